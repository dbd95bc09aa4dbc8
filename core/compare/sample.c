#include "compare/comparing.h"

#include <string.h>

/* About how many samples all triangles of a mesh with few triangles get. */
static const double SAMPLES = 4096;

enum { MOST_PARTS = 65 }; /* into so many parts a side is divided at most */

static he_status add_sample(he_comparing *c, double distance, double weight, he_error *err)
{
    if (c->sample_count == c->sample_capacity) {
        const size_t capacity = he_mem_grown(c->sample_capacity, c->sample_count + 1);
        he_sample *samples = he_mem_array(c->samples, capacity, sizeof *samples);
        if (samples == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the distances at samples");
        }
        c->samples = samples;
        c->sample_capacity = capacity;
    }
    c->samples[c->sample_count++] = (he_sample){distance, weight};
    return HE_OK;
}

/* Adds what a triangle contributes to the means, given the distances at its corners and its middle:
 * the weights 1/12 and 3/4 are exact for polynomials of the second degree. */
static void add_to_means(he_comparing *c, const double corner[3], double middle, double weight)
{
    c->weight += weight;
    c->sum += weight * (0.75 * middle + (corner[0] + corner[1] + corner[2]) / 12);
    c->squares +=
        weight * (0.75 * middle * middle +
                  (corner[0] * corner[0] + corner[1] * corner[1] + corner[2] * corner[2]) / 12);
}

/* A triangle of `from` that is divided into parts * parts smaller ones, row by row.
 *
 *          2          The samples are the corners of the small triangles and their middles.
 *         /_\
 *        /_\/_\
 *       0 ----- 1     */
typedef struct lattice {
    he_comparing *c;
    uint32_t triangle;
    he_vec3 corner[3];
    uint32_t parts;
    double weight; /* of a small triangle */
    uint32_t hint;
    double row[2][MOST_PARTS + 1]; /* distances at the corners in the lower and upper row */
} lattice;

/* Returns the point i / parts along the first side and k / parts along the way to corner 2. */
static he_vec3 point(const lattice *l, double i, double k)
{
    const double s = i / l->parts, t = k / l->parts;
    return he_vec3_add(he_vec3_scale(l->corner[0], 1 - s - t),
                       he_vec3_add(he_vec3_scale(l->corner[1], s), he_vec3_scale(l->corner[2], t)));
}

static he_status fill_row(lattice *l, uint32_t k, double *row, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t i = 0; status == HE_OK && i <= l->parts - k; i++) {
        status = he_comparing_ask(l->c, point(l, i, k), l->triangle, &l->hint, &row[i], err);
    }
    return status;
}

/* Samples the small triangle with its corners at these distances, whose middle is at (i, k). */
static he_status sample_part(lattice *l, const double corner[3], double i, double k, he_error *err)
{
    double middle;
    he_status status = he_comparing_ask(l->c, point(l, i, k), l->triangle, &l->hint, &middle, err);
    if (status == HE_OK) {
        add_to_means(l->c, corner, middle, l->weight);
        status = add_sample(l->c, middle, l->weight, err);
    }
    return status;
}

static he_status sample_lattice(lattice *l, he_error *err)
{
    double *lower = l->row[0], *upper = l->row[1];
    he_status status = fill_row(l, 0, lower, err);
    for (uint32_t k = 0; status == HE_OK && k < l->parts; k++) {
        status = fill_row(l, k + 1, upper, err);
        for (uint32_t i = 0; status == HE_OK && i < l->parts - k; i++) {
            const double up[3] = {lower[i], lower[i + 1], upper[i]};
            status = sample_part(l, up, i + 1 / 3.0, k + 1 / 3.0, err);
            if (status == HE_OK && i + 1 < l->parts - k) {
                const double down[3] = {lower[i + 1], upper[i + 1], upper[i]};
                status = sample_part(l, down, i + 2 / 3.0, k + 2 / 3.0, err);
            }
        }
        double *swap = lower;
        lower = upper;
        upper = swap;
    }
    return status;
}

/* --- triangles --- */

/* Returns the area of a triangle of `from` in the coordinates of that surface's tree, where
 * products neither overflow nor underflow. */
static double area_of(const he_comparing *c, uint32_t triangle)
{
    he_vec3 p[3];
    he_bvh_corners(c->from.tree, c->from.mesh, triangle, p);
    return he_vec3_length(he_vec3_cross(he_vec3_sub(p[1], p[0]), he_vec3_sub(p[2], p[0]))) / 2;
}

/* Returns an upper bound of the distances of the points of a triangle, given the nearest triangle
 * and the distance of its middle. */
static double bound_of(const he_comparing *c, uint32_t triangle, const he_vec3 corner[3],
                       uint32_t near_middle, double middle)
{
    const uint32_t *vertex = c->from.tree->triangles[triangle].vertex;
    const he_vec3 center =
        he_vec3_scale(he_vec3_add(corner[0], he_vec3_add(corner[1], corner[2])), 1 / 3.0);
    double radius = 0;
    for (int k = 0; k < 3; k++) {
        const double far = he_vec3_length(he_vec3_sub(corner[k], center));
        radius = far > radius ? far : radius;
    }
    double upper = middle + radius;
    uint32_t farthest;
    if (upper > c->lower) {
        upper = fmin(upper, he_comparing_farthest(c, corner, 3, near_middle, &farthest));
    }
    for (int k = 0; k < 3 && upper > c->target; k++) {
        if (c->nearest[vertex[k]] != near_middle) {
            upper =
                fmin(upper, he_comparing_farthest(c, corner, 3, c->nearest[vertex[k]], &farthest));
        }
    }
    return upper;
}

static he_status sample_triangle(he_comparing *c, uint32_t triangle, double weight, double cell,
                                 he_error *err)
{
    const uint32_t *vertex = c->from.tree->triangles[triangle].vertex;
    he_vec3 p[3];
    uint32_t hint = c->nearest[vertex[2]];
    double corner[3], middle;
    he_comparing_corners(c, triangle, p);
    for (int k = 0; k < 3; k++) {
        corner[k] = c->distance[vertex[k]];
    }
    const he_vec3 center = he_vec3_scale(he_vec3_add(p[0], he_vec3_add(p[1], p[2])), 1 / 3.0);
    he_status status = he_comparing_ask(c, center, triangle, &hint, &middle, err);
    if (status != HE_OK) {
        return status;
    }
    c->upper[triangle] = bound_of(c, triangle, p, hint, middle);
    const double parts = ceil(sqrt(weight / cell));
    if (!(parts > 1)) {
        add_to_means(c, corner, middle, weight);
        return add_sample(c, middle, weight, err);
    }
    lattice l = {.c = c, .triangle = triangle, .hint = hint};
    memcpy(l.corner, p, sizeof p);
    l.parts = parts < MOST_PARTS ? (uint32_t)parts : MOST_PARTS;
    l.weight = weight / ((double)l.parts * l.parts);
    return sample_lattice(&l, err);
}

/* --- parts --- */

static he_status reach_part(he_comparing *c, uint32_t from, uint32_t to, he_error *err)
{
    uint32_t hint = HE_NONE;
    he_status status = HE_OK;
    /* The order of the tree is one in which neighbours follow each other, so hints are good. */
    for (uint32_t i = from; status == HE_OK && i < to; i++) {
        he_vec3 corner[3];
        const uint32_t *vertex = c->from.tree->triangles[i].vertex;
        status = he_comparing_report(c, i, err);
        he_comparing_corners(c, i, corner);
        for (int k = 0; k < 3 && status == HE_OK; k++) {
            const uint32_t v = vertex[k];
            if (c->first[v] == i) {
                status = he_comparing_ask(c, corner[k], i, &hint, &c->distance[v], err);
                c->nearest[v] = hint;
            }
        }
    }
    return status;
}

he_status he_compare_reach(he_comparing *c, he_error *err)
{
    for (uint32_t v = 0; v < c->from.mesh->c.vertices.issued; v++) {
        c->first[v] = c->nearest[v] = HE_NONE;
        c->distance[v] = 0;
    }
    for (uint32_t i = c->from.tree->count; i-- > 0;) {
        const uint32_t *vertex = c->from.tree->triangles[i].vertex;
        for (int k = 0; k < 3 && !he_bits_get(c->equal, i); k++) {
            c->first[vertex[k]] = i;
        }
    }
    return he_compare_in_parts(c, reach_part, err);
}

static he_status sample_part_of_surface(he_comparing *c, uint32_t from, uint32_t to, he_error *err)
{
    /* Without any area every triangle counts as much as the others. */
    const double cell = c->area > 0 ? c->area / SAMPLES : 1;
    he_status status = HE_OK;
    for (uint32_t i = from; status == HE_OK && i < to; i++) {
        const double weight = c->area > 0 ? area_of(c, i) : 1;
        status = he_comparing_report(c, i, err);
        if (status == HE_OK && he_bits_get(c->equal, i)) {
            static const double zero[3] = {0, 0, 0};
            c->upper[i] = 0;
            add_to_means(c, zero, 0, weight);
            status = add_sample(c, 0, weight, err);
        } else if (status == HE_OK) {
            status = sample_triangle(c, i, weight, cell, err);
        }
    }
    return status;
}

he_status he_compare_sample(he_comparing *c, he_error *err)
{
    c->area = 0;
    for (uint32_t i = 0; i < c->from.tree->count; i++) {
        c->area += area_of(c, i);
    }
    return he_compare_in_parts(c, sample_part_of_surface, err);
}
