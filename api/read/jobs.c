/* jobs.c - GET and DELETE /v1/jobs: the state and the results of work that was answered 202. */
#include "api/event/events.h"
#include "api/job/job_out.h"
#include "api/read/records.h"
#include "api/request/handlers.h"
#include "format/text/number.h"

#include <stdio.h>
#include <string.h>

static void fail_absent(api_exchange *x)
{
    api_fail(x, API_NO_SUCH_JOB, "no job has the id \"%.60s\"", x->job_id);
}

static api_job_wanted wanted(const api_exchange *x)
{
    return (api_job_wanted){.viewer = x->token, .id = x->job_id};
}

static void show_whole(void *context, const api_job *job)
{
    api_exchange *x = context;
    api_write_job(&x->out, job, true);
}

void api_job_get(api_exchange *x)
{
    api_job_table *jobs = x->service->options.jobs;
    if (jobs == NULL || !api_job_find(jobs, wanted(x), show_whole, x)) {
        fail_absent(x);
        return;
    }
    api_answer_json(x, 200);
}

/* Adds the headers that were kept with a job's answer, except Content-Type and ETag, which are set
 * elsewhere. */
static void answer_kept_headers(api_exchange *x, const api_job *job)
{
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        const char *name = api_job_header_names[i];
        if (job->headers[i] != NULL && strcmp(name, "Content-Type") != 0 &&
            strcmp(name, "ETag") != 0) {
            api_answer_header(x, name, job->headers[i]);
        }
    }
}

static const char *kept_header(const api_job *job, const char *name)
{
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        if (strcmp(name, api_job_header_names[i]) == 0) {
            return job->headers[i];
        }
    }
    return NULL;
}

static void return_loan(void *state)
{
    api_job_return(state);
}

void api_job_result(api_exchange *x)
{
    api_job_table *jobs = x->service->options.jobs;
    api_job job;
    char path[API_JOB_RESULT_PATH];
    x->state = jobs == NULL ? NULL : api_job_lend(jobs, wanted(x), &job);
    if (x->state == NULL) {
        fail_absent(x);
        return;
    }
    x->free_state = return_loan;
    api_job_result_path(&job, path);
    if (job.state < API_JOB_DONE) {
        api_write_job(&x->out, &job, true);
        api_answer_json(x, 202);
    } else if (path[0] == '\0') {
        api_fail(x, API_NO_SUCH_RESULT, "the job is %s, so it has no answer to fetch",
                 api_job_state_name(job.state));
    } else {
        const char *tag = kept_header(&job, "ETag");
        if (tag == NULL || !api_not_modified_since(x, tag)) {
            answer_kept_headers(x, &job);
            const char *type = kept_header(&job, "Content-Type");
            if (job.blob.self != NULL) {
                api_answer_blob(x, 200, type, &job.blob);
            } else {
                api_answer_bytes(x, 200, type, job.body, job.length);
            }
        }
    }
}

void api_job_delete(api_exchange *x)
{
    api_job_table *jobs = x->service->options.jobs;
    bool forgotten = false;
    const st_status status =
        jobs == NULL ? ST_ABSENT : api_job_remove(jobs, wanted(x), &forgotten, show_whole, x);
    if (status == ST_ABSENT) {
        fail_absent(x);
    } else if (status != ST_OK) {
        api_fail_store(x, status);
    } else if (forgotten) {
        api_answer_empty(x, 204);
    } else {
        api_answer_json(x, 202);
    }
}

void api_job_events(api_exchange *x)
{
    api_job_table *jobs = x->service->options.jobs;
    api_source source;
    st_status status = jobs == NULL ? ST_ABSENT : api_job_follow(jobs, wanted(x), &source);
    if (status == ST_ABSENT) {
        fail_absent(x);
    } else if (status != ST_OK) {
        api_fail_store(x, status);
    } else {
        api_answer_live(x, 200, "text/event-stream", &source);
        api_answer_header(x, "X-Accel-Buffering", "no");
    }
}

/* The state of writing one page of the list of jobs. */
typedef struct page {
    api_out *out;
    uint64_t last; /* number of the last job on the page */
    bool more;     /* there is a next page */
} page;

static void show_brief(void *context, const api_job *job)
{
    page *p = context;
    api_write_job(p->out, job, false);
    p->last = job->number;
}

/* The values of the JSON members of an answer. The rows are written in order, so `next` is written
 * after `items` have filled in what the page ends with. */
typedef struct shown_page {
    api_exchange *x;
    api_job_page asked;
    page *page;
} shown_page;

static void write_items(api_out *out, const void *value)
{
    const shown_page *shown = value;
    api_job_table *jobs = shown->x->service->options.jobs;
    api_out_array_begin(out);
    shown->page->more = jobs != NULL && api_job_list(jobs, &shown->asked, show_brief, shown->page);
    api_out_array_end(out);
}

static void write_next(api_out *out, const void *value)
{
    const shown_page *shown = value;
    if (!shown->page->more) {
        api_out_null(out);
        return;
    }
    char cursor[32];
    snprintf(cursor, sizeof cursor, "j%llu", (unsigned long long)shown->page->last);
    api_out_string(out, cursor);
    api_answer_header_format(shown->x, "Link", "</v1/jobs?limit=%zu&cursor=%s>; rel=\"next\"",
                             shown->asked.limit, cursor);
}

static const api_field page_fields[] = {
    API_FIELD_MADE("items", "*#job", write_items, .required = true),
    API_FIELD_MADE("next", "text?", write_next, .required = true,
                   .doc = "The cursor of the next page."),
};
const api_record api_job_page_record = API_RECORD("job_page", page_fields);

/* Reads the cursor of a page: the number of the last job, after a letter that keeps clients from
 * using a job's number as a cursor. */
static bool read_cursor(api_exchange *x, uint64_t *after)
{
    const char *cursor = api_param_text(x, "cursor");
    size_t used = 0;
    *after = 0;
    if (cursor == NULL) {
        return true;
    }
    if (cursor[0] != 'j' ||
        he_u64_parse(cursor + 1, cursor + strlen(cursor), after, &used) != HE_OK ||
        used != strlen(cursor) - 1) {
        return api_fail(x, API_BAD_CURSOR,
                        "the cursor \"%.60s\" does not belong to the list of jobs", cursor);
    }
    return true;
}

void api_jobs_list(api_exchange *x)
{
    page p = {.out = &x->out};
    shown_page shown = {
        .x = x,
        .asked = {.viewer = x->token, .limit = (size_t)api_param_u64(x, "limit", API_DEFAULT_JOBS)},
        .page = &p};
    if (read_cursor(x, &shown.asked.after)) {
        api_record_write(&x->out, &api_job_page_record, &shown);
        api_answer_json(x, 200);
    }
}
