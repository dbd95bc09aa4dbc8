/* json_out.h - writing JSON, value after value, to the end of a text.
 *
 *     api_out out;
 *     api_out_init(&out, &text);
 *     api_out_object_begin(&out);
 *     api_out_key(&out, "id");
 *     api_out_id(&out, v.i);
 *     api_out_object_end(&out);
 *     if (text.failed) ...            the only check there is
 *
 * The writer inserts commas and colons. Strings are UTF-8 and are not re-encoded; quotes,
 * backslashes and control characters are escaped. Numbers are the shortest that read back to the
 * same double. Failure is sticky (text.h): after a write has failed, all later writes are ignored.
 * A value without its key inside an object, or an end that does not match, is a mistake of the
 * caller and trips an assert. */
#ifndef HE_API_JSON_JSON_OUT_H
#define HE_API_JSON_JSON_OUT_H

#include "api/json/text.h"
#include "mesh/mesh.h"

enum { API_OUT_DEPTH = 63 };

typedef struct api_out {
    api_text *text;
    uint64_t objects; /* bit d is set if nesting level d is an object, clear if it is an array */
    uint64_t filled;  /* bit d is set if nesting level d has a value already */
    unsigned depth;
    bool keyed; /* true if a key was written, but not yet its value */
    /* Called while a long list is written, to ask whether writing must stop; NULL: writing never
     * stops. */
    struct he_progress *progress;
    /* Long lists of ids are written in parts: how many parts were written since `progress` was
     * set. */
    unsigned parts;
    /* If not NULL, lists of ids and of numbers become arrays beside the JSON (packed.h). */
    struct api_arrays *arrays;
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
/* Writes a number, or null for NaN and infinity, which JSON cannot express. */
void api_out_number(api_out *out, double value);
void api_out_string(api_out *out, const char *string);
/* Writes a string. Each byte that is not UTF-8 becomes U+FFFD, because the string may quote invalid
 * text of a client. */
void api_out_string_length(api_out *out, const char *bytes, size_t length);
/* Writes an id, or null for HE_NONE. */
void api_out_id(api_out *out, uint32_t id);
void api_out_ids(api_out *out, const uint32_t *ids, size_t count);
/* Writes the ids a, b, a, b, ... as pairs [[a,b],...]; `count` is the number of ids. */
void api_out_pairs(api_out *out, const uint32_t *ids, size_t count);
/* Writes lists of ids that follow each other as a list of lists; ends[i] is where list i ends. */
void api_out_id_lists(api_out *out, const uint32_t *ids, const uint32_t *ends, size_t lists);
/* Writes a list of numbers; NaN and infinity become null, or stay in an array beside the JSON. */
void api_out_numbers(api_out *out, const double *numbers, size_t count);
void api_out_vec3(api_out *out, he_vec3 value);
/* Writes seconds since 1970 UTC as "2026-01-31T12:00:00.000Z". */
void api_out_time(api_out *out, double seconds);
/* Reserves space for a whole number that is known only later, and returns its position. Every
 * reserved number must be filled in, the last one first, before the text is sent. Filling it in
 * cannot fail. */
size_t api_out_later(api_out *out);
void api_out_fill(api_text *text, size_t at, uint64_t value);
/* Copies a text that is already one whole JSON value. */
void api_out_raw(api_out *out, const char *json, size_t length);

/* The api_out_key_* functions write a key and its value. */
void api_out_key_bool(api_out *out, const char *key, bool value);
void api_out_key_u64(api_out *out, const char *key, uint64_t value);
void api_out_key_number(api_out *out, const char *key, double value);
void api_out_key_string(api_out *out, const char *key, const char *string);
void api_out_key_id(api_out *out, const char *key, uint32_t id);
void api_out_key_ids(api_out *out, const char *key, const uint32_t *ids, size_t count);
void api_out_key_vec3(api_out *out, const char *key, he_vec3 value);
void api_out_key_null(api_out *out, const char *key);

#endif
