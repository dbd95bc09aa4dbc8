/* prefer.h - reads the header Prefer (RFC 7240), by which a client says how it would like to be
 * answered. */
#ifndef HE_API_HEADER_PREFER_H
#define HE_API_HEADER_PREFER_H

#include <stdbool.h>

typedef struct api_prefer {
    bool minimal;       /* return=minimal: the client wants no body */
    bool respond_async; /* respond-async: the client wants 202 and a job rather than to wait */
    double wait;        /* wait=N: seconds that the client will wait; negative: not given */
} api_prefer;

/* Reads the header Prefer, which may be NULL. Unknown preferences are ignored, as the RFC
 * demands. */
api_prefer api_prefer_read(const char *header);

#endif
