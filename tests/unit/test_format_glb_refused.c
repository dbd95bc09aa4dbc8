/* GLB and glTF files that must be refused: each error must name a byte of the file and the path of
 * the mistake in the JSON text. */
#include "unit/gltf_file.h"

#include <time.h>

static void containers(void **state)
{
    (void)state;
    unsigned char bin[SQUARE_BYTES];
    glb_file good;
    glb_square_bin(bin);
    glb_make(&good, "{" DATA "," MESHES "}", bin, sizeof bin);
    size_t json = good.bin - 8 - 20, at = good.bin - 8;
    /* A truncated file must be refused, whatever its length is. */
    for (size_t length = 0; length < good.length; length++) {
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(
            read_pieces(&(format_file){"glb", good.bytes, length}, 0, NULL, &import, &err),
            HE_SYNTAX);
        assert_int_equal(err.place, HE_PLACE_BYTE);
        assert_int_equal(err.at, length);
    }
    const struct {
        size_t where;
        uint32_t word;
        he_status status;
        uint64_t at;
        const char *words;
    } rows[] = {
        {0, 0x46546C68, HE_SYNTAX, 0, "not a GLB file"},
        {4, 1, HE_UNSUPPORTED, 4, "the version of the GLB file is 1, not 2"},
        {4, 3, HE_UNSUPPORTED, 4, "the version of the GLB file is 3, not 2"},
        {8, 19, HE_SYNTAX, 8, "a GLB file of 19 bytes cannot hold a chunk"},
        {8, (uint32_t)good.length + 4, HE_SYNTAX, good.length, "the file is shorter than the"},
        {8, (uint32_t)good.length - 4, HE_SYNTAX, at, "a chunk declares 96 bytes"},
        {8, 0xFFFFFFFF, HE_SYNTAX, good.length, "shorter than the 4294967295 bytes"},
        {12, 0xFFFFFFF0, HE_SYNTAX, 12, "a chunk declares 4294967280 bytes"},
        {12, (uint32_t)json + 2, HE_SYNTAX, at + 4, "a chunk declares 5130562 bytes"},
        {16, 0x004E4942, HE_SYNTAX, 16, "the first chunk is not \"JSON\""},
        {at + 4, 0x4E4F534A, HE_SYNTAX, at + 4, "there is a second JSON chunk"},
        {at, 0xFFFFFFF0, HE_SYNTAX, at, "a chunk declares 4294967280 bytes"},
        {at, 97, HE_SYNTAX, at, "a chunk declares 97 bytes"},
        {at, 94, HE_BAD_VALUE, 58, "only 94 were sent"},
        {at, 91, HE_SYNTAX, good.length - 5, "5 bytes follow the last chunk"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        glb_file f = good;
        f.length = rows[i].where;
        glb_word(&f, rows[i].word);
        expect_refused_at_byte(&(format_file){"glb", f.bytes, good.length}, rows[i].status,
                               rows[i].at, rows[i].words);
    }
    glb_file f = good;
    glb_word(&f, 0);
    expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_SYNTAX, good.length,
                           "the file is longer than the");
    /* The four bytes after the last chunk are too few for the header of another chunk. */
    f.bytes[8] = (unsigned char)f.length;
    f.bytes[9] = (unsigned char)(f.length >> 8);
    expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_SYNTAX, good.length,
                           "4 bytes follow the last chunk, which are too few");
    /* A third chunk has the type of a binary chunk, but only the second chunk may have this
     * type. */
    f = good;
    glb_word(&f, 0);
    glb_word(&f, 0x004E4942);
    f.bytes[8] = (unsigned char)f.length;
    f.bytes[9] = (unsigned char)(f.length >> 8);
    expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_SYNTAX, good.length + 4,
                           "a BIN chunk must be the second chunk");
    /* The file has no binary chunk, or an empty one, but a buffer refers to it. */
    glb_make(&f, "{" DATA "," MESHES "}", NULL, 0);
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_bytes("glb", f.bytes, f.length, &import, &err), HE_BAD_VALUE);
    assert_non_null(strstr(
        err.text,
        "buffers/0: the buffer has no URI, and the file has no binary chunk that holds its bytes"));
    glb_make(&f, "{" DATA "," MESHES "}", bin, 0);
    assert_int_equal(read_bytes("glb", f.bytes, f.length, &import, &err), HE_BAD_VALUE);
    assert_non_null(
        strstr(err.text, "buffers/0: the buffer should have 96 bytes, and only 0 were sent"));
    glb_make(&f, "", NULL, 0);
    expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_SYNTAX, 20,
                           "the text ends");
    expect_refused_at_byte(&(format_file){"gltf", "", 0}, HE_SYNTAX, 0, "the text ends");
}

static void json_to_the_letter(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        he_status status;
        uint64_t at;
        const char *words;
    } rows[] = {
        {"{\"asset\":{\"version\":\"2.0\"}", HE_SYNTAX, 26, "closing bracket"},
        {"{\"asset\":{\"version\":\"2.0\"}},", HE_SYNTAX, 27, "more text follows the JSON value"},
        {"\xEF\xBB\xBF{}", HE_SYNTAX, 0, "a value is expected"},
        {"{\"a\":1,}", HE_SYNTAX, 7, "a member's name"},
        {"{\"a\" 1}", HE_SYNTAX, 5, "':' is expected"},
        {"[1,]", HE_SYNTAX, 3, "a value is expected"},
        {"[1 2]", HE_SYNTAX, 3, "',' or the closing"},
        {"[01]", HE_SYNTAX, 1, "not a number"},
        {"[1.]", HE_SYNTAX, 1, "not a number"},
        {"[-]", HE_SYNTAX, 1, "not a number"},
        {"[1e999]", HE_NOT_FINITE, 1, "does not fit a double"},
        {"[nan]", HE_SYNTAX, 1, "a value is expected"},
        {"[tru]", HE_SYNTAX, 1, "a value is expected"},
        {"[\"\\x\"]", HE_SYNTAX, 2, "JSON has no such escape sequence"},
        {"[\"\\u12\"]", HE_SYNTAX, 2, "four hexadecimal"},
        {"[\"\\u0000\"]", HE_SYNTAX, 2, "a null character"},
        {"[\"\\ud800\"]", HE_SYNTAX, 2, "half of a surrogate pair is missing"},
        {"[\"\\ud800\\u0041\"]", HE_SYNTAX, 2, "half of a surrogate pair is missing"},
        {"[\"\\udc00\"]", HE_SYNTAX, 2, "half of a surrogate pair is missing"},
        {"[\"a\nb\"]", HE_SYNTAX, 3, "a control character"},
        {"[\"\xC0\x80\"]", HE_SYNTAX, 2, "not UTF-8"},
        {"[\"abc", HE_SYNTAX, 5, "does not end"},
        {"[\"abc\\", HE_SYNTAX, 5, "does not end"},
        {"{\"a\":1,\"b\":2,\"a\":3}", HE_SYNTAX, 13, "the member 'a' is given twice"},
        {"[{\"a\":1,\"\\u0061\":3}]", HE_SYNTAX, 8, "the member 'a' is given twice"},
        {"{\"a\":1,\"b\":2,\"c\":3,\"d\":4,\"e\":5,\"f\":6,\"g\":7,\"h\":8,\"i\":9,\"j\":10,"
         "\"k\":11,\"l\":12,\"m\":13,\"c\":14}",
         HE_SYNTAX, 83, "the member 'c' is given twice"},
        {"[]", HE_SYNTAX, 0, "not a glTF asset"},
        {"{}", HE_SYNTAX, 0, "not a glTF asset"},
        {"3", HE_SYNTAX, 0, "not a glTF asset"},
        {"{\"asset\":{}}", HE_SYNTAX, 9, "not a glTF asset"},
        {"{\"asset\":{\"version\":2}}", HE_SYNTAX, 9, "not a glTF asset"},
        {"{\"asset\":{\"version\":\"1.0\"}}", HE_UNSUPPORTED, 20,
         "asset/version: the version of glTF"},
        {"{\"asset\":{\"version\":\"20\"}}", HE_UNSUPPORTED, 20,
         "asset/version: the version of glTF"},
        {"{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}", HE_UNSUPPORTED, 39,
         "asset/minVersion: the file needs a reader of a later version"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_refused_at_byte(&(format_file){"gltf", rows[i].text, strlen(rows[i].text)},
                               rows[i].status, rows[i].at, rows[i].words);
    }
    static const char fine[] =
        "{\"asset\":{\"version\":\"2.0\"},\"x\":[\"\\ud83d\\ude00\\n\\u00e4\","
        "-1.5e-3,true,false,null,{},[]]}";
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_bytes("gltf", fine, sizeof fine - 1, &import, &err), HE_OK);
    expect_counts(&import, 0, 0, 0);
    he_import_clear(&import);
}

/* A glTF file that is valid, except that its first accessor `a` may be invalid. */
#define WITH_ACCESSOR(a)                               \
    "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" a \
    ",{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}]," MESHES "}"
#define WITH_VIEW(v)                                                                      \
    "{" ASSET "," BUFFERS ",'bufferViews':[" v                                            \
    ",{'buffer':0,'byteOffset':48,'byteLength':12}],'accessors':[{'bufferView':0,"        \
    "'componentType':5126,'count':4,'type':'VEC3'},{'bufferView':1,'componentType':5123," \
    "'count':6,'type':'SCALAR'}]," MESHES "}"
#define WITH_PRIMITIVE(p) "{" DATA ",'meshes':[{'primitives':[" p "]}]}"
#define WITH_NODES(n)     "{" DATA "," MESHES ",'scenes':[{'nodes':[0]}],'nodes':[" n "]}"
#define WITH_SPARSE(s) \
    WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','sparse':" s "}")

/* The padding "=" may only stand at the end of base64 data. The misplaced padding is at the border
 * between two pieces that the decoder reads, in a text with JSON escapes and in one without. */
static void base64_that_ends_too_early(void **state)
{
    (void)state;
    enum { PIECE = 1 << 16 };
    static const char head[] = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":9,"
                               "\"uri\":\"data:;base64,";
    static const char *const ends[] = {"==AAAA\"}]}", "A=AAAA\"}]}", "==\\u0041AAA\"}]}"};
    for (size_t i = 0; i < 3; i++) {
        size_t length = sizeof head - 1 + PIECE - 2;
        char *text = malloc(length + 40);
        assert_non_null(text);
        memset(text, 'A', length);
        memcpy(text, head, sizeof head - 1);
        length += (size_t)snprintf(text + length, 40, "%s", ends[i]);
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(read_pieces(&(format_file){"gltf", text, length}, 0, NULL, &import, &err),
                         HE_SYNTAX);
        assert_non_null(strstr(err.text, "buffers/0/uri: the data: URI of a buffer is not base64"));
        free(text);
    }
}

static void references_and_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *json;
        he_status status;
        const char *words;
    } rows[] = {
        /* mistakes in accessors */
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':0,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/count: 0 is not a whole number from 1"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':4.5,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/count: 4.5 is not"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':-4,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/count: -4 is not"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':'4','type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/count: \"4\" is not"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'type':'VEC3'}"), HE_BAD_VALUE,
         "accessors/0: 'count' is missing"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'}"),
         HE_BAD_VALUE,
         "accessors/0: 5 elements of 12 bytes from byte 0 do not fit in a buffer view of 48"},
        {WITH_ACCESSOR("{'componentType':5126,'count':4000000000,'type':'VEC3'}"), HE_LIMIT,
         "accessors/0: the accessor has 4000000000 elements, more than a mesh can have"},
        {WITH_ACCESSOR("{'componentType':5126,'count':9007199254740992,'type':'VEC3'}"), HE_LIMIT,
         "accessors/0: the accessor has 9007199254740992 elements"},
        {WITH_ACCESSOR("{'componentType':5126,'count':9007199254740993000,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/count"},
        {WITH_ACCESSOR("{'componentType':5126,'count':2000000000,'type':'VEC3'}"), HE_LIMIT,
         "meshes/0/primitives/0: the scene has more than"},
        {WITH_ACCESSOR("{'bufferView':0,'byteOffset':4,'componentType':5126,'count':4,"
                       "'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0: 4 elements of 12 bytes from byte 4"},
        {WITH_ACCESSOR("{'bufferView':0,'byteOffset':9007199254740988,'componentType':5126,"
                       "'count':4,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0: 4 elements"},
        {WITH_ACCESSOR("{'bufferView':0,'byteOffset':18446744073709551604,'componentType':5126,"
                       "'count':4,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/byteOffset"},
        {WITH_ACCESSOR("{'bufferView':0,'byteOffset':-12,'componentType':5126,'count':4,"
                       "'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/byteOffset: -12 is not"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5124,'count':4,'type':'VEC3'}"),
         HE_BAD_VALUE, "componentType 5124 does not exist"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5130,'count':4,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0/componentType: 5130"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':4,'type':'VEC5'}"),
         HE_BAD_VALUE, "accessors/0: 'type' is not"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5126,'count':4,'type':'VEC2'}"),
         HE_BAD_VALUE, "accessors/0: positions must be VEC3"},
        {WITH_ACCESSOR("{'bufferView':0,'componentType':5125,'count':4,'type':'VEC3'}"),
         HE_BAD_VALUE, "accessors/0: positions must be VEC3"},
        {WITH_ACCESSOR("{'bufferView':7,'componentType':5126,'count':4,'type':'VEC3'}"),
         HE_BAD_INDEX, "accessors/0/bufferView: there is no buffer view 7; the file has 5"},
        {WITH_ACCESSOR("3"), HE_BAD_VALUE, "accessors/0: the value is not an object"},
        /* mistakes in buffer views and buffers */
        {WITH_VIEW("{'byteLength':48}"), HE_BAD_VALUE, "bufferViews/0: 'buffer' is missing"},
        {WITH_VIEW("{'buffer':1,'byteLength':48}"), HE_BAD_INDEX,
         "there is no buffer 1; the file has 1"},
        {WITH_VIEW("{'buffer':0}"), HE_BAD_VALUE, "'byteLength' is missing"},
        {WITH_VIEW("{'buffer':0,'byteLength':97}"), HE_BAD_VALUE,
         "bytes 0 to 97 do not fit in a buffer of 96"},
        {WITH_VIEW("{'buffer':0,'byteOffset':49,'byteLength':48}"), HE_BAD_VALUE,
         "bufferViews/0: bytes 49 to 97 do not fit in a buffer of 96"},
        {WITH_VIEW("{'buffer':0,'byteOffset':9007199254740991,'byteLength':9007199254740991}"),
         HE_BAD_VALUE, "bufferViews/0: bytes"},
        {WITH_VIEW("{'buffer':0,'byteOffset':-4,'byteLength':48}"), HE_BAD_VALUE,
         "bufferViews/0/byteOffset: -4"},
        {WITH_VIEW("{'buffer':0,'byteLength':48,'byteStride':2147483647}"), HE_BAD_VALUE,
         "bufferViews/0/byteStride: 2147483647 is not a whole number from 0 to 252"},
        {WITH_VIEW("{'buffer':0,'byteLength':48,'byteStride':4}"), HE_BAD_VALUE,
         "elements of 12 bytes overlap, because the stride is only 4"},
        {WITH_VIEW("{'buffer':0,'byteLength':48,'byteStride':16}"), HE_BAD_VALUE,
         "accessors/0: 4 elements"},
        {"{" ASSET ",'buffers':[{'byteLength':97}]}", HE_BAD_VALUE,
         "should have 97 bytes, and only 96"},
        {"{" ASSET ",'buffers':[{}]}", HE_BAD_VALUE, "buffers/0: 'byteLength' is missing"},
        {"{" ASSET ",'buffers':[{'byteLength':96},{'byteLength':4}]}", HE_BAD_VALUE,
         "buffers/1: the buffer has no URI, and the file has no binary chunk"},
        {"{" ASSET ",'buffers':[{'byteLength':96,'uri':'data.bin'}]}", HE_UNSUPPORTED,
         "buffers/0/uri: the buffer is in another file, 'data.bin'"},
        {"{" ASSET ",'buffers':[{'byteLength':96,'uri':'http://169.254.169.254/'}]}",
         HE_UNSUPPORTED, "buffers/0/uri: the buffer is in another file, 'http://169.254.169.254/'"},
        {"{" ASSET ",'buffers':[{'byteLength':96,'uri':'data:,abc'}]}", HE_UNSUPPORTED,
         "buffers/0/uri: the data: URI of a buffer is not base64"},
        {"{" ASSET ",'buffers':[{'byteLength':96,'uri':'data:;base64,A-=='}]}", HE_SYNTAX,
         "buffers/0/uri: the data: URI of a buffer is not base64"},
        {"{" ASSET ",'buffers':[{'byteLength':96,'uri':'data:;base64,AAAA'}]}", HE_BAD_VALUE,
         "buffers/0: the buffer should have 96 bytes, and only 3"},
        {"{" ASSET ",'buffers':3}", HE_BAD_VALUE, "buffers: the value is not an array"},
        {"{" ASSET ",'buffers':[{'byteLength':9,'extensions':{'EXT_meshopt_compression':{}}},"
         "{'byteLength':9,'extensions':{'EXT_meshopt_compression':{}}}]}",
         HE_BAD_VALUE,
         "buffers/1: the buffer has no URI, and the file has no binary chunk that holds its bytes"},
        /* mistakes in normals and other directions */
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0,'NORMAL':4},'indices':1}"), HE_BAD_VALUE,
         "accessors/4: NORMAL must have componentType 5126, not 5121"},
        {"{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" ACCESSOR_LIST
         ",{'bufferView':4,'componentType':5120,'count':4,'type':'VEC3','normalized':true}],"
         "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':5},'indices':1}]}]}",
         HE_BAD_VALUE, "accessors/5: NORMAL must have componentType 5126, not 5120"},
        {"{" ASSET "," BUFFERS "," VIEWS ",'extensionsUsed':['KHR_mesh_quantization'],"
         "'accessors':[" ACCESSOR_LIST
         ",{'bufferView':4,'componentType':5121,'count':4,'type':'VEC4','normalized':true}],"
         "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TANGENT':5},'indices':1}]}]}",
         HE_BAD_VALUE,
         "accessors/5: TANGENT must have componentType 5126, or 5120 or 5122 with `normalized`, "
         "not "
         "5121"},
        /* mistakes in primitives */
        {WITH_PRIMITIVE("{'indices':1}"), HE_BAD_VALUE, "'attributes' is missing"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':9}}"), HE_BAD_INDEX,
         "meshes/0/primitives/0/attributes/POSITION: there is no accessor 9; the file has 5"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0},'indices':4294967296}"), HE_BAD_INDEX,
         "meshes/0/primitives/0/indices: there is no accessor 4294967296"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0},'indices':0}"), HE_BAD_VALUE,
         "accessors/0: indices must be SCALAR"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0},'indices':1,'mode':7}"), HE_BAD_VALUE,
         "meshes/0/primitives/0/mode: 7 is not a whole number from 0 to 6"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0},'indices':2}"), HE_BAD_VALUE,
         "meshes/0/primitives/0: 4 corners do not make a whole number of triangles"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0,'_A':1},'indices':1}"), HE_BAD_VALUE,
         "attributes/_A: 6 values are given for 4 vertices"},
        {WITH_PRIMITIVE("{'attributes':{'POSITION':0},'indices':1,'material':0}"), HE_BAD_INDEX,
         "there is no material 0; the file has 0"},
        {"{" DATA ",'meshes':[{'primitives':[1]}]}", HE_BAD_VALUE, "the value is not an object"},
        {"{" DATA ",'meshes':[{}]}", HE_BAD_VALUE, "meshes/0: 'primitives' is missing"},
        /* mistakes in nodes */
        {WITH_NODES("{'mesh':1}"), HE_BAD_INDEX,
         "nodes/0/mesh: there is no mesh 1; the file has 1"},
        {WITH_NODES("{'children':[1]}"), HE_BAD_INDEX, "there is no node 1; the file has 1"},
        {WITH_NODES("{'children':[0]}"), HE_BAD_VALUE,
         "nodes/0/children/0: node 0 is reached twice"},
        {WITH_NODES("{'children':[1]},{'children':[0]}"), HE_BAD_VALUE, "node 0 is reached twice"},
        {WITH_NODES("{'children':[1,1]},{'mesh':0}"), HE_BAD_VALUE, "node 1 is reached twice"},
        /* if there are no scenes, the reader begins at nodes without parents; in a cycle each node
         * has a parent, so the reader must find the cycle in another way */
        {"{" DATA "," MESHES ",'nodes':[{'mesh':0,'children':[0]}]}", HE_BAD_VALUE,
         "nodes/0/children/0: node 0 is inside itself"},
        {"{" DATA "," MESHES
         ",'nodes':[{'mesh':0},{'mesh':0},{'children':[1,3]},{'children':[2]}]}",
         HE_BAD_VALUE, "nodes/2/children/1: node 3 is inside itself"},
        /* A JSON value that should be a list but is none must be refused. If it were read like an
         * empty list, the mesh would be missing without an error. */
        {WITH_NODES("{'children':1},{'mesh':0}"), HE_BAD_VALUE,
         "nodes/0/children: the value is not"},
        {WITH_NODES("{'children':{}},{'mesh':0}"), HE_BAD_VALUE,
         "nodes/0/children: the value is not"},
        {"{" DATA "," MESHES ",'nodes':[{'mesh':0},{'children':'x'}]}", HE_BAD_VALUE,
         "nodes/1/children: the value is not an array"},
        {"{" DATA "," MESHES ",'nodes':[{'mesh':0}],'scenes':-1}", HE_BAD_VALUE,
         "scenes: the value is not an array"},
        {"{" DATA "," MESHES ",'nodes':[{'mesh':0}],'scenes':[{'nodes':null}]}", HE_BAD_VALUE,
         "scenes/0/nodes: the value is not an array"},
        {WITH_NODES("{'matrix':[1,2,3]}"), HE_BAD_VALUE,
         "nodes/0/matrix: the value must be an array of 16 numbers"},
        {WITH_NODES("{'matrix':[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}"), HE_BAD_VALUE, "last row"},
        {WITH_NODES("{'scale':[1,2,3,4]}"), HE_BAD_VALUE,
         "nodes/0/scale: the value must be an array of 3 numbers"},
        {WITH_NODES("{'scale':[1,2,null]}"), HE_BAD_VALUE,
         "nodes/0/scale/2: the value is not a number"},
        {WITH_NODES("{'rotation':5}"), HE_BAD_VALUE,
         "nodes/0/rotation: the value must be an array of 4 numbers"},
        {WITH_NODES("{'rotation':[0,-0,0,0]}"), HE_BAD_VALUE,
         "nodes/0/rotation: a rotation cannot be a quaternion of length 0"},
        {WITH_NODES("{'mesh':0,'scale':[1e308,1e308,1]},{}"), HE_OK, ""},
        {WITH_NODES("{'mesh':0,'scale':[1e308,1,1],'translation':[1e308,0,0]}"), HE_NOT_FINITE,
         "not finite"},
        {"{" DATA ",'scene':2,'scenes':[{}]}", HE_BAD_INDEX,
         "scene: there is no scene 2; the file has 1"},
        /* mistakes in sparse accessors */
        {WITH_SPARSE("{'count':2}"), HE_BAD_VALUE,
         "a sparse accessor needs 'indices' and 'values'"},
        {WITH_SPARSE("{'count':5,'indices':{'bufferView':1,'componentType':5123},'values':"
                     "{'bufferView':0}}"),
         HE_BAD_VALUE, "accessors/0/sparse/count: 5 is not a whole number from 1 to 4"},
        {WITH_SPARSE("{'count':3,'indices':{'bufferView':1,'byteOffset':4,'componentType':5123},"
                     "'values':{'bufferView':0}}"),
         HE_BAD_INDEX, "accessors/0/sparse: sparse index 0 (number 1)"},
        {WITH_SPARSE("{'count':4,'indices':{'bufferView':1,'componentType':5126},'values':"
                     "{'bufferView':0}}"),
         HE_BAD_VALUE, "sparse indices must have componentType"},
        {WITH_SPARSE("{'count':4,'indices':{'bufferView':2,'componentType':5123},'values':"
                     "{'bufferView':0}}"),
         HE_BAD_VALUE, "sparse/indices: 4 elements of 2 bytes"},
        {WITH_SPARSE("{'count':3,'indices':{'bufferView':1,'componentType':5123},'values':"
                     "{'bufferView':1}}"),
         HE_BAD_VALUE, "sparse/values: 3 elements of 12 bytes"},
        {WITH_SPARSE("{'count':3,'indices':{'bufferView':1,'componentType':5123},'values':{}}"),
         HE_BAD_VALUE, "sparse/values: 'bufferView' is missing"},
        /* extensions that the reader does not support */
        {"{" ASSET ",'extensionsRequired':['KHR_draco_mesh_compression']}", HE_UNSUPPORTED,
         "extensionsRequired/0: Draco compression is not supported: unpack it first, as "
         "\"gltf-transform copy"},
        {"{" ASSET ",'extensionsRequired':['EXT_meshopt_compression','KHR_meshopt_compression']}",
         HE_UNSUPPORTED, "extensionsRequired/1: the file needs the extension KHR_meshopt"},
        {"{" ASSET ",'extensionsRequired':['ACME_x']}", HE_UNSUPPORTED, "ACME_x"},
        {"{" ASSET ",'accessors':[{'componentType':5126,'count':3,'type':'VEC3'}],'meshes':[{"
         "'primitives':[{'attributes':{'POSITION':0},'extensions':{'KHR_draco_mesh_compression':"
         "{}}}]}]}",
         HE_UNSUPPORTED,
         "the primitive is stored only with Draco compression, which is not supported: unpack it "
         "first, as \"gltf-transform"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].status == HE_OK) {
            he_import import = glb_square_import(rows[i].json);
            he_import_clear(&import);
        } else {
            glb_expect_refused(rows[i].json, rows[i].status, rows[i].words);
        }
    }
}

static void numbers_in_the_buffer(void **state)
{
    (void)state;
    unsigned char bin[SQUARE_BYTES];
    static const uint32_t bits[] = {0x7FC00000, 0x7F800000, 0xFF800000};
    glb_file f;
    for (size_t i = 0; i < 3; i++) {
        glb_square_bin(bin);
        memcpy(bin + 28, &bits[i], 4);
        glb_make(&f, "{" DATA "," MESHES "}", bin, sizeof bin);
        expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_NOT_FINITE, f.bin + 24,
                               "not finite");
    }
    static const uint16_t bad[] = {4, 65535};
    for (size_t i = 0; i < 2; i++) {
        glb_square_bin(bin);
        memcpy(bin + 56, &bad[i], 2);
        glb_make(&f, "{" DATA "," MESHES "}", bin, sizeof bin);
        expect_refused_at_byte(&(format_file){"glb", f.bytes, f.length}, HE_BAD_INDEX, f.bin + 56,
                               "meshes/0/primitives/0: index");
    }
    /* only positions must not be NaN; in another attribute NaN is read as 0, with a warning */
    he_import import = {0};
    he_error err = {0};
    glb_square_bin(bin);
    memcpy(bin + 64, &bits[0], 4);
    glb_make(&f,
             "{" ASSET "," BUFFERS "," VIEWS ",'accessors':[" ACCESSOR_LIST
             ",{'bufferView':3,'componentType':5126,'count':4,'type':'SCALAR'}],'meshes':[{"
             "'primitives':[{'attributes':{'POSITION':0,'_A':5},'indices':1}]}]}",
             bin, sizeof bin);
    assert_int_equal(read_bytes("glb", f.bytes, f.length, &import, &err), HE_OK);
    assert_non_null(find_warning(&import.warnings, "not_finite", "A"));
    he_import_clear(&import);
}

/* --- bombs --- */

typedef struct writing {
    char *text;
    size_t length, room;
} writing;

static void put(writing *w, const char *text)
{
    size_t n = strlen(text);
    if (w->length + n + 1 > w->room) {
        w->room = 2 * (w->room + n) + 64;
        w->text = realloc(w->text, w->room);
        assert_non_null(w->text);
    }
    for (size_t i = 0; i <= n; i++) {
        w->text[w->length + i] = text[i] == '\'' ? '"' : text[i];
    }
    w->length += n;
}

static void expect_bomb(writing *w, he_status wanted, const char *words)
{
    he_import import = {0};
    he_error err = {0};
    struct timespec from, to;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
    he_status status =
        read_pieces(&(format_file){"gltf", w->text, w->length}, 0, NULL, &import, &err);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
    if (status != wanted || strstr(err.text, words) == NULL) {
        fail_msg("%.200s: %s: %s", w->text, he_status_slug(status), err.text);
    }
    print_message("%zu bytes, %.3f s: %s\n", w->length,
                  (double)(to.tv_sec - from.tv_sec) + (double)(to.tv_nsec - from.tv_nsec) * 1e-9,
                  status == HE_OK ? "read" : err.text);
    if (status == HE_OK) {
        he_import_clear(&import);
    }
    free(w->text);
    *w = (writing){0};
}

static void bombs(void **state)
{
    (void)state;
    writing w = {0};
    char part[200];
    /* each of 40 nodes has the next node as a child twice: if this were allowed, the scene would
     * show the last node 2^40 times */
    put(&w, "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[");
    for (int i = 0; i < 40; i++) {
        snprintf(part, sizeof part, "{'children':[%d,%d]},", i + 1, i + 1);
        put(&w, part);
    }
    put(&w, "{}]}");
    expect_bomb(&w, HE_BAD_VALUE, "node 40 is reached twice");
    /* JSON that is nested deeper than in any real file, by lists, objects, or both */
    put(&w, "{'asset':{'version':'2.0'},'extras':");
    for (int i = 0; i < 90000; i++) {
        put(&w, i % 2 ? "{'a':" : "[");
    }
    expect_bomb(&w, HE_SYNTAX, "nesting is deeper than 128 levels");
    /* An accessor without a buffer view consists of zeros and takes no bytes in the file. The first
     * file uses one large accessor of this kind; the next files use a smaller one in many nodes or
     * many primitives. */
    static const char zeros[] = "'accessors':[{'componentType':5126,'count':%d,'type':'VEC3'}]";
    put(&w, "{'asset':{'version':'2.0'},");
    snprintf(part, sizeof part, zeros, 3000000);
    put(&w, part);
    put(&w, ",'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]}");
    expect_bomb(&w, HE_LIMIT, "meshes/0/primitives/0: the scene has more than 32 MiB");
    put(&w, "{'asset':{'version':'2.0'},");
    snprintf(part, sizeof part, zeros, 30000);
    put(&w, part);
    put(&w, ",'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{}");
    for (int i = 0; i < 100000; i++) {
        put(&w, ",{'mesh':0}");
    }
    put(&w, "]}");
    expect_bomb(&w, HE_LIMIT, "the scene has more than");
    put(&w, "{'asset':{'version':'2.0'},");
    snprintf(part, sizeof part, zeros, 30000);
    put(&w, part);
    put(&w, ",'meshes':[{'primitives':[{'attributes':{'POSITION':0}}");
    for (int i = 0; i < 100000; i++) {
        put(&w, ",{'attributes':{'POSITION':0}}");
    }
    put(&w, "]}]}");
    expect_bomb(&w, HE_LIMIT, "the scene has more than");
    /* many attributes with different names that all use one accessor */
    put(&w, "{'asset':{'version':'2.0'},");
    snprintf(part, sizeof part, zeros, 30000);
    put(&w, part);
    put(&w, ",'meshes':[{'primitives':[{'attributes':{'POSITION':0");
    for (int i = 0; i < 20000; i++) {
        snprintf(part, sizeof part, ",'_A%d':0", i);
        put(&w, part);
    }
    put(&w, "}}]}]}");
    expect_bomb(&w, HE_LIMIT, "");
    /* many nodes use one primitive with many attributes: the reader has to search all these
     * attributes for each node */
    put(&w, "{'asset':{'version':'2.0'},'meshes':[{'primitives':[{'attributes':{");
    for (int i = 0; i < 100000; i++) {
        snprintf(part, sizeof part, "%s'_%d':0", i > 0 ? "," : "", i);
        put(&w, part);
    }
    put(&w, "}}]}],'nodes':[{}");
    for (int i = 0; i < 100000; i++) {
        put(&w, ",{'mesh':0}");
    }
    put(&w, "]}");
    expect_bomb(&w, HE_LIMIT, "the scene has more than");
    /* a long chain of nodes, each a child of the node before it: the reader must not use recursion,
     * and must refuse chains beyond a maximal depth */
    for (int many = 0; many < 2; many++) {
        int depth = many ? 70000 : 60000;
        put(&w, "{'asset':{'version':'2.0'},'nodes':[");
        for (int i = 0; i < depth; i++) {
            snprintf(part, sizeof part, "{'children':[%d]},", i + 1);
            put(&w, part);
        }
        put(&w, "{}]}");
        expect_bomb(&w, many ? HE_LIMIT : HE_OK, many ? "deeper than 65536 levels" : "");
    }
    /* First, a JSON text with more values than the reader allows; then an object and a list with
     * very many members, but not more than the reader allows. */
    put(&w, "{'asset':{'version':'2.0'},'extras':[0");
    for (int i = 0; i < (1 << 23); i++) {
        put(&w, ",0");
    }
    put(&w, "]}");
    expect_bomb(&w, HE_LIMIT, "JSON: there are more than 8388608 values");
    put(&w, "{'asset':{'version':'2.0'},'extras':{'x':0");
    for (int i = 0; i < 500000; i++) {
        snprintf(part, sizeof part, ",'%d':0", i);
        put(&w, part);
    }
    put(&w, "}}");
    expect_bomb(&w, HE_OK, "");
    put(&w, "{'asset':{'version':'2.0'},'nodes':[{}");
    for (int i = 0; i < 1000000; i++) {
        put(&w, ",{}");
    }
    put(&w, "]}");
    expect_bomb(&w, HE_OK, "");
}

/* The member `extras` of a glTF file contains data that only hedge writes and reads. The reader
 * goes through `extras` for every column of attribute values and every node. */
static void bombs_in_extras(void **state)
{
    (void)state;
    static const char column[] = "'rule':'copy','components':1,'accessor':1";
    writing w = {0};
    char part[300];
    /* many columns of the type bool use one accessor, in which only the last value is no bool */
    for (int many = 0; many < 2; many++) {
        put(&w, "{'asset':{'version':'2.0'},'buffers':[{'byteLength':120000,'uri':'data:;base64,");
        for (int i = 0; i < 39999; i++) {
            put(&w, "AAAA");
        }
        put(&w, "AAAC'}],'bufferViews':[{'buffer':0,'byteLength':120000}],'accessors':["
                "{'componentType':5126,'count':30000,'type':'VEC3'},"
                "{'bufferView':0,'componentType':5125,'count':30000,'type':'SCALAR'}],'meshes':["
                "{'primitives':[{'mode':0,'attributes':{'POSITION':0},'extras':{'hedge':{"
                "'columns':[{}");
        for (int i = 0; i < (many ? 4000 : 200); i++) {
            snprintf(part, sizeof part, ",{'domain':'vertex','name':'x','type':'bool',%s}", column);
            put(&w, part);
        }
        put(&w, "]}}}]}]}");
        expect_bomb(&w, many ? HE_LIMIT : HE_OK, many ? "the scene has more than" : "");
    }
    /* many nodes use a primitive with one very long label */
    for (int many = 0; many < 2; many++) {
        put(&w, "{'asset':{'version':'2.0'},'buffers':[{'byteLength':12,'uri':"
                "'data:;base64,AAAAAAAAAAAAAAAA'}],'bufferViews':[{'buffer':0,'byteLength':12}],"
                "'accessors':[{'componentType':5126,'count':1,'type':'VEC3'},"
                "{'bufferView':0,'componentType':5125,'count':1,'type':'SCALAR'}],'meshes':["
                "{'primitives':[{'mode':0,'attributes':{'POSITION':0},'extras':{'hedge':{"
                "'columns':[{'domain':'vertex','name':'x','type':'uint32',");
        put(&w, column);
        put(&w, ",'labels':['");
        for (int i = 0; i < 10000; i++) {
            put(&w, "name name ");
        }
        put(&w, "']}]}}}]}],'nodes':[{}");
        for (int i = 0; i < (many ? 4000 : 200); i++) {
            put(&w, ",{'mesh':0}");
        }
        put(&w, "]}");
        expect_bomb(&w, many ? HE_LIMIT : HE_OK, many ? "the scene has more than" : "");
    }
}

static void limits_of_the_caller(void **state)
{
    (void)state;
    unsigned char bin[SQUARE_BYTES];
    glb_file f;
    glb_square_bin(bin);
    glb_make(&f, "{" DATA "," MESHES "}", bin, sizeof bin);
    const he_limits rows[] = {{.vertices = 3}, {.faces = 1}, {.corners = 5}, {.bytes = 100}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(
            read_pieces(&(format_file){"glb", f.bytes, f.length}, 0, &rows[i], &import, &err),
            HE_LIMIT);
        assert_int_equal(err.place, HE_PLACE_BYTE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(containers),
        cmocka_unit_test(json_to_the_letter),
        cmocka_unit_test(base64_that_ends_too_early),
        cmocka_unit_test(references_and_numbers),
        cmocka_unit_test(numbers_in_the_buffer),
        cmocka_unit_test(bombs),
        cmocka_unit_test(bombs_in_extras),
        cmocka_unit_test(limits_of_the_caller),
    };
    return cmocka_run_group_tests_name("format_glb_refused", tests, NULL, NULL);
}
