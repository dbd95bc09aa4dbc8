#include "tests/api/stream.h"

#include "api/event/events.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void wake(void *context)
{
    listener *l = context;
    pthread_mutex_lock(&l->lock);
    l->woken = true;
    pthread_cond_signal(&l->changed);
    pthread_mutex_unlock(&l->lock);
}

/* Opens an event stream. Returns NULL if the request was refused because memory is out; any other
 * refusal fails the test. */
listener *stream_try(api_bench *b, const char *path, const char *query, const char *last)
{
    api_request request = {.method = "GET",
                           .path = path,
                           .query = query,
                           .request_id = "test",
                           .headers = {[API_HEADER_LAST_EVENT_ID] = last}};
    api_exchange *x = api_handle(bench_service(b), &request, NULL, 0);
    if (x == NULL || api_answer_of(x)->status != 200) {
        assert_true(x == NULL || api_answer_of(x)->status == 507);
        api_free(x);
        return NULL;
    }
    listener *l = calloc(1, sizeof *l);
    assert_non_null(l);
    l->exchange = x;
    l->source = api_answer_of(x)->live;
    assert_non_null(l->source);
    assert_string_equal(l->source->idle, API_EVENT_IDLE);
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    l->source->start(l->source->self, wake, l);
    return l;
}

listener *stream_open(api_bench *b, const char *path, const char *query, const char *last)
{
    listener *l = stream_try(b, path, query, last);
    assert_non_null(l);
    return l;
}

void stream_close(listener *l)
{
    api_free(l->exchange);
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->changed);
    sse_clear(&l->events);
    cJSON_Delete(l->data);
    free(l);
}

static void wait_for_wake(listener *l)
{
    pthread_mutex_lock(&l->lock);
    while (!l->woken) {
        pthread_cond_wait(&l->changed, &l->lock);
    }
    l->woken = false;
    pthread_mutex_unlock(&l->lock);
}

/* Waits for the next event and returns its name, or "" at the end of the stream. If `patient` is
 * false, it does not wait: it also returns "" if no event is ready. */
const char *stream_next(listener *l, bool patient)
{
    char buffer[777];
    cJSON_Delete(l->data);
    l->data = NULL;
    while (!sse_next(&l->events, &l->event)) {
        int64_t got = l->source->read(l->source->self, buffer, sizeof buffer);
        if (got == API_READ_WAIT && patient) {
            wait_for_wake(l);
        } else if (got <= 0) {
            assert_true(got == 0 || got == API_READ_WAIT);
            return "";
        } else {
            sse_add(&l->events, buffer, (size_t)got);
        }
    }
    l->data = cJSON_Parse(l->event.data);
    assert_non_null(l->data);
    return l->event.name;
}

const char *stream_text(const listener *l, const char *member)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(l->data, member);
    return cJSON_IsString(found) ? found->valuestring : "";
}

uint64_t stream_number(const listener *l, const char *member)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(l->data, member);
    assert_true(cJSON_IsNumber(found));
    return (uint64_t)found->valuedouble;
}

st_mesh *stream_mesh(api_bench *b)
{
    st_store *store = bench_store(b);
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(store, "m", &mesh), ST_OK);
    return mesh;
}

/* Copies the present state of the mesh "m". */
void stream_dump(api_bench *b, mirror *m)
{
    st_mesh *mesh = stream_mesh(b);
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    mirror_take(m, content, info.revision);
    st_read_end(mesh);
    st_release(mesh);
}

void stream_require(api_bench *b, const mirror *copy, const char *after)
{
    char text[MIRROR_TEXT] = "";
    mirror fresh = {0};
    stream_dump(b, &fresh);
    assert_int_equal(copy->revision, fresh.revision);
    if (!mirror_equal(copy, &fresh, text)) {
        fail_msg("after %s the copy differs at %s", after, text);
    }
    mirror_clear(&fresh);
}

/* Reads all events that are ready and applies them to the copy. Returns how often the events did
 * not suffice, so that the whole mesh was copied again. */
unsigned stream_follow(api_bench *b, listener *l, mirror *copy)
{
    unsigned anew = 0;
    const char *name;
    while ((name = stream_next(l, false))[0] != '\0') {
        bool lost = strcmp(name, "resync") == 0;
        if (strcmp(name, "edit") == 0) {
            lost = mirror_apply(copy, l->data) == MIRROR_LOST;
        }
        if (lost) {
            stream_dump(b, copy);
            anew++;
        }
    }
    return anew;
}
