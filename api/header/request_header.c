#include "api/header/request_header.h"

#include <strings.h>

#define ROW(constant, name, is_list) {name, sizeof(name) - 1, is_list},
static const struct {
    const char *name;
    size_t length;
    bool is_list;
} rows[API_REQUEST_HEADERS] = {API_REQUEST_HEADER_MAP(ROW)};
#undef ROW

api_request_header api_request_header_find(const char *name, size_t length)
{
    api_request_header i = 0;
    while (i < API_REQUEST_HEADERS &&
           (rows[i].length != length || strncasecmp(rows[i].name, name, length) != 0)) {
        i++;
    }
    return i;
}

bool api_request_header_is_list(api_request_header header)
{
    return rows[header].is_list;
}
