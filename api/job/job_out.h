/* job_out.h - writes jobs as JSON and as events. */
#ifndef HE_API_JOB_JOB_OUT_H
#define HE_API_JOB_JOB_OUT_H

#include "api/job/job.h"
#include "api/json/record.h"

/* The JSON members of a job, and of the event "job" that the listeners of its mesh get. */
extern const api_record api_job_record, api_job_state_record;

const char *api_job_state_name(api_job_state state);
/* Writes the path from which the job's answer can be fetched; "" if the job has not ended with an
 * answer that has a body. */
enum { API_JOB_RESULT_PATH = sizeof "/v1/jobs//result" + API_JOB_ID };
void api_job_result_path(const api_job *job, char out[API_JOB_RESULT_PATH]);
/* Writes a job as an object; if `whole` is true, with its result or its problem, which may be
 * large. */
void api_write_job(api_out *out, const api_job *job, bool whole);
/* Writes the state of a job as an event for listeners of its mesh. */
void api_event_job_state(api_text *text, const api_job *job);
/* Writes an event of a job's own stream: the event "job", or, if `bye` is true, the event "bye",
 * which ends the stream. The job's result is included if it fits into an event; GET of the job
 * always shows the result. */
void api_event_job(api_text *text, const api_job *job, bool bye);

#endif
