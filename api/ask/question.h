/* question.h - answers questions about a mesh; each question is a JSON object.
 *
 *     {"relation":"faces","of":{"vertex":5},"cw":false}   neighbours of an element
 *     {"relation":"faces","of":{"vertices":[1,2]}}        neighbours of many elements
 *     {"find":"halfedge","vertices":[1,2]}                the half-edge between two vertices
 *     {"get":{"edge":3}}                                  an element
 *     {"walk":"rings","from":{"vertex":5},"depth":2}      a walk: traverse.c
 *     {"measure":"dihedral","of":{"edge":3}}              a length, normal, curvature: measure.c
 *     {"ray":{"origin":[0,0,9],"direction":[0,0,-1]}}     the faces hit: spatial.c
 *     {"closest":[0,0,9]}                                 the nearest point
 *     {"self_intersections":{"limit":100}}                pairs of intersecting faces
 *
 * POST .../traverse takes one walk, POST .../query a list of any questions. A question about many
 * elements, or about "all", is called dense.
 *
 * COST is counted in steps (base/budget.h), because a question of forty bytes may concern the whole
 * mesh and a request may hold thousands. Walks and relations are charged API_HALFEDGE_STEPS for
 * each half-edge that they visit. Spatial searches are charged for each box, triangle and pair that
 * they visit, while they run. On a worker thread the budget is small. When it is used up, the
 * request starts again on the job pool with API_MAX_STEPS, or with the steps of one pass over the
 * mesh if those are more. A job has API_JOB_TIMES as many steps. A request that needs more is
 * refused (limit_exceeded), unless the client accepts a job. A question may take more steps than
 * are left, by at most one pass over the mesh. If such passes take longer than the client will wait
 * (API_PATIENCE), the request starts again as a job. */
#ifndef HE_API_ASK_QUESTION_H
#define HE_API_ASK_QUESTION_H

#include "api/request/mesh_access.h"
#include "base/budget.h"
#include "query/adjacency.h"

struct api_bvh;

/* The state of answering the questions of one request. */
typedef struct api_asker {
    api_exchange *x;
    const he_mesh *mesh;
    uint64_t revision;
    api_out *out;
    api_arena *arena;
    /* the computing steps that are left; charging steps also polls the progress of the exchange */
    he_budget budget;
    const char *asked; /* name of the current question, for the message of a refusal */
    /* True if the request runs on a worker thread, which must not compute for long: the budget is
     * small, and a request that needs more steps starts again on the job pool. */
    bool on_worker;
    bool reads_only; /* true if the body is only checked: nothing is searched or written */
    /* True if the budget is used up: the request starts again on the job pool or as a job. */
    bool spent;
    double seconds; /* estimated duration of the work announced by api_asker_waits, in seconds */
    /* True after the first search for intersecting faces. That search gets additional steps
     * (API_MEET_STEPS); further searches of the request get none. */
    bool has_met;
    he_ids first, second;
    struct api_bvh *tree; /* the tree of boxes (bvh_cache.h); NULL until a question needs it */
} api_asker;

/* Calls the function `answer`, which finds the mesh in x->content of the exchange. `answer` has
 * three outcomes: it writes to x->out and answers the request; or it fills the problem; or it sets
 * the member `spent` of the asker, and the request starts again on another thread. */
void api_asker_run(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));
/* Checks the body before a job is made, so that a mistake is reported at once: calls the function
 * `answer` with an asker that only reads the body (`reads_only` is set) and may look up ids in the
 * mesh. With such an asker, api_walk_ask, api_question_dense and api_measure_dense return, without
 * a result, as soon as the question is read. Questions of other kinds are not read. Returns false
 * with the problem filled. */
bool api_asker_read(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a));

/* api_question_ask answers a question of any kind, api_walk_ask only a walk. On failure both write
 * nothing and return false, with the problem filled or with a->spent set (`a` is the asker). */
bool api_question_ask(api_asker *a, const api_in *question);
bool api_walk_ask(api_asker *a, const api_in *walk);

/* The elements of an answer about "all" elements, in the order of ids: the answer names them,
 * because the question does not. {0} names none. */
typedef struct api_named {
    bool all; /* false: the question has a list of elements, and `ids` is empty */
    he_ids ids;
} api_named;

/* api_question_is_dense returns true if the question is about the neighbours of many elements. Then
 * api_question_dense finds the answer and puts it into `out` and `named`, which the caller clears,
 * also after a failure. */
bool api_question_is_dense(const api_in *question);
bool api_question_dense(api_asker *a, const api_in *question, he_dense *out, api_named *named);

/* The values of a measure of many elements, which the caller clears. A missing value is NaN. */
typedef struct api_measured {
    double *values;
    size_t count; /* number of values: three for an element whose measure is a vector */
    api_named named;
} api_measured;
/* api_measure_is_dense returns true if the question is about a measure of many elements. Then
 * api_measure_dense finds the values. */
bool api_measure_is_dense(const api_in *question);
bool api_measure_dense(api_asker *a, const api_in *question, api_measured *out);
void api_measured_clear(api_measured *measured);

/* --- functions that only the files in api/ask call --- */
bool api_measure_ask(api_asker *a, const api_in *question);
bool api_ray_ask(api_asker *a, const api_in *question);
bool api_closest_ask(api_asker *a, const api_in *question);
bool api_self_intersections_ask(api_asker *a, const api_in *question);

/* The elements that a question is about, as in {"vertex":5}, {"vertices":[1,2]},
 * {"vertices":"all"}. */
typedef struct api_target {
    he_kind kind;
    bool dense;
    uint32_t id; /* the element, if `dense` is false */
    /* ids of the elements if `dense` is true; NULL stands for all elements of this kind */
    const uint32_t *of;
    size_t count;
} api_target;

bool api_target_is_dense(const api_in *of);
/* Lists the elements if the question is about all of them. Returns false with the problem filled
 * when memory is out. */
bool api_asker_name(api_asker *a, const api_in *question, const api_target *of, api_named *out);
/* Reads which elements a question is about; they must be live. */
bool api_asker_target(api_asker *a, const api_in *of, api_target *out);
#define API_KIND_BIT(kind) (1u << (kind))
/* Reads {"vertex":5}, which must be a live element of one of the kinds in the bit set `kinds`. */
bool api_asker_element(api_asker *a, const api_in *in, unsigned kinds, he_kind *kind, uint32_t *id);
/* Announces that the asker will do work on the whole mesh, which takes about `seconds`. Returns
 * false, with a->spent set, if all work announced by this request takes longer than the client will
 * wait; the request then starts again as a job. */
bool api_asker_waits(api_asker *a, double seconds);
/* Returns how many half-edges may still be visited with the steps that are left. api_asker_pay
 * subtracts the steps for visited half-edges from the budget. */
uint64_t api_asker_left(const api_asker *a);
void api_asker_pay(api_asker *a, uint64_t halfedges);
/* Ends a request that needs more steps than are left. Sets a->spent on a worker thread or if the
 * client accepts a job; else fills the problem with limit_exceeded. Always returns false. `in` is
 * NULL for a request without a body. */
bool api_asker_exceed(api_asker *a, const api_in *in);
/* Fills the problem from a refusal of core, with the JSON pointer of `in`. Always returns false. */
bool api_asker_refuse(api_asker *a, const api_in *in, const he_error *err);

#endif
