/* Blocks that are kept for their next users (core/system/spare.h): each has one user at a time, few
 * are kept, and none while memory is full. */
#include "tests/unit/fixture.h"

#include "system/memory.h"
#include "system/spare.h"
#include "tests/failing.h"

#include <pthread.h>
#include <stdatomic.h>

enum { SIZE = 5000 };

/* In a build with AddressSanitizer no block is kept. */
#if defined(__SANITIZE_ADDRESS__)
enum { KEEPS = false };
#else
enum { KEEPS = true };
#endif

static void a_block_is_used_again(void **state)
{
    (void)state;
    st_spares spares = {0};
    void *first = st_spares_take(&spares, SIZE), *second = st_spares_take(&spares, SIZE);
    assert_non_null(first);
    assert_non_null(second);
    assert_ptr_not_equal(first, second);
    st_spares_put(&spares, first);
    void *again = st_spares_take(&spares, SIZE);
    assert_int_equal(again == first, KEEPS);
    st_spares_put(&spares, again);
    st_spares_put(&spares, second);
    st_spares_clear(&spares);
    st_spares_clear(&spares);
}

static void few_blocks_are_kept_and_none_when_memory_is_full(void **state)
{
    (void)state;
    enum { BLOCKS = 3 * ST_SPARES, BUDGET = 64 << 20 };
    st_spares spares = {0};
    void *blocks[BLOCKS];
    st_memory_install(0);
    const uint64_t before = st_memory_used();
    for (int round = 0; round < 2; round++) {
        const bool full = round > 0;
        for (int i = 0; i < BLOCKS; i++) {
            blocks[i] = st_spares_take(&spares, SIZE);
            assert_non_null(blocks[i]);
        }
        const uint64_t most = st_memory_used();
        if (full) {
            st_memory_set_budget(BUDGET);
            st_memory_count(BUDGET);
        }
        for (int i = 0; i < BLOCKS; i++) {
            st_spares_put(&spares, blocks[i]);
        }
        if (full) {
            st_memory_count(-(int64_t)BUDGET);
            st_memory_set_budget(0);
        }
        const uint64_t kept = (st_memory_used() - before) / ((most - before) / BLOCKS);
        assert_int_equal(kept, full || !KEEPS ? 0 : ST_SPARES);
    }
    st_spares_clear(&spares);
    assert_int_equal(st_memory_used(), before);
}

static void without_memory_only_a_kept_block_is_there(void **state)
{
    (void)state;
    st_spares spares = {0};
    void *block = st_spares_take(&spares, SIZE);
    assert_non_null(block);
    st_spares_put(&spares, block);
    failing_at(1);
    block = st_spares_take(&spares, SIZE);
    void *more = KEEPS ? st_spares_take(&spares, SIZE) : NULL;
    failing_off();
    assert_int_equal(block != NULL, KEEPS);
    assert_null(more);
    if (block != NULL) {
        st_spares_put(&spares, block);
    }
    st_spares_clear(&spares);
}

/* --- many threads --- */

typedef struct user {
    pthread_t thread;
    st_spares *spares;
    int number;
    bool ok;
} user;

/* Takes blocks, writes to them, and finds what it has written: no other thread has them. */
static void *use(void *context)
{
    enum { TURNS = 20000, AT_ONCE = 3 };
    user *u = context;
    u->ok = true;
    for (int turn = 0; turn < TURNS && u->ok; turn++) {
        int *blocks[AT_ONCE];
        for (int i = 0; i < AT_ONCE; i++) {
            blocks[i] = st_spares_take(u->spares, SIZE);
            u->ok = u->ok && blocks[i] != NULL;
            if (blocks[i] != NULL) {
                blocks[i][0] = blocks[i][SIZE / sizeof(int) - 1] = u->number;
            }
        }
        for (int i = 0; i < AT_ONCE; i++) {
            u->ok = u->ok && blocks[i][0] == u->number &&
                    blocks[i][SIZE / sizeof(int) - 1] == u->number;
            st_spares_put(u->spares, blocks[i]);
        }
    }
    return NULL;
}

static void each_block_has_one_user(void **state)
{
    (void)state;
    enum { USERS = 4 };
    st_spares spares = {0};
    user users[USERS];
    for (int i = 0; i < USERS; i++) {
        users[i] = (user){.spares = &spares, .number = i + 1};
        assert_int_equal(pthread_create(&users[i].thread, NULL, use, &users[i]), 0);
    }
    for (int i = 0; i < USERS; i++) {
        pthread_join(users[i].thread, NULL);
        assert_true(users[i].ok);
    }
    st_spares_clear(&spares);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_memory_only_a_kept_block_is_there),
        cmocka_unit_test(a_block_is_used_again),
        cmocka_unit_test(few_blocks_are_kept_and_none_when_memory_is_full),
        cmocka_unit_test(each_block_has_one_user),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
