/* smooth_laplacian.c - the method laplacian: implicit steps of the mean curvature flow. */
#include "smooth/smoothing.h"

#include "geometry/vec3.h"
#include "solve/conjugate.h"
#include "solve/laplacian.h"

#include <string.h>

/* The part of the surface that has free vertices, with vertices numbered anew: the free ones first,
 * in the order of s->free. */
typedef struct patch {
    uint32_t *numbers; /* of each vertex of the mesh; UINT32_MAX: not in the patch */
    uint32_t *corners; /* three vertices of the patch for each triangle */
    he_vec3 *points;
    uint32_t vertices, triangles;
} patch;

static void clear_patch(patch *p)
{
    he_mem_free(p->numbers);
    he_mem_free(p->corners);
    he_mem_free(p->points);
}

static bool touches(const he_smoothing *s, const uint32_t corners[3])
{
    return he_bits_get(s->is_free, corners[0]) || he_bits_get(s->is_free, corners[1]) ||
           he_bits_get(s->is_free, corners[2]);
}

/* Reads the corners of a face. Returns false if it is deleted or no triangle. */
static bool read_triangle(const he_mesh *m, he_face f, uint32_t corners[3])
{
    if (!he_face_is_live(m, f)) {
        return false;
    }
    const he_halfedge a = he_face_halfedge(m, f), b = he_next(m, a), c = he_next(m, b);
    corners[0] = he_origin(m, a).i;
    corners[1] = he_origin(m, b).i;
    corners[2] = he_origin(m, c).i;
    return he_next(m, c).i == a.i;
}

static void number(patch *p, const he_smoothing *s, uint32_t v)
{
    if (p->numbers[v] == UINT32_MAX) {
        p->points[p->vertices] = s->at[v];
        p->numbers[v] = p->vertices++;
    }
}

static he_status make_patch(const he_smoothing *s, patch *p, he_error *err)
{
    const uint32_t vertices = he_mesh_issued(s->mesh, HE_VERTEX);
    const uint32_t faces = he_mesh_issued(s->mesh, HE_FACE);
    *p = (patch){.numbers = he_mem_array(NULL, (size_t)vertices + 1, sizeof *p->numbers),
                 .corners = he_mem_array(NULL, 3 * (size_t)faces + 1, sizeof *p->corners),
                 .points = he_mem_array(NULL, (size_t)vertices + 1, sizeof *p->points)};
    if (p->numbers == NULL || p->corners == NULL || p->points == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to smooth %u vertices", s->count);
    }
    memset(p->numbers, 0xFF, ((size_t)vertices + 1) * sizeof *p->numbers);
    for (uint32_t i = 0; i < s->count; i++) {
        number(p, s, s->free[i]);
    }
    for (uint32_t f = 0; f < faces; f++) {
        uint32_t corners[3];
        if (!read_triangle(s->mesh, (he_face){f}, corners) || !touches(s, corners)) {
            continue;
        }
        for (uint32_t k = 0; k < 3; k++) {
            number(p, s, corners[k]);
            p->corners[3 * (size_t)p->triangles + k] = p->numbers[corners[k]];
        }
        p->triangles++;
    }
    return HE_OK;
}

/* Writes the right sides of the three coordinates: the mass times the position, less what the fixed
 * vertices contribute. */
static void fill_right(const he_smoothing *s, const patch *p, const he_laplacian *l,
                       const he_sparse *whole, double *right)
{
    for (uint32_t i = 0; i < s->count; i++) {
        he_vec3 sum = he_vec3_scale(p->points[i], l->masses[i]);
        for (size_t k = whole->starts[i]; k < whole->starts[i + 1]; k++) {
            if (whole->rows[k] >= s->count) {
                sum = he_vec3_sub(sum, he_vec3_scale(p->points[whole->rows[k]], whole->values[k]));
            }
        }
        right[i] = sum.x;
        right[s->count + (size_t)i] = sum.y;
        right[2 * (size_t)s->count + i] = sum.z;
    }
}

/* Makes the system of the free vertices from that of all vertices of the patch, whose first rows
 * are those of the free ones. */
static he_status take_part(const he_smoothing *s, const patch *p, const he_sparse *whole,
                           he_sparse *out, he_error *err)
{
    uint32_t *numbers = he_mem_array(NULL, (size_t)p->vertices + 1, sizeof *numbers);
    if (numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to smooth %u vertices", s->count);
    }
    for (uint32_t i = 0; i < p->vertices; i++) {
        numbers[i] = i < s->count ? i : UINT32_MAX;
    }
    he_status status = he_sparse_part(whole, numbers, s->count, out, err);
    he_mem_free(numbers);
    return status;
}

/* Beside very thin triangles the masses are smaller than the rounding errors of the weights, and
 * the system could have no solution. So each vertex gets a little more mass. */
static void steady(const he_smoothing *s, he_laplacian *l)
{
    const he_sparse *a = &l->matrix;
    for (uint32_t j = 0; j < a->n; j++) {
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            if (a->rows[i] == j) {
                l->masses[j] += 1e-13 * s->amount * fabs(a->values[i]);
            }
        }
    }
}

/* Solves by a factor. */
static he_status factor(const he_smoothing *s, const he_sparse *part, he_right_sides sides,
                        he_error *err)
{
    he_factor *of = NULL;
    he_status status = he_factor_make(part, s->mesh->progress, &of, err);
    if (status == HE_BAD_VALUE) {
        /* the time times a weight is not finite */
        status = he_fail_plain(err, HE_BAD_VALUE,
                               "the time of a step is too large for this surface: in units of the "
                               "mesh it is %g",
                               s->amount * s->scale * s->scale);
    }
    if (status == HE_OK) {
        status = he_factor_solve(of, part, sides, NULL, err);
    }
    he_factor_free(of);
    return status;
}

static he_status solve(he_smoothing *s, const patch *p, const he_laplacian *l, he_error *err)
{
    he_sparse whole = {0}, part = {0};
    double *right = he_mem_array(NULL, 3 * (size_t)s->count + 1, sizeof *right);
    const he_right_sides sides = {right, right, 3, false};
    bool solved = false;
    he_status status = right == NULL ? he_fail_plain(err, HE_NO_MEMORY,
                                                     "no memory to smooth %u vertices", s->count)
                                     : he_laplacian_step(l, s->amount, &whole, err);
    if (status == HE_OK) {
        status = take_part(s, p, &whole, &part, err);
    }
    if (status == HE_OK) {
        fill_right(s, p, l, &whole, right);
        status = he_conjugate_solve(&part, sides, s->mesh->progress, &solved, err);
    }
    if (status == HE_OK && !solved) {
        status = factor(s, &part, sides, err);
    }
    for (uint32_t i = 0; i < s->count && status == HE_OK; i++) {
        s->at[s->free[i]] =
            (he_vec3){right[i], right[s->count + (size_t)i], right[2 * (size_t)s->count + i]};
    }
    he_sparse_clear(&whole);
    he_sparse_clear(&part);
    he_mem_free(right);
    return status;
}

he_status he_smooth_laplacian(he_smoothing *s, he_error *err)
{
    patch p;
    he_laplacian l = {0};
    he_status status = make_patch(s, &p, err);
    if (status == HE_OK) {
        const he_surface surface = {p.vertices, p.triangles, p.corners, p.points};
        status = he_laplacian_make(&surface, s->mesh->progress, &l, err);
    }
    if (status == HE_OK) {
        steady(s, &l);
        status = solve(s, &p, &l, err);
    }
    he_laplacian_clear(&l);
    clear_patch(&p);
    if (status == HE_LIMIT) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "%u vertices are too many for one system of "
                             "equations",
                             s->count);
    }
    return status;
}
