/* gather.h - reading a streamed answer into memory.
 *
 * A job keeps its answer until a client fetches it, but a stream lives only as long as its
 * exchange. So the stream is read to its end while the job runs. */
#ifndef HE_API_REQUEST_GATHER_H
#define HE_API_REQUEST_GATHER_H

#include "api/request/exchange.h"

/* Reads a streamed answer into x->text; all other answers, such as blobs, stay as they are. Fills
 * the problem when memory is out, when the stream fails, and when the work is cancelled. */
void api_gather(api_exchange *x);

#endif
