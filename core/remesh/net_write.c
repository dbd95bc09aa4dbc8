#include "remesh/net_write.h"

#include "geometry/scale.h"
#include "mesh/write.h"

#include <string.h>

/* The number of the next new element of each kind. */
typedef struct fresh {
    uint32_t vertices, edges, faces;
} fresh;

/* Gives new edges their final ids, in the order of triangles, and returns their number. Edges of
 * the mesh keep their ids. */
static uint32_t number_edges(he_net *n, uint32_t *final)
{
    uint32_t next = n->first_edge;
    for (uint32_t i = 0; i < n->edge_count; i++) {
        final[i] = HE_NONE;
    }
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        for (unsigned i = 0; i < 3 && !he_net_is_gone(n, t); i++) {
            uint32_t *h = &n->ids[t].halfedge[i], e = *h >> 1;
            if (e >= n->first_edge) {
                uint32_t *to = &final[e - n->first_edge];
                *to = *to == HE_NONE ? next++ : *to;
                *h = 2 * *to | (*h & 1);
            }
        }
    }
    return next - n->first_edge;
}

/* Puts the parents of new edges into the order of their final ids. */
static he_status sort_parents(he_net *n, const uint32_t *final, uint32_t count, he_error *err)
{
    uint32_t *parent = he_mem_array(NULL, (size_t)count + 1, sizeof *parent);
    if (parent == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %u new edges", count);
    }
    for (uint32_t i = 0; i < n->edge_count; i++) {
        if (final[i] != HE_NONE) {
            parent[final[i] - n->first_edge] = n->edge_parent[i];
        }
    }
    he_mem_free(n->edge_parent);
    n->edge_parent = parent;
    n->edge_count = count;
    n->edge_room = count + 1;
    return HE_OK;
}

static he_status give_ids(he_net *n, const he_mesh *m, fresh *out, he_error *err)
{
    uint32_t *final = he_mem_array(NULL, (size_t)n->edge_count + 1, sizeof *final);
    if (final == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the ids of %u edges", n->edge_count);
    }
    out->edges = number_edges(n, final);
    he_status status = sort_parents(n, final, out->edges, err);
    he_mem_free(final);
    out->vertices = out->faces = 0;
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        if (n->vertex_id[v] == HE_NONE && !he_net_has(n, v, HE_NET_DEAD)) {
            n->vertex_id[v] = m->c.vertices.issued + out->vertices++;
        }
    }
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        if (n->ids[t].face == HE_NONE && !he_net_is_gone(n, t)) {
            n->ids[t].face = m->c.faces.issued + out->faces++;
        }
    }
    return status;
}

/* Sets the values of a deleted element to the default. */
static void clear_values(he_content *c, he_kind domain, uint32_t row)
{
    for (size_t i = 0; i < c->column_count; i++) {
        he_column *column = c->columns[i];
        if (column != NULL && column->domain == domain && row < column->rows) {
            memcpy(he_column_row(column, row), column->fallback, column->row_bytes);
        }
    }
}

/* The faces and vertices of the ground, as bits by their ids in the mesh: that way they are visited
 * in the order of ids, in which their links are near in memory. */
typedef struct ground_bits {
    uint64_t *faces, *vertices;
} ground_bits;

static void clear_bits(ground_bits *b)
{
    he_mem_free(b->faces);
    he_mem_free(b->vertices);
    *b = (ground_bits){NULL, NULL};
}

static he_status find_bits(const he_ground *g, const he_mesh *m, ground_bits *out, he_error *err)
{
    out->faces = he_bits_new((size_t)m->c.faces.issued + 1);
    out->vertices = he_bits_new((size_t)m->c.vertices.issued + 1);
    if (out->faces == NULL || out->vertices == NULL) {
        clear_bits(out);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for marks of %u faces",
                             m->c.faces.issued);
    }
    for (uint32_t t = 0; t < g->triangle_count; t++) {
        he_bits_set(out->faces, g->face[t]);
    }
    for (uint32_t v = 0; v < g->vertex_count; v++) {
        he_bits_set(out->vertices, g->vertex[v]);
    }
    return HE_OK;
}

/* Returns true if the half-edge h was one of a face of the ground. */
static bool was_in(const ground_bits *b, const he_mesh *m, uint32_t h)
{
    return m->c.face[h] < HE_DEAD && he_bits_get(b->faces, m->c.face[h]);
}

/* Marks the elements of the ground as deleted, by the link that says so: those that the net still
 * has are written afterwards. */
static void mark_old(const ground_bits *b, const he_mesh *m, he_content *c)
{
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (was_in(b, m, h)) {
            c->next[h] = HE_DEAD;
            c->boundary_halfedges -= m->c.face[h ^ 1] == HE_NONE;
        }
    }
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (he_bits_get(b->faces, f)) {
            c->face_halfedge[f] = HE_DEAD;
        }
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_bits_get(b->vertices, v)) {
            c->vertex_halfedge[v] = HE_DEAD;
        }
    }
}

/* Deletes the elements of the ground that the net does not have any more. */
static void delete_old(const ground_bits *b, const he_mesh *m, he_content *c)
{
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (c->next[h] == HE_DEAD && c->origin[h] != HE_DEAD && was_in(b, m, h)) {
            he_clear_edge(c, h >> 1);
            clear_values(c, HE_EDGE, h >> 1);
            clear_values(c, HE_HALFEDGE, h);
            clear_values(c, HE_HALFEDGE, h ^ 1);
            c->edges.live--;
        }
    }
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (c->face_halfedge[f] == HE_DEAD && he_bits_get(b->faces, f)) {
            clear_values(c, HE_FACE, f);
            c->faces.live--;
        }
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (c->vertex_halfedge[v] == HE_DEAD && he_bits_get(b->vertices, v)) {
            he_clear_vertex(c, v);
            clear_values(c, HE_VERTEX, v);
            c->vertices.live--;
        }
    }
}

/* Where ids are in no spatial order, the links of the half-edges are fetched into the caches so
 * many triangles before they are written. */
enum { AHEAD = 8 };

static void fetch_ahead(const he_net *n, const he_content *c, uint32_t t)
{
    if (t + AHEAD < n->triangle_count && !he_net_is_gone(n, t + AHEAD)) {
        for (unsigned i = 0; i < 3; i++) {
            const uint32_t h = n->ids[t + AHEAD].halfedge[i];
            __builtin_prefetch(&c->next[h], 1);
            __builtin_prefetch(&c->prev[h], 1);
            __builtin_prefetch(&c->origin[h], 1);
            __builtin_prefetch(&c->face[h], 1);
        }
    }
}

/* Writes the links inside a triangle. */
static void write_triangle(const he_net *n, const he_mesh *m, he_content *c, uint32_t t)
{
    const uint32_t *h = n->ids[t].halfedge;
    uint32_t f = n->ids[t].face, stored = h[0];
    for (unsigned i = 0; i < 3; i++) {
        c->next[h[i]] = h[i == 2 ? 0 : i + 1];
        c->prev[h[i]] = h[i == 0 ? 2 : i - 1];
        c->origin[h[i]] = n->vertex_id[n->triangles[t].v[i]];
        c->face[h[i]] = f;
        if (f < m->c.faces.issued && m->c.face_halfedge[f] == h[i]) {
            stored = h[i];
        }
    }
    c->face_halfedge[f] = stored;
}

/* Returns the boundary half-edge that leaves vertex v, which is on a border of the net and has only
 * one fan. */
static uint32_t boundary_from(const he_net *n, uint32_t v)
{
    uint32_t c = n->corner[v];
    for (uint32_t at = he_net_ccw(n, c); at != HE_NONE; at = he_net_ccw(n, at)) {
        c = at;
    }
    return he_net_halfedge(n, he_net_prev(c)) ^ 1;
}

/* Writes the links of the boundary half-edge beside corner `at`, which has no twin; nothing if
 * there is a face outside the net. At vertices that have other fans the boundary links stay as they
 * were. */
static void write_border(const he_net *n, const he_mesh *m, he_content *c, uint32_t at)
{
    uint32_t b = he_net_halfedge(n, at) ^ 1, end = he_net_origin(n, at);
    uint32_t start = he_net_target(n, at);
    if (he_net_is_frozen(n, at) && m->c.face[b] != HE_NONE) {
        return;
    }
    c->origin[b] = n->vertex_id[start];
    c->face[b] = HE_NONE;
    c->boundary_halfedges++;
    if (!he_net_has(n, end, HE_NET_PART)) {
        uint32_t after = boundary_from(n, end);
        c->next[b] = after;
        c->prev[after] = b;
    }
}

static void write_vertex(const he_net *n, const he_mesh *m, he_content *c, uint32_t v)
{
    uint32_t id = n->vertex_id[v], h = he_net_halfedge(n, n->corner[v]);
    uint32_t old = id < m->c.vertices.issued ? m->c.vertex_halfedge[id] : HE_NONE;
    bool single = !he_net_has(n, v, HE_NET_PART);
    if (single && he_net_has(n, v, HE_NET_BORDER)) {
        h = boundary_from(n, v);
    } else if (old != HE_NONE && c->next[old] != HE_DEAD && c->origin[old] == id) {
        h = old;
    }
    c->vertex_halfedge[id] = h;
    if (he_net_has(n, v, HE_NET_MOVED)) {
        he_vec3 p = n->vertices[v].p;
        c->position[id] = (he_vec3){he_clamped(n->middle.x + ldexp(p.x, n->exponent)),
                                    he_clamped(n->middle.y + ldexp(p.y, n->exponent)),
                                    he_clamped(n->middle.z + ldexp(p.z, n->exponent))};
    }
}

static he_status make_copy(const he_mesh *m, const fresh *made, he_mesh **out, he_error *err)
{
    he_mesh *copy = NULL;
    he_reservation need = {.vertices = made->vertices, .edges = made->edges, .faces = made->faces};
    he_status status = he_mesh_copy_with_progress(m, m->progress, &copy, err);
    if (status == HE_OK) {
        status = he_reserve(copy, need, err);
    }
    if (status != HE_OK) {
        he_mesh_free(copy);
        return status;
    }
    for (uint32_t i = 0; i < made->vertices; i++) {
        (void)he_new_vertex(copy);
    }
    for (uint32_t i = 0; i < made->edges; i++) {
        (void)he_new_edge(copy);
    }
    for (uint32_t i = 0; i < made->faces; i++) {
        (void)he_new_face(copy);
    }
    *out = copy;
    return HE_OK;
}

he_status he_net_write(he_net *n, const he_ground *g, const he_mesh *m, he_mesh **out,
                       he_error *err)
{
    fresh made = {0, 0, 0};
    ground_bits old = {NULL, NULL};
    he_mesh *copy = NULL;
    he_status status = give_ids(n, m, &made, err);
    if (status == HE_OK) {
        status = find_bits(g, m, &old, err);
    }
    if (status == HE_OK) {
        status = make_copy(m, &made, &copy, err);
    }
    if (status != HE_OK) {
        clear_bits(&old);
        return status;
    }
    he_content *c = &copy->c;
    mark_old(&old, m, c);
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        fetch_ahead(n, c, t);
        if (!he_net_is_gone(n, t)) {
            write_triangle(n, m, c, t);
        }
    }
    for (uint32_t at = 0; at < 4 * n->triangle_count; at++) {
        if ((at & 3) != 3 && he_net_twin(n, at) == HE_NONE && !he_net_is_gone(n, at >> 2)) {
            write_border(n, m, c, at);
        }
    }
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        if (!he_net_has(n, v, HE_NET_DEAD)) {
            write_vertex(n, m, c, v);
        }
    }
    delete_old(&old, m, c);
    clear_bits(&old);
    *out = copy;
    return HE_OK;
}
