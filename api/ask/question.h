/* question.h - one question about a mesh, asked as a JSON object.
 *
 *     {"relation":"faces","of":{"vertex":5},"cw":false}   what lies beside an element
 *     {"relation":"faces","of":{"vertices":[1,2]}}        beside many, or "all": dense
 *     {"find":"halfedge","vertices":[1,2]}                the half-edge between two vertices
 *     {"get":{"edge":3}}                                  an element
 *     {"walk":"rings","from":{"vertex":5},"depth":2}      a walk: traverse.c
 *     {"measure":"dihedral","of":{"edge":3}}              a length, normal, curvature: measure.c
 *     {"ray":{"origin":[0,0,9],"direction":[0,0,-1]}}     what is hit: spatial.c
 *     {"closest":[0,0,9]}                                 what is near
 *     {"self_intersections":{"limit":100}}                what meets
 *
 * POST .../traverse takes one walk, POST .../query a list of any of them; both come here.
 *
 * COST is counted in steps (base/budget.h), because a question of forty bytes may concern the whole
 * mesh and a request may hold thousands. Walks and relations are charged API_HALFEDGE_STEPS for
 * each half-edge that they look at; searches in space are charged for the boxes, triangles and
 * pairs that they do look at, as they go. On a worker an asker has little to spend; when that is
 * used up the request begins anew on the job pool with API_MAX_STEPS, or what one pass over the
 * mesh takes where that is more. A job has API_JOB_TIMES times as much. What exceeds that is
 * refused (limit_exceeded), unless the client takes a job instead. A question overspends by at most
 * one pass over the mesh; where such passes take longer than the client waits (API_PATIENCE), the
 * request begins anew as a job. */
#ifndef HE_API_ASK_QUESTION_H
#define HE_API_ASK_QUESTION_H

#include "api/request/mesh_access.h"
#include "base/budget.h"
#include "query/adjacency.h"

struct api_tree;

typedef struct api_asker {
    api_exchange *x;
    const he_mesh *mesh;
    uint64_t revision;
    api_out *out;
    api_arena *arena;
    he_budget budget;  /* what may still be spent; it asks the watch of the exchange */
    const char *asked; /* the kind of question at hand, for refusals */
    bool on_worker;    /* what is not left is looked for on the job pool */
    bool reads_only;   /* the body: nothing is looked for or written */
    bool spent;        /* the request begins anew, there or as a job */
    double seconds;    /* beside the budget, estimated: see api_asker_waits */
    bool has_met;      /* the one search for intersections beside the budget is done */
    he_ids first, second;
    struct api_tree *tree; /* once asked for: see tree.h */
} api_asker;

/* Call `answer` with the mesh at hand; it writes onto x->out and answers, or leaves a problem or
 * `spent`: then the request begins anew on the job pool. */
void api_asker_run(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));
/* Before there is a job: call `answer` with an asker that only reads the body (a->reads_only), so
 * that what is wrong with it is said at once. It may look at the mesh for ids. Then api_walk_ask,
 * api_question_dense and api_measure_dense end as soon as the question is read, and give nothing;
 * other questions are not asked. False with the problem filled. */
bool api_asker_read(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));

/* Answer a question of any kind, or a walk only. False with nothing written and the problem filled,
 * or with a->spent. */
bool api_question_ask(api_asker *a, const api_in *question);
bool api_walk_ask(api_asker *a, const api_in *walk);

/* Is this a relation of many elements? Then find its answer; `out` is the caller's to clear. */
bool api_question_is_dense(const api_in *question);
bool api_question_dense(api_asker *a, const api_in *question, he_dense *out);

/* Is this a measure of many elements? Then find its values, `*count` of them; `out` is the caller's
 * to free. What has no value is NaN. */
bool api_measure_is_dense(const api_in *question);
bool api_measure_dense(api_asker *a, const api_in *question, double **out, size_t *count);

/* --- for traverse.c, measure.c and spatial.c --- */
bool api_measure_ask(api_asker *a, const api_in *question);
bool api_ray_ask(api_asker *a, const api_in *question);
bool api_closest_ask(api_asker *a, const api_in *question);
bool api_self_intersections_ask(api_asker *a, const api_in *question);

/* What a question is about: {"vertex":5}, {"vertices":[1,2]}, {"vertices":"all"}. */
typedef struct api_target {
    he_kind kind;
    bool dense;
    uint32_t id;        /* unless dense */
    const uint32_t *of; /* NULL: all */
    size_t count;
} api_target;

bool api_target_is_dense(const api_in *of);
/* Elements that live. */
bool api_asker_target(api_asker *a, const api_in *of, api_target *out);
#define API_KIND_BIT(kind) (1u << (kind))
/* {"vertex":5}, an element that lives and is of one of the kinds in this set of bits. */
bool api_asker_element(api_asker *a, const api_in *in, unsigned kinds, he_kind *kind, uint32_t *id);
/* What is about to be done for all of the mesh takes about these seconds, beside the budget and
 * what was so announced before. False, with a->spent, where the request begins anew as a job; for
 * that the client did not say how long it waits, or less. */
bool api_asker_waits(api_asker *a, double seconds);
/* Half-edges that may still be looked at, and the charge for some that were. */
uint64_t api_asker_left(const api_asker *a);
void api_asker_pay(api_asker *a, uint64_t halfedges);
/* Always false: with a->spent on a worker or where the client takes a job, else limit_exceeded.
 * `in` is NULL where no body asks. */
bool api_asker_exceed(api_asker *a, const api_in *in);
/* Always false: the problem from core, and where it is. */
bool api_asker_refuse(api_asker *a, const api_in *in, const he_error *err);

#endif
