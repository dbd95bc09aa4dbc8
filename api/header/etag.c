#include "api/header/etag.h"

#include "format/text/number.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* Writes the part of an entity tag that changes with the mesh. printf is avoided for speed, because
 * nearly every answer has an entity tag. */
static size_t write_state(const st_mesh_info *info, char out[API_ETAG])
{
    static const char digits[] = "0123456789abcdef";
    char *at = out;
    *at++ = '"';
    for (int shift = 60; shift >= 0; shift -= 4) {
        *at++ = digits[info->incarnation >> shift & 15];
    }
    *at++ = '-';
    at += he_u64_print(info->metadata, at);
    *at++ = '-';
    at += he_u64_print(info->revision, at);
    *at++ = '-';
    return (size_t)(at - out);
}

void api_etag_write(const st_mesh_info *info, const char *representation, char out[API_ETAG])
{
    enum { STATE = 1 + 16 + 1 + 20 + 1 + 20 + 1 };
    size_t used = write_state(info, out), length = strlen(representation);
    size_t room = API_ETAG - STATE - 2;
    length = length < room ? length : room;
    memcpy(out + used, representation, length);
    memcpy(out + used + length, "\"", 2);
}

/* Steps through a list of entity tags. Returns false at the end of the list, or at an entry that is
 * malformed. */
static bool next_tag(const char **at, bool *weak, const char **tag, size_t *length)
{
    *at += strspn(*at, " \t,");
    *weak = strncmp(*at, "W/", 2) == 0;
    const char *quote = *at + (*weak ? 2 : 0);
    const char *end = *quote == '"' ? strchr(quote + 1, '"') : NULL;
    if (end == NULL) {
        return false;
    }
    *tag = quote;
    *length = (size_t)(end + 1 - quote);
    *at = end + 1;
    return true;
}

static bool is_any(const char *header)
{
    size_t blanks = strspn(header, " \t");
    return header[blanks] == '*' && header[blanks + 1 + strspn(header + blanks + 1, " \t")] == '\0';
}

void api_etag_code(const char *etag, api_coding coding, char out[API_ETAG])
{
    size_t length = strlen(etag);
    assert(length > 1 && length < API_ETAG);
    if (coding == API_IDENTITY) {
        memcpy(out, etag, length + 1);
    } else {
        snprintf(out, API_ETAG, "%.*s-%s\"", (int)length - 1, etag, api_coding_name(coding));
    }
}

bool api_etag_listed(const char *header, const char *etag, const api_codings *codings,
                     api_coding *found)
{
    *found = API_IDENTITY;
    if (is_any(header)) {
        return true;
    }
    bool weak;
    const char *tag;
    size_t length;
    while (next_tag(&header, &weak, &tag, &length)) {
        for (api_coding c = 0; c < API_CODING_COUNT; c++) {
            char coded[API_ETAG];
            api_etag_code(etag, c, coded);
            if (codings->allowed[c] && length == strlen(coded) && memcmp(tag, coded, length) == 0) {
                *found = c;
                return true;
            }
        }
    }
    return false;
}

bool api_etag_is_present(const char *header, const st_mesh_info *info)
{
    if (is_any(header)) {
        return true;
    }
    char state[API_ETAG];
    size_t prefix = write_state(info, state), length;
    bool weak;
    const char *tag;
    while (next_tag(&header, &weak, &tag, &length)) {
        if (!weak && length > prefix && memcmp(tag, state, prefix) == 0) {
            return true;
        }
    }
    return false;
}
