/* gltf_attribute.h - reads the attributes of a primitive as attributes of vertices.
 *
 *     NORMAL, TANGENT      normal, tangent, transformed by the node
 *     TEXCOORD_0, _1 ...   uv, uv1 ...: v runs down in glTF and up in a mesh, so v is read as 1 - v
 *     COLOR_0, _1 ...      color, color1 ...: fractions, also from normalized integers
 *     JOINTS_0, _1 ...     joints, joints1 ...
 *     WEIGHTS_0, _1 ...    weights, weights1 ...
 *     _ANY                 ANY; the reserved name position becomes position_1
 *
 * Floats stay float, normalized integers become float, and other integers become int32 or uint32.
 * Only uv is double: for a float v, 1 - v is exact in double, so that v is written back as it
 * was. */
#ifndef HE_FORMAT_GLTF_GLTF_ATTRIBUTE_H
#define HE_FORMAT_GLTF_GLTF_ATTRIBUTE_H

#include "format/gltf/gltf_surface.h"

/* A primitive that is being read. */
typedef struct he_gltf_primitive {
    uint32_t value, attributes; /* JSON values of the primitive and of its member attributes */
    const he_gltf_frame *frame;
    bool still; /* the frame is the identity */
    /* True if the matrix `frame` mirrors: it turns right-handed axes into left-handed ones. */
    bool mirror;
    bool indexed;
    uint64_t mode;
    he_gltf_accessor positions, indices;
    uint64_t faces;          /* number of triangles */
    uint64_t vertices;       /* number of vertices that the soup gets, one for each of the first
                                positions; the positions after these belong to copies of vertices */
    he_gltf_accessor copies; /* for each copy of a vertex, the vertex that was copied */
    bool private;            /* true if the extras are valid as far as they were read */
    /* True if attributes were read from extras, which take precedence over those of glTF. */
    bool exact;
    /* True if polygons were read from extras, which replace the triangles. */
    bool polygons;
    uint32_t first_vertex, first_face, first_corner; /* first rows in the soup */
} he_gltf_primitive;

/* Returns the vertex for position `index` of the primitive; for the position of a copy, the
 * vertex that was copied. `index` must be below the number of positions. */
static inline uint32_t he_gltf_vertex(const he_gltf_primitive *p, uint32_t index)
{
    return index < p->vertices
               ? index
               : he_gltf_whole(HE_GLTF_UINT32,
                               p->copies.bytes + (index - p->vertices) * p->copies.stride);
}
/* Returns the offset of element i in the input. If the bytes of the element are not in the input
 * itself, returns the offset of the JSON value `value`. */
uint64_t he_gltf_element_place(const he_gltf *asset, const he_gltf_accessor *a, uint32_t value,
                               uint64_t i);
HE_NODISCARD he_status he_gltf_add_attributes(he_gltf_surface *surface, const he_gltf_primitive *p,
                                              he_error *err);
/* Adds warnings about vertices that have no value of an attribute that other vertices have. */
void he_gltf_note_attributes(he_gltf_surface *surface);

/* Renames an attribute called position, which is the name of the positions of vertices in the API,
 * to position_1, and adds a warning that names the JSON value `value`. */
void he_gltf_rename(he_gltf *asset, char name[HE_COLUMN_NAME], uint32_t value);
he_column *he_gltf_find_column(const he_soup *soup, he_kind domain, const char *name);
/* Extends a column (the array of an attribute's values) to `end` values; new values are the
 * default. Errors name the JSON value `value`.
 * Returns HE_LIMIT if a limit of the soup would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_gltf_extend(he_gltf_surface *surface, uint32_t value, he_column *column,
                                      size_t end, he_error *err);

typedef enum he_gltf_role {
    HE_GLTF_NORMAL, /* a normal; like a tangent, it is transformed by the matrix of the node */
    HE_GLTF_TANGENT,
    HE_GLTF_UV,    /* texture coordinates; the second component v of glTF is 1 - v in a mesh */
    HE_GLTF_COLOR, /* a colour; written as bytes if bytes represent all values exactly */
    HE_GLTF_JOINTS,
    HE_GLTF_WEIGHTS,
    HE_GLTF_SEMANTICS
} he_gltf_role;

/* What glTF calls the semantic of an attribute (such as NORMAL), and how it maps to an attribute of
 * a mesh. Reader and writer share the table he_gltf_semantics, whose index is the role. */
typedef struct he_gltf_semantic {
    const char *semantic, *attribute;
    uint32_t least, most; /* components */
    bool numbered;        /* TEXCOORD_1 is uv1 */
    he_gltf_role role;
    he_gltf_role partner; /* glTF allows the attribute only if the primitive also has one of the
                           * role `partner`; `partner` equals `role` if no other attribute is
                           * needed */
} he_gltf_semantic;
extern const he_gltf_semantic he_gltf_semantics[HE_GLTF_SEMANTICS];

/* Converts component i of an attribute's value from a mesh to glTF or back; the conversion is its
 * own inverse. */
static inline double he_gltf_convert(he_gltf_role role, uint32_t i, double value)
{
    return role == HE_GLTF_UV && i == 1 ? 1 - value : value;
}

#endif
