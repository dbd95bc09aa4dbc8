/* gltf_file.h - GLB files built from JSON, written with ' for ", and from the bytes of a square:
 *
 *     3---2      byte 0: the corners as floats, 48: triangles 0 1 2, 0 2 3 of 16 bits,
 *     | / |      60: the strip 0 1 3 2 of 8 bits, 64: the fan 0 1 2 3 of 32 bits,
 *     0---1      80: four colours of 3 bytes at a stride of 4 */
#ifndef TESTS_UNIT_GLTF_FILE_H
#define TESTS_UNIT_GLTF_FILE_H

#include "unit/format_fixture.h"

typedef struct glb_file {
    unsigned char bytes[16384];
    size_t length;
    size_t json; /* offset of the JSON text in the file */
    size_t bin;
} glb_file;

/* Appends a word to the file, least significant byte first. */
void glb_word(glb_file *f, uint32_t word);

/* Makes a file of a JSON chunk and a binary chunk; with `bin` NULL there is no binary chunk. */
void glb_make(glb_file *f, const char *json, const void *bin, size_t size);

#define SQUARE_BYTES 96
extern const double glb_square[4][3]; /* the corners of the square */

/* Makes the binary chunk that is drawn above. */
void glb_square_bin(unsigned char bin[SQUARE_BYTES]);

#define ASSET   "'asset':{'version':'2.0'}"
#define BUFFERS "'buffers':[{'byteLength':96}]"
#define VIEWS                                                                                   \
    "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':12}," \
    "{'buffer':0,'byteOffset':60,'byteLength':4},{'buffer':0,'byteOffset':64,'byteLength':16}," \
    "{'buffer':0,'byteOffset':80,'byteLength':16,'byteStride':4}]"
/* the accessors of the square: 0 positions, 1 triangles, 2 strip, 3 fan, 4 colours */
#define ACCESSOR_LIST                                                  \
    "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"   \
    "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}," \
    "{'bufferView':2,'componentType':5121,'count':4,'type':'SCALAR'}," \
    "{'bufferView':3,'componentType':5125,'count':4,'type':'SCALAR'}," \
    "{'bufferView':4,'componentType':5121,'count':4,'type':'VEC3','normalized':true}"
#define ACCESSORS "'accessors':[" ACCESSOR_LIST "]"
#define DATA      ASSET "," BUFFERS "," VIEWS "," ACCESSORS
#define PRIMITIVE "{'attributes':{'POSITION':0},'indices':1}"
#define MESHES    "'meshes':[{'primitives':[" PRIMITIVE "]}]"

/* Reads a file with the chunk of the square, which must succeed. */
he_import glb_square_import(const char *json);

/* Requires that the file is refused with a byte offset, and that the message has these words, which
 * include the path in the JSON. */
void glb_expect_refused(const char *json, he_status wanted, const char *words);

#endif
