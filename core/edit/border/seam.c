#include "edit/border/seam.h"

#include "edit/piece/list.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"

void he_seam_clear(he_seam *seam)
{
    he_ids_clear(&seam->vertices);
    he_ids_clear(&seam->edges);
}

typedef struct plan {
    he_ids cuts;  /* the edges to cut, by rising id: new edge i is the copy of cuts[i] */
    he_ids ends;  /* the vertices at the ends of the cut edges, by rising id */
    he_ids parts; /* the first half-edge of each part of a fan of faces that gets a new vertex */
    size_t moved; /* number of half-edges, old and new, that will leave the new vertices */
    /* A bit for each cut edge: set if the edge has an interior end at which it is the only cut
     * edge. */
    uint64_t *once;
    bool marked;
    he_marks marks;
} plan;

static void clear_plan(plan *p)
{
    he_ids_clear(&p->cuts);
    he_ids_clear(&p->ends);
    he_ids_clear(&p->parts);
    he_mem_free(p->once);
}

/* Returns the index of edge e in the list of the edges to cut, or the length of this list if e is
 * not in it. */
static size_t find_cut(const plan *p, he_edge e)
{
    size_t low = 0, high = p->cuts.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (p->cuts.ids[middle] < e.i) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < p->cuts.count && p->cuts.ids[low] == e.i ? low : p->cuts.count;
}

static bool is_cut(const plan *p, he_halfedge h)
{
    return find_cut(p, he_edge_of(h)) < p->cuts.count;
}

/* A cut edge becomes two edges, one of which keeps the id. Returns true if this is the edge that
 * stays at the face left of h. */
static bool keeps_id(he_halfedge h)
{
    return h.i % 2 == 0;
}

/* Refuses if a face or an edge is locked in a part of a fan that gets a new vertex. The part
 * reaches counter-clockwise from half-edge `first` to half-edge `end`, which lies on the next cut
 * edge or on the boundary. */
static he_status check_part(const he_mesh *m, const plan *p, he_halfedge first, he_halfedge end,
                            he_error *err)
{
    he_status status = HE_OK;
    if (!is_cut(p, first) || keeps_id(first)) {
        status = he_require_unlocked(&p->marks, HE_EDGE, he_edge_of(first).i, err);
    }
    for (he_halfedge h = first; status == HE_OK && h.i != end.i;) {
        status = he_require_unlocked(&p->marks, HE_FACE, he_face_of(m, h).i, err);
        h = he_swing_ccw(m, h);
        /* If the edge of h is cut, this part of the fan may be on the side that gets the new edge.
         * A lock of the old edge does not matter then. */
        if (status == HE_OK && !(is_cut(p, h) && keeps_id(h))) {
            status = he_require_unlocked(&p->marks, HE_EDGE, he_edge_of(h).i, err);
        }
    }
    return status;
}

static he_status add_part(const he_mesh *m, plan *p, he_halfedge first, he_halfedge end,
                          he_error *err)
{
    for (he_halfedge h = first; h.i != end.i; h = he_swing_ccw(m, h)) {
        p->moved++;
    }
    p->moved++;
    he_status status = p->marked ? check_part(m, p, first, end, err) : HE_OK;
    return status != HE_OK ? status : he_ids_add(&p->parts, first.i, err);
}

/* Counts the cut edges of the fan that begins at `first`. Sets *lowest to the half-edge that leaves
 * the fan's vertex along the cut edge with the lowest id. */
static uint32_t count_cuts(const he_mesh *m, const plan *p, he_halfedge first, he_halfedge *lowest)
{
    uint32_t count = 0;
    he_halfedge h = first;
    do {
        if (is_cut(p, h)) {
            *lowest = count == 0 || h.i < lowest->i ? h : *lowest;
            count++;
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i && !he_is_boundary_halfedge(m, h));
    return count;
}

/* Plans into which parts the cuts divide a fan. `first` is the half-edge with which the fan begins;
 * in a closed fan it must be a half-edge of a cut edge. */
static he_status plan_fan(const he_mesh *m, plan *p, he_halfedge first, he_error *err)
{
    he_halfedge lowest = {HE_NONE};
    uint32_t count = count_cuts(m, p, first, &lowest);
    if (count == 0) {
        return HE_OK;
    }
    if (count == 1 && !he_is_boundary_vertex(m, he_origin(m, first))) {
        size_t i = find_cut(p, he_edge_of(first));
        if (he_bits_get(p->once, i)) {
            uint32_t e = he_edge_of(first).i;
            return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, e,
                           "after the cut both copies of edge %u would join vertices %u and %u: "
                           "cut further edges in the same operation",
                           e, he_origin(m, first).i, he_target(m, first).i);
        }
        he_bits_set(p->once, i);
        return HE_OK;
    }
    he_status status = HE_OK;
    he_halfedge from = first, h = first;
    do {
        h = he_swing_ccw(m, h);
        if (is_cut(p, h) || he_is_boundary_halfedge(m, h)) {
            he_halfedge side = keeps_id(lowest) ? from : h;
            if (side.i != lowest.i) {
                status = add_part(m, p, from, h, err);
            }
            from = h;
        }
    } while (status == HE_OK && h.i != first.i && !he_is_boundary_halfedge(m, h));
    return status;
}

static he_status plan_vertex(const he_mesh *m, plan *p, he_vertex v, he_error *err)
{
    he_halfedge stored = he_vertex_halfedge(m, v), h = stored;
    if (!he_is_boundary_vertex(m, v)) {
        while (!is_cut(p, h)) {
            h = he_swing_ccw(m, h);
        }
        return plan_fan(m, p, h, err);
    }
    he_status status = HE_OK;
    do {
        h = he_swing_ccw(m, h);
        status = plan_fan(m, p, h, err);
        while (!he_is_boundary_halfedge(m, h)) {
            h = he_swing_ccw(m, h);
        }
    } while (status == HE_OK && h.i != stored.i);
    return status;
}

static he_status plan_cut(const he_mesh *m, const uint32_t *edges, size_t count, plan *p,
                          he_error *err)
{
    he_status status = he_list_require(m, HE_EDGE, edges, count, HE_REPEATED_ELEMENT, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        he_edge e = {edges[i]};
        if (he_is_boundary_edge(m, e)) {
            return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i,
                           "edge %u is already on a boundary: it has only one face", e.i);
        }
        status = he_ids_add(&p->cuts, e.i, err);
        for (unsigned side = 0; side < 2 && status == HE_OK; side++) {
            status = he_ids_add(&p->ends, he_origin(m, he_edge_halfedge(e, side)).i, err);
        }
    }
    if (status == HE_OK) {
        status = he_ids_sort(&p->cuts, err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&p->ends, err);
    }
    if (status != HE_OK) {
        return status;
    }
    p->once = he_bits_new(count);
    if (p->once == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to cut %zu edges", count);
    }
    p->marked = he_marks_find(m, &p->marks);
    for (size_t i = 0; i < p->ends.count && status == HE_OK; i++) {
        status = plan_vertex(m, p, (he_vertex){p->ends.ids[i]}, err);
    }
    return status != HE_OK ? status : he_ids_sort(&p->parts, err);
}

enum { OPEN_LINKS = 8 + 2 * HE_SETTLE_LINKS, PART_LINKS = 4 + HE_SETTLE_LINKS };

/* Splits edge e into two edges with a hole of two sides between them: in the loop of its face,
 * half-edge 2e + 1 is replaced by a half-edge of the new edge. */
static he_edge open_edge(he_mesh *m, he_edge e)
{
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    he_edge made = he_new_edge(m);
    he_halfedge in = he_edge_halfedge(made, 0), out = he_twin(in);
    he_face f = he_face_of(m, t);
    he_set_origin(m, in, he_origin(m, t));
    he_set_origin(m, out, he_origin(m, h));
    he_link(m, he_prev(m, t), in);
    he_link(m, in, he_next(m, t));
    he_set_face(m, in, f);
    if (he_face_halfedge(m, f).i == t.i) {
        he_set_face_halfedge(m, f, in);
    }
    he_set_face(m, out, (he_face){HE_NONE});
    he_set_face(m, t, (he_face){HE_NONE});
    he_link(m, t, out);
    he_link(m, out, t);
    he_attributes_move(m, HE_HALFEDGE, in.i, t.i);
    he_attributes_copy(m, HE_EDGE, made.i, e.i);
    he_note_parent(m, HE_EDGE, made.i, e.i);
    he_ring_settle(m, he_origin(m, t), t);
    he_ring_settle(m, he_origin(m, out), out);
    return made;
}

/* Gives a new vertex to the part of a fan that begins with `first`. The new vertex is at the
 * position of the old one. */
static he_vertex split_fan(he_mesh *m, he_halfedge first)
{
    he_vertex v = he_origin(m, first), w = he_new_vertex(m);
    he_halfedge in = he_twin(first), out = first;
    he_set_origin(m, out, w);
    while (!he_is_boundary_halfedge(m, out)) {
        out = he_swing_ccw(m, out);
        he_set_origin(m, out, w);
    }
    he_halfedge after = he_next(m, in);
    he_link(m, he_prev(m, out), after);
    he_link(m, in, out);
    he_set_vertex_halfedge(m, w, out);
    he_set_position(m, w, he_position(m, v));
    he_attributes_copy(m, HE_VERTEX, w.i, v.i);
    he_note_parent(m, HE_VERTEX, w.i, v.i);
    he_ring_settle(m, v, after);
    return w;
}

he_status he_edge_cut(he_mesh *m, const uint32_t *edges, size_t count, he_seam *out, he_error *err)
{
    plan p = {.moved = 0};
    he_seam made = {.vertices = {0}};
    he_reservation need = {0};
    he_status status = plan_cut(m, edges, count, &p, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&made.vertices, p.parts.count, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&made.edges, count, err);
    }
    if (status == HE_OK && (p.parts.count > HE_MAX_ROWS || count > HE_MAX_ROWS)) {
        status = he_fail_plain(err, HE_IDS_EXHAUSTED, "the mesh has no ids left for %zu more edges",
                               count);
    }
    if (status == HE_OK) {
        need.vertices = (uint32_t)p.parts.count;
        need.edges = (uint32_t)count;
        need.links = count * OPEN_LINKS + p.parts.count * PART_LINKS + p.moved;
        need.lineage = count + p.parts.count;
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    /* Nothing below can fail. */
    for (size_t i = 0; i < count; i++) {
        made.edges.ids[made.edges.count++] = open_edge(m, (he_edge){p.cuts.ids[i]}).i;
    }
    for (size_t i = 0; i < p.parts.count; i++) {
        he_halfedge first = {p.parts.ids[i]};
        if (is_cut(&p, first) && !keeps_id(first)) {
            first = he_edge_halfedge((he_edge){made.edges.ids[find_cut(&p, he_edge_of(first))]}, 0);
        }
        made.vertices.ids[made.vertices.count++] = split_fan(m, first).i;
    }
    if (out != NULL) {
        *out = made;
        made = (he_seam){.vertices = {0}};
    }
out:
    he_seam_clear(&made);
    clear_plan(&p);
    return status;
}
