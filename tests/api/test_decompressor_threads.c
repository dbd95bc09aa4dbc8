/* Several threads decompress many request bodies at once: each body is decompressed or evicted, and
 * the memory for decoders stays below its limit. */
#include "api/header/decompressor.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { THREADS = 4, OPEN = 16, ROUNDS = 15, ALL = THREADS * OPEN };

static api_decompressor_room room;
static _Atomic unsigned unfolded, gone;

static bool take(void *context, const char *bytes, size_t length)
{
    (void)bytes;
    *(size_t *)context += length;
    return true;
}

/* Parts of a zstd frame: `head` is the frame header, with a window of 8 MiB, and an empty block;
 * `block` is a block of 1,024 zeros; `last` is such a block that ends the frame. */
static const char head[] = {0x28, (char)0xB5, 0x2F, (char)0xFD, 0, 13 << 3, 0, 0, 0};
static const char block[] = {2, 1 << 5, 0, '\0'}, last[] = {3, 1 << 5, 0, '\0'};

static bool feed(api_decompressor *u, const char *bytes, size_t length)
{
    api_problem problem = {0};
    size_t used = 0;
    bool good = api_decompressor_feed(u, bytes, length, &used, &problem);
    assert_true(good || problem.code == API_TOO_MANY_CODED);
    assert_true(atomic_load(&room.lent) <= API_MAX_DECOMPRESSING);
    return good;
}

/* Decompresses many bodies at the same time, a part of each in turn. Their windows need more memory
 * than there is for decoders; each body that was not evicted must be decompressed completely. */
static void *unfold_many(void *context)
{
    (void)context;
    api_decompressor *open[OPEN] = {NULL};
    size_t lengths[OPEN];
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < OPEN; i++) {
            api_problem problem = {0};
            lengths[i] = 0;
            open[i] = api_decompressor_new(API_ZSTD, &room, take, &lengths[i], &problem);
            if (open[i] != NULL && !feed(open[i], head, sizeof head)) {
                api_decompressor_free(open[i]);
                open[i] = NULL;
                gone++;
            }
        }
        for (int i = 0; i < OPEN; i++) {
            api_problem problem = {0};
            if (open[i] != NULL && feed(open[i], block, sizeof block) &&
                feed(open[i], last, sizeof last) && api_decompressor_end(open[i], &problem)) {
                assert_int_equal(lengths[i], 2048);
                unfolded++;
            } else {
                gone++;
            }
            api_decompressor_free(open[i]);
        }
    }
    return NULL;
}

static void bodies_unfold_or_give_way_on_many_threads(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, unfold_many, NULL), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_int_equal(atomic_load(&room.lent), 0);
    print_message("note: %u bodies unfolded, %u gave way\n", unfolded, gone);
    assert_true(unfolded > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bodies_unfold_or_give_way_on_many_threads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
