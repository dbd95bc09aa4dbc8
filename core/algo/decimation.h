/* decimation.h - the state of a decimation: decimate.c sets it up and picks edges, decimate_cost.c
 * computes the cost of an edge, decimate_step.c collapses one.
 *
 * COORDINATES inside a decimation are relative to the middle of the mesh, in units of a power of
 * two about half its size, so that no product of them leaves the range of a double.
 *
 * AN EDGE'S COST is outdated as soon as another vertex was merged into one of its ends. Costs
 * hardly ever fall, so it is computed again only when the edge is first in the queue: most edges
 * are deleted before that. The edge then returns to the queue, unless it still is among the first.
 *
 * ASIDE is an edge that was refused. It is in no queue, and returns when the faces around one of
 * its ends have changed.
 *
 * DEAR (too expensive) is an edge with an error above the maximum. It is in no queue either, and is
 * tried again when another vertex was merged into one of its ends: an error is a mean, and may
 * fall. */
#ifndef HE_ALGO_DECIMATION_H
#define HE_ALGO_DECIMATION_H

#include "algo/decimate.h"
#include "algo/edge_queue.h"
#include "algo/progressive.h"
#include "algo/quadric.h"
#include "mesh/column.h"
#include "mesh/walk.h"

#include <stdalign.h>

/* Flags of a vertex. HE_NODE_LOCKED and HE_NODE_HELD never change: edge_collapse would refuse to
 * move or to delete such a vertex. */
enum {
    HE_NODE_LOCKED = 1, /* the vertex may neither be deleted nor move */
    /* An edge or face at the vertex is locked: the vertex may move, but not be deleted. */
    HE_NODE_HELD = 2,
    HE_NODE_ASIDE = 4, /* some edges of the vertex may be ASIDE (refused, in no queue) */
    HE_NODE_DEAR = 8,  /* some edges of the vertex may be DEAR (too expensive, in no queue) */
    /* Refused edges of the vertex return to the queue later, see HE_DECIMATE_PATIENT. */
    HE_NODE_LATE = 16,
    HE_NODE_GREW = 32 /* another vertex was merged into this one while it was HE_NODE_LATE */
};

/* At a vertex of more edges than HE_DECIMATE_PATIENT, refused edges are not tried again after every
 * change nearby, but only after a number of changes that is 1 / HE_DECIMATE_PART of its degree, and
 * when the queue is empty. A single change concerns few of the vertex's edges, but all its refused
 * edges would be tried again. */
enum { HE_DECIMATE_PATIENT = 32, HE_DECIMATE_PART = 2 };

/* Where an edge is stored. */
typedef enum he_edge_place { HE_EDGE_QUEUED, HE_EDGE_ASIDE, HE_EDGE_DEAR } he_edge_place;

enum { HE_CACHE_LINE = 64 };

typedef struct he_node {
    /* Sum of the planes' quadrics, relative to `place`. */
    alignas(HE_CACHE_LINE) he_quadric quadric;
    he_vec3 place;
    uint32_t degree;
    uint32_t features; /* number of feature edges at the vertex; 3 stands for 3 or more */
    /* If HE_NODE_LATE: changes nearby since the vertex's edges returned to the queue. */
    uint32_t changes;
} he_node;

/* The elements that collapses merged, as pairs: the deleted element, then the element that
 * stays. */
typedef struct he_merges {
    he_ids vertices, edges;
} he_merges;

typedef struct he_decimation {
    he_mesh *mesh;
    he_node *nodes;      /* a node for each vertex, which fills two cache lines */
    void *memory;        /* the allocated block of memory that contains `nodes` */
    uint8_t *flags;      /* the HE_NODE_... flags of each vertex */
    uint8_t *places;     /* whether each edge is in the queue, ASIDE or DEAR: an he_edge_place */
    he_edge_queue queue; /* contains no edge twice */
    he_merges *merges;   /* where merges are noted, or NULL */
    he_progressive *log; /* where collapses are recorded, or NULL */
    const he_column *feature;
    /* `most` is the largest allowed error, in the coordinates inside the decimation (see
     * `exponent`) */
    double boundary_weight, most;
    he_vec3 middle;
    /* Coordinates inside the decimation are (coordinates of the mesh - middle) / 2^exponent. */
    int exponent;
    double inward; /* 2^-exponent */
    /* Largest error of a collapse so far, in the coordinates inside the decimation. */
    double error;
    /* The work done so far: the number of edges judged, plus an eighth of the number of half-edges
     * visited around their ends. A unit of either kind takes about the same time, and one collapse
     * at a vertex of large degree may take 256 units. */
    uint64_t work;
    he_ids late; /* vertices that got the flag HE_NODE_LATE, and perhaps still have it */
} he_decimation;

/* A possible collapse of an edge. */
typedef struct he_candidate {
    he_halfedge h; /* the half-edge to collapse; its origin would be deleted */
    /* True: the target of h moves to `place`; false: the target stays where it is. */
    bool moves;
    he_vec3 place; /* where the target of h moves, in the coordinates inside the decimation */
    double cost;   /* value of the sum of both ends' quadrics at `place` */
    /* Error of the collapse (see decimate.h), in the coordinates inside the decimation. */
    double error;
    float priority; /* priority of the edge in the queue */
} he_candidate;

/* The `count` half-edges that leave a vertex (`out`), and their targets, which are the corners of
 * the faces around it. */
typedef struct he_spokes {
    uint32_t count;
    uint32_t out[HE_DECIMATE_DEGREE], target[HE_DECIMATE_DEGREE];
} he_spokes;

static inline bool he_node_is_hub(const he_node *node)
{
    return node->degree > HE_DECIMATE_DEGREE;
}

/* Runs a decimation in the mesh itself, without rolling back if it fails. Records the collapses in
 * `log` unless that is NULL. */
HE_NODISCARD he_status he_decimation_run(he_mesh *m, const he_decimate_options *options,
                                         he_progressive *log, he_decimated *out, he_error *err);

/* The steps of he_decimation_run. Before the first step `d` must have its mesh and options; the
 * caller calls he_decimation_end in any case. */
HE_NODISCARD he_status he_decimation_begin(he_decimation *d, const he_decimate_options *options,
                                           he_error *err);
HE_NODISCARD he_status he_decimation_go(he_decimation *d, uint32_t faces, he_error *err);
void he_decimation_end(he_decimation *d);

he_vec3 he_decimation_inside(const he_decimation *d, he_vec3 outside);
/* Computes the cheapest collapse of an edge. Returns false if neither end may be deleted. */
bool he_decimation_cost(const he_decimation *d, he_edge e, he_candidate *out);
/* Makes mesh `m` equal to `made`, a copy of it that was decimated.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_decimation_write(he_mesh *m, const he_mesh *made, const he_merges *merges,
                                           he_error *err);
/* Decides whether an edge belongs in the queue, ASIDE or DEAR (see the head of decimation.h), and
 * computes the cheapest collapse of the edge unless it is ASIDE. */
he_edge_place he_decimation_judge(const he_decimation *d, he_edge e, he_candidate *what);
/* Records that an edge is in the queue, ASIDE or DEAR, as `place` says. It must not be in the queue
 * already. */
void he_decimation_put(he_decimation *d, he_edge e, he_edge_place place, const he_candidate *what);
/* Returns the edges of vertices that have the flag HE_NODE_LATE to the queue: vertices of many
 * edges that were not tried again after changes. Returns false if there are none. */
bool he_decimation_catch_up(he_decimation *d);
/* Collapses an edge and updates the vertices' quadrics and the queue.
 * Returns HE_LIMIT if a face would flip.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns the error of he_edge_collapse if that refuses. */
HE_NODISCARD he_status he_decimation_collapse(he_decimation *d, const he_candidate *what);

#endif
