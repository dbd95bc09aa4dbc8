/* job_out.h - how a job is written. */
#ifndef HE_API_JOB_JOB_OUT_H
#define HE_API_JOB_JOB_OUT_H

#include "api/job/job.h"
#include "api/json/json_out.h"

const char *api_job_state_name(api_job_state state);
/* Where the answer of a job is fetched by itself; "" where it has none, or none yet. */
enum { API_JOB_RESULT_PATH = sizeof "/v1/jobs//result" + API_JOB_ID };
void api_job_result_path(const api_job *job, char out[API_JOB_RESULT_PATH]);
/* The object; `whole` with its result or problem, which may be large. */
void api_write_job(api_out *out, const api_job *job, bool whole);
/* How a job is, as an event for those who listen to its mesh. */
void api_event_job_state(api_text *text, const api_job *job);
/* The news of a job as an event of its own stream: `bye` after the last. The result comes along
 * where an event may be as large; it is always at the job itself. */
void api_event_job(api_text *text, const api_job *job, bool bye);

#endif
