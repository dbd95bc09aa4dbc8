/* deform_patch.c - finds the free vertices, and the patch of triangles around them. */
#include "deform/deformer.h"

#include "geometry/scale.h"
#include "mesh/marks.h"
#include "mesh/walk.h"

#include <string.h>

/* The part of a vertex; OTHER stays and is not fixed. */
enum { OTHER, HANDLE, FIXED, FREE };

/* How far from free vertices a vertex is: INNER ones are free, NEAR ones share a face with an INNER
 * one, OUTER ones with a NEAR one. FAR ones are not in the patch. */
typedef enum reach { INNER, NEAR, OUTER, FAR } reach;

typedef struct search {
    const he_mesh *mesh;
    const he_deform_sets *sets;
    unsigned char *roles; /* of each vertex */
    unsigned char *reach;
    uint32_t *list; /* vertices still to be visited; then the number in the patch of each vertex */
    uint32_t vertices, faces;
} search;

static he_status allocate(search *s, he_error *err)
{
    const size_t room = (size_t)s->vertices + 1;
    s->roles = he_mem_zero(room, sizeof *s->roles);
    s->reach = he_mem_zero(room, sizeof *s->reach);
    s->list = he_mem_array(NULL, room, sizeof *s->list);
    return s->roles != NULL && s->reach != NULL && s->list != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to deform a mesh of %u vertices",
                               s->vertices);
}

/* --- roles --- */

/* Returns true if something around a vertex is locked. */
static bool is_locked(const he_mesh *m, const he_marks *marks, he_vertex v)
{
    const he_halfedge first = he_vertex_halfedge(m, v);
    bool locked = he_is_locked(marks, HE_VERTEX, v.i);
    he_halfedge h = first;
    while (first.i != HE_NONE && !locked) {
        const he_face f = he_face_of(m, h);
        locked = he_is_locked(marks, HE_EDGE, he_edge_of(h).i) ||
                 (f.i != HE_NONE && he_is_locked(marks, HE_FACE, f.i));
        h = he_swing_ccw(m, h);
        if (h.i == first.i) {
            break;
        }
    }
    return locked;
}

/* Makes the vertices free that are connected with a handle by edges between free ones. */
static he_status spread(search *s, he_progress *progress, he_error *err)
{
    const he_mesh *m = s->mesh;
    he_marks marks = {.feature = NULL};
    const bool marked = he_marks_find(m, &marks);
    uint32_t count = 0, visited = 0;
    he_status status = HE_OK;
    for (size_t i = 0; i < s->sets->fixed_count; i++) {
        s->roles[s->sets->fixed[i]] = FIXED;
    }
    for (size_t i = 0; i < s->sets->handle_count; i++) {
        s->roles[s->sets->handles[i]] = HANDLE;
        s->list[count++] = s->sets->handles[i];
    }
    while (count > 0 && status == HE_OK) {
        const he_halfedge first = he_vertex_halfedge(m, (he_vertex){s->list[--count]});
        he_halfedge h = first;
        status = he_progress_at(progress, ++visited, s->vertices, err);
        while (first.i != HE_NONE) {
            const he_vertex v = he_target(m, h);
            if (s->roles[v.i] == OTHER) {
                const bool locked = marked && is_locked(m, &marks, v);
                s->roles[v.i] = locked ? FIXED : FREE;
                s->list[count] = v.i;
                count += !locked;
            }
            h = he_swing_ccw(m, h);
            if (h.i == first.i) {
                break;
            }
        }
    }
    return status;
}

/* --- the patch --- */

/* Returns the number of corners of a face, or 0 if no corner has the given reach or a nearer one.
 */
static uint32_t corners_within(const search *s, he_halfedge first, reach from)
{
    bool touches = false;
    uint32_t corners = 0;
    he_halfedge h = first;
    do {
        touches |= s->reach[he_origin(s->mesh, h).i] <= from;
        corners++;
        h = he_next(s->mesh, h);
    } while (h.i != first.i);
    return touches ? corners : 0;
}

/* Gives the reach `from` + 1 to the corners of all faces that have a corner of the reach `from` or
 * a nearer one, unless they are nearer. Returns the number of triangles into which these faces are
 * cut. */
static uint64_t widen(search *s, reach from)
{
    const he_mesh *m = s->mesh;
    uint64_t triangles = 0;
    for (uint32_t f = 0; f < s->faces; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        const uint32_t corners = corners_within(s, h, from);
        for (uint32_t i = 0; i < corners; i++, h = he_next(m, h)) {
            unsigned char *at = &s->reach[he_origin(m, h).i];
            *at = *at == FAR ? (unsigned char)(from + 1) : *at;
        }
        triangles += corners > 0 ? corners - 2 : 0;
    }
    return triangles;
}

/* Numbers the vertices of the patch: the free ones first. s->list gets their numbers. */
static void number(search *s, he_deformer *d)
{
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t v = 0; v < s->vertices; v++) {
            if (s->reach[v] != FAR && (s->roles[v] == FREE) == (pass == 0)) {
                d->ids[d->vertices] = v;
                d->at[d->vertices] = he_position(s->mesh, (he_vertex){v});
                d->handle[d->vertices] = HE_NONE;
                s->list[v] = d->vertices++;
            }
        }
        d->free = pass == 0 ? d->vertices : d->free;
    }
    for (size_t i = 0; i < s->sets->handle_count; i++) {
        const uint32_t v = s->sets->handles[i];
        if (s->reach[v] != FAR) {
            d->handle[s->list[v]] = (uint32_t)i;
        }
    }
}

/* Cuts the faces that have an INNER or NEAR corner into fans of triangles. */
static void cut_faces(const search *s, he_deform_triangles *out)
{
    const he_mesh *m = s->mesh;
    for (uint32_t f = 0; f < s->faces; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        const he_halfedge first = he_face_halfedge(m, (he_face){f});
        const bool inside = corners_within(s, first, NEAR) > 0;
        for (he_halfedge h = he_next(m, first); inside && he_next(m, h).i != first.i;
             h = he_next(m, h)) {
            uint32_t *corners = out->corners + 3 * (size_t)out->count++;
            corners[0] = s->list[he_origin(m, first).i];
            corners[1] = s->list[he_origin(m, h).i];
            corners[2] = s->list[he_target(m, h).i];
        }
    }
}

/* --- parts and scale --- */

static uint32_t root_of(uint32_t *parents, uint32_t v)
{
    while (parents[v] != v) {
        parents[v] = parents[parents[v]];
        v = parents[v];
    }
    return v;
}

/* Numbers the connected parts of the patch. */
static void find_parts(he_deformer *d, const he_deform_triangles *t)
{
    for (uint32_t v = 0; v < d->vertices; v++) {
        d->part[v] = v;
    }
    for (size_t i = 0; i < 3 * (size_t)t->count; i++) {
        const uint32_t a = root_of(d->part, t->corners[i]),
                       b = root_of(d->part, t->corners[i - i % 3]);
        d->part[a > b ? a : b] = a > b ? b : a;
    }
    /* A root is lower than all others of its part, so each is numbered before it is asked for. */
    for (uint32_t v = 0; v < d->vertices; v++) {
        d->part[v] = d->part[v] == v ? v : root_of(d->part, v);
    }
    for (uint32_t v = 0; v < d->vertices; v++) {
        const uint32_t root = d->part[v];
        d->part[v] = root == v ? d->parts++ : d->part[root];
    }
}

static void scale(he_deformer *d)
{
    he_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    d->scale = 1;
    for (uint32_t v = 0; v < d->vertices; v++) {
        const he_vec3 p = d->at[v];
        low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
    if (d->vertices == 0) {
        return;
    }
    d->middle = he_vec3_add(he_vec3_scale(low, 0.5), he_vec3_scale(high, 0.5));
    const double extent = he_vec3_extent(he_vec3_sub(high, d->middle));
    d->scale = he_unit_of(extent);
    for (uint32_t v = 0; v < d->vertices; v++) {
        d->points[v] = he_vec3_scale(he_vec3_sub(d->at[v], d->middle), 1 / d->scale);
    }
}

/* --- the whole --- */

static he_status allocate_patch(he_deformer *d, const search *s, uint64_t triangles,
                                he_deform_triangles *out, he_error *err)
{
    size_t room = 1;
    for (uint32_t v = 0; v < s->vertices; v++) {
        room += s->reach[v] != FAR;
    }
    if (triangles > UINT32_MAX / 4) {
        return he_fail_plain(err, HE_LIMIT, "%llu triangles are too many to deform at once",
                             (unsigned long long)triangles);
    }
    d->ids = he_mem_array(NULL, room, sizeof *d->ids);
    d->handle = he_mem_array(NULL, room, sizeof *d->handle);
    d->part = he_mem_array(NULL, room, sizeof *d->part);
    d->points = he_mem_array(NULL, room, sizeof *d->points);
    d->at = he_mem_array(NULL, room, sizeof *d->at);
    out->corners = he_mem_array(NULL, 3 * (size_t)triangles + 1, sizeof *out->corners);
    return d->ids != NULL && d->handle != NULL && d->part != NULL && d->points != NULL &&
                   d->at != NULL && out->corners != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %zu vertices", room - 1);
}

he_status he_deformer_find_patch(he_deformer *d, const he_mesh *m, const he_deform_sets *sets,
                                 he_deform_triangles *out, he_progress *progress, he_error *err)
{
    search s = {.mesh = m,
                .sets = sets,
                .vertices = he_mesh_issued(m, HE_VERTEX),
                .faces = he_mesh_issued(m, HE_FACE)};
    he_status status = allocate(&s, err);
    if (status == HE_OK) {
        status = spread(&s, progress, err);
    }
    if (status == HE_OK) {
        for (uint32_t v = 0; v < s.vertices; v++) {
            s.reach[v] = s.roles[v] == FREE ? INNER : FAR;
        }
        (void)widen(&s, INNER);
        const uint64_t triangles = widen(&s, NEAR);
        status = allocate_patch(d, &s, triangles, out, err);
    }
    if (status == HE_OK) {
        d->handles = (uint32_t)sets->handle_count;
        number(&s, d);
        cut_faces(&s, out);
        find_parts(d, out);
        scale(d);
    }
    he_mem_free(s.roles);
    he_mem_free(s.reach);
    he_mem_free(s.list);
    return status;
}
