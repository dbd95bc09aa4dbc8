/* content_coding.h - content codings: reads which coding a body has and which codings a client
 * accepts (RFC 9110 sections 8.4 and 12.5.3; gzip is RFC 1952, zstd is RFC 8878). */
#ifndef HE_API_HEADER_CONTENT_CODING_H
#define HE_API_HEADER_CONTENT_CODING_H

#include <stdbool.h>

/* The content codings, in the order of preference if a client accepts several equally: zstd is
 * several times as fast as gzip, and its output is smaller. */
typedef enum api_coding { API_ZSTD, API_GZIP, API_IDENTITY, API_CODING_COUNT } api_coding;

/* Returns the name of a coding, such as "gzip". */
const char *api_coding_name(api_coding coding);

/* The codings accepted for request bodies: as a list that ends in NULL, and as the value of the
 * header Accept-Encoding that a refusal sends. */
extern const char *const api_codings_taken[];
extern const char api_codings_list[];

/* Reads the header Content-Encoding of a body. NULL, "" and "identity" mean API_IDENTITY; "x-gzip"
 * means gzip.
 * Returns false for an unknown coding, and for a list of several codings, because no body is
 * decompressed twice. */
bool api_coding_of_body(const char *content_encoding, api_coding *out);

/* The codings that an Accept-Encoding header allows, and the best of them. */
typedef struct api_codings {
    bool allowed[API_CODING_COUNT];
    api_coding best; /* the allowed coding that the client prefers */
} api_codings;

/* Chooses the coding of an answer. A NULL header allows identity alone, which needs no decoder.
 * Identity is allowed unless it has q=0, or "*" has q=0 and identity is not named; another coding
 * with an equal or higher q is preferred to identity. "*" stands for identity and gzip only,
 * because some proxies cannot read zstd, but all can read gzip: zstd is chosen only if the header
 * names it, or if nothing else is allowed. Malformed entries are skipped.
 * Returns false if the header allows no coding at all; then `best` is identity. */
bool api_coding_choose(const char *accept_encoding, api_codings *out);

#endif
