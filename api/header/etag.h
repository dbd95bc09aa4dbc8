/* etag.h - entity tags and the preconditions made of them. RFC 9110 section 8.8.3 and 13.
 *
 * A tag is "INCARNATION-METADATA-REVISION-REPRESENTATION": the first three are the facts of a mesh
 * that change with it, the last one word for what was sent ("summary", "obj", "page"), with
 * the content coding where it has one ("obj-gzip"). It is strong: two answers of one URL with equal
 * tags are equal byte for byte (8.8.3.3). */
#ifndef HE_API_HEADER_ETAG_H
#define HE_API_HEADER_ETAG_H

#include "api/header/coding.h"
#include "store/store.h"

enum { API_ETAG = 128 };

void api_etag_write(const st_mesh_info *info, const char *representation, char out[API_ETAG]);

/* The same of an answer with this content coding: "...-obj-gzip". */
void api_etag_code(const char *etag, api_coding coding, char out[API_ETAG]);

/* If-None-Match: does the list hold this tag (W/ aside) in a coding that is allowed, or is it "*"?
 * `found` is the coding, identity with "*". */
bool api_etag_listed(const char *header, const char *etag, const api_codings *codings,
                     api_coding *found);

/* If-Match of a write: does the list name the present state in any representation, or is it "*"?
 * A weak tag never matches. */
bool api_etag_is_present(const char *header, const st_mesh_info *info);

#endif
