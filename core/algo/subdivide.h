/* subdivide.h - finer meshes by refinement rules.
 *
 * A step makes a finer mesh of the whole mesh, in the time the finer mesh takes to write:
 *
 *     loop            a triangle becomes 4: three at its corners and the middle one
 *                     Loop, Smooth Subdivision Surfaces Based on Triangles, 1987
 *     catmull_clark   a face of n corners becomes n quads about its mean
 *                     Catmull, Clark, Recursively Generated B-Spline Surfaces on Arbitrary
 *                     Topological Meshes, 1978
 *     linear          triangles become 4, other faces quads, and no vertex moves: the mesh keeps
 *                     its shape
 *     sqrt3           a triangle becomes 3 about a vertex in it, and the old edges are flipped:
 *                     they join it with those of the faces beside, d, e and k
 *                     Kobbelt, Sqrt(3)-Subdivision, 2000
 *
 *         v1                    v1                      v1
 *         o                     o                       o                   d     v1
 *        / \                   / \                     / \                  o-----o
 *       /   \                 /g1 \                   /   \                / \   / \
 *      /     \     --->   m0 o-----o m1   or      m0 o  g1 o m1   or      / f \ /g1 \
 *     /       \             / \g3 / \               / `.o.' \         v0 o-----c-----o e
 *    /         \           / f \ /g2 \             / f  |  g2\            \   / \   /
 *   o-----------o         o-----o-----o           o-----o-----o            \ /g2 \ /
 *   v0          v2        v0    m2    v2          v0    m2    v2            o-----o
 *                                                                           k     v2
 *                             loop                catmull_clark             sqrt3
 *
 * WHO SURVIVES. All old vertices. An edge that is cut in halves keeps its id in the half with the
 * origin of half-edge 2e, which still leaves it; an edge that is flipped keeps its id, and
 * half-edge 2e its face (edge_flip). A face keeps its id in the part at the origin of its stored
 * half-edge. New ids follow the order of the old ones: vertices by edge, then by face; edges:
 * second halves by edge, then those inside, by face and from its stored half-edge on; faces by
 * face, then by corner from the one after the stored half-edge's on, the middle triangle last. Dead
 * ids stay dead.
 *
 * CURVES. A boundary edge, and an edge whose bool attribute `feature` is true, is sharp; so are its
 * parts; what comes to be inside faces is not, in any step of the call, whatever the default of the
 * attribute is. By the number of sharp edges a vertex is smooth (0), a dart (1: smooth rule), on a
 * curve (2) or a corner (3 or more), as in Hoppe et al., Piecewise Smooth Surface Reconstruction,
 * 1994. Where two meet, the curve becomes their cubic B-spline: the middle of an edge, and
 * (1 6 1) / 8 at vertices, as in DeRose, Kass, Truong, Subdivision Surfaces in Character Animation,
 * 1998. Corners stay in place, and so do a boundary vertex with one face, a bow-tie, an isolated
 * vertex and a vertex whose `locked` was true before the call. By sqrt3 sharp edges are not
 * flipped; in every second step of one call they are cut in three, by the B-spline's rules for
 * that, (1 16 10) / 27 and (4 19 4) / 27, and the triangles beside them become three at the two new
 * vertices instead of having one inside.
 *
 * ATTRIBUTES. Of vertices: interpolated columns take the rules positions take, so that a column
 * that is linear in the position remains so; a copy is of the origin of half-edge 2e, of the nearer
 * end, or of the corner of the face's stored half-edge. Of corners: linear within the old face;
 * what is interpolated has the middle of two corners at an edge and the mean inside. Of edges: both
 * parts have the edge's, unless the rule is default; edges inside have the default. Of faces: the
 * parts have the face's, unless the rule is default. Parts of `feature` edges are features under
 * any rule.
 *
 * LOCKED edges and faces are cut, like by other edits: the part that keeps the id is locked. New
 * vertices are not locked, whatever those about them are: see marks.h. */
#ifndef HE_ALGO_SUBDIVIDE_H
#define HE_ALGO_SUBDIVIDE_H

#include "mesh/mesh.h"

typedef enum he_scheme { HE_LOOP, HE_CATMULL_CLARK, HE_LINEAR, HE_SQRT3 } he_scheme;

enum { HE_SUBDIVIDE_STEPS = 12 };
/* Rows of vertices, edges and faces together that a mesh may come to have: some 3 GB of links. */
#define HE_SUBDIVIDE_ROWS (UINT64_C(1) << 27)

/* Live elements after each step. */
typedef struct he_subdivide_counts {
    uint32_t vertices, edges, faces;
} he_subdivide_counts;

/* `steps` of a scheme, 1 to HE_SUBDIVIDE_STEPS, as one replace that keeps ids (write.h). `counts`
 * (which may be NULL) has room for `steps` of them.
 *
 * Refused: HE_LIMIT when there would be more than HE_SUBDIVIDE_ROWS, before memory is taken;
 * HE_NOT_TRIANGLE naming a face, by loop and sqrt3; HE_DOUBLED_EDGE naming an edge of two triangles
 * with the same three corners, by all but catmull_clark; HE_LOCKED_ELEMENT naming an edge that
 * sqrt3 would flip, or a face beside one. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_subdivide(he_mesh *m, he_scheme scheme, unsigned steps,
                                    he_subdivide_counts *counts, he_error *err);

/* HE_LIMIT where the counts of the mesh alone tell that he_subdivide will refuse so, in no time.
 * HE_OK is no promise: linear makes more of polygons, and sqrt3 of sharp edges. */
HE_NODISCARD he_status he_subdivide_fits(const he_mesh *m, he_scheme scheme, unsigned steps,
                                         he_error *err);

#endif
