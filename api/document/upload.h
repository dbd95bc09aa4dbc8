/* upload.h - a body that becomes a mesh: a JSON document, the name of a shape, or a mesh file,
 * alone or among the files that it refers to (parts.h).
 *
 * The bytes go to a reader as they arrive; the mesh file is not kept. The reader is chosen by
 * ?format=, else by Content-Type, else (application/octet-stream) by the first bytes.
 *
 *     api_upload_begin    before the body
 *     api_upload_feed     per piece
 *     api_upload_end      the body is whole and, unless its format is read at the end, well formed
 *     api_upload_build    makes the mesh; on the job pool if it is large
 *
 * The exchange holds the state. All functions return false with the problem filled. */
#ifndef HE_API_DOCUMENT_UPLOAD_H
#define HE_API_DOCUMENT_UPLOAD_H

#include "api/json/record.h"
#include "api/request/exchange.h"

/* The members of the report of an import, and of a warning in it. */
extern const api_record api_import_record, api_warning_record;

bool api_upload_begin(api_exchange *x);
bool api_upload_feed(api_exchange *x, const char *bytes, size_t length);
bool api_upload_end(api_exchange *x);
/* Returns how many elements building the mesh will handle, for api_run_long. It must be called
 * after api_upload_end has returned true. */
uint64_t api_upload_elements(const api_exchange *x);
/* Returns true if the number of elements is only a guess: a file that api_upload_build reads as a
 * whole may expand a few bytes to many elements. */
bool api_upload_is_guessed(const api_exchange *x);
bool api_upload_build(api_exchange *x, he_mesh **out);
/* Returns the name in the document or in ?name=, or NULL. */
const char *api_upload_name(const api_exchange *x);
/* Writes the member "import" into an object that is open, after api_upload_build returned true. */
void api_upload_write_report(api_exchange *x);

#endif
