#include "edit/whole/normals.h"

#include "mesh/write.h"

#include <math.h>

static bool is_normal(const he_column *column)
{
    return column != NULL && column->domain != HE_EDGE && column->domain != HE_MESH_KIND &&
           he_is_normal_column(column);
}

/* Computes the matrix that transforms normals: a positive multiple of the inverse transpose of the
 * map's linear part, made of its cofactors. Its entries are divided by the largest one first, so
 * that nothing overflows. Returns false if the linear part is zero or the identity. */
static bool find_cofactors(const double matrix[16], double k[9])
{
    double a[9], largest = 0, off = 0;
    for (int i = 0; i < 9; i++) {
        a[i] = matrix[4 * (i / 3) + i % 3];
        largest = fmax(largest, fabs(a[i]));
        off = fmax(off, fabs(a[i] - (i % 4 == 0)));
    }
    if (!(largest > 0) || !(off > 0)) {
        return false;
    }
    for (int i = 0; i < 9; i++) {
        a[i] /= largest;
    }
    for (int r = 0; r < 3; r++) {
        const double *p = a + 3 * ((r + 1) % 3), *q = a + 3 * ((r + 2) % 3);
        for (int c = 0; c < 3; c++) {
            int d = (c + 1) % 3, e = (c + 2) % 3;
            k[3 * r + c] = p[d] * q[e] - p[e] * q[d];
        }
    }
    double volume = a[0] * k[0] + a[1] * k[1] + a[2] * k[2];
    for (int i = 0; volume < 0 && i < 9; i++) {
        k[i] = -k[i];
    }
    return true;
}

static void turn_row(const he_normals *n, size_t slot, uint32_t row)
{
    const he_column *column = n->m->c.columns[slot];
    double v[3], w[3];
    float f[3];
    if (column->type == HE_FLOAT) {
        memcpy(f, he_column_value(column, row), sizeof f);
        v[0] = (double)f[0], v[1] = (double)f[1], v[2] = (double)f[2];
    } else {
        memcpy(v, he_column_value(column, row), sizeof v);
    }
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    for (int i = 0; i < 3; i++) {
        const double *k = n->k + 3 * i;
        w[i] = k[0] * (v[0] / largest) + k[1] * (v[1] / largest) + k[2] * (v[2] / largest);
    }
    /* A map that flattens the mesh makes very small components, whose squares would underflow. All
     * components are therefore divided by the largest one before the length is computed. */
    largest = fmax(fabs(w[0]), fmax(fabs(w[1]), fabs(w[2])));
    if (!(largest > 0)) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        w[i] /= largest;
    }
    double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int i = 0; i < 3; i++) {
        w[i] /= length;
        f[i] = (float)w[i];
    }
    he_set_attribute(n->m, slot, row, column->type == HE_FLOAT ? (const void *)f : (const void *)w);
}

static bool is_mapped(const he_normals *n, he_face f)
{
    he_halfedge first = he_face_halfedge(n->m, f), h = first;
    do {
        if (!he_bits_get(n->chosen, he_origin(n->m, h).i)) {
            return false;
        }
        h = he_next(n->m, h);
    } while (h.i != first.i);
    return true;
}

/* Counts the normals in one attribute column that the map changes. If `commit` is true, the
 * function also transforms them. */
static size_t each_row(const he_normals *n, size_t slot, bool commit)
{
    const he_mesh *m = n->m;
    he_kind domain = m->c.columns[slot]->domain;
    size_t rows = 0;
    uint32_t issued = n->vertices == NULL ? he_mesh_issued(m, domain) : 0;
    for (uint32_t row = 0; row < issued; row++) {
        if (he_mesh_is_live(m, domain, row)) {
            rows++;
            if (commit) {
                turn_row(n, slot, row);
            }
        }
    }
    for (size_t i = 0; n->vertices != NULL && i < n->count; i++) {
        he_vertex v = {n->vertices[i]};
        he_halfedge first = he_vertex_halfedge(m, v), h = first;
        if (domain == HE_VERTEX) {
            rows++;
            if (commit) {
                turn_row(n, slot, v.i);
            }
            continue;
        }
        while (h.i != HE_NONE) {
            he_face f = he_face_of(m, h);
            /* The walks around the vertices pass a face several times. Its normal is transformed
             * only when a walk reaches the half-edge that the face stores, so only once. */
            bool turns = domain == HE_HALFEDGE ||
                         (f.i != HE_NONE && he_face_halfedge(m, f).i == h.i && is_mapped(n, f));
            rows += turns;
            if (turns && commit) {
                turn_row(n, slot, domain == HE_HALFEDGE ? h.i : f.i);
            }
            h = he_swing_ccw(m, h);
            if (h.i == first.i) {
                break;
            }
        }
    }
    return rows;
}

he_status he_normals_init(he_normals *n, he_mesh *m, const double matrix[16],
                          const uint32_t *vertices, size_t count, size_t *words, he_error *err)
{
    *n = (he_normals){.m = m, .vertices = vertices, .count = count};
    *words = 0;
    bool any = false;
    for (size_t i = 0; i < m->c.column_count; i++) {
        any |= is_normal(m->c.columns[i]);
    }
    n->turns = any && find_cofactors(matrix, n->k);
    if (!n->turns) {
        return HE_OK;
    }
    if (vertices != NULL) {
        n->chosen = he_bits_new(m->c.vertices.issued);
        if (n->chosen == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for a set of vertices");
        }
        for (size_t i = 0; i < count; i++) {
            he_bits_set(n->chosen, vertices[i]);
        }
    }
    for (size_t i = 0; i < m->c.column_count; i++) {
        if (is_normal(m->c.columns[i])) {
            *words += each_row(n, i, false) * (m->c.columns[i]->row_bytes / 4);
        }
    }
    return HE_OK;
}

void he_normals_commit(const he_normals *n)
{
    for (size_t i = 0; n->turns && i < n->m->c.column_count; i++) {
        if (is_normal(n->m->c.columns[i])) {
            (void)each_row(n, i, true);
        }
    }
}

void he_normals_clear(he_normals *n)
{
    he_mem_free(n->chosen);
    n->chosen = NULL;
}
