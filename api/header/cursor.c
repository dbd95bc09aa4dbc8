#include "api/header/cursor.h"

#include "format/text/number.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Writes a cursor. The text is "vertices.INCARNATION.REVISION.POSITION". The incarnation, a random
 * number that is new for each mesh that is created under an id, is in hexadecimal digits. */
void api_cursor_write(const char *collection, const st_mesh_info *info, uint64_t position,
                      char out[API_CURSOR])
{
    snprintf(out, API_CURSOR, "%s.%016" PRIx64 ".%" PRIu64 ".%" PRIu64, collection,
             info->incarnation, info->revision, position);
}

/* Reads a number up to a '.' or the end. Refuses texts that api_cursor_write would not have
 * written, such as leading zeros. */
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

typedef struct parts {
    size_t collection;       /* length of the collection's name */
    const char *incarnation; /* 16 hexadecimal digits */
    uint64_t revision, position;
} parts;

enum { DIGITS = 16 };

static bool split(const char *text, parts *out)
{
    *out = (parts){.collection = strcspn(text, ".")};
    const char *at = text + out->collection;
    if (*at != '.' || strspn(at + 1, "0123456789abcdef") != DIGITS || at[1 + DIGITS] != '.') {
        return false;
    }
    out->incarnation = at + 1;
    at += 1 + DIGITS + 1;
    return read_number(&at, &out->revision) && at[-1] == '.' && read_number(&at, &out->position) &&
           *at == '\0' && at[-1] != '.';
}

static bool is_of(const parts *cursor, const st_mesh_info *info)
{
    char incarnation[DIGITS + 4];
    snprintf(incarnation, sizeof incarnation, "%016" PRIx64, info->incarnation);
    return memcmp(incarnation, cursor->incarnation, DIGITS) == 0;
}

bool api_cursor_pins(const char *text, const st_mesh_info *info, uint64_t *revision)
{
    parts cursor;
    if (!split(text, &cursor) || !is_of(&cursor, info)) {
        return false;
    }
    *revision = cursor.revision;
    return true;
}

bool api_cursor_read(const char *text, const char *collection, const st_mesh_info *info,
                     uint64_t *position, api_problem *problem)
{
    parts cursor;
    if (!split(text, &cursor) || strlen(collection) != cursor.collection ||
        memcmp(text, collection, cursor.collection) != 0) {
        return api_problem_set(problem, API_BAD_CURSOR,
                               "the cursor does not belong to the list of %s", collection);
    }
    if (!is_of(&cursor, info)) {
        return api_problem_set(
            problem, API_REVISION_GONE,
            "the cursor belongs to another mesh, or to a deleted mesh that had this id");
    }
    *position = cursor.position;
    return true;
}
