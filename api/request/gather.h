/* gather.h - the whole of an answer that is pulled.
 *
 * What a job would have answered is kept until it is fetched, when the stream that makes it is
 * gone: it is read to its end while the job runs. */
#ifndef HE_API_REQUEST_GATHER_H
#define HE_API_REQUEST_GATHER_H

#include "api/request/exchange.h"

/* The answer that is pulled becomes one of bytes, in x->text; a blob and others stay as they are.
 * The problem is filled without memory, when the stream fails, and when the watch gives up. */
void api_gather(api_exchange *x);

#endif
