/* event_stream.c - GET .../events: the changes of a mesh as they happen. */
#include "api/request/handlers.h"

#include "api/event/event_follow.h"
#include "api/event/events.h"

/* Reads after which revision the client wants events. A browser that reconnects repeats its request
 * with Last-Event-ID, which is newer than the `since` in the URL. A Last-Event-ID that this server
 * did not make is not refused, because a browser would not reconnect after a refusal; it is treated
 * like an id of another mesh, for which the client gets `resync`. */
static bool read_since(api_exchange *x, st_since *since)
{
    const char *last = x->request.headers[API_HEADER_LAST_EVENT_ID];
    const char *text = api_param_text(x, "since");
    if (last != NULL && last[0] != '\0') {
        if (!api_since_read(last, since)) {
            *since = (st_since){.given = true, .has_incarnation = true};
        }
        return true;
    }
    return text == NULL || api_since_read(text, since) ||
           api_fail(x, API_BAD_PARAMETER,
                    "\"since\" must be the id of an event or a revision, not \"%.100s\"", text);
}

void api_events_get(api_exchange *x)
{
    st_since since = {0};
    api_source source;
    if (!read_since(x, &since)) {
        return;
    }
    const api_event_shared shared = {&x->service->backfills, x->service->presences};
    st_status status = api_event_follow(x->mesh, &since, &shared, &x->info, &source);
    if (status != ST_OK) {
        api_fail_store(x, status);
        return;
    }
    x->has_info = true;
    api_answer_live(x, 200, "text/event-stream", &source);
    api_answer_header(x, "X-Accel-Buffering", "no");
}
