#include "edit/whole/dual.h"

#include "edit/piece/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

/* The ids of the dual mesh: face f becomes vertex[f], edge e becomes edge[e], and vertex v becomes
 * face[v]. */
typedef struct rows {
    uint32_t *vertex, *edge, *face;
    /* the numbers of ids of each kind that were issued before the edit */
    uint32_t vertices, edges, faces;
} rows;

static void rows_clear(rows *r)
{
    he_mem_free(r->vertex);
    he_mem_free(r->edge);
    he_mem_free(r->face);
}

static he_status check_vertices(const he_mesh *m, he_error *err)
{
    for (uint32_t i = 0; i < m->c.vertices.issued; i++) {
        he_vertex v = {i};
        he_status status = he_progress_at(m->progress, i, m->c.vertices.issued, err);
        if (status != HE_OK) {
            return status;
        }
        if (!he_vertex_is_live(m, v)) {
            continue;
        }
        if (he_is_isolated(m, v)) {
            return he_fail(err, HE_ISOLATED_VERTEX, HE_VERTEX, i,
                           "vertex %u has no face, so its dual face would have no corner", i);
        }
        he_halfedge h = he_vertex_halfedge(m, v);
        if (he_swing_ccw(m, he_swing_ccw(m, h)).i == h.i) {
            return he_fail(err, HE_TOO_FEW_CORNERS, HE_VERTEX, i,
                           "vertex %u has two edges, so its dual face would have two corners", i);
        }
    }
    return HE_OK;
}

/* Checks that no two faces share two edges. For each edge, a face writes its own id into the array
 * entry of its neighbour across that edge. If the id is there already, the two faces share a second
 * edge. */
static he_status check_neighbours(const he_mesh *m, uint32_t *seen_by, he_error *err)
{
    for (uint32_t i = 0; i < m->c.faces.issued; i++) {
        seen_by[i] = HE_NONE;
    }
    for (uint32_t i = 0; i < m->c.faces.issued; i++) {
        he_status status = he_progress_at(m->progress, i, m->c.faces.issued, err);
        if (status != HE_OK) {
            return status;
        }
        if (!he_face_is_live(m, (he_face){i})) {
            continue;
        }
        he_halfedge first = he_face_halfedge(m, (he_face){i}), h = first;
        do {
            he_face g = he_face_of(m, he_twin(h));
            if (seen_by[g.i] == i) {
                return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(h).i,
                               "faces %u and %u share more than edge %u, so the dual would have "
                               "two edges between the same vertices",
                               i, g.i, he_edge_of(h).i);
            }
            seen_by[g.i] = i;
            h = he_next(m, h);
        } while (h.i != first.i);
    }
    return HE_OK;
}

static he_status check_locks(const he_mesh *m, he_error *err)
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        uint32_t issued = he_mesh_issued(m, kinds[k]);
        for (uint32_t i = 0; i < issued; i++) {
            /* A deleted element has the default value of the attribute `locked`, which may be true,
             * so deleted elements are skipped. */
            if (he_is_locked(&marks, kinds[k], i) && he_mesh_is_live(m, kinds[k], i)) {
                return he_require_unlocked(&marks, kinds[k], i, err);
            }
        }
    }
    return HE_OK;
}

static he_status check(const he_mesh *m, uint32_t *seen_by, he_error *err)
{
    for (uint32_t e = 0; m->c.boundary_halfedges > 0 && e < m->c.edges.issued; e++) {
        if (he_edge_is_live(m, (he_edge){e}) && he_is_boundary_edge(m, (he_edge){e})) {
            return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e,
                           "edge %u is on the boundary, and only a closed mesh has a dual", e);
        }
    }
    he_status status = check_vertices(m, err);
    if (status == HE_OK) {
        status = check_neighbours(m, seen_by, err);
    }
    return status == HE_OK ? check_locks(m, err) : status;
}

static void make_rows(he_mesh *m, rows *r)
{
    for (uint32_t i = 0; i < r->faces; i++) {
        if (he_face_is_live(m, (he_face){i})) {
            he_vertex v = he_new_vertex(m);
            he_set_position(m, v, he_loop_mean(m, he_face_halfedge(m, (he_face){i})));
            r->vertex[i] = v.i;
        }
    }
    for (uint32_t i = 0; i < r->edges; i++) {
        if (he_edge_is_live(m, (he_edge){i})) {
            he_edge e = he_new_edge(m);
            he_attributes_copy(m, HE_EDGE, e.i, i);
            he_note_parent(m, HE_EDGE, e.i, i);
            r->edge[i] = e.i;
        }
    }
    for (uint32_t i = 0; i < r->vertices; i++) {
        if (he_vertex_is_live(m, (he_vertex){i})) {
            r->face[i] = he_new_face(m).i;
        }
    }
}

/* Returns the dual half-edge of h. It runs from the new vertex of the face right of h to the new
 * vertex of the face left of h, and belongs to the new face of the origin of h. */
static he_halfedge star(const rows *r, he_halfedge h)
{
    return (he_halfedge){2 * r->edge[h.i >> 1] + (h.i & 1)};
}

static void link_rows(he_mesh *m, const rows *r)
{
    for (uint32_t i = 0; i < r->edges; i++) {
        he_progress_note(m->progress, i, r->edges);
        for (unsigned side = 0; side < 2 && he_edge_is_live(m, (he_edge){i}); side++) {
            he_halfedge h = he_edge_halfedge((he_edge){i}, side), s = star(r, h);
            he_set_next(m, s, star(r, he_swing_ccw(m, h)));
            he_set_prev(m, s, star(r, he_next(m, he_twin(h))));
            he_set_origin(m, s, (he_vertex){r->vertex[he_face_of(m, he_twin(h)).i]});
            he_set_face(m, s, (he_face){r->face[he_origin(m, h).i]});
        }
    }
    for (uint32_t i = 0; i < r->faces; i++) {
        if (he_face_is_live(m, (he_face){i})) {
            he_set_vertex_halfedge(m, (he_vertex){r->vertex[i]},
                                   star(r, he_twin(he_face_halfedge(m, (he_face){i}))));
        }
    }
    for (uint32_t i = 0; i < r->vertices; i++) {
        if (he_vertex_is_live(m, (he_vertex){i})) {
            he_set_face_halfedge(m, (he_face){r->face[i]},
                                 star(r, he_vertex_halfedge(m, (he_vertex){i})));
        }
    }
}

static void delete_old(he_mesh *m, const rows *r)
{
    for (uint32_t i = 0; i < r->vertices; i++) {
        if (he_vertex_is_live(m, (he_vertex){i})) {
            he_delete_vertex(m, (he_vertex){i});
        }
    }
    for (uint32_t i = 0; i < r->edges; i++) {
        if (he_edge_is_live(m, (he_edge){i})) {
            he_delete_edge(m, (he_edge){i});
        }
    }
    for (uint32_t i = 0; i < r->faces; i++) {
        if (he_face_is_live(m, (he_face){i})) {
            he_delete_face(m, (he_face){i});
        }
    }
}

he_status he_dual(he_mesh *m, he_error *err)
{
    rows r = {
        .vertices = m->c.vertices.issued, .edges = m->c.edges.issued, .faces = m->c.faces.issued};
    r.vertex = he_mem_array(NULL, r.faces + 1u, sizeof *r.vertex);
    r.edge = he_mem_array(NULL, r.edges + 1u, sizeof *r.edge);
    r.face = he_mem_array(NULL, r.vertices + 1u, sizeof *r.face);
    he_status status = HE_OK;
    if (r.vertex == NULL || r.edge == NULL || r.face == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the dual mesh");
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "checking", 0.4, err);
    }
    if (status == HE_OK) {
        status = check(m, r.vertex, err);
    }
    he_reservation need = {.vertices = m->c.faces.live,
                           .edges = m->c.edges.live,
                           .faces = m->c.vertices.live,
                           .deleted_vertices = m->c.vertices.live,
                           .deleted_edges = m->c.edges.live,
                           .deleted_faces = m->c.faces.live,
                           .lineage = m->c.edges.live};
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "making the dual", 1, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        make_rows(m, &r);
        link_rows(m, &r);
        delete_old(m, &r);
    }
    rows_clear(&r);
    return status;
}
