/* The short paths of edge_split, edge_flip and edge_collapse, which are for triangles in a mesh
 * without attributes. Random edits are made in two equal meshes; one of them has a slot for an
 * attribute column, which is empty, so that its edits take the general code. After each edit both
 * meshes must be equal in every link, and undo must lead back. The environment variable SEED=n
 * repeats a run, ROUNDS=n makes it longer. */
#include "fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/local/collapse.h"
#include "edit/local/flip.h"
#include "edit/local/split.h"
#include "mesh/column.h"
#include "mesh/write.h"
#include "model/random.h"
#include "tests/seed.h"

enum { SIDE = 9, EDITS = 400 };

static md_random numbers;

static uint32_t random_below(uint32_t n)
{
    return md_below(&numbers, n);
}

/* Makes a torus of triangles; each face is left out with a chance of one in `holes`, or none if
 * `holes` is 0. */
static he_mesh *torus(uint32_t holes)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        he_vec3 p = {random_below(1000) / 7.0, random_below(3), random_below(1000) / 9.0};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t f = 0; f < 2 * SIDE * SIDE; f++) {
        const uint32_t i = f / 2 / SIDE, j = f / 2 % SIDE, down = (i + 1) % SIDE * SIDE;
        const uint32_t here = i * SIDE, right = (j + 1) % SIDE;
        const uint32_t corners[2][3] = {{here + j, down + j, down + right},
                                        {here + j, down + right, here + right}};
        if (holes == 0 || random_below(holes) > 0) {
            assert_int_equal(he_soup_add_face(&soup, corners[f % 2], 3, NULL), HE_OK);
        }
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

/* Returns a copy of the mesh in which all edits take the general code. */
static he_mesh *general_copy(const he_mesh *m)
{
    he_mesh *copy;
    he_column *column;
    assert_int_equal(he_mesh_copy(m, &copy, NULL), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"a", HE_VERTEX, HE_DOUBLE, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(copy, HE_VERTEX), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(copy, column, NULL), HE_OK);
    assert_int_equal(he_mesh_drop_column(copy, 0, NULL), HE_OK);
    assert_int_equal(he_mesh_columns(copy), 1);
    return copy;
}

typedef struct choice {
    uint32_t edit, id; /* `id` may be that of a deleted half-edge, or of none */
    double t;
    bool has_place;
    he_vec3 place;
} choice;

static choice draw(const he_mesh *m)
{
    static const double fractions[] = {0.5, 0.25, 0, 1, -1, 0.75};
    return (choice){.edit = random_below(3),
                    .id = random_below(2 * he_mesh_issued(m, HE_EDGE) + 2),
                    .t = fractions[random_below(6)],
                    .has_place = random_below(4) == 0,
                    .place = {random_below(3), random_below(9) == 0 ? (double)INFINITY : 2, 0.5}};
}

static he_status make(he_mesh *m, const choice *c, uint32_t made[9], he_error *err)
{
    he_split split = {.sides = 0};
    he_vertex vertex = {0};
    he_status status = HE_OK;
    switch (c->edit) {
    case 0:
        status = he_edge_split(m, (he_edge){c->id / 2}, c->t, &split, err);
        break;
    case 1:
        status = he_edge_flip(m, (he_edge){c->id / 2}, err);
        break;
    default:
        status = he_edge_collapse(m, (he_halfedge){c->id}, c->t, c->has_place ? &c->place : NULL,
                                  &vertex, err);
    }
    const uint32_t results[9] = {split.vertex.i,   split.edges[0].i, split.edges[1].i,
                                 split.edges[2].i, split.faces[0].i, split.faces[1].i,
                                 split.sides,      vertex.i};
    memcpy(made, results, sizeof results);
    return status;
}

/* Returns the number of lineage records of a delta, and adds a hash of each to *hash. */
static size_t lineage(const he_delta *d, uint64_t *hash)
{
    size_t count = 0;
    for (size_t i = 0; i < d->count; i++) {
        const he_record *r = &d->records[i];
        if (r->column == HE_COL_PARENT || r->column == HE_COL_MERGED) {
            *hash = *hash * 31 + r->column + 3 * r->word + 5 * r->row + 7 * (uint64_t)r->before;
            count++;
        }
    }
    return count;
}

static void play(uint32_t holes, bool recording)
{
    he_mesh *m = torus(holes), *other = general_copy(m);
    he_delta *d = he_delta_new(), *other_d = he_delta_new();
    unsigned done = 0;
    for (unsigned i = 0; i < EDITS; i++) {
        const choice c = draw(m);
        uint32_t made[9], other_made[9];
        he_error err = {0}, other_err = {0};
        he_mesh *before;
        assert_int_equal(he_mesh_copy(m, &before, NULL), HE_OK);
        if (recording) {
            he_mesh_record(m, d);
            he_mesh_record(other, other_d);
        }
        he_status status = make(m, &c, made, &err);
        assert_int_equal(status, make(other, &c, other_made, &other_err));
        he_mesh_record(m, NULL);
        he_mesh_record(other, NULL);
        assert_true(he_mesh_equal(m, other));
        assert_memory_equal(made, other_made, sizeof made);
        if (status != HE_OK) {
            assert_string_equal(err.text, other_err.text);
            assert_true(he_mesh_equal(m, before));
        }
        done += status == HE_OK;
        if (recording) {
            uint64_t hash = 0, other_hash = 0;
            he_mesh *after;
            assert_int_equal(lineage(d, &hash), lineage(other_d, &other_hash));
            assert_true(hash == other_hash);
            assert_int_equal(he_mesh_copy(m, &after, NULL), HE_OK);
            he_delta_undo(d, m);
            assert_true(he_mesh_equal_live(m, before));
            he_delta_redo(d, m);
            assert_true(he_mesh_equal(m, after));
            he_mesh_free(after);
            he_delta_empty(d);
            he_delta_empty(other_d);
        }
        he_mesh_free(before);
    }
    fixture_check(m);
    assert_true(done > EDITS / 8);
    he_delta_free(d);
    he_delta_free(other_d);
    he_mesh_free(m);
    he_mesh_free(other);
}

static void short_and_general_code_write_equal_links(void **state)
{
    (void)state;
    const uint64_t rounds = seed_setting("ROUNDS", 12);
    numbers.state = seed_of_run();
    for (uint64_t round = 0; round < rounds; round++) {
        play(round % 3 == 0 ? 0 : round % 3 == 1 ? 30 : 5, round / 3 % 2 == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_and_general_code_write_equal_links),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
