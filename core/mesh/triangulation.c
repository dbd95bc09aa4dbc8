#include "mesh/triangulation.h"

#include <float.h>

/* Adds the steps of the search: where very many edges meet it may be long. */
static bool is_joined(const he_mesh *m, const he_flat *flat, uint32_t i, uint32_t k,
                      he_triangulation_work *work)
{
    he_vertex a = he_origin(m, (he_halfedge){flat->halfedge[i]});
    he_vertex b = he_origin(m, (he_halfedge){flat->halfedge[k]});
    return he_joined(m, work->joins, a, b, &work->steps);
}

static he_status refuse_work(const he_flat *flat, he_error *err)
{
    return he_fail_plain(err, HE_LIMIT, "a loop of %u corners takes more than %llu steps", flat->n,
                         (unsigned long long)HE_TRIANGULATION_STEPS);
}

static he_status refuse_doubled(const he_mesh *m, const he_flat *flat, he_error *err)
{
    uint32_t v = m->c.origin[flat->halfedge[0]];
    return he_fail(err, HE_DOUBLED_EDGE, HE_VERTEX, v,
                   "diagonals of the loop at vertex %u would double edges that are there", v);
}

/* --- exact: all sub-loops i..k of corners, smallest first --- */

/* A triangle that does not turn left outweighs all diagonals of a loop, each of which costs at most
 * one: its squared length over the largest there can be in the frame of flat.h. */
static const double BAD = 4096;

typedef struct table {
    double *cost;    /* of the best triangulation of sub-loop i..k, under i, k and under k, i;
                        DBL_MAX when there is none */
    uint8_t *middle; /* its triangle on the side i, k */
    he_triangulation_work *work;
} table;

static double diagonal_cost(const he_flat *f, uint32_t i, uint32_t k)
{
    double x = f->x[i] - f->x[k], y = f->y[i] - f->y[k];
    return (x * x + y * y) / 12;
}

/* What the sub-loop i..k costs, `side` with it. */
static double fill_cell(const he_flat *f, uint32_t i, uint32_t k, double side, table *t)
{
    uint32_t n = f->n;
    const double *from_i = t->cost + (size_t)i * n, *to_k = t->cost + (size_t)k * n;
    double best = DBL_MAX;
    for (uint32_t j = i + 1; j < k; j++) {
        double cost = side + from_i[j] + to_k[j];
        /* Most are no better even if they turn left: do not look. */
        if (cost < best) {
            cost += he_flat_turns_left(f, i, j, k) ? 0 : BAD;
            if (cost < best) {
                best = cost;
                t->middle[(size_t)i * n + k] = (uint8_t)j;
            }
        }
    }
    return best;
}

static he_status fill_table(const he_mesh *m, const he_flat *f, bool avoid, table *t, he_error *err)
{
    uint32_t n = f->n;
    for (uint32_t i = 0; i + 1 < n; i++) {
        t->cost[i * n + i + 1] = t->cost[(i + 1) * n + i] = 0;
    }
    for (uint32_t span = 2; span < n; span++) {
        for (uint32_t i = 0; i + span < n; i++) {
            uint32_t k = i + span;
            bool free = span == n - 1 || !avoid || !is_joined(m, f, i, k, t->work);
            double side = span < n - 1 ? diagonal_cost(f, i, k) : 0;
            double cost = free ? fill_cell(f, i, k, side, t) : DBL_MAX;
            t->cost[i * n + k] = t->cost[k * n + i] = cost;
            t->work->steps += span;
            if (t->work->steps > HE_TRIANGULATION_STEPS) {
                return refuse_work(f, err);
            }
        }
    }
    return HE_OK;
}

/* Triangles innermost first, so that each has its middle corner to itself when its turn comes.
 * The stack holds sub-loops; preorder written backwards is children before parents. */
static void read_table(const he_flat *f, const table *t, uint32_t *corners)
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
    const he_flat *f = &plan->flat;
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
        /* Did avoiding edges make it so? */
        status = fill_table(m, f, false, &t, err);
        if (status == HE_OK && cost >= t.cost[whole] + BAD / 2) {
            status = refuse_doubled(m, f, err);
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

/* --- ears --- */

typedef enum ear_state { UNKNOWN, NO_EAR, EAR } ear_state;

typedef struct ears {
    const he_mesh *m;
    const he_flat *f;
    bool avoid;                     /* diagonals that exist as edges */
    uint32_t *next, *prev;          /* of what is left of the loop */
    uint8_t *state;                 /* of corners */
    uint8_t *convex;                /* does the corner turn left? Never becomes false again */
    uint32_t *reflex, reflex_count; /* corners that were not convex when last looked at */
    uint32_t left;
    he_triangulation_work *work;
    bool blocked; /* an ear was passed over because its diagonal exists */
} ears;

static void look_at(ears *e, uint32_t i)
{
    e->convex[i] = he_flat_turns_left(e->f, e->prev[i], i, e->next[i]);
    e->state[i] = UNKNOWN;
}

static bool same_place(const he_flat *f, uint32_t a, uint32_t b)
{
    return f->x[a] == f->x[b] && f->y[a] == f->y[b];
}

/* On the left of a -> b, or on it? */
static bool not_right(const he_flat *f, uint32_t a, uint32_t b, uint32_t p)
{
    return (f->x[b] - f->x[a]) * (f->y[p] - f->y[a]) >= (f->y[b] - f->y[a]) * (f->x[p] - f->x[a]);
}

/* Does a corner that is not convex lie in the triangle? Only such a one can be the nearest in the
 * way of a diagonal. Corners that have become convex or were cut leave the list here. */
static bool is_pierced(ears *e, uint32_t a, uint32_t b, uint32_t c)
{
    const he_flat *f = e->f;
    for (uint32_t r = 0; r < e->reflex_count;) {
        uint32_t p = e->reflex[r];
        if (e->convex[p]) {
            e->reflex[r] = e->reflex[--e->reflex_count];
            continue;
        }
        e->work->steps++;
        if (p != a && p != b && p != c && not_right(f, a, b, p) && not_right(f, b, c, p) &&
            not_right(f, c, a, p) && !same_place(f, p, a) && !same_place(f, p, b) &&
            !same_place(f, p, c)) {
            return true;
        }
        r++;
    }
    return false;
}

static bool is_taken(ears *e, uint32_t a, uint32_t c)
{
    return e->avoid && is_joined(e->m, e->f, a, c, e->work);
}

static bool is_ear(ears *e, uint32_t i)
{
    if (e->state[i] == UNKNOWN) {
        e->work->steps++;
        uint32_t a = e->prev[i], c = e->next[i];
        bool ear = e->convex[i] && !is_pierced(e, a, i, c);
        if (ear && is_taken(e, a, c)) {
            e->blocked = true;
            ear = false;
        }
        e->state[i] = ear ? EAR : NO_EAR;
    }
    return e->state[i] == EAR;
}

static uint32_t cut_ear(ears *e, uint32_t i, uint32_t *corners)
{
    uint32_t a = e->prev[i], c = e->next[i], *triangle = corners + 3 * (size_t)(e->f->n - e->left);
    triangle[0] = a;
    triangle[1] = i;
    triangle[2] = c;
    e->next[a] = c;
    e->prev[c] = a;
    e->convex[i] = true; /* out of the list of reflex corners */
    e->left--;
    look_at(e, a);
    look_at(e, c);
    return e->next[c];
}

/* The first ear from i on; i itself when there is none. */
static bool find_ear(ears *e, uint32_t i, uint32_t *out)
{
    for (uint32_t seen = 0; seen < e->left && e->work->steps <= HE_TRIANGULATION_STEPS; seen++) {
        if (is_ear(e, i)) {
            *out = i;
            return true;
        }
        i = e->next[i];
    }
    return false;
}

/* Cutting ears frees corners that were pierced: look at all of them again. */
static void forget_states(ears *e, uint32_t i)
{
    for (uint32_t seen = 0; seen < e->left; seen++) {
        e->state[i] = UNKNOWN;
        i = e->next[i];
    }
}

/* Any corner whose diagonal is free, convex ones first. */
static bool find_corner(ears *e, uint32_t i, uint32_t *out)
{
    for (unsigned convex = 2; convex-- > 0;) {
        for (uint32_t seen = 0; seen < e->left; seen++, i = e->next[i]) {
            e->work->steps++;
            if (e->convex[i] >= convex && !is_taken(e, e->prev[i], e->next[i])) {
                *out = i;
                return true;
            }
        }
    }
    return false;
}

static he_status cut_ears(ears *e, he_triangulation *plan, he_error *err)
{
    uint32_t at = 0, i;
    while (e->left > 3) {
        if (!find_ear(e, at, &i)) {
            e->blocked = false;
            forget_states(e, at);
            if (!find_ear(e, at, &i)) {
                if (e->work->steps > HE_TRIANGULATION_STEPS) {
                    return refuse_work(e->f, err);
                }
                if (e->blocked || !find_corner(e, at, &i)) {
                    return refuse_doubled(e->m, e->f, err);
                }
                plan->degenerate = true;
            }
        }
        at = cut_ear(e, i, plan->corners);
    }
    plan->degenerate |= !he_flat_turns_left(e->f, e->prev[at], at, e->next[at]);
    (void)cut_ear(e, at, plan->corners);
    return HE_OK;
}

static he_status plan_ears(const he_mesh *m, bool avoid, he_triangulation_work *work,
                           he_triangulation *plan, he_error *err)
{
    uint32_t n = plan->flat.n;
    ears e = {.m = m, .f = &plan->flat, .avoid = avoid, .left = n, .work = work};
    uint32_t *block = he_mem_zero(n, 3 * sizeof(uint32_t) + 2 * sizeof(uint8_t));
    if (block == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop of %u corners", n);
    }
    e.next = block;
    e.prev = e.next + n;
    e.reflex = e.prev + n;
    e.state = (uint8_t *)(e.reflex + n);
    e.convex = e.state + n;
    for (uint32_t i = 0; i < n; i++) {
        e.next[i] = i + 1 == n ? 0 : i + 1;
        e.prev[i] = i == 0 ? n - 1 : i - 1;
    }
    for (uint32_t i = 0; i < n; i++) {
        look_at(&e, i);
        if (!e.convex[i]) {
            e.reflex[e.reflex_count++] = i;
        }
    }
    he_status status = cut_ears(&e, plan, err);
    he_mem_free(block);
    return status;
}

/* --- both --- */

void he_triangulation_clear(he_triangulation *triangulation)
{
    he_flat_clear(&triangulation->flat);
    he_mem_free(triangulation->corners);
    *triangulation = (he_triangulation){.corners = NULL};
}

static he_status plan_loop(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                           he_triangulation *plan, he_error *err)
{
    bool avoid = (flags & HE_AVOID_EDGES) != 0;
    if (plan->flat.n > HE_EXACT_CORNERS) {
        return plan_ears(m, avoid, work, plan, err);
    }
    if (flags & HE_ANY_DIAGONALS) {
        he_status status = plan_ears(m, avoid, work, plan, err);
        bool done = status == HE_OK && (!plan->degenerate || plan->flat.degenerate);
        if (done || (status != HE_OK && status != HE_DOUBLED_EDGE)) {
            return status;
        }
    }
    return plan_exact(m, avoid, work, plan, err);
}

he_status he_triangulation_make(const he_mesh *m, he_halfedge first, unsigned flags,
                                he_triangulation_work *work, he_triangulation *out, he_error *err)
{
    he_triangulation plan = {.degenerate = false};
    he_triangulation_work own = {0};
    work = work == NULL ? &own : work;
    uint64_t before = work->steps;
    he_status status = he_flat_init(&plan.flat, m, first, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t n = plan.flat.n;
    plan.corners = he_mem_array(NULL, 3 * (size_t)(n - 2), sizeof *plan.corners);
    if (plan.corners == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    } else {
        status = plan_loop(m, flags, work, &plan, err);
    }
    if (status != HE_OK) {
        he_triangulation_clear(&plan);
        return status;
    }
    plan.steps = work->steps - before;
    *out = plan;
    return HE_OK;
}
