/* jobs.h - a few threads that may block, and a bounded queue before them.
 *
 * What takes longer than a worker may be kept from its other connections runs here. A full queue
 * refuses: the caller answers 503 rather than let work pile up. */
#ifndef HE_SERVER_JOBS_H
#define HE_SERVER_JOBS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_jobs srv_jobs;

/* NULL when memory or threads are out. */
srv_jobs *srv_jobs_new(size_t threads, size_t queue);
/* Runs what is queued, then ends. */
void srv_jobs_free(srv_jobs *jobs);
/* Run work(context) on some thread, in the order of submission. False when the queue is full. */
bool srv_jobs_submit(srv_jobs *jobs, void (*work)(void *context), void *context);

#endif
