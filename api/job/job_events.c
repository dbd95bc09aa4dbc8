/* job_events.c - the event stream of a job. Each listener reads the newest state when it is ready
 * for it, so no events are queued for slow listeners. */
#include "api/job/job_entry.h"

#include "api/event/events.h"
#include "api/job/job_out.h"
#include "base/mem.h"

#include <string.h>

struct api_job_listener {
    api_job_entry *job; /* the job; the listener is counted in its `uses` */
    api_text text;      /* the message that is being sent */
    size_t sent;
    bool begun, ended, stopping;
    /* the state of the job that the last message showed */
    api_job_state state;
    const char *phase;
    double progress;

    void (*wake)(void *context);
    void *context;
    bool waiting; /* true if the listener is in the job's list `waiting` */
    api_job_listener *next;
};

/* A message is sent when the progress has grown by this fraction of the whole work. */
static const double STEP = 0.005;

void api_job_entry_wake(api_job_entry *job)
{
    api_job_listener *next;
    atomic_store_explicit(&job->awaited, false, memory_order_relaxed);
    for (api_job_listener *l = job->waiting; l != NULL; l = next) {
        next = l->next;
        l->waiting = false;
        l->wake(l->context);
    }
    job->waiting = NULL;
}

static void start(void *self, void (*wake)(void *context), void *context)
{
    api_job_listener *l = self;
    l->wake = wake;
    l->context = context;
}

static bool is_news(const api_job_listener *l, const api_job *facts)
{
    return !l->begun || l->state != facts->state || facts->progress >= l->progress + STEP ||
           l->phase != facts->phase;
}

/* Writes the next message of the stream to the listener's `text`. If there is no news of the job,
 * the text is empty and the listener will be woken. Returns false at the end of the stream. */
static bool next_message(api_job_listener *l)
{
    api_job_entry *job = l->job;
    api_text_empty(&l->text);
    l->sent = 0;
    if (l->ended) {
        return false;
    }
    pthread_mutex_lock(&job->table->lock);
    const api_job *facts = api_job_entry_facts(job);
    bool over = api_job_entry_has_ended(job);
    if (is_news(l, facts)) {
        l->begun = true;
        l->state = facts->state;
        l->phase = facts->phase;
        l->progress = facts->progress;
        api_event_job(&l->text, facts, false);
    } else if (!l->stopping) {
        l->waiting = true;
        l->next = job->waiting;
        job->waiting = l;
        atomic_store_explicit(&job->shown, l->progress, memory_order_relaxed);
        atomic_store_explicit(&job->awaited, true, memory_order_relaxed);
    }
    if (over || l->stopping) {
        l->ended = true;
        api_event_job(&l->text, facts, true);
    }
    pthread_mutex_unlock(&job->table->lock);
    return true;
}

static int64_t read_messages(void *self, char *buffer, size_t size)
{
    api_job_listener *l = self;
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
    api_job_listener *l = self;
    l->stopping = true;
}

static void leave(void *self)
{
    api_job_listener *l = self;
    api_job_table *table = l->job->table;
    pthread_mutex_lock(&table->lock);
    for (api_job_listener **at = &l->job->waiting; *at != NULL; at = &(*at)->next) {
        if (*at == l) {
            *at = l->next;
            break;
        }
    }
    table->listeners--;
    api_job_entry_release(l->job);
    pthread_mutex_unlock(&table->lock);
    api_text_clear(&l->text);
    he_mem_free(l);
}

st_status api_job_follow(api_job_table *table, api_job_wanted wanted, api_source *out)
{
    api_job_listener *l = he_mem_zero(1, sizeof *l);
    if (l == NULL) {
        return ST_NO_MEMORY;
    }
    pthread_mutex_lock(&table->lock);
    api_job_entry *job = api_job_entry_find(table, wanted);
    st_status status = job == NULL                             ? ST_ABSENT
                       : table->listeners >= API_JOB_LISTENERS ? ST_LISTENERS
                                                               : ST_OK;
    if (status == ST_OK) {
        job->uses++;
        table->listeners++;
    }
    pthread_mutex_unlock(&table->lock);
    if (status != ST_OK) {
        he_mem_free(l);
        return status;
    }
    l->job = job;
    *out = (api_source){.self = l,
                        .start = start,
                        .read = read_messages,
                        .finish = finish,
                        .free = leave,
                        .idle = API_EVENT_IDLE};
    return ST_OK;
}
