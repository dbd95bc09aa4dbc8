/* decimate.h - fewer triangles, and the shape as it was.
 *
 * Edges are collapsed (edit/local/collapse.h), one of the cheapest each time, by the quadrics of
 * Garland and Heckbert, "Surface simplification using quadric error metrics", 1997. A vertex has a
 * quadric (quadric.h): the sum of the squared distances to the planes of the faces about it, each
 * weighed by the face's area. An edge costs the least value of the sum of its ends' quadrics; there
 * the vertex that stays goes, and it keeps the sum. Where many places are as good as each other, in
 * flat places or along straight edges, that is towards the middle of the edge; an end that is
 * better still is taken as it is.
 *
 * Boundary edges and `feature` edges count as planes too, that hold the edge and stand upright on
 * its faces, each weighed by `boundary_weight` times the square of the edge's length.
 *
 * ERROR of a collapse: the square root of that least value divided by the weight of all planes in
 * it: a distance in the mesh's unit, the root mean square of the distances from the new place to
 * the planes of the original faces that it stands for. It is no bound on the distance of the
 * surfaces. Errors below 1e-12 of the size of the mesh count as 0.
 *
 * ORDER is by the cost times the error, up to a quarter of the product. By the cost alone the
 * largest distance of the surfaces was a tenth larger, and the mean no smaller, where that was
 * measured: on a bumpy torus of a million faces, at a tenth of them.
 *
 * An edge is not collapsed
 *
 *     by what edge_collapse refuses: the link condition, locked elements, F1 to F4 of features;
 *     if a face would turn by more than 60 degrees in this one step, or would have no area but for
 *     rounding (less than 1e-6 of the square of its longest side) where it had one;
 *     if the vertex that would go or move has more than HE_DECIMATE_DEGREE edges;
 *     if its error would be more than `max_error`.
 *
 * It is tried again when the faces about it have changed, and where its error was too large when an
 * end has taken another vertex in, unless that end has more than HE_DECIMATE_DEGREE edges. So no
 * edge is left that could be collapsed within `max_error`, but for those at such an end. Nothing
 * depends on chance or the clock.
 *
 * A face that turns a little in each of many steps is not held against what it was: on rough
 * surfaces some are turned over. Of a grid of 5,000 faces, moved by up to 0.3 of a cell in each
 * direction, up to 5 of the 2,500 that were left looked down.
 *
 * Vertices keep their ids or go, and so do edges and faces: nothing is created. Interpolated
 * attributes of the two vertices mix by where between them the new place lies. */
#ifndef HE_ALGO_DECIMATE_H
#define HE_ALGO_DECIMATE_H

#include "mesh/mesh.h"

enum { HE_DECIMATE_DEGREE = 256 };

/* What boundary_weight is where nobody asks for another. */
#define HE_BOUNDARY_WEIGHT 100.0
/* Costs of more would not fit into the queue. */
#define HE_BOUNDARY_WEIGHT_MAX 1e9

typedef struct he_decimate_options {
    uint32_t faces;         /* stop when there are no more than these */
    double max_error;       /* at least 0; may be infinite */
    double boundary_weight; /* from 0 to HE_BOUNDARY_WEIGHT_MAX */
} he_decimate_options;

typedef enum he_decimate_stop {
    HE_STOP_FACES,     /* there are no more faces than asked for */
    HE_STOP_ERROR,     /* some edge is too dear */
    HE_STOP_EXHAUSTED, /* none can */
    HE_STOP_COUNT
} he_decimate_stop;

/* "faces", "max_error", "exhausted" */
extern const char *const he_decimate_stop_names[HE_STOP_COUNT + 1];

typedef struct he_decimated {
    he_decimate_stop stop;
    double error; /* the largest of a collapse */
} he_decimated;

/* decimate: V - n, and n or 2n faces less (n and 2n of boundary and interior edges), E accordingly.
 *
 * It is done in a copy, and what differs is written word by word, each once. With more than
 * HE_DECIMATE_RECORDED faces to go the copy takes the place of the content instead, recorded as one
 * replace that keeps ids and the old arrays: the sets of changes are empty then. It is a quarter of
 * the memory: words take 264 bytes a face that goes.
 *
 * Refused: HE_NOT_TRIANGLE, naming a face; HE_BAD_VALUE unless the options are
 * as above. HE_NO_MEMORY, HE_CANCELLED. `out` may be NULL. */
enum { HE_DECIMATE_RECORDED = 20000 };
HE_NODISCARD he_status he_decimate(he_mesh *m, const he_decimate_options *options,
                                   he_decimated *out, he_error *err);

#endif
