/* media.h - the headers about media types: Content-Type, Accept, Prefer. RFC 9110 section 12, 7240.
 */
#ifndef HE_API_HEADER_MEDIA_H
#define HE_API_HEADER_MEDIA_H

#include <stdbool.h>
#include <stddef.h>

/* A body of several files, see multipart.h. */
#define API_MULTIPART "multipart/form-data"

/* Does a Content-Type name this type ("application/json")? Letter case and parameters do not
 * matter, but a charset must be UTF-8. */
bool api_media_is(const char *content_type, const char *type);

/* The index of the type in `offers` (ends in NULL) that an Accept header likes best: by q, then by
 * the order of the offers; -1 when all are refused. A header of NULL accepts everything. The most
 * specific range that matches an offer gives its q, as RFC 9110 12.5.1 says. A range that is not
 * well formed is passed over. */
int api_media_choose(const char *accept, const char *const *offers);

/* One entry of a list such as Accept-Encoding, "gzip;q=0.5". */
enum { API_WEIGHED_NAME = 31 };
typedef struct api_weighed {
    char name[API_WEIGHED_NAME + 1]; /* "?" where it is longer */
    int q;                           /* thousandths; -1 where it is not well formed */
} api_weighed;

/* Step through such a list, which may be NULL; empty entries are passed over. False at the end. */
bool api_media_next(const char **at, api_weighed *out);

/* Does a comma separated header hold this token, letter case aside ("return=minimal")? */
bool api_header_has(const char *header, const char *token);

/* ASCII letter case aside. */
bool api_equal_nocase(const char *a, const char *b);

#endif
