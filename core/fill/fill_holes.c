#include "fill/fill.h"
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

/* --- what is foreseen --- */

/* Returns the mean length of the boundary edges among a few thousand edges; that of all of these if
 * none is a boundary edge; 0 if there are no edges. */
static double sample_length(const he_mesh *m)
{
    enum { SAMPLES = 4096 };
    const uint32_t issued = he_mesh_issued(m, HE_EDGE), stride = issued / SAMPLES + 1;
    double sums[2] = {0, 0}, counts[2] = {0, 0};
    for (uint32_t e = 0; e < issued; e += stride) {
        if (he_edge_is_live(m, (he_edge){e})) {
            const bool boundary = he_is_boundary_edge(m, (he_edge){e});
            sums[boundary] += he_edge_length(m, (he_edge){e});
            counts[boundary]++;
        }
    }
    const int which = counts[1] > 0;
    return counts[which] > 0 ? sums[which] / counts[which] : 0;
}

/* Returns about how many faces fill a round hole, whose edges have the length 1. No surface of
 * least area is larger than that of a circle as long as its boundary, and a triangle of the wanted
 * length has the area sqrt(3) / 4 of its square. */
static double foretell_round(double edges, double edge_length)
{
    static const double OF_SQUARE = 1 / (4 * 3.14159265358979323846 * 0.43301270189221932);
    /* without a wanted length, edges grow inwards in a hole that would get more */
    static const double MANY = 50000, FOR_EACH_EDGE = 8;
    const double wanted = edge_length > 0 ? edge_length : 1;
    const double even = OF_SQUARE * (edges / wanted) * (edges / wanted);
    const double growing = fmax(MANY, FOR_EACH_EDGE * edges);
    return edges + (edge_length > 0 ? fmin(even, HE_FILL_FACES) : fmin(even, growing));
}

double he_fill_holes_foretell(const he_mesh *m, const he_fill_holes_options *options)
{
    const double edges = he_mesh_boundary_halfedges(m);
    const bool limited = options->max_edges > 0 && options->max_edges < edges;
    const double each = limited ? options->max_edges : edges;
    if (edges <= 0 || options->method != HE_FILL_ALL_SMOOTH) {
        return edges; /* no other method makes more faces than a hole has edges */
    }
    const double length = options->smooth.edge_length > 0 ? sample_length(m) : 0;
    const double wanted = length > 0 ? options->smooth.edge_length / length : 0;
    return fmin(edges / each * foretell_round(each, wanted), HE_FILL_ALL_FACES);
}

/* --- all holes --- */

/* The work of he_fill_holes. */
typedef struct filling {
    he_mesh *m;
    const he_fill_holes_options *options;
    he_rim_chords chords;
    uint64_t *seen; /* the half-edges of holes that were handled: a bit set */
    uint64_t faces; /* that were made */
    he_filled_holes done;
} filling;

/* What is known of a hole before it is filled. */
typedef struct hole {
    he_halfedge first;
    size_t edges;
    double size;   /* the diagonal of its box */
    bool one_face; /* one face is around all of it */
} hole;

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
    const uint32_t before = he_mesh_faces(w->m);
    if (w->faces > HE_FILL_ALL_FACES) {
        return he_fail_plain(err, HE_LIMIT, "the holes would be filled with more than %d faces",
                             (int)HE_FILL_ALL_FACES);
    }
    he_status status =
        method == HE_FILL_ALL_SMOOTH
            ? he_fill_loop(w->m, loop, &w->options->smooth, &w->chords, NULL, err)
            : he_hole_fill(w->m, (he_halfedge){loop->ids[0]}, he_fill_of(method), NULL, err);
    if (status == HE_OK) {
        w->done.filled++;
        w->faces += he_mesh_faces(w->m) - before;
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

static he_status fill_all(filling *w, he_error *err)
{
    const uint32_t count = he_mesh_issued(w->m, HE_HALFEDGE);
    he_status status = he_progress_phase(w->m->progress, "filling", 1, err);
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        status = he_progress_at(w->m->progress, i, count, err);
        const he_halfedge h = {i};
        if (status == HE_OK && he_edge_is_live(w->m, he_edge_of(h)) && !he_bits_get(w->seen, i) &&
            he_is_boundary_halfedge(w->m, h)) {
            const hole found = look_at(w, h);
            status = handle(w, &found, err);
        }
    }
    return status;
}

he_status he_fill_holes(he_mesh *m, const he_fill_holes_options *options, he_filled_holes *out,
                        he_error *err)
{
    filling w = {.m = m, .options = options};
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
        status = he_edit_end(m, &bracket, fill_all(&w, err));
    }
    he_edge_lookup_clear(&w.chords.lookup);
    he_mem_free(w.seen);
    if (status == HE_OK && out != NULL) {
        *out = w.done;
    } else {
        he_filled_holes_clear(&w.done);
    }
    return status;
}
