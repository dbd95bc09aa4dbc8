/* gltf_attribute.h - the attributes of a primitive as those of vertices.
 *
 *     NORMAL, TANGENT      normal, tangent, turned as their node turns them
 *     TEXCOORD_0, _1 ...   uv, uv1 ...: v runs down in glTF and up in a mesh, so that it is 1 - v
 *     COLOR_0, _1 ...      color, color1 ...: fractions, also where they are normalized integers
 *     JOINTS_0, _1 ...     joints, joints1 ...
 *     WEIGHTS_0, _1 ...    weights, weights1 ...
 *     _ANY                 ANY
 *
 * Floats stay float, normalized integers become it, others are int32 or uint32. Only uv is double:
 * there 1 - v takes nothing from a float, so that it comes back as it was. */
#ifndef HE_FORMAT_GLTF_GLTF_ATTRIBUTE_H
#define HE_FORMAT_GLTF_GLTF_ATTRIBUTE_H

#include "format/gltf/gltf_surface.h"

/* A primitive that is being added. */
typedef struct he_gltf_primitive {
    uint32_t value, attributes; /* in the JSON */
    const he_gltf_frame *frame;
    bool still;  /* the frame leaves all as it is */
    bool mirror; /* it turns surfaces inside out */
    bool indexed;
    uint64_t mode;
    he_gltf_accessor positions, indices;
    uint64_t faces;    /* triangles */
    uint64_t vertices; /* of the soup: the first ones of positions, the others are copies of them */
    he_gltf_accessor copies; /* the vertex that each is a copy of, where there are any */
    bool private;            /* extras fit so far */
    bool exact;              /* what was read from extras comes before attributes */
    bool polygons;           /* and its polygons before the triangles */
    uint32_t first_vertex, first_face, first_corner; /* in the soup */
} he_gltf_primitive;

/* The vertex that an index names, which is below the count of positions. */
static inline uint32_t he_gltf_vertex(const he_gltf_primitive *p, uint32_t index)
{
    return index < p->vertices
               ? index
               : he_gltf_whole(HE_GLTF_UINT32,
                               p->copies.bytes + (index - p->vertices) * p->copies.stride);
}
/* Place of element i in the input; where its bytes are not in the file, that of `value`. */
uint64_t he_gltf_element_place(const he_gltf *asset, const he_gltf_accessor *a, uint32_t value,
                               uint64_t i);
HE_NODISCARD he_status he_gltf_add_attributes(he_gltf_surface *surface, const he_gltf_primitive *p,
                                              he_error *err);
/* Say which vertices were given no value where others were. */
void he_gltf_note_attributes(he_gltf_surface *surface);

he_column *he_gltf_find_column(const he_soup *soup, he_kind domain, const char *name);
/* Rows up to `end` of a column whose first row to be written is `begin`: room for them, and
 * defaults before. HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_gltf_extend(he_gltf_surface *surface, uint32_t value, he_column *column,
                                      size_t end, he_error *err);

typedef enum he_gltf_role {
    HE_GLTF_NORMAL, /* turned by nodes */
    HE_GLTF_TANGENT,
    HE_GLTF_UV,    /* its second component is 1 - v */
    HE_GLTF_COLOR, /* bytes where they say all of it */
    HE_GLTF_JOINTS,
    HE_GLTF_WEIGHTS,
    HE_GLTF_SEMANTICS
} he_gltf_role;

/* What the writer calls an attribute, and the reader takes for it: a row of he_gltf_semantics, at
 * its role. */
typedef struct he_gltf_semantic {
    const char *semantic, *attribute;
    uint32_t least, most; /* components */
    bool numbered;        /* TEXCOORD_1 is uv1 */
    he_gltf_role role;
    he_gltf_role partner; /* the one without which it may not be, itself where there is none */
} he_gltf_semantic;
extern const he_gltf_semantic he_gltf_semantics[HE_GLTF_SEMANTICS];

/* Component i of a value, from a mesh to glTF or back. */
static inline double he_gltf_convert(he_gltf_role role, uint32_t i, double value)
{
    return role == HE_GLTF_UV && i == 1 ? 1 - value : value;
}

#endif
