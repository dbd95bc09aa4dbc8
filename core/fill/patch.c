#include "fill/patch.h"

#include "geometry/scale.h"
#include "mesh/layout.h"

/* A corner with more edges is a hub: whether an edge joins it to another hub is looked up. */
enum { HUB = 64 };

void he_patch_clear(he_patch *p)
{
    he_mem_free(p->at);
    he_mem_free(p->size);
    he_mem_free(p->degree);
    he_mem_free(p->corner);
    he_mem_free(p->corners);
    he_mem_free(p->twins);
    he_mem_free(p->beyond);
    *p = (he_patch){.mesh = NULL};
}

he_vec3 he_patch_inside(const he_patch *p, he_vec3 position)
{
    const he_vec3 half = he_vec3_sub(he_vec3_scale(position, 0.5), he_vec3_scale(p->base, 0.5));
    return he_vec3_scale(half, 2 / p->unit);
}

he_vec3 he_patch_outside(const he_patch *p, he_vec3 at)
{
    /* in halves, because a hole may be larger than the largest double */
    const he_vec3 half = he_vec3_add(he_vec3_scale(p->base, 0.5), he_vec3_scale(at, 0.5 * p->unit));
    return he_vec3_scale(half, 2);
}

/* --- the corners of the hole --- */

static bool is_hub(const he_mesh *m, he_halfedge leaving)
{
    he_halfedge h = leaving;
    for (uint32_t i = 0; i < HUB; i++) {
        h = he_swing_ccw(m, h);
        if (h.i == leaving.i) {
            return false;
        }
    }
    return true;
}

static he_status prepare_chords(const he_mesh *m, const he_ids *loop, he_rim_chords *chords,
                                he_error *err)
{
    for (size_t i = 0; i < loop->count && !chords->made; i++) {
        if (is_hub(m, (he_halfedge){loop->ids[i]})) {
            he_status status = he_edge_lookup_make(m, &chords->lookup, err);
            if (status != HE_OK) {
                return status;
            }
            chords->made = true;
        }
    }
    return HE_OK;
}

bool he_patch_is_chord(const he_patch *p, uint32_t a, uint32_t b)
{
    const he_mesh *m = p->mesh;
    uint64_t steps = 0;
    return a < p->rim && b < p->rim &&
           he_edge_lookup_has(m, p->chords->made ? &p->chords->lookup : NULL,
                              he_origin(m, (he_halfedge){p->loop[a]}),
                              he_origin(m, (he_halfedge){p->loop[b]}), &steps);
}

/* Chooses the unit of coordinates: a power of two, at least as large as the hole. */
static double unit_of(const he_mesh *m, const he_ids *loop, he_vec3 base)
{
    double extent = 0;
    for (size_t i = 0; i < loop->count; i++) {
        const he_vec3 at = he_position(m, he_origin(m, (he_halfedge){loop->ids[i]}));
        extent = fmax(
            extent, he_vec3_extent(he_vec3_sub(he_vec3_scale(at, 0.5), he_vec3_scale(base, 0.5))));
    }
    return he_unit_of(extent);
}

/* Returns the unit normal on the other side of a boundary half-edge, of the first corners of the
 * face there; zero if these have no area. */
static he_vec3 normal_beyond(const he_patch *p, he_halfedge h)
{
    enum { CORNERS = 64 };
    const he_mesh *m = p->mesh;
    const he_halfedge first = he_twin(h);
    const he_vec3 from = he_patch_inside(p, he_position(m, he_origin(m, first)));
    he_halfedge k = he_next(m, first);
    he_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < CORNERS && he_next(m, k).i != first.i; i++) {
        const he_vec3 a = he_patch_inside(p, he_position(m, he_origin(m, k))),
                      b = he_patch_inside(p, he_position(m, he_target(m, k)));
        sum = he_vec3_add(sum, he_triangle_normal(from, a, b));
        k = he_next(m, k);
    }
    he_vec3 normal;
    (void)he_vec3_normalise(sum, &normal);
    return normal;
}

static double distance(he_vec3 a, he_vec3 b)
{
    return he_vec3_length(he_vec3_sub(a, b));
}

/* Returns the mean length of the mesh's edges at corner i: those of the loop, and those between
 * them around the faces beyond. */
static double mean_length(const he_patch *p, uint32_t i)
{
    enum { EDGES = 64 };
    const he_mesh *m = p->mesh;
    const he_halfedge first = {p->loop[i]};
    he_halfedge h = first;
    double sum = 0;
    uint32_t count = 0;
    do {
        sum += distance(p->at[i], he_patch_inside(p, he_position(m, he_target(m, h))));
        count++;
        h = he_next(m, he_twin(h));
    } while (count < EDGES && h.i != first.i && !he_is_boundary_halfedge(m, h));
    return sum / count;
}

/* The wanted length at a corner is the mean of those of the mesh's edges there (Liepa 2003), so
 * that the patch is as dense as the mesh around it. But it is not more than this many times the
 * mean of the two edges in the loop: a pipe of long thin triangles gets a cap of even ones. */
static const double MOST_OF_LOOP = 2;

/* It is not less than this part of the mean of all, or two corners at one place would make
 * triangles without end. */
static const double LEAST_SIZE = 1e-3;

static void read_corners(he_patch *p)
{
    const he_mesh *m = p->mesh;
    double mean = 0;
    for (uint32_t i = 0; i < p->rim; i++) {
        const he_halfedge h = {p->loop[i]};
        (void)he_patch_add_vertex(p, he_patch_inside(p, he_position(m, he_origin(m, h))), 0, i);
        p->beyond[i] = normal_beyond(p, h);
    }
    for (uint32_t i = 0; i < p->rim; i++) {
        const uint32_t before = i == 0 ? p->rim - 1 : i - 1, after = i + 1 == p->rim ? 0 : i + 1;
        const double loop =
            distance(p->at[before], p->at[i]) / 2 + distance(p->at[i], p->at[after]) / 2;
        p->size[i] = fmin(mean_length(p, i), MOST_OF_LOOP * loop);
        mean += p->size[i] / p->rim;
    }
    for (uint32_t i = 0; i < p->rim; i++) {
        p->size[i] = fmax(p->size[i], LEAST_SIZE * mean);
    }
}

he_status he_patch_make(const he_mesh *m, const he_ids *loop, he_rim_chords *chords, he_patch *out,
                        he_error *err)
{
    const uint32_t rim = (uint32_t)loop->count;
    const he_vec3 base = he_position(m, he_origin(m, (he_halfedge){loop->ids[0]}));
    *out = (he_patch){.mesh = m,
                      .chords = chords,
                      .loop = loop->ids,
                      .rim = rim,
                      .base = base,
                      .unit = unit_of(m, loop, base)};
    he_status status = prepare_chords(m, loop, chords, err);
    if (status != HE_OK) {
        return status;
    }
    out->vertex_room = rim + 1;
    out->triangle_room = rim + 2;
    out->at = he_mem_array(NULL, out->vertex_room, sizeof *out->at);
    out->size = he_mem_array(NULL, out->vertex_room, sizeof *out->size);
    out->degree = he_mem_array(NULL, out->vertex_room, sizeof *out->degree);
    out->corner = he_mem_array(NULL, out->vertex_room, sizeof *out->corner);
    out->corners = he_mem_array(NULL, out->triangle_room, 3 * sizeof *out->corners);
    out->twins = he_mem_array(NULL, out->triangle_room, 3 * sizeof *out->twins);
    out->beyond = he_mem_array(NULL, rim, sizeof *out->beyond);
    if (out->at == NULL || out->size == NULL || out->degree == NULL || out->corner == NULL ||
        out->corners == NULL || out->twins == NULL || out->beyond == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to fill a hole of %u edges", rim);
    }
    read_corners(out);
    return HE_OK;
}

/* --- vertices and triangles --- */

/* Resizes an array in place. Returns false if memory is out. */
static bool resize(void *array, size_t count, size_t size)
{
    void **at = array;
    void *grown = he_mem_array(*at, count, size);
    if (grown != NULL) {
        *at = grown;
    }
    return grown != NULL;
}

he_status he_patch_reserve(he_patch *p, he_error *err)
{
    bool done = true;
    if (p->vertices + 1 > p->vertex_room) {
        const size_t room = he_mem_grown(p->vertex_room, (size_t)p->vertices + 1);
        done = resize(&p->at, room, sizeof *p->at) && resize(&p->size, room, sizeof *p->size) &&
               resize(&p->degree, room, sizeof *p->degree) &&
               resize(&p->corner, room, sizeof *p->corner);
        p->vertex_room = done ? (uint32_t)room : p->vertex_room;
    }
    if (done && p->triangles + 2 > p->triangle_room) {
        const size_t room = he_mem_grown(p->triangle_room, (size_t)p->triangles + 2);
        done = resize(&p->corners, room, 3 * sizeof *p->corners) &&
               resize(&p->twins, room, 3 * sizeof *p->twins);
        p->triangle_room = done ? (uint32_t)room : p->triangle_room;
    }
    return done ? HE_OK
                : he_fail_plain(err, HE_NO_MEMORY, "no memory to fill a hole with %u triangles",
                                p->triangles);
}

uint32_t he_patch_add_vertex(he_patch *p, he_vec3 at, double size, uint32_t corner)
{
    p->at[p->vertices] = at;
    p->size[p->vertices] = size;
    p->degree[p->vertices] = 0;
    p->corner[p->vertices] = corner;
    return p->vertices++;
}

uint32_t he_patch_add_triangle(he_patch *p, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t side = 3 * p->triangles;
    const uint32_t corners[3] = {a, b, c};
    for (uint32_t k = 0; k < 3; k++) {
        p->corners[side + k] = corners[k];
        p->twins[side + k] = UINT32_MAX;
        p->degree[corners[k]]++;
    }
    return p->triangles++;
}

he_status he_patch_pair(he_patch *p, he_error *err)
{
    /* Sides without a twin so far, in a list for each vertex from which they run. */
    uint32_t *first = he_mem_array(NULL, p->vertices, sizeof *first);
    uint32_t *next = he_mem_array(NULL, 3 * (size_t)p->triangles, sizeof *next);
    if (first == NULL || next == NULL) {
        he_mem_free(first);
        he_mem_free(next);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to fill a hole with %u triangles",
                             p->triangles);
    }
    for (uint32_t v = 0; v < p->vertices; v++) {
        first[v] = UINT32_MAX;
    }
    for (uint32_t s = 0; s < 3 * p->triangles; s++) {
        const uint32_t a = p->corners[s], b = p->corners[he_patch_next(s)];
        uint32_t *link = &first[b];
        while (*link != UINT32_MAX && p->corners[he_patch_next(*link)] != a) {
            link = &next[*link];
        }
        if (*link != UINT32_MAX) {
            p->twins[s] = *link;
            p->twins[*link] = s;
            *link = next[*link];
        } else {
            next[s] = first[a];
            first[a] = s;
        }
    }
    he_mem_free(first);
    he_mem_free(next);
    return HE_OK;
}
