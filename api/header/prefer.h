/* prefer.h - reads the header Prefer (RFC 7240), by which a client says how it would like to be
 * answered. */
#ifndef HE_API_HEADER_PREFER_H
#define HE_API_HEADER_PREFER_H

#include <stdbool.h>

typedef struct api_prefer {
    bool minimal; /* true if the header has return=minimal: the client wants no body */
    /* True if the header has respond-async: the client wants 202 and a job rather than to wait. */
    bool respond_async;
    /* The N of wait=N: seconds that the client will wait; negative: not given. */
    double wait;
} api_prefer;

/* Reads the header Prefer, which may be NULL. Unknown preferences are ignored, as the RFC
 * demands. */
api_prefer api_prefer_read(const char *header);

#endif
