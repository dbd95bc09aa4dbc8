/* media.h - the headers about media types: Content-Type and Accept (RFC 9110 section 12), and lists
 * of weighted entries such as Accept-Encoding.
 */
#ifndef HE_API_HEADER_MEDIA_H
#define HE_API_HEADER_MEDIA_H

#include <stdbool.h>
#include <stddef.h>

/* The media type of a body that contains several files (multipart.h). */
#define API_MULTIPART "multipart/form-data"

/* Returns true if the value of a Content-Type is this type ("application/json"). Letter case and
 * parameters are ignored, but a charset must be UTF-8. */
bool api_media_is(const char *content_type, const char *type);

/* Returns the index in `offers` (which ends in NULL) of the type that an Accept header prefers: the
 * one with the highest q, and the first of those with equal q. Returns -1 if the header refuses all
 * offers. A NULL header accepts everything. The q of an offer is that of the most specific range of
 * the header that matches it (RFC 9110 12.5.1). Malformed ranges are skipped. */
int api_media_choose(const char *accept, const char *const *offers);

/* One entry of a weighted list such as Accept-Encoding: "gzip;q=0.5". */
enum { API_WEIGHED_NAME = 31 };
typedef struct api_weighed {
    char name[API_WEIGHED_NAME + 1]; /* "?" for a longer name */
    int q;                           /* the weight in thousandths; -1: malformed */
} api_weighed;

/* Steps through a weighted list, which may be NULL; empty entries are skipped. Returns false at the
 * end. */
bool api_media_next(const char **at, api_weighed *out);

/* Returns true if a header, which is a comma-separated list, contains this entry
 * ("return=minimal"). Letter case is ignored. */
bool api_header_has(const char *header, const char *token);

/* Returns true if two strings are equal apart from the case of ASCII letters. */
bool api_equal_nocase(const char *a, const char *b);

#endif
