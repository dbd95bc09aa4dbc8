/* gltf_surface.h - primitives of glTF meshes made vertices, faces and attributes of a soup. */
#ifndef HE_FORMAT_GLTF_GLTF_SURFACE_H
#define HE_FORMAT_GLTF_GLTF_SURFACE_H

#include "format/gltf/gltf_material.h"
#include "format/io/spans.h"

enum { HE_GLTF_ATTRIBUTES = 256 };

/* Where a node puts its mesh: p becomes (row 0 . p + row 0's last, ...). */
typedef struct he_gltf_frame {
    double row[3][4];
} he_gltf_frame;

extern const he_gltf_frame he_gltf_no_frame; /* leaves all as it is, bit by bit */

/* {.asset = ..., .names = ...} is empty; names are borrowed. */
typedef struct he_gltf_surface {
    he_gltf *asset;
    he_labels *names; /* of materials, in their order */
    he_spans object, material;
    he_ids own_objects, own_materials;  /* pairs: faces from, to; read from extras */
    uint64_t given[HE_GLTF_ATTRIBUTES]; /* rows of each column of the soup */
    uint64_t mirrored;                  /* faces that were turned over */
    bool begun;                         /* places have their steps */
} he_gltf_surface;

void he_gltf_surface_clear(he_gltf_surface *surface);
/* Add all primitives of a mesh (a value of the JSON). `name` is the object's, HE_NONE where it has
 * none. A failure leaves the soup with a part. */
HE_NODISCARD he_status he_gltf_add_mesh(he_gltf_surface *surface, uint32_t mesh, uint32_t name,
                                        const he_gltf_frame *frame, he_error *err);
/* Add one primitive likewise. */
HE_NODISCARD he_status he_gltf_add_primitive(he_gltf_surface *surface, uint32_t primitive,
                                             uint32_t name, const he_gltf_frame *frame,
                                             he_error *err);
/* Make the attributes of faces. */
HE_NODISCARD he_status he_gltf_surface_finish(he_gltf_surface *surface, he_error *err);

#endif
