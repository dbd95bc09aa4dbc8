#include "edit/border/loop_split.h"

#include "mesh/marks.h"
#include "mesh/write.h"

/* Returns the half-edge of edge e that leaves vertex v, or HE_NONE if v is no end of e. */
static he_halfedge leaving(const he_mesh *m, he_edge e, he_vertex v)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    if (he_origin(m, h).i == v.i) {
        return h;
    }
    return he_target(m, h).i == v.i ? he_twin(h) : (he_halfedge){HE_NONE};
}

/* Arranges half-edges of the three edges as a cycle, in which each half-edge ends where the next
 * one begins. cycle[0] is the half-edge with the even id of edges[0]. Refuses if there is no such
 * cycle. */
static he_status find_cycle(const he_mesh *m, const he_edge edges[3], he_halfedge cycle[3],
                            he_error *err)
{
    cycle[0] = he_edge_halfedge(edges[0], 0);
    he_vertex u = he_origin(m, cycle[0]), v = he_target(m, cycle[0]);
    for (unsigned k = 1; k < 3; k++) {
        cycle[1] = leaving(m, edges[k], v);
        cycle[2] =
            cycle[1].i == HE_NONE ? cycle[1] : leaving(m, edges[3 - k], he_target(m, cycle[1]));
        if (cycle[2].i != HE_NONE && he_target(m, cycle[2]).i == u.i) {
            return HE_OK;
        }
    }
    return he_fail(err, HE_NOT_A_CYCLE, HE_EDGE, edges[0].i,
                   "edges %u, %u and %u do not form a cycle", edges[0].i, edges[1].i, edges[2].i);
}

static he_status check_faces(const he_mesh *m, const he_halfedge cycle[3], he_error *err)
{
    uint32_t faces[6];
    for (unsigned i = 0; i < 6; i++) {
        faces[i] = he_face_of(m, i < 3 ? cycle[i] : he_twin(cycle[i - 3])).i;
        for (unsigned k = 0; k < i; k++) {
            if (faces[k] == faces[i]) {
                return he_fail(err, HE_SHARED_FACE, HE_FACE, faces[i],
                               "face %u has two of the given edges", faces[i]);
            }
        }
    }
    return HE_OK;
}

/* Returns a half-edge that leaves the origin of cycle[i] on the right side of the cycle: the first
 * one counter-clockwise after the edge along which the cycle arrives at this vertex. */
static he_halfedge first_on_right(const he_mesh *m, const he_halfedge cycle[3], unsigned i)
{
    return he_swing_ccw(m, he_twin(cycle[(i + 2) % 3]));
}

static he_status check_locks(const he_mesh *m, const he_halfedge cycle[3], he_error *err)
{
    he_marks marks;
    he_status status = HE_OK;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    for (unsigned i = 0; i < 3; i++) {
        he_halfedge h = first_on_right(m, cycle, i);
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, he_twin(cycle[i])).i, err);
        for (; status == HE_OK && h.i != cycle[i].i; h = he_swing_ccw(m, h)) {
            status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(h).i, err);
            if (status == HE_OK) {
                status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, h).i, err);
            }
        }
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

static he_status check(const he_mesh *m, const he_edge edges[3], he_halfedge cycle[3],
                       he_error *err)
{
    he_status status = HE_OK;
    for (unsigned i = 0; status == HE_OK && i < 3; i++) {
        status = he_mesh_require(m, HE_EDGE, edges[i].i, err);
    }
    if (status == HE_OK) {
        status = find_cycle(m, edges, cycle, err);
    }
    for (unsigned i = 0; status == HE_OK && i < 3; i++) {
        he_vertex v = he_origin(m, cycle[i]);
        if (he_is_boundary_vertex(m, v)) {
            status = he_fail(err, HE_BOUNDARY_VERTEX, HE_VERTEX, v.i,
                             "vertex %u is on the boundary", v.i);
        }
    }
    if (status == HE_OK) {
        status = check_faces(m, cycle, err);
    }
    return status == HE_OK ? check_locks(m, cycle, err) : status;
}

/* Makes vertex `to` the origin of all half-edges that leave the origin of cycle[i] on the right
 * side of the cycle. */
static void move_right(he_mesh *m, const he_halfedge cycle[3], unsigned i, he_vertex to)
{
    for (he_halfedge h = first_on_right(m, cycle, i); h.i != cycle[i].i; h = he_swing_ccw(m, h)) {
        he_set_origin(m, h, to);
    }
}

/* Replaces half-edge `twin` by `outer` in the loop of its face. `twin` is the twin of a half-edge
 * of the cycle; the caller then makes `twin` a side of the face that closes (caps) the hole. */
static void take_place(he_mesh *m, he_halfedge outer, he_halfedge twin)
{
    he_face f = he_face_of(m, twin);
    he_link(m, he_prev(m, twin), outer);
    he_link(m, outer, he_next(m, twin));
    he_set_face(m, outer, f);
    if (he_face_halfedge(m, f).i == twin.i) {
        he_set_face_halfedge(m, f, outer);
    }
    he_attributes_move(m, HE_HALFEDGE, outer.i, twin.i);
}

static void commit(he_mesh *m, const he_halfedge cycle[3], he_loop_parts *made)
{
    /* The half-edges of the new edges that belong to the second cap (face that closes the cut).
     * They run in the direction of the cycle. */
    he_halfedge inner[3];
    for (unsigned i = 0; i < 3; i++) {
        he_vertex u = he_origin(m, cycle[i]);
        made->vertices[i] = he_new_vertex(m);
        he_set_position(m, made->vertices[i], he_position(m, u));
        he_attributes_copy(m, HE_VERTEX, made->vertices[i].i, u.i);
        he_note_parent(m, HE_VERTEX, made->vertices[i].i, u.i);
    }
    for (unsigned i = 0; i < 3; i++) {
        he_edge e = he_edge_of(cycle[i]);
        made->edges[i] = he_new_edge(m);
        inner[i] = he_edge_halfedge(made->edges[i], cycle[i].i & 1);
        he_attributes_copy(m, HE_EDGE, made->edges[i].i, e.i);
        he_note_parent(m, HE_EDGE, made->edges[i].i, e.i);
    }
    /* The half-edges on the right side of the cycle are found by walking around its vertices. Their
     * origins must be changed before any other links, because the walk reads those links. */
    for (unsigned i = 0; i < 3; i++) {
        move_right(m, cycle, i, made->vertices[i]);
    }
    for (unsigned i = 0; i < 3; i++) {
        take_place(m, he_twin(inner[i]), he_twin(cycle[i]));
        he_attributes_copy(m, HE_HALFEDGE, inner[i].i, cycle[i].i);
    }
    for (unsigned k = 0; k < 2; k++) {
        made->faces[k] = he_new_face(m);
    }
    he_set_face_halfedge(m, made->faces[0], he_twin(cycle[0]));
    he_set_face_halfedge(m, made->faces[1], inner[0]);
    for (unsigned i = 0; i < 3; i++) {
        unsigned after = (i + 1) % 3;
        he_vertex u = he_origin(m, cycle[i]), v = made->vertices[i];
        he_set_face(m, he_twin(cycle[i]), made->faces[0]);
        he_link(m, he_twin(cycle[after]), he_twin(cycle[i]));
        he_set_face(m, inner[i], made->faces[1]);
        he_link(m, inner[i], inner[after]);
        he_set_origin(m, inner[i], v);
        he_set_origin(m, he_twin(inner[i]), made->vertices[after]);
        he_set_vertex_halfedge(m, v, inner[i]);
        if (he_origin(m, he_vertex_halfedge(m, u)).i != u.i) {
            he_set_vertex_halfedge(m, u, cycle[i]);
        }
    }
}

he_status he_loop_split(he_mesh *m, he_edge a, he_edge b, he_edge c, he_loop_parts *out,
                        he_error *err)
{
    const he_edge edges[3] = {a, b, c};
    he_halfedge cycle[3];
    he_status status = check(m, edges, cycle, err);
    if (status != HE_OK) {
        return status;
    }
    he_reservation need = {.vertices = 3, .edges = 3, .faces = 2, .lineage = 6};
    for (unsigned i = 0; i < 3; i++) {
        /* Links written for each vertex of the cycle: the origins of half-edges that leave it, the
         * next and prev links of two neighbours, the stored half-edge of a face, three links of a
         * cap, and the half-edge that the vertex stores. */
        need.links += (size_t)he_vertex_degree(m, he_origin(m, cycle[i])) + 7;
    }
    status = he_reserve(m, need, err);
    if (status == HE_OK) {
        /* Nothing below can fail. */
        he_loop_parts made;
        commit(m, cycle, &made);
        if (out != NULL) {
            *out = made;
        }
    }
    return status;
}
