#include "select/proxies.h"

#include "base/forest.h"
#include "geometry/scale.h"
#include "mesh/marks.h"
#include "mesh/walk.h"
#include "select/bucket_queue.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* The most rounds of growing and fitting after seeds were added or moved, and at the end; and how
 * often seeds are moved at most. */
enum { ROUNDS_BETWEEN = 2, ROUNDS_AT_END = 10, MOVES = 8 };

/* The rounds end when the error falls by less than this fraction. */
static const double ENOUGH = 3e-3;

/* A patch whose error is below this fraction of its area counts as flat. */
static const double FLAT = 1e-12;

typedef struct proxy {
    he_vec3 normal;
    uint32_t seed;
    /* The two faces with the largest errors, and these errors. */
    uint32_t worst[2];
    double worst_error[2];
    double best;        /* the error of the seed, for each unit of its area */
    double error, area; /* sums over the faces of the patch */
    he_vec3 sum;        /* of the normals, weighted by area */
} proxy;

typedef struct fitting {
    const he_proxy_task *task;
    uint32_t *labels;
    float *least; /* for each face, the least error with which a patch has reached it */
    proxy *proxies;
    uint32_t count, capacity;
    he_bucket_queue *queue; /* faces that patches may take next */
    double error, area;     /* sums over all patches */
} fitting;

/* --- growing the patches --- */

/* Returns the error of a face for each unit of its area: the squared distance of two unit
 * vectors. */
static double error_of(const fitting *f, uint32_t face, uint32_t patch)
{
    const he_vec3 d = he_vec3_sub(f->task->normals[face], f->proxies[patch].normal);
    return he_vec3_dot(d, d);
}

/* Gives a face to a patch, and makes its neighbours candidates. A neighbour that another patch has
 * reached with less error stays with that patch. */
static he_status take(fitting *f, uint32_t face, uint32_t patch, he_error *err)
{
    const he_mesh *m = f->task->m;
    const he_halfedge first = he_face_halfedge(m, (he_face){face});
    he_halfedge h = first;
    he_status status = HE_OK;
    f->labels[face] = patch;
    do {
        const uint32_t next = he_face_of(m, he_twin(h)).i;
        if (next != HE_NONE && f->labels[next] == HE_NONE &&
            !he_is_marked(f->task->barrier, he_edge_of(h).i)) {
            const float error = (float)error_of(f, next, patch);
            if (error < f->least[next]) {
                f->least[next] = error;
                status = he_bucket_queue_add(f->queue, error, next, patch, err);
            }
        }
        h = he_next(m, h);
    } while (h.i != first.i && status == HE_OK);
    return status;
}

static he_status grow(fitting *f, he_error *err)
{
    const he_mesh *m = f->task->m;
    he_status status = HE_OK;
    assert(f->proxies != NULL);
    for (uint32_t i = 0; i < m->c.faces.issued; i++) {
        f->labels[i] = HE_NONE;
        f->least[i] = INFINITY;
    }
    for (uint32_t p = 0; p < f->count; p++) {
        f->labels[f->proxies[p].seed] = p;
    }
    for (uint32_t p = 0; p < f->count && status == HE_OK; p++) {
        status = take(f, f->proxies[p].seed, p, err);
    }
    he_queued c;
    for (uint64_t i = 0; status == HE_OK && he_bucket_queue_take(f->queue, &c); i++) {
        status = he_progress_at(m->progress, i, 4 * (uint64_t)m->c.faces.live, err);
        if (status == HE_OK && f->labels[c.face] == HE_NONE) {
            status = take(f, c.face, c.patch, err);
        }
    }
    return status;
}

/* --- fitting the proxies --- */

/* Adds a face to the sums of its patch, and remembers it if it fits best or worst. */
static void judge(const fitting *f, uint32_t face, proxy *x)
{
    const double area = f->task->areas[face];
    const double relative = error_of(f, face, f->labels[face]), error = relative * area;
    x->error += error;
    if (error > x->worst_error[0]) {
        x->worst[1] = x->worst[0];
        x->worst_error[1] = x->worst_error[0];
        x->worst[0] = face;
        x->worst_error[0] = error;
    } else if (error > x->worst_error[1]) {
        x->worst[1] = face;
        x->worst_error[1] = error;
    }
    if (relative < x->best && area > 0) {
        x->best = relative;
        x->seed = face;
    }
}

/* Makes each proxy the mean of the normals of its patch, and finds its error, and the faces that
 * fit best and worst. */
static void fit(fitting *f)
{
    const he_proxy_task *t = f->task;
    const uint32_t faces = t->m->c.faces.issued;
    for (uint32_t p = 0; p < f->count; p++) {
        const proxy old = f->proxies[p];
        f->proxies[p] = (proxy){.normal = old.normal,
                                .seed = old.seed,
                                .worst = {old.seed, old.seed},
                                .best = INFINITY};
    }
    for (uint32_t face = 0; face < faces; face++) {
        if (f->labels[face] != HE_NONE) {
            proxy *x = &f->proxies[f->labels[face]];
            x->sum = he_vec3_add(x->sum, he_vec3_scale(t->normals[face], t->areas[face]));
            x->area += t->areas[face];
        }
    }
    for (uint32_t p = 0; p < f->count; p++) {
        he_vec3 mean;
        proxy *x = &f->proxies[p];
        x->normal = he_vec3_normalise(x->sum, &mean) ? mean : x->normal;
    }
    for (uint32_t face = 0; face < faces; face++) {
        if (f->labels[face] != HE_NONE) {
            judge(f, face, &f->proxies[f->labels[face]]);
        }
    }
    f->error = f->area = 0;
    for (uint32_t p = 0; p < f->count; p++) {
        f->error += f->proxies[p].error;
        f->area += f->proxies[p].area;
    }
}

/* Grows patches and fits proxies until the error no longer falls. */
static he_status settle(fitting *f, int rounds, he_error *err)
{
    he_status status = HE_OK;
    double before = INFINITY;
    for (int i = 0; i < rounds && status == HE_OK; i++) {
        status = grow(f, err);
        if (status != HE_OK) {
            break;
        }
        fit(f);
        if (f->error >= (1 - ENOUGH) * before || f->error <= FLAT * f->area) {
            break;
        }
        before = f->error;
    }
    return status;
}

/* --- seeds --- */

static he_status add_seed(fitting *f, uint32_t face, he_error *err)
{
    if (f->count == f->capacity) {
        size_t capacity = he_mem_grown(f->capacity, (size_t)f->count + 1);
        proxy *grown = he_mem_array(f->proxies, capacity, sizeof *grown);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for more than %u patches", f->count);
        }
        f->proxies = grown;
        f->capacity = (uint32_t)capacity;
    }
    f->proxies[f->count++] = (proxy){.normal = f->task->normals[face], .seed = face};
    return HE_OK;
}

/* Adds a seed in each component: the face with the lowest id. Uses `labels` for the search. */
static he_status add_first_seeds(fitting *f, he_error *err)
{
    const he_mesh *m = f->task->m;
    he_status status = HE_OK;
    const uint32_t faces = m->c.faces.issued;
    for (uint32_t i = 0; i < faces; i++) {
        f->labels[i] = i;
    }
    for (uint32_t e = 0; e < m->c.edges.issued && status == HE_OK; e++) {
        const uint32_t a = m->c.face[2u * e], b = m->c.face[2u * e + 1u];
        status = he_progress_at(m->progress, e, m->c.edges.issued, err);
        if (a < faces && b < faces && !he_is_marked(f->task->barrier, e)) {
            (void)he_forest_unite(f->labels, a, b);
        }
    }
    for (uint32_t i = 0; i < faces && status == HE_OK; i++) {
        if (f->labels[i] == i && he_face_is_live(m, (he_face){i})) {
            status = add_seed(f, i, err);
        }
    }
    return status;
}

/* The error of a patch, for finding the largest. */
typedef struct rank {
    double error;
    uint32_t patch;
} rank;

static int compare_ranks(const void *a, const void *b)
{
    const rank *x = a, *y = b;
    return x->error > y->error   ? -1
           : x->error < y->error ? 1
                                 : (x->patch > y->patch) - (x->patch < y->patch);
}

/* Lists all patches, those with the largest errors first. */
static void sort_patches(const fitting *f, rank *ranks)
{
    for (uint32_t p = 0; p < f->count; p++) {
        ranks[p] = (rank){f->proxies[p].error, p};
    }
    qsort(ranks, f->count, sizeof *ranks, compare_ranks);
}

/* Returns the face of a patch, other than its seed, with the largest error; HE_NONE if the patch is
 * flat. */
static uint32_t worst_of(const proxy *x)
{
    const uint32_t worst = x->worst[x->worst[0] == x->seed];
    return x->error > FLAT * x->area && worst != x->seed ? worst : HE_NONE;
}

/* Adds up to `most` seeds, at the worst faces of the patches with the largest errors, at most one
 * in each patch. A flat patch gets none. */
static he_status add_seeds(fitting *f, uint32_t most, he_error *err)
{
    rank *ranks = he_mem_array(NULL, f->count, sizeof *ranks);
    if (ranks == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %u patches", f->count);
    }
    const uint32_t count = f->count;
    he_status status = HE_OK;
    sort_patches(f, ranks);
    for (uint32_t i = 0; i < count && f->count - count < most && status == HE_OK; i++) {
        const uint32_t worst = worst_of(&f->proxies[ranks[i].patch]);
        if (worst != HE_NONE) {
            status = add_seed(f, worst, err);
        }
    }
    he_mem_free(ranks);
    return status;
}

/* --- moving seeds --- */

/* Two patches that share an edge. */
typedef struct pair {
    double cost; /* the error that is added if they become one patch */
    uint32_t a, b;
} pair;

static int compare_patches(const void *x, const void *y)
{
    const pair *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->b > q->b) - (p->b < q->b);
}

static int compare_costs(const void *x, const void *y)
{
    const pair *p = x, *q = y;
    return p->cost < q->cost ? -1 : p->cost > q->cost ? 1 : compare_patches(x, y);
}

typedef struct pairs {
    pair *list;
    size_t count, capacity;
} pairs;

static he_status add_pair(pairs *all, uint32_t a, uint32_t b, he_error *err)
{
    if (all->count == all->capacity) {
        size_t capacity = he_mem_grown(all->capacity, all->count + 1);
        pair *grown = he_mem_array(all->list, capacity, sizeof *grown);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare patches");
        }
        all->list = grown;
        all->capacity = capacity;
    }
    all->list[all->count++] = (pair){0, a < b ? a : b, a < b ? b : a};
    return HE_OK;
}

/* Lists each pair of patches that share an edge which is no barrier, the cheapest first. */
static he_status find_pairs(const fitting *f, pairs *all, he_error *err)
{
    const he_mesh *m = f->task->m;
    const uint32_t faces = m->c.faces.issued;
    he_status status = HE_OK;
    for (uint32_t e = 0; e < m->c.edges.issued && status == HE_OK; e++) {
        const uint32_t a = m->c.face[2u * e], b = m->c.face[2u * e + 1u];
        if (a < faces && b < faces && f->labels[a] != f->labels[b] &&
            !he_is_marked(f->task->barrier, e)) {
            status = add_pair(all, f->labels[a], f->labels[b], err);
        }
    }
    if (status != HE_OK || all->count == 0) {
        return status;
    }
    qsort(all->list, all->count, sizeof *all->list, compare_patches);
    size_t kept = 0;
    for (size_t i = 0; i < all->count; i++) {
        if (kept == 0 || compare_patches(&all->list[i], &all->list[kept - 1]) != 0) {
            all->list[kept++] = all->list[i];
        }
    }
    all->count = kept;
    for (size_t i = 0; i < kept; i++) {
        pair *p = &all->list[i];
        const proxy *a = &f->proxies[p->a], *b = &f->proxies[p->b];
        const double together = a->area + b->area - he_vec3_length(he_vec3_add(a->sum, b->sum));
        p->cost = 2 * together - a->error - b->error;
    }
    qsort(all->list, kept, sizeof *all->list, compare_costs);
    return HE_OK;
}

/* Joins the patches of a pair, and gives the seed that this frees to the patch `to`. */
static void move_seed(fitting *f, const pair *p, uint32_t to)
{
    const uint32_t worst = worst_of(&f->proxies[to]);
    proxy *a = &f->proxies[p->a], *b = &f->proxies[p->b];
    he_vec3 mean;
    if (he_vec3_normalise(he_vec3_add(a->sum, b->sum), &mean)) {
        a->normal = mean;
    }
    *b = (proxy){.normal = f->task->normals[worst], .seed = worst};
}

/* Moves the seeds of as many patches as promise to lower the error. Every patch takes part in one
 * move at most; `used` says which did. `ranks` lists the patches, those with the largest errors
 * first. Returns how many seeds were moved. */
static uint32_t move_all(fitting *f, const pairs *all, const rank *ranks, bool *used)
{
    uint32_t moved = 0, next = 0;
    for (size_t i = 0; i < all->count; i++) {
        const pair *p = &all->list[i];
        while (next < f->count &&
               (used[ranks[next].patch] || worst_of(&f->proxies[ranks[next].patch]) == HE_NONE)) {
            next++;
        }
        if (next == f->count || !(p->cost < ranks[next].error / 2)) {
            break;
        }
        const uint32_t to = ranks[next].patch;
        if (!used[p->a] && !used[p->b] && p->a != to && p->b != to) {
            used[p->a] = used[p->b] = used[to] = true;
            move_seed(f, p, to);
            moved++;
        }
    }
    return moved;
}

static he_status move_seeds(fitting *f, uint32_t *moved, he_error *err)
{
    pairs all = {NULL, 0, 0};
    rank *ranks = he_mem_array(NULL, f->count, sizeof *ranks);
    bool *used = he_mem_zero(f->count, sizeof *used);
    he_status status =
        ranks != NULL && used != NULL
            ? find_pairs(f, &all, err)
            : he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %u patches", f->count);
    if (status == HE_OK) {
        sort_patches(f, ranks);
        *moved = move_all(f, &all, ranks, used);
    }
    he_mem_free(all.list);
    he_mem_free(ranks);
    he_mem_free(used);
    return status;
}

/* Moves seeds as long as that lowers the error. `best` gets the labels with the least error. */
static he_status improve(fitting *f, uint32_t *best, he_error *err)
{
    const size_t bytes = f->task->m->c.faces.issued * sizeof *best;
    double least = f->error;
    he_status status = HE_OK;
    memcpy(best, f->labels, bytes);
    for (int i = 0; i < MOVES && f->error > FLAT * f->area && status == HE_OK; i++) {
        uint32_t moved = 0;
        status = move_seeds(f, &moved, err);
        if (status == HE_OK && moved > 0) {
            status = settle(f, ROUNDS_BETWEEN + 1, err);
        }
        if (status != HE_OK || moved == 0 || f->error > (1 - ENOUGH) * least) {
            break;
        }
        least = f->error;
        memcpy(best, f->labels, bytes);
    }
    return status;
}

/* If all patches are flat, joins those that lie in one plane and share an edge: fewer patches than
 * wanted are then as good. */
static he_status join_flat(fitting *f, he_error *err)
{
    pairs all = {NULL, 0, 0};
    fit(f);
    if (f->error > FLAT * f->area) {
        return HE_OK;
    }
    uint32_t *into = he_mem_array(NULL, f->count, sizeof *into);
    he_status status =
        into != NULL ? find_pairs(f, &all, err)
                     : he_fail_plain(err, HE_NO_MEMORY, "no memory to join %u patches", f->count);
    for (uint32_t p = 0; p < f->count && status == HE_OK; p++) {
        into[p] = p;
    }
    for (size_t i = 0; i < all.count && status == HE_OK; i++) {
        const pair *p = &all.list[i];
        if (p->cost <= FLAT * (f->proxies[p->a].area + f->proxies[p->b].area)) {
            (void)he_forest_unite(into, p->a, p->b);
        }
    }
    for (uint32_t face = 0; face < f->task->m->c.faces.issued && status == HE_OK; face++) {
        if (f->labels[face] != HE_NONE) {
            f->labels[face] = he_forest_root(into, f->labels[face]);
        }
    }
    he_mem_free(all.list);
    he_mem_free(into);
    return status;
}

static he_status fit_all(fitting *f, he_error *err)
{
    const uint32_t wanted = f->task->count, faces = f->task->m->c.faces.issued;
    uint32_t *best = he_mem_array(NULL, faces, sizeof *best);
    he_status status = best != NULL
                           ? add_first_seeds(f, err)
                           : he_fail_plain(err, HE_NO_MEMORY, "no memory for %u patches", wanted);
    for (bool more = true; more && status == HE_OK;) {
        const uint32_t before = f->count;
        status = settle(f, before < wanted ? ROUNDS_BETWEEN : ROUNDS_AT_END, err);
        if (status == HE_OK && before < wanted) {
            status = add_seeds(f, before < wanted - before ? before : wanted - before, err);
        }
        more = f->count > before;
    }
    if (status == HE_OK) {
        status = improve(f, best, err);
    }
    if (status == HE_OK) {
        memcpy(f->labels, best, faces * sizeof *best);
        status = join_flat(f, err);
    }
    he_mem_free(best);
    return status;
}

he_status he_proxies_fit(const he_proxy_task *task, uint32_t *labels, he_error *err)
{
    const uint32_t faces = task->m->c.faces.issued;
    fitting f = {.task = task, .labels = labels};
    f.least = he_mem_array(NULL, (size_t)faces + 1, sizeof *f.least);
    f.queue = he_bucket_queue_new();
    he_status status = f.least != NULL && f.queue != NULL
                           ? HE_OK
                           : he_fail_plain(err, HE_NO_MEMORY, "no memory for patches of %u faces",
                                           task->m->c.faces.live);
    for (uint32_t face = 0; face < faces && status == HE_OK; face++) {
        labels[face] = HE_NONE;
    }
    if (status == HE_OK && task->m->c.faces.live > 0) {
        status = fit_all(&f, err);
    }
    he_mem_free(f.least);
    he_bucket_queue_free(f.queue);
    he_mem_free(f.proxies);
    return status;
}
