/* Readers of mesh files must withstand three tests: allocations fail, files are changed at random,
 * and files are so large that a reader that takes more than linear time is noticed. The environment
 * variable SEED repeats the random changes, ROUNDS sets their number. */
#include "unit/format_fixture.h"

#include "tests/pace.h"
#include "tests/failing.h"

static const char obj[] =
    "# all there is\nmtllib x.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1 0.5\nv 0 1 0 1 1 1\n"
    "v 2 0.25 1e-3\nvt 0 0\nvt 1 0.5\nvt 0 1 0.5\nvn 0 0 1\nvn 0 1 0\no thing\ng left \\\n arm\n"
    "usemtl K\xF6rper\ns 1\nf 1/1/1 2/2/2 3/3/1\nf -5//1 \\\n 3 4\nl 1 2\nxyz 1\ns off\ng\n"
    "usemtl red\nf 2 5 3\n";

static const char off[] = "STCNOFF # header\n4 2 5\n0 0 0 0 0 1 255 0 0 0.5 0\n"
                          "1 0 0 0 0 1 0 255 0 7 1.0 0\n1 1 0 0 0 1 0 0 255 1 1\n"
                          "0 1 0 0 0 1 9 9 9 0 1\n3 0 1 2 0.5 0.25 1\n3 0 2\n3 255 1 2 3\n";

static const char ply[] =
    "ply\nformat ascii 1.0\ncomment all there is\nelement vertex 4\nproperty float x\n"
    "property double y\nproperty int z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nproperty float q\nproperty list uchar int ring\nelement face 2\n"
    "property short mark\nproperty list uint int vertex_index\nelement tristrips 1\n"
    "property list int int vertex_indices\nelement other 1\nproperty int a\nend_header\n"
    "0 0 0 1 2 3 .5 0\n1 0 0 255 0 0 1 1 7\n1 1 0 0 0 0 nan 2 3 4\n0 1 5 9 9 9 2 0 extra\n"
    "-3 3 0 1 2\n7 3 0 2 3\n4 1 0 3 -1\n12\n";

#define ROWS                                                                                       \
    "element other 1\nproperty uint a\nelement vertex 4\nproperty float x\nproperty short y\n"     \
    "property char z\nproperty uchar q\nelement face 2\nproperty list uchar ushort vertex_index\n" \
    "property float w\nelement tristrips 1\nproperty list char char vertex_indices\nend_header\n"

static const char little[] = "ply\nformat binary_little_endian 1.0\n" ROWS "\1\2\3\4"
                             "\0\0\0\0\0\0\0\1\0\0\x80\x3F\0\0\0\2"
                             "\0\0\x80\x3F\1\0\0\3\0\0\0\0\1\0\5\4"
                             "\3\0\0\1\0\2\0\0\0\x80\x7F\3\0\0\2\0\3\0\0\0\0\0"
                             "\4\1\0\3\xFF.";

static const char big[] = "ply\r\nformat binary_big_endian 1.0\r\n" ROWS "\1\2\3\4"
                          "\0\0\0\0\0\0\0\1\x3F\x80\0\0\0\0\0\2"
                          "\x3F\x80\0\0\0\1\0\3\0\0\0\0\0\1\5\4"
                          "\3\0\0\0\1\0\2\x7F\x80\0\0\3\0\0\0\2\0\3\0\0\0\0"
                          "\4\1\0\3\xFF.";

static const char solid[] =
    "solid left\ncolor red\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex 1 1 0\nendloop\nendfacet\nendsolid\nSOLID K\xF6rper\nFACET NORMAL 0 0 nan\n"
    "OUTER LOOP\nVERTEX 0 -0 0\nVERTEX 1 1 0.0\nVERTEX 0 1 1e-3\nENDLOOP\nENDFACET\n";

#define ZERO "\0\0\0\0"
#define UNIT "\0\0\x80\x3F"

static const char facets[] =
    "solid but it is not text                                                        "
    "\2\0\0\0" ZERO ZERO UNIT ZERO ZERO ZERO UNIT ZERO ZERO UNIT UNIT ZERO "\0\0" ZERO ZERO UNIT
    "\0\0\0\x80" ZERO ZERO UNIT UNIT ZERO ZERO UNIT UNIT "\1\0.";

/* A glTF file as JSON (.gltf) and not binary (.glb): random changes of a GLB file would mostly give
 * a chunk of a wrong length, and test little else. */
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
    "{\"name\":\"a\",\"mesh\":0,\"children\":[1]},{\"mesh\":0,\"scale\":[-1,1,1],"
    "\"translation\":[0,0,1],\"rotation\":[0,0,0,1]}],\"materials\":[{\"name\":\"m\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"_A\":0},\"material\":0},"
    "{\"attributes\":{\"POSITION\":1},\"indices\":2,\"mode\":5}]}],\"buffers\":[{\"byteLength\":42,"
    "\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAABAAIA\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
    "\"byteLength\":6}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
    "\"type\":\"VEC3\"},{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{"
    "\"count\":2,\"indices\":{\"bufferView\":1,\"byteOffset\":2,\"componentType\":5123},\"values\":"
    "{\"bufferView\":0,\"byteOffset\":12}}},{\"bufferView\":1,\"componentType\":5123,\"count\":3,"
    "\"type\":\"SCALAR\"}]}";

static const char container[] =
    "glTF\2\0\0\0\334\001\000\000\224\001\000\000JSON"
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}"
    "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],\"b"
    "uffers\":[{\"byteLength\":42}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"b"
    "uffer\":0,\"byteOffset\":36,\"byteLength\":6}],\"accessors\":[{\"bufferView\":0,\"com"
    "ponentType\":5126,\"count\":3,\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":"
    "5123,\"count\":3,\"type\":\"SCALAR\"}]}  "
    "\054\000\000\000BIN\0" ZERO ZERO ZERO UNIT ZERO ZERO UNIT UNIT ZERO "\0\0\1\0\2\0\0\0";

/* A mesh of quadrilaterals: the writers of formats with only triangles must divide them. */
static const char cube[] = "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                           "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

static const struct {
    const char *name, *text;
    size_t length;
} files[] = {{"obj", obj, sizeof obj - 1},
             {"off", off, sizeof off - 1},
             {"ply", ply, sizeof ply - 1},
             {"ply", little, sizeof little - 1},
             {"ply", big, sizeof big - 1},
             {"stl", solid, sizeof solid - 1},
             {"stl", facets, sizeof facets - 1},
             {"gltf", gltf, sizeof gltf - 1},
             {"glb", container, sizeof container - 1},
             {"off", cube, sizeof cube - 1}};

enum { FILES = sizeof files / sizeof *files };

static void readers_without_memory(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILES; i++) {
        failing f = {.what = files[i].name};
        while (failing_next(&f)) {
            he_import import = {0};
            he_error err = {0};
            he_status status =
                read_pieces(&(format_file){files[i].name, files[i].text, files[i].length}, 5, NULL,
                            &import, &err);
            if (failing_status(&f, status)) {
                he_import_clear(&import);
            } else {
                assert_int_equal(err.status, HE_NO_MEMORY);
                assert_true(err.text[0] != '\0');
            }
        }
        print_message("%s: %ld allocations of the reader failed, each refused\n", files[i].name,
                      f.n - 1);
        assert_true(f.n > 5);
    }
}

/* Returns the format in which a mesh from a file of the format `name` is written again. A .gltf
 * file is written as GLB, because the format has no writer of its own. */
static const char *writer_of(const char *name)
{
    return strcmp(name, "gltf") == 0 ? "glb" : name;
}

static void writers_without_memory(void **state)
{
    (void)state;
    he_mesh *meshes[FILES];
    for (size_t i = 0; i < FILES; i++) {
        he_import import = {0};
        he_error err = {0};
        if (read_bytes(files[i].name, files[i].text, files[i].length, &import, &err) != HE_OK) {
            fail_msg("%s: %s", files[i].name, err.text);
        }
        meshes[i] = build_import(&import);
        he_import_clear(&import);
    }
    long failures = 0;
    for (size_t i = 0; i < FILES * FILES; i++) {
        const char *name = writer_of(files[i % FILES].name);
        failing f = {.what = name};
        while (failing_next(&f)) {
            he_writer *writer;
            he_error err = {0};
            he_status status =
                he_writer_new(he_format_find(name), meshes[i / FILES], 0, NULL, &writer, &err);
            if (status == HE_OK) {
                char buffer[64];
                while (he_writer_read(writer, buffer, sizeof buffer) > 0) {
                }
                he_writer_free(writer);
            } else {
                assert_int_equal(err.status, HE_NO_MEMORY);
            }
            failing_status(&f, status);
        }
        failures += f.n - 1;
        assert_true(f.n > 2);
    }
    print_message("%ld allocations of the writers failed, each refused\n", failures);
    for (size_t i = 0; i < FILES; i++) {
        he_mesh_free(meshes[i]);
    }
}

static uint64_t seed;

static uint64_t next_random(void)
{
    seed += 0x9E3779B97F4A7C15;
    uint64_t z = (seed ^ seed >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return z ^ z >> 31;
}

/* Changes, removes, repeats or inserts bytes at random. The inserted bytes are characters that have
 * a meaning in mesh files. */
static size_t mutate(char *text, size_t length, size_t room)
{
    static const char *const bits[] = {"\n",
                                       "\r",
                                       "\\\n",
                                       " ",
                                       "#",
                                       "-",
                                       ".",
                                       "e",
                                       "/",
                                       "//",
                                       "\\",
                                       "0",
                                       "-1",
                                       "9",
                                       "1e999",
                                       "nan",
                                       "4294967297",
                                       "18446744073709551617",
                                       "\nf 1 2 3\n",
                                       "\nv 1 2 3\n",
                                       "3 0 1 2\n",
                                       "g ",
                                       "0.00000000000000000000000000001",
                                       "123456789012345678901234567890",
                                       "\xEF\xBB\xBF",
                                       "OFF",
                                       "element x 1\n",
                                       "property int x\n",
                                       "endfacet\n",
                                       "vertex 1 0 0\n",
                                       "solid\n",
                                       "\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],",
                                       "\"extras\":{\"hedge\":{}},",
                                       "4000000000",
                                       "{",
                                       "]",
                                       "\"",
                                       "\xFF\xFF\xFF\xFF",
                                       "\x01"};
    for (uint64_t n = 1 + next_random() % 4; n > 0; n--) {
        size_t at = length == 0 ? 0 : next_random() % length;
        size_t span = next_random() % 12;
        span = span < length - at ? span : length - at;
        switch (next_random() % 5) {
        case 0:
            if (length > 0) {
                text[at] = (char)next_random();
            }
            break;
        case 1:
            memmove(text + at, text + at + span, length - at - span);
            length -= span;
            break;
        case 2:
            if (length + span <= room) {
                memmove(text + at + span, text + at, length - at);
                length += span;
            }
            break;
        case 3:
            length = at + (length - at) / (1 + next_random() % 3);
            break;
        default: {
            const char *bit = bits[next_random() % (sizeof bits / sizeof *bits)];
            size_t size = strlen(bit);
            if (length + size <= room) {
                memmove(text + at + size, text + at, length - at);
                for (size_t k = 0; k < size; k++) {
                    text[at + k] = bit[k];
                }
                length += size;
            }
            break;
        }
        }
    }
    return length;
}

/* Reading a file of any bytes must succeed or give an error, and the result must not depend on the
 * sizes of the pieces in which the file is read. Building a mesh from the result must succeed or be
 * refused. Each mesh that was built must be written and read again. */
static void mutated_files(void **state)
{
    (void)state;
    const char *text = getenv("SEED");
    seed = text != NULL ? strtoull(text, NULL, 10) : 20240229;
    text = getenv("ROUNDS");
    uint64_t rounds = text != NULL ? strtoull(text, NULL, 10) : 4000;
    print_message("SEED=%llu ROUNDS=%llu\n", (unsigned long long)seed, (unsigned long long)rounds);
    unsigned imported = 0, built = 0, refused = 0;
    for (uint64_t i = 0; i < rounds; i++) {
        char bytes[2048];
        size_t file = next_random() % FILES, length = files[file].length;
        memcpy(bytes, files[file].text, length);
        length = mutate(bytes, length, sizeof bytes);
        he_import import = {0}, other = {0};
        he_error err = {0}, second = {0};
        const char *name = files[file].name;
        size_t piece = 1 + next_random() % 40;
        he_status status = read_pieces(&(format_file){name, bytes, length}, 0, NULL, &import, &err);
        assert_int_equal(
            read_pieces(&(format_file){name, bytes, length}, piece, NULL, &other, &second), status);
        if (status != HE_OK) {
            assert_string_equal(err.text, second.text);
            assert_int_not_equal(err.place, HE_PLACE_NONE);
            refused++;
            continue;
        }
        expect_same_imports(&import, &other);
        he_import_clear(&other);
        imported++;
        he_mesh *mesh = NULL;
        if (he_build(&import.soup, 0, &mesh, NULL, &err) == HE_OK) {
            fixture_check(mesh);
            /* encoding in which the mesh is written, if the format is PLY */
            static const char *const plys[] = {"binary", "ascii", "binary_big_endian"};
            name = writer_of(name);
            const char *encoding = strcmp(name, "ply") == 0   ? plys[i % 3]
                                   : strcmp(name, "glb") == 0 ? "binary"
                                                              : "ascii";
            size_t first_length, length_again;
            char *first = write_encoded(name, encoding, mesh, 999, NULL, &first_length);
            he_mesh *again = NULL;
            he_import third = {0};
            if (read_pieces(&(format_file){name, first, first_length}, 0, NULL, &third, &err) !=
                HE_OK) {
                fail_msg("round %llu: %s\n%s", (unsigned long long)i, err.text, first);
            }
            assert_int_equal(he_build(&third.soup, 0, &again, NULL, NULL), HE_OK);
            char *repeated = write_encoded(name, encoding, again, 1, NULL, &length_again);
            assert_int_equal(length_again, first_length);
            assert_memory_equal(repeated, first, first_length);
            free(repeated);
            free(first);
            he_mesh_free(again);
            he_import_clear(&third);
            built++;
        } else {
            he_import_locate(&import, &err);
            assert_int_not_equal(err.place, HE_PLACE_NONE);
        }
        he_mesh_free(mesh);
        he_import_clear(&import);
    }
    print_message("%u refused, %u imported, %u built\n", refused, imported, built);
    assert_true(refused > rounds / 10 && built > rounds / 10);
}

/* A long file to be read: `part` repeated `count` times between `before` and `after`. */
typedef struct flood {
    const char *what, *format, *before, *part, *after;
    size_t count;
    he_status status;
} flood;

static he_status pour(const flood *f, size_t count, he_import *import)
{
    he_reader *reader;
    he_error err = {0};
    he_status status = he_reader_new(he_format_find(f->format), NULL, &reader, &err);
    assert_int_equal(status, HE_OK);
    status = he_reader_feed(reader, f->before, strlen(f->before), &err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        char part[128];
        int n = snprintf(part, sizeof part, f->part, (unsigned)i);
        assert_true(n > 0);
        status = he_reader_feed(reader, part, (size_t)n, &err);
    }
    if (status == HE_OK) {
        status = he_reader_feed(reader, f->after, strlen(f->after), &err);
    }
    if (status == HE_OK) {
        status = he_reader_finish(reader, import, &err);
    }
    he_reader_free(reader);
    return status;
}

/* Returns how many seconds reading the file takes. If the file's header declares 500,000 elements,
 * the file contains only a tenth of them. */
static double time_flood(const void *context, size_t count)
{
    const flood *f = context;
    he_import import = {0};
    bool counted = strcmp(f->format, "obj") != 0 && strstr(f->before, "500000") != NULL;
    double start = pace_seconds();
    he_status status = pour(f, count, &import);
    double took = pace_seconds() - start;
    assert_int_equal(status, counted && count < f->count ? HE_SYNTAX : f->status);
    if (status == HE_OK) {
        he_import_clear(&import);
    }
    return took;
}

static void nothing_is_quadratic(void **state)
{
    (void)state;
    static const char start[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    static const flood floods[] = {
        {"a line continued again and again", "obj", "v 0 0 0\nf", " 1 \\\n", "1\n", 100000, HE_OK},
        {"continued blank lines", "obj", "v 0 0 0\n", "\\\n", "f 1 1 1\n", 200000, HE_OK},
        {"a face with many corners", "obj", "v 0 0 0\nf", " 1", "\n", 500000, HE_OK},
        {"groups", "obj", start, "g group%u\nf 1 2 3\n", "", 100000, HE_OK},
        {"changes between two groups", "obj", start, "g a\nf 1 2 3\ng b\n", "", 100000, HE_OK},
        {"unknown keywords", "obj", start, "key%u 1 2 3\n", "", 100000, HE_OK},
        {"a name of many continued lines", "obj", "v 0 0 0\ng ", "x\\\n", "x\nf 1 1 1\n", 200000,
         HE_OK},
        {"a comment without end", "obj", "v 0 0 0\n#", "# comment ", "", 200000, HE_OK},
        {"lines that end nowhere", "obj", "v 0 0 0\nv ", "1", "", 200000, HE_NOT_FINITE},
        {"texture coordinates", "obj", start, "vt 0.5\nf 1/-1 2/1 3/-1\n", "", 100000, HE_OK},
        {"a first corner that is wrong", "obj", start, "f 9999999 1 2\n", "", 100000, HE_BAD_INDEX},
        {"faces and vertices in turn", "obj", "", "v 0 0 0\nf -1 -1 -1\n", "", 100000, HE_OK},
        {"a face with many corners", "off", "OFF\n1 1 0\n0 0 0\n500000", " 0", "\n", 500000, HE_OK},
        {"a face with a corner a line", "off", "OFF\n1 1 0\n0 0 0\n500000", "\n0", "\n", 500000,
         HE_OK},
        {"numbers behind a vertex", "off", "OFF\n1 0 0\n0 0 0", " 1", "\n", 500000, HE_OK},
        {"blank lines", "off", "OFF\n", "\n", "0 0 0\n", 500000, HE_OK},
        {"comments in a header", "ply", "ply\nformat ascii 1.0\n", "comment %u\n", "end_header\n",
         500000, HE_OK},
        {"properties", "ply", "ply\nformat ascii 1.0\nelement x 0\n", "property int p%u\n", "",
         100000, HE_LIMIT},
        {"a header without end", "ply", "ply\n", "comment ", "", 500000, HE_LIMIT},
        {"a list of all", "ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\n"
         "property int z\nelement tristrips 1\nproperty list int int vertex_index\nend_header\n"
         "0 0 0\n500000",
         " 0", "\n", 500000, HE_OK},
        {"facets at one place", "stl", "solid\n",
         "facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n", "endsolid", 100000, HE_OK},
        {"facets apart", "stl", "solid\n",
         "facet\nvertex 0 0 %u\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n", "endsolid", 100000, HE_OK},
        {"solids", "stl", "", "solid s%u\nendsolid\n", "", 100000, HE_OK},
        {"words that do not belong", "stl", "solid\nfacet\n", "w%u\n",
         "vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endfacet endsolid", 200000, HE_OK},
        {"one long line", "stl", "solid\n",
         "facet normal 0 0 0 outer vertex 0 0 %u vertex 0 1 0 "
         "vertex 1 0 0 endloop endfacet ",
         "endsolid", 50000, HE_OK},
    };
    for (size_t i = 0; i < sizeof floods / sizeof *floods; i++) {
        char what[80];
        snprintf(what, sizeof what, "%s, %s", floods[i].format, floods[i].what);
        pace_require_linear(what, time_flood, &floods[i], floods[i].count);
    }
}

static void a_face_that_repeats_its_corners(void **state)
{
    (void)state;
    static const flood f = {"",  "obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf", " 1 2 3 4", "\n",
                            300, HE_OK};
    he_import import = {0};
    assert_int_equal(pour(&f, 300, &import), HE_OK);
    expect_counts(&import, 4, 1, 1200);
    he_mesh *mesh = NULL;
    he_error err = {0};
    assert_int_equal(he_build(&import.soup, 0, &mesh, NULL, &err), HE_REPEATED_CORNER);
    he_import_locate(&import, &err);
    assert_int_equal(err.at, 5);
    he_import_clear(&import);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(readers_without_memory),
        cmocka_unit_test(writers_without_memory),
        cmocka_unit_test(mutated_files),
        cmocka_unit_test(nothing_is_quadratic),
        cmocka_unit_test(a_face_that_repeats_its_corners),
    };
    return cmocka_run_group_tests_name("format_hostile", tests, NULL, NULL);
}
