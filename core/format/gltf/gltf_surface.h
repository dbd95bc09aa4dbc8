/* gltf_surface.h - adds primitives of glTF meshes to a soup as vertices, faces and attributes. */
#ifndef HE_FORMAT_GLTF_GLTF_SURFACE_H
#define HE_FORMAT_GLTF_GLTF_SURFACE_H

#include "format/gltf/gltf_material.h"
#include "format/io/spans.h"

enum { HE_GLTF_ATTRIBUTES = 256 };

/* The transformation of a node: the first coordinate of point p becomes the product of row 0 with
 * p, plus the last number of row 0, and so on. */
typedef struct he_gltf_frame {
    double row[3][4];
} he_gltf_frame;

extern const he_gltf_frame he_gltf_no_frame; /* the identity, bit by bit */

/* The soup that is filled with primitives, and the state of filling it. {.asset = ..., .names =
 * ...} is empty; the names are borrowed. */
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
/* Adds all primitives of a glTF mesh (a value of the JSON). `name` is the name of the object,
 * HE_NONE if it has none. After a failure the soup contains some of them. */
HE_NODISCARD he_status he_gltf_add_mesh(he_gltf_surface *surface, uint32_t mesh, uint32_t name,
                                        const he_gltf_frame *frame, he_error *err);
/* Adds one primitive of a glTF mesh, with the parameters of he_gltf_add_mesh. */
HE_NODISCARD he_status he_gltf_add_primitive(he_gltf_surface *surface, uint32_t primitive,
                                             uint32_t name, const he_gltf_frame *frame,
                                             he_error *err);
/* Makes the attributes of faces, after all primitives are added. */
HE_NODISCARD he_status he_gltf_surface_finish(he_gltf_surface *surface, he_error *err);

#endif
