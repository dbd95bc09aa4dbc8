/* Reading the geometry of GLB and glTF files. */
#include "unit/gltf_file.h"

#include <math.h>

static const uint32_t two[] = {0, 1, 2, 0, 2, 3};

static void a_square_of_two_triangles(void **state)
{
    (void)state;
    he_import import = glb_square_import("{" DATA "," MESHES "}");
    expect_counts(&import, 4, 2, 6);
    expect_corners(&import, two, 6);
    assert_memory_equal(import.soup.positions, glb_square, sizeof glb_square);
    assert_int_equal(import.warnings.count, 0);
    assert_int_equal(import.soup.column_count, 0);
    uint64_t bin = he_source_map_find(&import.vertices, 0);
    assert_int_equal(import.vertices.unit, HE_PLACE_BYTE);
    assert_int_equal(he_source_map_find(&import.vertices, 3), bin + 36);
    assert_int_equal(he_source_map_find(&import.faces, 0), bin + 48);
    assert_int_equal(he_source_map_find(&import.faces, 1), bin + 54);
    he_mesh *mesh = build_import(&import);
    fixture_counts(mesh, 4, 5, 2);
    he_mesh_free(mesh);
    he_import_clear(&import);
}

static void every_mode_and_every_type_of_index(void **state)
{
    (void)state;
    static const struct {
        const char *primitive;
        uint32_t corners[6];
        size_t faces;
    } rows[] = {
        {"'indices':1,'mode':4", {0, 1, 2, 0, 2, 3}, 2},
        {"'indices':2,'mode':5", {0, 1, 3, 1, 2, 3}, 2},
        {"'indices':3,'mode':6", {1, 2, 0, 2, 3, 0}, 2},
        {"'mode':5", {0, 1, 2, 1, 3, 2}, 2},
        {"'mode':6", {1, 2, 0, 2, 3, 0}, 2},
        {"'mode':6.0", {1, 2, 0, 2, 3, 0}, 2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[2000];
        snprintf(json, sizeof json,
                 "{" DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},%s}]}]}",
                 rows[i].primitive);
        he_import import = glb_square_import(json);
        expect_counts(&import, 4, rows[i].faces, 3 * rows[i].faces);
        expect_corners(&import, rows[i].corners, 3 * rows[i].faces);
        he_import_clear(&import);
    }
    /* if a primitive has no indices, each three vertices in a row are the corners of a triangle */
    he_import import = glb_square_import(
        "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[{'bufferView':0,'componentType':5126,"
        "'count':3,'type':'VEC3'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]}");
    expect_corners(&import, two, 3);
    he_import_clear(&import);
}

static void points_and_lines_are_left_out(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':0},"
        "{'attributes':{'POSITION':0},'mode':1},{'attributes':{'POSITION':0},'mode':2},"
        "{'attributes':{'POSITION':0},'mode':3},{'attributes':{'COLOR_0':4}}," PRIMITIVE "]}]}");
    expect_counts(&import, 4, 2, 6);
    assert_int_equal(find_warning(&import.warnings, "skipped_points", "")->count, 1);
    assert_int_equal(find_warning(&import.warnings, "skipped_lines", "")->count, 3);
    assert_int_equal(find_warning(&import.warnings, "no_positions", "")->count, 1);
    he_import_clear(&import);
}

/* --- nodes --- */

static void expect_position(const he_import *import, size_t v, double x, double y, double z)
{
    he_vec3 p = import->soup.positions[v];
    if (fabs(p.x - x) > 1e-12 || fabs(p.y - y) > 1e-12 || fabs(p.z - z) > 1e-12) {
        fail_msg("vertex %zu is at %g %g %g, not %g %g %g", v, p.x, p.y, p.z, x, y, z);
    }
}

static void nodes_move_what_they_place(void **state)
{
    (void)state;
    static const struct {
        const char *nodes;
        double at[3]; /* position of vertex 2 in the scene; without its node's transform it would be
                         1 1 0 */
        bool mirrored;
    } rows[] = {
        {"{'mesh':0}", {1, 1, 0}, false},
        {"{'mesh':0,'translation':[10,20,30]}", {11, 21, 30}, false},
        {"{'mesh':0,'scale':[2,3,4]}", {2, 3, 0}, false},
        /* the rotation is a quarter turn about z */
        {"{'mesh':0,'rotation':[0,0,0.70710678118654752,0.70710678118654752]}", {-1, 1, 0}, false},
        {"{'mesh':0,'translation':[1,0,0],'scale':[2,2,2],"
         "'rotation':[0,0,0.70710678118654752,0.70710678118654752]}",
         {-1, 2, 0},
         false},
        /* a matrix in glTF is stored column by column */
        {"{'mesh':0,'matrix':[0,2,0,0, -2,0,0,0, 0,0,2,0, 1,0,0,1]}", {-1, 2, 0}, false},
        {"{'children':[1],'translation':[5,0,0]},{'mesh':0,'scale':[2,2,2]}", {7, 2, 0}, false},
        {"{'children':[1],'scale':[2,2,2]},{'mesh':0,'translation':[5,0,0]}", {12, 2, 0}, false},
        {"{'mesh':0,'scale':[-1,1,1]}", {-1, 1, 0}, true},
        {"{'mesh':0,'scale':[-1,-1,1]}", {-1, -1, 0}, false},
        {"{'children':[1],'scale':[1,-2,1]},{'mesh':0,'scale':[-3,1,1]}", {-3, -2, 0}, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        static const uint32_t turned[] = {0, 2, 1, 0, 3, 2};
        char json[2500];
        snprintf(json, sizeof json, "{" DATA "," MESHES ",'scenes':[{'nodes':[0]}],'nodes':[%s]}",
                 rows[i].nodes);
        he_import import = glb_square_import(json);
        expect_counts(&import, 4, 2, 6);
        expect_position(&import, 2, rows[i].at[0], rows[i].at[1], rows[i].at[2]);
        expect_corners(&import, rows[i].mirrored ? turned : two, 6);
        const he_warning *note = find_warning(&import.warnings, "mirrored", "");
        assert_true((note != NULL) == rows[i].mirrored);
        assert_true(note == NULL || note->count == 2);
        he_import_clear(&import);
    }
}

/* A quaternion need not have length 1: it must mean the same rotation as the quaternion of length 1
 * in the same direction. */
static void a_quaternion_of_another_length_is_made_one_of_length_1(void **state)
{
    (void)state;
    static const struct {
        const char *rotation;
        bool noted;
    } rows[] = {
        {"[0,0,3,3]", true},
        {"[0,0,1e-200,1e-200]", true},
        {"[0,0,1e300,1e300]", true},
        {"[0,0,0.708,0.708]", true},
        {"[0,0,0.70711,0.70711]", false},
        {"[0,0,0.70710678118654752,0.70710678118654752]", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[2500];
        snprintf(json, sizeof json,
                 "{" DATA "," MESHES
                 ",'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'rotation':%s}]}",
                 rows[i].rotation);
        he_import import = glb_square_import(json);
        expect_position(&import, 2, -1, 1, 0);
        const he_warning *note = find_warning(&import.warnings, "rotation_made_unit", "");
        assert_true((note != NULL) == rows[i].noted);
        he_import_clear(&import);
    }
}

static void a_mesh_of_several_nodes_comes_several_times(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA "," MESHES ",'scene':0,'scenes':[{'nodes':[0,2]}],'nodes':[{'mesh':0,"
        "'children':[1]},{'mesh':0,'translation':[0,0,1]},{'mesh':0,'translation':[0,0,2]}]}");
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10, 8, 10, 11};
    expect_counts(&import, 12, 6, 18);
    expect_corners(&import, corners, 18);
    expect_position(&import, 4, 0, 0, 1);
    expect_position(&import, 8, 0, 0, 2);
    assert_int_equal(find_warning(&import.warnings, "instances", "")->count, 2);
    he_mesh_free(build_import(&import));
    he_import_clear(&import);
}

static void the_scene_that_is_named_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *rest;
        double z;
        size_t vertices;
    } rows[] = {
        {"'scene':1,'scenes':[{'nodes':[0]},{'nodes':[1]}],", 1, 4},
        {"'scene':0,'scenes':[{'nodes':[0]},{'nodes':[1]}],", 0, 4},
        {"'scenes':[{'nodes':[1]},{'nodes':[0]}],", 1, 4},
        /* a file without a scene shows the nodes that are not children of other nodes */
        {"", 0, 8},
        {"'scenes':[{}],", 0, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char json[2500];
        snprintf(json, sizeof json,
                 "{" DATA "," MESHES ",%s'nodes':[{'mesh':0},{'mesh':0,'translation':[0,0,1]}]}",
                 rows[i].rest);
        he_import import = glb_square_import(json);
        assert_int_equal(import.soup.vertex_count, rows[i].vertices);
        if (rows[i].vertices > 0) {
            expect_position(&import, 0, 0, 0, rows[i].z);
        }
        assert_int_equal(find_warning(&import.warnings, "unused_meshes", "") != NULL,
                         rows[i].vertices == 0);
        assert_int_equal(find_warning(&import.warnings, "other_scenes", "") != NULL, i < 3);
        he_import_clear(&import);
    }
}

/* --- accessors --- */

static void sparse_accessors(void **state)
{
    (void)state;
    /* A sparse accessor stores only values that replace values of a base list. Here the two stored
     * positions are bytes 12 to 35 of the binary data. They replace values 1 and 2 of a list of
     * zeros, or corners 0 and 2 of the square. */
    static const struct {
        const char *view, *indices;
        double at[4][3];
    } rows[] = {
        {"", "'bufferView':5", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}},
        {"'bufferView':0,", "'bufferView':6", {{1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
    };
    for (size_t i = 0; i < 2; i++) {
        char json[2500];
        snprintf(json, sizeof json,
                 "{" ASSET "," BUFFERS ",'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,"
                 "'byteOffset':48,'byteLength':12},{},{},{'buffer':0,'byteOffset':12,"
                 "'byteLength':24},{'buffer':0,'byteOffset':50,'byteLength':4},{'buffer':0,"
                 "'byteOffset':54,'byteLength':4}],"
                 "'accessors':[{%s'componentType':5126,'count':4,'type':'VEC3','sparse':{"
                 "'count':2,'indices':{%s,'componentType':5123},'values':{'bufferView':4}}},"
                 "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}]," MESHES "}",
                 rows[i].view, rows[i].indices);
        he_import import = glb_square_import(json);
        expect_counts(&import, 4, 2, 6);
        assert_memory_equal(import.soup.positions, rows[i].at, sizeof rows[i].at);
        he_import_clear(&import);
    }
}

static void quantized_positions(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" ASSET "," BUFFERS "," VIEWS ",'extensionsUsed':['KHR_mesh_quantization'],"
        "'extensionsRequired':['KHR_mesh_quantization'],'accessors':["
        "{'bufferView':4,'componentType':5121,'count':4,'type':'VEC3','normalized':true},"
        "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'},"
        "{'bufferView':4,'componentType':5120,'count':4,'type':'VEC3'},"
        "{'bufferView':4,'componentType':5120,'count':4,'type':'VEC3','normalized':true}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':3},'indices':1},{'"
        "attributes':{'POSITION':2},'indices':1},"
        "{'attributes':{'POSITION':3},'indices':1}]}]}");
    expect_position(&import, 3, 0.2, 0.4, 0.8);
    expect_position(&import, 4, -1, 0, 0);
    expect_position(&import, 7, 51, 102, -52);
    expect_position(&import, 11, 51 / 127.0, 102 / 127.0, -52 / 127.0);
    assert_int_equal(import.warnings.count, 1);
    float normal[3];
    memcpy(normal, find_column(&import, HE_VERTEX, "normal")->data + 36, sizeof normal);
    assert_true(fabs((double)normal[2] + 52 / 127.0) < 1e-6);
    he_import_clear(&import);
}

static void buffers_in_uris(void **state)
{
    (void)state;
    /* The data of the file contains only three corners of the square, 36 bytes. */
    static const char triangle[] =
        "{'asset':{'version':'2.0'},'buffers':[{'byteLength':36,'uri':'data:application/"
        "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAA'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36}],'accessors':[{'bufferView':0,"
        "'componentType':5126,'count':3,'type':'VEC3'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]}";
    char json[sizeof triangle];
    for (size_t i = 0; i < sizeof triangle; i++) {
        json[i] = triangle[i] == '\'' ? '"' : triangle[i];
    }
    glb_file f;
    glb_make(&f, triangle, NULL, 0);
    for (int i = 0; i < 2; i++) {
        he_import import = {0};
        he_error err = {0};
        he_status status = i == 0 ? read_bytes("glb", f.bytes, f.length, &import, &err)
                                  : read_bytes("gltf", json, strlen(json), &import, &err);
        if (status != HE_OK) {
            fail_msg("%s", err.text);
        }
        expect_counts(&import, 3, 1, 3);
        assert_memory_equal(import.soup.positions, glb_square, 3 * sizeof *glb_square);
        /* the place that hedge names for a face of a glTF file is the offset of the face's
         * primitive in the JSON text */
        assert_int_equal(he_source_map_find(&import.faces, 0),
                         (i == 0 ? f.json : 0) +
                             (size_t)(strstr(triangle, "{'attributes'") - triangle));
        he_import_clear(&import);
    }
    assert_ptr_equal(he_format_sniff(json, strlen(json)), he_format_find("gltf"));
    assert_ptr_equal(he_format_sniff(f.bytes, 20), he_format_find("glb"));
    assert_null(he_format_sniff("{\"vertices\":[]}", 15));
}

/* JSON allows two kinds of escapes in strings, "\/" and "\u002f", also within a data: URI. */
static void buffers_in_uris_with_escapes(void **state)
{
    (void)state;
    static const char *const uris[] = {
        "data:application\\/octet-stream;base64,AACAPwAAgD8AAIA/AACAPwAAgD8AAIA/"
        "AACAPwAAgD8AAIA/",
        "data:application\\/octet-stream;base64,AACAPwAAgD8AAIA\\/AACAPwAAgD8AAIA\\/"
        "AACAPwAAgD8AAIA\\/",
        "\\u0064ata:;base64\\u002cAACAPw\\u0041AgD8AAIA\\u002fAACAPwAAgD8AAIA\\u002F"
        "AACAPwAAgD8AAIA/",
    };
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        char json[1000];
        int length =
            snprintf(json, sizeof json,
                     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s"
                     "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
                     "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
                     uris[i]);
        he_import import = {0};
        he_error err = {0};
        if (read_bytes("gltf", json, (size_t)length, &import, &err) != HE_OK) {
            fail_msg("%s: %s", uris[i], err.text);
        }
        expect_counts(&import, 3, 1, 3);
        expect_position(&import, 2, 1, 1, 1);
        he_import_clear(&import);
    }
}

static void numbers_that_are_not_aligned(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" ACCESSOR_LIST
        ",{'bufferView':4,'byteOffset':1,'componentType':5123,'count':4,'type':'SCALAR'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'_A':5},'indices':1}]}]}");
    expect_u32s(&import, &(attribute_shape){HE_VERTEX, "A", 1, 4},
                (uint32_t[]){0, 255, 0xFF00, 0xCC66});
    assert_int_equal(find_warning(&import.warnings, "misaligned", "")->count, 1);
    he_import_clear(&import);
}

/* --- attributes --- */

static void attributes_of_vertices(void **state)
{
    (void)state;
    static const unsigned char colors[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 102, 204};
    he_import import = glb_square_import(
        "{" DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':0,'COLOR_0':4,"
        "'_HEAT':3,'_':3,'other':3,'TEXCOORD_0':0,'COLOR_1':0,'COLOR_01':0,'TANGENT':0,"
        "'_position':0,'JOINTS_0':4,'_any\\u0041':4},'indices':1}]}]}");
    expect_bytes(&import, HE_VERTEX, 3, colors, 4);
    expect_u32s(&import, &(attribute_shape){HE_VERTEX, "HEAT", 1, 4}, (uint32_t[]){0, 1, 2, 3});
    const he_column *normal = find_column(&import, HE_VERTEX, "normal");
    assert_int_equal(normal->type, HE_FLOAT);
    assert_int_equal(normal->rule, HE_INTERPOLATE);
    for (size_t i = 0; i < 12; i++) {
        float value;
        memcpy(&value, normal->data + 4 * i, sizeof value);
        assert_true((double)value == glb_square[i / 3][i % 3]);
    }
    assert_int_equal(find_column(&import, HE_VERTEX, "color1")->type, HE_FLOAT);
    const he_column *any = find_column(&import, HE_VERTEX, "anyA");
    assert_int_equal(any->type, HE_FLOAT);
    float first;
    memcpy(&first, any->data, sizeof first);
    assert_true(first == 1);
    assert_non_null(find_warning(&import.warnings, "renamed_attribute", "position"));
    assert_non_null(find_column(&import, HE_VERTEX, "position_1"));
    static const char *const ignored[] = {"_",        "other",   "TEXCOORD_0",
                                          "COLOR_01", "TANGENT", "JOINTS_0"};
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++) {
        assert_non_null(find_warning(&import.warnings, "ignored_attribute", ignored[i]));
    }
    assert_int_equal(import.soup.column_count, 6);
    he_import_clear(&import);
}

static void directions_turn_with_their_node(void **state)
{
    (void)state;
    /* If the node scales x by two, the normal 1 1 0 must turn towards y. If it scales x by -2, the
     * triangle is reversed, and the normal must be mirrored with it. */
    static const struct {
        const char *node;
        double x, y;
    } rows[] = {{"'scale':[2,1,1]", 0.4472135955, 0.894427191},
                {"'scale':[-2,1,1]", -0.4472135955, 0.894427191},
                {"'scale':[5,5,5]", 0.70710678, 0.70710678}};
    for (size_t i = 0; i < 3; i++) {
        char json[2500];
        snprintf(json, sizeof json,
                 "{" DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':0},"
                 "'indices':1}]}],'nodes':[{'mesh':0,%s}]}",
                 rows[i].node);
        he_import import = glb_square_import(json);
        float n[3];
        memcpy(n, find_column(&import, HE_VERTEX, "normal")->data + 24, sizeof n);
        assert_true(fabs((double)n[0] - rows[i].x) < 1e-6 && fabs((double)n[1] - rows[i].y) < 1e-6);
        he_import_clear(&import);
    }
}

static void attributes_of_some_primitives(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA ",'meshes':[{'primitives':[" PRIMITIVE ",{'attributes':{'POSITION':0,"
        "'COLOR_0':4,'_HEAT':3},'indices':1}," PRIMITIVE ",{'attributes':{'POSITION':0,"
        "'_HEAT':0},'indices':1}]}]}");
    static const unsigned char colors[24] = {0,   0, 0, 0, 0,   0, 0, 0, 0,   0,  0,   0,
                                             255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 102, 204};
    expect_bytes(&import, HE_VERTEX, 3, colors, 8);
    assert_int_equal(find_warning(&import.warnings, "vertices_without", "color")->count, 12);
    assert_int_equal(find_warning(&import.warnings, "attribute_types", "_HEAT")->count, 1);
    he_import_clear(&import);
}

static void names_are_attributes_of_faces(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA ",'materials':[{'name':'St\\u00e4hl'},{}],'meshes':[{'name':'plate','primitives':["
        "{'attributes':{'POSITION':0},'indices':1,'material':0},{'attributes':{'POSITION':0},"
        "'indices':1,'material':1}," PRIMITIVE "]}],'nodes':[{'mesh':0},{'mesh':0,'name':'lid',"
        "'translation':[0,0,1]}]}");
    static const char *const materials[] = {"St\xC3\xA4hl", "material_1", ""};
    for (size_t f = 0; f < 12; f++) {
        assert_string_equal(face_label(&import, "object", f), f < 6 ? "plate" : "lid");
        assert_string_equal(face_label(&import, "material", f), materials[f / 2 % 3]);
    }
    he_import_clear(&import);
}

static void expect_look(const he_materials *table, size_t slot, const char *name,
                        const double numbers[9], bool two_sided)
{
    assert_true(slot < table->count);
    const he_look look = table->rows[slot]->look;
    const double is[9] = {look.base_color[0], look.base_color[1], look.base_color[2],
                          look.base_color[3], look.metallic,      look.roughness,
                          look.emission[0],   look.emission[1],   look.emission[2]};
    assert_string_equal(table->rows[slot]->name, name);
    assert_int_equal(look.two_sided, two_sided);
    for (size_t i = 0; i < 9; i++) {
        if (is[i] != numbers[i]) {
            fail_msg("number %zu of %s is %.17g, not %.17g", i, name, is[i], numbers[i]);
        }
    }
}

static void materials_are_rows_of_the_table(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA ",'extensionsUsed':['KHR_materials_emissive_strength'],'materials':["
        "{'name':'red','pbrMetallicRoughness':{'baseColorFactor':[1,0,0,0.5],'metallicFactor':0.25,"
        "'roughnessFactor':0.75},'emissiveFactor':[0.5,0,1],'doubleSided':true,'alphaMode':'BLEND',"
        "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':4}}},"
        "{},"
        "{'name':'red','pbrMetallicRoughness':{'baseColorFactor':[0,1,0,0.5]}},"
        "{'name':'old','extensions':{'KHR_materials_pbrSpecularGlossiness':"
        "{'diffuseFactor':[0,0,1,1],'glossinessFactor':0.25}}},"
        "{'name':'odd','pbrMetallicRoughness':{'baseColorFactor':[1,2],'metallicFactor':7,"
        "'roughnessFactor':'x'}}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'material':2}]}]}");
    const he_materials *table = &import.soup.materials;
    assert_int_equal(table->count, 5);
    expect_look(table, 0, "red", (double[]){1, 0, 0, 0.5, 0.25, 0.75, 2, 0, 4}, true);
    expect_look(table, 1, "material_1", (double[]){1, 1, 1, 1, 1, 1, 0, 0, 0}, false);
    expect_look(table, 2, "red_2", (double[]){0, 1, 0, 1, 1, 1, 0, 0, 0}, false);
    expect_look(table, 3, "old", (double[]){0, 0, 1, 1, 0, 0.75, 0, 0, 0}, false);
    expect_look(table, 4, "odd", (double[]){1, 1, 1, 1, 1, 1, 0, 0, 0}, false);
    assert_string_equal(face_label(&import, "material", 0), "red_2");
    assert_non_null(find_warning(&import.warnings, "material_renamed", "red"));
    assert_non_null(find_warning(&import.warnings, "opaque", "red"));
    assert_non_null(find_warning(&import.warnings, "material_range", "odd"));
    assert_int_equal(import.warnings.count, 3);
    he_import_clear(&import);
}

static void what_has_no_place_is_noted(void **state)
{
    (void)state;
    he_import import = glb_square_import(
        "{" DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,"
        "'targets':[{'POSITION':0}]}]}],'images':[{'uri':'file:///etc/passwd'}],"
        "'skins':[{'joints':[0]}],'animations':[{}],'extensionsUsed':['KHR_materials_unlit',"
        "'ACME_thing'],'extensionsRequired':['KHR_materials_unlit'],"
        "'extras':{'a':[1,{'b':null}]}}");
    static const char *const codes[] = {"ignored_targets", "ignored_skins", "ignored_animations"};
    for (size_t i = 0; i < 3; i++) {
        assert_non_null(find_warning(&import.warnings, codes[i], ""));
    }
    assert_non_null(find_warning(&import.warnings, "ignored_images", "file:///etc/passwd"));
    assert_non_null(find_warning(&import.warnings, "ignored_extension", "ACME_thing"));
    he_import_clear(&import);
    unsigned char bin[SQUARE_BYTES];
    glb_file f;
    glb_square_bin(bin);
    glb_make(&f, "{" DATA "," MESHES "}", bin, sizeof bin);
    glb_word(&f, 4);
    glb_word(&f, 0x12345678);
    glb_word(&f, 0);
    f.bytes[8] = (unsigned char)f.length;
    f.bytes[9] = (unsigned char)(f.length >> 8);
    he_error err = {0};
    assert_int_equal(read_bytes("glb", f.bytes, f.length, &import, &err), HE_OK);
    assert_non_null(find_warning(&import.warnings, "ignored_chunk", ""));
    he_import_clear(&import);
}

/* If the length of a chunk is no multiple of 4, the next chunk may begin right after it or at the
 * next multiple of 4: the reader must accept both files, with a warning. */
static void a_chunk_that_is_not_aligned_is_read_with_a_note(void **state)
{
    (void)state;
    unsigned char bin[SQUARE_BYTES];
    glb_file f;
    glb_square_bin(bin);
    glb_make(&f, "{" DATA "," MESHES "}", bin, sizeof bin);
    size_t json = f.bin - 8 - f.json;
    while (f.bytes[f.json + json - 1] == ' ' || json % 4 == 0) {
        f.bytes[f.json + json - 1] = ' ';
        json--;
    }
    for (size_t padded = 0; padded < 2; padded++) {
        glb_file g = f;
        g.length = 8;
        glb_word(&g, (uint32_t)(f.length - (padded == 1 ? 0 : f.bin - 8 - f.json - json)));
        glb_word(&g, (uint32_t)json);
        memcpy(g.bytes + g.length, f.bytes + g.length, 4 + json);
        g.length += 4 + json;
        for (; padded == 1 && g.length < f.bin - 8; g.length++) {
            g.bytes[g.length] = ' ';
        }
        memcpy(g.bytes + g.length, f.bytes + f.bin - 8, f.length - f.bin + 8);
        g.length += f.length - f.bin + 8;
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(read_bytes("glb", g.bytes, g.length, &import, &err), HE_OK);
        expect_counts(&import, 4, 2, 6);
        expect_position(&import, 2, 1, 1, 0);
        expect_warning(&import, "unaligned_chunk", "", 1, 12);
        he_import_clear(&import);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_of_two_triangles),
        cmocka_unit_test(every_mode_and_every_type_of_index),
        cmocka_unit_test(points_and_lines_are_left_out),
        cmocka_unit_test(nodes_move_what_they_place),
        cmocka_unit_test(a_quaternion_of_another_length_is_made_one_of_length_1),
        cmocka_unit_test(a_mesh_of_several_nodes_comes_several_times),
        cmocka_unit_test(the_scene_that_is_named_is_read),
        cmocka_unit_test(sparse_accessors),
        cmocka_unit_test(quantized_positions),
        cmocka_unit_test(numbers_that_are_not_aligned),
        cmocka_unit_test(buffers_in_uris),
        cmocka_unit_test(buffers_in_uris_with_escapes),
        cmocka_unit_test(attributes_of_vertices),
        cmocka_unit_test(directions_turn_with_their_node),
        cmocka_unit_test(attributes_of_some_primitives),
        cmocka_unit_test(names_are_attributes_of_faces),
        cmocka_unit_test(materials_are_rows_of_the_table),
        cmocka_unit_test(what_has_no_place_is_noted),
        cmocka_unit_test(a_chunk_that_is_not_aligned_is_read_with_a_note),
    };
    return cmocka_run_group_tests_name("format_glb", tests, NULL, NULL);
}
