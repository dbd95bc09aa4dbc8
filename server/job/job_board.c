#include "server/job/job_board.h"

#include "server/job/job.h"
#include "server/store/mesh_events.h"
#include "server/store/stored_mesh.h"
#include "server/system/clock.h"
#include "server/system/random.h"

#include <stddef.h>
#include <string.h>

srv_board *srv_board_new(const srv_board_options *options)
{
    srv_board *board = he_mem_zero(1, sizeof *board);
    if (board != NULL) {
        board->options = *options;
        pthread_mutex_init(&board->lock, NULL);
    }
    return board;
}

/* --- the list, under the lock --- */

void srv_job_release(srv_job *j)
{
    if (--j->uses == 0) {
        api_free(j->work);
        he_mem_free(j->body);
        he_mem_free(j);
    }
}

static void append(srv_board *board, srv_job *j)
{
    j->previous = board->last;
    if (board->last != NULL) {
        board->last->next = j;
    } else {
        board->first = j;
    }
    board->last = j;
    board->count++;
    j->listed = true;
}

static void forget(srv_board *board, srv_job *j)
{
    if (j->previous != NULL) {
        j->previous->next = j->next;
    } else {
        board->first = j->next;
    }
    if (j->next != NULL) {
        j->next->previous = j->previous;
    } else {
        board->last = j->previous;
    }
    board->count--;
    board->bytes -= j->body == NULL ? 0 : j->facts.length;
    j->listed = false;
    srv_job_release(j);
}

/* The one that ended first; NULL when none has. */
static srv_job *ended_first(const srv_board *board)
{
    srv_job *found = NULL;
    for (srv_job *j = board->first; j != NULL; j = j->next) {
        if (srv_job_has_ended(j) && (found == NULL || j->facts.finished < found->facts.finished)) {
            found = j;
        }
    }
    return found;
}

/* Forget what is too old, and as many more as it takes for `room` jobs; the newest answer stays
 * however large it is. */
static void tidy(srv_board *board, size_t room)
{
    double now = srv_clock_utc();
    srv_job *j = ended_first(board);
    while (j != NULL &&
           (now - j->facts.finished >= board->options.keep || board->count + room > SRV_JOBS_KEPT ||
            (board->bytes > SRV_JOBS_BYTES && board->bytes > j->facts.length))) {
        forget(board, j);
        j = ended_first(board);
    }
}

srv_job *srv_job_find(const srv_board *board, const char *id)
{
    srv_job *j = board->first;
    while (j != NULL && strcmp(j->facts.id, id) != 0) {
        j = j->next;
    }
    return j;
}

/* --- running --- */

/* Progress that listeners are woken for. */
static const double WORTH = 0.005;

static bool tell(void *context, const char *phase, double done)
{
    srv_job *j = context;
    atomic_store_explicit(&j->phase, phase, memory_order_relaxed);
    atomic_store_explicit(&j->progress, done, memory_order_relaxed);
    if (atomic_load_explicit(&j->awaited, memory_order_relaxed) &&
        done >= atomic_load_explicit(&j->shown, memory_order_relaxed) + WORTH) {
        pthread_mutex_lock(&j->board->lock);
        srv_job_wake(j);
        pthread_mutex_unlock(&j->board->lock);
    }
    return !atomic_load_explicit(&j->stop, memory_order_relaxed);
}

/* What the exchange would have answered. Without memory the body is not kept. */
static void keep_answer(srv_job *j)
{
    const api_answer *answer = api_answer_of(j->work);
    j->facts.status = answer->status;
    for (size_t i = 0; i < answer->header_count; i++) {
        const char *value = answer->headers[i].value;
        if (strcmp(answer->headers[i].name, "Location") == 0 &&
            strlen(value) < sizeof j->facts.location) {
            memcpy(j->facts.location, value, strlen(value) + 1);
        }
    }
    if (answer->read == NULL && answer->length > 0) {
        j->facts.length = (size_t)answer->length;
        j->body = he_mem_alloc(j->facts.length);
        if (j->body != NULL) {
            memcpy(j->body, answer->bytes, j->facts.length);
        }
    }
    j->facts.body = j->body;
    j->facts.length = j->body == NULL ? 0 : j->facts.length;
}

/* Followers of the mesh that the job is about: not of one that has its id since. */
static void tell_mesh(api_mesh *mesh, const api_job *facts)
{
    if (mesh != NULL) {
        srv_events_job(mesh, facts);
    }
}

/* Frees the work first: its memory is back before the end shows. */
static void end(srv_job *j)
{
    srv_board *board = j->board;
    api_free(j->work);
    pthread_mutex_lock(&board->lock);
    j->work = NULL;
    api_mesh *about = j->about;
    j->about = NULL;
    const char *slash = strrchr(j->facts.location, '/');
    if (slash != NULL && strlen(slash + 1) <= API_MESH_ID) {
        memcpy(j->facts.mesh, slash + 1, strlen(slash + 1) + 1);
    }
    j->facts.state = j->facts.status < 400   ? API_JOB_DONE
                     : atomic_load(&j->stop) ? API_JOB_CANCELLED
                                             : API_JOB_FAILED;
    j->facts.progress = j->facts.state == API_JOB_DONE ? 1 : atomic_load(&j->progress);
    j->facts.phase = atomic_load(&j->phase);
    j->facts.finished = srv_clock_utc();
    board->bytes += j->facts.length;
    srv_job_wake(j);
    api_job facts = j->facts;
    tidy(board, 0);
    srv_job_release(j);
    pthread_mutex_unlock(&board->lock);
    tell_mesh(about, &facts);
    srv_mesh_release(about);
}

/* Nobody is told that something was done which the journal may never have. */
static void lose_answer(srv_job *j)
{
    pthread_mutex_lock(&j->board->lock);
    he_mem_free(j->body);
    j->body = NULL;
    j->facts.body = NULL;
    j->facts.length = 0;
    j->facts.location[0] = '\0';
    j->facts.status = 503;
    pthread_mutex_unlock(&j->board->lock);
}

static void resume(srv_hold *hold)
{
    srv_job *j = (srv_job *)((char *)hold - offsetof(srv_job, hold));
    if (hold->abandoned) {
        lose_answer(j);
    }
    end(j);
}

/* D1: the end is not shown before it is durable. */
static void end_when_durable(srv_job *j)
{
    const api_answer *answer = api_answer_of(j->work);
    srv_store *store = j->board->options.store;
    if (answer->mesh != NULL && !srv_store_is_durable(store, answer->mesh, answer->record)) {
        atomic_store(&j->phase, "storing");
        j->hold = (srv_hold){.mesh = answer->mesh, .record = answer->record, .resume = resume};
        if (!srv_held_add(srv_store_held(store), &j->hold)) {
            resume(&j->hold);
        }
        return;
    }
    end(j);
}

static void run(void *context)
{
    srv_job *j = context;
    srv_board *board = j->board;
    pthread_mutex_lock(&board->lock);
    bool wanted = j->facts.state == API_JOB_QUEUED;
    api_job facts = {.number = 0};
    if (wanted) {
        j->facts.state = API_JOB_RUNNING;
        j->facts.started = srv_clock_utc();
        srv_job_wake(j);
        facts = *srv_job_facts(j);
    } else {
        srv_job_release(j);
    }
    pthread_mutex_unlock(&board->lock);
    if (!wanted) {
        return;
    }
    tell_mesh(j->about, &facts); /* which only the end lets go */
    api_watch(j->work, tell, j);
    api_work(j->work);
    pthread_mutex_lock(&board->lock);
    keep_answer(j);
    pthread_mutex_unlock(&board->lock);
    end_when_durable(j);
}

/* --- what api asks for --- */

const api_job *srv_job_facts(srv_job *j)
{
    if (!srv_job_has_ended(j)) {
        j->facts.phase = atomic_load(&j->phase);
        j->facts.progress = atomic_load(&j->progress);
    }
    return &j->facts;
}

static srv_job *job_new(srv_board *board, api_exchange *work, const char *operation,
                        const char *mesh)
{
    srv_job *j = he_mem_zero(1, sizeof *j);
    if (j == NULL) {
        return NULL;
    }
    j->board = board;
    j->work = work;
    j->uses = 2;
    srv_random_id(j->facts.id, API_JOB_ID);
    j->facts.operation = operation;
    memcpy(j->facts.mesh, mesh, strnlen(mesh, API_MESH_ID));
    j->facts.created = srv_clock_utc();
    atomic_init(&j->phase, "");
    atomic_init(&j->progress, 0);
    atomic_init(&j->stop, false);
    atomic_init(&j->awaited, false);
    atomic_init(&j->shown, 0);
    return j;
}

static api_store_status submit(void *self, api_exchange *work, const char *operation,
                               const char *mesh, api_job *out)
{
    srv_board *board = self;
    srv_job *j = job_new(board, work, operation, mesh);
    if (j == NULL) {
        return API_STORE_NO_MEMORY;
    }
    const api_load load = api_load_of(work);
    if (load.claims) {
        srv_claimed_by(load.about, j->facts.id);
    }
    const srv_task task = {.work = run,
                           .context = j,
                           .share = SRV_SHARE_JOB,
                           .cost = load.seconds,
                           .flow = srv_pool_flow("", mesh)};
    pthread_mutex_lock(&board->lock);
    tidy(board, 1);
    bool accepted = !board->stopped && board->count < SRV_JOBS_KEPT;
    if (accepted) {
        j->facts.number = ++board->submitted;
        *out = *srv_job_facts(j);
        j->about = load.about == NULL ? NULL : srv_mesh_retain(load.about);
        append(board, j);
        /* It cannot run before the lock is given back. */
        accepted = board->options.submit(board->options.pool, &task);
        if (!accepted) {
            forget(board, j);
        }
    }
    pthread_mutex_unlock(&board->lock);
    if (!accepted) {
        srv_mesh_release(j->about);
        he_mem_free(j);
    }
    return accepted ? API_STORE_OK : API_STORE_TOO_MANY;
}

static bool find(void *self, const char *id, void (*show)(void *context, const api_job *job),
                 void *context)
{
    srv_board *board = self;
    pthread_mutex_lock(&board->lock);
    tidy(board, 0);
    srv_job *j = srv_job_find(board, id);
    if (j != NULL) {
        show(context, srv_job_facts(j));
    }
    pthread_mutex_unlock(&board->lock);
    return j != NULL;
}

static bool list(void *self, uint64_t after, size_t limit,
                 void (*show)(void *context, const api_job *job), void *context)
{
    srv_board *board = self;
    size_t given = 0;
    pthread_mutex_lock(&board->lock);
    tidy(board, 0);
    srv_job *j = board->first;
    for (; j != NULL && given < limit; j = j->next) {
        if (j->facts.number > after) {
            show(context, srv_job_facts(j));
            given++;
        }
    }
    pthread_mutex_unlock(&board->lock);
    return j != NULL;
}

/* Under the lock; what is left of one that waited, and its use of a mesh, are to be given back
 * without it. */
static api_exchange *cancel(srv_job *j, api_mesh **about)
{
    api_exchange *work = NULL;
    *about = NULL;
    atomic_store(&j->stop, true);
    if (j->facts.state == API_JOB_QUEUED) {
        work = j->work;
        *about = j->about;
        j->work = NULL;
        j->about = NULL;
        j->facts.state = API_JOB_CANCELLED;
        j->facts.finished = srv_clock_utc();
        srv_job_wake(j);
    }
    return work;
}

static bool remove_job(void *self, const char *id, bool *forgotten,
                       void (*show)(void *context, const api_job *job), void *context)
{
    srv_board *board = self;
    api_exchange *over = NULL;
    api_mesh *about = NULL;
    api_job facts = {.number = 0};
    pthread_mutex_lock(&board->lock);
    tidy(board, 0);
    srv_job *j = srv_job_find(board, id);
    if (j != NULL) {
        *forgotten = srv_job_facts(j)->state >= API_JOB_DONE;
        if (*forgotten) {
            forget(board, j);
        } else {
            over = cancel(j, &about);
            facts = *srv_job_facts(j);
            show(context, &facts);
        }
    }
    pthread_mutex_unlock(&board->lock);
    if (over != NULL) {
        api_free(over);
        tell_mesh(about, &facts);
        srv_mesh_release(about);
    }
    return j != NULL;
}

api_jobs srv_board_interface(srv_board *board)
{
    return (api_jobs){.self = board,
                      .submit = submit,
                      .find = find,
                      .list = list,
                      .remove = remove_job,
                      .follow = srv_job_follow};
}

/* What is left of some job that waited; NULL when none does. */
static api_exchange *cancel_one(srv_board *board, api_mesh **about)
{
    api_exchange *work = NULL;
    pthread_mutex_lock(&board->lock);
    board->stopped = true;
    for (srv_job *j = board->first; j != NULL && work == NULL; j = j->next) {
        work = cancel(j, about);
    }
    pthread_mutex_unlock(&board->lock);
    return work;
}

void srv_board_stop(srv_board *board)
{
    api_mesh *about = NULL;
    for (api_exchange *work; (work = cancel_one(board, &about)) != NULL;) {
        api_free(work);
        srv_mesh_release(about);
    }
}

void srv_board_free(srv_board *board)
{
    if (board != NULL) {
        while (board->first != NULL) {
            forget(board, board->first);
        }
        pthread_mutex_destroy(&board->lock);
        he_mem_free(board);
    }
}
