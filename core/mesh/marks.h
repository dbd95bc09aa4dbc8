/* marks.h - marks, which are the attributes `feature`, `locked` and `selected`. Edits respect the
 * first two.
 *
 * A mark is a bool attribute of one component with one of these names. An attribute of another type
 * or number of components is no mark.
 *
 *     feature    on edges: the edge is part of a feature line, whose shape is preserved
 *     locked     on vertices, edges, faces: the element stays as it is
 *     selected   on anything: a set that requests may name; edits ignore it
 *
 * LOCKED. An edit is refused with HE_LOCKED_ELEMENT, naming the element, if it would delete a
 * locked element, move a locked vertex, give a locked edge another end, or add a corner to a locked
 * face or remove one. Edges and faces move with their vertices: to keep a face in place, the
 * vertices at its corners must be locked. Locked elements may be cut (edge_bisect, edge_split,
 * edge_cut, face_split, face_poke, face_triangulate, plane_split, vertex_split,
 * vertex_split_corners): one part of a cut element keeps the id and the mark; the new part is
 * marked, too, if the column's rule is copy. A new vertex on an edge that is cut, or inside a face,
 * has the column's default value whatever the rule, so a lock never spreads to a new vertex. When
 * two elements of one kind are merged and one of them is locked, the attributes of the locked
 * element stay unchanged.
 *
 * FEATURE. edge_flip of a feature edge is refused with HE_FEATURE_EDGE. A vertex with exactly two
 * feature edges is inside a feature line; a vertex with one, three or more feature edges is an end
 * or a corner of feature lines. edge_collapse, which deletes the origin of the edge, is refused,
 * naming an edge, if
 *
 *     F1   the edge is no feature and the origin has a feature edge;
 *     F2   the edge is a feature and the origin is an end or a corner of feature lines;
 *     F3   a triangle beside the edge would lose a side that is a feature;
 *     F4   the target would move and has a feature edge, unless it has exactly two and the edge is
 *          one of them.
 *
 * So a feature line can be simplified along itself, and vertices beside a feature line can be
 * collapsed onto it. A vertex moves if its position changes: a new point that rounds to the old
 * position is no move.
 *
 * delaunay skips the edges that edge_flip would refuse. Edits that delete elements (face_join,
 * face_delete) and welds ignore `feature`: when two edges are merged, the remaining edge keeps its
 * own mark. */
#ifndef HE_MESH_MARKS_H
#define HE_MESH_MARKS_H

#include "mesh/layout.h"

/* The attribute columns of a mesh that are marks; NULL for each mark that the mesh does not have.
 * The pointers are valid until a column is added or removed. */
typedef struct he_marks {
    const he_column *feature;
    const he_column *locked[HE_KIND_COUNT]; /* indexed by HE_VERTEX, HE_EDGE, HE_FACE */
} he_marks;

/* Returns true if the column is called `name` and is a mark: bool, one component. */
bool he_is_mark(const he_column *column, const char *name);
/* Finds the mark with this domain and name. Returns NULL if the mesh has no such mark. */
const he_column *he_mark_find(const he_mesh *m, he_kind domain, const char *name);

bool he_marks_search(const he_mesh *m, he_marks *out);
/* Finds the marks that edits respect: `feature` and `locked`. Returns false if the mesh has
 * neither; in a mesh without attributes this costs one test. */
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
/* Returns HE_LOCKED_ELEMENT if the element is locked. An id of HE_NONE is never locked. */
HE_NODISCARD he_status he_require_unlocked(const he_marks *marks, he_kind kind, uint32_t id,
                                           he_error *err);
/* Returns HE_LOCKED_ELEMENT if an edge or face around the origin of a half-edge is locked; the
 * search goes counter-clockwise, beginning at the half-edge. */
HE_NODISCARD he_status he_require_unlocked_about(const he_mesh *m, const he_marks *marks,
                                                 he_halfedge first, he_error *err);

#endif
