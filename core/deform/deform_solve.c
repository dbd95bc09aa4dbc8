/* deform_solve.c - computes the positions of the free vertices for given goals of the handles.
 *
 * The unknowns are the offsets d from the motion of the whole part: q_i = R p_i + t + d_i, where
 * the rotation R and the vector t fit the goals best. So the offsets of a rigid motion are 0. */
#include "deform/deformer.h"

#include "base/parallel.h"
#include "geometry/scale.h"

#include <string.h>

/* A connected part of the patch, and the motion that fits its handles and fixed vertices best. */
typedef struct part {
    uint32_t count;     /* of its vertices that are not free */
    bool moves;         /* one of them moves */
    he_vec3 from, to;   /* their mean, and the mean of where they go */
    double products[9]; /* of where they go, less `to`, and where they are, less `from` */
    he_rotation turn;
} part;

typedef struct solving {
    const he_deformer *d;
    part *parts;
    double *block;       /* the arrays below, one after the other */
    he_vec3 *now;        /* the present position of each vertex of the patch, scaled */
    he_vec3 *offset;     /* of those that are not free */
    he_rotation *turns;  /* of each vertex of the patch; NULL with biharmonic */
    double *base;        /* what the fixed offsets contribute to the right sides */
    double *right;       /* the right sides, then the solutions: three of d->free numbers */
    he_progress threads; /* lends threads and reports nothing */
} solving;

static void clear(solving *s)
{
    he_mem_free(s->parts);
    he_mem_free(s->block);
}

/* Takes `count` numbers from those that are left. */
static double *take(double **left, size_t count)
{
    double *taken = *left;
    *left += count;
    return taken;
}

/* The arrays are parts of one block: while a handle is dragged they are allocated many times a
 * second, and the system gives out the pages of a large block in larger pieces. */
static he_status allocate(solving *s, he_error *err)
{
    enum { POINT = 3, ROTATION = 9 };
    const he_deformer *d = s->d;
    const size_t points = POINT * (size_t)d->vertices, sides = POINT * (size_t)d->free;
    const size_t turns = d->method == HE_DEFORM_ARAP ? ROTATION * (size_t)d->vertices : 0;
    s->parts = he_mem_zero((size_t)d->parts + 1, sizeof *s->parts);
    s->block = he_mem_array(NULL, 2 * points + turns + 2 * sides, sizeof *s->block);
    if (s->parts == NULL || s->block == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices", d->free);
    }
    double *left = s->block;
    s->now = (he_vec3 *)(void *)take(&left, points);
    s->offset = (he_vec3 *)(void *)take(&left, points);
    s->turns = turns == 0 ? NULL : (he_rotation *)(void *)take(&left, turns);
    s->base = take(&left, sides);
    s->right = take(&left, sides);
    return HE_OK;
}

/* --- the motion of the whole parts --- */

/* Sets the present position of each vertex that is not free: its goal. */
static he_status take_goals(solving *s, const he_vec3 *goals, he_error *err)
{
    const he_deformer *d = s->d;
    for (uint32_t v = d->free; v < d->vertices; v++) {
        s->now[v] = d->points[v];
        if (d->handle[v] == HE_NONE) {
            continue;
        }
        const he_vec3 goal = goals[d->handle[v]], way = he_vec3_sub(goal, d->at[v]);
        if (he_vec3_extent(way) > 0) {
            s->parts[d->part[v]].moves = true;
            s->now[v] = he_vec3_scale(he_vec3_sub(goal, d->middle), 1 / d->scale);
        }
        if (!he_vec3_is_finite(s->now[v])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, d->ids[v],
                           "vertex %u would move too far to compute with", d->ids[v]);
        }
    }
    return HE_OK;
}

static he_vec3 towards_mean(he_vec3 mean, he_vec3 p, uint32_t count)
{
    return he_vec3_add(mean, he_vec3_scale(he_vec3_sub(p, mean), 1.0 / count));
}

static void fit_parts(solving *s)
{
    const he_deformer *d = s->d;
    for (uint32_t v = d->free; v < d->vertices; v++) {
        part *p = &s->parts[d->part[v]];
        p->count++;
        p->from = towards_mean(p->from, d->points[v], p->count);
        p->to = towards_mean(p->to, s->now[v], p->count);
    }
    for (uint32_t v = d->free; v < d->vertices; v++) {
        part *p = &s->parts[d->part[v]];
        he_matrix_add(p->products, 1, he_vec3_sub(s->now[v], p->to),
                      he_vec3_sub(d->points[v], p->from));
    }
    for (uint32_t i = 0; i < d->parts; i++) {
        static const double none[9] = {0};
        part *p = &s->parts[i];
        p->turn = he_rotation_nearest(d->method == HE_DEFORM_ARAP ? p->products : none);
    }
}

/* Returns where the motion of its whole part takes a vertex. */
static he_vec3 carried(const solving *s, uint32_t v)
{
    const part *p = &s->parts[s->d->part[v]];
    return he_vec3_add(p->to, he_rotation_apply(&p->turn, he_vec3_sub(s->d->points[v], p->from)));
}

/* Computes the offsets of the vertices that are not free, and what they contribute to the right
 * sides. */
static void prepare(solving *s)
{
    const he_deformer *d = s->d;
    const he_sparse *a = &d->matrix;
    for (uint32_t v = 0; v < d->vertices; v++) {
        s->offset[v] = v < d->free ? (he_vec3){0, 0, 0} : he_vec3_sub(s->now[v], carried(s, v));
        if (s->turns != NULL) {
            s->turns[v] = s->parts[d->part[v]].turn;
        }
    }
    for (uint32_t v = 0; v < d->free; v++) {
        he_vec3 sum = {0, 0, 0};
        for (size_t i = a->starts[v]; i < a->starts[v + 1]; i++) {
            if (a->rows[i] >= d->free) {
                sum = he_vec3_sub(sum, he_vec3_scale(s->offset[a->rows[i]], a->values[i]));
            }
        }
        s->base[v] = sum.x;
        s->base[d->free + (size_t)v] = sum.y;
        s->base[2 * (size_t)d->free + v] = sum.z;
    }
}

/* --- the steps of arap --- */

/* Chooses the rotation of each vertex of a range for the present positions. */
static he_status turn(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    (void)which, (void)err;
    const solving *s = context;
    const he_deformer *d = s->d;
    const he_sparse *a = &d->matrix;
    for (size_t v = from; v < to; v++) {
        const he_vec3 p = d->points[v], q = s->now[v];
        double products[9] = {0};
        for (size_t i = a->starts[v]; i < a->starts[v + 1]; i++) {
            const uint32_t other = a->rows[i];
            he_matrix_add(products, -a->values[i], he_vec3_sub(q, s->now[other]),
                          he_vec3_sub(p, d->points[other]));
        }
        s->turns[v] = he_rotation_nearest(products);
    }
    return HE_OK;
}

/* Adds to the right sides of a range what the rotations of the vertices contribute, beyond that of
 * the whole part. */
static he_status add_turns(void *context, uint32_t which, size_t from, size_t to, he_error *err)
{
    (void)which, (void)err;
    const solving *s = context;
    const he_deformer *d = s->d;
    const he_sparse *a = &d->matrix;
    for (size_t v = from; v < to; v++) {
        const he_rotation *own = &s->turns[v], *whole = &s->parts[d->part[v]].turn;
        he_vec3 sum = {0, 0, 0};
        for (size_t i = a->starts[v]; i < a->starts[v + 1]; i++) {
            const uint32_t other = a->rows[i];
            const he_vec3 edge = he_vec3_sub(d->points[v], d->points[other]);
            he_rotation mean;
            for (int k = 0; k < 9; k++) {
                mean.k[k] = 0.5 * (own->k[k] + s->turns[other].k[k]) - whole->k[k];
            }
            sum = he_vec3_sub(sum, he_vec3_scale(he_rotation_apply(&mean, edge), a->values[i]));
        }
        s->right[v] += sum.x;
        s->right[d->free + (size_t)v] += sum.y;
        s->right[2 * (size_t)d->free + v] += sum.z;
    }
    return HE_OK;
}

/* Chooses the positions of the free vertices for the present rotations. */
static he_status move(solving *s, bool turned, he_error *err)
{
    const he_deformer *d = s->d;
    memcpy(s->right, s->base, 3 * (size_t)d->free * sizeof *s->right);
    he_status status = turned ? he_run_ranges(&s->threads, d->free, add_turns, s, err) : HE_OK;
    if (status != HE_OK) {
        return status;
    }
    status = he_factor_solve(d->factor, &d->system, (he_right_sides){s->right, s->right, 3, turned},
                             NULL, err);
    if (status == HE_NOT_FINITE) {
        return he_fail(err, HE_NOT_FINITE, HE_VERTEX, d->ids[0],
                       "vertex %u, or another that follows, would have a position that is not "
                       "finite",
                       d->ids[0]);
    }
    for (uint32_t v = 0; v < d->free && status == HE_OK; v++) {
        const he_vec3 offset = {s->right[v], s->right[d->free + (size_t)v],
                                s->right[2 * (size_t)d->free + v]};
        s->now[v] = he_vec3_add(carried(s, v), offset);
    }
    return status;
}

static double energy_of(const solving *s)
{
    const he_deformer *d = s->d;
    const he_sparse *a = &d->matrix;
    double energy = 0;
    for (uint32_t v = 0; v < d->vertices; v++) {
        for (size_t i = a->starts[v]; i < a->starts[v + 1]; i++) {
            const uint32_t other = a->rows[i];
            const he_vec3 old = he_vec3_sub(d->points[v], d->points[other]);
            const he_vec3 bent = he_vec3_sub(he_vec3_sub(s->now[v], s->now[other]),
                                             he_rotation_apply(&s->turns[v], old));
            energy -= a->values[i] * he_vec3_dot(bent, bent);
        }
    }
    /* Rounding may make it less than 0. */
    return he_saturated(fmax(energy, 0) * d->scale * d->scale);
}

/* --- the whole --- */

/* Returns true if all handles move by one vector, up to rounding. */
static bool is_translation(const solving *s, he_vec3 *by)
{
    static const double ROUNDING = 1e-14;
    const he_deformer *d = s->d;
    bool any = false;
    for (uint32_t v = d->free; v < d->vertices; v++) {
        if (d->handle[v] != HE_NONE) {
            const he_vec3 way = he_vec3_sub(s->now[v], d->points[v]);
            *by = any ? *by : way;
            any = true;
            if (!(he_vec3_extent(he_vec3_sub(way, *by)) <= ROUNDING)) {
                return false;
            }
        }
    }
    return any;
}

/* Chooses the first positions of the free vertices. */
static he_status begin(solving *s, he_error *err)
{
    const he_deformer *d = s->d;
    he_vec3 by = {0, 0, 0};
    if (d->fields == NULL || !is_translation(s, &by)) {
        return move(s, false, err);
    }
    for (uint32_t v = 0; v < d->free; v++) {
        s->now[v] = he_deformer_carry(d, v, &s->parts[d->part[v]].turn, by);
        if (!he_vec3_is_finite(s->now[v])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, d->ids[v],
                           "vertex %u would have a position that is not finite", d->ids[v]);
        }
    }
    return HE_OK;
}

static he_status do_steps(solving *s, unsigned steps, he_progress *progress, he_error *err)
{
    he_status status = begin(s, err);
    for (unsigned i = 0; i < steps && status == HE_OK && s->turns != NULL; i++) {
        /* The steps of a small mesh are too short to be told of one by one. */
        if (i == 0 || s->d->free >= HE_PROGRESS_STRIDE) {
            status = he_progress_step(progress, i, steps, err);
        }
        if (status == HE_OK) {
            status = he_run_ranges(&s->threads, s->d->vertices, turn, s, err);
        }
        if (status == HE_OK) {
            status = move(s, true, err);
        }
    }
    return status;
}

/* Turns the scaled positions into those of the mesh: each vertex moves by the scaled difference, so
 * that a vertex of a part that does not move keeps its bits. */
static he_status unscale(const solving *s, he_vec3 *positions, he_error *err)
{
    const he_deformer *d = s->d;
    for (uint32_t v = 0; v < d->free; v++) {
        const he_vec3 way = he_vec3_scale(he_vec3_sub(s->now[v], d->points[v]), d->scale);
        const bool moves = s->parts[d->part[v]].moves;
        positions[v] = moves ? he_vec3_add(d->at[v], way) : d->at[v];
        if (!he_vec3_is_finite(positions[v])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, d->ids[v],
                           "vertex %u would have a position that is not finite", d->ids[v]);
        }
    }
    return HE_OK;
}

he_status he_deformer_solve(const he_deformer *d, he_deform_motion *motion, he_progress *progress,
                            he_error *err)
{
    solving s = {.d = d, .threads = {.parallel = progress == NULL ? NULL : progress->parallel}};
    motion->energy = 0;
    if (motion->steps < 1 || motion->steps > HE_DEFORM_STEPS) {
        return he_fail_plain(err, HE_BAD_VALUE, "a deformation does 1 to %d steps, not %u",
                             (int)HE_DEFORM_STEPS, motion->steps);
    }
    if (d->free == 0) {
        return HE_OK;
    }
    he_status status = allocate(&s, err);
    if (status == HE_OK) {
        status = take_goals(&s, motion->goals, err);
    }
    if (status == HE_OK) {
        fit_parts(&s);
        prepare(&s);
        status = do_steps(&s, motion->steps, progress, err);
    }
    if (status == HE_OK) {
        status = unscale(&s, motion->positions, err);
    }
    if (status == HE_OK && s.turns != NULL) {
        motion->energy = energy_of(&s);
    }
    clear(&s);
    return status;
}
