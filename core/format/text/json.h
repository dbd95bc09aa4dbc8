/* json.h - a JSON text as a tree, for formats that are written in it.
 *
 * The text is checked by the lexer (json_lexer.h), and no member may be given twice. It is kept by
 * the caller; the tree adds eight bytes a value, so that a text costs five times its length at
 * most, and no recursion.
 *
 * A value is named by its number, the root is 0 and HE_NONE is a value that is absent. A number is
 * only turned into a double when asked for. Every refusal names the byte and the path:
 *
 *     accessors/3/count: 0 is not a whole number from 1 to 9007199254740992 */
#ifndef HE_FORMAT_TEXT_JSON_H
#define HE_FORMAT_TEXT_JSON_H

#include "base/mem.h"
#include "base/watch.h"
#include "mesh/mesh.h"

enum { HE_JSON_PATH = 100 };
#define HE_JSON_VALUES ((size_t)1 << 23)         /* of one text, names of members included */
#define HE_JSON_TEXT   ((size_t)UINT32_MAX / 2u) /* bytes of one */
#define HE_JSON_WHOLE  ((uint64_t)1 << 53)       /* up to here doubles count right */

typedef struct he_json_value {
    uint32_t at;   /* its first byte in the text, which says its type */
    uint32_t next; /* the value after all that is inside this one */
} he_json_value;

/* {0} is empty. */
typedef struct he_json {
    const char *text; /* borrowed */
    size_t length;
    uint64_t offset; /* of the text in the input, for places */
    he_json_value *values;
    size_t count, capacity;
} he_json;

/* HE_SYNTAX, HE_NOT_FINITE for a number beyond doubles, HE_LIMIT, HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_json_parse(he_json *json, const char *text, size_t length,
                                     uint64_t offset, he_watch *watch, he_error *err);
void he_json_clear(he_json *json);

/* '{', '[', '"', 't', 'f', 'n', or '0' for any number; '\0' for HE_NONE. */
char he_json_type(const he_json *json, uint32_t value);
/* The member of this name, HE_NONE where `object` is none or has it not. Linear in the members. */
uint32_t he_json_find(const he_json *json, uint32_t object, const char *name);
/* The items of an array; of an object the names of its members, each with its value after it:
 * for (i = he_json_first(j, a); i != HE_NONE; i = he_json_after(j, a, i)) */
uint32_t he_json_first(const he_json *json, uint32_t list);
uint32_t he_json_after(const he_json *json, uint32_t list, uint32_t item);
/* The value of the member whose name is `name`. */
static inline uint32_t he_json_of(uint32_t name)
{
    return name + 1;
}
/* Values that are inside, itself counted. */
size_t he_json_span(const he_json *json, uint32_t value);

/* Is this a string, and this one? */
bool he_json_is(const he_json *json, uint32_t value, const char *text);
bool he_json_begins(const he_json *json, uint32_t value, const char *text);
/* The string without quotes and escapes, cut at a character to fit, ended by NUL; "" where the
 * value is no string. Returns its length. */
size_t he_json_string(const he_json *json, uint32_t value, char *to, size_t size);
/* The string's bytes as they stand, without quotes. */
const char *he_json_raw(const he_json *json, uint32_t value, size_t *length);

/* HE_BAD_VALUE, with the place and path, unless it is such a value within its range. */
HE_NODISCARD he_status he_json_number(const he_json *json, uint32_t value, double *out,
                                      he_error *err);
HE_NODISCARD he_status he_json_whole(const he_json *json, uint32_t value, uint64_t least,
                                     uint64_t most, uint64_t *out, he_error *err);

/* "meshes/0/primitives/2", for people: names are cut to fit. */
void he_json_path(const he_json *json, uint32_t value, char *to, size_t size);
/* he_fail_at the value's byte, the text begun by its path. */
he_status he_json_fail(const he_json *json, uint32_t value, he_error *err, he_status status,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Where in the input. */
uint64_t he_json_place(const he_json *json, uint32_t value);

#endif
