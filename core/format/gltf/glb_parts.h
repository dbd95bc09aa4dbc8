/* glb_parts.h - what a GLB of a mesh consists of, known before its first byte: the parts of its one
 * buffer, each a buffer view and an accessor of the same number, and the JSON that names them.
 *
 * Packed, the parts are streams of EXT_meshopt_compression in the file's buffer, and the buffer
 * that the views speak of is its fallback, which has no bytes. */
#ifndef HE_FORMAT_GLTF_GLB_PARTS_H
#define HE_FORMAT_GLTF_GLB_PARTS_H

#include "format/gltf/gltf_attribute.h"
#include "format/gltf/meshopt.h"
#include "format/gltf/glb_groups.h"
#include "format/io/cuts.h"
#include "format/io/splits.h"

typedef enum he_glb_content {
    HE_GLB_POSITIONS, /* three floats a vertex */
    HE_GLB_VALUES,    /* an attribute of vertices or corners in a type of glTF */
    HE_GLB_TRIANGLES,
    HE_GLB_COPIES,  /* of each copy the vertex that it is one of (splits.h) */
    HE_GLB_DEGREES, /* of faces */
    HE_GLB_CORNERS, /* vertices of faces */
    HE_GLB_ORDER,   /* of faces as they are written: the number of each in the order of ids */
    HE_GLB_WORDS    /* an attribute as it is in memory, a bool as a word */
} he_glb_content;

typedef struct he_glb_part {
    he_glb_content content;
    const he_column *column;           /* of values and words */
    char semantic[HE_COLUMN_NAME + 2]; /* of positions and values */
    unsigned type;                     /* the componentType */
    uint32_t components;               /* of an element of the accessor */
    bool normalized;
    he_gltf_role role;          /* of values; HE_GLTF_SEMANTICS without one */
    uint64_t count;             /* elements of the accessor */
    uint32_t stride;            /* bytes from one to the next */
    uint64_t offset;            /* in the buffer, a multiple of 4 */
    uint64_t packed_at, packed; /* of its stream in the file's buffer, bytes of that */
} he_glb_part;

/* {0} is empty. */
typedef struct he_glb_parts {
    const he_mesh *mesh;
    uint32_t *numbers; /* of vertices, NULL where those are their ids */
    he_splits splits;  /* where corners say more than their vertices can */
    he_cuts cuts;
    he_glb_groups groups; /* of faces */
    he_glb_part *parts;
    size_t count, capacity;
    uint64_t bytes; /* of the buffer, a multiple of 4 */
    bool packs;     /* then the streams are here, a multiple of 4 bytes */
    unsigned char *streams;
    size_t streams_length, streams_capacity;
    char *json;
    size_t json_length; /* a multiple of 4 */
} he_glb_parts;

/* All but the JSON, and the streams where it `packs`. `watch` may be NULL. HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_glb_parts_make(const he_mesh *mesh, bool packs, he_watch *watch,
                                         he_notes *notes, he_glb_parts *out, he_error *err);
void he_glb_parts_clear(he_glb_parts *parts);
/* Bytes of a part without what fills it up to a multiple of 4. */
uint64_t he_glb_part_bytes(const he_glb_part *part);

/* How a part is packed. Indices are taken as uint32_t, see he_meshopt_encode. */
he_meshopt_stream he_glb_part_stream(const he_glb_part *part);
/* Pack the next part, whose bytes these are. HE_NO_MEMORY. */
HE_NODISCARD he_status he_glb_pack(he_glb_parts *parts, he_glb_part *part, const void *bytes,
                                   he_error *err);

/* The JSON, where nothing else is missing. HE_NO_MEMORY; HE_LIMIT where the file would have more
 * than its 32 bits can count. */
HE_NODISCARD he_status he_glb_describe(he_glb_parts *parts, he_error *err);
/* Bytes of the BIN chunk. */
uint64_t he_glb_bin_bytes(const he_glb_parts *parts);

#endif
