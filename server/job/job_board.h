/* job_board.h - work that outlives its request: runs it, knows how far it is, keeps how it ended.
 * Fills in api/job/jobs.h.
 *
 * A job runs on the pool it shares with requests that are merely long. What it would have answered
 * is kept for a while, within SRV_JOBS_KEPT jobs and SRV_JOBS_BYTES of answers: the ones that ended
 * first go first. Everything else of it is freed before it shows its end.
 *
 * One lock, held for as long as it takes to copy an answer. Progress goes past it. It is taken by
 * those who hold a mesh's, when progress has come far enough for listeners: so no mesh's is taken
 * under it, and no work freed. */
#ifndef HE_SERVER_JOB_JOB_BOARD_H
#define HE_SERVER_JOB_JOB_BOARD_H

#include "api/request/api.h"
#include "server/store/store.h"

typedef struct srv_board srv_board;

enum {
    SRV_JOBS_KEPT = 1000,      /* jobs, those that wait and run included */
    SRV_JOBS_BYTES = 64 << 20, /* of answers */
    SRV_JOB_SECONDS = 3600,    /* how long one that has ended is kept */
    SRV_JOB_LISTENERS = 1000   /* clients that listen to jobs */
};

typedef struct srv_board_options {
    srv_store *store; /* tells what is durable */
    /* Run the task on another thread, or later; false when too much waits already. */
    bool (*submit)(void *pool, const srv_task *task);
    void *pool;
    double keep; /* seconds */
} srv_board_options;

/* NULL when memory is out. */
srv_board *srv_board_new(const srv_board_options *options);
/* Nothing may run or wait in the pool any more. */
void srv_board_free(srv_board *board);
/* The functions of api/job/jobs.h over this board. */
api_jobs srv_board_interface(srv_board *board);
/* Cancel everything, and take nothing more. */
void srv_board_stop(srv_board *board);

#endif
