#include "api/event/event_backfill.h"

#include "api/event/events.h"
#include "api/limits.h"
#include "base/mem.h"
#include "store/history_cursor.h"

#include <pthread.h>

/* The number of bytes after which a batch of events ends; a batch may be longer by a part of one
 * event. */
enum { BATCH = 32 * 1024 };

struct api_backfill {
    api_backfills *all;
    st_mesh *mesh; /* the mesh; the backfill counts as one reference to it */
    st_mesh_info info;
    uint64_t to;
    /* While a task of this backfill is queued or running on the job pool, only that task uses the
     * cursor; else only the listener does. */
    st_cursor *cursor;
    api_text text;
    bool failed;
    /* The lock protects the members below. */
    pthread_mutex_t lock;
    /* Number of users: 1 for the listener, and 1 for a task that is queued or running. */
    unsigned uses;
    bool working, waiting;
    /* Wakes the listener when events are ready; NULL if the listener has freed the backfill. */
    void (*wake)(void *context);
    void *context;
};

api_backfill *api_backfill_new(api_backfills *all, st_mesh *mesh, const st_mesh_info *from,
                               uint64_t to)
{
    api_backfill *c = NULL;
    if (atomic_fetch_add(&all->count, 1) < API_MAX_BACKFILLS && all->pool != NULL) {
        c = he_mem_zero(1, sizeof *c);
    }
    if (c == NULL) {
        atomic_fetch_sub(&all->count, 1);
        return NULL;
    }
    c->all = all;
    c->mesh = st_hold(mesh);
    c->info = *from;
    c->to = to;
    c->uses = 1;
    pthread_mutex_init(&c->lock, NULL);
    return c;
}

/* Ends the use of a backfill by the listener or by a task: unlocks the backfill, and frees it after
 * the last use. The caller holds the lock of the backfill. */
static void release(api_backfill *c)
{
    bool last = --c->uses == 0;
    pthread_mutex_unlock(&c->lock);
    if (last) {
        atomic_fetch_sub(&c->all->count, 1);
        st_cursor_end(c->cursor);
        st_release(c->mesh);
        api_text_clear(&c->text);
        pthread_mutex_destroy(&c->lock);
        he_mem_free(c);
    }
}

void api_backfill_free(api_backfill *c)
{
    if (c != NULL) {
        pthread_mutex_lock(&c->lock);
        c->wake = NULL;
        release(c);
    }
}

void api_backfill_wake(api_backfill *c, void (*wake)(void *context), void *context)
{
    c->wake = wake;
    c->context = context;
}

/* --- functions that run on the job pool --- */

/* Renders a change of the history as an event. A change that added or removed attribute columns or
 * replaced the whole content is announced as `stale`, because its delta refers to objects of the
 * mesh, which other threads may be changing. */
static void render(api_backfill *c, const st_cursor_step *step)
{
    c->info.revision = step->revision;
    if (step->delta->object_count > 0) {
        api_event_stale(&c->text, &c->info);
    } else {
        const st_change change = {.action = step->action,
                                  .delta = step->delta,
                                  .undone = step->undone,
                                  .content = step->content};
        api_event_edit(&c->text, &c->info, &change);
    }
}

/* Gets the next change of the history. If the history in memory has dropped that change since the
 * last call, the cursor is begun again, because the history on disk may have it. */
static bool next_step(api_backfill *c, st_cursor_step *step)
{
    st_status status = st_cursor_next(c->cursor, step);
    if (status == ST_GONE) {
        st_cursor_end(c->cursor);
        c->cursor = NULL;
        status = st_cursor_begin(c->mesh, c->info.revision, &c->cursor);
        status = status == ST_OK ? st_cursor_next(c->cursor, step) : status;
    }
    return status == ST_OK;
}

static bool make_batch(api_backfill *c)
{
    if (c->cursor == NULL && st_cursor_begin(c->mesh, c->info.revision, &c->cursor) != ST_OK) {
        return false;
    }
    while (c->info.revision < c->to && c->text.length < BATCH) {
        st_cursor_step step;
        if (!next_step(c, &step)) {
            return false;
        }
        render(c, &step);
    }
    return !c->text.failed;
}

static bool is_wanted(api_backfill *c)
{
    pthread_mutex_lock(&c->lock);
    bool wanted = c->wake != NULL;
    pthread_mutex_unlock(&c->lock);
    return wanted;
}

static void work(void *context)
{
    api_backfill *c = context;
    c->failed = is_wanted(c) && !make_batch(c);
    pthread_mutex_lock(&c->lock);
    c->working = false;
    if (c->waiting && c->wake != NULL) {
        c->waiting = false;
        c->wake(c->context);
    }
    release(c);
}

/* --- functions that the listener calls --- */

static void begin_work(api_backfill *c)
{
    c->working = true;
    c->uses++;
    if (!st_pool_submit(c->all->pool, &(st_task){.work = work, .context = c})) {
        c->working = false;
        c->uses--;
        c->failed = true;
    }
}

static api_backfill_step take(api_backfill *c, api_text *text)
{
    if (!c->working && !c->failed && c->text.length == 0 && c->info.revision < c->to) {
        begin_work(c);
    }
    if (c->working) {
        c->waiting = true;
        return API_BACKFILL_WAIT;
    }
    if (c->failed) {
        return API_BACKFILL_FAILED;
    }
    if (c->text.length == 0) {
        return API_BACKFILL_DONE;
    }
    *text = c->text;
    c->text = (api_text){0};
    return API_BACKFILL_TEXT;
}

api_backfill_step api_backfill_take(api_backfill *c, api_text *text)
{
    pthread_mutex_lock(&c->lock);
    api_backfill_step step = take(c, text);
    pthread_mutex_unlock(&c->lock);
    return step;
}
