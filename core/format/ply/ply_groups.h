/* ply_groups.h - groups of properties of a PLY file that together are one attribute.
 *
 *     nx ny nz                                               normal
 *     red green blue [alpha], r g b [a]                      color
 *     s t, u v, texture_u texture_v, texture_s texture_t     uv, v upward
 *
 * COLOURS are 0 to 1 in a mesh (colors.h). A property of whole numbers counts from 0 to 255, one of
 * ushort to 65535; one of floats or doubles has the values of the mesh. Colours are written as
 * uchar. */
#ifndef HE_FORMAT_PLY_PLY_GROUPS_H
#define HE_FORMAT_PLY_PLY_GROUPS_H

#include "format/ply/ply_header.h"

/* ATTRIBUTES OF CORNERS are written as other programs expect, with vertices that are split
 * (io/splits.h). A comment and a property of vertices mark them:
 *
 *     comment hedge corners normal uv        these attributes are of corners
 *     property uint hedge_vertex             row of the vertex copied, or else the vertex's own row
 *
 * Faces also have "texcoord" lists, two numbers a corner, for programs that read such lists. */
#define HE_PLY_CORNERS_MARK "hedge corners"
#define HE_PLY_VERTEX_MARK  "hedge_vertex"
#define HE_PLY_TEXCOORD     "texcoord"

enum { HE_PLY_GROUPS = 7, HE_PLY_GROUP = 4 };

typedef struct he_ply_group {
    const char *attribute;
    uint32_t least, most; /* members */
    bool color;
    /* True if this group is the one that is written, of those that are read as the same
     * attribute. */
    bool written;
    const char *names[HE_PLY_GROUP];
} he_ply_group;

extern const he_ply_group he_ply_groups[HE_PLY_GROUPS];

/* Returns the number that stands for full intensity in a colour property of this type; 1 if the
 * type is float or double. */
double he_ply_full_color(he_ply_type type);

#endif
