/* The search for the first repeated id in a list: it must work if the list has few or many ids, and
 * if the ids are close together or far apart. Its memory must not depend on the size of the
 * mesh. */
#include "fixture.h"

#include "edit/piece/list.h"

enum { COUNT = 1000 };

/* size of the largest block of memory that was requested */
static size_t largest;

static void *measure(void *context, void *memory, size_t size)
{
    (void)context;
    largest = size > largest ? size : largest;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    return realloc(memory, size);
}

static const he_mem_hook measuring = {measure, NULL};

static size_t find(const uint32_t *ids, size_t count)
{
    size_t at = SIZE_MAX;
    assert_int_equal(he_list_repeat(ids, count, &at, NULL), HE_OK);
    return at;
}

static void the_first_repeat_is_found_however_far_apart_ids_are(void **state)
{
    (void)state;
    static const uint32_t steps[] = {1, 2, 300, 70000, 4000000};
    uint32_t ids[COUNT];
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
        for (size_t count = 0; count <= COUNT; count += count < 40 ? 1 : 96) {
            for (uint32_t i = 0; i < count; i++) {
                ids[i] = 7 + steps[k] * (uint32_t)(count - i);
            }
            assert_int_equal(find(ids, count), count);
            if (count > 2) {
                ids[count - 1] = ids[1];
                assert_int_equal(find(ids, count), count - 1);
                ids[count / 2 + 1] = ids[0];
                assert_int_equal(find(ids, count), count / 2 + 1);
            }
        }
    }
}

static void a_list_of_ids_far_apart_takes_memory_by_its_length(void **state)
{
    (void)state;
    uint32_t ids[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        ids[i] = i * 4000000u;
    }
    he_mem_set_hook(&measuring);
    largest = 0;
    assert_int_equal(find(ids, COUNT), COUNT);
    he_mem_set_hook(NULL);
    assert_true(largest <= COUNT * 64);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_repeat_is_found_however_far_apart_ids_are),
        cmocka_unit_test(a_list_of_ids_far_apart_takes_memory_by_its_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
