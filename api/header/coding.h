/* coding.h - content codings: what they are called, and which of them two headers ask for.
 * RFC 9110 sections 8.4 and 12.5.3; gzip is RFC 1952, zstd RFC 8878. */
#ifndef HE_API_HEADER_CODING_H
#define HE_API_HEADER_CODING_H

#include <stdbool.h>

/* In the order in which a client that likes several equally is served: zstd is several times as
 * fast as gzip and smaller. */
typedef enum api_coding { API_ZSTD, API_GZIP, API_IDENTITY, API_CODING_COUNT } api_coding;

/* "gzip" */
const char *api_coding_name(api_coding coding);

/* The names a body may be coded by, which ends in NULL, and the same as the header Accept-Encoding
 * of a refusal. */
extern const char *const api_codings_taken[];
extern const char api_codings_list[];

/* What a Content-Encoding says; NULL, "" and identity are API_IDENTITY, x-gzip is gzip. False for
 * what is unknown and for more than one coding, so that no body unfolds twice. */
bool api_coding_of_body(const char *content_encoding, api_coding *out);

/* What an Accept-Encoding allows. */
typedef struct api_codings {
    bool allowed[API_CODING_COUNT];
    api_coding best; /* the one it likes best, of those allowed */
} api_codings;

/* False when it allows none: then `best` is identity all the same. NULL allows identity alone:
 * who says nothing gets what needs no decoder. Identity is allowed unless it, or "*" without it,
 * has q=0; another coding that is liked as much or more is better. "*" stands for identity and
 * gzip, which everything between reads: zstd is taken only by name, or where nothing else is
 * allowed. An entry that is not well formed is passed over. */
bool api_coding_choose(const char *accept_encoding, api_codings *out);

#endif
