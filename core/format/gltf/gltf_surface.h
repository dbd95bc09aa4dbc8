/* gltf_surface.h - adds primitives of glTF meshes to a soup as vertices, faces and attributes. */
#ifndef HE_FORMAT_GLTF_GLTF_SURFACE_H
#define HE_FORMAT_GLTF_GLTF_SURFACE_H

#include "format/gltf/gltf_material.h"
#include "format/io/face_groups.h"

enum { HE_GLTF_ATTRIBUTES = 256 };

/* The transformation of a node, as the first three rows of a 4 x 4 matrix: coordinate i of point p
 * becomes row[i][0] * p.x + row[i][1] * p.y + row[i][2] * p.z + row[i][3]. */
typedef struct he_gltf_frame {
    double row[3][4];
} he_gltf_frame;

extern const he_gltf_frame he_gltf_no_frame; /* the identity, bit by bit */

/* The soup that is filled with primitives, and the state of filling it. {.asset = ..., .names =
 * ...} is empty; the names are borrowed. */
typedef struct he_gltf_surface {
    he_gltf *asset;
    he_labels *names; /* names of the asset's materials, by their index */
    he_face_groups object, material;
    he_ids own_objects, own_materials;  /* ranges of faces whose material names came from extras:
                                         * pairs of a first face and the face after the last */
    uint64_t given[HE_GLTF_ATTRIBUTES]; /* for each column (attribute) of the soup, the number of
                                         * elements whose value is from the file */
    uint64_t mirrored;                  /* number of faces that were reversed */
    bool begun;                         /* the import's he_source_map are initialised */
} he_gltf_surface;

void he_gltf_surface_clear(he_gltf_surface *surface);
/* Adds all primitives of a glTF mesh. `mesh` is its JSON value, `name` the JSON string with the
 * name of the object, or HE_NONE. After a failure the soup contains some of the primitives. */
HE_NODISCARD he_status he_gltf_add_mesh(he_gltf_surface *surface, uint32_t mesh, uint32_t name,
                                        const he_gltf_frame *frame, he_error *err);
/* Adds one primitive of a glTF mesh, with the parameters of he_gltf_add_mesh. */
HE_NODISCARD he_status he_gltf_add_primitive(he_gltf_surface *surface, uint32_t primitive,
                                             uint32_t name, const he_gltf_frame *frame,
                                             he_error *err);
/* Makes the face attributes object and material; must be called after all primitives are added. */
HE_NODISCARD he_status he_gltf_surface_finish(he_gltf_surface *surface, he_error *err);

#endif
