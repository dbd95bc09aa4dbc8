/* decimation.h - the state of a decimation, shared by its parts: decimate.c sets it up and picks
 * edges, decimate_cost.c says what an edge costs, decimate_step.c collapses one.
 *
 * COORDINATES inside are relative to the middle of the mesh, in units of a power of two about half
 * its size, so that no product of them leaves the range of a double.
 *
 * AN EDGE'S COST is out of date as soon as one of its ends has taken another vertex in. Costs
 * hardly ever fall, so it is found again only when the edge comes first: most edges go before that.
 * It then waits for its turn again, unless it still is among the first.
 *
 * ASIDE is an edge that was refused. It is in no queue, and goes back when the faces about one of
 * its ends have changed.
 *
 * DEAR is one with an error above the most there may be. It is in no queue either, and is looked at
 * again when one of its ends has taken another vertex in: an error is a mean, and may fall. */
#ifndef HE_ALGO_DECIMATION_H
#define HE_ALGO_DECIMATION_H

#include "algo/decimate.h"
#include "algo/edge_queue.h"
#include "algo/progressive.h"
#include "algo/quadric.h"
#include "mesh/column.h"
#include "mesh/walk.h"

#include <stdalign.h>

/* Flags of a vertex. They hold throughout: edges and vertices that edge_collapse would have to
 * refuse for them stay. */
enum {
    HE_NODE_LOCKED = 1, /* stays where it is */
    HE_NODE_HELD = 2,   /* an edge or face about it is locked: it stays, but may move */
    HE_NODE_ASIDE = 4,  /* some edge of it may be aside */
    HE_NODE_DEAR = 8,   /* some edge of it may be too dear */
    HE_NODE_LATE = 16,  /* edges of it are to go back later, see HE_DECIMATE_PATIENT */
    HE_NODE_GREW = 32   /* it has taken a vertex in meanwhile */
};

/* A vertex of more edges brings them back only after as many changes about it as half of them, and
 * when the queue is empty: a change concerns few of them, and all would be tried for each. */
enum { HE_DECIMATE_PATIENT = 32, HE_DECIMATE_PART = 2 };

/* Where an edge is. */
typedef enum he_edge_place { HE_EDGE_QUEUED, HE_EDGE_ASIDE, HE_EDGE_DEAR } he_edge_place;

enum { HE_CACHE_LINE = 64 };

typedef struct he_node {
    alignas(HE_CACHE_LINE) he_quadric quadric; /* about `place` */
    he_vec3 place;
    uint32_t degree;
    uint32_t features; /* feature edges at it; 3 stands for more */
    uint32_t changes;  /* since its edges were brought back, if HE_NODE_LATE */
} he_node;

/* What became part of what, in pairs of the one gone and the one that stays. */
typedef struct he_merges {
    he_ids vertices, edges;
} he_merges;

typedef struct he_decimation {
    he_mesh *mesh;
    he_node *nodes;      /* by vertex; each lies in two cache lines */
    void *memory;        /* of the nodes */
    uint8_t *flags;      /* by vertex: HE_NODE_... */
    uint8_t *places;     /* by edge: an he_edge_place */
    he_edge_queue queue; /* no edge twice */
    he_merges *merges;   /* noted there, or NULL */
    he_progressive *log; /* where collapses are remembered, or NULL */
    const he_column *feature;
    double boundary_weight, most; /* the largest error, inside */
    he_vec3 middle;
    int exponent;  /* inside = (outside - middle) / 2^exponent */
    double inward; /* 2^-exponent */
    double error;  /* the largest so far, inside */
    /* What was done: edges judged, and every eighth half-edge looked at about their ends. Both take
     * about as long, and there may be 256 of them for each collapse at a hub. */
    uint64_t work;
    he_ids late; /* vertices that were HE_NODE_LATE and perhaps are */
} he_decimation;

/* What to do with an edge. */
typedef struct he_candidate {
    he_halfedge h;  /* its origin goes */
    bool moves;     /* the target goes to `place`, else it stays there */
    he_vec3 place;  /* inside */
    double cost;    /* of the quadrics */
    double error;   /* as in decimate.h, inside */
    float priority; /* in the queue */
} he_candidate;

/* Faces about vertices: `count` of `vertices`, the targets of the half-edges `out`. */
typedef struct he_spokes {
    uint32_t count;
    uint32_t out[HE_DECIMATE_DEGREE], target[HE_DECIMATE_DEGREE];
} he_spokes;

static inline bool he_node_is_hub(const he_node *node)
{
    return node->degree > HE_DECIMATE_DEGREE;
}

/* he_decimate in place, without rolling back, remembering collapses in `log` unless it is NULL. */
HE_NODISCARD he_status he_decimation_run(he_mesh *m, const he_decimate_options *options,
                                         he_progressive *log, he_decimated *out, he_error *err);

/* The parts of it: `d` has its mesh, and what is to be kept, and he_decimation_end is called in any
 * case. */
HE_NODISCARD he_status he_decimation_begin(he_decimation *d, const he_decimate_options *options,
                                           he_error *err);
HE_NODISCARD he_status he_decimation_go(he_decimation *d, uint32_t faces, he_error *err);
void he_decimation_end(he_decimation *d);

he_vec3 he_decimation_inside(const he_decimation *d, he_vec3 outside);
/* False where no end may go. */
bool he_decimation_cost(const he_decimation *d, he_edge e, he_candidate *out);
/* Make `m` equal to a copy that was decimated. HE_NO_MEMORY. */
HE_NODISCARD he_status he_decimation_write(he_mesh *m, const he_mesh *made, const he_merges *merges,
                                           he_error *err);
/* Where an edge belongs, with what to do with it unless that is aside. */
he_edge_place he_decimation_judge(const he_decimation *d, he_edge e, he_candidate *what);
/* Put one there that is not in the queue. */
void he_decimation_put(he_decimation *d, he_edge e, he_edge_place place, const he_candidate *what);
/* Bring back the edges of vertices that are late. False where there are none. */
bool he_decimation_catch_up(he_decimation *d);
/* Collapse it, keep nodes and queue right. Any refusal of he_edge_collapse, HE_LIMIT where a face
 * would turn over; HE_NO_MEMORY. */
HE_NODISCARD he_status he_decimation_collapse(he_decimation *d, const he_candidate *what);

#endif
