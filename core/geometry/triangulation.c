#include "geometry/triangulation.h"

#include "geometry/ears.h"
#include "geometry/sweep.h"
#include "mesh/long_faces.h"

#include <float.h>
#include <string.h>

/* --- work that the triangulations of several loops share --- */

/* Progress is reported each time that this many steps were taken, which takes less than a
 * millisecond. */
enum { STEPS_UNTOLD = 1 << 15 };

/* When searches for edges around vertices have taken this many steps, and as many more as making
 * the index of edges takes, the index is made (edge_lookup.h). */
enum { SEARCHED_AT_LEAST = 4096 };

bool he_diagonal_exists(const he_mesh *m, const he_planar_loop *flat, uint32_t i, uint32_t k,
                        he_triangulation_work *work)
{
    he_vertex a = he_origin(m, (he_halfedge){flat->halfedge[i]});
    he_vertex b = he_origin(m, (he_halfedge){flat->halfedge[k]});
    uint64_t steps = 0;
    bool exists = he_edge_lookup_has(m, work->lookup, a, b, &steps);
    work->steps += steps;
    work->searched += steps;
    return exists;
}

he_status he_triangulation_step(const he_mesh *m, he_triangulation_work *work, he_error *err)
{
    if ((work->lookup == NULL || work->lookup == &work->own) &&
        work->searched - work->sorted > SEARCHED_AT_LEAST + 2 * (uint64_t)m->c.edges.issued) {
        he_edge_lookup_clear(&work->own);
        work->lookup = NULL;
        he_status status = he_edge_lookup_make(m, &work->own, err);
        if (status != HE_OK) {
            return status;
        }
        work->lookup = &work->own;
        work->sorted = work->searched;
    }
    if (work->progress != NULL && work->steps - work->told > STEPS_UNTOLD) {
        work->told = work->steps;
        return he_progress_step(work->progress, work->done, work->of, err);
    }
    return HE_OK;
}

void he_triangulation_work_clear(he_triangulation_work *work)
{
    he_edge_lookup_clear(&work->own);
    *work = (he_triangulation_work){0};
}

he_status he_diagonals_refuse(const he_mesh *m, const he_planar_loop *flat, he_error *err)
{
    uint32_t v = m->c.origin[flat->halfedge[0]];
    return he_fail(err, HE_DOUBLED_EDGE, HE_VERTEX, v,
                   "a diagonal of the loop through vertex %u would join two vertices that an edge "
                   "already joins",
                   v);
}

/* --- exact triangulation by dynamic programming: sub-loops of corners i..k, smallest first --- */

/* The cost of a triangle that does not turn left. It exceeds the cost of all diagonals of a loop
 * together, because there are fewer than HE_EXACT_CORNERS diagonals and none costs more than 1. */
static const double BAD = 4096;

typedef struct table {
    /* cost[i * n + k] and cost[k * n + i], for i < k, both hold the cost of the best triangulation
     * of the sub-loop from corner i to corner k; DBL_MAX if there is none. */
    double *cost;
    /* middle[i * n + k], for i < k, is the third corner of the triangle that has the corners i and
     * k in the best triangulation of the sub-loop */
    uint8_t *middle;
    he_triangulation_work *work;
} table;

static double diagonal_cost(const he_planar_loop *f, uint32_t i, uint32_t k)
{
    double x = f->x[i] - f->x[k], y = f->y[i] - f->y[k];
    return (x * x + y * y) / 12;
}

/* Finds the best triangulation of the sub-loop from corner i to corner k, and returns its cost.
 * `side`, the cost of the diagonal between i and k, is included. */
static double fill_cell(const he_planar_loop *f, uint32_t i, uint32_t k, double side, table *t)
{
    uint32_t n = f->n;
    const double *from_i = t->cost + (size_t)i * n, *to_k = t->cost + (size_t)k * n;
    double best = DBL_MAX;
    for (uint32_t j = i + 1; j < k; j++) {
        double cost = side + from_i[j] + to_k[j];
        /* The cost of most triangles i, j, k is too high even if the triangle turns left; then it
         * is not tested whether the triangle turns left. */
        if (cost < best) {
            cost += he_planar_loop_turns_left(f, i, j, k) ? 0 : BAD;
            if (cost < best) {
                best = cost;
                t->middle[(size_t)i * n + k] = (uint8_t)j;
            }
        }
    }
    return best;
}

static he_status fill_table(const he_mesh *m, const he_planar_loop *f, bool avoid, table *t,
                            he_error *err)
{
    uint32_t n = f->n;
    for (uint32_t i = 0; i + 1 < n; i++) {
        t->cost[i * n + i + 1] = t->cost[(i + 1) * n + i] = 0;
    }
    for (uint32_t span = 2; span < n; span++) {
        he_status status = he_triangulation_step(m, t->work, err);
        if (status != HE_OK) {
            return status;
        }
        for (uint32_t i = 0; i + span < n; i++) {
            uint32_t k = i + span;
            bool free = span == n - 1 || !avoid || !he_diagonal_exists(m, f, i, k, t->work);
            double side = span < n - 1 ? diagonal_cost(f, i, k) : 0;
            double cost = free ? fill_cell(f, i, k, side, t) : DBL_MAX;
            t->cost[i * n + k] = t->cost[k * n + i] = cost;
            t->work->steps += span;
        }
    }
    return HE_OK;
}

/* Writes the triangles of the best triangulation, in such an order that each triangle cuts its
 * middle corner off the rest of the loop. The stack holds sub-loops that are still to be visited.
 * Each sub-loop is visited before the smaller sub-loops that its triangle leaves, and `corners` is
 * filled from its end to its beginning, so the triangles of the smaller sub-loops come first. */
static void read_table(const he_planar_loop *f, const table *t, uint32_t *corners)
{
    uint32_t stack[2 * HE_EXACT_CORNERS], depth = 0, n = f->n, left = n - 2;
    stack[depth++] = 0 * n + (n - 1);
    while (depth > 0) {
        uint32_t at = stack[--depth], i = at / n, k = at % n, j = t->middle[at];
        left--;
        corners[3 * left] = i;
        corners[3 * left + 1] = j;
        corners[3 * left + 2] = k;
        if (j - i > 1) {
            stack[depth++] = i * n + j;
        }
        if (k - j > 1) {
            stack[depth++] = j * n + k;
        }
    }
}

static he_status plan_exact(const he_mesh *m, bool avoid, he_triangulation_work *work,
                            he_triangulation *plan, he_error *err)
{
    const he_planar_loop *f = &plan->flat;
    size_t cells = (size_t)f->n * f->n, whole = f->n - 1;
    he_status status = HE_OK;
    table t = {he_mem_array(NULL, cells, sizeof *t.cost), he_mem_zero(cells, sizeof *t.middle),
               work};
    if (t.cost == NULL || t.middle == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
        goto out;
    }
    status = fill_table(m, f, avoid, &t, err);
    double cost = t.cost[whole];
    if (status == HE_OK && avoid && cost >= BAD) {
        /* The table is filled again without avoiding edges, to find out whether avoiding them
         * caused the flipped triangles. */
        status = fill_table(m, f, false, &t, err);
        if (status == HE_OK && cost >= t.cost[whole] + BAD / 2) {
            status = he_diagonals_refuse(m, f, err);
        }
        if (status == HE_OK) {
            status = fill_table(m, f, true, &t, err);
        }
    }
    if (status != HE_OK) {
        goto out;
    }
    plan->degenerate = cost >= BAD;
    read_table(f, &t, plan->corners);
out:
    he_mem_free(t.cost);
    he_mem_free(t.middle);
    return status;
}

/* --- triangulation of short and of long loops --- */

void he_triangulation_clear(he_triangulation *triangulation)
{
    he_planar_loop_clear(&triangulation->flat);
    he_mem_free(triangulation->corners);
    *triangulation = (he_triangulation){.corners = NULL};
}

/* Returns true if a diagonal of the triangulation joins two vertices that an edge of the mesh
 * joins. */
static bool doubles_edge(const he_mesh *m, const he_triangulation *plan,
                         he_triangulation_work *work)
{
    /* The side from the third to the first corner of a triangle is the diagonal that cuts the
     * triangle off. The last triangle is not cut off, so it is skipped. */
    for (uint32_t k = 0; k + 3 < plan->flat.n; k++) {
        const uint32_t *corners = plan->corners + 3 * (size_t)k;
        if (he_diagonal_exists(m, &plan->flat, corners[0], corners[2], work)) {
            return true;
        }
    }
    return false;
}

/* Triangulates a loop by a sweep line (sweep.h), because ear clipping got stuck. *done becomes
 * false if the sweep line finds no triangulation. */
static he_status plan_sweep(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                            he_triangulation *plan, bool *done, he_error *err)
{
    const he_planar_loop *f = &plan->flat;
    he_status status = he_sweep_cut(f, plan->corners, done, &work->steps, err);
    if (status != HE_OK || !*done) {
        return status;
    }
    if ((flags & HE_AVOID_EDGES) != 0 && doubles_edge(m, plan, work)) {
        return he_diagonals_refuse(m, f, err);
    }
    plan->degenerate = false;
    for (uint32_t k = 0; k + 2 < f->n && !plan->degenerate; k++) {
        const uint32_t *corners = plan->corners + 3 * (size_t)k;
        plan->degenerate = !he_planar_loop_turns_left(f, corners[0], corners[1], corners[2]);
    }
    return HE_OK;
}

static he_status plan_long(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                           he_triangulation *plan, he_error *err)
{
    bool stuck = true;
    he_status status = HE_OK;
    if (!plan->flat.degenerate) {
        status = he_ears_cut(m, flags, work, plan, &stuck, err);
        if (status == HE_OK && stuck) {
            bool done = false;
            status = plan_sweep(m, flags, work, plan, &done, err);
            stuck = !done;
        }
    }
    if (status == HE_OK && stuck) {
        status = he_ears_cut(m, flags | HE_ANY_CORNER, work, plan, &stuck, err);
    }
    return status;
}

static he_status plan_loop(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                           he_triangulation *plan, he_error *err)
{
    if (plan->flat.n > HE_EXACT_CORNERS) {
        return plan_long(m, flags, work, plan, err);
    }
    if (flags & HE_ANY_DIAGONALS) {
        bool stuck = false, flat = plan->flat.degenerate;
        he_status status =
            he_ears_cut(m, flat ? flags | HE_ANY_CORNER : flags, work, plan, &stuck, err);
        bool done = status == HE_OK && !stuck && (!plan->degenerate || flat);
        if (done || (status != HE_OK && status != HE_DOUBLED_EDGE)) {
            return status;
        }
    }
    return plan_exact(m, (flags & HE_AVOID_EDGES) != 0, work, plan, err);
}

/* Takes the triangulation of a loop from the mesh's cache of long faces. Sets *found to true if the
 * cache has the triangulation and, with HE_AVOID_EDGES, none of its diagonals is an edge of the
 * mesh. */
static he_status take_kept(const he_mesh *m, he_halfedge first, unsigned flags,
                           he_triangulation_work *work, he_triangulation *plan, bool *found,
                           he_error *err)
{
    const he_long_face *kept = he_long_faces_find(m, first);
    if (kept == NULL || (flags & HE_ANY_DIAGONALS) == 0) {
        return HE_OK;
    }
    size_t n = kept->n, bytes = 3 * (n - 2) * sizeof *plan->corners;
    plan->flat.n = kept->n;
    plan->flat.memory = he_mem_array(NULL, n, sizeof *plan->flat.halfedge);
    plan->flat.halfedge = plan->flat.memory;
    plan->corners = he_mem_alloc(bytes);
    if (plan->flat.halfedge == NULL || plan->corners == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    }
    for (size_t i = 0; i < n; i++, first = he_next(m, first)) {
        plan->flat.halfedge[i] = first.i;
    }
    memcpy(plan->corners, kept->corners, bytes);
    plan->degenerate = kept->degenerate;
    work->steps += n;
    *found = (flags & HE_AVOID_EDGES) == 0 || !doubles_edge(m, plan, work);
    if (!*found) {
        he_triangulation_clear(plan);
    }
    return he_triangulation_step(m, work, err);
}

static he_status make(const he_mesh *m, he_halfedge first, unsigned flags,
                      he_triangulation_work *work, he_triangulation *plan, he_error *err)
{
    bool found = false;
    he_status status = take_kept(m, first, flags, work, plan, &found, err);
    if (status == HE_OK && !found) {
        status = he_planar_loop_init(&plan->flat, m, first, err);
    }
    if (status != HE_OK || found) {
        return status;
    }
    plan->corners = he_mem_array(NULL, 3 * (size_t)(plan->flat.n - 2), sizeof *plan->corners);
    if (plan->corners == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    }
    return plan_loop(m, flags, work, plan, err);
}

he_status he_triangulation_make(const he_mesh *m, he_halfedge first, unsigned flags,
                                he_triangulation_work *work, he_triangulation *out, he_error *err)
{
    he_triangulation plan = {.degenerate = false};
    he_triangulation_work alone = {0}, *shared = work == NULL ? &alone : work;
    uint64_t before = shared->steps;
    he_status status = make(m, first, flags, shared, &plan, err);
    plan.steps = shared->steps - before;
    he_triangulation_work_clear(&alone);
    if (status != HE_OK) {
        he_triangulation_clear(&plan);
        return status;
    }
    *out = plan;
    return HE_OK;
}
