/* json_in.h - strict reading of control documents, which are JSON bodies other than meshes.
 *
 * The text is scanned before cJSON sees it. The scan checks UTF-8, depth, number of values, and the
 * exact grammar of numbers and strings; it refuses \u0000, lone surrogates, a byte order mark and
 * anything after the value. Then the text is parsed, and an object with a repeated member is
 * refused with the member's name.
 *
 * Values are read through api_in, a cursor that knows the path back to the root (the outermost
 * value of the document), so that every refusal carries the JSON pointer of the value at fault.
 * Cursors live on the stack; a child holds a pointer to its parent, which must outlive it. All
 * functions that return bool fill the problem when they return false, except api_in_find, where
 * false means "absent".
 *
 *     api_in depth;
 *     if (!api_in_only(&root, (const char *const[]){"walk", "depth", NULL}) ||
 *         !api_in_need(&root, "depth", &depth) || !api_in_u64(&depth, 0, 100, &n)) {
 *         return;
 *     } */
#ifndef HE_API_JSON_JSON_IN_H
#define HE_API_JSON_JSON_IN_H

#include "api/json/arena.h"
#include "api/json/packed.h"
#include "api/json/problem.h"

struct cJSON;

typedef struct api_in {
    const struct cJSON *value;
    /* The cursor at the array or object that contains the value; NULL for the outermost value. */
    const struct api_in *parent;
    /* Index of the value in its array; not used if the value is a member of an object. */
    size_t index;
    api_problem *problem; /* the problem that is filled when the value is refused */
} api_in;

/* A parsed document. */
typedef struct api_document {
    struct cJSON *root;
} api_document;

/* The items of a long array in a document, which the parsed document leaves out. The caller parses
 * the items one at a time, so that the array needs no more memory than its text. */
typedef struct api_items {
    const char *name; /* name of the document's member whose value is the array */
    /* Begin and end of the items' text; NULL if the document has no such array. */
    const char *at, *end;
    size_t count;
    /* The arrays beside the document for which {"array":K} stands; NULL: it has none. */
    const api_arrays *arrays;
} api_items;

/* Limits and options for parsing a text. */
typedef struct api_in_options {
    size_t values; /* how many values the text may contain at most */
    size_t before; /* bytes of the body before the text; problems count bytes from its begin */
    /* Describes the array whose items are left out, with `name` set; NULL: there is no such
     * array. */
    api_items *items;
} api_in_options;

/* One parsed item of a long array; reading the next item replaces it. {0}: no item was read yet. */
typedef struct api_item {
    api_document document;
    api_in in;
    const char *next; /* the text after the item */
} api_item;

/* Makes cJSON allocate through mem.h. api_service_new calls it once, before threads start. */
void api_in_setup(void);

/* Parses the text into `out`, which the caller clears, and sets the cursor `root` to the outermost
 * value. If the options name an array whose items are left out (api_items), that array is empty in
 * `out`, and the caller reads its items one by one with api_item_read; the text must outlive the
 * items. A repeated member inside an item is found when the item is read.
 * Returns false with malformed_json, duplicate_member, limit_exceeded (413) or no_memory. */
bool api_document_parse(api_bytes text, const api_in_options *options, api_document *out,
                        api_in *root, api_problem *problem);
/* Parses a text that the scan (json_scan.h) has accepted already. */
bool api_document_parse_scanned(api_bytes text, api_document *out, api_in *root,
                                api_problem *problem);
void api_document_clear(api_document *document);
/* Reads one item. Items are read in order: for (size_t i = 0; i < items.count &&
 * api_item_read(...); i++). `list` is a cursor at the array of the items.
 * Returns false with duplicate_member or no_memory. */
bool api_item_read(const api_items *items, size_t i, const api_in *list, api_item *item);
void api_item_clear(api_item *item);

/* --- objects, arrays and types --- */
bool api_in_is_null(const api_in *in);
bool api_in_is_string(const api_in *in);
bool api_in_is_array(const api_in *in);
bool api_in_is_object(const api_in *in);
bool api_in_is_number(const api_in *in);

/* Checks that the value is an object with no other members than `names`, each of which may be
 * absent. `names` ends in NULL. */
bool api_in_only(const api_in *in, const char *const *names);
bool api_in_object(const api_in *in); /* checks that the value is an object */
/* Returns false if the object has no member `name`. */
bool api_in_find(const api_in *object, const char *name, api_in *out);
/* Finds the member `name`, and refuses the object if it has no such member. */
bool api_in_need(const api_in *object, const char *name, api_in *out);
/* Returns the array beside the document for which the value stands; NULL if it is no such value.
 * api_in_is_array and api_in_count treat it like an array, the other functions refuse it. */
const api_numbers *api_in_numbers(const api_in *in);
/* Checks that the value is an array of `min` to `max` values. */
bool api_in_array(const api_in *in, size_t min, size_t max);
/* Returns the number of values in an array or members in an object, in linear time. */
size_t api_in_count(const api_in *in);
/* Steps through an array or an object: for (bool more = api_in_first(&a, &i); more; more =
 * api_in_next(&i))
 */
bool api_in_first(const api_in *in, api_in *child);
bool api_in_next(api_in *child);
/* Returns a cursor that names item `i` of an array in a refusal. It has no value to read. */
api_in api_in_item(const api_in *array, size_t i);
const char *api_in_name(const api_in *member); /* returns the name of a member of an object */

/* --- reading values --- */
bool api_in_bool(const api_in *in, bool *out);
bool api_in_number(const api_in *in, double *out); /* reads a finite number */
/* These functions check a number that was read already, and refuse the value at `in`. */
bool api_in_check_within(const api_in *in, double value, const double range[2], bool exclusive);
bool api_in_check_whole(const api_in *in, double value, uint64_t min, uint64_t max);
/* Reads a number. Refuses a number outside [min, max] with bad_value; if `exclusive` is true, also
 * `min` and `max` themselves. */
bool api_in_number_within(const api_in *in, double min, double max, bool exclusive, double *out);
/* Reads a whole number in [min, max]; max is at most 2^53. */
bool api_in_u64(const api_in *in, uint64_t min, uint64_t max, uint64_t *out);
/* Reads an element id: a whole number below 2^32 - 2. */
bool api_in_id(const api_in *in, uint32_t *out);
/* Reads an array of at least `min` ids; `*ids` gets them, in the arena. */
bool api_in_ids(const api_in *in, size_t min, api_arena *arena, uint32_t **ids, size_t *count);
bool api_in_vec3(const api_in *in, he_vec3 *out);
/* Reads a string of at most `max` bytes, which the document owns. */
bool api_in_string(const api_in *in, size_t max, const char **out);
/* Reads a name that people see: a string of at most `max` bytes without the characters that
 * api_unseen_character() finds. */
bool api_in_seen_name(const api_in *in, size_t max, const char **out);
/* Reads a string that must be one of `choices`, which ends in NULL; `out` gets its index. */
bool api_in_choice(const api_in *in, const char *const *choices, int *out);
/* Reads {"vertex":5}: an object with one member that is named after a kind of element. */
bool api_in_element(const api_in *in, he_kind *kind, uint32_t *id);

/* Refuses the value at `in` with its JSON pointer. Always returns false. */
bool api_in_fail(const api_in *in, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Adds the JSON pointer of `in` to a problem that is already filled (for example by a refusal of
 * core). */
void api_in_point(const api_in *in);
/* Writes the JSON pointer of `in`, truncated if it does not fit. */
void api_in_pointer(const api_in *in, char *out, size_t size);

#endif
