/* job.h - the description of a job: a request that outlives its connection (job_table.h). */
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

/* The number of headers that a job keeps of its answer; api_job_header_names has their names. */
enum { API_JOB_HEADERS = 4 };
extern const char *const api_job_header_names[API_JOB_HEADERS];

/* The description of a job. */
typedef struct api_job {
    char id[API_JOB_ID + 1]; /* id of the job: random, so that no client can guess it */
    /* The name of the token of the request that started the job; "" if the request had no token. */
    char holder[API_TOKEN_NAME + 1];
    uint64_t number; /* number of the job: jobs are numbered from 1 in the order of submission */
    api_job_state state;
    const char *operation; /* operationId of the request's route */
    /* What the work of the job is doing now, such as "writing"; "" before it runs. */
    const char *phase;
    double progress;           /* fraction of the work that is done, 0 to 1; never decreases */
    char mesh[ST_MESH_ID + 1]; /* id of the job's mesh; "" while the mesh has no id */
    /* The times at which the job was submitted, was started and ended, in seconds since 1970 UTC; 0
     * if that has not happened yet. */
    double created, started, finished;
    int status;                      /* HTTP status of the job's answer; 0: no answer yet */
    char location[API_JOB_LOCATION]; /* value of the answer's header Location; "": none */
    /* The answer's body, valid only while the callback that got this struct runs; NULL: there is no
     * answer yet, or it was not kept. */
    const char *body;
    size_t length;
    /* The answer's body, if it is not in `body`; valid only while the callback runs. */
    api_blob blob;
    bool shown; /* true if `body` is JSON that GET /v1/jobs/{job} shows as a part of the job */
    /* The values of the answer's headers, in the order of api_job_header_names, valid as long as
     * `body`; NULL for a header that the answer does not have. */
    const char *headers[API_JOB_HEADERS];
} api_job;

#endif
