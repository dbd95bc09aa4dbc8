#include "algo/result_write.h"

#include "mesh/write.h"

#include <string.h>

static bool is_live(const he_mesh *m, he_kind kind, uint32_t row)
{
    return kind == HE_HALFEDGE ? he_edge_is_live(m, (he_edge){row >> 1})
                               : he_mesh_is_live(m, kind, row);
}

static void write_halfedge(he_mesh *m, const he_mesh *made, he_halfedge h)
{
    if (he_next(m, h).i != he_next(made, h).i) {
        he_set_next(m, h, he_next(made, h));
    }
    if (he_prev(m, h).i != he_prev(made, h).i) {
        he_set_prev(m, h, he_prev(made, h));
    }
    if (he_origin(m, h).i != he_origin(made, h).i) {
        he_set_origin(m, h, he_origin(made, h));
    }
    if (he_face_of(m, h).i != he_face_of(made, h).i) {
        he_set_face(m, h, he_face_of(made, h));
    }
}

static size_t count_halfedge(const he_mesh *m, const he_mesh *made, he_halfedge h)
{
    return (size_t)(he_next(m, h).i != he_next(made, h).i) +
           (he_prev(m, h).i != he_prev(made, h).i) + (he_origin(m, h).i != he_origin(made, h).i) +
           (he_face_of(m, h).i != he_face_of(made, h).i);
}

static bool differ(const void *a, const void *b, size_t bytes)
{
    return memcmp(a, b, bytes) != 0;
}

static bool has_moved(const he_mesh *m, const he_mesh *made, uint32_t v)
{
    return differ(&m->c.position[v], &made->c.position[v], sizeof *m->c.position);
}

/* Returns how many elements of a kind are deleted: those that live before and new ones, less those
 * that live afterwards. */
static size_t deleted(const he_rows *before, const he_rows *after)
{
    return (size_t)before->live + (after->issued - before->issued) - after->live;
}

static void count_words(const he_mesh *m, const he_mesh *made, he_reservation *need)
{
    need->vertices = made->c.vertices.issued - m->c.vertices.issued;
    need->edges = made->c.edges.issued - m->c.edges.issued;
    need->faces = made->c.faces.issued - m->c.faces.issued;
    need->deleted_vertices = deleted(&m->c.vertices, &made->c.vertices);
    need->deleted_edges = deleted(&m->c.edges, &made->c.edges);
    need->deleted_faces = deleted(&m->c.faces, &made->c.faces);
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(made, (he_vertex){v})) {
            need->links += m->c.vertex_halfedge[v] != made->c.vertex_halfedge[v];
            need->positions += has_moved(m, made, v);
        }
    }
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (he_edge_is_live(made, (he_edge){h >> 1})) {
            need->links += count_halfedge(m, made, (he_halfedge){h});
        }
    }
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        need->links += he_face_is_live(made, (he_face){f}) &&
                       m->c.face_halfedge[f] != made->c.face_halfedge[f];
    }
}

/* Counts the 4-byte words that differ between two values of an attribute. */
static size_t words_between(const unsigned char *a, const unsigned char *b, size_t bytes)
{
    size_t count = 0;
    for (size_t at = 0; at < bytes; at += 4) {
        count += differ(a + at, b + at, bytes - at < 4 ? bytes - at : 4);
    }
    return count;
}

/* Counts the words of an attribute's values that differ between the mesh and its changed copy. If
 * `to` is not NULL, also writes the differing values to the mesh `to`. */
static size_t each_value(const he_mesh *m, const he_mesh *made, size_t slot, he_mesh *to)
{
    const he_column *from = m->c.columns[slot], *column = made->c.columns[slot];
    size_t count = 0;
    for (uint32_t row = 0; row < column->rows; row++) {
        if (is_live(made, column->domain, row) &&
            differ(he_column_value(from, row), he_column_value(column, row), column->row_bytes)) {
            count += words_between(he_column_value(from, row), he_column_value(column, row),
                                   column->row_bytes);
            if (to != NULL) {
                he_set_attribute(to, slot, row, he_column_value(column, row));
            }
        }
    }
    return count;
}

static size_t each_column(const he_mesh *m, const he_mesh *made, he_mesh *to)
{
    size_t count = 0;
    for (size_t i = 0; i < m->c.column_count; i++) {
        if (m->c.columns[i] != NULL && m->c.columns[i]->domain != HE_MESH_KIND) {
            count += each_value(m, made, i, to);
        }
    }
    return count;
}

static void write_links(he_mesh *m, const he_mesh *made)
{
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (!he_vertex_is_live(made, (he_vertex){v})) {
            continue;
        }
        if (m->c.vertex_halfedge[v] != made->c.vertex_halfedge[v]) {
            he_set_vertex_halfedge(m, (he_vertex){v}, he_vertex_halfedge(made, (he_vertex){v}));
        }
        if (has_moved(m, made, v)) {
            he_set_position(m, (he_vertex){v}, he_position(made, (he_vertex){v}));
        }
    }
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (he_edge_is_live(made, (he_edge){h >> 1})) {
            write_halfedge(m, made, (he_halfedge){h});
        }
    }
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (he_face_is_live(made, (he_face){f}) &&
            m->c.face_halfedge[f] != made->c.face_halfedge[f]) {
            he_set_face_halfedge(m, (he_face){f}, he_face_halfedge(made, (he_face){f}));
        }
    }
}

static void delete_rows(he_mesh *m, const he_mesh *made)
{
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (he_face_is_live(m, (he_face){f}) && !he_face_is_live(made, (he_face){f})) {
            he_delete_face(m, (he_face){f});
        }
    }
    for (uint32_t e = 0; e < m->c.edges.issued; e++) {
        if (he_edge_is_live(m, (he_edge){e}) && !he_edge_is_live(made, (he_edge){e})) {
            he_delete_edge(m, (he_edge){e});
        }
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) && !he_vertex_is_live(made, (he_vertex){v})) {
            he_delete_vertex(m, (he_vertex){v});
        }
    }
}

/* Makes the elements that only the copy has. Their links are written afterwards like those of other
 * elements. */
static void make_new(he_mesh *m, const he_mesh *made)
{
    while (m->c.vertices.issued < made->c.vertices.issued) {
        (void)he_new_vertex(m);
    }
    while (m->c.edges.issued < made->c.edges.issued) {
        (void)he_new_edge(m);
    }
    while (m->c.faces.issued < made->c.faces.issued) {
        (void)he_new_face(m);
    }
}

he_status he_result_write(he_mesh *m, const he_mesh *made, size_t lineage, he_error *err)
{
    he_reservation need = {.lineage = lineage};
    count_words(m, made, &need);
    /* Changed attribute values are reserved as if they were links, by the number of changed words.
     * With need.attributes, he_reserve would allocate memory for all values of each attribute. */
    need.links += each_column(m, made, NULL);
    he_status status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    make_new(m, made);
    (void)each_column(m, made, m);
    write_links(m, made);
    delete_rows(m, made);
    return HE_OK;
}
