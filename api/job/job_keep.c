/* job_keep.c - keeps jobs across a restart: stores and loads them.
 *
 * A job is recorded when it is accepted and when it ends. If its work changed a mesh, the journal's
 * record of that change also shows that the job was done. So a job with neither a recorded end nor
 * a recorded change has changed nothing. */
#include "api/job/job_entry.h"
#include "api/json/problem.h"
#include "base/mem.h"
#include "system/clock.h"

#include <stdio.h>
#include <string.h>

/* The largest body of an answer that is kept across a restart, in bytes. */
enum { KEPT_BODY = 64 << 10 };

/* Returns the number that stands for the state in the journal. Journals on disk contain numbers of
 * st_job_state, so that they do not depend on the order of api_job_state. */
static st_job_state kept_state(api_job_state state)
{
    switch (state) {
    case API_JOB_QUEUED:
    case API_JOB_RUNNING:
        return ST_JOB_ACCEPTED;
    case API_JOB_DONE:
        return ST_JOB_DONE;
    case API_JOB_FAILED:
        return ST_JOB_FAILED;
    case API_JOB_CANCELLED:
        break;
    }
    return ST_JOB_CANCELLED;
}

static api_job_state state_of(st_job_state kept)
{
    switch (kept) {
    case ST_JOB_DONE:
        return API_JOB_DONE;
    case ST_JOB_CANCELLED:
        return API_JOB_CANCELLED;
    case ST_JOB_FAILED:
    case ST_JOB_ACCEPTED:
        break;
    }
    return API_JOB_FAILED;
}

static const char *text_of(const char *text)
{
    return text == NULL ? "" : text;
}

const char *api_job_entry_mesh(const api_job *facts)
{
    const char *slash = strrchr(facts->location, '/');
    return slash != NULL && strlen(slash + 1) <= ST_MESH_ID ? slash + 1 : facts->mesh;
}

st_status api_job_keep(api_job_entry *j, uint64_t *position)
{
    const api_job *facts = &j->facts;
    const char *phase = atomic_load(&j->phase);
    st_job job = {.number = facts->number,
                  .state = kept_state(j->end),
                  .operation = facts->operation,
                  .phase = phase,
                  .mesh = api_job_entry_mesh(facts),
                  .location = facts->location,
                  .holder = facts->holder,
                  .progress = j->end == API_JOB_DONE ? 1 : atomic_load(&j->progress),
                  .created = facts->created,
                  .started = facts->started,
                  .finished = j->ended,
                  .status = facts->status,
                  .shown = facts->shown};
    memcpy(job.id, facts->id, sizeof job.id);
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        job.headers[i] = text_of(facts->headers[i]);
    }
    if (facts->body != NULL && facts->length <= KEPT_BODY) {
        job.body = facts->body;
        job.length = facts->length;
    }
    const st_status status = st_job_keep(j->table->options.store, &job, position);
    j->is_kept = j->is_kept || (status == ST_OK && *position != 0);
    return status;
}

st_status api_job_forget(const api_job_entry *j)
{
    uint64_t position;
    return j->is_kept ? st_job_forget(j->table->options.store, j->facts.id, &position) : ST_OK;
}

/* --- loading jobs after a restart --- */

enum { TEXTS = 2 + API_JOB_HEADERS };

/* Copies those texts of a stored job to which api_job only points. Returns false when memory is
 * out. */
static bool copy_texts(api_job_entry *j, const st_job *job)
{
    const char *from[TEXTS] = {job->operation, job->phase};
    const char *to[TEXTS];
    size_t size = 0;
    memcpy(from + 2, job->headers, sizeof job->headers);
    for (size_t i = 0; i < TEXTS; i++) {
        size += strlen(from[i]) + 1;
    }
    j->texts = he_mem_alloc(size);
    if (j->texts == NULL) {
        return false;
    }
    char *at = j->texts;
    for (size_t i = 0; i < TEXTS; i++) {
        const size_t bytes = strlen(from[i]) + 1;
        to[i] = memcpy(at, from[i], bytes);
        at += bytes;
    }
    j->facts.operation = to[0];
    j->facts.phase = to[1];
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        j->facts.headers[i] = to[2 + i][0] == '\0' ? NULL : to[2 + i];
    }
    return true;
}

static bool copy_body(api_job_entry *j, const st_job *job)
{
    if (job->body != NULL) {
        j->body = he_mem_alloc(job->length + 1);
        if (j->body == NULL) {
            return false;
        }
        memcpy(j->body, job->body, job->length);
    }
    j->facts.body = j->body;
    j->facts.length = j->body == NULL ? 0 : job->length;
    j->facts.shown = job->shown;
    return true;
}

/* Restores the header Location of a job that made a mesh, if the journal has the record of the new
 * mesh but not of the job's answer. */
static void locate(api_job *facts)
{
    enum { CREATED = 201 };
    if (facts->state == API_JOB_DONE && facts->status == CREATED && facts->location[0] == '\0') {
        (void)snprintf(facts->location, sizeof facts->location, "/v1/meshes/%s", facts->mesh);
    }
}

/* Marks a job as failed because a restart interrupted it. Returns false when memory is out. */
static bool interrupt(api_job_entry *j)
{
    api_problem problem = {0};
    api_text text = {0};
    (void)api_problem_set(&problem, API_INTERRUPTED,
                          "the server stopped before the job ended: it changed nothing, and the "
                          "request can be sent again");
    api_problem_write(&problem, "", &text);
    if (text.failed) {
        api_text_clear(&text);
        return false;
    }
    he_mem_free(j->body);
    j->facts.body = j->body = text.bytes;
    j->facts.length = text.length;
    j->facts.shown = true;
    j->facts.headers[ST_JOB_TYPE] = "application/problem+json";
    j->facts.status = api_problem_http(&problem);
    j->facts.finished = st_clock_utc();
    j->interrupted = true;
    return true;
}

static bool fill(api_job_entry *j, const st_job *job)
{
    api_job *facts = &j->facts;
    *facts = (api_job){.number = job->number,
                       .state = state_of(job->state),
                       .progress = job->progress,
                       .created = job->created,
                       .started = job->started,
                       .finished = job->finished,
                       .status = job->status};
    memcpy(facts->id, job->id, sizeof facts->id);
    (void)snprintf(facts->mesh, sizeof facts->mesh, "%s", job->mesh);
    (void)snprintf(facts->holder, sizeof facts->holder, "%s", job->holder);
    (void)snprintf(facts->location, sizeof facts->location, "%s", job->location);
    if (!copy_texts(j, job) || !copy_body(j, job) ||
        (job->state == ST_JOB_ACCEPTED && !interrupt(j))) {
        return false;
    }
    locate(facts);
    j->end = facts->state;
    j->ended = facts->finished;
    atomic_init(&j->phase, facts->phase);
    atomic_init(&j->progress, facts->progress);
    return true;
}

static bool take(void *context, const st_job *job)
{
    api_job_table *table = context;
    api_job_entry *j = he_mem_zero(1, sizeof *j);
    if (j == NULL) {
        return false;
    }
    j->table = table;
    j->uses = 1;
    j->is_kept = true;
    if (!fill(j, job)) {
        api_job_entry_release(j);
        return false;
    }
    api_job_entry_append(table, j);
    table->bytes += j->facts.length;
    table->submitted = job->number > table->submitted ? job->number : table->submitted;
    return true;
}

bool api_job_restore(api_job_table *table)
{
    if (st_jobs_kept(table->options.store, take, table) != ST_OK) {
        return false;
    }
    /* The ends of interrupted jobs are recorded only now, because nothing can be recorded while
     * jobs are read from the store. So at the next restart these jobs are found to have ended. */
    for (api_job_entry *j = table->first; j != NULL; j = j->next) {
        uint64_t position;
        if (j->interrupted) {
            (void)api_job_keep(j, &position);
        }
    }
    return true;
}
