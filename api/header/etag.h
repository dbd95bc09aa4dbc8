/* etag.h - entity tags and the preconditions that use them (RFC 9110 sections 8.8.3 and 13).
 *
 * A tag is "INCARNATION-METADATA-REVISION-REPRESENTATION". The first three parts change with the
 * mesh. REPRESENTATION is one word for what was sent ("summary", "obj", "page"), followed by the
 * content coding if the answer has one ("obj-gzip"). Tags are strong: two answers of one URL with
 * equal tags are equal byte for byte (RFC 9110 8.8.3.3). */
#ifndef HE_API_HEADER_ETAG_H
#define HE_API_HEADER_ETAG_H

#include "api/header/content_coding.h"
#include "store/store.h"

enum { API_ETAG = 128 };

void api_etag_write(const st_mesh_info *info, const char *representation, char out[API_ETAG]);

/* Adds the content coding to an entity tag: "...-obj" becomes "...-obj-gzip". */
void api_etag_code(const char *etag, api_coding coding, char out[API_ETAG]);

/* Evaluates If-None-Match: returns true if the header is "*" or lists this tag, possibly with W/ or
 * with the suffix of an allowed coding. Sets `found` to that coding, or to identity. */
bool api_etag_listed(const char *header, const char *etag, const api_codings *codings,
                     api_coding *found);

/* Evaluates If-Match of a write: returns true if the header is "*" or lists a tag of the mesh's
 * present state, of any representation. A weak tag (W/) never matches. */
bool api_etag_is_present(const char *header, const st_mesh_info *info);

#endif
