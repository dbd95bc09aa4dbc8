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

static void write_text(api_out *out, const char *key, const char *text)
{
    if (text[0] == '\0') {
        api_out_key_null(out, key);
    } else {
        api_out_key_string(out, key, text);
    }
}

static void write_time(api_out *out, const char *key, double seconds)
{
    if (seconds == 0) {
        api_out_key_null(out, key);
    } else {
        api_out_key_time(out, key, seconds);
    }
}

/* Writes the answer of the job's request, once the job has ended. */
static void write_answer(api_out *out, const api_job *job, bool whole)
{
    bool ended = job->state >= API_JOB_DONE;
    api_out_key(out, "status");
    if (!ended || job->status == 0) {
        api_out_null(out);
    } else {
        api_out_u64(out, (uint64_t)job->status);
    }
    write_text(out, "location", ended ? job->location : "");
    char path[API_JOB_RESULT_PATH];
    api_job_result_path(job, path);
    write_text(out, "result_link", path);
    if (!whole || !ended) {
        return;
    }
    api_out_key(out, job->state == API_JOB_DONE ? "result" : "problem");
    if (job->body == NULL || !job->shown) {
        api_out_null(out);
    } else {
        api_out_raw(out, job->body, job->length);
    }
}

static void write_progress(api_out *out, const api_job *job)
{
    api_out_key_number(out, "progress", floor(job->progress * STEPS) / STEPS);
}

static void write_job_state(api_out *out, const api_job *job)
{
    api_out_key_string(out, "id", job->id);
    api_out_key_string(out, "state", states[job->state]);
    write_progress(out, job);
}

void api_write_job(api_out *out, const api_job *job, bool whole)
{
    api_out_object_begin(out);
    api_out_key_string(out, "id", job->id);
    api_out_key_string(out, "operation", job->operation);
    api_out_key_string(out, "state", states[job->state]);
    write_text(out, "phase", job->phase);
    write_progress(out, job);
    write_text(out, "mesh", job->mesh);
    write_time(out, "created", job->created);
    write_time(out, "started", job->started);
    write_time(out, "finished", job->finished);
    write_answer(out, job, whole);
    api_out_object_end(out);
}

void api_event_job_state(api_text *text, const api_job *job)
{
    api_text data = {0};
    api_out out;
    api_out_init(&out, &data);
    api_out_object_begin(&out);
    write_job_state(&out, job);
    api_out_object_end(&out);
    api_event_add(text, "job", &data);
    api_text_clear(&data);
}

void api_event_job(api_text *text, const api_job *job, bool bye)
{
    api_text data = {0};
    api_out out;
    if (bye) {
        api_event_bye(text, job->state >= API_JOB_DONE ? "ended" : "stopping");
        return;
    }
    api_out_init(&out, &data);
    api_write_job(&out, job, job->length <= API_MAX_EVENT);
    api_event_add(text, "job", &data);
    api_text_clear(&data);
}
