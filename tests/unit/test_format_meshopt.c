/* glTF files whose buffer views are compressed by EXT_meshopt_compression: valid ones must give the
 * same geometry as uncompressed files, invalid ones must be refused. */
#include "unit/gltf_file.h"

#include "format/gltf/gltf.h"
#include "format/gltf/meshopt.h"
#include "tests/failing.h"

#include <math.h>

/* The corners of a square, each of 16 bytes with padding; two triangles cover the square. */
static const float corners[4][4] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}, {0, 1, 0, 0}};
static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};

static const he_meshopt_stream corner_stream = {HE_MESHOPT_ATTRIBUTES, HE_MESHOPT_NONE, 4, 16};

typedef struct packed {
    unsigned char bytes[1024];
    size_t length;
} packed;

static packed pack(const he_meshopt_stream *stream, const void *elements)
{
    packed p;
    unsigned char room[16384];
    size_t most = he_meshopt_bound(stream);
    assert_true(most <= sizeof room);
    p.length = he_meshopt_encode(stream, elements, room, most);
    assert_true(p.length <= most && p.length <= sizeof p.bytes);
    assert_true(p.length >= he_meshopt_least(stream));
    memcpy(p.bytes, room, p.length);
    return p;
}

/* Data of a binary chunk: the compressed corners are the first `corners` bytes, the compressed
 * indices are `indices` bytes from byte `at` on, and `length` is the size of all the data. */
typedef struct bin {
    unsigned char bytes[2048];
    size_t corners, at, indices, length;
} bin;

static bin join(const packed *first, const packed *second)
{
    bin b = {
        .corners = first->length, .at = (first->length + 3) / 4 * 4, .indices = second->length};
    memset(b.bytes, 0, sizeof b.bytes);
    memcpy(b.bytes, first->bytes, first->length);
    memcpy(b.bytes + b.at, second->bytes, second->length);
    b.length = (b.at + second->length + 3) / 4 * 4;
    return b;
}

/* Writes the JSON of a glTF file whose binary chunk holds a `bin`. `of_corners` and `of_indices`
 * are the JSON objects of the compression extension for the corners and for the indices. */
static void describe(char *json, size_t size, const char *of_corners, const char *of_indices)
{
    int used = snprintf(
        json, size,
        "{'asset':{'version':'2.0'},'extensionsUsed':['EXT_meshopt_compression'],"
        "'extensionsRequired':['EXT_meshopt_compression'],'buffers':[{'byteLength':%s},"
        "{'byteLength':88,'extensions':{'EXT_meshopt_compression':{'fallback':true}}}],"
        "'bufferViews':[{'buffer':1,'byteLength':64,'byteStride':16,'extensions':{"
        "'EXT_meshopt_compression':%s}},{'buffer':1,'byteOffset':64,'byteLength':%s,'extensions':{"
        "'EXT_meshopt_compression':%s}}],'accessors':[{'bufferView':0,'componentType':5126,"
        "'count':4,'type':'VEC3'},{'bufferView':1,'componentType':%s,'count':6,'type':'SCALAR'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]}",
        "1024", of_corners, strstr(of_indices, "'byteStride':4") != NULL ? "24" : "12", of_indices,
        strstr(of_indices, "'byteStride':4") != NULL ? "5125" : "5123");
    assert_true(used > 0 && (size_t)used < size);
}

enum { CHUNK = 1024 };

static he_status read_packed(const bin *b, const char *of_corners, const char *of_indices,
                             he_import *import, he_error *err)
{
    char json[4096];
    glb_file f;
    describe(json, sizeof json, of_corners, of_indices);
    glb_make(&f, json, b->bytes, CHUNK);
    return read_bytes("glb", f.bytes, f.length, import, err);
}

/* A compressed buffer view: its `length` bytes from byte `at` on are decompressed to `count`
 * elements of `stride` bytes each. */
typedef struct packed_view {
    size_t at, length;
    const char *mode, *filter; /* the member "filter" is left out if this is an empty string */
    unsigned count, stride;
} packed_view;

enum { EXTENSION = 300 };

/* Writes the JSON object of the compression extension for a buffer view. */
static const char *extension(char text[EXTENSION], const packed_view *v)
{
    snprintf(text, EXTENSION,
             "{'buffer':0,'byteOffset':%zu,'byteLength':%zu,'mode':'%s'%s%s%s,'count':%u,"
             "'byteStride':%u}",
             v->at, v->length, v->mode, v->filter[0] == '\0' ? "" : ",'filter':'", v->filter,
             v->filter[0] == '\0' ? "" : "'", v->count, v->stride);
    return text;
}

static bin square_packed(he_meshopt_mode mode, size_t stride)
{
    packed first = pack(&corner_stream, corners);
    he_meshopt_stream stream = {mode, HE_MESHOPT_NONE, 6, stride};
    packed second = pack(&stream, triangles);
    return join(&first, &second);
}

static void expect_square(const he_import *import)
{
    expect_counts(import, 4, 2, 6);
    assert_memory_equal(import->soup.positions, glb_square, sizeof glb_square);
    assert_int_equal(import->warnings.count, 0);
}

static void packed_views_are_read_as_plain_ones(void **state)
{
    (void)state;
    static const size_t strides[] = {2, 4};
    for (size_t i = 0; i < 4; i++) {
        he_meshopt_mode mode = i < 2 ? HE_MESHOPT_TRIANGLES : HE_MESHOPT_INDICES;
        bin b = square_packed(mode, strides[i % 2]);
        char first[EXTENSION], second[EXTENSION];
        he_import import = {0};
        he_error err = {0};
        he_status status = read_packed(
            &b, extension(first, &(packed_view){0, b.corners, "ATTRIBUTES", "NONE", 4, 16}),
            extension(second, &(packed_view){b.at, b.indices, he_meshopt_modes[mode], "", 6,
                                             (unsigned)strides[i % 2]}),
            &import, &err);
        if (status != HE_OK) {
            fail_msg("%zu: %s", i, err.text);
        }
        expect_square(&import);
        if (mode == HE_MESHOPT_INDICES) {
            expect_corners(&import, triangles, 6);
        }
        he_import_clear(&import);
    }
}

/* With the exponential filter a value is stored as an exponent E and a number M, and means 2^E * M:
 * the value 1 is stored as E = -8 and M = 256. */
static void exponents_are_undone(void **state)
{
    (void)state;
    uint32_t words[4][4];
    for (size_t i = 0; i < 16; i++) {
        words[i / 4][i % 4] = 0xF8000000 | (uint32_t)(corners[i / 4][i % 4] * 256);
    }
    packed first = pack(&corner_stream, words);
    he_meshopt_stream stream = {HE_MESHOPT_TRIANGLES, HE_MESHOPT_NONE, 6, 2};
    packed second = pack(&stream, triangles);
    bin b = join(&first, &second);
    char of_corners[EXTENSION], of_indices[EXTENSION];
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(
        read_packed(
            &b,
            extension(of_corners, &(packed_view){0, b.corners, "ATTRIBUTES", "EXPONENTIAL", 4, 16}),
            extension(of_indices, &(packed_view){b.at, b.indices, "TRIANGLES", "NONE", 6, 2}),
            &import, &err),
        HE_OK);
    expect_square(&import);
    he_import_clear(&import);
}

/* One filter stores directions as points on an octahedron; another filter stores quaternions
 * without their largest component. Decoding must restore the full vectors. */
static void directions_and_turns_are_undone(void **state)
{
    (void)state;
    static const int8_t up[4] = {0, 0, 127, 0}, right[4] = {127, 0, 127, 0};
    static const int16_t none[4] = {0, 0, 0, 32767};
    int8_t two[2][4];
    memcpy(two[0], up, sizeof up);
    memcpy(two[1], right, sizeof right);
    he_meshopt_stream stream = {HE_MESHOPT_ATTRIBUTES, HE_MESHOPT_NONE, 2, 4};
    packed p = pack(&stream, two);
    int8_t out[2][4];
    stream.filter = HE_MESHOPT_OCTAHEDRAL;
    assert_true(he_meshopt_decode(&stream, p.bytes, p.length, out));
    assert_memory_equal(out[0], up, sizeof up);
    assert_memory_equal(out[1], ((int8_t[]){127, 0, 0, 0}), sizeof right);
    he_meshopt_stream turns = {HE_MESHOPT_ATTRIBUTES, HE_MESHOPT_NONE, 1, 8};
    p = pack(&turns, none);
    int16_t turn[4];
    turns.filter = HE_MESHOPT_QUATERNION;
    assert_true(he_meshopt_decode(&turns, p.bytes, p.length, turn));
    assert_memory_equal(turn, ((int16_t[]){0, 0, 0, 32767}), sizeof turn);
}

/* --- refusals --- */

typedef struct row {
    /* JSON of the compression extensions for corners and indices, with %zu in place of lengths;
     * NULL stands for a valid extension */
    const char *corners, *indices;
    he_status status;
    const char *words;
} row;

#define CORNERS(rest) "{'buffer':0,'byteLength':%zu," rest "}"
#define INDICES(rest) "{'buffer':0,'byteOffset':%zu,'byteLength':%zu," rest "}"

static void expect_packed_refused(const bin *b, const char *of_corners, const char *of_indices,
                                  he_status wanted, const char *words)
{
    he_import import = {0};
    he_error err = {0};
    he_status status = read_packed(b, of_corners, of_indices, &import, &err);
    if (status != wanted || err.place != HE_PLACE_BYTE || strstr(err.text, words) == NULL) {
        fail_msg("%s, %s\ngot %s: %s\nwanted %s: %s", of_corners, of_indices,
                 he_status_slug(status), err.text, he_status_slug(wanted), words);
    }
}

static void what_the_extension_forbids_is_refused(void **state)
{
    (void)state;
    static const row rows[] = {
        {CORNERS("'mode':'ATTRIBUTES','count':4"), NULL, HE_BAD_VALUE, "'byteStride' is missing"},
        {CORNERS("'mode':'ATTRIBUTES','byteStride':16"), NULL, HE_BAD_VALUE, "'count' is missing"},
        {CORNERS("'count':4,'byteStride':16"), NULL, HE_BAD_VALUE, "'mode' is missing"},
        {CORNERS("'mode':'OTHER','count':4,'byteStride':16"), NULL, HE_UNSUPPORTED,
         "/mode: this value of \"mode\" is not supported"},
        {CORNERS("'mode':7,'count':4,'byteStride':16"), NULL, HE_UNSUPPORTED,
         "/mode: this value of \"mode\" is not"},
        {CORNERS("'mode':'ATTRIBUTES','filter':'COLOR','count':4,'byteStride':16"), NULL,
         HE_UNSUPPORTED, "/filter: this value of \"filter\" is not supported"},
        {CORNERS("'mode':'ATTRIBUTES','count':0,'byteStride':16"), NULL, HE_BAD_VALUE, "/count: 0"},
        {CORNERS("'mode':'ATTRIBUTES','count':4294967296,'byteStride':16"), NULL, HE_BAD_VALUE,
         "/count: 4294967296"},
        {CORNERS("'mode':'ATTRIBUTES','count':2000000000,'byteStride':256"), NULL, HE_BAD_VALUE,
         "2000000000 elements of 256 bytes cannot be compressed to"},
        {CORNERS("'mode':'ATTRIBUTES','count':4,'byteStride':0"), NULL, HE_BAD_VALUE,
         "/byteStride: 0"},
        {CORNERS("'mode':'ATTRIBUTES','count':4,'byteStride':14"), NULL, HE_BAD_VALUE,
         "byteStride must be a multiple of 4, from 4 to 256"},
        {CORNERS("'mode':'ATTRIBUTES','count':4,'byteStride':260"), NULL, HE_BAD_VALUE,
         "byteStride must be a multiple of 4, from 4 to 256"},
        {CORNERS("'mode':'ATTRIBUTES','count':4,'byteStride':18446744073709551632"), NULL,
         HE_BAD_VALUE, "/byteStride: "},
        {CORNERS("'mode':'ATTRIBUTES','filter':'OCTAHEDRAL','count':4,'byteStride':16"), NULL,
         HE_BAD_VALUE, "byteStride must be 4 or 8 for the filter OCTAHEDRAL"},
        {CORNERS("'mode':'ATTRIBUTES','filter':'QUATERNION','count':4,'byteStride':16"), NULL,
         HE_BAD_VALUE, "byteStride must be 4 or 8 for the filter OCTAHEDRAL"},
        {CORNERS("'mode':'ATTRIBUTES','count':3,'byteStride':16"), NULL, HE_BAD_VALUE,
         "the buffer view declares 64 bytes, but decompresses to 48"},
        {CORNERS("'mode':'ATTRIBUTES','count':200,'byteStride':16"), NULL, HE_SYNTAX,
         "the bytes are not a compressed stream of the mode ATTRIBUTES with 200"},
        {CORNERS("'mode':'TRIANGLES','count':6,'byteStride':4"), NULL, HE_SYNTAX,
         "the bytes are not a compressed stream of the mode TRIANGLES"},
        {"{'buffer':2,'byteLength':%zu,'mode':'ATTRIBUTES','count':4,'byteStride':16}", NULL,
         HE_BAD_INDEX, "there is no buffer 2; the file has 2"},
        {"{'buffer':1,'byteLength':%zu,'mode':'ATTRIBUTES','count':4,'byteStride':16}", NULL,
         HE_BAD_VALUE, "buffer 1 is only a fallback and has no bytes"},
        {"{'buffer':0,'byteOffset':1024,'byteLength':%zu,'mode':'ATTRIBUTES','count':4,"
         "'byteStride':16}",
         NULL, HE_BAD_VALUE, "do not fit in a buffer of 1024"},
        {"{'buffer':0,'mode':'ATTRIBUTES','count':4,'byteStride':16}", NULL, HE_BAD_VALUE,
         "'byteLength' is missing"},
        {NULL, INDICES("'mode':'TRIANGLES','count':7,'byteStride':2"), HE_BAD_VALUE,
         "count must be a multiple of 3"},
        {NULL, INDICES("'mode':'TRIANGLES','count':6,'byteStride':1"), HE_BAD_VALUE,
         "byteStride must be 2 or 4"},
        {NULL, INDICES("'mode':'TRIANGLES','count':6,'byteStride':8"), HE_BAD_VALUE,
         "byteStride must be 2 or 4"},
        {NULL, INDICES("'mode':'TRIANGLES','filter':'EXPONENTIAL','count':6,'byteStride':2"),
         HE_BAD_VALUE, "a filter needs the mode ATTRIBUTES"},
        {NULL, INDICES("'mode':'TRIANGLES','count':2000000001,'byteStride':2"), HE_BAD_VALUE,
         "2000000001 elements of 2 bytes cannot be compressed to"},
        {NULL, INDICES("'mode':'INDICES','count':2000000001,'byteStride':2"), HE_BAD_VALUE,
         "2000000001 elements of 2 bytes cannot be compressed to"},
        {NULL, INDICES("'mode':'TRIANGLES','count':3,'byteStride':2"), HE_BAD_VALUE,
         "the buffer view declares 12 bytes, but decompresses to 6"},
        {NULL, INDICES("'mode':'INDICES','count':6,'byteStride':2"), HE_SYNTAX,
         "the bytes are not a compressed stream of the mode INDICES"},
    };
    bin b = square_packed(HE_MESHOPT_TRIANGLES, 2);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char first[EXTENSION], second[EXTENSION];
        extension(first, &(packed_view){0, b.corners, "ATTRIBUTES", "", 4, 16});
        extension(second, &(packed_view){b.at, b.indices, "TRIANGLES", "", 6, 2});
        if (rows[i].corners != NULL) {
            const char *number = strstr(rows[i].corners, "%zu");
            size_t before =
                number == NULL ? strlen(rows[i].corners) : (size_t)(number - rows[i].corners);
            snprintf(first, sizeof first, "%.*s", (int)before, rows[i].corners);
            if (number != NULL) {
                snprintf(first + before, sizeof first - before, "%zu%s", b.corners, number + 3);
            }
        }
        if (rows[i].indices != NULL) {
            const char *rest = strstr(rows[i].indices, "'mode'");
            snprintf(second, sizeof second, "{'buffer':0,'byteOffset':%zu,'byteLength':%zu,%s",
                     b.at, b.indices, rest);
        }
        expect_packed_refused(&b, first, second, rows[i].status, rows[i].words);
    }
}

/* The end of compressed data is marked in the data itself, so the reader must notice that data is
 * truncated, and refuse it instead of reading other geometry from it. */
static void streams_that_are_cut_or_of_another_version_are_refused(void **state)
{
    (void)state;
    bin b = square_packed(HE_MESHOPT_TRIANGLES, 2);
    char first[EXTENSION], second[EXTENSION];
    for (size_t length = 1; length < b.corners; length++) {
        he_import import = {0};
        he_error err = {0};
        he_status status =
            read_packed(&b, extension(first, &(packed_view){0, length, "ATTRIBUTES", "", 4, 16}),
                        extension(second, &(packed_view){b.at, b.indices, "TRIANGLES", "", 6, 2}),
                        &import, &err);
        assert_true(status == HE_SYNTAX || status == HE_BAD_VALUE);
    }
    extension(first, &(packed_view){0, b.corners, "ATTRIBUTES", "", 4, 16});
    for (size_t length = 1; length < b.indices; length++) {
        he_import import = {0};
        he_error err = {0};
        he_status status = read_packed(
            &b, first, extension(second, &(packed_view){b.at, length, "TRIANGLES", "", 6, 2}),
            &import, &err);
        assert_true(status == HE_SYNTAX || status == HE_BAD_VALUE);
    }
    extension(second, &(packed_view){b.at, b.indices, "TRIANGLES", "", 6, 2});
    b.bytes[0] = 0xA1;
    expect_packed_refused(&b, first, second, HE_UNSUPPORTED,
                          "ATTRIBUTES were compressed by version 1 of their coding; "
                          "EXT_meshopt_compression allows at most 0");
    b.bytes[0] = 0xB0;
    expect_packed_refused(&b, first, second, HE_SYNTAX,
                          "the bytes are not a compressed stream of the mode ATTRIBUTES");
    b.bytes[0] = 0xA0;
    b.bytes[b.at] = 0xE2;
    expect_packed_refused(&b, first, second, HE_UNSUPPORTED,
                          "TRIANGLES were compressed by version 2");
}

/* Flips each bit of the compressed data in turn: the reader must then either read the file, perhaps
 * with other geometry, or refuse it with an error that names a byte. */
static void streams_of_wrong_bytes_end_well(void **state)
{
    (void)state;
    static const char *const filters[] = {"NONE", "EXPONENTIAL"};
    bin whole = square_packed(HE_MESHOPT_TRIANGLES, 2);
    char first[EXTENSION], second[EXTENSION];
    size_t read = 0, refused = 0;
    extension(second, &(packed_view){whole.at, whole.indices, "TRIANGLES", "", 6, 2});
    for (size_t at = 0; at < whole.at + whole.indices; at++) {
        for (unsigned bit = 0; bit < 16; bit++) {
            bin b = whole;
            b.bytes[at] ^= (unsigned char)(1u << bit % 8);
            extension(first, &(packed_view){0, b.corners, "ATTRIBUTES", filters[bit / 8], 4, 16});
            he_import import = {0};
            he_error err = {0};
            if (read_packed(&b, first, second, &import, &err) == HE_OK) {
                read++;
            } else {
                refused++;
                assert_int_equal(err.place, HE_PLACE_BYTE);
            }
            he_import_clear(&import);
        }
    }
    print_message("note: %zu streams with a wrong bit were read, %zu refused\n", read, refused);
    assert_true(read > 0 && refused > 0);
}

/* Buffer views full of zeros are compressed to very few bytes: hedge must decompress them up to a
 * limit on their total size, and refuse a file that exceeds the limit. */
static void what_unpacks_to_too_much_is_refused(void **state)
{
    (void)state;
    enum { COUNT = 1 << 16, STRIDE = 256 };
    he_meshopt_stream stream = {HE_MESHOPT_ATTRIBUTES, HE_MESHOPT_NONE, COUNT, STRIDE};
    size_t most = he_meshopt_bound(&stream);
    unsigned char *zeros = calloc(COUNT, STRIDE), *room = malloc(most);
    assert_non_null(zeros);
    assert_non_null(room);
    size_t length = he_meshopt_encode(&stream, zeros, room, most);
    free(zeros);
    size_t padded = (length + 3) / 4 * 4;
    /* Each view is decompressed to 16 MiB. A file may decompress to 32 MiB, which is two such
     * views, plus 16 times its own size. */
    for (size_t views = 1; views <= 6; views++) {
        char json[4096];
        int used = snprintf(json, sizeof json,
                            "{'asset':{'version':'2.0'},'buffers':[{'byteLength':%zu}],"
                            "'bufferViews':[",
                            padded);
        for (size_t i = 0; i < views; i++) {
            used += snprintf(json + used, sizeof json - (size_t)used,
                             "%s{'buffer':0,'byteLength':%d,'byteStride':252,'extensions':{"
                             "'EXT_meshopt_compression':{'buffer':0,'byteLength':%zu,'count':%d,"
                             "'byteStride':%d,'mode':'ATTRIBUTES'}}}",
                             i > 0 ? "," : "", COUNT * STRIDE, length, COUNT, STRIDE);
        }
        used += snprintf(json + used, sizeof json - (size_t)used, "],'accessors':[");
        for (size_t i = 0; i < views; i++) {
            used += snprintf(json + used, sizeof json - (size_t)used,
                             "%s{'bufferView':%zu,'componentType':5126,'count':3,'type':'VEC3'}",
                             i > 0 ? "," : "", i);
        }
        used += snprintf(json + used, sizeof json - (size_t)used, "],'meshes':[{'primitives':[");
        for (size_t i = 0; i < views; i++) {
            used += snprintf(json + used, sizeof json - (size_t)used,
                             "%s{'attributes':{'POSITION':%zu}}", i > 0 ? "," : "", i);
        }
        used += snprintf(json + used, sizeof json - (size_t)used, "]}]}");
        assert_true((size_t)used < sizeof json);
        size_t text = ((size_t)used + 3) / 4 * 4, whole = 28 + text + padded;
        unsigned char *file = malloc(whole);
        assert_non_null(file);
        uint32_t words[] = {0x46546C67, 2, (uint32_t)whole, (uint32_t)text, 0x4E4F534A};
        memcpy(file, words, sizeof words);
        memset(file + 20, ' ', text);
        for (int i = 0; i < used; i++) {
            file[20 + i] = (unsigned char)(json[i] == '\'' ? '"' : json[i]);
        }
        uint32_t chunk[] = {(uint32_t)padded, 0x004E4942};
        memcpy(file + 20 + text, chunk, sizeof chunk);
        memset(file + 28 + text, 0, padded);
        memcpy(file + 28 + text, room, length);
        he_import import = {0};
        he_error err = {0};
        uint64_t allowed = ((uint64_t)32 << 20) + 16 * (uint64_t)(text + padded);
        he_status status = read_bytes("glb", file, whole, &import, &err);
        bool fits = (uint64_t)views * COUNT * STRIDE <= allowed;
        assert_int_equal(status, fits ? HE_OK : HE_LIMIT);
        assert_true(fits || strstr(err.text, "decompresses to more than 32 MiB, and more than 16 "
                                             "times its size") != NULL);
        assert_true(fits == (views < 3));
        he_import_clear(&import);
        free(file);
    }
    free(room);
}

static void a_fallback_may_be_missing_unless_a_plain_view_needs_it(void **state)
{
    (void)state;
    glb_expect_refused("{" ASSET ",'buffers':[{'byteLength':96,'extensions':{"
                       "'EXT_meshopt_compression':{'fallback':true}}}]," VIEWS "," ACCESSORS
                       "," MESHES "}",
                       HE_BAD_VALUE, "buffer 0 is only a fallback and has no bytes");
    glb_expect_refused("{" ASSET ",'buffers':[{'byteLength':96},{'byteLength':96,'uri':'x.bin',"
                       "'extensions':{'EXT_meshopt_compression':{'fallback':false}}}]," VIEWS
                       "," ACCESSORS "," MESHES "}",
                       HE_UNSUPPORTED, "the buffer is in another file, 'x.bin'");
    he_import import =
        glb_square_import("{" ASSET ",'buffers':[{'byteLength':96},{'byteLength':96,'uri':'x.bin',"
                          "'extensions':{'EXT_meshopt_compression':{'fallback':true}}}]," VIEWS
                          "," ACCESSORS "," MESHES "}");
    expect_square(&import);
    he_import_clear(&import);
}

/* --- memory --- */

static void without_memory_nothing_is_read(void **state)
{
    (void)state;
    bin b = square_packed(HE_MESHOPT_TRIANGLES, 2);
    char first[EXTENSION], second[EXTENSION];
    extension(first, &(packed_view){0, b.corners, "ATTRIBUTES", "", 4, 16});
    extension(second, &(packed_view){b.at, b.indices, "TRIANGLES", "", 6, 2});
    char json[4096];
    glb_file f;
    describe(json, sizeof json, first, second);
    glb_make(&f, json, b.bytes, CHUNK);
    failing each = {0};
    while (failing_next(&each)) {
        he_import import = {0};
        he_error err = {0};
        failing_status(
            &each, read_pieces(&(format_file){"glb", f.bytes, f.length}, 0, NULL, &import, &err));
        he_import_clear(&import);
    }
    assert_true(each.n > 4);
}

/* --- writing --- */

/* Files for the tests of the writer: `seam` has polygons, groups, and corners with different values
 * at one vertex; the files after it have only triangles, or no faces. */
static const char seam[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 0.1\nv 9 9 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "vt 0.25 0.125\nvn 0 0 1\ng one\nf 1/1/1 2/2/1 3/3/1 4/4/1\ng two\nusemtl red\n"
    "f 2/5/1 5/1/1 3/4/1\n";
static const char cut[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                          "f 1/1 2/2 3/3\nf 3/1 4/2 1/3\n";
static const char bare[] =
    "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 5 5 5 1 1 1\n"
    "f 3 1 2\nf 1 3 4\n";
static const char points[] = "v 0 0 0\nv 1 0 0\n";

static he_import read_glb(const he_mesh *mesh, const char *encoding, size_t piece, size_t *length)
{
    he_import import = {0};
    he_error err = {0};
    char *bytes = write_encoded("glb", encoding, mesh, piece, NULL, length);
    if (read_pieces(&(format_file){"glb", bytes, *length}, 0, NULL, &import, &err) != HE_OK) {
        fail_msg("%s: %s", encoding, err.text);
    }
    free(bytes);
    return import;
}

/* Requires that two soups have equal faces. With `exact`, each face must also begin with the same
 * corner. */
static void expect_same_faces(const he_soup *a, const he_soup *b, bool exact)
{
    assert_int_equal(a->face_count, b->face_count);
    assert_int_equal(a->corner_count, b->corner_count);
    for (size_t f = 0; f < a->face_count; f++) {
        size_t start = a->starts[f];
        size_t end = f + 1 < a->face_count ? a->starts[f + 1] : a->corner_count;
        size_t turn = 0;
        assert_int_equal(b->starts[f], start);
        while (start + turn < end && b->corners[start + turn] != a->corners[start]) {
            turn++;
        }
        assert_true(start + turn < end && (!exact || turn == 0));
        for (size_t k = 0; k < end - start; k++) {
            assert_int_equal(a->corners[start + k], b->corners[start + (turn + k) % (end - start)]);
        }
    }
}

static void a_packed_file_has_what_a_plain_one_has(void **state)
{
    (void)state;
    static const char *const texts[] = {seam, cut, bare, points};
    static const size_t pieces[] = {1, 100, 4096};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        he_mesh *mesh = mesh_of_text("obj", texts[i]);
        for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++) {
            size_t plain, packed_bytes;
            he_import a = read_glb(mesh, "binary", 4096, &plain);
            he_import b = read_glb(mesh, "meshopt", pieces[k], &packed_bytes);
            assert_int_equal(a.soup.vertex_count, b.soup.vertex_count);
            assert_memory_equal(a.soup.positions, b.soup.positions,
                                a.soup.vertex_count * sizeof(he_vec3));
            expect_same_faces(&a.soup, &b.soup, i < 2);
            assert_int_equal(a.soup.column_count, b.soup.column_count);
            for (size_t c = 0; c < a.soup.column_count; c++) {
                expect_same_columns(a.soup.columns[c], b.soup.columns[c]);
            }
            assert_int_equal(b.warnings.count, 0);
            he_import_clear(&a);
            he_import_clear(&b);
        }
        he_mesh_free(mesh);
    }
}

/* An empty mesh has no data to compress, so the file must be equal to an uncompressed one. */
static void an_empty_mesh_is_not_packed(void **state)
{
    (void)state;
    he_mesh *mesh = he_mesh_new();
    assert_non_null(mesh);
    size_t plain, length;
    char *a = write_encoded("glb", "binary", mesh, 4096, NULL, &plain);
    char *b = write_encoded("glb", "meshopt", mesh, 4096, NULL, &length);
    assert_int_equal(plain, length);
    assert_memory_equal(a, b, length);
    free(a);
    free(b);
    he_mesh_free(mesh);
}

static void a_regular_mesh_becomes_smaller(void **state)
{
    (void)state;
    enum { SIDE = 60 };
    char *text = malloc(SIDE * SIDE * 80), *at = text;
    assert_non_null(text);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            at += snprintf(at, 80, "v %d %d %d\n", x, y, x * y % 7);
        }
    }
    for (int y = 0; y + 1 < SIDE; y++) {
        for (int x = 0; x + 1 < SIDE; x++) {
            int v = y * SIDE + x + 1;
            at += snprintf(at, 80, "f %d %d %d\nf %d %d %d\n", v, v + 1, v + SIDE + 1, v,
                           v + SIDE + 1, v + SIDE);
        }
    }
    he_mesh *mesh = mesh_of_text("obj", text);
    size_t plain, length;
    free(write_encoded("glb", "binary", mesh, 4096, NULL, &plain));
    free(write_encoded("glb", "meshopt", mesh, 4096, NULL, &length));
    print_message("note: a grid of %d faces has %zu bytes as GLB, %zu packed\n",
                  2 * (SIDE - 1) * (SIDE - 1), plain, length);
    assert_true(length * 2 < plain);
    he_mesh_free(mesh);
    free(text);
}

static void a_writer_without_memory_is_refused(void **state)
{
    (void)state;
    he_mesh *mesh = mesh_of_text("obj", seam);
    failing f = {0};
    while (failing_next(&f)) {
        he_writer *writer = NULL;
        he_status status =
            he_writer_new(he_format_find("glb"), mesh, HE_GLB_MESHOPT, NULL, &writer, NULL);
        he_writer_free(failing_status(&f, status) ? writer : NULL);
    }
    assert_true(f.n > 9);
    he_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_views_are_read_as_plain_ones),
        cmocka_unit_test(exponents_are_undone),
        cmocka_unit_test(directions_and_turns_are_undone),
        cmocka_unit_test(what_the_extension_forbids_is_refused),
        cmocka_unit_test(streams_that_are_cut_or_of_another_version_are_refused),
        cmocka_unit_test(streams_of_wrong_bytes_end_well),
        cmocka_unit_test(what_unpacks_to_too_much_is_refused),
        cmocka_unit_test(a_fallback_may_be_missing_unless_a_plain_view_needs_it),
        cmocka_unit_test(without_memory_nothing_is_read),
        cmocka_unit_test(a_packed_file_has_what_a_plain_one_has),
        cmocka_unit_test(an_empty_mesh_is_not_packed),
        cmocka_unit_test(a_regular_mesh_becomes_smaller),
        cmocka_unit_test(a_writer_without_memory_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
