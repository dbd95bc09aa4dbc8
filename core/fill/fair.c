/* fair.c - he_patch_fair: moves the new vertices so that the patch continues the mesh. */
#include "fill/patch.h"

#include "base/progress.h"
#include "mesh/layout.h"
#include "query/idmap.h"
#include "solve/harmonic.h"

/* No more faces around a vertex, and no more corners of a face, are looked at in one direction, so
 * that a vertex or face that is in many holes does not cost too much. */
enum { ENOUGH = 64 };

/* The mesh around the hole. The first vertices are the corners of the hole, in order. */
typedef struct surroundings {
    he_idmap vertices, faces; /* ids of the mesh */
    he_ids corners;           /* of triangles, as indices in `vertices` */
} surroundings;

static void surroundings_clear(surroundings *s)
{
    he_idmap_clear(&s->vertices);
    he_idmap_clear(&s->faces);
    he_ids_clear(&s->corners);
}

/* Adds a face, cut into triangles from one corner, unless it was added before. */
static he_status add_face(surroundings *s, const he_mesh *m, he_halfedge h, he_error *err)
{
    uint32_t index[3] = {0, 0, 0};
    bool added;
    he_status status = he_idmap_add(&s->faces, he_face_of(m, h).i, &index[0], &added, err);
    if (status != HE_OK || !added) {
        return status;
    }
    he_halfedge k = h;
    for (uint32_t i = 0; i < ENOUGH && status == HE_OK && (i == 0 || k.i != h.i); i++) {
        index[1] = index[2];
        status = he_idmap_add(&s->vertices, he_origin(m, k).i, &index[i == 0 ? 0 : 2], &added, err);
        if (i >= 2 && status == HE_OK) {
            status = he_ids_reserve(&s->corners, 3, err);
        }
        for (uint32_t c = 0; c < 3 && i >= 2 && status == HE_OK; c++) {
            s->corners.ids[s->corners.count++] = index[c];
        }
        k = he_next(m, k);
    }
    return status;
}

/* Adds the faces around the origin of a half-edge, clockwise from its right side and, if a hole or
 * the limit ends this, counter-clockwise from the left side of `left`. */
static he_status add_faces(surroundings *s, const he_mesh *m, he_halfedge right, he_halfedge left,
                           he_error *err)
{
    he_status status = HE_OK;
    he_halfedge h = right;
    for (uint32_t i = 0; i < ENOUGH && status == HE_OK; i++) {
        const he_halfedge twin = he_twin(h);
        if (he_is_boundary_halfedge(m, twin)) {
            break;
        }
        status = add_face(s, m, twin, err);
        h = he_next(m, twin);
        if (h.i == right.i) {
            return status;
        }
    }
    h = left;
    for (uint32_t i = 0; i < ENOUGH && status == HE_OK && !he_is_boundary_halfedge(m, h); i++) {
        status = add_face(s, m, h, err);
        h = he_swing_ccw(m, h);
    }
    return status;
}

/* Finds the faces around the hole, as far as `rings` rings of vertices. */
static he_status gather(const he_patch *p, unsigned rings, surroundings *out, he_error *err)
{
    const he_mesh *m = p->mesh;
    he_status status = HE_OK;
    for (uint32_t i = 0; i < p->rim && status == HE_OK; i++) {
        uint32_t index;
        bool added;
        status = he_idmap_add(&out->vertices, he_origin(m, (he_halfedge){p->loop[i]}).i, &index,
                              &added, err);
    }
    for (uint32_t i = 0; i < p->rim && rings > 0 && status == HE_OK; i++) {
        const uint32_t before = p->loop[i == 0 ? p->rim - 1 : i - 1];
        status = add_faces(out, m, (he_halfedge){p->loop[i]}, he_twin((he_halfedge){before}), err);
    }
    const size_t count = out->vertices.ids.count;
    for (size_t i = p->rim; i < count && rings > 1 && status == HE_OK; i++) {
        const he_halfedge h = he_vertex_halfedge(m, (he_vertex){out->vertices.ids.ids[i]});
        status = add_faces(out, m, h, h, err);
    }
    return status;
}

/* The surface over which equations are solved: the patch and its surroundings. */
typedef struct domain {
    he_surface surface;
    uint32_t *corners;
    he_vec3 *points;
    uint64_t *fixed;
    double *values; /* x of all vertices, then y, then z */
} domain;

static void domain_clear(domain *d)
{
    he_mem_free(d->corners);
    he_mem_free(d->points);
    he_mem_free(d->fixed);
    he_mem_free(d->values);
}

static he_status make_domain(const he_patch *p, const surroundings *s, domain *out, he_error *err)
{
    const uint32_t extra = (uint32_t)s->vertices.ids.count - p->rim;
    const uint32_t vertices = p->vertices + extra;
    const size_t sides = 3 * (size_t)p->triangles;
    out->corners = he_mem_array(NULL, sides + s->corners.count, sizeof *out->corners);
    out->points = he_mem_array(NULL, vertices, sizeof *out->points);
    out->values = he_mem_array(NULL, 3 * (size_t)vertices, sizeof *out->values);
    out->fixed = he_bits_new(vertices);
    if (out->corners == NULL || out->points == NULL || out->values == NULL || out->fixed == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to smooth %u vertices", p->vertices);
    }
    for (size_t i = 0; i < sides; i++) {
        out->corners[i] = p->corners[i];
    }
    for (size_t i = 0; i < s->corners.count; i++) {
        const uint32_t v = s->corners.ids[i];
        out->corners[sides + i] = v < p->rim ? v : v - p->rim + p->vertices;
    }
    for (uint32_t v = 0; v < vertices; v++) {
        const uint32_t outside =
            v < p->vertices ? 0 : s->vertices.ids.ids[v - p->vertices + p->rim];
        out->points[v] = v < p->vertices
                             ? p->at[v]
                             : he_patch_inside(p, he_position(p->mesh, (he_vertex){outside}));
        if (v < p->rim || v >= p->vertices) {
            he_bits_set(out->fixed, v);
        }
    }
    out->surface = (he_surface){vertices, p->triangles + (uint32_t)s->corners.count / 3,
                                out->corners, out->points};
    return HE_OK;
}

/* Solves the equations of order k for the new vertices. */
static he_status solve(he_patch *p, domain *d, unsigned k, he_error *err)
{
    const uint32_t n = d->surface.vertices;
    he_laplacian l = {.masses = NULL};
    he_harmonic *system = NULL;
    for (uint32_t v = 0; v < n; v++) {
        d->values[v] = d->points[v].x;
        d->values[n + (size_t)v] = d->points[v].y;
        d->values[2 * (size_t)n + v] = d->points[v].z;
    }
    he_status status = he_laplacian_make(&d->surface, p->mesh->progress, &l, err);
    if (status == HE_OK) {
        status = he_harmonic_make(&l, k, d->fixed, p->mesh->progress, &system, err);
    }
    he_laplacian_clear(&l);
    if (status == HE_OK) {
        /* A second pass would only make up for the roundings of the first one: what the equations
         * make of the roundings in the positions of the rim is as large. */
        status = he_harmonic_solve(system, d->values, 3, true, NULL, err);
    }
    he_harmonic_free(system);
    for (uint32_t v = p->rim; v < p->vertices && status == HE_OK; v++) {
        const he_vec3 at = {d->values[v], d->values[n + (size_t)v], d->values[2 * (size_t)n + v]};
        if (!he_vec3_is_finite(he_patch_outside(p, at))) {
            status = he_fail_plain(err, HE_NOT_FINITE, "a position is not finite");
        }
    }
    for (uint32_t v = p->rim; v < p->vertices && status == HE_OK; v++) {
        const he_vec3 to = {d->values[v], d->values[n + (size_t)v], d->values[2 * (size_t)n + v]};
        p->at[v] = to;
    }
    return status;
}

bool he_patch_must_stop(he_status status, const he_error *why, he_error *err)
{
    const bool stop = status == HE_NO_MEMORY || status == HE_CANCELLED;
    if (stop && err != NULL) {
        *err = *why;
    }
    return stop;
}

he_status he_patch_fair(he_patch *p, unsigned continuity, he_error *err)
{
    /* If the equations have no solution, those of the next lower order are solved. If there are
     * none, the patch stays as it is. */
    for (unsigned order = continuity + 1; order >= 1 && p->vertices > p->rim; order--) {
        surroundings s = {.corners = {NULL, 0, 0}};
        domain d = {.corners = NULL};
        he_error why = {.status = HE_OK};
        he_status status = gather(p, order - 1, &s, &why);
        if (status == HE_OK) {
            status = make_domain(p, &s, &d, &why);
        }
        if (status == HE_OK) {
            status = solve(p, &d, order, &why);
        }
        domain_clear(&d);
        surroundings_clear(&s);
        if (status == HE_OK) {
            return he_patch_relax(p, err);
        }
        if (he_patch_must_stop(status, &why, err)) {
            return status;
        }
    }
    return HE_OK;
}
