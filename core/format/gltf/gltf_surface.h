/* gltf_surface.h - adds primitives of glTF meshes to a soup as vertices, faces and attributes. */
#ifndef HE_FORMAT_GLTF_GLTF_SURFACE_H
#define HE_FORMAT_GLTF_GLTF_SURFACE_H

#include "format/gltf/gltf_material.h"
#include "format/io/spans.h"

enum { HE_GLTF_ATTRIBUTES = 256 };

/* The transformation of a node: p becomes (row 0 . p + the last number of row 0, ...). */
typedef struct he_gltf_frame {
    double row[3][4];
} he_gltf_frame;

extern const he_gltf_frame he_gltf_no_frame; /* the identity, bit by bit */

/* {.asset = ..., .names = ...} is empty; names are borrowed. */
typedef struct he_gltf_surface {
    he_gltf *asset;
    he_labels *names; /* names of materials, in their order */
    he_spans object, material;
    he_ids own_objects,
        own_materials; /* pairs of faces from, to, whose names were read from extras */
    uint64_t given[HE_GLTF_ATTRIBUTES]; /* rows with a value, for each column of the soup */
    uint64_t mirrored;                  /* faces that were reversed */
    bool begun;                         /* the distance of places is known */
} he_gltf_surface;

void he_gltf_surface_clear(he_gltf_surface *surface);
/* Adds all primitives of a mesh (a value of the JSON). `name` is the object's, HE_NONE if it has
 * none. After a failure the soup has a part of them. */
HE_NODISCARD he_status he_gltf_add_mesh(he_gltf_surface *surface, uint32_t mesh, uint32_t name,
                                        const he_gltf_frame *frame, he_error *err);
/* Adds one primitive as he_gltf_add_mesh does. */
HE_NODISCARD he_status he_gltf_add_primitive(he_gltf_surface *surface, uint32_t primitive,
                                             uint32_t name, const he_gltf_frame *frame,
                                             he_error *err);
/* Makes the attributes of faces. */
HE_NODISCARD he_status he_gltf_surface_finish(he_gltf_surface *surface, he_error *err);

#endif
