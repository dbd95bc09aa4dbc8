#include "fill/patch.h"

#include "geometry/geometry.h"
#include "mesh/write.h"

void he_filled_holes_clear(he_filled_holes *filled)
{
    he_ids_clear(&filled->left);
}

he_fill he_fill_of(he_fill_method method)
{
    static const he_fill methods[] = {[HE_FILL_ALL_POLYGON] = HE_FILL_POLYGON,
                                      [HE_FILL_ALL_FAN] = HE_FILL_FAN,
                                      [HE_FILL_ALL_TRIANGULATE] = HE_FILL_TRIANGULATE};
    return methods[method];
}

/* --- all holes --- */

/* The work of he_fill_holes. */
typedef struct filling {
    he_mesh *m;
    const he_fill_holes_options *options;
    he_fill_shared shared;
    uint64_t *seen; /* the half-edges of holes that were looked at: a bit set */
    he_filled_holes done;
} filling;

/* What is known of a hole before it is filled. */
typedef struct hole {
    he_halfedge first;
    size_t edges;
    double size;   /* the diagonal of its box */
    bool one_face; /* one face is around all of it */
} hole;

/* Returns true if h is a half-edge of a hole that was not looked at yet. */
static bool is_new(const filling *w, he_halfedge h)
{
    return he_edge_is_live(w->m, he_edge_of(h)) && !he_bits_get(w->seen, h.i) &&
           he_is_boundary_halfedge(w->m, h);
}

/* Walks around a hole once, and marks its half-edges as seen. */
static hole look_at(const filling *w, he_halfedge h)
{
    const he_mesh *m = w->m;
    hole found = {.first = h, .one_face = true};
    const uint32_t face = he_face_of(m, he_twin(h)).i;
    he_vec3 low = he_position(m, he_origin(m, h)), high = low;
    he_halfedge k = h;
    do {
        const he_vec3 p = he_position(m, he_origin(m, k));
        he_bits_set(w->seen, k.i);
        low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
        found.one_face = found.one_face && he_face_of(m, he_twin(k)).i == face;
        found.edges++;
        k = he_next(m, k);
    } while (k.i != h.i);
    found.size = hypot(hypot(high.x - low.x, high.y - low.y), high.z - low.z);
    return found;
}

static bool is_large(const he_fill_holes_options *o, const hole *h)
{
    return (o->max_edges > 0 && h->edges > o->max_edges) ||
           (o->max_size > 0 && h->size > o->max_size);
}

static he_status fill_one(filling *w, const he_ids *loop, he_error *err)
{
    const he_fill_method method = w->options->method;
    he_status status =
        method == HE_FILL_ALL_SMOOTH
            ? he_fill_loop(w->m, loop, &w->options->smooth, &w->shared, NULL, err)
            : he_hole_fill(w->m, (he_halfedge){loop->ids[0]}, he_fill_of(method), NULL, err);
    if (status == HE_OK) {
        w->done.filled++;
        w->done.bend = fmax(w->done.bend, he_fill_bend(w->m, loop));
    }
    return status;
}

static he_status leave(filling *w, he_halfedge h, uint32_t *count, he_error *err)
{
    ++*count;
    return he_ids_add(&w->done.left, h.i, err);
}

/* Fills a hole, or counts why it is left. */
static he_status handle(filling *w, const hole *h, he_error *err)
{
    if (is_large(w->options, h)) {
        return leave(w, h->first, &w->done.large, err);
    }
    if (h->one_face) {
        return leave(w, h->first, &w->done.single, err);
    }
    he_ids loop = {0};
    he_error why = {.status = HE_OK};
    he_status status = he_hole_loop(w->m, h->first, &loop, &why);
    const bool touches = status == HE_REPEATED_CORNER;
    if (status == HE_OK) {
        status = fill_one(w, &loop, &why);
    }
    he_ids_clear(&loop);
    if (touches) {
        return leave(w, h->first, &w->done.touching, err);
    }
    if (status == HE_DOUBLED_EDGE) {
        return leave(w, h->first, &w->done.doubled, err);
    }
    if (status != HE_OK && err != NULL) {
        *err = why;
    }
    return status;
}

/* Refuses a length of edges that asks for too many faces, as far as the sizes of the holes tell,
 * before any of them is filled. */
static he_status foresee_all(const filling *w, he_error *err)
{
    const he_fill_holes_options *o = w->options;
    const uint32_t count = he_mesh_issued(w->m, HE_HALFEDGE);
    filling look = {.m = w->m, .options = o, .seen = he_bits_new((size_t)count + 1)};
    he_status status = look.seen == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory to look for holes")
                           : he_progress_phase(w->m->progress, "looking for holes", 0.02, err);
    double all = 0;
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        const he_halfedge h = {i};
        status = he_progress_at(w->m->progress, i, count, err);
        if (status == HE_OK && is_new(&look, h)) {
            const hole found = look_at(&look, h);
            uint64_t steps = is_large(o, &found) || found.one_face ? 0 : UINT64_MAX;
            const double faces = he_fill_foretell(w->m, h, &o->smooth, &steps);
            all += faces;
            status = he_fill_within(faces, o->smooth.edge_length, err);
        }
    }
    he_mem_free(look.seen);
    return status == HE_OK ? he_fill_within_all(all, w->shared.left, err) : status;
}

static he_status fill_all(filling *w, he_error *err)
{
    const uint32_t count = he_mesh_issued(w->m, HE_HALFEDGE);
    he_status status = he_progress_phase(w->m->progress, "filling", 1, err);
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        status = he_progress_at(w->m->progress, i, count, err);
        const he_halfedge h = {i};
        if (status == HE_OK && is_new(w, h)) {
            const hole found = look_at(w, h);
            status = handle(w, &found, err);
        }
    }
    return status;
}

he_status he_fill_holes(he_mesh *m, const he_fill_holes_options *options, he_filled_holes *out,
                        he_error *err)
{
    filling w = {.m = m, .options = options, .shared.left = he_fill_most(m)};
    he_bracket bracket;
    if (!isfinite(options->smooth.edge_length) || options->smooth.edge_length < 0 ||
        !isfinite(options->max_size) || options->max_size < 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "lengths must be finite and not below 0");
    }
    w.seen = he_bits_new((size_t)he_mesh_issued(m, HE_HALFEDGE) + 1);
    if (w.seen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for holes");
    }
    he_status status = he_edit_begin(m, &bracket, err);
    if (status == HE_OK) {
        const bool asked = options->method == HE_FILL_ALL_SMOOTH && options->smooth.edge_length > 0;
        status = asked ? foresee_all(&w, err) : HE_OK;
        status = he_edit_end(m, &bracket, status == HE_OK ? fill_all(&w, err) : status);
    }
    he_edge_lookup_clear(&w.shared.chords.lookup);
    he_mem_free(w.seen);
    if (status == HE_OK && out != NULL) {
        *out = w.done;
    } else {
        he_filled_holes_clear(&w.done);
    }
    return status;
}
