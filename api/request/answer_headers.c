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
    /* Comparing lengths and first letters keeps this fast, because it is called for each header of
     * each answer. */
    for (size_t i = 0; i < sizeof listed / sizeof *listed; i++) {
        if (listed[i].length == length && listed[i].name[0] == name[0] &&
            memcmp(name, listed[i].name, length) == 0) {
            return true;
        }
    }
    return length >= sizeof cors - 1 && memcmp(name, cors, sizeof cors - 1) == 0;
}
