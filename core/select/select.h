/* select.h - the operation `select`: finds elements by a rule, and writes the set of them into an
 * attribute (set_write.h).
 *
 * Every rule finds elements of the kind that the caller asks for:
 *
 *   region       The faces that a chain of faces joins to a seed. Neighbours in the chain share an
 *                edge at which their normals differ by at most `angle`, and which is no feature
 *                edge unless `cross_features` is true. A face without a normal counts as if it had
 *                the normal of a neighbour (smooth_normals.h).
 *   component    The components (topology.h, joined by vertices) of the seeds, which are vertices,
 *                edges or faces. An isolated vertex is a component, too.
 *   box          Vertices from the corner `low` to the corner `high`, both included.
 *   half_space   Vertices on the side of a plane to which its normal points, or in the plane
 *                within its tolerance (plane.h).
 *   lasso        Vertices that a matrix maps into a polygon, its border included (lasso.h).
 *   cone         Elements whose normal makes an angle of at most `angle` with a direction. The
 *                normal of a vertex is the mean of the normals of its faces, weighted by angles;
 *                that of an edge is the mean of those of its two faces.
 *   measure      Elements of which a measure is from `from` to `to`, both included.
 *   attribute    Elements of which a component of an attribute, or of the "position" of vertices,
 *                is from `from` to `to`.
 *   grow         The seeds, and all elements that can be reached from them in `steps` steps. A step
 *                leads from a vertex to the other end of one of its edges, from an edge or face to
 *                one with which it shares a vertex.
 *   shrink       The seeds, without those that can be reached in `steps` steps from an element that
 *                is no seed. The boundary of the mesh shrinks nothing.
 *   boundary     The edges that have a face of a set on exactly one side; without a set, the edges
 *                on the boundary of the mesh.
 *
 * region, component and boundary find edges or faces first. Of faces, the other kinds are all their
 * edges and vertices; of the boundary's edges, the vertices are their ends and the faces those of
 * the set beside them. box, half_space and lasso find vertices first; an edge or face belongs to
 * the set if all its corners, or any of them, do. */
#ifndef HE_SELECT_SELECT_H
#define HE_SELECT_SELECT_H

#include "edit/plane/plane.h"
#include "select/lasso.h"
#include "select/set_write.h"

typedef enum he_select_by {
    HE_BY_REGION,
    HE_BY_COMPONENT,
    HE_BY_BOX,
    HE_BY_HALF_SPACE,
    HE_BY_LASSO,
    HE_BY_CONE,
    HE_BY_MEASURE,
    HE_BY_ATTRIBUTE,
    HE_BY_GROW,
    HE_BY_SHRINK,
    HE_BY_BOUNDARY
} he_select_by;

/* The measures of elements. An element of which a measure is undefined is never selected. */
typedef enum he_select_measure {
    HE_MEASURE_AREA,           /* of faces; of vertices: the mixed area (curvature.h) */
    HE_MEASURE_LENGTH,         /* of edges */
    HE_MEASURE_DIHEDRAL,       /* of edges, see he_edge_dihedral; negative for valleys */
    HE_MEASURE_DEGREE,         /* number of edges of a vertex, number of corners of a face */
    HE_MEASURE_SMALLEST_ANGLE, /* of faces: the smallest of their he_corner_angle */
    HE_MEASURE_ANGLE_DEFECT,   /* of vertices, like the next two, see he_curvature */
    HE_MEASURE_MEAN_CURVATURE,
    HE_MEASURE_GAUSSIAN_CURVATURE
} he_select_measure;

/* A rule. The members that `by` does not need are not read. */
typedef struct he_select_rule {
    he_select_by by;
    he_kind of; /* kind of the elements to find: HE_VERTEX, HE_EDGE or HE_FACE */
    /* The seeds: faces for region; vertices, edges or faces for component; elements of the kind
     * `of` for grow and shrink; faces for boundary, where `seeds` may be NULL. */
    const uint32_t *seeds;
    size_t seed_count;
    he_kind seed_kind;
    double angle; /* for region and cone, in radians, from 0 to pi */
    bool cross_features;
    he_vec3 low, high;
    he_plane plane;
    he_lasso lasso;
    he_corner_rule corners;
    he_vec3 direction;
    he_select_measure measure;
    const char *attribute;
    uint32_t component; /* index of a component of the attribute, from 0 */
    double from, to;    /* may be infinite */
    uint32_t steps;
} he_select_rule;

/* Finds elements by a rule and writes the set. `out` may be NULL.
 *
 * If the selection is refused, nothing changes.
 * Returns HE_BAD_VALUE if there are no seeds, if seeds are of a wrong kind, if `low` exceeds `high`
 * or `from` exceeds `to`, if a direction is zero or a tolerance negative, if a matrix is singular
 * or a polygon has fewer than three corners, if the elements do not have the measure or the
 * attribute has no such component, or if the name is empty, too long or "position". Returns
 * HE_NOT_FINITE if a coordinate, or a number of the matrix, is not finite. Returns HE_LIMIT if the
 * polygon has more than HE_LASSO_CORNERS corners, or if faces have so many corners that measuring
 * curvatures would take too long. Returns HE_NO_SUCH_ATTRIBUTE if there is no attribute to measure
 * or to remove elements from. Returns HE_ATTRIBUTE_CLASH if the attribute to be written has another
 * type. Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if a seed is not live, HE_REPEATED_ELEMENT
 * if it is listed twice. Returns HE_CANCELLED if the work was cancelled. Returns HE_NO_MEMORY if
 * memory is out, HE_IDS_EXHAUSTED if a face has too large an id for measuring curvatures. */
HE_NODISCARD he_status he_select(he_mesh *m, const he_select_rule *rule, const he_set_into *into,
                                 he_set_counts *out, he_error *err);

#endif
