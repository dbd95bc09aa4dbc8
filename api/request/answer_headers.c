#include "api/request/answer_headers.h"

#include <stddef.h>
#include <string.h>

#define WITH_SEPARATOR(name, separator) name separator
const char api_exposed_headers[] = API_EXPOSED_HEADERS(WITH_SEPARATOR);

bool api_header_is_listed(const char *name)
{
#define WITH_LENGTH(name, separator) {(name), sizeof(name) - 1},
    static const struct {
        const char *name;
        size_t length;
    } listed[] = {API_EXPOSED_HEADERS(WITH_LENGTH) WITH_LENGTH("Cache-Control", )
                      WITH_LENGTH("Content-Type", )};
    static const char cors[] = "Access-Control-";
    const size_t length = strlen(name);
    /* Comparing lengths first keeps this fast, because it is called for each header of each
     * answer. */
    bool found = length >= sizeof cors - 1 && memcmp(name, cors, sizeof cors - 1) == 0;
    for (size_t i = 0; i < sizeof listed / sizeof *listed && !found; i++) {
        found = listed[i].length == length && memcmp(name, listed[i].name, length) == 0;
    }
    return found;
}
