/* json.h - parses a JSON text into a tree, for mesh formats that are written in JSON.
 *
 * The lexer (json_lexer.h) checks the text; in addition, no name may occur twice in an object. The
 * caller keeps the text; the tree adds eight bytes for each value, so it takes at most four times
 * the length of the text, and parsing does not recurse.
 *
 * A value is named by its number: 0 is the outermost value, and HE_NONE stands for a value that is
 * absent. A number is converted to a double only when it is read. Every error names the byte and
 * the path:
 *
 *     accessors/3/count: 0 is not a whole number from 1 to 9007199254740992 */
#ifndef HE_FORMAT_TEXT_JSON_H
#define HE_FORMAT_TEXT_JSON_H

#include "base/mem.h"
#include "base/progress.h"
#include "mesh/mesh.h"

enum { HE_JSON_PATH = 100 };
#define HE_JSON_VALUES ((size_t)1 << 23)         /* the most values of a text, counting names */
#define HE_JSON_TEXT   ((size_t)UINT32_MAX / 2u) /* most bytes of one text */
#define HE_JSON_WHOLE  ((uint64_t)1 << 53) /* doubles represent all whole numbers up to this */

typedef struct he_json_value {
    uint32_t at;   /* offset in the text of the value's first byte, which determines its type */
    uint32_t next; /* number of the first value after this value and all values inside it */
} he_json_value;

/* {0} is empty. */
typedef struct he_json {
    const char *text; /* borrowed */
    size_t length;
    uint64_t offset; /* offset of the text in the input, so that errors name bytes of the input */
    he_json_value *values;
    size_t count, capacity;
} he_json;

/* Parses a JSON text.
 * Returns HE_SYNTAX if the text is not valid JSON.
 * Returns HE_NOT_FINITE if a number is beyond the range of doubles.
 * Returns HE_LIMIT if the text has too many values or is too long.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_json_parse(he_json *json, const char *text, size_t length,
                                     uint64_t offset, he_progress *progress, he_error *err);
void he_json_clear(he_json *json);

/* Returns the type of a value: '{', '[', '"', 't', 'f', 'n', or '0' for any number; '\0' for
 * HE_NONE. */
char he_json_type(const he_json *json, uint32_t value);
/* Finds the member of an object by its name. Returns HE_NONE if `object` is no object or has no
 * such member. Takes time linear in the number of members. */
uint32_t he_json_find(const he_json *json, uint32_t object, const char *name);
/* These two functions iterate over the items of an array, or over the names of an object's members;
 * the value of a member comes directly after its name (he_json_of):
 *     for (i = he_json_first(j, a); i != HE_NONE; i = he_json_after(j, a, i)) */
uint32_t he_json_first(const he_json *json, uint32_t list);
uint32_t he_json_after(const he_json *json, uint32_t list, uint32_t item);
/* Returns the number of a member's value, given the number of the member's name. */
static inline uint32_t he_json_of(uint32_t name)
{
    return name + 1;
}
/* Returns how many values are inside a value, counting the value itself. */
size_t he_json_span(const he_json *json, uint32_t value);

/* Returns true if the value is a string equal to `text`. */
bool he_json_is(const he_json *json, uint32_t value, const char *text);
bool he_json_begins(const he_json *json, uint32_t value, const char *text);
/* Copies a string value without its quotes and escapes. If the string does not fit, it is cut
 * between characters; the copy ends in NUL. Copies "" if the value is no string. Returns the length
 * of the copy. */
size_t he_json_string(const he_json *json, uint32_t value, char *to, size_t size);
/* Returns the bytes of a string value as they stand in the text, without the quotes. */
const char *he_json_raw(const he_json *json, uint32_t value, size_t *length);

/* he_json_number reads any number, he_json_whole a whole number from `least` to `most`.
 * Returns HE_BAD_VALUE, with the byte and the path of the value, if the value is not such a
 * number. */
HE_NODISCARD he_status he_json_number(const he_json *json, uint32_t value, double *out,
                                      he_error *err);
HE_NODISCARD he_status he_json_whole(const he_json *json, uint32_t value, uint64_t least,
                                     uint64_t most, uint64_t *out, he_error *err);

/* Writes the path of a value for messages, such as "meshes/0/primitives/2"; names are cut to
 * fit. */
void he_json_path(const he_json *json, uint32_t value, char *to, size_t size);
/* Fails like he_fail_at at the byte where the value begins; the message begins with the path of
 * the value. */
he_status he_json_fail(const he_json *json, uint32_t value, he_error *err, he_status status,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Returns the byte of the input where the value begins. */
uint64_t he_json_place(const he_json *json, uint32_t value);

#endif
