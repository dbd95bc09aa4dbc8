/* decimation.h - the state of a decimation: decimate.c sets it up and picks edges, decimate_cost.c
 * computes the cost of an edge, decimate_step.c collapses one.
 *
 * COORDINATES inside a decimation are relative to the middle of the mesh, in units of a power of
 * two about half its size, so that no product of them leaves the range of a double.
 *
 * AN EDGE'S COST is outdated as soon as another vertex was merged into one of its ends. Costs
 * hardly ever fall, so an outdated cost is computed again only when its edge comes first in the
 * queue: most edges are deleted before that. With the new cost the edge goes back into the queue,
 * unless that cost is still among the lowest.
 *
 * An edge is ASIDE after its collapse was refused. It is not in the queue, and goes back into it
 * when the faces around one of its ends have changed.
 *
 * An edge is DEAR (too expensive) while the error of its collapse is above the maximum. It is not
 * in the queue, and is tried again when another vertex was merged into one of its ends: an error is
 * a mean, so it may become smaller. */
#ifndef HE_ALGO_DECIMATION_H
#define HE_ALGO_DECIMATION_H

#include "algo/decimate.h"
#include "algo/edge_queue.h"
#include "algo/progressive.h"
#include "algo/quadric.h"
#include "mesh/column.h"
#include "mesh/walk.h"

#include <stdalign.h>

/* Flags of a vertex. HE_NODE_LOCKED and HE_NODE_HELD mark vertices that edge_collapse would refuse
 * to move or to delete; these two flags never change. */
enum {
    HE_NODE_LOCKED = 1, /* the vertex may neither be deleted nor move */
    /* An edge or face at the vertex is locked: the vertex may move, but not be deleted. */
    HE_NODE_HELD = 2,
    HE_NODE_ASIDE = 4, /* some edges of the vertex may be ASIDE (refused, in no queue) */
    HE_NODE_DEAR = 8,  /* some edges of the vertex may be DEAR (too expensive, in no queue) */
    /* The vertex has so many edges that its refused edges are tried again only after several
     * changes, see HE_DECIMATE_PATIENT. */
    HE_NODE_LATE = 16,
    HE_NODE_GREW = 32 /* another vertex was merged into this one while it was HE_NODE_LATE */
};

/* At a vertex of more than HE_DECIMATE_PATIENT edges, refused edges are not tried again after every
 * change of a face around the vertex, but only after so many changes as the vertex has edges,
 * divided by HE_DECIMATE_PART, or when the queue is empty. A single change concerns few of the
 * vertex's edges, but all its refused edges would be tried again. */
enum { HE_DECIMATE_PATIENT = 32, HE_DECIMATE_PART = 2 };

/* Where an edge is stored. */
typedef enum he_edge_place { HE_EDGE_QUEUED, HE_EDGE_ASIDE, HE_EDGE_DEAR } he_edge_place;

enum { HE_CACHE_LINE = 64 };

typedef struct he_node {
    /* The quadric of the vertex (see decimate.h), relative to its position `place`. */
    alignas(HE_CACHE_LINE) he_quadric quadric;
    he_vec3 place;
    uint32_t degree;
    uint32_t features; /* number of feature edges at the vertex; 3 stands for 3 or more */
    /* If the vertex is HE_NODE_LATE: number of changes of faces around it since its refused edges
     * last went back into the queue. */
    uint32_t changes;
} he_node;

/* The elements that collapses merged, as pairs: the deleted element, then the element that
 * stays. */
typedef struct he_merges {
    he_ids vertices, edges;
} he_merges;

typedef struct he_decimation {
    he_mesh *mesh;
    he_node *nodes;      /* one node for each vertex; a node fills two cache lines */
    void *memory;        /* the allocated block of memory that contains `nodes` */
    uint8_t *flags;      /* the HE_NODE_... flags of each vertex */
    uint8_t *places;     /* whether each edge is in the queue, ASIDE or DEAR: an he_edge_place */
    he_edge_queue queue; /* contains no edge twice */
    /* receives the elements that each collapse merges; NULL if they are not needed */
    he_merges *merges;
    he_progressive *log; /* receives a record of each collapse; NULL if none is needed */
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
    /* The work done so far: the number of edges whose cost was computed, plus an eighth of the
     * number of half-edges visited around their ends. One edge takes about as long as eight
     * half-edges; a single collapse at a vertex of large degree may add 256. */
    uint64_t work;
    /* all vertices with the flag HE_NODE_LATE, perhaps also vertices that have lost it */
    he_ids late;
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
/* Decides whether an edge belongs in the queue, ASIDE or DEAR (see the head of decimation.h), and
 * computes the cheapest collapse of the edge unless it is ASIDE. */
he_edge_place he_decimation_judge(const he_decimation *d, he_edge e, he_candidate *what);
/* Puts an edge, which must not be in the queue, into the queue or marks it as ASIDE or DEAR, as
 * `place` says. */
void he_decimation_put(he_decimation *d, he_edge e, he_edge_place place, const he_candidate *what);
/* Puts the refused edges of all vertices with the flag HE_NODE_LATE back into the queue. Returns
 * false if no vertex has the flag. */
bool he_decimation_catch_up(he_decimation *d);
/* Collapses an edge and updates the vertices' quadrics and the queue.
 * Returns HE_LIMIT if a face would flip.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns the error of he_edge_collapse if that refuses. */
HE_NODISCARD he_status he_decimation_collapse(he_decimation *d, const he_candidate *what);

#endif
