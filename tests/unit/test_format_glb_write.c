/* GLB files that hedge writes: hedge must read the original mesh back, and other programs must see
 * triangles. */
#include "unit/gltf_file.h"

#include "mesh/write.h"
#include "tests/failing.h"

#include <math.h>

static const char *const specimens[] = {
    "012",
    "0123",
    "012,023,031,132",
    "0321,4567,0154,1265,2376,3047", /* a cube */
    "01234567",                      /* an octagon */
    "0123,3254,456",
    "012,034,056", /* a bow-tie of three fans */
    "0123,3245,5467",
};

static char *write_glb(const he_mesh *mesh, he_warnings *warnings, size_t *length)
{
    return write_bytes("glb", "binary", mesh, warnings, length);
}

static he_import read_back(const char *bytes, size_t length)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes("glb", bytes, length, &import, &err) != HE_OK) {
        fail_msg("byte %llu: %s", (unsigned long long)err.at, err.text);
    }
    return import;
}

/* Renames the member `hedge` of `extras`: hedge then does not find its own data and reads the file
 * as other programs do. */
static void hide_extras(char *bytes, size_t length)
{
    for (size_t i = 0; i + 7 < length; i++) {
        if (memcmp(bytes + i, "\"hedge\":", 8) == 0) {
            bytes[i + 1] = 'H';
        }
    }
}

static void expect_same_faces(const he_mesh *m, const he_import *import)
{
    size_t corner = 0;
    assert_int_equal(import->soup.face_count, he_mesh_faces(m));
    for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
        uint32_t first = m->c.face_halfedge[f], h = first;
        assert_int_equal(import->soup.starts[f], corner);
        do {
            assert_int_equal(import->soup.corners[corner++], m->c.origin[h]);
            h = m->c.next[h];
        } while (h != first);
    }
    assert_int_equal(import->soup.corner_count, corner);
}

static void polygons_come_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof specimens / sizeof *specimens; i++) {
        he_mesh *mesh = fixture_mesh(specimens[i]);
        he_warnings warnings;
        size_t length, triangles = 0;
        char *bytes = write_glb(mesh, &warnings, &length);
        he_import import = read_back(bytes, length);
        assert_int_equal(import.warnings.count, 0);
        assert_int_equal(import.soup.vertex_count, he_mesh_vertices(mesh));
        assert_memory_equal(import.soup.positions, mesh->c.position,
                            he_mesh_vertices(mesh) * sizeof(he_vec3));
        expect_same_faces(mesh, &import);
        for (uint32_t f = 0; f < he_mesh_faces(mesh); f++) {
            triangles += he_face_degree(mesh, (he_face){f}) - 2;
        }
        assert_int_equal(find_warning(&warnings, "triangulated", "") != NULL,
                         triangles > he_mesh_faces(mesh));
        he_import_clear(&import);
        /* hedge does not find its own data, so it reads the file as other programs do */
        hide_extras(bytes, length);
        import = read_back(bytes, length);
        expect_counts(&import, he_mesh_vertices(mesh), triangles, 3 * triangles);
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(mesh);
    }
}

static void meshes_without_faces(void **state)
{
    (void)state;
    for (uint32_t vertices = 0; vertices < 3; vertices++) {
        he_soup soup;
        he_mesh *mesh;
        he_soup_init(&soup, NULL);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, 1, 2}, NULL), HE_OK);
        }
        assert_int_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
        he_soup_clear(&soup);
        size_t length;
        char *bytes = write_glb(mesh, NULL, &length);
        he_import import = read_back(bytes, length);
        expect_counts(&import, vertices, 0, 0);
        assert_int_equal(import.warnings.count, 0);
        he_import_clear(&import);
        hide_extras(bytes, length);
        import = read_back(bytes, length);
        expect_counts(&import, 0, 0, 0);
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(mesh);
    }
}

static void many_vertices_have_long_indices(void **state)
{
    (void)state;
    for (uint32_t vertices = 65535; vertices < 65537; vertices++) {
        he_soup soup;
        he_mesh *mesh;
        he_soup_init(&soup, NULL);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, v % 7, 0}, NULL), HE_OK);
        }
        uint32_t last[3] = {vertices - 3, vertices - 2, vertices - 1};
        assert_int_equal(he_soup_add_face(&soup, last, 3, NULL), HE_OK);
        assert_int_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
        he_soup_clear(&soup);
        size_t length;
        char *bytes = write_encoded("glb", "binary", mesh, 4096, NULL, &length);
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(
            read_pieces(&(format_file){"glb", bytes, length}, 1000, NULL, &import, &err), HE_OK);
        expect_corners(&import, last, 3);
        const char *type = vertices < 65536 ? "\"componentType\":5123" : "\"componentType\":5125";
        bytes[20 + 600] = '\0';
        assert_non_null(strstr(bytes + 20, type));
        he_import_clear(&import);
        free(bytes);
        he_mesh_free(mesh);
    }
}

static void what_is_not_carried_is_said(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0.1 0 0\nv 1 0 0\nv 1 1 0\nv 0 3e38 0\nvt 0 0\nvt 1 0\n"
                                        "vt 1 1\nusemtl steel \"1\"\nf 1/1 2/2 3/3 4/1\n");
    he_column *column;
    assert_int_equal(
        he_column_new(&(he_column_schema){"crease", HE_EDGE, HE_BOOL, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"mark", HE_FACE, HE_BOOL, 2, HE_DEFAULT}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, 1, NULL), HE_OK);
    memcpy(he_column_row(column, 0), (unsigned char[]){0, 1}, 2);
    assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
    he_warnings warnings;
    size_t length;
    char *bytes = write_glb(mesh, &warnings, &length);
    assert_int_equal(find_warning(&warnings, "rounded", "")->count, 2);
    assert_int_equal(find_warning(&warnings, "triangulated", "")->count, 1);
    assert_non_null(find_warning(&warnings, "attribute_lost", "edge crease"));
    assert_null(
        /* other programs can see this attribute, so the writer must not warn that it is stored in
         * the extras only */
        find_warning(&warnings, "in_extras", "halfedge uv"));
    assert_null(find_warning(&warnings, "in_extras", "face material"));
    assert_non_null(find_warning(&warnings, "in_extras", "face mark"));
    he_import import = read_back(bytes, length);
    assert_string_equal(face_label(&import, "material", 0), "steel \"1\"");
    assert_int_equal(find_column(&import, HE_FACE, "material")->rule, HE_COPY);
    const he_column *mark = find_column(&import, HE_FACE, "mark");
    assert_int_equal(mark->rule, HE_DEFAULT);
    assert_memory_equal(mark->data, ((unsigned char[]){0, 1}), 2);
    const double uv[] = {0, 0, 1, 0, 1, 1, 0, 0};
    expect_doubles(&import, &(attribute_shape){HE_HALFEDGE, "uv", 2, 4}, uv);
    assert_true(import.soup.positions[3].y == (double)3e38f);
    he_import_clear(&import);
    free(bytes);
    he_mesh_free(mesh);
}

/* glTF requires that numbered attributes have no gaps (TEXCOORD_1 needs TEXCOORD_0) and that
 * JOINTS_0 and WEIGHTS_0 come together. An attribute that would break this rule must be written
 * under a name of its own, or only in the extras. */
static void numbered_attributes_have_no_gaps(void **state)
{
    (void)state;
    static const struct {
        struct {
            const char *name;
            he_type type;
            uint32_t components;
            /* expected name in the file, or NULL if the attribute must be in the extras only */
            const char *semantic;
        } columns[3];
    } rows[] = {
        {{{"uv1", HE_FLOAT, 2, "_uv1"}}},
        {{{"uv1", HE_FLOAT, 2, "TEXCOORD_1"}, {"uv", HE_FLOAT, 2, "TEXCOORD_0"}}},
        {{{"uv", HE_INT32, 2, NULL}, {"uv1", HE_FLOAT, 2, "_uv1"}}},
        {{{"uv", HE_FLOAT, 3, "_uv"}, {"uv1", HE_FLOAT, 2, "_uv1"}}},
        {{{"uv", HE_FLOAT, 2, "TEXCOORD_0"}, {"uv2", HE_FLOAT, 2, "_uv2"}}},
        {{{"color1", HE_UINT32, 4, NULL}}},
        {{{"joints", HE_UINT32, 4, NULL}}},
        {{{"weights", HE_FLOAT, 4, "_weights"}}},
        {{{"joints", HE_UINT32, 4, "JOINTS_0"}, {"weights", HE_FLOAT, 4, "WEIGHTS_0"}}},
        {{{"joints", HE_FLOAT, 4, "_joints"}, {"weights", HE_FLOAT, 4, "_weights"}}},
        {{{"weights", HE_FLOAT, 4, "WEIGHTS_0"},
          {"joints", HE_UINT32, 4, "JOINTS_0"},
          {"joints1", HE_UINT32, 4, NULL}}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *mesh = fixture_mesh("012,023");
        for (size_t k = 0; k < 3 && rows[i].columns[k].name != NULL; k++) {
            he_column *column;
            he_rule rule = rows[i].columns[k].type == HE_FLOAT ? HE_INTERPOLATE : HE_COPY;
            assert_int_equal(he_column_new(&(he_column_schema){rows[i].columns[k].name, HE_VERTEX,
                                                               rows[i].columns[k].type,
                                                               rows[i].columns[k].components, rule},
                                           &column, NULL),
                             HE_OK);
            assert_int_equal(he_column_extend(column, 4, NULL), HE_OK);
            assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
        }
        size_t length, json = 0;
        char *bytes = write_glb(mesh, NULL, &length), semantic[40], text[4096];
        memcpy(&json, bytes + 12, 4);
        assert_true(json < sizeof text);
        memcpy(text, bytes + 20, json);
        text[json] = '\0';
        he_import import = read_back(bytes, length);
        hide_extras(bytes, length);
        he_import other = read_back(bytes, length);
        for (size_t k = 0; k < 3 && rows[i].columns[k].name != NULL; k++) {
            const char *name = rows[i].columns[k].name;
            const he_column *column = find_column(&import, HE_VERTEX, name);
            assert_non_null(column);
            assert_int_equal(column->type, rows[i].columns[k].type);
            assert_int_equal(column->components, rows[i].columns[k].components);
            assert_int_equal(find_column(&other, HE_VERTEX, name) != NULL,
                             rows[i].columns[k].semantic != NULL);
            if (rows[i].columns[k].semantic != NULL) {
                snprintf(semantic, sizeof semantic, "\"%s\":", rows[i].columns[k].semantic);
                assert_non_null(strstr(text, semantic));
            }
        }
        he_import_clear(&import);
        he_import_clear(&other);
        free(bytes);
        he_mesh_free(mesh);
    }
}

/* --- inconsistent extras --- */

#define PRIVATE(list, hedge, node)                                                           \
    "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" ACCESSOR_LIST list                      \
    "],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'extras':{'hedge':" \
    "{" hedge "}}}]}],'nodes':[{'mesh':0" node "}]}"

/* The extras contain hedge's own data, which describes polygons and columns. The test replaces this
 * data by invalid data: hedge must then ignore it and read the triangles. The numbers of the data
 * are stored in two buffer views of the square's file: the degree 4 in the view for colours, and
 * the corners 0 1 2 3 in the view for a triangle fan. */
static void extras_are_not_believed(void **state)
{
    (void)state;
    static const char words[] =
        ",{'bufferView':4,'componentType':5125,'count':1,'type':'SCALAR'}"                 /* 5 */
        ",{'bufferView':3,'componentType':5125,'count':4,'type':'SCALAR'}"                 /* 6 */
        ",{'bufferView':4,'componentType':5125,'count':2,'type':'SCALAR'}"                 /* 7 */
        ",{'bufferView':4,'byteOffset':8,'componentType':5125,'count':1,'type':'SCALAR'}"; /* 8 */
    static const struct {
        const char *hedge, *node;
        uint32_t degree;
        uint32_t second;
        uint32_t corner; /* expected last corner of the last face that is read */
        size_t faces;
        const char
            *column; /* name of the column that must be read, or NULL if no column must be read */
        bool fits;
    } rows[] = {
        {"'polygons':{'degrees':5,'corners':6}", "", 4, 0, 3, 1, NULL, true},
        {"'polygons':{'degrees':5,'corners':6}", ",'scale':[1,1,1]", 4, 0, 3, 1, NULL, true},
        {"'polygons':{'degrees':5,'corners':6}", ",'scale':[1,1,2]", 4, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':5,'corners':6}", "", 3, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':5,'corners':6}", "", 5, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':5,'corners':6}", "", 0xFFFFFFFF, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':7,'corners':6}", "", 4, 3, 3, 2, NULL, false},
        {"'polygons':{'degrees':5}", "", 4, 0, 3, 2, NULL, false},
        {"'polygons':{}", "", 4, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':5,'corners':1}", "", 4, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':99,'corners':6}", "", 4, 0, 3, 2, NULL, false},
        {"'polygons':{'degrees':5,'corners':5}", "", 4, 0, 3, 2, NULL, false},
        {"", "", 4, 0, 3, 2, NULL, true},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, "n", true},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':5}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'double','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'edge','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint64','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':17,'rule':'copy',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'best',"
         "'accessor':7}]",
         "", 4, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'bool','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 1, 2, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'bool','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 1, 0, 3, 2, "n", true},
        {"'columns':[{'domain':'face','name':'n','type':'float','components':1,'rule':'copy',"
         "'accessor':7}]",
         "", 0x7F800000, 0, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7,'labels':['a','b']}]",
         "", 0, 1, 3, 2, "n", true},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7,'labels':['a','b']}]",
         "", 0, 2, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7,'labels':['a','a','b']}]",
         "", 0, 2, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':7,'labels':['a',3]}]",
         "", 0, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'face','name':'n','type':'int32','components':1,'rule':'copy',"
         "'accessor':7,'labels':['a','b']}]",
         "", 0, 1, 3, 2, NULL, false},
        {"'columns':[{'domain':'vertex','name':'n','type':'uint32','components':1,'rule':'copy',"
         "'accessor':6},{'domain':'vertex','name':'n','type':'uint32','components':1,"
         "'rule':'copy','accessor':6}]",
         "", 0, 1, 3, 2, NULL, false},
        {"'columns':3", "", 0, 1, 3, 2, NULL, true},
        {"'columns':[3,{}]", "", 0, 1, 3, 2, NULL, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        unsigned char bin[SQUARE_BYTES];
        char json[3000];
        glb_file f;
        snprintf(json, sizeof json, PRIVATE("%s", "%s", "%s"), words, rows[i].hedge, rows[i].node);
        glb_square_bin(bin);
        memcpy(bin + 80, &rows[i].degree, 4);
        memcpy(bin + 84, &rows[i].second, 4);
        glb_make(&f, json, bin, sizeof bin);
        he_import import = read_back((const char *)f.bytes, f.length);
        assert_int_equal(import.soup.face_count, rows[i].faces);
        assert_int_equal(find_warning(&import.warnings, "stale_extras", "") == NULL, rows[i].fits);
        assert_true(rows[i].column == NULL || find_column(&import, HE_FACE, "n") != NULL);
        assert_true(rows[i].column != NULL || find_column(&import, HE_FACE, "n") == NULL);
        he_mesh_free(build_import(&import));
        he_import_clear(&import);
    }
}

/* Labels in the extras of a primitive apply to the faces of this primitive only; the other faces
 * must keep the names that the mesh or the material gives them. */
static void names_beside_names_in_extras(void **state)
{
    (void)state;
    static const char extras[] = "'extras':{'hedge':{'columns':[{'domain':'face','name':'%s',"
                                 "'type':'uint32','components':1,'rule':'copy','accessor':5%s}]}}";
    static const struct {
        /* `name` is the name of a column. `first` has labels of this column for the second
         * primitive of the file, `second` has labels for the third primitive. */
        const char *name, *first, *second;
        const char *names[8];
    } rows[] = {
        {"object",
         ",'labels':['x','y']",
         NULL,
         {"plate", "plate", "y", "x", "plate", "plate", "", ""}},
        {"material", ",'labels':['x','y']", NULL, {"steel", "steel", "y", "x", "", "", "", ""}},
        {"object",
         ",'labels':['x','y']",
         ",'labels':['y','z']",
         {"plate", "plate", "y", "x", "z", "y", "", ""}},
        {"object", "", NULL, {NULL}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[4000], one[400], two[400];
        unsigned char bin[SQUARE_BYTES];
        glb_file f;
        snprintf(one, sizeof one, extras, rows[i].name, rows[i].first);
        snprintf(two, sizeof two, extras, rows[i].name,
                 rows[i].second == NULL ? "" : rows[i].second);
        snprintf(json, sizeof json,
                 "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" ACCESSOR_LIST
                 ",{'bufferView':4,'componentType':5125,'count':2,'type':'SCALAR'}],"
                 "'materials':[{'name':'steel'}],'meshes':[{'name':'plate','primitives':["
                 "{'attributes':{'POSITION':0},'indices':1,'material':0},"
                 "{'attributes':{'POSITION':0},'indices':1,%s},"
                 "{'attributes':{'POSITION':0},'indices':1%s%s}]},{'primitives':[" PRIMITIVE
                 "]}],'nodes':[{'mesh':0},{'mesh':1}]}",
                 one, rows[i].second == NULL ? "" : ",", rows[i].second == NULL ? "" : two);
        glb_square_bin(bin);
        memcpy(bin + 80, (unsigned char[]){1, 0, 0, 0, 0, 0, 0, 0}, 8);
        glb_make(&f, json, bin, sizeof bin);
        he_import import = read_back((const char *)f.bytes, f.length);
        assert_int_equal(import.soup.face_count, 8);
        assert_null(find_warning(&import.warnings, "stale_extras", ""));
        for (size_t k = 0; k < 8 && rows[i].names[0] != NULL; k++) {
            assert_string_equal(face_label(&import, rows[i].name, k), rows[i].names[k]);
        }
        assert_int_equal(find_warning(&import.warnings, "attribute_types", rows[i].name) != NULL,
                         rows[i].names[0] == NULL);
        failing each = {0};
        while (failing_next(&each)) {
            he_import other = {0};
            he_error err = {0};
            he_status status =
                read_pieces(&(format_file){"glb", f.bytes, f.length}, 0, NULL, &other, &err);
            if (failing_status(&each, status)) {
                he_import_clear(&other);
            }
        }
        he_import_clear(&import);
    }
}

/* Another program has changed the triangles of a file but kept hedge's data, which describes the
 * old polygons: polygons that do not fit the triangles must be ignored. */
static void polygons_of_other_triangles(void **state)
{
    (void)state;
    he_mesh *mesh = fixture_mesh("0123,3254,456");
    size_t length;
    char *bytes = write_glb(mesh, NULL, &length);
    size_t json = 0, at = 0;
    memcpy(&json, bytes + 12, 4);
    /* offset of the 16-bit indices, which follow seven positions in the binary chunk */
    at = 20 + json + 8 + 7 * 12;
    for (size_t i = 0; i < 15; i++) {
        char other[4096];
        assert_true(length < sizeof other);
        memcpy(other, bytes, length);
        other[at + 2 * i] = 6;
        he_import import = read_back(other, length);
        bool same = bytes[at + 2 * i] == 6;
        assert_int_equal(import.soup.face_count, same || i >= 12 ? 3 : 5);
        he_import_clear(&import);
    }
    free(bytes);
    he_mesh_free(mesh);
}

static void extras_without_memory(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                                        "g a\nf 1/1 2/2 3/1 4/2\n");
    size_t length;
    char *bytes = write_glb(mesh, NULL, &length);
    failing f = {0};
    while (failing_next(&f)) {
        he_import import = {0};
        he_error err = {0};
        he_status status =
            read_pieces(&(format_file){"glb", bytes, length}, 0, NULL, &import, &err);
        if (failing_status(&f, status)) {
            expect_counts(&import, 4, 1, 4);
            assert_string_equal(face_label(&import, "group", 0), "a");
            he_import_clear(&import);
        } else {
            assert_int_equal(err.status, HE_NO_MEMORY);
        }
    }
    print_message("%ld allocations failed, each refused\n", f.n - 1);
    assert_true(f.n > 20);
    free(bytes);
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_come_back),
        cmocka_unit_test(meshes_without_faces),
        cmocka_unit_test(many_vertices_have_long_indices),
        cmocka_unit_test(what_is_not_carried_is_said),
        cmocka_unit_test(numbered_attributes_have_no_gaps),
        cmocka_unit_test(extras_are_not_believed),
        cmocka_unit_test(names_beside_names_in_extras),
        cmocka_unit_test(polygons_of_other_triangles),
        cmocka_unit_test(extras_without_memory),
    };
    return cmocka_run_group_tests_name("format_glb_write", tests, NULL, NULL);
}
