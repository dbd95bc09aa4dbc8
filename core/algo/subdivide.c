#include "algo/subdivide.h"

#include "algo/subdivide_step.h"
#include "mesh/marks.h"
#include "mesh/write.h"

#include <string.h>

/* --- sizes --- */

/* Properties of the mesh before a step that the step needs: its sizes, its feature edges, and the
 * vertices that must not move. */
typedef struct start {
    he_sizes sizes;
    /* a bit for each edge: set if the edge is a feature; NULL if there are no features */
    uint64_t *feature;
    uint64_t *fixed;
} start;

static he_status no_memory(const he_mesh *m, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to subdivide %u faces", m->c.faces.live);
}

/* Returns true if a vertex is on the boundary and has only one face, so that it has only two
 * edges. */
static bool has_one_face(const he_content *c, uint32_t v)
{
    uint32_t h = c->vertex_halfedge[v];
    return h != HE_NONE && c->face[h] == HE_NONE && c->prev[c->prev[h] ^ 1] == (h ^ 1);
}

static he_status find_fixed(const he_mesh *m, const he_marks *marks, start *out, he_error *err)
{
    const he_content *c = &m->c;
    if (c->boundary_halfedges == 0 && marks->locked[HE_VERTEX] == NULL) {
        return HE_OK;
    }
    out->fixed = he_bits_new(c->vertices.issued);
    if (out->fixed == NULL) {
        return no_memory(m, err);
    }
    for (uint32_t v = 0; v < c->vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) &&
            (he_is_locked(marks, HE_VERTEX, v) || has_one_face(c, v))) {
            he_bits_set(out->fixed, v);
        }
    }
    return HE_OK;
}

static he_status find_features(const he_mesh *m, const he_marks *marks, start *out, he_error *err)
{
    if (marks->feature == NULL) {
        return HE_OK;
    }
    out->feature = he_bits_new(m->c.edges.issued);
    if (out->feature == NULL) {
        return no_memory(m, err);
    }
    for (uint32_t e = 0; e < m->c.edges.issued; e++) {
        if (he_edge_is_live(m, (he_edge){e}) && he_is_feature(marks, (he_edge){e})) {
            he_bits_set(out->feature, e);
        }
    }
    return HE_OK;
}

static void count_sharp(const he_mesh *m, start *out)
{
    he_sizes *sizes = &out->sizes;
    bool any = m->c.boundary_halfedges > 0 || out->feature != NULL;
    for (uint32_t e = 0; e < m->c.edges.issued && any; e++) {
        bool live = he_edge_is_live(m, (he_edge){e});
        bool boundary = live && he_is_boundary_edge(m, (he_edge){e});
        if (boundary || (live && out->feature != NULL && he_bits_get(out->feature, e))) {
            sizes->sharp++;
            sizes->sharp_sides += boundary ? 1 : 2;
        }
    }
}

static he_status count_polygons(const he_mesh *m, he_sizes *sizes, he_error *err)
{
    const he_content *c = &m->c;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < c->faces.issued && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f, c->faces.issued, err);
        uint32_t h = c->face_halfedge[f];
        if (h == HE_DEAD || c->next[c->next[c->next[h]]] == h) {
            continue;
        }
        sizes->polygons++;
        sizes->corners += he_face_degree(m, (he_face){f});
    }
    return status;
}

static he_sizes counts_of(const he_content *c)
{
    return (he_sizes){.vertices = c->vertices.issued,
                      .edges = c->edges.issued,
                      .faces = c->faces.issued,
                      .live_vertices = c->vertices.live,
                      .live_edges = c->edges.live,
                      .live_faces = c->faces.live,
                      .boundary = c->boundary_halfedges};
}

static he_status begin(const he_mesh *m, he_scheme scheme, start *out, he_error *err)
{
    const he_content *c = &m->c;
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    out->sizes = counts_of(c);
    he_status status = scheme == HE_LINEAR ? count_polygons(m, &out->sizes, err) : HE_OK;
    if (status == HE_OK) {
        status = find_features(m, &marks, out, err);
    }
    if (status == HE_OK && scheme != HE_LINEAR) {
        status = find_fixed(m, &marks, out, err);
    }
    if (status == HE_OK) {
        count_sharp(m, out);
    }
    return status;
}

static void add(he_sizes *sizes, uint64_t vertices, uint64_t edges, uint64_t faces)
{
    sizes->vertices += vertices;
    sizes->edges += edges;
    sizes->faces += faces;
    sizes->live_vertices += vertices;
    sizes->live_edges += edges;
    sizes->live_faces += faces;
}

/* Returns true if this step cuts sharp edges into three parts: the scheme sqrt3 does so in every
 * second step. */
static bool cuts_in_three(he_scheme scheme, unsigned step)
{
    return scheme == HE_SQRT3 && step % 2 == 1;
}

static he_sizes after(he_sizes s, he_scheme scheme, bool thirds)
{
    uint64_t edges = s.live_edges, faces = s.live_faces, corners = 2 * edges - s.boundary;
    uint64_t triangles = faces - s.polygons, halves = 2;
    switch (scheme) {
    case HE_LOOP:
        add(&s, edges, edges + 3 * faces, 3 * faces);
        break;
    case HE_CATMULL_CLARK:
        add(&s, edges + faces, edges + corners, corners - faces);
        break;
    case HE_LINEAR:
        add(&s, edges + s.polygons, edges + 3 * triangles + s.corners,
            3 * triangles + s.corners - s.polygons);
        s.polygons = s.corners;
        s.corners *= 4;
        break;
    case HE_SQRT3:
        if (thirds) {
            uint64_t centres = faces - s.sharp_sides;
            add(&s, 2 * s.sharp + centres, 2 * s.sharp + 2 * s.sharp_sides + 3 * centres,
                2 * faces);
        } else {
            add(&s, faces, 3 * faces, 2 * faces);
        }
        halves = thirds ? 3 : 1;
        break;
    }
    s.boundary *= halves;
    s.sharp *= halves;
    s.sharp_sides *= halves;
    return s;
}

static uint64_t rows_of(const he_sizes *s)
{
    return s->vertices + s->edges + s->faces;
}

/* Computes the sizes of the mesh after each step, or fails if a size is too large. A step
 * multiplies each size by at most seven, so 64 bits cannot overflow. Sizes within the limit fit
 * into 32-bit ids. */
_Static_assert(HE_SUBDIVIDE_ROWS < HE_MAX_ROWS,
               "HE_SUBDIVIDE_ROWS must be below the number of ids");
static he_status estimate(const he_sizes *first, he_scheme scheme, unsigned steps, he_sizes *out,
                          he_error *err)
{
    he_sizes s = *first;
    for (unsigned i = 0; i < steps; i++) {
        s = after(s, scheme, cuts_in_three(scheme, i));
        if (rows_of(&s) > HE_SUBDIVIDE_ROWS) {
            return he_fail_plain(err, HE_LIMIT,
                                 "after step %u of the subdivision the mesh would have %llu "
                                 "vertices, edges and faces; at most %llu are allowed",
                                 i + 1, (unsigned long long)rows_of(&s),
                                 (unsigned long long)HE_SUBDIVIDE_ROWS);
        }
        out[i] = s;
    }
    return HE_OK;
}

he_status he_subdivide_fits(const he_mesh *m, he_scheme scheme, unsigned steps, he_error *err)
{
    he_sizes sizes = counts_of(&m->c), unused[HE_SUBDIVIDE_STEPS];
    assert(steps >= 1 && steps <= HE_SUBDIVIDE_STEPS);
    return estimate(&sizes, scheme, steps, unused, err);
}

/* --- locked elements --- */

static he_status require_unlocked(const he_mesh *m, const start *at, he_error *err)
{
    he_marks marks;
    he_status status = HE_OK;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    for (uint32_t e = 0; e < m->c.edges.issued && status == HE_OK; e++) {
        he_edge edge = {e};
        if (!he_edge_is_live(m, edge) || he_is_boundary_edge(m, edge) ||
            (at->feature != NULL && he_bits_get(at->feature, e))) {
            continue;
        }
        status = he_require_unlocked(&marks, HE_EDGE, e, err);
        for (unsigned side = 0; side < 2 && status == HE_OK; side++) {
            he_face f = he_face_of(m, he_edge_halfedge(edge, side));
            status = he_require_unlocked(&marks, HE_FACE, f.i, err);
        }
    }
    return status;
}

/* --- a step --- */

static void clear_step(he_subdivide_step *s)
{
    he_mem_free(s->edge_rank);
    he_mem_free(s->face_rank);
    he_mem_free(s->sharp);
    he_mem_free(s->degree);
    he_mem_free(s->centre);
    he_mem_free(s->spoke);
    he_mem_free(s->third);
    he_mem_free(s->vertex_from);
    he_mem_free(s->edge_from);
    he_mem_free(s->face_from);
    he_mem_free(s->corner_from);
}

/* Returns an array that maps the id of each live element to the number of live elements before it.
 * Returns NULL if no element is deleted, and also if memory is out; then *failed is set to true.
 * `link` has `stride` entries for each element, of which the first is HE_DEAD if the element is
 * deleted. */
static uint32_t *rank(const he_rows *rows, const uint32_t *link, uint32_t stride, bool *failed)
{
    if (rows->live == rows->issued) {
        return NULL;
    }
    uint32_t *ranks = he_mem_array(NULL, rows->issued, sizeof *ranks), live = 0;
    *failed |= ranks == NULL;
    for (uint32_t i = 0; i < rows->issued && ranks != NULL; i++) {
        ranks[i] = live;
        live += link[(size_t)stride * i] != HE_DEAD;
    }
    return ranks;
}

static void note_sharp(he_subdivide_step *s, uint32_t v)
{
    if (s->sharp[v] < 3) {
        s->sharp[v]++;
    }
}

static void count_edges(he_subdivide_step *s)
{
    const he_content *c = s->from;
    for (uint32_t e = 0; e < c->edges.issued; e++) {
        uint32_t a = c->origin[2 * e], b = c->origin[2 * e + 1];
        if (a == HE_DEAD) {
            continue;
        }
        s->degree[a]++;
        s->degree[b]++;
        if (s->sharp != NULL && he_subdivide_is_sharp(s, e)) {
            note_sharp(s, a);
            note_sharp(s, b);
        }
    }
    for (uint32_t v = 0; v < s->fixed_count && s->fixed != NULL && s->sharp != NULL; v++) {
        if (he_bits_get(s->fixed, v)) {
            s->sharp[v] = 3;
        }
    }
}

static he_status prepare(he_subdivide_step *s, he_error *err)
{
    const he_content *c = s->from;
    bool failed = false;
    s->edge_rank = rank(&c->edges, c->next, 2, &failed);
    s->face_rank = rank(&c->faces, c->face_halfedge, 1, &failed);
    if (s->scheme != HE_LINEAR) {
        bool smooth = c->boundary_halfedges == 0 && s->feature == NULL && s->fixed == NULL;
        s->degree = he_mem_zero(c->vertices.issued, sizeof *s->degree);
        s->sharp = smooth ? NULL : he_mem_zero(c->vertices.issued, sizeof *s->sharp);
        failed |= s->degree == NULL || (s->sharp == NULL && !smooth);
    }
    if (failed) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to check %u vertices", c->vertices.live);
    }
    if (s->scheme != HE_LINEAR) {
        count_edges(s);
    }
    return HE_OK;
}

/* Allocates memory for all elements of the finer mesh and sets their numbers; the links are written
 * later. */
static he_status make_room(he_mesh *fresh, const he_sizes *sizes, he_error *err)
{
    he_reservation need = {.vertices = (uint32_t)sizes->vertices,
                           .edges = (uint32_t)sizes->edges,
                           .faces = (uint32_t)sizes->faces};
    he_status status = he_reserve(fresh, need, err);
    if (status != HE_OK) {
        return status;
    }
    he_content *c = &fresh->c;
    c->vertices.issued = need.vertices;
    c->edges.issued = need.edges;
    c->faces.issued = need.faces;
    c->vertices.live = (uint32_t)sizes->live_vertices;
    c->edges.live = (uint32_t)sizes->live_edges;
    c->faces.live = (uint32_t)sizes->live_faces;
    c->boundary_halfedges = (uint32_t)sizes->boundary;
    return HE_OK;
}

/* The parameters of one step of a subdivision. */
typedef struct refinement {
    he_scheme scheme;
    /* true if the scheme is sqrt3 and this step cuts sharp edges into three parts */
    bool thirds;
    const he_sizes *sizes; /* sizes of the finer mesh */
    /* reported progress (0 to 1) when the step begins (`done`) and when it ends (`to`) */
    double done, to;
} refinement;

static he_status run_step(he_subdivide_step *s, he_mesh *fresh, const refinement *r, he_error *err)
{
    const double done = r->done, to = r->to;
    double share = s->from->column_count > 0 ? 0.3 : 0.6;
    he_status status = he_progress_phase(s->progress, "refining", done + share * (to - done), err);
    if (status == HE_OK) {
        status = make_room(fresh, r->sizes, err);
    }
    if (status == HE_OK) {
        status = prepare(s, err);
    }
    if (status == HE_OK) {
        status = he_subdivide_reserve_parents(s, err);
    }
    if (status == HE_OK) {
        status = s->scheme == HE_SQRT3 ? he_subdivide_sqrt3(s, err) : he_subdivide_split(s, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(s->progress, "placing vertices",
                                   s->from->column_count > 0 ? done + 0.5 * (to - done) : to, err);
    }
    if (status == HE_OK) {
        status = he_subdivide_place(s, s->from->position, s->to->position, err);
    }
    if (status == HE_OK && s->from->column_count > 0) {
        status = he_progress_phase(s->progress, "interpolating attributes", to, err);
    }
    return status == HE_OK ? he_subdivide_attributes(s, err) : status;
}

/* Makes the finer mesh from the coarser mesh, whose arrays are `c`, and finds the feature edges of
 * the finer mesh. */
static he_status step(const he_mesh *m, const he_content *c, const refinement *r, start *at,
                      he_mesh **out, he_error *err)
{
    he_mesh *fresh = he_mesh_new();
    he_subdivide_step s = {.from = c,
                           .to = fresh == NULL ? NULL : &fresh->c,
                           .progress = m->progress,
                           .scheme = r->scheme,
                           .thirds = r->thirds,
                           .polygonal = at->sizes.polygons > 0,
                           .feature = at->feature,
                           .fixed = at->fixed,
                           .fixed_count = m->c.vertices.issued};
    if (at->feature != NULL) {
        s.feature_next = he_bits_new(r->sizes->edges);
    }
    he_status status = fresh == NULL || (at->feature != NULL && s.feature_next == NULL)
                           ? no_memory(m, err)
                           : run_step(&s, fresh, r, err);
    clear_step(&s);
    if (status != HE_OK) {
        he_mem_free(s.feature_next);
        he_mesh_free(fresh);
        return status;
    }
    he_mem_free(at->feature);
    at->feature = s.feature_next;
    *out = fresh;
    return HE_OK;
}

static he_status run(he_mesh *m, he_scheme scheme, unsigned steps, start *at, const he_sizes *sizes,
                     he_error *err)
{
    he_mesh *now = NULL;
    he_status status = HE_OK;
    double total = 0;
    refinement r = {.scheme = scheme};
    for (unsigned i = 0; i < steps; i++) {
        total += (double)rows_of(&sizes[i]);
    }
    for (unsigned i = 0; i < steps && status == HE_OK; i++) {
        he_mesh *finer = NULL;
        r.thirds = cuts_in_three(scheme, i);
        r.sizes = &sizes[i];
        r.done = r.to;
        r.to += (double)rows_of(&sizes[i]) / total;
        status = step(m, now == NULL ? &m->c : &now->c, &r, at, &finer, err);
        if (status == HE_OK) {
            he_mesh_free(now);
            now = finer;
        }
    }
    if (status == HE_OK) {
        status = he_materials_copy(&m->c.materials, &now->c.materials, err);
    }
    if (status == HE_OK) {
        status = he_mesh_replace(m, now, HE_KEEPS_IDS, err);
    }
    if (status != HE_OK) {
        he_mesh_free(now);
    }
    return status;
}

he_status he_subdivide(he_mesh *m, he_scheme scheme, unsigned steps, he_subdivide_counts *counts,
                       he_error *err)
{
    assert(steps >= 1 && steps <= HE_SUBDIVIDE_STEPS);
    he_sizes sizes[HE_SUBDIVIDE_STEPS];
    start at = {.feature = NULL};
    he_status status = begin(m, scheme, &at, err);
    if (status == HE_OK) {
        status = estimate(&at.sizes, scheme, steps, sizes, err);
    }
    if (status == HE_OK && scheme == HE_SQRT3) {
        status = require_unlocked(m, &at, err);
    }
    if (status == HE_OK && m->c.faces.live > 0) {
        status = run(m, scheme, steps, &at, sizes, err);
    }
    for (unsigned i = 0; i < steps && status == HE_OK && counts != NULL; i++) {
        counts[i] =
            (he_subdivide_counts){(uint32_t)sizes[i].live_vertices, (uint32_t)sizes[i].live_edges,
                                  (uint32_t)sizes[i].live_faces};
    }
    he_mem_free(at.feature);
    he_mem_free(at.fixed);
    return status;
}
