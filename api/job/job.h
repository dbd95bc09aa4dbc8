/* job.h - what is known of a job: a request that outlives its connection (job_table.h). */
#ifndef HE_API_JOB_JOB_H
#define HE_API_JOB_JOB_H

#include "api/blob.h"
#include "api/token/token.h"
#include "journal/journal.h"

typedef enum api_job_state {
    API_JOB_QUEUED,
    API_JOB_RUNNING,
    API_JOB_DONE,
    API_JOB_FAILED,
    API_JOB_CANCELLED
} api_job_state;

enum { API_JOB_STATES = API_JOB_CANCELLED + 1 };

enum { API_JOB_ID = ST_JOB_ID, API_JOB_LOCATION = sizeof "/v1/meshes/" + ST_MESH_ID };

/* Headers of the answer that are kept with it, in the order of api_job_header_names. */
enum { API_JOB_HEADERS = 4 };
extern const char *const api_job_header_names[API_JOB_HEADERS];

/* What is known of a job. */
typedef struct api_job {
    char id[API_JOB_ID + 1];         /* unguessable */
    char holder[API_TOKEN_NAME + 1]; /* name of the token that began it, "" for that of nobody */
    uint64_t number;                 /* in the order of submission, from 1 */
    api_job_state state;
    const char *operation;             /* name of the route's row */
    const char *phase;                 /* of the work, "" before it runs */
    double progress;                   /* 0 to 1, never falls */
    char mesh[ST_MESH_ID + 1];         /* "" while it has no id */
    double created, started, finished; /* seconds since 1970 UTC; 0: not yet */
    int status;                        /* HTTP, of the answer; 0: there is none */
    char location[API_JOB_LOCATION];   /* likewise; "" where it has none */
    const char *body;                  /* lent for the call; NULL: none, or not kept */
    size_t length;
    api_blob blob;                        /* lent: where the answer lies, if not in `body` */
    bool shown;                           /* the body is JSON, and a part of what is told of it */
    const char *headers[API_JOB_HEADERS]; /* lent for the call; NULL where it has none */
} api_job;

#endif
