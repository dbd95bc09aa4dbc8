/* The writers of OBJ and OFF: reading their files must give equal meshes, whatever the size of the
 * buffer that the writer fills. */
#include "unit/format_fixture.h"

#include "mesh/write.h"

static void text_is_as_expected(void **state)
{
    (void)state;
    he_mesh *mesh =
        mesh_of_text("obj", "v 0 0 0\nv 1.5 0 -0\nv 1e-7 1 0.1\nv 0 2 1e300\n"
                            "vt 0 0\nvt 1 0\nvt .5 1\nvt 0 0\n"
                            "s 1\ng a\nf 1/1 2/2 3/3\ns off\nusemtl m\nf 1/4 3/3 4/1\n");
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_string_equal(text, "# 4 vertices, 2 faces\n"
                              "v 0 0 0\nv 1.5 0 -0\nv 1e-7 1 0.1\nv 0 2 1e300\n"
                              "vt 0 0\nvt 1 0\nvt 0.5 1\n"
                              "g a\ns 1\nf 1/1 2/2 3/3\nusemtl m\ns 0\nf 1/1 3/3 4/1\n");
    assert_int_equal(warnings.count, 0);
    free(text);
    text = write_text("off", mesh, &warnings);
    assert_string_equal(text, "OFF\n4 2 5\n0 0 0\n1.5 0 -0\n1e-7 1 0.1\n0 2 1e300\n"
                              "3 0 1 2\n3 0 2 3\n");
    assert_int_equal(warnings.count, 4);
    assert_non_null(find_warning(&warnings, "attribute_lost", "halfedge uv"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "face group"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "face material"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "face smoothing"));
    free(text);
    he_mesh_free(mesh);

    mesh = he_mesh_new();
    assert_non_null(mesh);
    text = write_text("obj", mesh, NULL);
    assert_string_equal(text, "# 0 vertices, 0 faces\n");
    free(text);
    text = write_text("off", mesh, NULL);
    assert_string_equal(text, "OFF\n0 0 0\n");
    free(text);
    he_mesh_free(mesh);
}

/* A column of attribute values may have fewer rows than there are elements (column.h). The writer
 * must write the default value for the elements without a row. */
static void rows_that_are_not_stored_are_the_default(void **state)
{
    (void)state;
    static const double white[3] = {1, 1, 1}, red[3] = {1, 0, 0};
    static const uint32_t corners[3] = {0, 1, 2}, seven = 7;
    he_soup soup;
    he_column *color, *smoothing;
    he_mesh *mesh;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, i == 2, 0}, NULL), HE_OK);
    }
    assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
    assert_int_equal(
        he_soup_column(&soup, &(he_column_schema){"color", HE_VERTEX, HE_DOUBLE, 3, HE_INTERPOLATE},
                       &color, NULL),
        HE_OK);
    memcpy(color->fallback, white, sizeof white);
    assert_int_equal(he_column_extend(color, 1, NULL), HE_OK);
    memcpy(he_column_row(color, 0), red, sizeof red);
    assert_int_equal(
        he_soup_column(&soup, &(he_column_schema){"smoothing", HE_FACE, HE_UINT32, 1, HE_COPY},
                       &smoothing, NULL),
        HE_OK);
    memcpy(smoothing->fallback, &seven, sizeof seven);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    char *text = write_text("obj", mesh, NULL);
    assert_string_equal(text, "# 3 vertices, 1 faces\n"
                              "v 0 0 0 1 0 0\nv 1 0 0 1 1 1\nv 2 1 0 1 1 1\ns 7\nf 1 2 3\n");
    free(text);
    text = write_text("off", mesh, NULL);
    assert_string_equal(text, "COFF\n3 1 3\n0 0 0 1.0 0.0 0.0 1.0\n1 0 0 1.0 1.0 1.0 1.0\n"
                              "2 1 0 1.0 1.0 1.0 1.0\n3 0 1 2\n");
    free(text);
    he_mesh_free(mesh);
    he_soup_clear(&soup);
}

static const char quads[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 .25\nv 2 1 .125\n";

static void obj_round_trips(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "",
        "v 7 7 7\n",
        "f 1 2 3 4\nf 2 5 6 3\n",
        "f 1 2 3 4\nf 5 6 3 2\n",
        "vt 0 0\nvt 1 0.1 0.7\nvt -0 0\nf 1/1 2/2 3/3 4/1\nf 2/3 5/2 6/1 3/1\n",
        "vn 0 0 1\nvn 0 0.6 0.8\nf 1//1 2//2 3//2 4//1\nf 2//1 5//2 6//1 3//1\n",
        "vt 0 .3\nvn 0 0 1\nvt 1 0\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf 2/2/1 5/2/1 6/1/1 3/1/1\n",
        "o a b\ng x y  z\nusemtl \xC3\xA9\ns 4294967295\nf 1 2 3 4\ng\no c\ns 0\nf 2 5 6 3\n",
        "f 1 2 3 4\nusemtl #1\nf 2 5 6 3\n",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char text[500];
        snprintf(text, sizeof text, "%s%s", quads, lines[i]);
        he_mesh *mesh = mesh_of_text("obj", text);
        he_warnings warnings;
        char *written = write_text("obj", mesh, &warnings);
        assert_int_equal(warnings.count, 0);
        he_import before = read_text("obj", text), after = read_text("obj", written);
        assert_int_equal(after.soup.column_count, before.soup.column_count);
        for (size_t k = 0; k < before.soup.column_count; k++) {
            const he_column *column = before.soup.columns[k];
            const he_column *other = find_column(&after, column->domain, column->name);
            assert_non_null(other);
            expect_same_columns(column, other);
        }
        he_mesh *again = build_import(&after);
        if (before.soup.column_count == 0) {
            assert_true(he_mesh_equal(mesh, again));
        }
        char *third = write_text("obj", again, NULL);
        assert_string_equal(third, written);
        free(third);
        free(written);
        he_import_clear(&before);
        he_import_clear(&after);
        he_mesh_free(mesh);
        he_mesh_free(again);
    }
}

static void off_round_trips(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "OFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        "COFF\n3 1 3\n0 0 0 1.0 0.0 0.0 1.0\n1 0 0 0.0 1.0 1e-7 1.0\n0.5 1 0 0.0 0.0 0.25 1.0\n"
        "3 0 1 2 1.0 0.0 0.0 0.5\n",
        "STCNOFF\n3 1 3\n0 0 0 0 0 1 1.0 0.0 0.0 0.5 0 0.25\n1 0 0 0 0 1 0.0 1.0 0.0 1.0 0 1\n"
        "0.5 1 0 0 0 1 0.0 0.0 1.0 0.0 1 -1\n3 0 1 2\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_mesh *mesh = mesh_of_text("off", texts[i]);
        he_warnings warnings;
        char *written = write_text("off", mesh, &warnings);
        assert_string_equal(written, texts[i]);
        assert_int_equal(warnings.count, 0);
        free(written);
        he_mesh_free(mesh);
    }
}

static void vertex_values_go_to_obj(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("off", "STCNOFF\n3 1 3\n0 0 0 0 0 1 255 0 0 7 0 0.25\n"
                                        "1 0 0 0 1 0 0 255 0 8 0 1\n0 1 0 0 0 1 0 0 51 9 1 1\n"
                                        "3 0 1 2 1 2 3\n");
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_string_equal(text, "# 3 vertices, 1 faces\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
                              "v 0 1 0 0 0 0.2\nvt 0 0.25\nvt 0 1\nvt 1 1\n"
                              "vn 0 0 1\nvn 0 1 0\nvn 0 0 1\nf 1/1/1 2/2/2 3/3/3\n");
    assert_int_equal(warnings.count, 2);
    assert_non_null(find_warning(&warnings, "alpha_lost", "vertex color"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "face color"));
    free(text);
    he_mesh_free(mesh);
}

static void dead_rows_are_skipped(void **state)
{
    (void)state;
    /* Two isolated vertices are deleted, so the remaining ones must get numbers without gaps in the
     * file. */
    he_mesh *mesh = mesh_of_text("obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 0 1 0\nv 7 7 7\n"
                                        "g one\nf 2 3 5\n");
    he_delete_vertex(mesh, (he_vertex){0});
    he_delete_vertex(mesh, (he_vertex){3});
    fixture_check(mesh);
    char *text = write_text("obj", mesh, NULL);
    assert_string_equal(text, "# 4 vertices, 1 faces\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 7 7 7\n"
                              "g one\nf 1 2 3\n");
    free(text);
    text = write_text("off", mesh, NULL);
    assert_string_equal(text, "OFF\n4 1 3\n0 0 0\n1 0 0\n0 1 0\n7 7 7\n3 0 1 2\n");
    free(text);
    he_mesh_free(mesh);
}

/* An attribute with the value `row` for element 0. `labels` are the names of the attribute's
 * values, or NULL if the values have no names. */
typedef struct attribute {
    const char *name;
    he_kind domain;
    he_type type;
    uint32_t components;
    const void *row;
    const char *const *labels;
} attribute;

static void add_column(he_mesh *mesh, const attribute *a)
{
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){a->name, a->domain, a->type, a->components, HE_COPY},
                      &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(mesh, a->domain), NULL), HE_OK);
    memcpy(he_column_row(column, 0), a->row, column->row_bytes);
    if (a->labels != NULL) {
        column->labels = he_labels_new();
        uint32_t ignored;
        for (const char *const *label = a->labels; *label != NULL; label++) {
            assert_int_equal(he_labels_add(column->labels, *label, strlen(*label), &ignored, NULL),
                             HE_OK);
        }
    }
    assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
}

static void names_that_do_not_fit_a_line(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    char longer[5000];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    add_column(mesh, &(attribute){"group", HE_FACE, HE_UINT32, 1, &(uint32_t){0},
                                  (const char *const[]){" a\nf 9 9 9\\", NULL}});
    add_column(mesh, &(attribute){"object", HE_FACE, HE_UINT32, 1, &(uint32_t){1},
                                  (const char *const[]){"", longer, NULL}});
    add_column(mesh, &(attribute){"material", HE_FACE, HE_UINT32, 1, &(uint32_t){77},
                                  (const char *const[]){"only", NULL}});
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_non_null(strstr(text, "\ng _a_f 9 9 9_\n"));
    assert_int_equal(warnings.count, 1);
    assert_string_equal(warnings.items[0].code, "names_changed");
    he_import import = read_text("obj", text);
    assert_string_equal(face_label(&import, "object", 0), longer);
    assert_string_equal(face_label(&import, "group", 0), "_a_f 9 9 9_");
    assert_null(find_column(&import, HE_FACE, "material"));
    he_import_clear(&import);
    free(text);
    he_mesh_free(mesh);
}

static void what_is_lost_is_named(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    double big[2] = {1e308, 1};
    big[0] *= 10;
    add_column(mesh, &(attribute){"uv", HE_VERTEX, HE_DOUBLE, 2, big, NULL});
    add_column(mesh, &(attribute){"normal", HE_VERTEX, HE_FLOAT, 3, (float[]){0.1f, 0, -1}, NULL});
    add_column(mesh,
               &(attribute){"color", HE_VERTEX, HE_BOOL, 4, (unsigned char[]){1, 0, 1, 1}, NULL});
    add_column(mesh, &(attribute){"group", HE_FACE, HE_UINT32, 1, &(uint32_t){1}, NULL});
    add_column(mesh, &(attribute){"weight", HE_EDGE, HE_INT32, 1, &(int32_t){-4}, NULL});
    he_warnings warnings;
    char *text = write_text("obj", mesh, &warnings);
    assert_non_null(strstr(text, "v 0 0 0\n"));
    assert_non_null(strstr(text, "vt 0 1\n"));
    assert_non_null(strstr(text, "vn 0.1 0 -1\n"));
    assert_int_equal(warnings.count, 4);
    assert_int_equal(find_warning(&warnings, "not_finite", "uv")->count, 1);
    assert_non_null(
        /* the colours are of type bool and not fractions */
        find_warning(&warnings, "attribute_lost", "vertex color"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "face group"));
    assert_non_null(find_warning(&warnings, "attribute_lost", "edge weight"));
    char sentence[HE_WARNING_TEXT];
    he_warning_text(find_warning(&warnings, "attribute_lost", "edge weight"), sentence,
                    sizeof sentence);
    assert_string_equal(
        sentence, "attribute 'edge weight' is not written, because the format cannot hold it");
    free(text);
    he_mesh_free(mesh);
}

/* Makes random meshes of polygons, with coordinates that are any finite doubles. */
static void random_meshes_round_trip(void **state)
{
    (void)state;
    uint64_t random = 88172645463325252u;
    for (int round = 0; round < 50; round++) {
        he_soup soup;
        he_soup_init(&soup, NULL);
        for (int v = 0; v < 200; v++) {
            double p[3];
            for (int i = 0; i < 3; i++) {
                do {
                    random ^= random << 13;
                    random ^= random >> 7;
                    random ^= random << 17;
                    memcpy(&p[i], &random, sizeof random);
                } while (!(p[i] - p[i] == 0));
            }
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){p[0], p[1], p[2]}, NULL), HE_OK);
        }
        uint32_t v = 0;
        while (v < 190) { /* the polygons share no vertices */
            uint32_t degree = 3 + (uint32_t)(random >> 8 & 7), corners[10];
            for (uint32_t i = 0; i < degree; i++) {
                corners[i] = v++;
            }
            assert_int_equal(he_soup_add_face(&soup, corners, degree, NULL), HE_OK);
            random = random * 6364136223846793005u + 1;
        }
        he_mesh *mesh;
        assert_int_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
        he_soup_clear(&soup);
        static const char *const names[] = {"obj", "off"};
        for (size_t i = 0; i < 2; i++) {
            char *text = write_pieces(names[i], mesh, 1000, NULL);
            he_import import = {0};
            he_error err = {0};
            assert_int_equal(
                read_pieces(&(format_file){names[i], text, strlen(text)}, 777, NULL, &import, &err),
                HE_OK);
            he_mesh *again = build_import(&import);
            assert_true(he_mesh_equal(mesh, again));
            he_mesh_free(again);
            he_import_clear(&import);
            free(text);
        }
        he_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_as_expected),
        cmocka_unit_test(rows_that_are_not_stored_are_the_default),
        cmocka_unit_test(obj_round_trips),
        cmocka_unit_test(off_round_trips),
        cmocka_unit_test(vertex_values_go_to_obj),
        cmocka_unit_test(dead_rows_are_skipped),
        cmocka_unit_test(names_that_do_not_fit_a_line),
        cmocka_unit_test(what_is_lost_is_named),
        cmocka_unit_test(random_meshes_round_trip),
    };
    return cmocka_run_group_tests_name("format_write", tests, NULL, NULL);
}
