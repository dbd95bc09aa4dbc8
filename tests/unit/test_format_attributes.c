/* Attributes of an edited mesh are written to files of all formats that can store them. Reading the
 * file must give the same values, bit by bit, each at its own element, and no values of deleted
 * elements. */
#include "unit/format_fixture.h"

#include "edit/local/erase.h"
#include "format/io/export.h"
#include "mesh/compact.h"
#include "mesh/write.h"
#include "model/random.h"
#include "tests/seed.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <time.h>

typedef struct attribute {
    const char *name;
    he_kind domain;
    he_type type;
    uint32_t components;
    /* random whole numbers are less than `below`, or may be any numbers if it is 0; random
     * fractions are k / (below - 1) with a whole number k */
    uint32_t below;
} attribute;

static void random_number(md_random *random, const attribute *a, unsigned char *at)
{
    uint32_t word = (uint32_t)md_bits(random), bits;
    uint64_t wide = md_bits(random);
    word = a->below != 0 ? word % a->below : word;
    double fraction = a->below == 0 ? 0 : word / (a->below - 1.0);
    if (a->below != 0 && (a->type == HE_FLOAT || a->type == HE_DOUBLE)) {
        float narrow = (float)fraction;
        memcpy(at, a->type == HE_FLOAT ? (void *)&narrow : &fraction, he_type_bytes(a->type));
        return;
    }
    switch (a->type) {
    case HE_INT32:
    case HE_UINT32:
        memcpy(at, &word, sizeof word);
        break;
    case HE_FLOAT: {
        float value;
        do {
            bits = (uint32_t)md_bits(random);
            memcpy(&value, &bits, sizeof value);
        } while (!isfinite(value));
        memcpy(at, &value, sizeof value);
        break;
    }
    case HE_DOUBLE: {
        double value;
        memcpy(&value, &wide, sizeof value);
        while (!isfinite(value)) {
            wide = md_bits(random);
            memcpy(&value, &wide, sizeof value);
        }
        memcpy(at, &value, sizeof value);
        break;
    }
    case HE_BOOL:
    case HE_TYPE_COUNT:
        fail();
    }
}

static void add_attribute(he_mesh *m, md_random *random, const attribute *a)
{
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){a->name, a->domain, a->type, a->components, HE_COPY},
                      &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, a->domain), NULL), HE_OK);
    for (uint32_t row = 0; row < column->rows; row++) {
        for (uint32_t i = 0; i < a->components && he_mesh_is_live(m, a->domain, row); i++) {
            random_number(random, a, he_column_row(column, row) + i * he_type_bytes(a->type));
        }
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

/* Makes a grid with attributes, and deletes some of its faces and vertices. */
static he_mesh *worn_grid(md_random *random, const attribute *attributes, size_t count)
{
    enum { SIDE = 8 };
    he_soup soup;
    he_mesh *m;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < (SIDE + 1) * (SIDE + 1); i++) {
        he_vec3 p = {i % (SIDE + 1) / 3.0, i * 0.1, 1e-7 * i};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t a = i / SIDE * (SIDE + 1) + i % SIDE, b = a + SIDE + 1;
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){a, a + 1, b + 1, b}, 4, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, 0, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    for (size_t i = 0; i < count; i++) {
        add_attribute(m, random, &attributes[i]);
    }
    for (int i = 0; i < 12; i++) {
        uint32_t face = md_below(random, SIDE * SIDE);
        if (he_mesh_is_live(m, HE_FACE, face)) {
            he_leftover leftover = i % 2 ? HE_DROP_ISOLATED : HE_KEEP_ISOLATED;
            assert_int_equal(he_face_delete(m, &face, 1, leftover, NULL), HE_OK);
        }
    }
    fixture_check(m);
    return m;
}

/* Requires that the mesh data read from a file has the attribute `a` with the values of the mesh.
 * The values of corners come face by face; other values come in the order of the elements' ids,
 * which have no gaps in this test. */
static void expect_column(const he_mesh *m, const he_import *import, const attribute *a)
{
    const he_column *wanted = he_mesh_find_column(m, a->domain, a->name);
    const he_column *column = find_column(import, a->domain, a->name);
    size_t row = 0, bytes = wanted->row_bytes;
    assert_non_null(column);
    assert_int_equal(column->type, a->type);
    assert_int_equal(column->components, a->components);
    if (a->domain != HE_HALFEDGE) {
        assert_int_equal(column->rows, he_mesh_count(m, a->domain));
        assert_memory_equal(column->data, wanted->data, column->rows * bytes);
        return;
    }
    for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
        uint32_t first = m->c.face_halfedge[f], h = first;
        do {
            assert_true(row < column->rows);
            assert_memory_equal(he_column_value(column, row++), he_column_value(wanted, h), bytes);
            h = m->c.next[h];
        } while (h != first);
    }
    assert_int_equal(row, column->rows);
}

static void round_trip(const char *format, const char *encoding, const attribute *attributes,
                       size_t count)
{
    printf("note: %s %s\n", format, encoding);
    md_random random = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        he_mesh *m = worn_grid(&random, attributes, count);
        he_warnings warnings;
        size_t length;
        char *bytes = write_encoded(format, encoding, m, 777, &warnings, &length);
        /* whether the format is GLB: only GLB stores positions as floats, and only its writer warns
         * of attributes that other programs cannot see */
        bool narrow = strcmp(format, "glb") == 0;
        assert_true(narrow || warnings.count == 0);
        he_import import = {0};
        he_error err = {0};
        if (read_pieces(&(format_file){format, bytes, length}, 333, NULL, &import, &err) != HE_OK) {
            fail_msg("%s", err.text);
        }
        assert_int_equal(import.warnings.count, 0);
        assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
        assert_int_equal(import.soup.vertex_count, he_mesh_vertices(m));
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 p = m->c.position[v];
            p = narrow ? (he_vec3){he_narrow(p.x), he_narrow(p.y), he_narrow(p.z)} : p;
            assert_memory_equal(&import.soup.positions[v], &p, sizeof p);
        }
        assert_int_equal(import.soup.column_count, count);
        for (size_t i = 0; i < count; i++) {
            expect_column(m, &import, &attributes[i]);
        }
        he_mesh_free(build_import(&import));
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(m);
    }
}

static void ply_keeps_the_attributes_of_vertices_and_faces(void **state)
{
    (void)state;
    static const attribute attributes[] = {
        {"normal", HE_VERTEX, HE_FLOAT, 3, 0},  {"color", HE_VERTEX, HE_FLOAT, 4, 256},
        {"uv", HE_VERTEX, HE_DOUBLE, 2, 0},     {"charge", HE_VERTEX, HE_INT32, 1, 0},
        {"weight", HE_VERTEX, HE_DOUBLE, 1, 0}, {"normal", HE_FACE, HE_DOUBLE, 3, 0},
        {"color", HE_FACE, HE_FLOAT, 3, 256},   {"part", HE_FACE, HE_UINT32, 1, 0},
        {"heat", HE_FACE, HE_FLOAT, 1, 0},
    };
    static const char *const encodings[] = {"ascii", "binary", "binary_big_endian"};
    for (size_t i = 0; i < 3; i++) {
        round_trip("ply", encodings[i], attributes, sizeof attributes / sizeof *attributes);
    }
}

static void obj_keeps_the_values_of_corners(void **state)
{
    (void)state;
    static const attribute attributes[] = {
        {"color", HE_VERTEX, HE_DOUBLE, 3, 0},
        {"uv", HE_HALFEDGE, HE_DOUBLE, 2, 0},
        {"normal", HE_HALFEDGE, HE_DOUBLE, 3, 0},
        {"smoothing", HE_FACE, HE_UINT32, 1, 3},
    };
    round_trip("obj", "ascii", attributes, sizeof attributes / sizeof *attributes);
}

static void off_keeps_normals_colors_and_texture(void **state)
{
    (void)state;
    static const attribute attributes[] = {
        {"normal", HE_VERTEX, HE_DOUBLE, 3, 0},
        {"color", HE_VERTEX, HE_DOUBLE, 4, 256},
        {"uv", HE_VERTEX, HE_DOUBLE, 2, 0},
        {"color", HE_FACE, HE_DOUBLE, 3, 256},
    };
    round_trip("off", "ascii", attributes, sizeof attributes / sizeof *attributes);
}

static void glb_keeps_them_all(void **state)
{
    (void)state;
    static const attribute attributes[] = {
        {"normal", HE_VERTEX, HE_FLOAT, 3, 0},      {"color", HE_VERTEX, HE_FLOAT, 4, 256},
        {"color1", HE_VERTEX, HE_FLOAT, 3, 0},      {"uv", HE_VERTEX, HE_DOUBLE, 2, 0},
        {"uv1", HE_VERTEX, HE_FLOAT, 2, 0},         {"uv3", HE_VERTEX, HE_FLOAT, 2, 0},
        {"charge", HE_VERTEX, HE_INT32, 1, 0},      {"weight", HE_VERTEX, HE_DOUBLE, 1, 0},
        {"_under", HE_VERTEX, HE_FLOAT, 4, 0},      {"frame", HE_VERTEX, HE_FLOAT, 16, 0},
        {"joints", HE_VERTEX, HE_UINT32, 4, 65536}, {"normal", HE_FACE, HE_DOUBLE, 3, 0},
        {"part", HE_FACE, HE_UINT32, 1, 0},         {"uv", HE_HALFEDGE, HE_DOUBLE, 2, 0},
        {"color", HE_HALFEDGE, HE_FLOAT, 4, 0},     {"big", HE_FACE, HE_DOUBLE, 16, 0},
    };
    round_trip("glb", "binary", attributes, sizeof attributes / sizeof *attributes);
}

/* A stored mesh may have attributes with the name that is now that of the positions. */
static void a_reserved_name_is_read_as_another(void **state)
{
    (void)state;
    static const attribute attributes[] = {{"position", HE_VERTEX, HE_DOUBLE, 2, 0},
                                           {"position", HE_FACE, HE_INT32, 1, 0}};
    md_random random = {seed_of_run()};
    he_mesh *m = worn_grid(&random, attributes, 2);
    he_warnings warnings;
    size_t length;
    char *bytes = write_encoded("glb", "binary", m, 777, &warnings, &length);
    he_import import = {0};
    assert_int_equal(
        read_pieces(&(format_file){"glb", bytes, length}, 333, NULL, &import, &(he_error){0}),
        HE_OK);
    assert_int_equal(find_warning(&import.warnings, "renamed_attribute", "position")->count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_non_null(find_column(&import, attributes[i].domain, "position_1"));
    }
    assert_int_equal(import.soup.column_count, 2);
    he_mesh_free(build_import(&import));
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_keeps_the_attributes_of_vertices_and_faces),
        cmocka_unit_test(obj_keeps_the_values_of_corners),
        cmocka_unit_test(off_keeps_normals_colors_and_texture),
        cmocka_unit_test(glb_keeps_them_all),
        cmocka_unit_test(a_reserved_name_is_read_as_another),
    };
    return cmocka_run_group_tests_name("format_attributes", tests, NULL, NULL);
}
