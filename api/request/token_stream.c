#include "api/request/token_stream.h"

#include "api/event/events.h"
#include "base/mem.h"
#include "system/clock.h"

#include <string.h>

typedef struct stream {
    api_tokens *tokens;
    api_token *token; /* the token; the stream counts as one reference to it */
    api_source inner;
    api_token_watch watch;
    void (*wake)(void *context);
    void *context;
    _Atomic bool started;
    bool begun, ended;
    char tail[2]; /* the last two bytes sent; an event ends with two newlines */
    api_text bye;
    size_t sent; /* how many bytes of `bye` were sent */
} stream;

/* Wakes the stream because its token was revoked. Before `started` is set no wake is needed,
 * because a read follows anyway. */
static void lose_token(api_token_watch *watch)
{
    stream *s = (stream *)((char *)watch - offsetof(stream, watch));
    if (atomic_load(&s->started)) {
        s->wake(s->context);
    }
}

static void start(void *self, void (*wake)(void *context), void *context)
{
    stream *s = self;
    s->wake = wake;
    s->context = context;
    s->inner.start(s->inner.self, wake, context);
    api_tokens_watch(s->tokens, &s->watch);
    atomic_store(&s->started, true);
}

static bool is_between_events(const stream *s)
{
    return !s->begun || (s->tail[0] == '\n' && s->tail[1] == '\n');
}

/* Returns how many of the next bytes of the stream still belong to the event of which a part was
 * sent before. */
static size_t rest_of_event(const stream *s, const char *bytes, size_t length)
{
    char before[2] = {s->tail[0], s->tail[1]};
    for (size_t i = 0; i < length; i++) {
        before[0] = before[1];
        before[1] = bytes[i];
        if (before[0] == '\n' && before[1] == '\n') {
            return i + 1;
        }
    }
    return length;
}

static int64_t say_bye(stream *s, char *buffer, size_t size)
{
    if (s->bye.length == 0) {
        api_event_bye(&s->bye, "token");
    }
    if (s->bye.failed) {
        return -1;
    }
    size_t left = s->bye.length - s->sent, length = left < size ? left : size;
    memcpy(buffer, s->bye.bytes + s->sent, length);
    s->sent += length;
    s->ended = s->sent == s->bye.length;
    return (int64_t)length;
}

static void remember_tail(stream *s, const char *bytes, size_t length)
{
    for (size_t i = length > 2 ? length - 2 : 0; i < length; i++) {
        s->tail[0] = s->tail[1];
        s->tail[1] = bytes[i];
    }
    s->begun = true;
}

static int64_t read_stream(void *self, char *buffer, size_t size)
{
    stream *s = self;
    bool good = s->sent == 0 && api_token_is_current(s->token, st_clock_utc());
    if (s->ended) {
        return 0;
    }
    if (!good && is_between_events(s)) {
        return say_bye(s, buffer, size);
    }
    int64_t got = s->inner.read(s->inner.self, buffer, size);
    if (!good && got == API_READ_WAIT) {
        /* -1 cuts the connection: the event cannot be completed, because the source has to wait for
         * its rest. */
        return -1;
    }
    if (got > 0) {
        got = good ? got : (int64_t)rest_of_event(s, buffer, (size_t)got);
        remember_tail(s, buffer, (size_t)got);
    }
    return got;
}

static void finish(void *self)
{
    stream *s = self;
    s->inner.finish(s->inner.self);
}

static void free_stream(void *self)
{
    stream *s = self;
    api_tokens_unwatch(s->tokens, &s->watch);
    s->inner.free(s->inner.self);
    api_text_clear(&s->bye);
    api_token_release(s->token);
    he_mem_free(s);
}

bool api_token_stream_new(api_tokens *tokens, api_token *token, const api_source *source,
                          api_source *out)
{
    stream *s = he_mem_zero(1, sizeof *s);
    if (s == NULL) {
        return false;
    }
    s->tokens = tokens;
    s->token = api_token_hold(token);
    s->inner = *source;
    s->watch = (api_token_watch){.token = token, .gone = lose_token};
    atomic_init(&s->started, false);
    *out = (api_source){.self = s,
                        .start = start,
                        .read = read_stream,
                        .finish = finish,
                        .free = free_stream,
                        .idle = source->idle};
    return true;
}
