#include "api/event/event_follow.h"

#include "api/event/events.h"
#include "base/mem.h"

#include <string.h>

static void render(const st_mesh_info *info, const st_change *change, api_text *text)
{
    if (change->removed) {
        api_event_bye(text, "deleted");
    } else if (change->action == ST_REPLACE) {
        api_event_resync(text, info->incarnation, info->revision, "replaced");
    } else if (change->named != 0) {
        api_event_moment(text, change->named, change->moment);
    } else if (change->delta == NULL) {
        api_event_metadata(text, info);
    } else {
        api_event_edit(text, info, change);
    }
}

bool api_event_render(const st_mesh_info *info, const st_change *change, char **bytes,
                      size_t *length)
{
    api_text text = {0};
    render(info, change, &text);
    if (text.failed) {
        api_text_clear(&text);
        return false;
    }
    *bytes = text.bytes;
    *length = text.length;
    return true;
}

typedef struct stream {
    st_mesh *mesh; /* the mesh; the stream counts as one reference to it */
    st_listener listener;
    bool listens;
    uint64_t incarnation;
    api_presences *presences;
    /* the moment up to which presences were sent (api_presences_news) */
    uint64_t seen;
    api_backfill *missed; /* makes the missed events; NULL if there are none, or all were sent */
    uint64_t caught_up;   /* the revision of the last of the missed events */
    api_text text;        /* text that is sent before anything else */
    size_t sent;
    bool finishing; /* the server is stopping */
    bool ended;     /* the stream ends after `text` */
} stream;

static void start(void *self, void (*wake)(void *context), void *context)
{
    stream *s = self;
    st_queue_wake(&s->listener, wake, context);
    if (s->missed != NULL) {
        api_backfill_wake(s->missed, wake, context);
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

enum { IN_TEXT = -3 }; /* a result of read_missed: the bytes to send are in `text` of the stream */

/* Reads missed events. If they cannot be made, the event `resync` is sent instead. */
static int64_t read_missed(stream *s)
{
    switch (api_backfill_take(s->missed, &s->text)) {
    case API_BACKFILL_TEXT:
        return IN_TEXT;
    case API_BACKFILL_WAIT:
        return API_READ_WAIT;
    case API_BACKFILL_FAILED:
        api_event_resync(&s->text, s->incarnation, s->caught_up, "gap");
        break;
    case API_BACKFILL_DONE:
        break;
    }
    api_backfill_free(s->missed);
    s->missed = NULL;
    return IN_TEXT;
}

static int64_t read_queue(stream *s, char *buffer, size_t size)
{
    size_t got = 0;
    switch (st_queue_read(&s->listener, buffer, size, &got)) {
    case ST_QUEUE_GOT:
        return (int64_t)got;
    case ST_QUEUE_WAIT:
        return API_READ_WAIT;
    case ST_QUEUE_NUDGED:
        api_presences_news(s->presences, s->incarnation, &s->seen, &s->text);
        return IN_TEXT;
    case ST_QUEUE_ENDED:
        return 0;
    case ST_QUEUE_LOST:
        api_event_resync(&s->text, s->incarnation, st_queue_skip(&s->listener).key, "lost");
        s->ended = true;
        return IN_TEXT;
    case ST_QUEUE_BEHIND:
        break;
    }
    api_event_resync(&s->text, s->incarnation, st_queue_skip(&s->listener).key, "gap");
    return IN_TEXT;
}

/* Reads the next bytes of an event stream. When the server stops, the stream sends the events that
 * are ready and ends. */
static int64_t read_stream(void *self, char *buffer, size_t size)
{
    stream *s = self;
    while (s->text.length == 0 && !s->text.failed) {
        if (s->ended) {
            return 0;
        }
        int64_t got = s->missed != NULL ? read_missed(s) : read_queue(s, buffer, size);
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
    if (s->listens) {
        st_unfollow(s->mesh, &s->listener);
    }
    api_backfill_free(s->missed);
    st_release(s->mesh);
    api_text_clear(&s->text);
    he_mem_free(s);
}

/* Begins a stream with missed events from the history. A change of the mesh's name is no revision
 * and so not in the history; therefore the present name is sent as well. */
static void begin_with_history(stream *s, const st_mesh_info *info, uint64_t since,
                               api_backfills *backfills)
{
    st_mesh_info from = *info;
    from.revision = since;
    s->caught_up = info->revision;
    s->missed = api_backfill_new(backfills, s->mesh, &from, info->revision);
    if (s->missed == NULL) {
        api_event_resync(&s->text, info->incarnation, info->revision, "busy");
    } else {
        api_event_metadata(&s->text, info);
    }
}

static void begin(stream *s, const st_mesh_info *info, const st_since *since, st_missed missed,
                  const api_event_shared *shared)
{
    s->incarnation = info->incarnation;
    s->presences = shared->presences;
    api_event_begin(&s->text, info, !since->given);
    api_presences_news(s->presences, s->incarnation, &s->seen, &s->text);
    switch (missed) {
    case ST_MISSED_NOTHING:
        break;
    case ST_MISSED_HISTORY:
        begin_with_history(s, info, since->revision, shared->backfills);
        break;
    case ST_MISSED_FOREIGN:
        api_event_resync(&s->text, info->incarnation, info->revision, "incarnation");
        break;
    case ST_MISSED_FUTURE:
        api_event_resync(&s->text, info->incarnation, info->revision, "future");
        break;
    }
}

st_status api_event_follow(st_mesh *mesh, const st_since *since, const api_event_shared *shared,
                           st_mesh_info *info, api_source *out)
{
    stream *s = he_mem_zero(1, sizeof *s);
    if (s == NULL) {
        return ST_NO_MEMORY;
    }
    s->mesh = st_hold(mesh);
    st_missed missed = ST_MISSED_NOTHING;
    st_status status = st_follow(mesh, &s->listener, since, &missed, info);
    s->listens = status == ST_OK;
    if (s->listens) {
        begin(s, info, since, missed, shared);
        status = s->text.failed ? ST_NO_MEMORY : ST_OK;
    }
    if (status != ST_OK) {
        free_stream(s);
        return status;
    }
    *out = (api_source){.self = s,
                        .start = start,
                        .read = read_stream,
                        .finish = finish,
                        .free = free_stream,
                        .idle = API_EVENT_IDLE};
    return ST_OK;
}
