/* glb_parts.h - the contents of a GLB file, which are computed before its first byte is written:
 * the parts of its one buffer, and the JSON that describes them. Part i has a buffer view and an
 * accessor of number i.
 *
 * If the file is compressed, each part is a stream of EXT_meshopt_compression in the file's buffer,
 * and the views refer to a fallback buffer, which has no bytes. */
#ifndef HE_FORMAT_GLTF_GLB_PARTS_H
#define HE_FORMAT_GLTF_GLB_PARTS_H

#include "format/gltf/gltf_attribute.h"
#include "format/gltf/meshopt.h"
#include "format/gltf/glb_groups.h"
#include "format/io/export_triangles.h"
#include "format/io/splits.h"

typedef enum he_glb_content {
    HE_GLB_POSITIONS, /* three floats a vertex */
    HE_GLB_VALUES,    /* an attribute of vertices or corners in a type of glTF */
    HE_GLB_TRIANGLES,
    HE_GLB_COPIES,  /* number of the vertex that each copy was made from (splits.h) */
    HE_GLB_DEGREES, /* degrees of faces */
    HE_GLB_CORNERS, /* the vertex at each corner of each face */
    HE_GLB_ORDER,   /* for each face that the file has, its number in the order of face ids */
    HE_GLB_WORDS    /* an attribute as it is in memory, but each bool takes 32 bits */
} he_glb_content;

typedef struct he_glb_part {
    he_glb_content content;
    const he_column *column;           /* for values and words */
    char semantic[HE_COLUMN_NAME + 2]; /* name of the part's attribute in glTF, such as "NORMAL"; ""
                                        * if the part has neither positions nor values of an
                                        * attribute */
    unsigned type;                     /* the componentType of the accessor */
    uint32_t components;               /* number of components of each element of the accessor */
    bool normalized;
    /* The glTF attribute to which the values belong; HE_GLTF_SEMANTICS if none. */
    he_gltf_role role;
    uint64_t count;             /* elements of the accessor */
    uint32_t stride;            /* bytes from one element to the next */
    uint64_t offset;            /* offset in the buffer, a multiple of 4 */
    uint64_t packed_at, packed; /* `packed_at` is the offset in the file's buffer of the compressed
                                   part, `packed` is its length */
} he_glb_part;

/* {0} is empty. */
typedef struct he_glb_parts {
    const he_mesh *mesh;
    /* Number that each vertex has in the file; NULL if the numbers are the ids. */
    uint32_t *numbers;
    he_splits splits; /* copies of vertices whose corners have different values */
    he_export_triangles cuts;
    he_glb_groups groups; /* groups of faces */
    he_glb_part *parts;
    size_t count, capacity;
    uint64_t bytes; /* number of bytes of the uncompressed buffer, a multiple of 4 */
    bool packs;     /* true if parts are compressed: `streams` then has the compressed parts, each
                     * padded to a multiple of 4 bytes */
    unsigned char *streams;
    size_t streams_length, streams_capacity;
    char *json;
    size_t json_length; /* a multiple of 4 */
} he_glb_parts;

/* Computes the parts of the file, except the JSON and, if `packs` is set, the compressed streams.
 * `progress` may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_glb_parts_make(const he_mesh *mesh, bool packs, he_progress *progress,
                                         he_warnings *warnings, he_glb_parts *out, he_error *err);
void he_glb_parts_clear(he_glb_parts *parts);
/* Returns the number of bytes of a part, without its padding to a multiple of 4. */
uint64_t he_glb_part_bytes(const he_glb_part *part);

/* Returns the layout of the stream into which a part is compressed. */
he_meshopt_stream he_glb_part_stream(const he_glb_part *part);
/* Compresses a part. `bytes` has the elements of the part; if they are indices of triangles, they
 * must be uint32_t (see he_meshopt_encode). Parts must be compressed in the order of their numbers.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_glb_pack(he_glb_parts *parts, he_glb_part *part, const void *bytes,
                                   he_error *err);

/* Writes the JSON that describes the parts of the file, which must be complete.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_LIMIT if the length of the file does not fit into 32 bits, as a GLB requires. */
HE_NODISCARD he_status he_glb_describe(he_glb_parts *parts, he_error *err);
/* Returns the number of bytes of the BIN chunk. */
uint64_t he_glb_bin_bytes(const he_glb_parts *parts);

#endif
