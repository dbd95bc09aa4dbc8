/* question.h - one question about a mesh, asked as a JSON object.
 *
 *     {"relation":"faces","of":{"vertex":5},"cw":false}   neighbours of an element
 *     {"relation":"faces","of":{"vertices":[1,2]}}        of many, or of "all": dense
 *     {"find":"halfedge","vertices":[1,2]}                the half-edge between two vertices
 *     {"get":{"edge":3}}                                  an element
 *     {"walk":"rings","from":{"vertex":5},"depth":2}      a walk: traverse.c
 *     {"measure":"dihedral","of":{"edge":3}}              a length, normal, curvature: measure.c
 *     {"ray":{"origin":[0,0,9],"direction":[0,0,-1]}}     the faces hit: spatial.c
 *     {"closest":[0,0,9]}                                 the nearest point
 *     {"self_intersections":{"limit":100}}                pairs of intersecting faces
 *
 * POST .../traverse takes one walk, POST .../query a list of any questions; both are answered here.
 *
 * COST is counted in steps (base/budget.h), because a question of forty bytes may concern the whole
 * mesh and a request may hold thousands. Walks and relations are charged API_HALFEDGE_STEPS for
 * each half-edge that they visit. Spatial searches are charged for each box, triangle and pair that
 * they visit, as they go. On a worker the budget is small. When it is used up, the request starts
 * again on the job pool with API_MAX_STEPS, or with the steps of one pass over the mesh if those
 * are more. A job has API_JOB_TIMES as many. A request that needs more is refused (limit_exceeded),
 * unless the client accepts a job. A question overspends by at most one pass over the mesh; if such
 * passes take longer than the client waits (API_PATIENCE), the request starts again as a job. */
#ifndef HE_API_ASK_QUESTION_H
#define HE_API_ASK_QUESTION_H

#include "api/request/mesh_access.h"
#include "base/budget.h"
#include "query/adjacency.h"

struct api_bvh;

typedef struct api_asker {
    api_exchange *x;
    const he_mesh *mesh;
    uint64_t revision;
    api_out *out;
    api_arena *arena;
    he_budget budget;  /* steps left; it also polls the progress of the exchange */
    const char *asked; /* name of the current question, for refusals */
    bool on_worker;    /* little budget: a request that needs more moves to the job pool */
    bool reads_only;   /* only reads the body: no search, no output */
    bool spent;        /* budget used up: the request starts again on the pool or as a job */
    double seconds;    /* estimate of work outside the budget: see api_asker_waits */
    bool has_met;      /* the search for intersections that has its own budget is done */
    he_ids first, second;
    struct api_bvh *tree; /* once needed: see bvh_cache.h */
} api_asker;

/* Calls `answer` with the mesh in x->content. It writes to x->out and answers, or leaves a problem
 * or `spent`: then the request starts again on the job pool. */
void api_asker_run(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));
/* Checks the body before a job is made, so that a mistake is reported at once: calls `answer` with
 * an asker that only reads the body (a->reads_only) and may look up ids in the mesh. With it
 * api_walk_ask, api_question_dense and api_measure_dense return as soon as the question is read,
 * without a result; other questions are not evaluated. Returns false with the problem filled. */
bool api_asker_read(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));

/* Answers a question of any kind, or (api_walk_ask) a walk only. Returns false with nothing written
 * and the problem filled, or with a->spent. */
bool api_question_ask(api_asker *a, const api_in *question);
bool api_walk_ask(api_asker *a, const api_in *walk);

/* Returns true if the question is about the relation of many elements. api_question_dense then
 * finds its answer; the caller clears `out`. */
bool api_question_is_dense(const api_in *question);
bool api_question_dense(api_asker *a, const api_in *question, he_dense *out);

/* Returns true if the question is about a measure of many elements. api_measure_dense then finds
 * its values, `*count` of them; the caller frees `out`. A missing value is NaN. */
bool api_measure_is_dense(const api_in *question);
bool api_measure_dense(api_asker *a, const api_in *question, double **out, size_t *count);

/* --- functions that traverse.c, measure.c and spatial.c define for question.c or share --- */
bool api_measure_ask(api_asker *a, const api_in *question);
bool api_ray_ask(api_asker *a, const api_in *question);
bool api_closest_ask(api_asker *a, const api_in *question);
bool api_self_intersections_ask(api_asker *a, const api_in *question);

/* The elements of a question: {"vertex":5}, {"vertices":[1,2]}, {"vertices":"all"}. */
typedef struct api_target {
    he_kind kind;
    bool dense;
    uint32_t id;        /* unless dense */
    const uint32_t *of; /* NULL: all */
    size_t count;
} api_target;

bool api_target_is_dense(const api_in *of);
/* Reads a target whose elements must be live. */
bool api_asker_target(api_asker *a, const api_in *of, api_target *out);
#define API_KIND_BIT(kind) (1u << (kind))
/* Reads {"vertex":5}: a live element of one of the kinds in this bit set. */
bool api_asker_element(api_asker *a, const api_in *in, unsigned kinds, he_kind *kind, uint32_t *id);
/* Announces work on the whole mesh that is not charged to the budget, with its duration. Returns
 * false, with a->spent, if all announced work takes longer than the client is willing to wait; the
 * request then starts again as a job. */
bool api_asker_waits(api_asker *a, double seconds);
/* Returns how many half-edges may still be visited; api_asker_charge charges for visited ones. */
uint64_t api_asker_left(const api_asker *a);
void api_asker_pay(api_asker *a, uint64_t halfedges);
/* Ends a request that needs more steps than it may take, and always returns false: with a->spent on
 * a worker or if the client accepts a job, else with limit_exceeded. `in` is NULL for a request
 * without a body. */
bool api_asker_exceed(api_asker *a, const api_in *in);
/* Fills the problem from a refusal of core, with the JSON pointer of `in`. Always returns false. */
bool api_asker_refuse(api_asker *a, const api_in *in, const he_error *err);

#endif
