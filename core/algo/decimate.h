/* decimate.h - simplifies a mesh by collapsing the edges that change the shape least.
 *
 * The decimation collapses edges one by one (edit/local/collapse.h), each time an edge whose cost
 * is among the lowest. Costs come from the quadrics of Garland and Heckbert, "Surface
 * simplification using quadric error metrics", 1997. A vertex has a quadric (quadric.h): the sum of
 * the squared distances to the planes of the faces about it, each weighed by the face's area. The
 * cost of an edge is the least value that the sum of the quadrics of its two ends has at any point;
 * the vertex that stays moves to that point, and the sum becomes its quadric. If many points are
 * equally good, as in flat regions or along straight edges, a point near the middle of the edge is
 * taken; if the sum is less at the position of one end, the vertex that stays gets that position.
 *
 * Boundary edges and `feature` edges add planes that contain the edge and are perpendicular to its
 * faces, each weighed by `boundary_weight` times the square of the edge's length.
 *
 * The ERROR of a collapse is the square root of that least value divided by the weight of all its
 * planes. It is a distance in the mesh's unit: the root mean square of the distances from the new
 * point to the planes of the original faces that it stands for. It is no bound on the distance of
 * the surfaces. Errors below 1e-12 of the size of the mesh count as 0.
 *
 * ORDER. Edges are collapsed by rising product of cost and error; products that differ by less than
 * a quarter may come in either order. When edges were ordered by cost alone, the largest distance
 * between the surfaces was a tenth larger, and the mean no smaller, measured on a bumpy torus
 * reduced from a million faces to a tenth of them.
 *
 * An edge is not collapsed
 *
 *     if edge_collapse refuses it because of the link condition, locked elements, or the rules F1
 *     to F4 for features (marks.h); if a face would turn by more than 60 degrees in this one step,
 *     or would get an area that is zero but for rounding (less than 1e-6 of the square of its
 *     longest side) although its area was larger before; if the
 * vertex that would be deleted or move has more than HE_DECIMATE_DEGREE edges; if its error would
 * be more than `max_error`.
 *
 * A refused edge is tried again when the faces around it have changed, or, if its error was too
 * large, when another vertex has been merged into an end, unless that end has more than
 * HE_DECIMATE_DEGREE edges. So no edge is left that could be collapsed within `max_error`, except
 * edges with such an end. Nothing depends on chance or the clock.
 *
 * A face may turn a little in each of many steps, which no test limits: on rough surfaces some
 * faces flip. In a horizontal grid of 5,000 faces that face up, with vertices moved by up to 0.3 of
 * a cell in each direction, up to 5 of the 2,500 faces that were left faced down.
 *
 * Each vertex, edge and face keeps its id or is deleted; no element is created. Interpolated
 * attributes of the two vertices are mixed by the position of the new point between them. */
#ifndef HE_ALGO_DECIMATE_H
#define HE_ALGO_DECIMATE_H

#include "mesh/mesh.h"

enum { HE_DECIMATE_DEGREE = 256 };

/* The default weight of boundary and feature edges relative to faces. */
#define HE_BOUNDARY_WEIGHT 100.0
/* The largest allowed weight of boundary edges. With a larger one the costs of edges would not fit
 * into the priority queue. */
#define HE_BOUNDARY_WEIGHT_MAX 1e9

typedef struct he_decimate_options {
    uint32_t faces;   /* the decimation stops when the mesh has at most this many faces */
    double max_error; /* no collapse has a larger error; at least 0; may be infinite */
    /* Weight of boundary and feature edges, from 0 to HE_BOUNDARY_WEIGHT_MAX. */
    double boundary_weight;
} he_decimate_options;

typedef enum he_decimate_stop {
    HE_STOP_FACES,     /* the requested number of faces is reached */
    HE_STOP_ERROR,     /* every collapse left would have an error above `max_error` */
    HE_STOP_EXHAUSTED, /* no edge can be collapsed */
    HE_STOP_COUNT
} he_decimate_stop;

/* The names of the reasons why a decimation stopped: "faces", "max_error", "exhausted". */
extern const char *const he_decimate_stop_names[HE_STOP_COUNT + 1];

typedef struct he_decimated {
    he_decimate_stop stop;
    double error; /* the largest error of a collapse */
} he_decimated;

/* decimate: V - n for n collapses. A collapse deletes one face at a boundary edge, two at an
 * interior edge, and the edges accordingly.
 *
 * A copy of the mesh is decimated, and then each word of the mesh that differs from the copy is
 * written once and recorded for undo. If more than HE_DECIMATE_RECORDED faces would be deleted, the
 * arrays of the copy replace those of the mesh instead. That is recorded as one replacement, which
 * keeps ids and the old arrays; the change then lists no changed elements. A record of each word
 * would take four times as much memory: 264 bytes for each deleted face.
 *
 * `out` may be NULL.
 * Returns HE_NOT_TRIANGLE naming a face, if one is no triangle.
 * Returns HE_BAD_VALUE if an option is outside its range, which struct he_decimate_options states.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
enum { HE_DECIMATE_RECORDED = 20000 };
HE_NODISCARD he_status he_decimate(he_mesh *m, const he_decimate_options *options,
                                   he_decimated *out, he_error *err);

#endif
