#include "server/http/http_headers.h"

#include "base/mem.h"

#include <string.h>

/* In how many lines one header was sent, and the sum of the lengths of the values in these lines
 * plus one byte for each line (for the comma or the NUL after its value). */
typedef struct line_sum {
    size_t count, bytes;
} line_sum;

/* Writes the values of all lines of a header to `out`, separated by commas. Returns the position
 * after the joined value and its NUL. */
static char *join(const srv_head *head, api_request_header header, char *out)
{
    for (size_t i = 0; i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        if (api_request_header_find(field->name, field->name_length) == header) {
            memcpy(out, field->value, field->value_length);
            out += field->value_length;
            *out++ = ',';
        }
    }
    out[-1] = '\0';
    return out;
}

static bool is_joined(const line_sum *sums, api_request_header header)
{
    return sums[header].count > 1 && api_request_header_is_list(header);
}

bool srv_headers_read(const srv_head *head, const char *values[API_REQUEST_HEADERS], char **joined)
{
    line_sum sums[API_REQUEST_HEADERS] = {{0, 0}};
    const char *first[API_REQUEST_HEADERS] = {NULL};
    size_t bytes = 0;
    for (size_t i = 0; i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        api_request_header header = api_request_header_find(field->name, field->name_length);
        if (header < API_REQUEST_HEADERS) {
            first[header] = first[header] == NULL ? field->value : first[header];
            sums[header].count++;
            sums[header].bytes += field->value_length + 1;
        }
    }
    for (api_request_header h = 0; h < API_REQUEST_HEADERS; h++) {
        bytes += is_joined(sums, h) ? sums[h].bytes : 0;
    }
    char *out = bytes == 0 ? NULL : he_mem_alloc(bytes);
    if (out == NULL && bytes > 0) {
        return false;
    }
    *joined = out;
    for (api_request_header h = 0; h < API_REQUEST_HEADERS; h++) {
        values[h] = first[h];
        if (is_joined(sums, h)) {
            values[h] = out;
            out = join(head, h, out);
        }
    }
    return true;
}
