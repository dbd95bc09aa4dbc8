/* keyed.h - requests with an Idempotency-Key: done once, and answered alike each time they come.
 *
 * Rows with API_KEYED or API_KEYED_NEW read the header (draft-ietf-httpapi-idempotency-key-header):
 * 1 to API_KEY_LENGTH visible characters, quoted or not, taken as they stand. With API_KEYED the
 * key is one of the mesh and dies with it, with API_KEYED_NEW one of the store. A request is the
 * same when method, path, query, Content-Type and each byte of the body are, its content coding
 * undone: how it was packed for the way says nothing about what is asked. So of multipart/form-data
 * the names, types and bytes of the files are, which its reader adds, and not the boundary, which a
 * client makes up anew. Of these a keyed hash of
 * 128 bits is kept, since bodies are too large to keep. Preconditions are not part of it: a write
 * that is asked for again meets the revision it made.
 *
 * Answers of 2xx are kept. Refusals are not, so that the client may try again once their reason is
 * gone; neither are failures. */
#ifndef HE_API_REQUEST_KEYED_H
#define HE_API_REQUEST_KEYED_H

#include "api/request/exchange.h"

/* After the row was found: check the header and begin the hash. */
bool api_keyed_begin(api_exchange *x);
void api_keyed_body(api_exchange *x, const char *bytes, size_t length);
/* The reader of multipart/form-data adds what makes requests equal or different: the files, not
 * their delimiters. */
void api_keyed_add(api_exchange *x, const char *bytes, size_t length);
/* Before the handler. False when it must not run: the first answer was given again, or refused. */
bool api_keyed_find(api_exchange *x);
/* The answer is complete: keep it, or let the key be used again. */
void api_keyed_settle(api_exchange *x);

#endif
