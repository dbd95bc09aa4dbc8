/* A job as it goes on, for those who listen: each gets the newest facts whenever it is ready for
 * them, so that nothing is kept for the slow. */
#include "server/job/job.h"

#include <string.h>

struct srv_job_listener {
    srv_job *job; /* with a use */
    void (*write)(const api_job *job, bool bye, api_text *text);
    api_text text; /* being sent */
    size_t sent;
    bool begun, ended, stopping;
    /* what it was told last */
    api_job_state state;
    const char *phase;
    double progress;

    void (*wake)(void *context);
    void *context;
    bool waiting; /* in the job's list */
    srv_job_listener *next;
};

/* Less is not worth a message. */
static const double STEP = 0.005;

void srv_job_wake(srv_job *job)
{
    srv_job_listener *next;
    atomic_store_explicit(&job->awaited, false, memory_order_relaxed);
    for (srv_job_listener *l = job->waiting; l != NULL; l = next) {
        next = l->next;
        l->waiting = false;
        l->wake(l->context);
    }
    job->waiting = NULL;
}

static void start(void *self, void (*wake)(void *context), void *context)
{
    srv_job_listener *l = self;
    l->wake = wake;
    l->context = context;
}

static bool is_news(const srv_job_listener *l, const api_job *facts)
{
    return !l->begun || l->state != facts->state || facts->progress >= l->progress + STEP ||
           l->phase != facts->phase;
}

/* Write the next message, or arrange to be woken for it; false at the end. */
static bool next_message(srv_job_listener *l)
{
    srv_job *job = l->job;
    api_text_empty(&l->text);
    l->sent = 0;
    if (l->ended) {
        return false;
    }
    pthread_mutex_lock(&job->board->lock);
    const api_job *facts = srv_job_facts(job);
    bool over = srv_job_has_ended(job);
    if (is_news(l, facts)) {
        l->begun = true;
        l->state = facts->state;
        l->phase = facts->phase;
        l->progress = facts->progress;
        l->write(facts, false, &l->text);
    } else if (!l->stopping) {
        l->waiting = true;
        l->next = job->waiting;
        job->waiting = l;
        atomic_store_explicit(&job->shown, l->progress, memory_order_relaxed);
        atomic_store_explicit(&job->awaited, true, memory_order_relaxed);
    }
    if (over || l->stopping) {
        l->ended = true;
        l->write(facts, true, &l->text);
    }
    pthread_mutex_unlock(&job->board->lock);
    return true;
}

static int64_t read_messages(void *self, char *buffer, size_t size)
{
    srv_job_listener *l = self;
    if (l->sent == l->text.length && !next_message(l)) {
        return 0;
    }
    if (l->text.failed) {
        return -1;
    }
    if (l->text.length == 0) {
        return API_READ_WAIT;
    }
    size_t left = l->text.length - l->sent, n = left < size ? left : size;
    memcpy(buffer, l->text.bytes + l->sent, n);
    l->sent += n;
    return (int64_t)n;
}

static void finish(void *self)
{
    srv_job_listener *l = self;
    l->stopping = true;
}

static void leave(void *self)
{
    srv_job_listener *l = self;
    srv_board *board = l->job->board;
    pthread_mutex_lock(&board->lock);
    for (srv_job_listener **at = &l->job->waiting; *at != NULL; at = &(*at)->next) {
        if (*at == l) {
            *at = l->next;
            break;
        }
    }
    board->listeners--;
    srv_job_release(l->job);
    pthread_mutex_unlock(&board->lock);
    api_text_clear(&l->text);
    he_mem_free(l);
}

api_store_status srv_job_follow(void *self, const char *id,
                                void (*write)(const api_job *job, bool bye, api_text *text),
                                api_source *out)
{
    srv_board *board = self;
    srv_job_listener *l = he_mem_zero(1, sizeof *l);
    if (l == NULL) {
        return API_STORE_NO_MEMORY;
    }
    pthread_mutex_lock(&board->lock);
    srv_job *job = srv_job_find(board, id);
    api_store_status status = job == NULL                             ? API_STORE_ABSENT
                              : board->listeners >= SRV_JOB_LISTENERS ? API_STORE_LISTENERS
                                                                      : API_STORE_OK;
    if (status == API_STORE_OK) {
        job->uses++;
        board->listeners++;
    }
    pthread_mutex_unlock(&board->lock);
    if (status != API_STORE_OK) {
        he_mem_free(l);
        return status;
    }
    l->job = job;
    l->write = write;
    *out = (api_source){
        .self = l, .start = start, .read = read_messages, .finish = finish, .free = leave};
    return API_STORE_OK;
}
