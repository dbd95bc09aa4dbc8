/* prefer.h - the Prefer header (RFC 7240): what a client would rather have. */
#ifndef HE_API_HEADER_PREFER_H
#define HE_API_HEADER_PREFER_H

#include <stdbool.h>

typedef struct api_prefer {
    bool minimal;       /* return=minimal */
    bool respond_async; /* 202 and a job, rather than to wait */
    double wait;        /* wait=N, seconds the client has; negative: not said */
} api_prefer;

/* `header` may be NULL. What is not understood is passed over, as the RFC wants. */
api_prefer api_prefer_read(const char *header);

#endif
