#include "api/header/prefer.h"

#include "api/header/media.h"

#include <stddef.h>
#include <string.h>

/* No request takes this many seconds, so the digits of a "wait" that is longer are not read to the
 * end. */
enum { MOST_SECONDS = 1000000 };

/* Returns the seconds N of the preference "wait=N" in the header, or -1 if there is none. */
static double read_wait(const char *header)
{
    static const char name[] = "wait=";
    for (const char *at = header; at != NULL; at = strpbrk(at, ",;")) {
        at += strspn(at, ",; \t");
        size_t i = 0;
        while (i < sizeof name - 1 && (at[i] | 32) == (name[i] | 32)) {
            i++;
        }
        const char *digit = at + i;
        if (i < sizeof name - 1 || *digit < '0' || *digit > '9') {
            continue;
        }
        double seconds = 0;
        for (; *digit >= '0' && *digit <= '9' && seconds < MOST_SECONDS; digit++) {
            seconds = 10 * seconds + (*digit - '0');
        }
        return seconds;
    }
    return -1;
}

api_prefer api_prefer_read(const char *header)
{
    return (api_prefer){
        .minimal = api_header_has(header, "return=minimal"),
        .respond_async = api_header_has(header, "respond-async"),
        .wait = read_wait(header),
    };
}
