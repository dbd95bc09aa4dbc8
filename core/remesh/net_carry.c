/* net_carry.c - computes the attributes of new and changed elements from the old surface, by the
 * rules in remesh.h. */
#include "remesh/net_write.h"

#include "mesh/marks.h"
#include "mesh/write.h"

#include <string.h>

/* A point of the old surface: three elements of the mesh, and their weights. */
typedef struct source {
    uint32_t rows[3];
    double weights[3];
    size_t count;     /* elements whose weight is zero are left out */
    uint32_t nearest; /* the element with the greatest weight */
} source;

static source source_of(const uint32_t rows[3], const double weights[3])
{
    source s = {.count = 0, .nearest = rows[0]};
    double most = -1;
    for (unsigned i = 0; i < 3; i++) {
        if (weights[i] > most) {
            most = weights[i];
            s.nearest = rows[i];
        }
        if (weights[i] > 0) {
            s.rows[s.count] = rows[i];
            s.weights[s.count++] = weights[i];
        }
    }
    return s;
}

/* The work of he_net_carry. */
typedef struct carrier {
    const he_net *n;
    const he_ground *g;
    const he_mesh *m;
    he_content *c;
} carrier;

/* Writes the values of an element in all columns of its kind. If `keeps` is true, only interpolated
 * columns are written. */
static void write_values(const carrier *w, he_kind kind, uint32_t row, const source *s, bool keeps)
{
    for (size_t i = 0; i < w->c->column_count; i++) {
        he_column *to = w->c->columns[i];
        if (to == NULL || to->domain != kind || (kind == HE_VERTEX && he_is_mark(to, "locked"))) {
            continue;
        }
        const he_column *from = w->m->c.columns[i];
        if (to->rule == HE_INTERPOLATE) {
            he_column_blend(from, s->rows, s->weights, s->count, he_column_row(to, row));
        } else if (to->rule == HE_COPY && !keeps) {
            memcpy(he_column_row(to, row), he_column_value(from, s->nearest), to->row_bytes);
        }
    }
}

static bool has_moved(const he_net *n, uint32_t v)
{
    return he_net_has(n, v, HE_NET_MOVED);
}

static void carry_vertex(const carrier *w, uint32_t v)
{
    const he_net *n = w->n;
    he_ground_point at;
    uint32_t rows[3], id = n->vertex_id[v];
    he_ground_walk(w->g, he_net_place(n, v), n->ground[v], &at);
    for (unsigned i = 0; i < 3; i++) {
        rows[i] = w->g->vertex[w->g->triangles[at.triangle].v[i]];
    }
    source s = source_of(rows, at.weight);
    write_values(w, HE_VERTEX, id, &s, id < w->m->c.vertices.issued);
}

/* Returns true if a triangle is not one of the mesh that stays as it was. */
static bool has_changed(const carrier *w, uint32_t t)
{
    const he_net *n = w->n;
    const he_net_ids *ids = &n->ids[t];
    bool changed = ids->face >= w->m->c.faces.issued;
    for (unsigned i = 0; i < 3 && !changed; i++) {
        uint32_t v = n->triangles[t].v[i], h = ids->halfedge[i];
        changed = has_moved(n, v) || h >= 2 * w->m->c.edges.issued ||
                  w->m->c.face[h] != ids->face || w->m->c.origin[h] != n->vertex_id[v];
    }
    return changed;
}

/* On a line, a corner's values are those on the side of the line on which a point is that is a
 * little nearer to the middle of the face than the corner. */
static const double INWARD = 1.0 / 64;

/* Finds the point of the ground that is nearest to a corner, on its side of the lines. All corners
 * at a vertex that is not on a line get the same point, and those at a vertex of a line, on one
 * side of it, the same up to rounding: the values have no seams but those of before. */
static void find_place(const carrier *w, uint32_t c, he_vec3 middle, uint32_t from,
                       he_ground_point *at)
{
    const he_net *n = w->n;
    const uint32_t v = he_net_origin(n, c);
    he_vec3 p = he_net_place(n, v);
    if (!he_net_has(n, v, HE_NET_LINE | HE_NET_FIXED)) {
        he_ground_walk(w->g, p, n->ground[v], at);
        return;
    }
    he_vec3 in = he_vec3_add(p, he_vec3_scale(he_vec3_sub(middle, p), INWARD));
    he_ground_walk(w->g, in, from, at);
    he_ground_walk_beside(w->g, p, at->triangle, at);
}

static void carry_corner(const carrier *w, uint32_t c, he_vec3 middle, uint32_t from)
{
    he_ground_point at;
    uint32_t rows[3];
    find_place(w, c, middle, from, &at);
    uint32_t h = w->m->c.face_halfedge[w->g->face[at.triangle]];
    for (unsigned i = 0; i < 3; i++) {
        rows[i] = h;
        h = w->m->c.next[h];
    }
    source s = source_of(rows, at.weight);
    write_values(w, HE_HALFEDGE, he_net_halfedge(w->n, c), &s, false);
}

static void carry_face(const carrier *w, uint32_t t, bool corners)
{
    const he_net *n = w->n;
    const uint32_t *v = n->triangles[t].v;
    he_ground_point at;
    he_vec3 sum = he_vec3_add(he_vec3_add(he_net_place(n, v[0]), he_net_place(n, v[1])),
                              he_net_place(n, v[2]));
    he_vec3 middle = he_vec3_scale(sum, 1.0 / 3);
    he_ground_walk(w->g, middle, n->ground[v[0]], &at);
    uint32_t face = w->g->face[at.triangle];
    source s = {{face}, {1}, 1, face};
    write_values(w, HE_FACE, n->ids[t].face, &s, false);
    for (uint32_t c = 4 * t; c < 4 * t + 3 && corners; c++) {
        carry_corner(w, c, middle, at.triangle);
    }
}

/* Sets the values of new edges that are parts of old ones. */
static void carry_edges(const carrier *w)
{
    const he_net *n = w->n;
    for (size_t i = 0; i < w->c->column_count; i++) {
        he_column *to = w->c->columns[i];
        if (to == NULL || to->domain != HE_EDGE ||
            (to->rule == HE_DEFAULT && !he_is_mark(to, "feature"))) {
            continue;
        }
        const he_column *from = w->m->c.columns[i];
        for (uint32_t e = 0; e < n->edge_count; e++) {
            if (n->edge_parent[e] != HE_NONE) {
                memcpy(he_column_row(to, n->first_edge + e),
                       he_column_value(from, n->edge_parent[e]), to->row_bytes);
            }
        }
    }
}

he_status he_net_carry(const he_net *n, const he_ground *g, const he_mesh *m, he_mesh *made,
                       he_error *err)
{
    const carrier w = {n, g, m, &made->c};
    bool faces = he_has_columns(m, HE_FACE), corners = he_has_columns(m, HE_HALFEDGE);
    he_status status = HE_OK;
    if (he_has_columns(m, HE_VERTEX)) {
        for (uint32_t v = 0; v < n->vertex_count && status == HE_OK; v++) {
            status = he_progress_at(m->progress, v + 1, n->vertex_count, err);
            if (has_moved(n, v) && !he_net_has(n, v, HE_NET_DEAD)) {
                carry_vertex(&w, v);
            }
        }
    }
    for (uint32_t t = 0; t < n->triangle_count && (faces || corners) && status == HE_OK; t++) {
        status = he_progress_at(m->progress, t + 1, n->triangle_count, err);
        if (!he_net_is_gone(n, t) && has_changed(&w, t)) {
            carry_face(&w, t, corners);
        }
    }
    carry_edges(&w);
    return status;
}
