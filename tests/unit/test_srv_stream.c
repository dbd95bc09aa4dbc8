/* Tests of event streams that wait for events: a suspended stream must be resumed exactly once,
 * whatever ends its wait and whenever this happens; a comment must be sent if there are no events
 * for some time; and a stop must end all streams. */
#include "tests/unit/fixture.h"

#include "server/http/http_stream.h"

#include <pthread.h>
#include <string.h>

enum { STREAMS = 40, NEWS = 2000, LONG = 1000000000 };

/* A stream and its source of events. Each event is one byte. `told` is the number of events that
 * were announced, `read` is the number of events that were read. */
typedef struct talk {
    srv_stream stream;
    pthread_mutex_t lock;
    void (*wake)(void *context);
    void *context;
    unsigned told, read, starts, finishes;
    bool waiting, finished;
    /* The members from here on are used by the threads that stand for the server's workers. */
    bool aside, begun, ended;
    unsigned comments;
    struct talk *next;
} talk;

static void start(void *self, void (*wake)(void *context), void *context)
{
    talk *t = self;
    t->wake = wake;
    t->context = context;
    t->starts++;
}

static int64_t read_talk(void *self, char *buffer, size_t size)
{
    talk *t = self;
    int64_t got = 0;
    pthread_mutex_lock(&t->lock);
    while ((size_t)got < size && t->read < t->told) {
        buffer[got++] = '.';
        t->read++;
    }
    if (got == 0 && !t->finished) {
        t->waiting = true;
        got = API_READ_WAIT;
    }
    pthread_mutex_unlock(&t->lock);
    return got;
}

static void finish(void *self)
{
    talk *t = self;
    pthread_mutex_lock(&t->lock);
    t->finished = true;
    t->finishes++;
    pthread_mutex_unlock(&t->lock);
}

static void tell(talk *t)
{
    pthread_mutex_lock(&t->lock);
    t->told++;
    if (t->waiting) {
        t->waiting = false;
        t->wake(t->context);
    }
    pthread_mutex_unlock(&t->lock);
}

/* --- threads that read resumed streams, as the threads of libmicrohttpd do --- */

static struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    talk *ready;
    size_t open;
    unsigned comments;
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};

static srv_streams *streams;
static talk talks[STREAMS];
static api_source sources[STREAMS];

static void resume(srv_stream *stream)
{
    talk *t = (talk *)((char *)stream - offsetof(talk, stream));
    pthread_mutex_lock(&pool.lock);
    assert_true(t->aside);
    t->aside = false;
    t->next = pool.ready;
    pool.ready = t;
    pthread_cond_broadcast(&pool.changed);
    pthread_mutex_unlock(&pool.lock);
}

/* Reads the stream until it has to wait or ends. */
static void pull(talk *t)
{
    char buffer[64];
    int64_t got;
    if (!t->begun) {
        t->begun = true;
        srv_stream_begin(streams, &t->stream, &sources[t - talks], -1, resume);
    }
    while ((got = srv_stream_read(&t->stream, buffer, sizeof buffer)) > 0) {
        pthread_mutex_lock(&pool.lock);
        if (got == 4 && memcmp(buffer, "idle", 4) == 0) {
            t->comments++;
            pool.comments++;
            pthread_cond_broadcast(&pool.changed);
        }
        pthread_mutex_unlock(&pool.lock);
    }
    pthread_mutex_lock(&pool.lock);
    if (got == API_READ_WAIT) {
        t->aside = true;
        pthread_mutex_unlock(&pool.lock);
        srv_stream_aside(&t->stream);
        return;
    }
    assert_int_equal(got, 0);
    t->ended = true;
    pool.open--;
    pthread_cond_broadcast(&pool.changed);
    pthread_mutex_unlock(&pool.lock);
}

static void *work(void *context)
{
    (void)context;
    pthread_mutex_lock(&pool.lock);
    while (pool.open > 0) {
        talk *t = pool.ready;
        if (t == NULL) {
            pthread_cond_wait(&pool.changed, &pool.lock);
            continue;
        }
        pool.ready = t->next;
        pthread_mutex_unlock(&pool.lock);
        pull(t);
        pthread_mutex_lock(&pool.lock);
    }
    pthread_mutex_unlock(&pool.lock);
    return NULL;
}

enum { WORKERS = 2 };

static pthread_t workers[WORKERS];

static void open_pool(uint64_t heartbeat)
{
    streams = srv_streams_new(heartbeat);
    assert_non_null(streams);
    pool.ready = NULL;
    pool.open = STREAMS;
    pool.comments = 0;
    for (size_t i = 0; i < STREAMS; i++) {
        talks[i] = (talk){.next = pool.ready};
        pthread_mutex_init(&talks[i].lock, NULL);
        sources[i] = (api_source){
            .self = &talks[i], .start = start, .read = read_talk, .finish = finish, .idle = "idle"};
        pool.ready = &talks[i];
    }
    for (size_t i = 0; i < WORKERS; i++) {
        assert_int_equal(pthread_create(&workers[i], NULL, work, NULL), 0);
    }
}

static void close_pool(void)
{
    srv_streams_stop(streams);
    for (size_t i = 0; i < WORKERS; i++) {
        pthread_join(workers[i], NULL);
    }
    srv_streams_free(streams);
    for (size_t i = 0; i < STREAMS; i++) {
        assert_true(talks[i].ended);
        assert_int_equal(talks[i].starts, 1);
        assert_int_equal(talks[i].finishes, 1);
        assert_int_equal(talks[i].read, talks[i].told);
        pthread_mutex_destroy(&talks[i].lock);
    }
}

static void *talk_to_half(void *context)
{
    size_t first = *(const size_t *)context;
    for (unsigned i = 0; i < NEWS; i++) {
        tell(&talks[first + 2 * (i * 7 % (STREAMS / 2))]);
    }
    return NULL;
}

static void all_that_is_told_is_read(void **state)
{
    (void)state;
    static const size_t halves[] = {0, 1};
    pthread_t tellers[2];
    open_pool(LONG);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(pthread_create(&tellers[i], NULL, talk_to_half, (void *)&halves[i]), 0);
    }
    for (size_t i = 0; i < 2; i++) {
        pthread_join(tellers[i], NULL);
    }
    close_pool();
    for (size_t i = 0; i < STREAMS; i++) {
        assert_int_equal(talks[i].comments, 0);
    }
}

static void silence_is_filled(void **state)
{
    (void)state;
    open_pool(1000);
    pthread_mutex_lock(&pool.lock);
    while (pool.comments < 20 * STREAMS) {
        pthread_cond_wait(&pool.changed, &pool.lock);
    }
    pthread_mutex_unlock(&pool.lock);
    tell(&talks[3]);
    close_pool();
    for (size_t i = 0; i < STREAMS; i++) {
        assert_true(talks[i].comments > 0);
    }
}

/* When the server stops, some streams were never read, some are being read, and some are
 * suspended. */
static void a_stop_finds_them_all(void **state)
{
    (void)state;
    for (int i = 0; i < 50; i++) {
        open_pool(LONG);
        close_pool();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_is_told_is_read),
        cmocka_unit_test(silence_is_filled),
        cmocka_unit_test(a_stop_finds_them_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
