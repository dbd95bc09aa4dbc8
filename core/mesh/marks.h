/* marks.h - attributes that edits heed.
 *
 * A mark is a bool attribute of one component under one of these names. Under another type or
 * number of components a name means nothing.
 *
 *     feature    on edges: part of a line whose shape is to be kept
 *     locked     on vertices, edges, faces: stays as it is
 *     selected   on anything: a set that requests may name; edits do not heed it
 *
 * LOCKED. Refused with HE_LOCKED_ELEMENT, naming it, is every edit that would take a locked element
 * away, move a locked vertex, give a locked edge another end, or give a locked face another corner
 * or take one from it. A vertex that moves takes its edges and faces along: lock the corners to
 * hold those in place. Cutting is allowed (edge_bisect, edge_split, edge_cut, face_split,
 * face_poke, face_triangulate, plane_split, vertex_split, vertex_split_corners): the element keeps
 * its part, and its mark; the other part has the mark too where the column's rule is copy. A vertex
 * that is made between others (on an edge that is cut, in a face) is no part of any: it has the
 * column's default, under any rule, so a lock never spreads to midpoints. What
 * becomes one with a locked element of its kind leaves no trace in its attributes: they stay.
 *
 * FEATURE. edge_flip of a feature edge is refused with HE_FEATURE_EDGE. A vertex with exactly two
 * feature edges is inside a line, one with another number, other than none, is an end or a corner
 * of lines. edge_collapse is refused, naming an edge, where
 *
 *     F1   the edge is no feature and the origin, which goes, has one;
 *     F2   the edge is a feature and the origin is an end or a corner;
 *     F3   the other side of a triangle beside the edge goes, and is a feature;
 *     F4   the target would move and has a feature edge, unless the edge is one of exactly two.
 *
 * So a line can be thinned out along itself, and what is beside it be drawn onto it. A vertex moves
 * where its position comes out as another one: a point that rounds to where it is moves nothing.
 *
 * delaunay leaves edges alone that edge_flip would refuse. Edits whose whole purpose is to take
 * something away (face_join, face_delete), and welds, do not heed `feature`: of edges that become
 * one, the one that stays says whether it is one. */
#ifndef HE_MESH_MARKS_H
#define HE_MESH_MARKS_H

#include "mesh/layout.h"

/* The columns of a mesh that are marks, NULL where there is none. Valid until a column comes or
 * goes. */
typedef struct he_marks {
    const he_column *feature;
    const he_column *locked[HE_KIND_COUNT]; /* of HE_VERTEX, HE_EDGE, HE_FACE */
} he_marks;

/* Is it a bool column of one component with that name? */
bool he_is_mark(const he_column *column, const char *name);
/* The bool column of one component with that domain and name, NULL when there is none. */
const he_column *he_mark_find(const he_mesh *m, he_kind domain, const char *name);

bool he_marks_search(const he_mesh *m, he_marks *out);
/* False when there are no marks edits heed. Costs one test in a mesh without attributes. */
static inline bool he_marks_find(const he_mesh *m, he_marks *out)
{
    return m->c.column_count > 0 && he_marks_search(m, out);
}

static inline bool he_is_marked(const he_column *mark, uint32_t id)
{
    return mark != NULL && *he_column_value(mark, id) != 0;
}
static inline bool he_is_feature(const he_marks *marks, he_edge e)
{
    return he_is_marked(marks->feature, e.i);
}
static inline bool he_is_locked(const he_marks *marks, he_kind kind, uint32_t id)
{
    return he_is_marked(marks->locked[kind], id);
}
/* HE_LOCKED_ELEMENT for a locked one. An id of HE_NONE is never locked. */
HE_NODISCARD he_status he_require_unlocked(const he_marks *marks, he_kind kind, uint32_t id,
                                           he_error *err);
/* The same of each edge and face about the origin of a half-edge, counter-clockwise from it. */
HE_NODISCARD he_status he_require_unlocked_about(const he_mesh *m, const he_marks *marks,
                                                 he_halfedge first, he_error *err);

#endif
