#include "edit/whole/reverse.h"

#include "edit/piece/list.h"
#include "mesh/write.h"

/* The elements that are reversed. */
typedef struct part {
    he_ids vertices, edges, faces;
} part;

static void part_clear(part *p)
{
    he_ids_clear(&p->vertices);
    he_ids_clear(&p->edges);
    he_ids_clear(&p->faces);
}

/* Lists all elements to reverse if the whole mesh is reversed: all faces and edges, and all
 * vertices that have faces. */
static he_status take_all(const he_mesh *m, part *out, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t v = 0; status == HE_OK && v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) && !he_is_isolated(m, (he_vertex){v})) {
            status = he_ids_add(&out->vertices, v, err);
        }
    }
    for (uint32_t e = 0; status == HE_OK && e < m->c.edges.issued; e++) {
        status = he_progress_at(m->progress, e, m->c.edges.issued, err);
        if (status == HE_OK && he_edge_is_live(m, (he_edge){e})) {
            status = he_ids_add(&out->edges, e, err);
        }
    }
    for (uint32_t f = 0; status == HE_OK && f < m->c.faces.issued; f++) {
        if (he_face_is_live(m, (he_face){f})) {
            status = he_ids_add(&out->faces, f, err);
        }
    }
    return status;
}

/* Lists all elements to reverse if only some faces are reversed: these faces, their vertices and
 * their edges. Each element is listed once. */
static he_status take_listed(const he_mesh *m, const uint32_t *faces, size_t count, part *out,
                             he_error *err)
{
    he_status status = he_ids_reserve(&out->faces, count, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        out->faces.ids[out->faces.count++] = faces[i];
        he_halfedge first = he_face_halfedge(m, (he_face){faces[i]}), h = first;
        do {
            status = he_ids_add(&out->vertices, he_origin(m, h).i, err);
            if (status == HE_OK) {
                status = he_ids_add(&out->edges, he_edge_of(h).i, err);
            }
            h = he_next(m, h);
        } while (status == HE_OK && h.i != first.i);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&out->vertices, err);
    }
    return status == HE_OK ? he_ids_sort(&out->edges, err) : status;
}

static he_status check_edges(const he_mesh *m, const part *p, const uint64_t *chosen, he_error *err)
{
    for (size_t i = 0; i < p->edges.count; i++) {
        for (unsigned side = 0; side < 2; side++) {
            he_face f = he_face_of(m, he_edge_halfedge((he_edge){p->edges.ids[i]}, side));
            if (f.i != HE_NONE && !he_bits_get(chosen, f.i)) {
                return he_fail(err, HE_ORIENTATION, HE_EDGE, p->edges.ids[i],
                               "face %u shares edge %u with a face to reverse: list it too", f.i,
                               p->edges.ids[i]);
            }
        }
    }
    return HE_OK;
}

static he_status check_vertices(const he_mesh *m, const part *p, const uint64_t *chosen,
                                he_error *err)
{
    for (size_t i = 0; i < p->vertices.count; i++) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){p->vertices.ids[i]}), h = first;
        do {
            he_face f = he_face_of(m, h);
            if (f.i != HE_NONE && !he_bits_get(chosen, f.i)) {
                return he_fail(err, HE_BOWTIE, HE_VERTEX, p->vertices.ids[i],
                               "face %u shares vertex %u with a face to reverse: list it too", f.i,
                               p->vertices.ids[i]);
            }
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
    }
    return HE_OK;
}

static he_status check_whole(const he_mesh *m, const part *p, he_error *err)
{
    uint64_t *chosen = he_bits_new(m->c.faces.issued);
    if (chosen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory to check that the faces are whole components");
    }
    for (size_t i = 0; i < p->faces.count; i++) {
        he_bits_set(chosen, p->faces.ids[i]);
    }
    he_status status = check_edges(m, p, chosen, err);
    if (status == HE_OK) {
        status = check_vertices(m, p, chosen, err);
    }
    he_mem_free(chosen);
    return status;
}

/* Moves corner values around vertex v. The value of a corner is stored with the half-edge that
 * leaves the corner. The corner that h leaves is left by he_swing_ccw(h) after the reversal, so
 * each value moves to the next half-edge around v. Values of boundary half-edges move, too, so that
 * a second reversal restores all values. */
static void shift_corners(he_mesh *m, size_t slot, he_vertex v)
{
    const he_column *column = m->c.columns[slot];
    he_halfedge first = he_vertex_halfedge(m, v), to = first;
    unsigned char last[HE_COLUMN_ROW_BYTES], value[HE_COLUMN_ROW_BYTES];
    memcpy(last, he_column_value(column, first.i), column->row_bytes);
    for (;;) {
        he_halfedge from = he_next(m, he_twin(to));
        if (from.i == first.i) {
            break;
        }
        memcpy(value, he_column_value(column, from.i), column->row_bytes);
        he_set_attribute(m, slot, to.i, value);
        to = from;
    }
    he_set_attribute(m, slot, to.i, last);
}

static void negate(he_mesh *m, size_t slot, uint32_t row)
{
    const he_column *column = m->c.columns[slot];
    unsigned char value[HE_COLUMN_ROW_BYTES];
    memcpy(value, he_column_value(column, row), column->row_bytes);
    he_normal_negate(column, value);
    he_set_attribute(m, slot, row, value);
}

static void turn_values(he_mesh *m, const part *p)
{
    for (size_t slot = 0; slot < m->c.column_count; slot++) {
        const he_column *column = m->c.columns[slot];
        if (column == NULL) {
            continue;
        }
        bool normals = he_is_normal_column(column);
        for (size_t i = 0; column->domain == HE_HALFEDGE && i < p->vertices.count; i++) {
            shift_corners(m, slot, (he_vertex){p->vertices.ids[i]});
        }
        for (size_t i = 0; column->domain == HE_HALFEDGE && normals && i < p->edges.count; i++) {
            negate(m, slot, 2 * p->edges.ids[i]);
            negate(m, slot, 2 * p->edges.ids[i] + 1);
        }
        for (size_t i = 0; column->domain == HE_VERTEX && normals && i < p->vertices.count; i++) {
            negate(m, slot, p->vertices.ids[i]);
        }
        for (size_t i = 0; column->domain == HE_FACE && normals && i < p->faces.count; i++) {
            negate(m, slot, p->faces.ids[i]);
        }
    }
}

/* Reverses the half-edges h and t of an edge: face(h) becomes the old face(t), next(h) becomes the
 * old twin(prev(t)), and prev(h) becomes the old twin(next(t)); the links of t change in this way,
 * too. Only links of this edge are read, so the edges may be handled in any order. */
static void turn_edge(he_mesh *m, he_edge e)
{
    he_halfedge next[2], prev[2];
    he_face face[2];
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge t = he_edge_halfedge(e, 1 - side);
        next[side] = he_twin(he_prev(m, t));
        prev[side] = he_twin(he_next(m, t));
        face[side] = he_face_of(m, t);
    }
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side);
        he_set_next(m, h, next[side]);
        he_set_prev(m, h, prev[side]);
        he_set_face(m, h, face[side]);
    }
}

static void commit(he_mesh *m, const part *p)
{
    turn_values(m, p);
    for (size_t i = 0; i < p->vertices.count; i++) {
        he_vertex v = {p->vertices.ids[i]};
        if (he_is_boundary_vertex(m, v)) {
            he_set_vertex_halfedge(m, v, he_swing_ccw(m, he_vertex_halfedge(m, v)));
        }
    }
    for (size_t i = 0; i < p->faces.count; i++) {
        he_face f = {p->faces.ids[i]};
        he_set_face_halfedge(m, f, he_swing_ccw(m, he_face_halfedge(m, f)));
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        turn_edge(m, (he_edge){p->edges.ids[i]});
        he_progress_note(m->progress, i, p->edges.count);
    }
}

he_status he_reverse(he_mesh *m, const uint32_t *faces, size_t count, he_error *err)
{
    part p = {.vertices = {0}};
    he_status status = he_progress_phase(m->progress, "gathering", 0.4, err);
    if (status == HE_OK && faces == NULL) {
        status = take_all(m, &p, err);
    } else if (status == HE_OK) {
        status = he_list_require(m, HE_FACE, faces, count, HE_REPEATED_ELEMENT, err);
        if (status == HE_OK) {
            status = take_listed(m, faces, count, &p, err);
        }
        if (status == HE_OK) {
            status = check_whole(m, &p, err);
        }
    }
    he_reservation need = {.links = 6 * p.edges.count + p.vertices.count + p.faces.count};
    if (m->c.column_count > 0) {
        need.attributes = 4 * p.edges.count + p.vertices.count + p.faces.count;
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "reversing faces", 1, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, &p);
    }
    part_clear(&p);
    return status;
}
