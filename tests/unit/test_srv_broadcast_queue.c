/* Tests of the queue of events: every listener must read all messages in order, but no message
 * before it is released as durable. A slow listener must learn that it missed messages, and the
 * queue must not keep messages for a slow listener. */
#include "tests/unit/fixture.h"

#include "store/publish/broadcast_queue.h"
#include "tests/failing.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static st_queue feed;
static st_queue_counts counts;

static int setup(void **state)
{
    (void)state;
    st_queue_init(&feed, (st_place){.stamp = 7, .key = 3}, &counts);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    st_queue_clear(&feed);
    return 0;
}

static void count_wake(void *context)
{
    ++*(unsigned *)context;
}

static void join(st_listener *listener, unsigned *wakes)
{
    assert_true(st_queue_listen(&feed, listener, SIZE_MAX));
    st_queue_wake(listener, count_wake, wakes);
}

/* Adds a message whose text is its stamp: the position in the journal up to which changes must be
 * durable before the message may be read. */
static void add(uint64_t stamp, uint64_t key)
{
    char text[32];
    int length = snprintf(text, sizeof text, "%llu;", (unsigned long long)stamp);
    st_queue_add(&feed, (st_place){stamp, key}, text, (size_t)length);
}

static void assert_reads(st_listener *listener, const char *expected)
{
    char text[256];
    size_t length = 0, got = 0;
    while (st_queue_read(listener, text + length, 3, &got) == ST_QUEUE_GOT) {
        length += got;
        assert_true(length + 3 < sizeof text);
    }
    text[length] = '\0';
    assert_string_equal(text, expected);
}

static void assert_step(st_listener *listener, st_queue_result expected)
{
    char text[256];
    size_t got;
    assert_int_equal(st_queue_read(listener, text, sizeof text, &got), expected);
}

static void everybody_reads_everything_once(void **state)
{
    (void)state;
    st_listener early, late;
    unsigned early_wakes = 0, late_wakes = 0;
    join(&early, &early_wakes);
    add(8, 4);
    st_queue_allow(&feed, 8);
    join(&late, &late_wakes);
    add(9, 5);
    st_queue_allow(&feed, 9);
    assert_int_equal(early_wakes,
                     0); /* the listener `early` is not waiting, so it must not be woken */
    assert_reads(&early, "8;9;");
    assert_reads(&late, "9;");
    add(10, 5);
    st_queue_allow(&feed, 10);
    assert_int_equal(early_wakes, 1);
    add(12, 6);
    st_queue_allow(&feed, 12);
    assert_int_equal(early_wakes,
                     1); /* a listener is woken once per wait, not once for each message */
    assert_int_equal(late_wakes, 1);
    assert_reads(&early, "10;12;");
    assert_reads(&late, "10;12;");
    st_queue_leave(&early);
    st_queue_leave(&late);
}

static void what_is_not_allowed_is_not_read(void **state)
{
    (void)state;
    st_listener listener;
    unsigned wakes = 0;
    join(&listener, &wakes);
    assert_step(&listener, ST_QUEUE_WAIT);
    add(8, 4);
    add(9, 5);
    add(10, 6);
    assert_int_equal(wakes, 0);
    assert_reads(&listener, "");
    st_queue_allow(&feed, 9);
    assert_int_equal(wakes, 1);
    assert_reads(&listener, "8;9;");
    st_queue_end(&feed);
    /* message 10 must be read before the listener learns that the queue has ended, but it is not
     * released yet */
    assert_step(&listener, ST_QUEUE_WAIT);
    st_queue_allow(&feed, 10);
    assert_reads(&listener, "10;");
    assert_step(&listener, ST_QUEUE_ENDED);
    st_queue_leave(&listener);
}

static void what_is_beside_a_message_comes_after_it(void **state)
{
    (void)state;
    st_listener listener, late;
    unsigned wakes = 0;
    join(&listener, &wakes);
    st_queue_allow(&feed, 7);
    assert_reads(&listener, "");
    st_queue_add_beside(&feed, "a;", 2);
    assert_int_equal(wakes, 1);
    add(8, 4);
    st_queue_add_beside(&feed, "b;", 2);
    st_queue_add_beside(&feed, "c;", 2);
    assert_reads(&listener,
                 "a;"); /* message 8 is not released yet, so messages 8, b and c must not be read */
    assert_int_equal(wakes, 1);
    add(9, 5);
    st_queue_allow(&feed, 9);
    assert_reads(&listener, "8;b;c;9;");
    join(&late, &wakes);
    assert_true(st_queue_rewind(&late, 4));
    assert_reads(&late, "b;c;9;");
    assert_true(st_queue_rewind(&late, 3));
    assert_reads(&late, "a;8;b;c;9;");
    st_queue_add_beside(&feed, NULL, 0);
    assert_step(&listener, ST_QUEUE_BEHIND);
    assert_int_equal(st_queue_skip(&listener).key, 5);
    st_queue_end(&feed);
    st_queue_add_beside(&feed, "d;", 2);
    assert_step(&listener, ST_QUEUE_ENDED);
    st_queue_leave(&listener);
    st_queue_leave(&late);
}

static void a_nudge_is_noticed_once_and_after_all_messages(void **state)
{
    (void)state;
    st_listener listener, late;
    unsigned wakes = 0, late_wakes = 0;
    join(&listener, &wakes);
    assert_step(&listener, ST_QUEUE_WAIT);
    st_queue_nudge(&feed);
    st_queue_nudge(&feed);
    assert_int_equal(wakes, 1);
    assert_step(&listener, ST_QUEUE_NUDGED);
    assert_step(&listener, ST_QUEUE_WAIT);
    /* A listener that does not wait is not woken, but learns of the nudge when it would wait. */
    st_queue_allow(&feed, 7);
    add(8, 4);
    st_queue_allow(&feed, 8);
    assert_int_equal(wakes, 2);
    st_queue_nudge(&feed);
    assert_int_equal(wakes, 2);
    char text[8];
    size_t got;
    assert_int_equal(st_queue_read(&listener, text, sizeof text, &got), ST_QUEUE_GOT);
    assert_step(&listener, ST_QUEUE_NUDGED);
    assert_step(&listener, ST_QUEUE_WAIT);
    join(&late, &late_wakes);
    assert_step(&late, ST_QUEUE_WAIT);
    st_queue_end(&feed);
    st_queue_nudge(&feed);
    assert_step(&listener, ST_QUEUE_ENDED);
    st_queue_leave(&listener);
    st_queue_leave(&late);
}

static void who_is_slow_is_behind_once(void **state)
{
    (void)state;
    st_listener slow, middle;
    unsigned wakes = 0;
    char byte[2];
    size_t got;
    join(&slow, &wakes);
    join(&middle, &wakes);
    add(8, 4);
    st_queue_allow(&feed, 8);
    assert_int_equal(st_queue_read(&middle, byte, 1, &got), ST_QUEUE_GOT);
    uint64_t stamp = 9;
    for (; stamp < 9 + ST_QUEUE_MESSAGES + 10; stamp++) {
        add(stamp, stamp);
    }
    assert_int_equal(feed.count, ST_QUEUE_MESSAGES);
    /* A slow listener has missed messages. It may learn the position from which it can continue
     * only when this position is durable. */
    assert_step(&slow, ST_QUEUE_WAIT);
    st_queue_allow(&feed, stamp - 3);
    assert_step(&slow, ST_QUEUE_BEHIND);
    st_place place = st_queue_skip(&slow);
    assert_int_equal(place.stamp, stamp - 3);
    assert_int_equal(place.key, stamp - 3);
    assert_step(&slow, ST_QUEUE_WAIT);
    /* A slow listener that has read the first part of a message must still get the rest of this
     * message. */
    assert_int_equal(st_queue_read(&middle, byte, 2, &got), ST_QUEUE_GOT);
    assert_int_equal(got, 1);
    assert_int_equal(byte[0], ';');
    assert_step(&middle, ST_QUEUE_BEHIND);
    st_queue_allow(&feed, stamp);
    assert_step(&slow, ST_QUEUE_GOT);
    st_queue_leave(&slow);
    st_queue_leave(&middle);
}

static void bytes_are_bounded_too(void **state)
{
    (void)state;
    enum { LARGE = 100 * 1000 };
    static char text[LARGE];
    st_listener slow;
    unsigned wakes = 0;
    join(&slow, &wakes);
    memset(text, 'x', sizeof text);
    for (uint64_t stamp = 8; stamp < 100; stamp++) {
        st_queue_add(&feed, (st_place){stamp, stamp}, text, sizeof text);
        assert_true(feed.bytes <= ST_QUEUE_BYTES);
    }
    assert_int_equal(feed.count, ST_QUEUE_BYTES / LARGE);
    st_queue_shed(&feed); /* the queue keeps messages as long as it has a listener */
    assert_int_equal(feed.count, ST_QUEUE_BYTES / LARGE);
    st_queue_leave(&slow);
    /* the queue counts as followed for some time after its last listener has left */
    assert_true(st_queue_is_followed(&feed));
    st_queue_shed(&feed);
    assert_int_equal(feed.count, 0);
    assert_int_equal(feed.bytes, 0);
}

static void a_listener_goes_back_to_a_key(void **state)
{
    (void)state;
    st_listener listener;
    unsigned wakes = 0;
    join(&listener, &wakes);
    add(8, 4);
    add(9, 4); /* message 9 is about a change that makes no new revision, so it has the revision of
                  message 8 */
    add(10, 5);
    st_queue_allow(&feed, 10);
    assert_true(st_queue_rewind(&listener, 3));
    assert_reads(&listener, "8;9;10;");
    assert_true(st_queue_rewind(&listener, 4));
    assert_reads(&listener, "9;10;");
    assert_true(st_queue_rewind(&listener, 5));
    assert_reads(&listener, "");
    assert_false(st_queue_rewind(&listener, 2));
    assert_false(st_queue_rewind(&listener, 6));
    st_queue_leave(&listener);
}

static void only_so_many_may_listen(void **state)
{
    (void)state;
    st_listener listener[3];
    assert_true(st_queue_listen(&feed, &listener[0], 2));
    assert_true(st_queue_listen(&feed, &listener[1], 2));
    assert_false(st_queue_listen(&feed, &listener[2], 2));
    st_queue_leave(&listener[0]);
    assert_true(st_queue_listen(&feed, &listener[2], 2));
    st_queue_leave(&listener[1]);
    st_queue_leave(&listener[2]);
}

static void a_message_without_memory_is_a_gap(void **state)
{
    (void)state;
    st_listener listener;
    unsigned wakes = 0;
    join(&listener, &wakes);
    add(8, 4);
    failing_at(1);
    add(9, 5);
    assert_int_equal(failing_count(), 1);
    failing_off();
    st_queue_allow(&feed, 9);
    assert_step(&listener, ST_QUEUE_BEHIND);
    assert_int_equal(st_queue_skip(&listener).key, 5);
    add(10, 6);
    st_queue_add(&feed, (st_place){11, 7}, NULL, 0);
    add(12, 8);
    st_queue_allow(&feed, 12);
    assert_step(&listener, ST_QUEUE_BEHIND);
    assert_int_equal(st_queue_skip(&listener).key, 8);
    st_queue_leave(&listener);
}

/* --- threads --- */

enum { LISTENERS = 6, MESSAGES = 20000 };

typedef struct reader {
    pthread_t thread;
    st_listener listener;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool woken, leaves;
    uint64_t last; /* stamp of the last message that the reader has read */
    unsigned behind;
} reader;

static void wake_reader(void *context)
{
    reader *r = context;
    pthread_mutex_lock(&r->lock);
    assert_false(r->woken);
    r->woken = true;
    pthread_cond_signal(&r->changed);
    pthread_mutex_unlock(&r->lock);
}

static void wait_for_wake(reader *r)
{
    pthread_mutex_lock(&r->lock);
    while (!r->woken) {
        pthread_cond_wait(&r->changed, &r->lock);
    }
    r->woken = false;
    pthread_mutex_unlock(&r->lock);
}

/* A message is a stamp of eight bytes; a read must return whole messages, without gaps. */
static void take(reader *r, const char *bytes, size_t length)
{
    for (size_t at = 0; at < length; at += sizeof(uint64_t)) {
        uint64_t stamp;
        memcpy(&stamp, bytes + at, sizeof stamp);
        assert_int_equal(stamp, r->last + 1);
        r->last = stamp;
    }
}

static void *read_feed(void *context)
{
    reader *r = context;
    char buffer[16 * sizeof(uint64_t)];
    for (;;) {
        size_t got = 0;
        st_queue_result step = st_queue_read(&r->listener, buffer, sizeof buffer, &got);
        if (step == ST_QUEUE_GOT) {
            take(r, buffer, got);
        } else if (step == ST_QUEUE_WAIT) {
            wait_for_wake(r);
        } else if (step == ST_QUEUE_BEHIND) {
            r->last = st_queue_skip(&r->listener).stamp;
            r->behind++;
        } else {
            break;
        }
        if (r->leaves && r->last > MESSAGES / 2) {
            break;
        }
    }
    st_queue_leave(&r->listener);
    return NULL;
}

static void threads_read_what_one_writes(void **state)
{
    (void)state;
    static reader readers[LISTENERS];
    for (size_t i = 0; i < LISTENERS; i++) {
        reader *r = &readers[i];
        *r = (reader){.last = 7, .leaves = i == 0};
        pthread_mutex_init(&r->lock, NULL);
        pthread_cond_init(&r->changed, NULL);
        assert_true(st_queue_listen(&feed, &r->listener, LISTENERS));
        st_queue_wake(&r->listener, wake_reader, r);
        assert_int_equal(pthread_create(&r->thread, NULL, read_feed, r), 0);
    }
    for (uint64_t stamp = 8; stamp <= MESSAGES; stamp++) {
        st_queue_add(&feed, (st_place){stamp, stamp}, (const char *)&stamp, sizeof stamp);
        if (stamp % 3 == 0 || stamp == MESSAGES) {
            st_queue_allow(&feed, stamp);
        }
    }
    st_queue_end(&feed);
    unsigned behind = 0;
    for (size_t i = 0; i < LISTENERS; i++) {
        pthread_join(readers[i].thread, NULL);
        assert_true(readers[i].leaves || readers[i].last == MESSAGES);
        behind += readers[i].behind;
        pthread_mutex_destroy(&readers[i].lock);
        pthread_cond_destroy(&readers[i].changed);
    }
    assert_int_equal(feed.listeners, 0);
    printf("note: %d messages to %d threads, behind %u times\n", MESSAGES, LISTENERS, behind);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(everybody_reads_everything_once),
        TEST(what_is_not_allowed_is_not_read),
        TEST(what_is_beside_a_message_comes_after_it),
        TEST(a_nudge_is_noticed_once_and_after_all_messages),
        TEST(who_is_slow_is_behind_once),
        TEST(bytes_are_bounded_too),
        TEST(a_listener_goes_back_to_a_key),
        TEST(only_so_many_may_listen),
        TEST(a_message_without_memory_is_a_gap),
        TEST(threads_read_what_one_writes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
