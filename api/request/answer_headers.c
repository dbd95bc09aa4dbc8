#include "api/request/answer_headers.h"

#include <stddef.h>
#include <string.h>

#define WITH_SEPARATOR(name, separator) name separator
const char api_exposed_headers[] = API_EXPOSED_HEADERS(WITH_SEPARATOR);

bool api_header_is_listed(const char *name)
{
#define WITH_COMMA(name, separator) name,
    static const char *const exposed[] = {API_EXPOSED_HEADERS(WITH_COMMA)};
    static const char cors[] = "Access-Control-";
    bool found = strncmp(name, cors, sizeof cors - 1) == 0 || strcmp(name, "Cache-Control") == 0 ||
                 strcmp(name, "Content-Type") == 0;
    for (size_t i = 0; i < sizeof exposed / sizeof *exposed && !found; i++) {
        found = strcmp(name, exposed[i]) == 0;
    }
    return found;
}
