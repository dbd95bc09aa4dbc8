#include "server/store/catch_up.h"

#include "api/event/events.h"
#include "server/store/replay_walk.h"
#include "server/system/thread_pool.h"

enum { BATCH = 32 * 1024 }; /* bytes, and an event more */

struct srv_catch_up {
    api_mesh *mesh; /* a use */
    api_mesh_info info;
    uint64_t to;
    /* The job's while one is queued or runs, else the listener's. */
    srv_walk *walk;
    api_text text;
    bool failed;
    /* Under the lock. */
    pthread_mutex_t lock;
    unsigned uses; /* the listener and the job */
    bool working, waiting;
    void (*wake)(void *context); /* NULL: the listener has gone */
    void *context;
};

srv_catch_up *srv_catch_up_new(api_mesh *mesh, const api_mesh_info *from, uint64_t to)
{
    srv_events *events = mesh->events;
    srv_catch_up *c = NULL;
    if (atomic_fetch_add(&events->catch_ups, 1) < SRV_MAX_CATCH_UPS) {
        c = he_mem_zero(1, sizeof *c);
    }
    if (c == NULL) {
        atomic_fetch_sub(&events->catch_ups, 1);
        return NULL;
    }
    atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    c->mesh = mesh;
    c->info = *from;
    c->to = to;
    c->uses = 1;
    pthread_mutex_init(&c->lock, NULL);
    return c;
}

/* Give back one use, under the lock, which is given back too. */
static void release(srv_catch_up *c)
{
    bool last = --c->uses == 0;
    pthread_mutex_unlock(&c->lock);
    if (last) {
        atomic_fetch_sub(&c->mesh->events->catch_ups, 1);
        srv_walk_end(c->walk);
        srv_mesh_release(c->mesh);
        api_text_clear(&c->text);
        pthread_mutex_destroy(&c->lock);
        he_mem_free(c);
    }
}

void srv_catch_up_free(srv_catch_up *c)
{
    if (c != NULL) {
        pthread_mutex_lock(&c->lock);
        c->wake = NULL;
        release(c);
    }
}

void srv_catch_up_wake(srv_catch_up *c, void (*wake)(void *context), void *context)
{
    c->wake = wake;
    c->context = context;
}

/* --- on the job pool --- */

/* Columns and contents that came or went belong to the mesh and may be changing. */
static void render(srv_catch_up *c, const srv_walk_step *step)
{
    c->info.revision = step->revision;
    if (step->delta->object_count > 0) {
        api_event_stale(&c->text, &c->info);
    } else {
        api_event_edit(&c->text, &c->info, step->action, step->content, step->delta, step->undone);
    }
}

static bool make_batch(srv_catch_up *c)
{
    if (c->walk == NULL && srv_walk_begin(c->mesh, c->info.revision, &c->walk) != API_STORE_OK) {
        return false;
    }
    while (c->info.revision < c->to && c->text.length < BATCH) {
        srv_walk_step step;
        if (srv_walk_next(c->walk, &step) != API_STORE_OK) {
            return false;
        }
        render(c, &step);
    }
    return !c->text.failed;
}

static bool is_wanted(srv_catch_up *c)
{
    pthread_mutex_lock(&c->lock);
    bool wanted = c->wake != NULL;
    pthread_mutex_unlock(&c->lock);
    return wanted;
}

static void work(void *context)
{
    srv_catch_up *c = context;
    c->failed = is_wanted(c) && !make_batch(c);
    pthread_mutex_lock(&c->lock);
    c->working = false;
    if (c->waiting && c->wake != NULL) {
        c->waiting = false;
        c->wake(c->context);
    }
    release(c);
}

/* --- the listener --- */

static void begin_work(srv_catch_up *c)
{
    c->working = true;
    c->uses++;
    if (!srv_pool_submit(c->mesh->events->pool, &(srv_task){.work = work, .context = c})) {
        c->working = false;
        c->uses--;
        c->failed = true;
    }
}

static srv_catch_up_step take(srv_catch_up *c, api_text *text)
{
    if (!c->working && !c->failed && c->text.length == 0 && c->info.revision < c->to) {
        begin_work(c);
    }
    if (c->working) {
        c->waiting = true;
        return SRV_CATCH_UP_WAIT;
    }
    if (c->failed) {
        return SRV_CATCH_UP_FAILED;
    }
    if (c->text.length == 0) {
        return SRV_CATCH_UP_DONE;
    }
    *text = c->text;
    c->text = (api_text){0};
    return SRV_CATCH_UP_TEXT;
}

srv_catch_up_step srv_catch_up_take(srv_catch_up *c, api_text *text)
{
    pthread_mutex_lock(&c->lock);
    srv_catch_up_step step = take(c, text);
    pthread_mutex_unlock(&c->lock);
    return step;
}
