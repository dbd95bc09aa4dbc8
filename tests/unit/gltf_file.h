/* gltf_file.h - builds GLB files from JSON (in which ' stands for ") and the binary data of a
 * square:
 *
 *     3---2      from byte 0 the corners as floats, from 48 the triangles 0 1 2 and 0 2 3 in
 *     | / |      16 bits per index, from 60 the strip 0 1 3 2 in 8 bits, from 64 the fan 0 1 2 3
 *     0---1      in 32 bits, from 80 four colours of 3 bytes, one in every 4 bytes */
#ifndef TESTS_UNIT_GLTF_FILE_H
#define TESTS_UNIT_GLTF_FILE_H

#include "unit/format_fixture.h"

typedef struct glb_file {
    unsigned char bytes[16384];
    size_t length;
    size_t json; /* offset of the JSON text in bytes[] */
    size_t bin;
} glb_file;

/* Appends a word of 32 bits to the file, least significant byte first. */
void glb_word(glb_file *f, uint32_t word);

/* Makes a GLB file of a JSON chunk and a binary chunk, or without a binary chunk if `bin` is
 * NULL. */
void glb_make(glb_file *f, const char *json, const void *bin, size_t size);

#define SQUARE_BYTES 96
extern const double glb_square[4][3]; /* positions of the corners of the square */

/* Makes the binary data of the square (see the drawing above). */
void glb_square_bin(unsigned char bin[SQUARE_BYTES]);

#define ASSET   "'asset':{'version':'2.0'}"
#define BUFFERS "'buffers':[{'byteLength':96}]"
#define VIEWS                                                                                   \
    "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':12}," \
    "{'buffer':0,'byteOffset':60,'byteLength':4},{'buffer':0,'byteOffset':64,'byteLength':16}," \
    "{'buffer':0,'byteOffset':80,'byteLength':16,'byteStride':4}]"
/* glTF accessors for the binary data of the square: 0 positions, 1 triangles, 2 strip, 3 fan, 4
 * colours */
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

/* Reads a GLB file made of `json` and the binary data of the square; reading must succeed. */
he_import glb_square_import(const char *json);

/* Requires that reading a GLB file of this JSON fails at a byte offset, and that the message
 * contains `words`, which include the path in the JSON. */
void glb_expect_refused(const char *json, he_status wanted, const char *words);

#endif
