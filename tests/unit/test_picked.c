/* A client may choose values that would all collide in a hash table whose hash function it knows.
 * The work must nevertheless be proportional to the number of values, because the hash function has
 * a random seed. */
#include "unit/fixture.h"

#include "build/build.h"
#include "edit/merge/weld.h"
#include "format/io/export.h"
#include "mesh/delta.h"

#include "tests/pace.h"

#include <stdio.h>

enum { PICKED = 50000 };

/* --- names of labels that would collide --- */

/* Returns whether the FNV-1a hash of the name has a value in a small range, so that such names
 * would collide in any hash table of up to a million slots. */
static bool lies_low(const char *name)
{
    uint64_t h = 14695981039346656037u;
    for (const char *p = name; *p != '\0'; p++) {
        h = (h ^ (unsigned char)*p) * 1099511628211u;
    }
    return ((h ^ h >> 32) & ((1 << 20) - 1)) < 1 << 12;
}

typedef struct name {
    char text[12];
} name;

static double add_names(const void *context, size_t count)
{
    const name *names = context;
    he_labels *labels = he_labels_new();
    assert_non_null(labels);
    double from = pace_seconds();
    for (size_t i = 0; i < count; i++) {
        uint32_t number;
        assert_int_equal(he_labels_add(labels, names[i].text, strlen(names[i].text), &number, NULL),
                         HE_OK);
        assert_int_equal(number, i);
    }
    double seconds = pace_seconds() - from;
    he_labels_release(labels);
    return seconds;
}

static void names_cannot_be_picked_to_collide(void **state)
{
    (void)state;
    name *names = malloc(PICKED * sizeof *names);
    assert_non_null(names);
    for (unsigned i = 0, count = 0; count < PICKED; i++) {
        snprintf(names[count].text, sizeof names[count].text, "%x", i);
        count += lies_low(names[count].text);
    }
    pace_require_linear("names", add_names, names, PICKED);
    free(names);
}

/* --- values of face corners that would collide when they are numbered for an export --- */

/* Returns whether the hash of the number, made without a random seed, has a value in a small range:
 * such numbers would collide in a hash table. */
static bool number_lies_low(uint64_t word)
{
    uint64_t h = (sizeof word ^ word) * 0x9E3779B97F4A7C15;
    h ^= h >> 32;
    return (h * 0xBF58476D1CE4E5B9 >> 16 & ((1 << 20) - 1)) < 1 << 12;
}

static double number_corners(const void *context, size_t count)
{
    const double *values = context;
    he_soup soup;
    he_mesh *mesh = NULL;
    he_column *column = NULL;
    he_distinct distinct;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 0, 0}, NULL), HE_OK);
        if (i % 3 == 2) {
            const uint32_t corners[3] = {i - 2, i - 1, i};
            assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
        }
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_int_equal(he_column_new(&(he_column_schema){"value", HE_HALFEDGE, HE_DOUBLE, 1, HE_COPY},
                                   &column, NULL),
                     HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(mesh, HE_HALFEDGE), NULL), HE_OK);
    for (uint32_t h = 0; h < he_mesh_issued(mesh, HE_HALFEDGE); h++) {
        if (!he_is_boundary_halfedge(mesh, (he_halfedge){h})) {
            double value = values[he_origin(mesh, (he_halfedge){h}).i];
            memcpy(he_column_row(column, h), &value, sizeof value);
        }
    }
    double from = pace_seconds();
    assert_int_equal(
        he_distinct_make(mesh, (const he_column *const[]){column}, 1, false, NULL, &distinct, NULL),
        HE_OK);
    double seconds = pace_seconds() - from;
    assert_int_equal(distinct.first.count, count / 3 * 3);
    he_distinct_clear(&distinct);
    he_column_free(column);
    he_mesh_free(mesh);
    return seconds;
}

static void values_of_corners_cannot_be_picked_to_collide(void **state)
{
    (void)state;
    double *values = malloc(PICKED * sizeof *values);
    assert_non_null(values);
    uint64_t word = UINT64_C(0x3FF0000000000000); /* the bits of the number 1.0 */
    for (size_t count = 0; count < PICKED; word++) {
        if (number_lies_low(word)) {
            memcpy(&values[count++], &word, sizeof word);
        }
    }
    pace_require_linear("values", number_corners, values, PICKED);
    free(values);
}

/* --- entries of mesh arrays whose records in a delta would collide --- */

static double fold_rows(const void *context, size_t count)
{
    const uint32_t *rows = context;
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    assert_int_equal(he_delta_reserve(delta, count, 0, NULL), HE_OK);
    for (size_t i = 0; i < count; i++) {
        delta->records[delta->count++] = (he_record){.row = rows[i], .column = HE_COL_NEXT};
    }
    double from = pace_seconds();
    assert_int_equal(he_delta_fold(delta, 0, NULL, NULL), HE_OK);
    double seconds = pace_seconds() - from;
    assert_int_equal(delta->count, count);
    he_delta_free(delta);
    return seconds;
}

static void rows_of_records_cannot_be_picked_to_collide(void **state)
{
    (void)state;
    uint32_t *rows = malloc(PICKED * sizeof *rows);
    assert_non_null(rows);
    uint32_t count = 0;
    for (uint32_t row = 0; count < PICKED; row++) {
        uint64_t h = ((uint64_t)row << 32 | (uint64_t)HE_COL_NEXT << 8) * 0x9E3779B97F4A7C15;
        rows[count] = row;
        count += h >> 58 == 0;
    }
    pace_require_linear("rows", fold_rows, rows, PICKED);
    free(rows);
}

/* --- edges that would collide when they are merged by a weld --- */

enum { PAIRS = PICKED / 4 };

/* Makes two triangles for each vertex in `lows`, which coincide along the edge from this vertex to
 * the next one, then welds all these pairs. Returns how many seconds the weld took. */
static double weld_pairs(const void *context, size_t count)
{
    const uint32_t *lows = context;
    he_soup soup;
    he_mesh *mesh = NULL;
    he_ids into = {0};
    he_soup_init(&soup, NULL);
    uint32_t named = lows[count - 1] + 2;
    for (uint32_t v = 0; v < named; v++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, 0, 0}, NULL), HE_OK);
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t a = lows[i], next = (uint32_t)soup.vertex_count;
        const he_vec3 more[4] = {{a, 1, 0}, {a + 1.0, 0, 0}, {a, 0, 0}, {a, -1, 0}};
        for (size_t k = 0; k < 4; k++) {
            assert_int_equal(he_soup_add_vertex(&soup, more[k], NULL), HE_OK);
        }
        const uint32_t above[3] = {a, a + 1, next}, below[3] = {next + 1, next + 2, next + 3};
        assert_int_equal(he_soup_add_face(&soup, above, 3, NULL), HE_OK);
        assert_int_equal(he_soup_add_face(&soup, below, 3, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    double from = pace_seconds();
    assert_int_equal(he_weld_near(mesh, 0, HE_MERGE_MEAN, &into, NULL, NULL), HE_OK);
    double seconds = pace_seconds() - from;
    assert_int_equal(he_mesh_edges(mesh), 5 * count);
    he_ids_clear(&into);
    he_mesh_free(mesh);
    return seconds;
}

static void edges_to_weld_cannot_be_picked_to_collide(void **state)
{
    (void)state;
    uint32_t *lows = malloc(PAIRS * sizeof *lows);
    assert_non_null(lows);
    size_t count = 0;
    for (uint32_t a = 0; count < PAIRS; a += 2) {
        uint64_t h = ((uint64_t)a << 32 | (a + 1)) * 0x9E3779B97F4A7C15;
        lows[count] = a;
        count += ((h ^ h >> 32) * 0xBF58476D1CE4E5B9 >> 32 & ((1 << 18) - 1)) < 1 << 12;
    }
    pace_require_linear("edges", weld_pairs, lows, PAIRS);
    free(lows);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_cannot_be_picked_to_collide),
        cmocka_unit_test(values_of_corners_cannot_be_picked_to_collide),
        cmocka_unit_test(rows_of_records_cannot_be_picked_to_collide),
        cmocka_unit_test(edges_to_weld_cannot_be_picked_to_collide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
