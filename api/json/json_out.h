/* json_out.h - writing JSON, in order, onto a text.
 *
 *     api_out out;
 *     api_out_init(&out, &text);
 *     api_out_object_begin(&out);
 *     api_out_key(&out, "id");
 *     api_out_id(&out, v.i);
 *     api_out_object_end(&out);
 *     if (text.failed) ...            the only check there is
 *
 * Commas and colons are put by the writer. Strings are UTF-8 and stay it; quotes, backslashes and
 * control characters are escaped. Numbers are the shortest that read back to the same double.
 * Failure is the text's: sticky. A value without its key inside an object, or an end that does not
 * match, is the caller's mistake and asserted. */
#ifndef HE_API_JSON_JSON_OUT_H
#define HE_API_JSON_JSON_OUT_H

#include "api/json/text.h"
#include "mesh/mesh.h"

enum { API_OUT_DEPTH = 63 };

typedef struct api_out {
    api_text *text;
    uint64_t objects; /* bit d: level d is an object */
    uint64_t filled;  /* bit d: level d has a value already */
    unsigned depth;
    bool keyed;             /* a key waits for its value */
    struct he_watch *watch; /* asked in long lists whether to go on; NULL: they are written whole */
    unsigned parts;         /* of lists of ids, written since the watch was made */
} api_out;

void api_out_init(api_out *out, api_text *text);

void api_out_object_begin(api_out *out);
void api_out_object_end(api_out *out);
void api_out_array_begin(api_out *out);
void api_out_array_end(api_out *out);
void api_out_key(api_out *out, const char *key);

void api_out_null(api_out *out);
void api_out_bool(api_out *out, bool value);
void api_out_u64(api_out *out, uint64_t value);
void api_out_i64(api_out *out, int64_t value);
/* null for NaN and infinity, which JSON cannot say. */
void api_out_number(api_out *out, double value);
void api_out_string(api_out *out, const char *string);
/* Bytes that are not UTF-8 become U+FFFD each: text of the client may be quoted. */
void api_out_string_length(api_out *out, const char *bytes, size_t length);
/* null for HE_NONE. */
void api_out_id(api_out *out, uint32_t id);
void api_out_ids(api_out *out, const uint32_t *ids, size_t count);
/* Pairs a, b, a, b, ...: [[a,b],...]; `count` is of ids. */
void api_out_pairs(api_out *out, const uint32_t *ids, size_t count);
void api_out_vec3(api_out *out, he_vec3 value);
/* Seconds since 1970 UTC as "2026-01-31T12:00:00.000Z". */
void api_out_time(api_out *out, double seconds);
/* Leaves a place for a whole number that is known later, and returns where it is. Each is filled,
 * the last one first, after which the text may be sent; filling cannot fail. */
size_t api_out_later(api_out *out);
void api_out_fill(api_text *text, size_t at, uint64_t value);
/* One whole JSON value that is text already. */
void api_out_raw(api_out *out, const char *json, size_t length);

/* A key and its value at once. */
void api_out_key_bool(api_out *out, const char *key, bool value);
void api_out_key_u64(api_out *out, const char *key, uint64_t value);
void api_out_key_i64(api_out *out, const char *key, int64_t value);
void api_out_key_number(api_out *out, const char *key, double value);
void api_out_key_string(api_out *out, const char *key, const char *string);
void api_out_key_id(api_out *out, const char *key, uint32_t id);
void api_out_key_ids(api_out *out, const char *key, const uint32_t *ids, size_t count);
void api_out_key_vec3(api_out *out, const char *key, he_vec3 value);
void api_out_key_time(api_out *out, const char *key, double seconds);
void api_out_key_null(api_out *out, const char *key);

#endif
