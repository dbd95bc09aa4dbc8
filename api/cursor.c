#include "api/cursor.h"

#include "format/number.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* "vertices.INCARNATION.REVISION.POSITION", the incarnation in hexadecimal digits. */
void api_cursor_write(const char *collection, const api_mesh_info *info, uint64_t position,
                      char out[API_CURSOR])
{
    snprintf(out, API_CURSOR, "%s.%016" PRIx64 ".%" PRIu64 ".%" PRIu64, collection,
             info->incarnation, info->revision, position);
}

/* One number up to a '.' or the end; the text must be what we would have written. */
static bool read_number(const char **at, uint64_t *out)
{
    const char *end = *at + strcspn(*at, ".");
    size_t used;
    if (he_u64_parse(*at, end, out, &used) != HE_OK || *at + used != end ||
        (**at == '0' && used > 1)) {
        return false;
    }
    *at = *end == '.' ? end + 1 : end;
    return true;
}

bool api_cursor_read(const char *text, const char *collection, const api_mesh_info *info,
                     uint64_t *position, api_problem *problem)
{
    char incarnation[20];
    size_t name = strlen(collection), digits = 16;
    uint64_t revision, place;
    const char *at = text;
    bool known = strncmp(text, collection, name) == 0 && text[name] == '.' &&
                 strspn(text + name + 1, "0123456789abcdef") == digits &&
                 text[name + 1 + digits] == '.';
    if (known) {
        at = text + name + 1 + digits + 1;
    }
    if (!known || !read_number(&at, &revision) || at[-1] != '.' || !read_number(&at, &place) ||
        *at != '\0' || at[-1] == '.') {
        return api_problem_set(problem, API_BAD_CURSOR, "the cursor is not one of %s", collection);
    }
    snprintf(incarnation, sizeof incarnation, "%016" PRIx64, info->incarnation);
    if (memcmp(incarnation, text + name + 1, digits) != 0 || revision != info->revision) {
        return api_problem_set(problem, API_REVISION_GONE,
                               "the cursor is of revision %" PRIu64 ", the mesh is at %" PRIu64,
                               revision, info->revision);
    }
    *position = place;
    return true;
}
