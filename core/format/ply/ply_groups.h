/* ply_groups.h - properties of a PLY file that are one attribute together.
 *
 *     nx ny nz                                               normal
 *     red green blue [alpha], r g b [a]                      color
 *     s t, u v, texture_u texture_v, texture_s texture_t     uv, v upward
 *
 * COLOURS are 0 to 1 in a mesh (colors.h). A property of whole numbers has 0 to 255, one of ushort
 * 0 to 65535; one of floats or doubles has what the mesh has. Written they are uchar. */
#ifndef HE_FORMAT_PLY_PLY_GROUPS_H
#define HE_FORMAT_PLY_PLY_GROUPS_H

#include "format/ply/ply_header.h"

/* WHAT CORNERS SAY is written as other programs have it, with vertices that are split
 * (io/splits.h). A comment and a property of vertices tell it to be of corners:
 *
 *     comment hedge corners normal uv        these attributes are of corners
 *     property uint hedge_vertex             of a copy the row of its vertex; of others their own
 *
 * Faces have "texcoord" lists besides, two numbers a corner, for programs that look there. */
#define HE_PLY_CORNERS_MARK "hedge corners"
#define HE_PLY_VERTEX_MARK  "hedge_vertex"
#define HE_PLY_TEXCOORD     "texcoord"

enum { HE_PLY_GROUPS = 7, HE_PLY_GROUP = 4 };

typedef struct he_ply_group {
    const char *attribute;
    uint32_t least, most; /* members */
    bool color;
    bool written; /* of the groups of an attribute it is the one that is written */
    const char *names[HE_PLY_GROUP];
} he_ply_group;

extern const he_ply_group he_ply_groups[HE_PLY_GROUPS];

/* What stands for 1 in a property of a colour; 1 where it is of fractions. */
double he_ply_full_color(he_ply_type type);

#endif
