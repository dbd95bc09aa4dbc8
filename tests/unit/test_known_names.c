/* Tests of errors about unknown names: the message must list the names that exist, or suggest the
 * one that was probably meant. */
#include "api/json/known_names.h"

#include "fixture.h"

typedef struct pair_case {
    const char *a, *b;
    size_t distance;
} pair_case;

static const pair_case pairs[] = {
    {"", "", 0},
    {"cube", "cube", 0},
    {"cube", "", 4},
    {"cube", "cub", 1},
    {"cube", "ucbe", 1},
    {"cube", "tube", 1},
    {"kitten", "sitting", 3},
    {"split_edge", "edge_split", 1},
    {"edge_split", "edge_flip", 3},
    {"a_b_c", "c_a_b", 1},
    {"a_b", "a_c", 1},
};

static void the_distance_counts_letters_and_neighbours_exchanged(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        assert_int_equal(api_name_distance(pairs[i].a, pairs[i].b), pairs[i].distance);
        assert_int_equal(api_name_distance(pairs[i].b, pairs[i].a), pairs[i].distance);
    }
    char longer[80] = {0};
    memset(longer, 'x', 65);
    assert_true(api_name_distance(longer, longer) == SIZE_MAX);
}

static const char *text_of(api_known_names *known, const char *wanted, const char *const *names)
{
    *known = (api_known_names){.wanted = wanted};
    for (; *names != NULL; names++) {
        api_known_names_add(known, *names);
    }
    return api_known_names_text(known);
}

static void a_name_like_the_wanted_one_is_offered(void **state)
{
    (void)state;
    static const char *const shapes[] = {"cube", "torus", "tetrahedron", NULL};
    api_known_names known;
    assert_string_equal(text_of(&known, "cub", shapes), "; did you mean \"cube\"?");
    assert_string_equal(text_of(&known, "tetraeder", shapes),
                        "; there are cube, torus, tetrahedron");
    assert_string_equal(text_of(&known, "tetrahedra", shapes), "; did you mean \"tetrahedron\"?");
    assert_string_equal(text_of(&known, "", shapes), "; there are cube, torus, tetrahedron");
}

static void what_does_not_fit_the_list_is_told_by_dots(void **state)
{
    (void)state;
    api_known_names known = {.wanted = "?"};
    assert_string_equal(api_known_names_text(&known), "");
    api_known_names_add(&known, "one");
    assert_string_equal(api_known_names_text(&known), "; there is one");
    for (int i = 0; i < 100; i++) {
        api_known_names_add(&known, "another_name");
    }
    const char *text = api_known_names_text(&known);
    size_t length = strlen(text);
    assert_in_range(length, 150, sizeof known.text - 1);
    assert_string_equal(text + length - 5, ", ...");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_distance_counts_letters_and_neighbours_exchanged),
        cmocka_unit_test(a_name_like_the_wanted_one_is_offered),
        cmocka_unit_test(what_does_not_fit_the_list_is_told_by_dots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
