/* upload.h - makes a mesh from a request's body: a JSON document, the name of a shape, or a mesh
 * file, alone or together with the files that it refers to (parts.h).
 *
 * The bytes go to a reader as they arrive; the whole body is never kept. The reader is chosen by
 * ?format=, else by Content-Type, else (application/octet-stream) by the first bytes.
 *
 *     api_upload_begin    before the body
 *     api_upload_feed     per piece
 *     api_upload_end      checks that the body is complete and, unless its format is read only by
 *                         api_upload_build, well formed
 *     api_upload_build    makes the mesh; on the job pool if it is large
 *
 * The state is in x->state. Functions that fail return false with the problem filled. */
#ifndef HE_API_DOCUMENT_UPLOAD_H
#define HE_API_DOCUMENT_UPLOAD_H

#include "api/json/record.h"
#include "api/request/exchange.h"

/* The JSON members of the report of an import, and of a warning in it. */
extern const api_record api_import_record, api_warning_record;

bool api_upload_begin(api_exchange *x);
bool api_upload_feed(api_exchange *x, const char *bytes, size_t length);
bool api_upload_end(api_exchange *x);
/* Returns with how many elements api_upload_build will have to work, for api_run_long. It must be
 * called after api_upload_end has returned true. */
uint64_t api_upload_elements(const api_exchange *x);
/* Returns true if api_upload_elements is only a guess, because the file will be read by
 * api_upload_build. A few bytes of such a file may become many elements. */
bool api_upload_is_guessed(const api_exchange *x);
bool api_upload_build(api_exchange *x, he_mesh **out);
/* Returns the name that ?name= or the document gives to the mesh, or NULL. */
const char *api_upload_name(const api_exchange *x);
/* Writes the member "import" into an object that the caller has begun, after api_upload_build
 * returned true. */
void api_upload_write_report(api_exchange *x);

#endif
