/* kept.h - a body that never changes, such as a file of the web page: its bytes, its entity tag,
 * and its compressed forms.
 *
 * Each compressed form is made once, when it is first needed, and is then kept as long as the body.
 * So it may be compressed as well as possible, which takes about 40 ms for a body of a megabyte,
 * and a thousand clients that request the body at once need not wait for a thousand compressions.
 * All functions may be called from any thread. A body has less than a gigabyte. */
#ifndef HE_API_HEADER_KEPT_H
#define HE_API_HEADER_KEPT_H

#include "api/header/content_coding.h"

#include <stddef.h>

typedef struct api_kept api_kept;

/* Makes a body of `length` bytes, which are copied. Returns NULL when memory is out. */
api_kept *api_kept_new(const char *bytes, size_t length);
void api_kept_free(api_kept *kept); /* takes NULL */

/* Sets `bytes` and `length` to the uncompressed body, which is valid as long as `kept`. */
void api_kept_bytes(const api_kept *kept, const char **bytes, size_t *length);
/* Returns the entity tag, quoted. Equal bodies have equal tags. */
const char *api_kept_etag(const api_kept *kept);
/* Sets `bytes` and `length` to the body in a coding other than identity, valid as long as `kept`.
 * The compressed form may be longer than the body. Returns false when memory is out; a later call
 * tries to compress it again. */
bool api_kept_coded(api_kept *kept, api_coding coding, const char **bytes, size_t *length);

#endif
