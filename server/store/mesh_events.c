#include "server/store/mesh_events.h"

#include "api/event/events.h"
#include "server/store/catch_up.h"

#include <stddef.h>
#include <string.h>

/* --- telling --- */

static void render(const api_mesh *mesh, const srv_record *record, api_text *text)
{
    const api_mesh_info *info = &mesh->info;
    if (record->removed) {
        api_event_bye(text, "deleted");
    } else if (record->action == API_REPLACE) {
        api_event_resync(text, info->incarnation, info->revision, "replaced");
    } else if (record->delta == NULL) {
        api_event_metadata(text, info);
    } else {
        api_event_edit(text, info, record->action, record->content, record->delta, record->undone);
    }
}

static bool is_durable(const api_mesh *mesh, uint64_t record)
{
    const srv_journal *journal = mesh->journal;
    return journal->durable(journal->self, mesh->info.id, mesh->info.incarnation) >= record;
}

static void became_durable(srv_hold *hold);

/* Let what is durable be read. One hold at a time waits for the journal: whoever finds it waiting
 * leaves its message to became_durable, which looks for newer ones after it has let go. */
static void allow(api_mesh *mesh)
{
    for (;;) {
        uint64_t newest = srv_feed_newest(&mesh->feed);
        if (is_durable(mesh, newest)) {
            srv_feed_allow(&mesh->feed, newest);
            return;
        }
        if (atomic_exchange(&mesh->holding, true)) {
            return;
        }
        atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
        mesh->hold = (srv_hold){.mesh = mesh, .record = newest, .resume = became_durable};
        if (srv_held_add(mesh->events->held, &mesh->hold)) {
            return;
        }
        bool abandoned = mesh->hold.abandoned;
        atomic_store(&mesh->holding, false);
        srv_mesh_release(mesh);
        if (abandoned) {
            return;
        }
    }
}

static void became_durable(srv_hold *hold)
{
    api_mesh *mesh = (api_mesh *)((char *)hold - offsetof(api_mesh, hold));
    bool abandoned = hold->abandoned;
    uint64_t record = hold->record;
    atomic_store(&mesh->holding, false);
    if (!abandoned) {
        srv_feed_allow(&mesh->feed, record);
        allow(mesh);
    }
    srv_mesh_release(mesh);
}

void srv_events_publish(api_mesh *mesh, const srv_record *record)
{
    srv_place place = {.stamp = record->number, .key = record->revision};
    api_text text = {0};
    bool followed = srv_feed_is_followed(&mesh->feed);
    if (followed) {
        render(mesh, record, &text);
    }
    srv_feed_add(&mesh->feed, place, text.failed ? NULL : text.bytes, text.length);
    if (record->removed) {
        srv_feed_end(&mesh->feed);
    }
    if (followed) {
        allow(mesh);
    }
    api_text_clear(&text);
}

void srv_events_job(api_mesh *mesh, const api_job *job)
{
    api_text text = {0};
    if (srv_feed_is_followed(&mesh->feed)) {
        api_event_job_state(&text, job);
        srv_feed_add_beside(&mesh->feed, text.failed ? NULL : text.bytes, text.length);
        allow(mesh);
        api_text_clear(&text);
    }
}

/* --- listening --- */

typedef struct stream {
    srv_events *events;
    api_mesh *mesh; /* a use */
    srv_listener listener;
    uint64_t incarnation;
    srv_catch_up *missed; /* NULL: nothing, or no more */
    uint64_t caught_up;   /* the last revision of it */
    api_text text;        /* to be sent before anything else */
    size_t sent;
    bool finishing; /* the server stops */
    bool ended;     /* nothing comes after `text` */
} stream;

static void start(void *self, void (*wake)(void *context), void *context)
{
    stream *s = self;
    srv_feed_wake(&s->listener, wake, context);
    if (s->missed != NULL) {
        srv_catch_up_wake(s->missed, wake, context);
    }
}

static size_t copy_text(stream *s, char *buffer, size_t size)
{
    size_t length = s->text.length - s->sent;
    length = length < size ? length : size;
    memcpy(buffer, s->text.bytes + s->sent, length);
    s->sent += length;
    if (s->sent == s->text.length) {
        api_text_clear(&s->text);
        s->sent = 0;
    }
    return length;
}

enum { IN_TEXT = -3 }; /* there is something to be sent in `text` */

/* What cannot be had is left out, and said. */
static int64_t read_missed(stream *s)
{
    switch (srv_catch_up_take(s->missed, &s->text)) {
    case SRV_CATCH_UP_TEXT:
        return IN_TEXT;
    case SRV_CATCH_UP_WAIT:
        return API_READ_WAIT;
    case SRV_CATCH_UP_FAILED:
        api_event_resync(&s->text, s->incarnation, s->caught_up, "gap");
        break;
    case SRV_CATCH_UP_DONE:
        break;
    }
    srv_catch_up_free(s->missed);
    s->missed = NULL;
    return IN_TEXT;
}

static int64_t read_feed(stream *s, char *buffer, size_t size)
{
    size_t got = 0;
    switch (srv_feed_read(&s->listener, buffer, size, &got)) {
    case SRV_FEED_GOT:
        return (int64_t)got;
    case SRV_FEED_WAIT:
        return API_READ_WAIT;
    case SRV_FEED_ENDED:
        return 0;
    case SRV_FEED_BEHIND:
        break;
    }
    api_event_resync(&s->text, s->incarnation, srv_feed_skip(&s->listener).key, "gap");
    return IN_TEXT;
}

/* In turn: what was prepared, what it missed, what happens. A stop waits for none of them. */
static int64_t read_stream(void *self, char *buffer, size_t size)
{
    stream *s = self;
    while (s->text.length == 0 && !s->text.failed) {
        if (s->ended) {
            return 0;
        }
        int64_t got = s->missed != NULL ? read_missed(s) : read_feed(s, buffer, size);
        if (got == API_READ_WAIT && s->finishing) {
            api_event_bye(&s->text, "stopping");
            s->ended = true;
        } else if (got != IN_TEXT) {
            return got;
        }
    }
    return s->text.failed ? -1 : (int64_t)copy_text(s, buffer, size);
}

static void finish(void *self)
{
    stream *s = self;
    s->finishing = true;
}

static void free_stream(void *self)
{
    stream *s = self;
    srv_feed_leave(&s->listener);
    srv_catch_up_free(s->missed);
    atomic_fetch_sub(&s->events->count, 1);
    srv_mesh_release(s->mesh);
    api_text_clear(&s->text);
    he_mem_free(s);
}

/* Of what is not a revision the history knows nothing: the name is told as it is. */
static void begin_with_history(stream *s, const api_mesh_info *info, uint64_t since)
{
    api_mesh_info from = *info;
    from.revision = since;
    s->caught_up = info->revision;
    s->missed = srv_catch_up_new(s->mesh, &from, info->revision);
    if (s->missed == NULL) {
        api_event_resync(&s->text, info->incarnation, info->revision, "busy");
    } else {
        api_event_metadata(&s->text, info);
    }
}

/* Where the listener goes on, and what it is told first. Under the mesh's lock. */
static void begin(stream *s, const api_mesh_info *info, const api_since *since)
{
    bool foreign = since->has_incarnation && since->incarnation != info->incarnation;
    if (!since->given) {
        api_event_begin(&s->text, info, true);
        return;
    }
    api_event_begin(&s->text, info, false);
    if (foreign || since->revision > info->revision) {
        api_event_resync(&s->text, info->incarnation, info->revision,
                         foreign ? "incarnation" : "future");
    } else if (!srv_feed_rewind(&s->listener, since->revision)) {
        begin_with_history(s, info, since->revision);
    }
}

static stream *stream_new(api_mesh *mesh)
{
    srv_events *events = mesh->events;
    stream *s = he_mem_zero(1, sizeof *s);
    if (s != NULL) {
        *s = (stream){.events = events, .mesh = mesh};
        atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    }
    return s;
}

api_store_status srv_follow(void *self, api_mesh *mesh, const api_since *since, api_mesh_info *info,
                            api_source *out)
{
    (void)self;
    srv_events *events = mesh->events;
    if (atomic_fetch_add(&events->count, 1) >= events->most) {
        atomic_fetch_sub(&events->count, 1);
        return API_STORE_LISTENERS;
    }
    stream *s = stream_new(mesh);
    if (s == NULL) {
        atomic_fetch_sub(&events->count, 1);
        return API_STORE_NO_MEMORY;
    }
    api_store_status status = API_STORE_OK;
    pthread_rwlock_rdlock(&mesh->lock);
    srv_mesh_info(mesh, info);
    if (info->removed) {
        status = API_STORE_ABSENT;
    } else if (!srv_feed_listen(&mesh->feed, &s->listener, events->most_of_mesh)) {
        status = API_STORE_LISTENERS;
    } else {
        s->incarnation = info->incarnation;
        begin(s, info, since);
    }
    pthread_rwlock_unlock(&mesh->lock);
    if (status == API_STORE_OK && s->text.failed) {
        status = API_STORE_NO_MEMORY;
    }
    if (status != API_STORE_OK) {
        free_stream(s);
        return status;
    }
    *out = (api_source){
        .self = s, .start = start, .read = read_stream, .finish = finish, .free = free_stream};
    return API_STORE_OK;
}
