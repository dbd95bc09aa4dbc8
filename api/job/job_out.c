#include "api/job/job_out.h"

#include "api/event/events.h"
#include "api/limits.h"

#include <math.h>
#include <stdio.h>

/* Progress is written as a multiple of 1 / STEPS. */
static const double STEPS = 10000;

static const char *const states[] = {
    [API_JOB_QUEUED] = "queued", [API_JOB_RUNNING] = "running",     [API_JOB_DONE] = "done",
    [API_JOB_FAILED] = "failed", [API_JOB_CANCELLED] = "cancelled",
};

const char *api_job_state_name(api_job_state state)
{
    return states[state];
}

void api_job_result_path(const api_job *job, char out[API_JOB_RESULT_PATH])
{
    out[0] = '\0';
    if (job->state == API_JOB_DONE && (job->body != NULL || job->blob.self != NULL)) {
        snprintf(out, API_JOB_RESULT_PATH, "/v1/jobs/%s/result", job->id);
    }
}

/* A job with the values of its JSON members that are not in api_job. */
typedef struct shown {
    api_job job;
    const char *state;
    bool has_status, has_result, has_problem;
    double progress;
    char link[API_JOB_RESULT_PATH];
} shown;

/* Writes the body of the job's answer if it is JSON that the job shows, else null. */
static void write_body(api_out *out, const void *value)
{
    const api_job *job = &((const shown *)value)->job;
    if (job->body == NULL || !job->shown) {
        api_out_null(out);
    } else {
        api_out_raw(out, job->body, job->length);
    }
}

static const api_field job_fields[] = {
    API_FIELD("id", "text", shown, job.id, .required = true,
              .doc = "The id of the job. Only the token that started the job may see and cancel "
                     "it; on a server without tokens, every client that knows the id may."),
    API_FIELD("operation", "text", shown, job.operation, .required = true,
              .doc = "The operationId of the request."),
    API_FIELD("state", "#job_state", shown, state, .required = true),
    API_FIELD("phase", "text?", shown, job.phase, .required = true, .zero_is_none = true,
              .doc = "What the job is doing now or, if the job has ended, what it did last."),
    API_FIELD("progress", "number", shown, progress, .required = true,
              .doc = "How much of the work is done, from 0 to 1; it never decreases."),
    API_FIELD("mesh", "text?", shown, job.mesh, .required = true, .zero_is_none = true,
              .doc = "The id of the mesh that the job works on; null if the job makes a mesh that "
                     "has no id yet."),
    API_FIELD("created", "time", shown, job.created, .required = true),
    API_FIELD("started", "time?", shown, job.started, .required = true, .zero_is_none = true),
    API_FIELD("finished", "time?", shown, job.finished, .required = true, .zero_is_none = true),
    API_FIELD("status", "integer?", shown, job.status, .required = true,
              .known = API_KNOWN(shown, has_status),
              .doc = "The HTTP status with which the request would have been answered."),
    API_FIELD("location", "text?", shown, job.location, .required = true, .zero_is_none = true,
              .doc = "The header Location with which the request would have been answered."),
    API_FIELD("result_link", "text?", shown, link, .required = true, .zero_is_none = true,
              .doc = "The path from which GET fetches the result without the rest of the job; null "
                     "while there is no result."),
    API_FIELD_MADE("result", "#job_result?", write_body, .known = API_KNOWN(shown, has_result),
                   .doc =
                       "The body with which the request would have been answered; null if it has "
                       "none, or the body is not JSON, is a whole mesh, or is too large to keep."),
    API_FIELD_MADE("problem", "#problem?", write_body, .known = API_KNOWN(shown, has_problem),
                   .doc = "The problem, if the job failed."),
};
const api_record api_job_record = API_RECORD("job", job_fields);

static const api_field state_fields[] = {
    API_FIELD("id", "text", shown, job.id, .required = true),
    API_FIELD("state", "#job_state", shown, state, .required = true),
    API_FIELD("progress", "number", shown, progress, .required = true,
              .doc = "How much of the work is done, from 0 to 1."),
};
const api_record api_job_state_record = API_RECORD("job_state_told", state_fields);

/* Computes the values of a job's JSON members; `whole` includes the body of the answer. */
static void show(const api_job *job, bool whole, shown *out)
{
    const bool ended = job->state >= API_JOB_DONE;
    *out = (shown){.job = *job,
                   .state = states[job->state],
                   .has_status = ended && job->status != 0,
                   .has_result = whole && job->state == API_JOB_DONE,
                   .has_problem = whole && ended && job->state != API_JOB_DONE,
                   .progress = floor(job->progress * STEPS) / STEPS};
    api_job_result_path(job, out->link);
    if (!ended) {
        out->job.location[0] = '\0';
    }
}

void api_write_job(api_out *out, const api_job *job, bool whole)
{
    shown value;
    show(job, whole, &value);
    api_record_write(out, &api_job_record, &value);
}

void api_event_job_state(api_text *text, const api_job *job)
{
    shown value;
    show(job, false, &value);
    api_event_record(text, "job", &api_job_state_record, &value);
}

void api_event_job(api_text *text, const api_job *job, bool bye)
{
    if (bye) {
        api_event_bye(text, job->state >= API_JOB_DONE ? "ended" : "stopping");
        return;
    }
    shown value;
    show(job, job->length <= API_MAX_EVENT, &value);
    api_event_record(text, "job", &api_job_record, &value);
}
