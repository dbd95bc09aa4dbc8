/* content_encoding.h - the content coding of an exchange: how the request's body is compressed, and
 * how the answer will be compressed.
 *
 * An answer is compressed with the coding that Accept-Encoding prefers (content_coding.h).
 * Exceptions are event streams, answers of at most API_COMPRESS_FROM bytes, types that are
 * compressed already, answers that are marked as dense (api.h), and answers that would not become
 * shorter. ETags are strong, so a compressed answer has its own: "...-gzip". If-None-Match is
 * answered 304 for the tag of any coding that the client accepts, and the 304 repeats that tag.
 * If-Match compares only the state of the mesh, so it accepts the tags of all codings. */
#ifndef HE_API_REQUEST_CONTENT_ENCODING_H
#define HE_API_REQUEST_CONTENT_ENCODING_H

#include "api/request/exchange.h"

/* Reads how the body is compressed into x->coding_in, or refuses with 415. */
bool api_content_encoding_body(api_exchange *x);
/* Reads which codings the client accepts into x->codings, or refuses with 406. */
bool api_content_encoding_accept(api_exchange *x);
/* Returns true if the answer depends on Accept-Encoding. */
bool api_content_encoding_varies(const api_exchange *x);
/* Compresses the complete answer. If there is no memory for that, the answer stays uncompressed. */
void api_content_encoding_answer(api_exchange *x);

#endif
