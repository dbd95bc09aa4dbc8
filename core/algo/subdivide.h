/* subdivide.h - finer meshes by refinement rules.
 *
 * A step refines the whole mesh, in time linear in the finer mesh:
 *
 *     loop            a triangle becomes 4: three at its corners and the middle one
 *                     Loop, Smooth Subdivision Surfaces Based on Triangles, 1987
 *     catmull_clark   a face of n corners becomes n quads about its mean
 *                     Catmull, Clark, Recursively Generated B-Spline Surfaces on Arbitrary
 *                     Topological Meshes, 1978
 *     linear          triangles become 4, other faces quads, and no vertex moves: the mesh keeps
 *                     its shape
 *     sqrt3           a triangle becomes 3 around a new vertex c in it, and the old edges are
 *                     flipped: they join c with the new vertices x, y and z in the adjacent faces
 *                     Kobbelt, Sqrt(3)-Subdivision, 2000
 *
 *         v1                    v1                      v1
 *         o                     o                       o                   x     v1
 *        / \                   / \                     / \                  o-----o
 *       /   \                 /g1 \                   /   \                / \   / \
 *      /     \     --->   m0 o-----o m1   or      m0 o  g1 o m1   or      / f \ /g1 \
 *     /       \             / \g3 / \               / `.o.' \         v0 o-----c-----o y
 *    /         \           / f \ /g2 \             / f  |  g2\            \   / \   /
 *   o-----------o         o-----o-----o           o-----o-----o            \ /g2 \ /
 *   v0          v2        v0    m2    v2          v0    m2    v2            o-----o
 *                                                                           z     v2
 *                             loop                catmull_clark             sqrt3
 *
 * WHO SURVIVES. All old vertices. An edge that is cut in halves keeps its id in the half with the
 * origin of half-edge 2e, which still leaves it; an edge that is flipped keeps its id, and
 * half-edge 2e its face (edge_flip). A face keeps its id in the part at the origin of its stored
 * half-edge. New ids follow the order of the old elements. Vertices: first one for each edge, then
 * one for each face. Edges: first the second halves of the old edges, then the edges inside faces,
 * face by face, from the stored half-edge of the face on. Faces: face by face, and within a face by
 * corner, from the corner after that of the stored half-edge on, the middle triangle last. Ids of
 * deleted elements stay unused.
 *
 * CURVES. An edge is sharp if it is on the boundary or its bool attribute `feature` is true, and
 * the parts of a sharp edge are sharp. Edges that are made inside faces are never sharp, whatever
 * the default of the attribute is. By the number of sharp edges a vertex is smooth (0), a dart (1:
 * smooth rule), on a curve (2) or a corner (3 or more), as in Hoppe et al., Piecewise Smooth
 * Surface Reconstruction, 1994. At a vertex of two sharp edges the curve becomes their cubic
 * B-spline: the middle of an edge, and (1 6 1) / 8 at vertices, as in DeRose, Kass, Truong,
 * Subdivision Surfaces in Character Animation, 1998. Vertices of 3 or more sharp edges stay in
 * place, and so do a boundary vertex with one face, a bow-tie, an isolated vertex and a vertex
 * whose `locked` was true before the call. The scheme sqrt3 does not flip sharp edges; in every
 * second step of one call it cuts them in three, by the B-spline's rules for that, (1 16 10) / 27
 * and (4 19 4) / 27; a triangle beside such an edge is divided into three at the two new vertices
 * on the edge, and gets no new vertex inside.
 *
 * ATTRIBUTES. Vertices: interpolated columns follow the rules of positions, so that a column that
 * is linear in the position remains so; in copied columns a new vertex gets the value of the origin
 * of half-edge 2e, of the nearer end of an edge that is cut in three, or of the corner of the
 * face's stored half-edge. Corners: linear within the old face; interpolated columns have the mean
 * of two corners on an edge, and the mean of all corners inside the face. Edges: both parts have
 * the edge's value, unless the attribute's rule is `default`; edges inside faces have the default
 * value. Faces: the parts have the face's value, unless the attribute's rule is `default`. Parts of
 * `feature` edges are features under any rule.
 *
 * LOCKED edges and faces are cut all the same, as by other edits; only the part that keeps the id
 * is locked afterwards. New vertices are never locked, even between locked ones: see marks.h. */
#ifndef HE_ALGO_SUBDIVIDE_H
#define HE_ALGO_SUBDIVIDE_H

#include "mesh/mesh.h"

typedef enum he_scheme { HE_LOOP, HE_CATMULL_CLARK, HE_LINEAR, HE_SQRT3 } he_scheme;

enum { HE_SUBDIVIDE_STEPS = 12 };
/* The largest number of vertices, edges and faces together that a refined mesh may have. Their
 * links take about 3 GB. */
#define HE_SUBDIVIDE_ROWS (UINT64_C(1) << 27)

/* The numbers of live elements after each step of a subdivision. */
typedef struct he_subdivide_counts {
    uint32_t vertices, edges, faces;
} he_subdivide_counts;

/* Refines the mesh by `steps` steps of a scheme, 1 to HE_SUBDIVIDE_STEPS. The whole is recorded as
 * one replacement that keeps ids (write.h). `counts`, which may be NULL, must have `steps` entries;
 * each gets the counts after one step.
 *
 * Returns HE_LIMIT if there would be more than HE_SUBDIVIDE_ROWS, before memory is allocated.
 * Returns HE_NOT_TRIANGLE naming a face, if loop or sqrt3 meets one that is no triangle.
 * Returns HE_DOUBLED_EDGE naming an edge, if it has two triangles with the same three corners and
 * the scheme is not catmull_clark.
 * Returns HE_LOCKED_ELEMENT, naming an element, if an edge that sqrt3 would flip, or a face beside
 * one, is locked.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_subdivide(he_mesh *m, he_scheme scheme, unsigned steps,
                                    he_subdivide_counts *counts, he_error *err);

/* Decides from the mesh's counts alone, in constant time, whether he_subdivide will certainly
 * refuse because of its limit. If it returns HE_OK, he_subdivide may still refuse, because this
 * function assumes fewer new elements than `linear` makes in faces that are no triangles, and than
 * `sqrt3` makes at sharp edges.
 * Returns HE_LIMIT if it will certainly refuse. */
HE_NODISCARD he_status he_subdivide_fits(const he_mesh *m, he_scheme scheme, unsigned steps,
                                         he_error *err);

#endif
