/* Tests of the daemon's memory: freed memory must be returned to the system when the process is
 * idle, and an error must say whether the memory budget was the reason why memory was refused. */
#include "tests/unit/fixture.h"

#include "api/json/problem.h"
#include "base/mem.h"
#include "system/memory.h"
#include "tests/failing.h"

#include <stdio.h>
#include <unistd.h>

#define MILLIS UINT64_C(1000)

static void pages_are_given_back_once_after_work_when_it_rests(void **state)
{
    (void)state;
    st_memory_rest rest = {0};
    assert_false(st_memory_rests(&rest, 10 * MILLIS)); /* the process has done hardly any work */
    assert_false(st_memory_rests(&rest, 400 * MILLIS));
    assert_false(st_memory_rests(&rest, 450 * MILLIS)); /* the process is busy */
    assert_true(st_memory_rests(&rest, 499 * MILLIS));
    assert_false(st_memory_rests(&rest, 499 * MILLIS));
    assert_false(st_memory_rests(&rest, 518 * MILLIS));
    assert_true(st_memory_rests(&rest, 519 * MILLIS)); /* 20 ms of work since memory was returned */
    assert_false(st_memory_rests(&rest, 520 * MILLIS));
}

/* The sanitizers replace the allocator of the C library, so the test measures nothing if a
 * sanitizer is used. */
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
/* 64 MiB in all; the test frees all blocks except every 64th */
enum { BLOCKS = 4096, BLOCK = 16 * 1024, KEPT = 64 };

static size_t resident_bytes(void)
{
    size_t all = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%zu %zu", &all, &resident), 2);
    fclose(file);
    return resident * (size_t)sysconf(_SC_PAGESIZE);
}

static void what_is_freed_between_used_blocks_goes_back_to_the_system(void **state)
{
    (void)state;
    static void *blocks[BLOCKS];
    st_memory_install(0);
    for (size_t i = 0; i < BLOCKS; i++) {
        blocks[i] = he_mem_zero(1, BLOCK);
        assert_non_null(blocks[i]);
        memset(blocks[i], 1, BLOCK);
    }
    size_t full = resident_bytes();
    for (size_t i = 0; i < BLOCKS; i++) {
        if (i % KEPT != KEPT - 1) {
            he_mem_free(blocks[i]);
        }
    }
    st_memory_rest rest = {0};
    assert_true(st_memory_rests(&rest, 20 * MILLIS));
    assert_true(resident_bytes() < full - (size_t)BLOCKS * BLOCK / 10 * 9);
    for (size_t i = KEPT - 1; i < BLOCKS; i += KEPT) {
        he_mem_free(blocks[i]);
    }
}

/* Returns whether the process has asked the kernel for huge pages at this address. */
static bool asks_for_huge_pages(const void *address)
{
    char line[512];
    unsigned long from = 0, to = 0;
    bool inside = false, asks = false;
    FILE *file = fopen("/proc/self/smaps", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "%lx-%lx ", &from, &to) == 2) {
            inside = (unsigned long)address >= from && (unsigned long)address < to;
        } else if (inside && strncmp(line, "VmFlags:", 8) == 0) {
            asks = strstr(line, " hg") != NULL;
        }
    }
    fclose(file);
    return asks;
}

/* Small blocks are in the heap, and freeing them makes room there for a large block. The large
 * block must nevertheless get a mapping of its own, because huge pages are requested only for such
 * mappings. */
static void large_blocks_have_huge_pages_only_in_mappings_of_their_own(void **state)
{
    (void)state;
    enum { PIECES = 32, PIECE = 512 * 1024, LARGE = 8 << 20, HUGE_BLOCK = 256 << 20 };
    void *pieces[PIECES];
    st_memory_install(0);
    for (size_t i = 0; i < PIECES; i++) {
        pieces[i] = he_mem_alloc(PIECE);
        assert_non_null(pieces[i]);
    }
    for (size_t i = 0; i + 1 < PIECES; i++) {
        he_mem_free(pieces[i]);
    }
    char *inside = he_mem_alloc(LARGE), *own = he_mem_alloc(HUGE_BLOCK);
    assert_non_null(inside);
    assert_non_null(own);
    assert_true(inside >= (char *)pieces[0] && inside < (char *)pieces[PIECES - 1]);
    assert_false(asks_for_huge_pages(inside + LARGE / 2));
    if (access("/sys/kernel/mm/transparent_hugepage/enabled", R_OK) == 0) {
        assert_true(asks_for_huge_pages(own + LARGE));
    }
    he_mem_free(own);
    he_mem_free(inside);
    he_mem_free(pieces[PIECES - 1]);
}
#endif

static void expect_code(const char *code)
{
    const api_problem problem = {.code = HE_NO_MEMORY, .detail = "no memory for it"};
    char member[64];
    api_text text = {0};
    (void)snprintf(member, sizeof member, "\"code\":\"%s\"", code);
    api_problem_write(&problem, NULL, &text);
    api_text_add_char(&text, '\0');
    assert_non_null(strstr(text.bytes, member));
    assert_non_null(strstr(text.bytes, "\"status\":507"));
    assert_non_null(strstr(api_problem_unwritten(), member));
    api_text_clear(&text);
}

static void a_refusal_names_the_budget_if_that_is_used_up(void **state)
{
    (void)state;
    expect_code("no_memory");
    st_memory_install(1 << 20);
    assert_null(he_mem_alloc(2 << 20));
    assert_true(st_memory_was_over_budget());
    expect_code("memory_budget");
    he_mem_set_hook(NULL);
}

/* A large block that grows gets a whole number of huge pages. A block that shrinks must not: it
 * could become larger than it was. */
static void a_block_shrinks_although_the_budget_is_used_up(void **state)
{
    (void)state;
    enum { MIB = 1 << 20, BLOCK_BYTES = 7 * MIB - 64 * 1024, NEW_BYTES = BLOCK_BYTES - 4096 };
    st_memory_install(0);
    const uint64_t before = st_memory_used();
    unsigned char *block = he_mem_alloc(BLOCK_BYTES);
    assert_non_null(block);
    memset(block, 7, BLOCK_BYTES);
    const uint64_t full = st_memory_used();
    st_memory_set_budget(full);
    assert_null(he_mem_alloc(1 << 20));
    block = he_mem_shrink(block, NEW_BYTES);
    assert_true(st_memory_used() <= full && block[NEW_BYTES - 1] == 7);
    block = he_mem_shrink(block, 5 * MIB);
    assert_in_range(st_memory_used() - before, 5 * MIB, 5 * MIB + 64 * 1024);
    assert_true(block[0] == 7 && block[5 * MIB - 1] == 7);
    he_mem_free(block);
    assert_true(st_memory_used() == before);
    he_mem_set_hook(NULL);
}

static void a_block_that_cannot_shrink_stays_as_it_is(void **state)
{
    (void)state;
    unsigned char *block = he_mem_alloc(5 << 20);
    assert_non_null(block);
    block[1000] = 7;
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        unsigned char *shrunk = he_mem_shrink(block, 5000);
        assert_non_null(shrunk);
        assert_true(f.n > 1 || shrunk == block);
        block = shrunk;
        (void)failing_end(&f, true);
    }
    assert_true(block[1000] == 7);
    he_mem_free(block);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refusal_names_the_budget_if_that_is_used_up),
        cmocka_unit_test(a_block_shrinks_although_the_budget_is_used_up),
        cmocka_unit_test(a_block_that_cannot_shrink_stays_as_it_is),
        cmocka_unit_test(pages_are_given_back_once_after_work_when_it_rests),
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
        cmocka_unit_test(what_is_freed_between_used_blocks_goes_back_to_the_system),
        cmocka_unit_test(large_blocks_have_huge_pages_only_in_mappings_of_their_own),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
