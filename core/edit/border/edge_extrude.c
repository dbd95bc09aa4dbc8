#include "edit/border/edge_extrude.h"

#include "edit/piece/list.h"
#include "edit/piece/point.h"
#include "edit/piece/ring.h"

void he_walls_clear(he_walls *walls)
{
    he_ids_clear(&walls->vertices);
    he_ids_clear(&walls->edges);
    he_ids_clear(&walls->faces);
}

/* A vertex at an end of extruded edges. `in` is the index in plan.chain of the half-edge that
 * arrives at the vertex, `out` the index of the half-edge that leaves it. An index is HE_NONE if
 * plan.chain has no such half-edge. */
typedef struct joint {
    uint32_t in, out;
} joint;

typedef struct plan {
    size_t count;
    he_ids chain; /* the boundary half-edge of each edge to extrude, in the caller's order */
    he_ids ends;  /* the vertices at the ends of these edges, by rising id */
    joint *joints;
} plan;

static void clear_plan(plan *p)
{
    he_ids_clear(&p->chain);
    he_ids_clear(&p->ends);
    he_mem_free(p->joints);
}

static he_halfedge at(const plan *p, uint32_t i)
{
    return (he_halfedge){p->chain.ids[i]};
}

/* Returns the index of vertex v in p->ends, which must contain v. */
static size_t place_of(const plan *p, he_vertex v)
{
    size_t low = 0, high = p->ends.count - 1;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (p->ends.ids[middle] < v.i) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static he_status plan_chain(const he_mesh *m, const uint32_t *edges, plan *p, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < p->count && status == HE_OK; i++) {
        he_edge e = {edges[i]};
        if (!he_is_boundary_edge(m, e)) {
            return he_fail(err, HE_NOT_BOUNDARY, HE_EDGE, e.i,
                           "edge %u is not on a boundary: it has two faces", e.i);
        }
        he_halfedge h = he_edge_halfedge(e, 0);
        h = he_is_boundary_halfedge(m, h) ? h : he_twin(h);
        status = he_ids_add(&p->chain, h.i, err);
        if (status == HE_OK) {
            status = he_ids_add(&p->ends, he_origin(m, h).i, err);
        }
        if (status == HE_OK) {
            status = he_ids_add(&p->ends, he_target(m, h).i, err);
        }
    }
    return status == HE_OK ? he_ids_sort(&p->ends, err) : status;
}

static he_status refuse_branch(const plan *p, uint32_t v, uint32_t i, uint32_t k, he_error *err)
{
    return he_fail(err, HE_BRANCHING_CHAIN, HE_VERTEX, v,
                   "the boundary half-edges of edges %u and %u both begin or both end at vertex "
                   "%u: extrude the two edges one after the other",
                   he_edge_of(at(p, i)).i, he_edge_of(at(p, k)).i, v);
}

static he_status plan_joints(const he_mesh *m, plan *p, he_error *err)
{
    p->joints = he_mem_array(NULL, p->ends.count, sizeof *p->joints);
    if (p->joints == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to extrude %zu edges", p->count);
    }
    for (size_t i = 0; i < p->ends.count; i++) {
        p->joints[i] = (joint){HE_NONE, HE_NONE};
    }
    for (uint32_t i = 0; i < p->count; i++) {
        joint *from = &p->joints[place_of(p, he_origin(m, at(p, i)))];
        joint *to = &p->joints[place_of(p, he_target(m, at(p, i)))];
        if (from->out != HE_NONE) {
            return refuse_branch(p, he_origin(m, at(p, i)).i, from->out, i, err);
        }
        if (to->in != HE_NONE) {
            return refuse_branch(p, he_target(m, at(p, i)).i, to->in, i, err);
        }
        from->out = i;
        to->in = i;
    }
    for (size_t i = 0; i < p->ends.count; i++) {
        if (p->joints[i].in == HE_NONE || p->joints[i].out == HE_NONE) {
            continue;
        }
        he_halfedge in = at(p, p->joints[i].in), out = at(p, p->joints[i].out);
        if (he_next(m, in).i != out.i && he_ring_fan_end(m, in).i == out.i) {
            uint32_t v = p->ends.ids[i];
            return he_fail(err, HE_CLOSED_FAN, HE_VERTEX, v,
                           "a closed fan of faces would form around vertex %u, which also belongs "
                           "to %u other fans of faces",
                           v, he_vertex_fans(m, (he_vertex){v}) - 1);
        }
    }
    return HE_OK;
}

static he_vec3 moved(const he_mesh *m, uint32_t v, he_vec3 by)
{
    he_vec3 p = he_position(m, (he_vertex){v});
    return (he_vec3){p.x + by.x, p.y + by.y, p.z + by.z};
}

static he_status make_plan(const he_mesh *m, const uint32_t *edges, he_vec3 by, plan *p,
                           he_error *err)
{
    he_status status = he_list_require(m, HE_EDGE, edges, p->count, HE_REPEATED_ELEMENT, err);
    if (status == HE_OK) {
        status = plan_chain(m, edges, p, err);
    }
    if (status == HE_OK) {
        status = plan_joints(m, p, err);
    }
    for (size_t i = 0; i < p->ends.count && status == HE_OK; i++) {
        if (!he_point_is_finite(moved(m, p->ends.ids[i], by))) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, p->ends.ids[i],
                           "the copy of vertex %u would have a position that is not finite",
                           p->ends.ids[i]);
        }
    }
    return status;
}

static he_status reserve(he_mesh *m, const plan *p, he_walls *made, he_error *err)
{
    if (p->count > HE_MAX_ROWS / 4) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED, "the mesh has no ids left to extrude %zu edges",
                             p->count);
    }
    uint32_t count = (uint32_t)p->count, ends = (uint32_t)p->ends.count;
    he_reservation need = {.vertices = ends, .edges = ends + count, .faces = count};
    need.links = 3 * p->count + (2 + HE_GAP_LINKS + HE_SETTLE_LINKS) * p->ends.count;
    need.attributes = p->count;
    need.lineage = p->ends.count + 2 * p->count;
    he_status status = he_ids_reserve(&made->vertices, ends, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&made->edges, count, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&made->faces, count, err);
    }
    return status == HE_OK ? he_reserve(m, need, err) : status;
}

/* The lowest ids of the new elements. Vertex i of plan.ends is copied to vertex `vertex` + i, and
 * edge `side` + i joins it to its copy. Edge i of plan.chain is copied to edge `far` + i. */
typedef struct fresh {
    uint32_t vertex, side, far;
} fresh;

/* Returns the half-edge that runs from vertex i of plan.ends to the copy of this vertex. */
static he_halfedge side_at(const fresh *new, size_t i)
{
    return he_edge_halfedge((he_edge){new->side + (uint32_t)i}, 0);
}

/* Returns the half-edge of the copy of edge i that belongs to a new quad. Its twin is on the
 * boundary, where the extruded edge was before. */
static he_halfedge far_at(const fresh *new, uint32_t i)
{
    return he_edge_halfedge((he_edge){new->far + i}, 0);
}

static void make_corner(he_mesh *m, const plan *p, const fresh *new, size_t i, he_vec3 by)
{
    he_vertex v = {p->ends.ids[i]}, w = {new->vertex + (uint32_t)i};
    he_halfedge up = side_at(new, i), down = he_twin(up);
    he_set_origin(m, up, v);
    he_set_origin(m, down, w);
    he_set_position(m, w, moved(m, v.i, by));
    he_attributes_copy(m, HE_VERTEX, w.i, v.i);
    he_note_parent(m, HE_VERTEX, w.i, v.i);
    joint j = p->joints[i];
    if (j.in != HE_NONE && j.out != HE_NONE) {
        he_ring_close_gap(m, at(p, j.in), at(p, j.out));
        he_link(m, he_twin(far_at(new, j.in)), he_twin(far_at(new, j.out)));
    } else if (j.in != HE_NONE) {
        he_link(m, down, he_next(m, at(p, j.in)));
        he_link(m, he_twin(far_at(new, j.in)), down);
        he_set_face(m, down, (he_face){HE_NONE});
    } else {
        he_link(m, he_prev(m, at(p, j.out)), up);
        he_link(m, up, he_twin(far_at(new, j.out)));
        he_set_face(m, up, (he_face){HE_NONE});
    }
    he_set_vertex_halfedge(m, w, j.out != HE_NONE ? he_twin(far_at(new, j.out)) : down);
}

static he_face make_wall(he_mesh *m, const plan *p, const fresh *new, uint32_t i)
{
    he_halfedge h = at(p, i), far = far_at(new, i), inner = he_twin(h);
    size_t from = place_of(p, he_origin(m, h)), to = place_of(p, he_target(m, h));
    he_halfedge up = side_at(new, to), down = he_twin(side_at(new, from));
    const he_halfedge loop[4] = {h, up, far, down};
    he_face f = he_new_face(m), beside = he_face_of(m, inner);
    he_set_origin(m, far, he_origin(m, he_twin(up)));
    he_set_origin(m, he_twin(far), he_origin(m, down));
    he_set_face(m, he_twin(far), (he_face){HE_NONE});
    for (unsigned k = 0; k < 4; k++) {
        he_link(m, loop[k], loop[(k + 1) % 4]);
        he_set_face(m, loop[k], f);
        /* Corners 0 and 3 of the quad are at the origin of h and at the copy of that vertex,
         * corners 1 and 2 at the target of h and at its copy. A copy gets the attributes of the
         * corner that the face beside h has at the original vertex. */
        he_attributes_copy(m, HE_HALFEDGE, loop[k].i, k % 3 == 0 ? he_next(m, inner).i : inner.i);
    }
    he_set_face_halfedge(m, f, h);
    he_attributes_copy(m, HE_FACE, f.i, beside.i);
    he_attributes_copy(m, HE_EDGE, he_edge_of(far).i, he_edge_of(h).i);
    he_note_parent(m, HE_FACE, f.i, beside.i);
    he_note_parent(m, HE_EDGE, he_edge_of(far).i, he_edge_of(h).i);
    return f;
}

static void commit(he_mesh *m, const plan *p, he_vec3 by, he_walls *made)
{
    fresh new = {m->c.vertices.issued, m->c.edges.issued, m->c.edges.issued};
    new.far += (uint32_t)p->ends.count;
    for (size_t i = 0; i < p->ends.count; i++) {
        made->vertices.ids[made->vertices.count++] = he_new_vertex(m).i;
        (void)he_new_edge(m);
    }
    for (size_t i = 0; i < p->count; i++) {
        made->edges.ids[made->edges.count++] = he_new_edge(m).i;
    }
    for (size_t i = 0; i < p->ends.count; i++) {
        make_corner(m, p, &new, i, by);
    }
    for (uint32_t i = 0; i < p->count; i++) {
        made->faces.ids[made->faces.count++] = make_wall(m, p, &new, i).i;
    }
    for (size_t i = 0; i < p->ends.count; i++) {
        he_ring_settle(m, (he_vertex){p->ends.ids[i]}, side_at(&new, i));
    }
}

he_status he_edge_extrude(he_mesh *m, const uint32_t *edges, size_t count, he_vec3 by,
                          he_walls *out, he_error *err)
{
    plan p = {.count = count};
    he_walls made = {.vertices = {0}};
    he_status status = make_plan(m, edges, by, &p, err);
    if (status == HE_OK) {
        status = reserve(m, &p, &made, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    /* Nothing below can fail. */
    commit(m, &p, by, &made);
    if (out != NULL) {
        *out = made;
        made = (he_walls){.vertices = {0}};
    }
out:
    he_walls_clear(&made);
    clear_plan(&p);
    return status;
}
