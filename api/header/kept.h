/* kept.h - a body that never changes: its bytes, its tag, and its compressed forms.
 *
 * Each form is compressed once, when it is first asked for, and is then kept as long as the body.
 * Without that, a thousand clients that ask for the same page at once would each cost the time of a
 * compression. All functions may be called from any thread. */
#ifndef HE_API_HEADER_KEPT_H
#define HE_API_HEADER_KEPT_H

#include "api/header/content_coding.h"

#include <stddef.h>

typedef struct api_kept api_kept;

/* Makes a body of `length` bytes, which are copied. Returns NULL when memory is out. */
api_kept *api_kept_new(const char *bytes, size_t length);
void api_kept_free(api_kept *kept); /* NULL is allowed */

/* Sets `bytes` and `length` to the uncompressed body, which is valid as long as `kept`. */
void api_kept_bytes(const api_kept *kept, const char **bytes, size_t *length);
/* Returns the entity tag, quoted. Equal bodies have equal tags. */
const char *api_kept_etag(const api_kept *kept);
/* Sets `bytes` and `length` to the body in a coding other than identity, valid as long as `kept`.
 * It may be longer than the body. Returns false when memory is out; a later call tries again. */
bool api_kept_coded(api_kept *kept, api_coding coding, const char **bytes, size_t *length);

#endif
