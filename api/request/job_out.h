/* job_out.h - how a job is written. */
#ifndef HE_API_REQUEST_JOB_OUT_H
#define HE_API_REQUEST_JOB_OUT_H

#include "api/request/exchange.h"

/* The members that say how it is: id, state and progress. */
void api_write_job_state(api_out *out, const api_job *job);
/* The object; `whole` with its result or problem, which may be large. */
void api_write_job(api_out *out, const api_job *job, bool whole);
/* 202 with the job and its place. */
void api_answer_job(api_exchange *x, const api_job *job);

#endif
