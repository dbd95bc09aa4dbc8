#include "mesh/check.h"

#include "mesh/content.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct checker {
    const he_mesh *m;
    he_problem *problems;
    size_t capacity, total;
    uint64_t *in_face; /* a bit for each half-edge, set when a walk around a face reaches it */
    uint64_t *in_ring; /* a bit for each half-edge, set when a walk around a vertex reaches it */
    /* The last walk that reached each vertex: 1 + the id of the face or vertex around which that
     * walk went; 0 if no walk has reached the vertex. */
    uint32_t *stamp;
} checker;

static void broken(checker *c, int rule, he_element at, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void broken(checker *c, int rule, he_element at, const char *format, ...)
{
    if (c->total < c->capacity) {
        he_problem *p = &c->problems[c->total];
        *p = (he_problem){.rule = rule, .kind = at.kind, .id = at.id};
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(p->text, sizeof p->text, format, arguments);
        va_end(arguments);
    }
    c->total++;
}

/* Returns true if the check must stop, because the caller wants only one problem and one
 * was found. */
static bool enough(const checker *c)
{
    return c->capacity == 1 && c->total > 0;
}

static bool halfedge_lives(const he_mesh *m, uint32_t h)
{
    return h < 2 * m->c.edges.issued && m->c.next[h & ~1u] != HE_DEAD;
}

static void check_edge_links(checker *c, uint32_t e)
{
    const he_content *k = &c->m->c;
    bool dead = k->next[2 * e] == HE_DEAD;
    for (uint32_t h = 2 * e; h <= 2 * e + 1; h++) {
        if (dead) {
            if (k->next[h] != HE_DEAD || k->prev[h] != HE_DEAD || k->origin[h] != HE_DEAD ||
                k->face[h] != HE_DEAD) {
                broken(c, 12, (he_element){HE_EDGE, e}, "deleted edge %u still has links", e);
            }
            continue;
        }
        if (!halfedge_lives(c->m, k->next[h])) {
            broken(c, 1, (he_element){HE_HALFEDGE, h}, "next %u of halfedge %u does not exist",
                   k->next[h], h);
        }
        if (!halfedge_lives(c->m, k->prev[h])) {
            broken(c, 1, (he_element){HE_HALFEDGE, h}, "prev %u of halfedge %u does not exist",
                   k->prev[h], h);
        }
        if (!he_vertex_is_live(c->m, (he_vertex){k->origin[h]})) {
            broken(c, 1, (he_element){HE_HALFEDGE, h}, "origin %u of halfedge %u does not exist",
                   k->origin[h], h);
        }
        if (k->face[h] != HE_NONE && !he_face_is_live(c->m, (he_face){k->face[h]})) {
            broken(c, 1, (he_element){HE_HALFEDGE, h}, "face %u of halfedge %u does not exist",
                   k->face[h], h);
        }
    }
}

/* Checks that every link leads to a live element: invariant I1, and the half-edges that vertices
 * and faces store. If this pass of the check finds a bad link, the later passes are skipped,
 * because they follow links. */
static void check_links(checker *c)
{
    const he_content *k = &c->m->c;
    for (uint32_t e = 0; e < k->edges.issued && !enough(c); e++) {
        check_edge_links(c, e);
    }
    for (uint32_t v = 0; v < k->vertices.issued && !enough(c); v++) {
        uint32_t h = k->vertex_halfedge[v];
        if (h != HE_DEAD && h != HE_NONE && !halfedge_lives(c->m, h)) {
            broken(c, 8, (he_element){HE_VERTEX, v}, "halfedge %u of vertex %u does not exist", h,
                   v);
        }
    }
    for (uint32_t f = 0; f < k->faces.issued && !enough(c); f++) {
        uint32_t h = k->face_halfedge[f];
        if (h != HE_DEAD && !halfedge_lives(c->m, h)) {
            broken(c, 6, (he_element){HE_FACE, f}, "halfedge %u of face %u does not exist", h, f);
        }
    }
}

static void check_halfedges(checker *c)
{
    const he_content *k = &c->m->c;
    for (uint32_t h = 0; h < 2 * k->edges.issued && !enough(c); h++) {
        if (k->next[h] == HE_DEAD) {
            continue;
        }
        uint32_t next = k->next[h];
        if (k->prev[next] != h) {
            broken(c, 2, (he_element){HE_HALFEDGE, h}, "prev of next of halfedge %u is %u", h,
                   k->prev[next]);
        }
        if (k->next[k->prev[h]] != h) {
            broken(c, 2, (he_element){HE_HALFEDGE, h}, "next of prev of halfedge %u is %u", h,
                   k->next[k->prev[h]]);
        }
        if (k->origin[next] != k->origin[h ^ 1]) {
            broken(c, 3, (he_element){HE_HALFEDGE, h},
                   "halfedge %u ends at vertex %u, but the next half-edge begins at vertex %u", h,
                   k->origin[h ^ 1], k->origin[next]);
        }
        if (k->face[next] != k->face[h]) {
            broken(c, 4, (he_element){HE_HALFEDGE, h},
                   "halfedge %u and its next %u have different faces", h, next);
        }
        if ((h & 1) == 0 && k->face[h] == HE_NONE && k->face[h + 1] == HE_NONE) {
            broken(c, 5, (he_element){HE_EDGE, h >> 1}, "edge %u has no face", h >> 1);
        }
        if ((h & 1) == 0 && k->origin[h] == k->origin[h + 1]) {
            broken(c, 10, (he_element){HE_EDGE, h >> 1}, "edge %u joins vertex %u to itself",
                   h >> 1, k->origin[h]);
        }
    }
}

static void check_face(checker *c, uint32_t f)
{
    const he_content *k = &c->m->c;
    uint32_t first = k->face_halfedge[f], h = first;
    if (k->face[first] != f) {
        broken(c, 6, (he_element){HE_FACE, f},
               "halfedge %u, which face %u stores, belongs to another face", first, f);
        return;
    }
    uint64_t degree = 0;
    do {
        if (he_bits_get(c->in_face, h)) {
            broken(c, 6, (he_element){HE_FACE, f}, "the loop of face %u does not close", f);
            return;
        }
        he_bits_set(c->in_face, h);
        uint32_t v = k->origin[h];
        if (c->stamp[v] == f + 1) {
            broken(c, 7, (he_element){HE_FACE, f}, "face %u uses vertex %u twice", f, v);
        }
        c->stamp[v] = f + 1;
        degree++;
        h = k->next[h];
    } while (h != first);
    if (degree < 3) {
        broken(c, 7, (he_element){HE_FACE, f}, "face %u has %u corners", f, (unsigned)degree);
    }
}

static void check_faces(checker *c)
{
    const he_content *k = &c->m->c;
    for (uint32_t f = 0; f < k->faces.issued && !enough(c); f++) {
        if (k->face_halfedge[f] != HE_DEAD) {
            check_face(c, f);
        }
    }
    for (uint32_t h = 0; h < 2 * k->edges.issued && !enough(c); h++) {
        if (k->next[h] != HE_DEAD && k->face[h] != HE_NONE && !he_bits_get(c->in_face, h)) {
            broken(c, 6, (he_element){HE_FACE, k->face[h]},
                   "halfedge %u is not in the loop of its face %u", h, k->face[h]);
        }
    }
}

static void check_ring(checker *c, uint32_t v)
{
    const he_content *k = &c->m->c;
    uint32_t first = k->vertex_halfedge[v], h = first;
    if (k->origin[first] != v) {
        broken(c, 8, (he_element){HE_VERTEX, v},
               "halfedge %u, which vertex %u stores, leaves vertex %u", first, v, k->origin[first]);
        return;
    }
    bool boundary = false;
    do {
        if (he_bits_get(c->in_ring, h) || k->origin[h] != v) {
            broken(c, 9, (he_element){HE_VERTEX, v},
                   "the half-edges around vertex %u do not lead back to the first", v);
            return;
        }
        he_bits_set(c->in_ring, h);
        boundary |= k->face[h] == HE_NONE;
        uint32_t target = k->origin[h ^ 1];
        if (target > v && c->stamp[target] == v + 1) {
            broken(c, 10, (he_element){HE_EDGE, h >> 1},
                   "edge %u is not the only edge between vertices %u and %u", h >> 1, v, target);
        }
        c->stamp[target] = v + 1;
        h = k->prev[h] ^ 1;
    } while (h != first);
    if (boundary && k->face[first] != HE_NONE) {
        broken(c, 8, (he_element){HE_VERTEX, v},
               "halfedge %u of boundary vertex %u is not on the boundary", first, v);
    }
}

static void check_vertices(checker *c)
{
    const he_content *k = &c->m->c;
    memset(c->stamp, 0, k->vertices.issued * sizeof *c->stamp);
    for (uint32_t v = 0; v < k->vertices.issued && !enough(c); v++) {
        uint32_t h = k->vertex_halfedge[v];
        if (h != HE_DEAD && h != HE_NONE) {
            check_ring(c, v);
        }
        he_vec3 p = k->position[v];
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
            broken(c, 11, (he_element){HE_VERTEX, v}, "the position of vertex %u is not finite", v);
        }
    }
    for (uint32_t h = 0; h < 2 * k->edges.issued && !enough(c); h++) {
        if (k->next[h] != HE_DEAD && !he_bits_get(c->in_ring, h)) {
            uint32_t v = k->origin[h];
            bool isolated = k->vertex_halfedge[v] == HE_NONE;
            broken(c, isolated ? 8 : 9, (he_element){HE_VERTEX, v},
                   "the half-edges around vertex %u do not include halfedge %u", v, h);
        }
    }
}

static void check_count(checker *c, const char *what, uint32_t stored, uint32_t counted)
{
    if (stored != counted) {
        broken(c, 12, (he_element){HE_MESH_KIND, 0},
               "the counter of the mesh says %u %s, but the mesh has %u", stored, what, counted);
    }
}

static void check_dead_attributes(checker *c, const he_column *column)
{
    for (size_t row = 0; row < column->rows && !enough(c); row++) {
        if (!he_mesh_is_live(c->m, column->domain, (uint32_t)row) &&
            memcmp(he_column_row(column, row), column->fallback, column->row_bytes) != 0) {
            broken(c, 12, (he_element){column->domain, (uint32_t)row},
                   "deleted %s %zu has a value of attribute %s", he_kind_name(column->domain), row,
                   column->name);
        }
    }
}

static void check_rows(checker *c)
{
    const he_content *k = &c->m->c;
    uint32_t vertices = 0, edges = 0, faces = 0, boundary = 0;
    for (uint32_t v = 0; v < k->vertices.issued; v++) {
        vertices += k->vertex_halfedge[v] != HE_DEAD;
        he_vec3 p = k->position[v];
        if (k->vertex_halfedge[v] == HE_DEAD && (p.x != 0 || p.y != 0 || p.z != 0)) {
            broken(c, 12, (he_element){HE_VERTEX, v}, "deleted vertex %u has a position", v);
        }
    }
    for (uint32_t h = 0; h < 2 * k->edges.issued; h++) {
        edges += (h & 1) == 0 && k->next[h] != HE_DEAD;
        boundary += k->face[h] == HE_NONE;
    }
    for (uint32_t f = 0; f < k->faces.issued; f++) {
        faces += k->face_halfedge[f] != HE_DEAD;
    }
    check_count(c, "live vertices", k->vertices.live, vertices);
    check_count(c, "live edges", k->edges.live, edges);
    check_count(c, "live faces", k->faces.live, faces);
    check_count(c, "boundary halfedges", k->boundary_halfedges, boundary);
    for (size_t i = 0; i < k->column_count && !enough(c); i++) {
        if (k->columns[i] != NULL && k->columns[i]->domain != HE_MESH_KIND) {
            check_dead_attributes(c, k->columns[i]);
        }
    }
}

static void check_materials(checker *c)
{
    const he_materials *table = &c->m->c.materials;
    for (size_t i = 0; i < table->count && !enough(c); i++) {
        const he_material *row = table->rows[i];
        if (row == NULL) {
            continue;
        }
        he_look look = row->look;
        if (he_materials_find(table, row->name, row->length) != i) {
            broken(c, 13, (he_element){HE_MESH_KIND, 0}, "two materials are called %.80s",
                   row->name);
        }
        if (row->length == 0 || he_look_clamp(&look)) {
            broken(c, 13, (he_element){HE_MESH_KIND, 0},
                   "material %zu has no name, or a number out of range", i);
        }
    }
}

he_status he_check(const he_mesh *mesh, he_problem *problems, size_t capacity, size_t *total,
                   he_error *err)
{
    return he_check_with_progress(mesh, NULL, problems, capacity, total, err);
}

he_status he_check_with_progress(const he_mesh *mesh, he_progress *progress, he_problem *problems,
                                 size_t capacity, size_t *total, he_error *err)
{
    /* The passes of the check, in the order in which they run. If the first pass finds a link to no
     * live element, all other passes are skipped, because they follow links. */
    static void (*const passes[])(checker * c) = {check_links,    check_halfedges, check_faces,
                                                  check_vertices, check_rows,      check_materials};
    enum { PASSES = sizeof passes / sizeof *passes };
    size_t halfedges = 2 * (size_t)mesh->c.edges.issued;
    he_status status = HE_OK;
    checker c = {.m = mesh, .problems = problems, .capacity = capacity};
    c.in_face = he_bits_new(halfedges);
    c.in_ring = he_bits_new(halfedges);
    c.stamp = he_mem_zero(mesh->c.vertices.issued, sizeof *c.stamp);
    if (c.in_face == NULL || c.in_ring == NULL || c.stamp == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to check the mesh");
        goto out;
    }
    for (size_t i = 0; i < PASSES && status == HE_OK && (i != 1 || c.total == 0); i++) {
        status = he_progress_step(progress, i, PASSES, err);
        if (status == HE_OK) {
            passes[i](&c);
        }
    }
    if (status == HE_OK) {
        *total = c.total;
    }
out:
    he_mem_free(c.in_face);
    he_mem_free(c.in_ring);
    he_mem_free(c.stamp);
    return status;
}
