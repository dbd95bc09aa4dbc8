#include "api/job/job_table.h"

#include "api/job/job_entry.h"
#include "api/job/job_out.h"
#include "api/json/problem.h"
#include "base/mem.h"
#include "store/followers.h"
#include "store/write.h"
#include "system/clock.h"
#include "system/random.h"

#include <stddef.h>
#include <string.h>

const char *const api_job_header_names[API_JOB_HEADERS] = {"Content-Type", "Content-Disposition",
                                                           "ETag", "Export-Warnings"};

/* Sends the state of a job to the listeners of its mesh. The mesh is passed as a pointer, not by
 * its id, because a new mesh that has got this id must not get the event. */
static void tell_listeners(st_mesh *mesh, const api_job *job)
{
    if (mesh != NULL && st_is_followed(mesh)) {
        api_text text = {0};
        api_event_job_state(&text, job);
        st_follow_tell(mesh, text.failed ? NULL : text.bytes, text.length);
        api_text_clear(&text);
    }
}

static void free_work(api_job_work *work)
{
    if (work->self != NULL) {
        work->free(work->self);
        work->self = NULL;
    }
}

/* --- the list of jobs; callers hold the table's lock --- */

static void free_blob(api_job_entry *j)
{
    if (j->blob.self != NULL) {
        j->blob.free(j->blob.self);
    }
    j->blob = j->facts.blob = (api_blob){.self = NULL};
}

void api_job_entry_release(api_job_entry *j)
{
    if (--j->uses == 0) {
        free_work(&j->work);
        free_blob(j);
        he_mem_free(j->body);
        he_mem_free(j->texts);
        he_mem_free(j);
    }
}

void api_job_entry_append(api_job_table *table, api_job_entry *j)
{
    j->previous = table->last;
    if (table->last != NULL) {
        table->last->next = j;
    } else {
        table->first = j;
    }
    table->last = j;
    table->count++;
    j->listed = true;
}

static void take_out(api_job_table *table, api_job_entry *j)
{
    if (j->previous != NULL) {
        j->previous->next = j->next;
    } else {
        table->first = j->next;
    }
    if (j->next != NULL) {
        j->next->previous = j->previous;
    } else {
        table->last = j->previous;
    }
    table->count--;
    table->bytes -= j->body == NULL ? 0 : j->facts.length;
    j->listed = false;
    api_job_entry_release(j);
}

static void forget(api_job_table *table, api_job_entry *j)
{
    /* If the store cannot delete the job's record now, it deletes the record later because of its
     * age. */
    (void)api_job_forget(j);
    take_out(table, j);
}

/* Returns the job that ended first, or NULL if none has ended. */
static api_job_entry *ended_first(const api_job_table *table)
{
    api_job_entry *found = NULL;
    for (api_job_entry *j = table->first; j != NULL; j = j->next) {
        if (api_job_entry_has_ended(j) &&
            (found == NULL || j->facts.finished < found->facts.finished)) {
            found = j;
        }
    }
    return found;
}

/* Drops jobs that have ended: those that ended too long ago, and, as long as the table exceeds its
 * limits or lacks space for `room` more jobs, the job that ended first. The newest answer is kept,
 * however large it is. */
static void tidy(api_job_table *table, size_t room)
{
    double now = st_clock_utc();
    api_job_entry *j = ended_first(table);
    while (j != NULL &&
           (now - j->facts.finished >= table->options.keep || table->count + room > API_JOBS_KEPT ||
            (table->bytes > API_JOBS_BYTES && table->bytes > j->facts.length))) {
        forget(table, j);
        j = ended_first(table);
    }
}

api_job_table *api_job_table_new(const api_job_table_options *options)
{
    api_job_table *table = he_mem_zero(1, sizeof *table);
    if (table == NULL) {
        return NULL;
    }
    table->options = *options;
    pthread_mutex_init(&table->lock, NULL);
    if (!api_job_restore(table)) {
        api_job_table_free(table);
        return NULL;
    }
    tidy(table, 0);
    return table;
}

api_job_entry *api_job_entry_find(const api_job_table *table, api_job_wanted wanted)
{
    api_job_entry *j = table->first;
    while (j != NULL && strcmp(j->facts.id, wanted.id) != 0) {
        j = j->next;
    }
    return j != NULL && api_job_entry_is_seen(j, wanted.viewer) ? j : NULL;
}

/* --- running a job --- */

/* Listeners are woken when the progress has grown by this fraction of the whole work. */
static const double WORTH = 0.005;

static bool tell(void *context, const char *phase, double done)
{
    api_job_entry *j = context;
    atomic_store_explicit(&j->phase, phase, memory_order_relaxed);
    atomic_store_explicit(&j->progress, done, memory_order_relaxed);
    if (atomic_load_explicit(&j->awaited, memory_order_relaxed) &&
        done >= atomic_load_explicit(&j->shown, memory_order_relaxed) + WORTH) {
        pthread_mutex_lock(&j->table->lock);
        api_job_entry_wake(j);
        pthread_mutex_unlock(&j->table->lock);
    }
    return !atomic_load_explicit(&j->stop, memory_order_relaxed);
}

/* Copies the headers of an answer into the job. Returns false when memory is out. */
static bool keep_headers(api_job_entry *j, const api_job_outcome *outcome)
{
    size_t length = 0;
    for (size_t i = 0; i < API_JOB_HEADERS; i++) {
        length += outcome->headers[i] == NULL ? 0 : strlen(outcome->headers[i]) + 1;
    }
    char *at = length == 0 ? NULL : he_mem_alloc(length);
    j->texts = at;
    for (size_t i = 0; i < API_JOB_HEADERS && at != NULL; i++) {
        if (outcome->headers[i] != NULL) {
            size_t bytes = strlen(outcome->headers[i]) + 1;
            j->facts.headers[i] = memcpy(at, outcome->headers[i], bytes);
            at += bytes;
        }
    }
    return length == 0 || at != NULL;
}

/* Stores the answer of the work in the job. If there is no memory for its headers, the body is
 * dropped. */
static void keep_outcome(api_job_entry *j, const api_job_outcome *outcome)
{
    j->facts.status = outcome->status;
    size_t length = strlen(outcome->location);
    if (length < sizeof j->facts.location) {
        memcpy(j->facts.location, outcome->location, length + 1);
    }
    j->blob = outcome->blob;
    if (outcome->body != NULL && keep_headers(j, outcome)) {
        j->body = outcome->body;
    } else {
        he_mem_free(outcome->body);
    }
    if (j->blob.self != NULL && !keep_headers(j, outcome)) {
        free_blob(j);
    }
    j->facts.body = j->body;
    j->facts.blob = (api_blob){j->blob.self, j->blob.length, j->blob.read, NULL};
    j->facts.length = j->body == NULL ? 0 : outcome->length;
    j->facts.shown = outcome->shown;
}

/* Ends a job. The work is freed first, so that the memory it used is free when clients see the
 * end. */
static void end(api_job_entry *j)
{
    api_job_table *table = j->table;
    free_work(&j->work);
    pthread_mutex_lock(&table->lock);
    st_mesh *about = j->about;
    j->about = NULL;
    const char *mesh = api_job_entry_mesh(&j->facts);
    if (mesh != j->facts.mesh) {
        memcpy(j->facts.mesh, mesh, strlen(mesh) + 1);
    }
    j->facts.state = j->end;
    j->facts.progress = j->facts.state == API_JOB_DONE ? 1 : atomic_load(&j->progress);
    j->facts.phase = atomic_load(&j->phase);
    j->facts.finished = j->ended;
    api_job_count_end(j);
    table->bytes += j->facts.length;
    api_job_entry_wake(j);
    api_job facts = j->facts;
    tidy(table, 0);
    api_job_entry_release(j);
    pthread_mutex_unlock(&table->lock);
    tell_listeners(about, &facts);
    st_release(about);
}

/* Replaces the answer by a problem, because the job's change could not be made durable, or because
 * that is not known. When memory is out, only the status of the problem is kept. */
static void answer_lost(api_job_entry *j)
{
    api_problem problem = {0};
    api_text text = {0};
    api_problem_set_lost(&problem, &j->wait, j->changed);
    api_problem_write(&problem, "", &text);
    pthread_mutex_lock(&j->table->lock);
    he_mem_free(j->body);
    free_blob(j);
    j->body = text.failed ? NULL : text.bytes;
    j->facts.body = j->body;
    j->facts.length = text.failed ? 0 : text.length;
    j->facts.shown = true;
    memset(j->facts.headers, 0, sizeof j->facts.headers);
    j->facts.headers[0] = "application/problem+json"; /* Content-Type */
    j->facts.location[0] = '\0';
    j->facts.status = api_problem_http(&problem);
    pthread_mutex_unlock(&j->table->lock);
    if (text.failed) {
        api_text_clear(&text);
    }
}

static api_job_entry *waiter(st_wait *wait)
{
    return (api_job_entry *)((char *)wait - offsetof(api_job_entry, wait));
}

static void resume_noted(st_wait *wait)
{
    end(waiter(wait));
}

static bool is_stopped(api_job_table *table)
{
    pthread_mutex_lock(&table->lock);
    bool stopped = table->stopped;
    pthread_mutex_unlock(&table->lock);
    return stopped;
}

static void decide_end(api_job_entry *j)
{
    j->end = j->facts.status < 400   ? API_JOB_DONE
             : atomic_load(&j->stop) ? API_JOB_CANCELLED
                                     : API_JOB_FAILED;
    j->noted = 0;
}

/* Decides in which state a job ends and records the end in the store. If the job was cancelled
 * because the server stops, its end is not recorded: after the restart it is found without an end
 * and marked as interrupted. */
static void note_end(api_job_entry *j)
{
    uint64_t position;
    decide_end(j);
    if (j->is_kept && !(j->end == API_JOB_CANCELLED && is_stopped(j->table)) &&
        api_job_keep(j, &position) == ST_OK) {
        j->noted = position;
    }
}

/* Called when the changes of the work are durable, when they are lost, or when the server stops.
 * Ends the job when the record of its end is durable as well, so that a job that clients saw as
 * done is still done after a crash. */
static void resume(st_wait *wait)
{
    api_job_entry *j = waiter(wait);
    switch (wait->end) {
    case ST_WAIT_DURABLE:
        break;
    case ST_WAIT_LOST:
        answer_lost(j);
        note_end(j);
        break;
    /* The server stops before it is known whether the changes become durable. */
    case ST_WAIT_STOPPED:
        answer_lost(j);
        decide_end(j);
        break;
    }
    const uint64_t position = j->noted;
    j->wait =
        (st_wait){.shown = {.position = position, .since = position - 1}, .resume = resume_noted};
    if (position == 0 || !st_waits_add(st_store_waits(j->table->options.store), &j->wait)) {
        end(j);
    }
}

/* Ends a job as soon as its changes are durable: clients must not see the end before that (rule D1
 * of the store). */
static void end_when_durable(api_job_entry *j, const api_job_outcome *outcome)
{
    st_waits *waits = st_store_waits(j->table->options.store);
    j->changed = outcome->changed;
    j->ended = st_clock_utc();
    if (!st_waits_is_durable(waits, &outcome->awaits)) {
        atomic_store(&j->phase, "storing");
    }
    note_end(j);
    j->wait = (st_wait){.shown = outcome->awaits, .resume = resume};
    if (!st_waits_add(waits, &j->wait)) {
        resume(&j->wait);
    }
}

static void run(void *context)
{
    api_job_entry *j = context;
    api_job_table *table = j->table;
    pthread_mutex_lock(&table->lock);
    bool wanted = j->facts.state == API_JOB_QUEUED;
    api_job facts = {.number = 0};
    if (wanted) {
        j->facts.state = API_JOB_RUNNING;
        j->facts.started = st_clock_utc();
        api_job_count_begin(j);
        api_job_entry_wake(j);
        facts = *api_job_entry_facts(j);
    } else {
        api_job_entry_release(j);
    }
    pthread_mutex_unlock(&table->lock);
    if (!wanted) {
        return;
    }
    /* The member `about` can be read without the lock, because it does not change before the job
     * ends. */
    tell_listeners(j->about, &facts);
    api_job_outcome outcome = {.location = ""};
    j->work.run(j->work.self, j->facts.id, tell, j, &outcome);
    pthread_mutex_lock(&table->lock);
    keep_outcome(j, &outcome);
    pthread_mutex_unlock(&table->lock);
    end_when_durable(j, &outcome);
}

/* --- the functions of job_table.h --- */

const api_job *api_job_entry_facts(api_job_entry *j)
{
    if (!api_job_entry_has_ended(j)) {
        j->facts.phase = atomic_load(&j->phase);
        j->facts.progress = atomic_load(&j->progress);
    }
    return &j->facts;
}

static api_job_entry *job_new(api_job_table *table, const api_job_work *work, const char *operation,
                              const char *mesh)
{
    api_job_entry *j = he_mem_zero(1, sizeof *j);
    if (j == NULL) {
        return NULL;
    }
    j->table = table;
    j->work = *work;
    j->uses = 2;
    st_random_id(j->facts.id, API_JOB_ID);
    j->facts.operation = operation;
    memcpy(j->facts.mesh, mesh, strnlen(mesh, ST_MESH_ID));
    memcpy(j->facts.holder, work->holder, strnlen(work->holder, API_TOKEN_NAME));
    j->facts.created = st_clock_utc();
    atomic_init(&j->phase, "");
    atomic_init(&j->progress, 0);
    atomic_init(&j->stop, false);
    atomic_init(&j->awaited, false);
    atomic_init(&j->shown, 0);
    return j;
}

static void stop_if_lost(api_job_entry *j)
{
    if (j->accepted.end == ST_WAIT_LOST) {
        /* The client will not get the answer 202, because the job's record was lost, so it will
         * never ask for the job. */
        atomic_store(&j->stop, true);
    }
}

static void resume_accepted(st_wait *wait)
{
    api_job_entry *j = (api_job_entry *)((char *)wait - offsetof(api_job_entry, accepted));
    api_job_table *table = j->table;
    stop_if_lost(j);
    pthread_mutex_lock(&table->lock);
    api_job_entry_release(j);
    pthread_mutex_unlock(&table->lock);
}

/* Arranges that the job is stopped if its record at `position` of the journal can never become
 * durable. The caller holds the table's lock. */
static void watch_note(api_job_entry *j, uint64_t position)
{
    st_waits *waits = st_store_waits(j->table->options.store);
    j->accepted = (st_wait){.shown = {.position = position, .since = position - 1},
                            .resume = resume_accepted};
    j->uses++;
    if (position == 0 || !st_waits_add(waits, &j->accepted)) {
        stop_if_lost(j);
        j->uses--;
    }
}

/* Returns true if the token that starts this work has as many jobs as allowed already. The caller
 * holds the table's lock. */
static bool is_beyond(const api_job_table *table, const api_job_work *work)
{
    uint64_t open = 0;
    for (const api_job_entry *j = work->most == 0 ? NULL : table->first; j != NULL; j = j->next) {
        open += !api_job_entry_has_ended(j) && strcmp(j->facts.holder, work->holder) == 0 ? 1 : 0;
    }
    return work->most != 0 && open >= work->most;
}

/* Adds a job to the table and passes it to the pool. The caller holds the table's lock, so the job
 * cannot start before it is recorded. If the disk accepts no more records, a job that only reads is
 * accepted all the same, although it would be lost at a restart; a job that writes is refused when
 * it commits. */
static st_status accept(api_job_table *table, api_job_entry *j, const st_task *task)
{
    uint64_t position = 0;
    if (table->stopped || table->count >= API_JOBS_KEPT) {
        return ST_TOO_MANY;
    }
    if (is_beyond(table, &j->work)) {
        return ST_QUOTA;
    }
    j->facts.number = ++table->submitted;
    st_status status = api_job_keep(j, &position);
    if (status != ST_OK && status != ST_FULL && status != ST_FAILED) {
        return status;
    }
    api_job_entry_append(table, j);
    if (!table->options.submit(table->options.pool, task)) {
        forget(table, j);
        return ST_TOO_MANY;
    }
    watch_note(j, status == ST_OK ? position : 0);
    return ST_OK;
}

st_status api_job_submit(api_job_table *table, const api_job_work *work, const char *operation,
                         const char *mesh, api_job *out)
{
    api_job_entry *j = job_new(table, work, operation, mesh);
    if (j == NULL) {
        return ST_NO_MEMORY;
    }
    if (work->claims) {
        st_claimed_by(work->about, j->facts.id);
    }
    const st_task task = {.work = run,
                          .context = j,
                          .share = ST_SHARE_JOB,
                          .cost = work->seconds,
                          .flow = st_pool_flow("", mesh)};
    j->about = work->about == NULL ? NULL : st_hold(work->about);
    pthread_mutex_lock(&table->lock);
    tidy(table, 1);
    const st_status status = accept(table, j, &task);
    *out = *api_job_entry_facts(j);
    pthread_mutex_unlock(&table->lock);
    if (status != ST_OK) {
        st_release(j->about);
        he_mem_free(j);
    }
    return status;
}

bool api_job_find(api_job_table *table, api_job_wanted wanted,
                  void (*show)(void *context, const api_job *job), void *context)
{
    pthread_mutex_lock(&table->lock);
    tidy(table, 0);
    api_job_entry *j = api_job_entry_find(table, wanted);
    if (j != NULL) {
        show(context, api_job_entry_facts(j));
    }
    pthread_mutex_unlock(&table->lock);
    return j != NULL;
}

api_job_loan *api_job_lend(api_job_table *table, api_job_wanted wanted, api_job *facts)
{
    pthread_mutex_lock(&table->lock);
    tidy(table, 0);
    api_job_entry *j = api_job_entry_find(table, wanted);
    if (j != NULL) {
        j->uses++;
        *facts = *api_job_entry_facts(j);
    }
    pthread_mutex_unlock(&table->lock);
    return j;
}

void api_job_return(api_job_loan *loan)
{
    api_job_table *table = loan->table;
    pthread_mutex_lock(&table->lock);
    api_job_entry_release(loan);
    pthread_mutex_unlock(&table->lock);
}

bool api_job_list(api_job_table *table, const api_job_page *page,
                  void (*show)(void *context, const api_job *job), void *context)
{
    size_t given = 0;
    pthread_mutex_lock(&table->lock);
    tidy(table, 0);
    bool more = false;
    for (api_job_entry *j = table->first; j != NULL && !more; j = j->next) {
        if (j->facts.number > page->after && api_job_entry_is_seen(j, page->viewer)) {
            more = given == page->limit;
            if (!more) {
                show(context, api_job_entry_facts(j));
                given++;
            }
        }
    }
    pthread_mutex_unlock(&table->lock);
    return more;
}

/* Cancels a job. The caller holds the table's lock. After unlocking, it must free the returned
 * work, if its `self` is not NULL (the job was still queued), and release `about`. */
static api_job_work cancel(api_job_entry *j, st_mesh **about)
{
    api_job_work work = {.self = NULL};
    *about = NULL;
    atomic_store(&j->stop, true);
    if (j->facts.state == API_JOB_QUEUED) {
        work = j->work;
        *about = j->about;
        j->work.self = NULL;
        j->about = NULL;
        j->facts.state = API_JOB_CANCELLED;
        j->facts.finished = j->ended = st_clock_utc();
        j->end = API_JOB_CANCELLED;
        api_job_count_end(j);
        if (j->is_kept && !j->table->stopped) {
            uint64_t position;
            /* If the store cannot record the cancellation, the job is marked as interrupted after a
             * restart. */
            (void)api_job_keep(j, &position);
        }
        api_job_entry_wake(j);
    }
    return work;
}

st_status api_job_remove(api_job_table *table, api_job_wanted wanted, bool *forgotten,
                         void (*show)(void *context, const api_job *job), void *context)
{
    api_job_work over = {.self = NULL};
    st_mesh *about = NULL;
    api_job facts = {.number = 0};
    pthread_mutex_lock(&table->lock);
    tidy(table, 0);
    api_job_entry *j = api_job_entry_find(table, wanted);
    st_status status = j == NULL ? ST_ABSENT : ST_OK;
    *forgotten = j != NULL && api_job_entry_has_ended(j);
    if (*forgotten) {
        status = api_job_forget(j);
        if (status == ST_OK) {
            take_out(table, j);
        }
    } else if (j != NULL) {
        over = cancel(j, &about);
        facts = *api_job_entry_facts(j);
        show(context, &facts);
    }
    pthread_mutex_unlock(&table->lock);
    if (over.self != NULL) {
        free_work(&over);
        tell_listeners(about, &facts);
        st_release(about);
    }
    return status;
}

/* Cancels one queued job and returns its work, or a work whose members are all NULL if no job is
 * queued. */
static api_job_work cancel_one(api_job_table *table, st_mesh **about)
{
    api_job_work work = {.self = NULL};
    pthread_mutex_lock(&table->lock);
    table->stopped = true;
    for (api_job_entry *j = table->first; j != NULL && work.self == NULL; j = j->next) {
        work = cancel(j, about);
    }
    pthread_mutex_unlock(&table->lock);
    return work;
}

void api_job_table_stop(api_job_table *table)
{
    st_mesh *about = NULL;
    for (api_job_work work; (work = cancel_one(table, &about)).self != NULL;) {
        free_work(&work);
        st_release(about);
    }
}

void api_job_table_free(api_job_table *table)
{
    if (table != NULL) {
        while (table->first != NULL) {
            take_out(table, table->first);
        }
        pthread_mutex_destroy(&table->lock);
        he_mem_free(table);
    }
}
