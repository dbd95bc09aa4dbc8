/* idempotency.h - requests with an Idempotency-Key: executed once, and answered the same way each
 * time.
 *
 * Routes with the flag API_IDEMPOTENCY_KEY or API_IDEMPOTENCY_KEY_NEW read the header
 * (draft-ietf-httpapi-idempotency-key-header): 1 to API_KEY_LENGTH visible characters, quoted or
 * not, taken literally. With API_IDEMPOTENCY_KEY, keys are kept for each mesh and deleted with it.
 * With API_IDEMPOTENCY_KEY_NEW, for requests that make a mesh, keys are kept for the whole store.
 *
 * Two requests are equal if their methods, paths, queries, Content-Types and all bytes of their
 * decompressed bodies are equal. For multipart/form-data the names, types and bytes of the files
 * are compared, and not the boundary, which clients choose anew each time. The store keeps a keyed
 * hash of 128 bits of all this, because bodies are too large to keep. Preconditions such as
 * If-Match are not compared, because the write itself has changed the revision that a repeated
 * request would find.
 *
 * Answers with a status 2xx are kept. Refusals and failures are not, so that the client may try
 * again when their reason is gone. */
#ifndef HE_API_REQUEST_IDEMPOTENCY_H
#define HE_API_REQUEST_IDEMPOTENCY_H

#include "api/request/exchange.h"

/* Checks the header Idempotency-Key and begins the hash of the request. It is called when the route
 * is known. */
bool api_idempotency_begin(api_exchange *x);
void api_idempotency_body(api_exchange *x, const char *bytes, size_t length);
/* Adds bytes of the body to the hash. The reader of multipart/form-data calls it with the files,
 * not their delimiters. */
void api_idempotency_add(api_exchange *x, const char *bytes, size_t length);
/* Looks up the key before the handler runs. Returns false if the handler must not run, because the
 * request was answered with the answer kept under the key, or refused. */
bool api_idempotency_find(api_exchange *x);
/* Keeps the complete answer under the key; or releases the key if the request was refused or
 * failed. */
void api_idempotency_settle(api_exchange *x);

#endif
