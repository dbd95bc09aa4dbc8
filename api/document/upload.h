/* upload.h - a body that becomes a mesh: a JSON document, the name of a shape, or a mesh file,
 * alone or among the files that it refers to (parts.h).
 *
 * The bytes go to a reader as they arrive; nothing keeps the mesh's file. The reader is chosen by
 * ?format=, else by Content-Type, else (application/octet-stream) by the first bytes.
 *
 *     api_upload_begin    before the body
 *     api_upload_feed     per piece
 *     api_upload_end      the body is whole and, unless its format is read at the end, well formed
 *     api_upload_build    the mesh; costs the mesh, so it may have to move to the job pool first
 *
 * State is the exchange's. On false the problem is filled. */
#ifndef HE_API_DOCUMENT_UPLOAD_H
#define HE_API_DOCUMENT_UPLOAD_H

#include "api/request/exchange.h"

bool api_upload_begin(api_exchange *x);
bool api_upload_feed(api_exchange *x, const char *bytes, size_t length);
bool api_upload_end(api_exchange *x);
/* After a good end: what the building will cost, for api_run_long. */
uint64_t api_upload_elements(const api_exchange *x);
/* A file that is read as a whole, which api_upload_build does, may make much of few bytes: its
 * elements are guessed. */
bool api_upload_is_guessed(const api_exchange *x);
bool api_upload_build(api_exchange *x, he_mesh **out);
/* The name the document or ?name= gives, NULL when there is none. */
const char *api_upload_name(const api_exchange *x);
/* The member "import" of an object that is open. After a good build. */
void api_upload_write_report(api_exchange *x);

#endif
