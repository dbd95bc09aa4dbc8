#include "edit/bevel/edge_bevel.h"

#include "edit/bevel/bevel.h"
#include "edit/piece/point.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"

void he_bevel_clear(he_bevel *bevel)
{
    he_ids_clear(&bevel->vertices);
    he_ids_clear(&bevel->edges);
}

/* One end of the edge that is bevelled. The edges that meet the bevelled edge there are cut: each
 * gets a new vertex near this end. */
typedef struct bevel_end {
    he_halfedge along; /* the half-edge of the bevelled edge that begins at this end */
    /* The half-edges, except `along`, that leave this end in the fan of faces that contains the
     * bevelled edge, counter-clockwise from `along`. */
    he_ids ring;
    /* If this end is on the boundary, the index in `ring` of the first half-edge after the hole; 0
     * if this end is an interior vertex. */
    size_t gap;
    /* The id of the new vertex on the edge of ring[0]; the new vertex on the edge of ring[i] has
     * the id `first` + i. */
    uint32_t first;
} bevel_end;

static he_status walk_end(const he_mesh *m, he_halfedge along, bevel_end *out, he_error *err)
{
    out->along = along;
    he_status status = HE_OK;
    for (he_halfedge h = he_swing_ccw(m, along); status == HE_OK && h.i != along.i;
         h = he_swing_ccw(m, h)) {
        status = he_ids_add(&out->ring, h.i, err);
        if (!he_is_boundary_halfedge(m, h)) {
            continue;
        }
        /* Half-edge h is the last one of its fan: counter-clockwise after it come a hole or other
         * fans. The walk continues at the first half-edge of the fan, which is found by turning
         * clockwise from the bevelled edge. */
        out->gap = out->ring.count;
        h = along;
        while (!he_is_boundary_halfedge(m, he_twin(h))) {
            h = he_next(m, he_twin(h));
        }
        for (; status == HE_OK && h.i != along.i; h = he_swing_ccw(m, h)) {
            status = he_ids_add(&out->ring, h.i, err);
        }
        return status;
    }
    return status;
}

static he_halfedge at(const bevel_end *end, size_t i)
{
    return (he_halfedge){end->ring.ids[i]};
}

static he_status check_end(const he_mesh *m, const bevel_end *end, he_error *err)
{
    if (end->ring.count < 2) {
        uint32_t v = he_origin(m, end->along).i;
        return he_fail(err, HE_LOW_DEGREE, HE_VERTEX, v, "vertex %u has only two edges", v);
    }
    return HE_OK;
}

static he_status check_locks(const he_mesh *m, const bevel_end *end, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_status status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(end->along).i, err);
    if (status == HE_OK) {
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, end->along).i, err);
    }
    if (status == HE_OK && end->gap == 0) {
        status = he_require_unlocked(&marks, HE_VERTEX, he_origin(m, end->along).i, err);
    }
    for (size_t i = 0; i < end->ring.count && status == HE_OK; i++) {
        status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(at(end, i)).i, err);
        if (status == HE_OK) {
            status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, at(end, i)).i, err);
        }
    }
    return status;
}

static he_status check(const he_mesh *m, he_edge e, double width, bevel_end ends[2], he_error *err)
{
    he_status status = he_mesh_require(m, HE_EDGE, e.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (he_is_boundary_edge(m, e)) {
        return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i, "edge %u has only one face", e.i);
    }
    if (!(width > 0)) {
        return he_fail(err, HE_BAD_VALUE, HE_EDGE, e.i, "the width must be above 0, not %g", width);
    }
    for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
        status = walk_end(m, he_edge_halfedge(e, i), &ends[i], err);
        if (status == HE_OK) {
            status = check_end(m, &ends[i], err);
        }
    }
    for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
        status = check_locks(m, &ends[i], err);
    }
    return status;
}

static he_status reserve(he_mesh *m, const bevel_end ends[2], he_bevel *made, he_error *err)
{
    size_t cuts = ends[0].ring.count + ends[1].ring.count;
    he_reservation need = {.faces = 1, .deleted_edges = 1};
    if (cuts > HE_MAX_ROWS / 4) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED,
                             "the mesh has no ids left for %zu more vertices", cuts);
    }
    need.vertices = need.edges = (uint32_t)cuts;
    for (unsigned i = 0; i < 2; i++) {
        need.edges += ends[i].gap > 0;
        need.deleted_vertices += ends[i].gap == 0;
    }
    /* An upper bound of the links written: three for each cut edge (its origin, next and prev),
     * three at each of the two faces beside the bevelled edge (next, prev and the stored
     * half-edge), and two more at each hole. */
    need.links = 3 * cuts + 2 * (3 + 2 + HE_SETTLE_LINKS);
    need.attributes = cuts;
    need.lineage = need.vertices + need.edges + 1;
    he_status status = he_ids_reserve(&made->vertices, cuts, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&made->edges, need.edges, err);
    }
    return status == HE_OK ? he_reserve(m, need, err) : status;
}

/* The new face that replaces the bevelled edge, while its sides are linked one after the other:
 * `first` and `last` are the first and the latest side, and `edges` lists all of them. */
typedef struct new_face {
    he_face face;
    he_halfedge first, last;
    he_ids *edges;
} new_face;

static void add_side(he_mesh *m, new_face *rim, he_halfedge h)
{
    if (rim->first.i == HE_NONE) {
        rim->first = h;
    } else {
        he_link(m, rim->last, h);
    }
    he_set_face(m, h, rim->face);
    rim->edges->ids[rim->edges->count++] = he_edge_of(h).i;
    rim->last = h;
}

/* Makes a side of the new face and returns its half-edge 2e, which belongs to that face. */
static he_halfedge new_edge(he_mesh *m, he_vertex from, he_vertex to)
{
    he_halfedge h = he_edge_halfedge(he_new_edge(m), 0);
    he_set_origin(m, h, from);
    he_set_origin(m, he_twin(h), to);
    return h;
}

static void descend(he_mesh *m, he_edge e, he_edge from)
{
    he_attributes_copy(m, HE_EDGE, e.i, from.i);
    he_note_parent(m, HE_EDGE, e.i, from.i);
}

static he_vertex cut_at(const bevel_end *end, size_t i)
{
    return (he_vertex){end->first + (uint32_t)i};
}

/* Returns the fraction of its length at which the edge of ring[i] is cut: 0 at the bevelled edge, 1
 * at the far end. */
static double part_of(const he_mesh *m, const bevel_end *end, size_t i, double width)
{
    return he_bevel_part(m, at(end, i), width);
}

static void make_cuts(he_mesh *m, bevel_end *end, double width, he_bevel *made)
{
    he_vertex v = he_origin(m, end->along);
    end->first = m->c.vertices.issued;
    for (size_t i = 0; i < end->ring.count; i++) {
        he_vertex c = he_new_vertex(m), x = he_target(m, at(end, i));
        double t = part_of(m, end, i, width);
        he_set_position(m, c, he_point_between(he_position(m, v), he_position(m, x), t));
        he_attributes_between(m, HE_VERTEX, c.i, v.i, x.i, t);
        he_note_parent(m, HE_VERTEX, c.i, v.i);
        made->vertices.ids[made->vertices.count++] = c.i;
    }
}

/* Makes a long side of the new face: the edge that replaces the bevelled edge in the face left of
 * h. It joins the first new vertex near the origin of h to the last new vertex near the target of
 * h. Returns its half-edge that belongs to the new face. */
static he_halfedge make_long_side(he_mesh *m, he_halfedge h, const bevel_end *from,
                                  const bevel_end *to, double width)
{
    he_halfedge in = new_edge(m, cut_at(to, to->ring.count - 1), cut_at(from, 0));
    he_halfedge out = he_twin(in), before = he_prev(m, h);
    he_face f = he_face_of(m, h);
    he_link(m, before, out);
    he_link(m, out, he_next(m, h));
    he_set_face(m, out, f);
    if (he_face_halfedge(m, f).i == h.i) {
        he_set_face_halfedge(m, f, out);
    }
    he_attributes_between(m, HE_HALFEDGE, out.i, h.i, before.i, part_of(m, from, 0, width));
    descend(m, he_edge_of(in), he_edge_of(h));
    return in;
}

/* Makes the two sides of the new face that border a hole, if an end v of the bevelled edge is on
 * the boundary. They join the last new vertex before the hole to v, and v to the first new vertex
 * after the hole. Half-edge `corner` leaves the last new vertex before the hole. */
static void make_stubs(he_mesh *m, const bevel_end *end, he_halfedge corner, new_face *rim)
{
    he_vertex v = he_origin(m, end->along);
    he_halfedge before = at(end, end->gap - 1), after = he_twin(at(end, end->gap));
    he_halfedge in = new_edge(m, cut_at(end, end->gap - 1), v);
    he_link(m, he_prev(m, before), he_twin(in));
    he_link(m, he_twin(in), before);
    he_set_face(m, he_twin(in), (he_face){HE_NONE});
    he_attributes_copy(m, HE_HALFEDGE, in.i, corner.i);
    descend(m, he_edge_of(in), he_edge_of(before));
    add_side(m, rim, in);

    in = new_edge(m, v, cut_at(end, end->gap));
    he_link(m, he_twin(in), he_next(m, after));
    he_link(m, after, he_twin(in));
    he_set_face(m, he_twin(in), (he_face){HE_NONE});
    he_attributes_copy(m, HE_HALFEDGE, in.i, end->along.i);
    descend(m, he_edge_of(in), he_edge_of(after));
    add_side(m, rim, in);
}

/* Makes the sides of the new face that join the new vertices near one end of the bevelled edge.
 * `corner` is a half-edge of a long side of the new face; it leaves the first of these vertices. */
static void make_short_sides(he_mesh *m, const bevel_end *end, double width, he_halfedge corner,
                             new_face *rim)
{
    for (size_t i = 0; i < end->ring.count; i++) {
        he_halfedge h = at(end, i);
        if (end->gap > 0 && i + 1 == end->gap) {
            make_stubs(m, end, corner, rim);
            he_set_origin(m, h, cut_at(end, i));
            he_set_vertex_halfedge(m, cut_at(end, i), h);
            continue;
        }
        he_halfedge in = {HE_NONE};
        if (i + 1 < end->ring.count) {
            he_halfedge before = he_twin(at(end, i + 1));
            in = new_edge(m, cut_at(end, i), cut_at(end, i + 1));
            corner = he_twin(in);
            he_link(m, before, corner);
            he_link(m, corner, h);
            he_set_face(m, corner, he_face_of(m, h));
            he_attributes_between(m, HE_HALFEDGE, corner.i, h.i, before.i,
                                  part_of(m, end, i + 1, width));
            add_side(m, rim, in);
        }
        he_attributes_between(m, HE_HALFEDGE, h.i, h.i, he_next(m, h).i, part_of(m, end, i, width));
        if (in.i != HE_NONE) {
            he_attributes_copy(m, HE_HALFEDGE, in.i, h.i);
        }
        he_set_origin(m, h, cut_at(end, i));
        /* The first new vertex after the hole must store a boundary half-edge (invariant I8 of
         * mesh.h). That half-edge belongs to the new edge between the new vertex and the end of the
         * bevelled edge. */
        bool stub = end->gap > 0 && i == end->gap;
        he_halfedge stored = stub ? he_next(m, he_twin(h)) : h;
        he_set_vertex_halfedge(m, cut_at(end, i), stored);
    }
}

static void commit(he_mesh *m, he_edge e, double width, bevel_end ends[2], he_bevel *made)
{
    const he_halfedge h = ends[0].along, back = ends[1].along;
    make_cuts(m, &ends[0], width, made);
    make_cuts(m, &ends[1], width, made);
    new_face rim = {he_new_face(m), {HE_NONE}, {HE_NONE}, &made->edges};
    made->face = rim.face;
    he_attributes_copy(m, HE_FACE, rim.face.i, he_face_of(m, h).i);
    he_note_parent(m, HE_FACE, rim.face.i, he_face_of(m, h).i);
    he_halfedge left = make_long_side(m, h, &ends[0], &ends[1], width);
    he_halfedge right = make_long_side(m, back, &ends[1], &ends[0], width);
    make_short_sides(m, &ends[0], width, he_twin(left), &rim);
    add_side(m, &rim, right);
    make_short_sides(m, &ends[1], width, he_twin(right), &rim);
    add_side(m, &rim, left);
    he_link(m, left, rim.first);
    he_set_face_halfedge(m, rim.face, rim.first);
    he_attributes_copy(m, HE_HALFEDGE, right.i, at(&ends[0], ends[0].ring.count - 1).i);
    he_attributes_copy(m, HE_HALFEDGE, left.i, at(&ends[1], ends[1].ring.count - 1).i);
    const he_vertex v[2] = {he_origin(m, h), he_origin(m, back)};
    he_delete_edge(m, e);
    for (unsigned i = 0; i < 2; i++) {
        if (ends[i].gap == 0) {
            he_delete_vertex(m, v[i]);
        } else {
            he_ring_settle(m, v[i], he_prev(m, at(&ends[i], ends[i].gap - 1)));
        }
    }
}

he_status he_edge_bevel(he_mesh *m, he_edge e, double width, he_bevel *out, he_error *err)
{
    bevel_end ends[2] = {{.gap = 0}, {.gap = 0}};
    he_bevel made = {.face = {HE_NONE}};
    he_status status = check(m, e, width, ends, err);
    if (status == HE_OK) {
        status = reserve(m, ends, &made, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, e, width, ends, &made);
        if (out != NULL) {
            *out = made;
            made = (he_bevel){.face = {HE_NONE}};
        }
    }
    he_bevel_clear(&made);
    he_ids_clear(&ends[0].ring);
    he_ids_clear(&ends[1].ring);
    return status;
}
