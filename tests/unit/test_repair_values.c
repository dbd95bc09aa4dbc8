/* Tests of what the repair weld does with values of vertices: if merged vertices have different
 * values, the values must move to the corners of faces. */
#include "unit/format_fixture.h"

#include "query/open_seams.h"
#include "repair/repair.h"
#include "tests/failing.h"

/* Two triangles meet along an edge, but each triangle has vertices of its own at the ends of the
 * edge. Many programs write the seam of a texture in this way. */
static const char seam[] =
    "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
    "property float z\nproperty double s\nproperty double t\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0 255 0 0\n1 0 0 1 0 255 0 0\n0 1 0 0 1 255 0 0\n"
    "1 1 0 .5 .5 255 0 0\n0 1 0 .25 .5 255 0 0\n1 0 0 .5 .25 255 0 0\n9 9 9 %s\n"
    "3 0 1 2\n3 3 4 5\n";

static he_mesh *weld(const char *isolated, he_repaired *done)
{
    char text[1000];
    he_repair_plan plan = {.which = he_repair_bit(HE_REPAIR_WELD)};
    snprintf(text, sizeof text, seam, isolated);
    he_import import = read_text("ply", text);
    assert_int_equal(he_repair_soup(&import.soup, &plan, done, NULL), HE_OK);
    he_mesh *mesh = build_import(&import);
    he_import_clear(&import);
    return mesh;
}

static void a_seam_of_texture_stays_a_seam(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = weld("0 0 0 0 0", &done);
    assert_int_equal(he_mesh_vertices(mesh), 5);
    assert_int_equal(he_mesh_edges(mesh), 5);
    assert_int_equal(done.accounts[HE_REPAIR_WELD].count, 2);
    assert_int_equal(done.accounts[HE_REPAIR_WELD].moved, 2);
    assert_null(he_mesh_find_column(mesh, HE_VERTEX, "uv"));
    /* If merged vertices have equal values of an attribute, it must stay an attribute of
     * vertices. */
    assert_null(he_mesh_find_column(mesh, HE_HALFEDGE, "color"));
    assert_non_null(he_mesh_find_column(mesh, HE_VERTEX, "color"));
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_non_null(strstr(text, "vt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.5\nvt 0.25 0.5\nvt 0.5 0.25\n"
                                 "f 1/1 2/2 3/3\nf 4/4 3/5 2/6\n"));
    assert_int_equal(warnings.count, 0);
    free(text);
    he_repaired_clear(&done);
    he_mesh_free(mesh);
}

/* One of four triangles has the wrong orientation. The repair must reverse the triangle and negate
 * its normals. */
static void normals_turn_with_their_face(void **state)
{
    (void)state;
    he_repair_plan plan = {.which = he_repair_bit(HE_REPAIR_ORIENT)};
    he_repaired done = {0};
    he_import import = read_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 0\nv 3 2 0\n"
                                        "vn 0 0 1\nvn 0.6 0 -0.8\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                        "f 1/1/1 2/2/1 3/3/1\nf 2/1/2 3/2/1 4/3/2\n"
                                        "f 1/1/1 3/1/1 5/1/1\nf 2/1/1 1/1/1 6/1/1\n");
    he_column *face;
    assert_int_equal(he_soup_column(&import.soup,
                                    &(he_column_schema){"normal", HE_FACE, HE_FLOAT, 3, HE_COPY},
                                    &face, NULL),
                     HE_OK);
    assert_int_equal(he_column_extend(face, 4, NULL), HE_OK);
    memcpy(he_column_row(face, 1), (float[]){0, 0.5f, -1}, 3 * sizeof(float));
    assert_int_equal(he_repair_soup(&import.soup, &plan, &done, NULL), HE_OK);
    assert_int_equal(done.accounts[HE_REPAIR_ORIENT].count, 1);
    assert_int_equal(done.accounts[HE_REPAIR_ORIENT].pairs[0].a, 1);
    he_mesh *mesh = build_import(&import);
    const float turned[3] = {0, -0.5f, 1};
    face = (he_column *)he_mesh_find_column(mesh, HE_FACE, "normal");
    for (size_t i = 0; i < 3; i++) {
        float part;
        memcpy(&part, he_column_value(face, 1) + i * sizeof part, sizeof part);
        assert_true(part == turned[i]);
    }
    char *text = write_text("obj", mesh, NULL);
    assert_non_null(strstr(text, "f 1/1/1 2/2/1 3/3/1\nf 2/1/2 4/3/2 3/2/3\n"
                                 "f 1/1/1 3/1/1 5/1/1\n"));
    assert_non_null(strstr(text, "vn 0 0 1\nvn -0.6 -0 0.8\nvn -0 -0 -1\nf"));
    free(text);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_import_clear(&import);
}

static void a_vertex_without_corners_keeps_its_value(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = weld("0 1 0 0 0", &done);
    const he_column *column = he_mesh_find_column(mesh, HE_VERTEX, "uv");
    assert_non_null(column);
    assert_memory_equal(he_column_value(column, 4), ((double[]){0, 1}), 16);
    assert_non_null(he_mesh_find_column(mesh, HE_HALFEDGE, "uv"));
    he_repaired_clear(&done);
    he_mesh_free(mesh);
}

static void the_edges_that_a_weld_would_make_are_counted(void **state)
{
    (void)state;
    static const struct {
        const char *vertices, *faces;
        uint64_t seams;
    } rows[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 1 -0\nv 1 0 0\n", "f 1 2 3\nf 4 5 6\n", 1},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", "f 1 2 3\nf 4 3 2\n", 0},
        /* The two edges coincide, but both faces would use the merged edge in the same direction,
         * so a weld cannot join them. */
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\n", "f 1 2 3\nf 4 6 5\n", 0},
        /* Three faces have coinciding edges; only two of these edges can be joined. */
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nv 1 0 0\n",
         "f 1 2 3\nf 4 5 6\nf 7 8 9\n", 1},
        {"v 0 0 0\nv 0 0 0\nv 0 0 0\n", "f 1 2 3\n", 0},
        {"v 0 0 0\n", "", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[400];
        uint64_t seams = 99;
        snprintf(text, sizeof text, "%s%s", rows[i].vertices, rows[i].faces);
        he_mesh *mesh = mesh_of_text("obj", text);
        assert_int_equal(he_open_seams_count(mesh, &seams, NULL), HE_OK);
        assert_int_equal(seams, rows[i].seams);
        he_mesh_free(mesh);
    }
}

static void counting_them_may_lack_memory(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    uint64_t seams;
    failing_at(1);
    assert_int_equal(he_open_seams_count(mesh, &seams, NULL), HE_NO_MEMORY);
    failing_off();
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_seam_of_texture_stays_a_seam),
        cmocka_unit_test(normals_turn_with_their_face),
        cmocka_unit_test(a_vertex_without_corners_keeps_its_value),
        cmocka_unit_test(the_edges_that_a_weld_would_make_are_counted),
        cmocka_unit_test(counting_them_may_lack_memory),
    };
    return cmocka_run_group_tests_name("repair_values", tests, NULL, NULL);
}
