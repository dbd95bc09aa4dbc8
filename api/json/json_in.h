/* json_in.h - reading control documents strictly.
 *
 * The text is scanned before cJSON sees it: UTF-8, depth, number of values, the grammar of numbers
 * and strings to the letter, no \u0000, no lone surrogate, no byte order mark, nothing after the
 * value. Then it is parsed, and objects with a repeated member are refused by name.
 *
 * Values are read through api_in, a cursor that knows its way back to the root, so that every
 * refusal carries the JSON pointer of the value at fault. Cursors live on the stack; a child holds
 * a pointer to its parent, which must outlive it. All functions that return bool fill the problem
 * on false, save api_in_find, where false says "absent".
 *
 *     api_in depth;
 *     if (!api_in_only(&root, (const char *const[]){"walk", "depth", NULL}) ||
 *         !api_in_need(&root, "depth", &depth) || !api_in_u64(&depth, 0, 100, &n)) {
 *         return;
 *     } */
#ifndef HE_API_JSON_JSON_IN_H
#define HE_API_JSON_JSON_IN_H

#include "api/json/arena.h"
#include "api/json/problem.h"

struct cJSON;

typedef struct api_in {
    const struct cJSON *value;
    const struct api_in *parent; /* NULL at the root */
    size_t index;                /* in an array; members know their name */
    api_problem *problem;        /* where refusals go */
} api_in;

/* A parsed document. */
typedef struct api_document {
    struct cJSON *root;
} api_document;

/* What a text may hold. */
typedef struct api_in_limits {
    size_t values;
    bool no_offsets; /* byte offsets would mislead: the text is not what the client sent */
} api_in_limits;

/* The items of an array that is left out of its document, so that they are read one at a time and
 * a long list costs no more than its text. */
typedef struct api_items {
    const char *name;     /* of the member of the root that holds the array */
    const char *at, *end; /* their text; NULL: the root has no such array */
    size_t count;
} api_items;

/* One of them; the next one takes its place. {0} is none. */
typedef struct api_item {
    api_document document;
    api_in in;
    const char *next; /* what follows it in the text */
} api_item;

/* Makes cJSON take its memory from mem.h. Once, before threads start; api_service_new does it. */
void api_in_setup(void);

/* `root` reads `out`, which the caller clears. Refusals: malformed_json, duplicate_member,
 * limit_exceeded (413), no_memory. */
bool api_document_parse(const char *bytes, size_t length, const api_in_limits *limits,
                        api_document *out, api_in *root, api_problem *problem);
void api_document_clear(api_document *document);
/* The same for a document whose array of `items->name` is left empty: `bytes` must outlive its
 * items, in which a repeated member is found when they are read. */
bool api_document_parse_but(const char *bytes, size_t length, const api_in_limits *limits,
                            api_items *items, api_document *out, api_in *root,
                            api_problem *problem);
/* The items in their order: for (size_t i = 0; i < items.count && api_item_read(...); i++). `list`
 * is a cursor at their array. Refusals: duplicate_member, no_memory. */
bool api_item_read(const api_items *items, size_t i, const api_in *list, api_item *item);
void api_item_clear(api_item *item);

/* --- shape --- */
bool api_in_is_null(const api_in *in);
bool api_in_is_string(const api_in *in);
bool api_in_is_array(const api_in *in);
bool api_in_is_object(const api_in *in);
bool api_in_is_number(const api_in *in);

/* An object with these members and no others (each may be absent). `names` ends in NULL. */
bool api_in_only(const api_in *in, const char *const *names);
bool api_in_object(const api_in *in);                                  /* an object */
bool api_in_find(const api_in *object, const char *name, api_in *out); /* false: absent */
bool api_in_need(const api_in *object, const char *name, api_in *out); /* false: refused */
/* An array of between `min` and `max` values. */
bool api_in_array(const api_in *in, size_t min, size_t max);
size_t api_in_count(const api_in *in); /* of values or members; linear */
/* Walk an array or an object: for (bool more = api_in_first(&a, &i); more; more = api_in_next(&i))
 */
bool api_in_first(const api_in *in, api_in *child);
bool api_in_next(api_in *child);
const char *api_in_name(const api_in *member); /* of a member of an object */

/* --- values --- */
bool api_in_bool(const api_in *in, bool *out);
bool api_in_number(const api_in *in, double *out); /* finite */
/* bad_value outside [min, max], or on its ends when exclusive. */
bool api_in_number_within(const api_in *in, double min, double max, bool exclusive, double *out);
/* A whole number in [min, max]; max at most 2^53. */
bool api_in_u64(const api_in *in, uint64_t min, uint64_t max, uint64_t *out);
/* An element id: a whole number below 2^32 - 2. */
bool api_in_id(const api_in *in, uint32_t *out);
/* At least `min` ids, in the arena. */
bool api_in_ids(const api_in *in, size_t min, api_arena *arena, uint32_t **ids, size_t *count);
bool api_in_vec3(const api_in *in, he_vec3 *out);
/* At most `max` bytes; borrowed from the document. */
bool api_in_string(const api_in *in, size_t max, const char **out);
/* The index among `choices`, which ends in NULL. */
bool api_in_choice(const api_in *in, const char *const *choices, int *out);
/* {"vertex":5}: one member named after an element kind. */
bool api_in_element(const api_in *in, he_kind *kind, uint32_t *id);

/* Refuse the value `in` is at, with its pointer. Returns false. */
bool api_in_fail(const api_in *in, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Add the pointer of `in` to the problem that is there (a refusal of core, say). */
void api_in_point(const api_in *in);
/* The JSON pointer of `in`, cut when it does not fit. */
void api_in_pointer(const api_in *in, char *out, size_t size);

#endif
