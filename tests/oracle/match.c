#include "oracle/oracle.h"

#include "mesh/check.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static bool differ(char text[OR_TEXT], const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool differ(char text[OR_TEXT], const char *format, ...)
{
    va_list list;
    va_start(list, format);
    (void)vsnprintf(text, OR_TEXT, format, list);
    va_end(list);
    return false;
}

/* Reads the corners of hedge's face f; returns false if the loop of its half-edges does not
 * close. */
static bool read_face(const he_mesh *m, uint32_t f, or_face *out)
{
    out->alive = out->locked = false;
    out->count = 0;
    if (f >= he_mesh_issued(m, HE_FACE) || !he_face_is_live(m, (he_face){f})) {
        return false;
    }
    he_halfedge first = he_face_halfedge(m, (he_face){f});
    he_halfedge h = first;
    do {
        if (out->count == OR_CORNERS || he_face_of(m, h).i != f) {
            return false;
        }
        out->v[out->count++] = he_origin(m, h).i;
        h = he_next(m, h);
    } while (h.i != first.i);
    out->alive = true;
    return true;
}

static bool adopt_faces(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    uint32_t made = he_mesh_issued(m, HE_FACE) - o->faces;
    uint32_t expected = o->fresh;
    for (uint32_t i = 0; i < o->cuts && !o->by_plane; i++) {
        expected += o->cut[i].was.count - (o->cut[i].id == OR_NONE ? 2 : 3);
    }
    if (o->bridging) {
        uint32_t n = o->bridge[0].count;
        uint32_t other = o->bridge[1].count;
        expected = n == other ? n : n + other;
    }
    if (made != expected && (!o->by_plane || o->cuts == 0)) {
        return differ(text, "%u faces were issued, not %u", made, expected);
    }
    for (uint32_t i = 0; i < o->cuts; i++) {
        uint32_t f = o->cut[i].id;
        if (f != OR_NONE && !read_face(m, f, &o->face[f])) {
            return differ(text, "face %u has no loop", f);
        }
    }
    for (uint32_t f = o->faces; f < o->faces + made; f++) {
        or_face there;
        if (!read_face(m, f, &there)) {
            return differ(text, "new face %u has no loop", f);
        }
        if (o->cuts > 0 || o->bridging) {
            o->face[f] = there;
            continue;
        }
        uint32_t k = f;
        while (k < o->faces + made && !or_same_cycle(&o->face[k], &there)) {
            k++;
        }
        if (k == o->faces + made) {
            return differ(text, "new face %u (%u, %u, %u ... %u corners) is not expected", f,
                          there.v[0], there.v[1], there.v[2], there.count);
        }
        or_face swap = o->face[f];
        o->face[f] = o->face[k];
        o->face[k] = swap;
    }
    o->faces += made;
    o->fresh = 0;
    return true;
}

/* Finds which of the two joined edges survives an edge_join. hedge may choose either one; the
 * surviving edge keeps its direction. */
static bool adopt_joined(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    bool alive[2];
    for (int i = 0; i < 2; i++) {
        alive[i] = he_mesh_is_live(m, HE_EDGE, o->joining[i]);
    }
    if (alive[0] == alive[1]) {
        return differ(text, "edges %u and %u: one must survive, the other go", o->joining[0],
                      o->joining[1]);
    }
    or_edge *stays = &o->edge[o->joining[alive[0] ? 0 : 1]];
    or_edge *goes = &o->edge[o->joining[alive[0] ? 1 : 0]];
    bool a_stays = o->vertex[stays->a].alive;
    uint32_t other = o->vertex[goes->a].alive ? goes->a : goes->b;
    *(a_stays ? &stays->b : &stays->a) = other;
    goes->alive = false;
    return true;
}

static bool adopt_edges(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    if (o->either && !adopt_joined(o, m, text)) {
        return false;
    }
    uint64_t wrong = or_derive(o);
    if (wrong != 0) {
        return differ(text, "the faces cannot be held: %#llx", (unsigned long long)wrong);
    }
    uint32_t expected = 0;
    for (uint32_t a = 0; a < o->vertices; a++) {
        for (uint32_t i = 0; i < or_degree(o, a); i++) {
            expected += o->around[a][i] < a && o->joined[a][o->around[a][i]] == OR_NONE;
        }
    }
    uint32_t made = he_mesh_issued(m, HE_EDGE) - o->edges;
    if (made != expected) {
        return differ(text, "%u edges were issued, not %u", made, expected);
    }
    for (uint32_t e = o->edges; e < o->edges + made; e++) {
        if (!he_edge_is_live(m, (he_edge){e})) {
            return differ(text, "new edge %u is dead", e);
        }
        uint32_t a = he_origin(m, (he_halfedge){2 * e}).i;
        uint32_t b = he_origin(m, (he_halfedge){2 * e + 1}).i;
        if (a >= o->vertices || b >= o->vertices || o->joined[a][b] != OR_NONE ||
            (o->left[a][b] == OR_NONE && o->left[b][a] == OR_NONE)) {
            return differ(text, "new edge %u joins %u and %u", e, a, b);
        }
        o->edge[e] = (or_edge){.alive = true, .a = a, .b = b};
        or_set_joined(o, e);
    }
    o->edges += made;
    return true;
}

/* Returns whether the part of a polygon with the corners i..k was cut into triangles, and counts
 * these. The triangle on the left of the side k->i has a third corner j between i and k; the parts
 * i..j and j..k must be cut into triangles, too. Each directed side belongs to one face only, so
 * the triangles are found without trying. */
static bool chain_is_cut(const or_mesh *o, const or_face *p, uint32_t i, uint32_t k,
                         uint32_t *triangles)
{
    if (k == i + 1) {
        return true;
    }
    uint32_t f = o->left[p->v[k]][p->v[i]];
    if (f == OR_NONE || o->face[f].count != 3) {
        return false;
    }
    uint32_t j = or_place(p, or_after(&o->face[f], p->v[i]));
    if (j == OR_NONE || j <= i || j >= k) {
        return false;
    }
    ++*triangles;
    return chain_is_cut(o, p, i, j, triangles) && chain_is_cut(o, p, j, k, triangles);
}

/* Returns 1 or -1 if a face has corners only above or only below the plane, else 0. */
static int side_of_part(const or_mesh *o, const or_face *f)
{
    bool above = false;
    bool below = false;
    for (uint32_t i = 0; i < f->count; i++) {
        above = above || o->distance[f->v[i]] > 0;
        below = below || o->distance[f->v[i]] < 0;
    }
    return above == below ? 0 : above ? 1 : -1;
}

/* Returns whether a face was cut correctly by the plane. Its parts are found by starting at the
 * part that keeps the id and crossing diagonals. Each part must be on one side of the plane and its
 * neighbours on the other side, and together they must have every side of the old face once. If
 * there is one diagonal less than there are parts, the parts form a disk. */
static bool parts_make_up(const or_mesh *o, uint32_t i, uint32_t first_new, uint32_t *made)
{
    const or_face *was = &o->cut[i].was;
    uint32_t part[OR_CORNERS];
    uint32_t parts = 1;
    uint32_t sides = 0;
    uint32_t diagonals = 0;
    part[0] = o->left[o->cut[i].start][or_after(was, o->cut[i].start)];
    if (part[0] != o->cut[i].id) {
        return false;
    }
    for (uint32_t k = 0; k < parts; k++) {
        const or_face *f = &o->face[part[k]];
        int side = side_of_part(o, f);
        if (side == 0 || (k > 0 && part[k] < first_new)) {
            return false;
        }
        for (uint32_t c = 0; c < f->count; c++) {
            uint32_t a = f->v[c];
            uint32_t b = or_after(f, a);
            if (or_place(was, a) == OR_NONE || or_place(was, b) == OR_NONE) {
                return false;
            }
            if (or_after(was, a) == b) {
                sides++;
                continue;
            }
            uint32_t beyond = o->left[b][a];
            if (o->distance[a] != 0 || o->distance[b] != 0 || beyond == OR_NONE ||
                side_of_part(o, &o->face[beyond]) != -side) {
                return false;
            }
            diagonals++;
            uint32_t known = 0;
            while (known < parts && part[known] != beyond) {
                known++;
            }
            if (known == parts) {
                if (parts == OR_CORNERS) {
                    return false;
                }
                part[parts++] = beyond;
            }
        }
    }
    *made += parts - 1;
    return parts > 1 && sides == was->count && diagonals == 2 * (parts - 1);
}

static bool adopt_parts(const or_mesh *o, uint32_t first_new, char text[OR_TEXT])
{
    uint32_t made = 0;
    for (uint32_t i = 0; i < o->cuts; i++) {
        if (!parts_make_up(o, i, first_new, &made)) {
            return differ(text, "face %u is not cut into parts on one side of the plane each",
                          o->cut[i].id);
        }
    }
    return made == o->faces - first_new
               ? true
               : differ(text, "%u faces are new, %u of them parts", o->faces - first_new, made);
}

static void settled(or_mesh *o)
{
    or_forget(o->before);
    o->before = NULL;
    o->cuts = 0;
    o->may = 0;
    o->either = o->by_plane = o->bridging = false;
}

void or_decline(or_mesh *o)
{
    or_lists *before = o->before;
    o->before = NULL;
    settled(o);
    if (before != NULL) {
        or_restore(o, before);
    }
}

bool or_adopt(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    uint32_t first_new = o->faces;
    if (o->by_plane) {
        or_plane_vertices(o);
    }
    if (he_mesh_issued(m, HE_VERTEX) != o->vertices || he_mesh_issued(m, HE_EDGE) > OR_EDGES ||
        he_mesh_issued(m, HE_FACE) > OR_FACES) {
        return differ(text, "%u vertices were issued, not %u", he_mesh_issued(m, HE_VERTEX),
                      o->vertices);
    }
    if (!adopt_faces(o, m, text) || !adopt_edges(o, m, text)) {
        return false;
    }
    if (o->by_plane && !adopt_parts(o, first_new, text)) {
        return false;
    }
    if (o->bridging && !or_strip_is_right(o, first_new)) {
        return differ(text, "the new faces do not make up a strip of least twist");
    }
    for (uint32_t i = 0; i < o->cuts && !o->by_plane; i++) {
        const or_face *was = &o->cut[i].was;
        uint32_t triangles = 0;
        if (!chain_is_cut(o, was, 0, was->count - 1, &triangles) || triangles != was->count - 2) {
            return differ(text, "the triangles do not make up the polygon %u, %u, %u ...",
                          was->v[0], was->v[1], was->v[2]);
        }
        uint32_t f = o->cut[i].id;
        uint32_t start = o->cut[i].start;
        if (f != OR_NONE && o->left[start][or_after(was, start)] != f) {
            return differ(text, "face %u does not keep the triangle of its half-edge from %u", f,
                          start);
        }
    }
    settled(o);
    return true;
}

static bool close_to(double a, double b)
{
    return fabs(a - b) <= 1e-9 * (1 + fabs(a));
}

static bool position_matches(or_vertex *v, he_vec3 p)
{
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
        return false;
    }
    bool same = false;
    if (v->inside) {
        same = p.x >= v->low.x - 1e-9 && p.x <= v->high.x + 1e-9 && p.y >= v->low.y - 1e-9 &&
               p.y <= v->high.y + 1e-9 && p.z >= v->low.z - 1e-9 && p.z <= v->high.z + 1e-9;
    } else if (v->near) {
        same = close_to(v->at.x, p.x) && close_to(v->at.y, p.y) && close_to(v->at.z, p.z);
    } else {
        same = v->at.x == p.x && v->at.y == p.y && v->at.z == p.z;
    }
    v->at = p;
    v->near = v->inside = false;
    return same;
}

static bool vertices_match(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    for (uint32_t v = 0; v < o->vertices; v++) {
        he_vertex vertex = {v};
        if (o->vertex[v].alive != he_vertex_is_live(m, vertex)) {
            return differ(text, "vertex %u should be %s", v, o->vertex[v].alive ? "alive" : "dead");
        }
        if (o->vertex[v].alive) {
            he_vec3 p = he_position(m, vertex);
            he_vec3 q = o->vertex[v].at;
            if (!position_matches(&o->vertex[v], p)) {
                return differ(text, "vertex %u is at %.17g, %.17g, %.17g, not %.17g, %.17g, %.17g",
                              v, p.x, p.y, p.z, q.x, q.y, q.z);
            }
        }
    }
    return true;
}

static bool edges_match(const or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    for (uint32_t e = 0; e < o->edges; e++) {
        if (o->edge[e].alive != he_edge_is_live(m, (he_edge){e})) {
            return differ(text, "edge %u should be %s", e, o->edge[e].alive ? "alive" : "dead");
        }
        if (!o->edge[e].alive) {
            continue;
        }
        uint32_t a = o->edge[e].a;
        uint32_t b = o->edge[e].b;
        he_halfedge h = {2 * e};
        he_halfedge t = {2 * e + 1};
        if (he_origin(m, h).i != a || he_origin(m, t).i != b) {
            return differ(text, "edge %u runs from %u to %u, not from %u to %u", e,
                          he_origin(m, h).i, he_origin(m, t).i, a, b);
        }
        if (he_face_of(m, h).i != o->left[a][b] || he_face_of(m, t).i != o->left[b][a]) {
            return differ(text, "edge %u has faces %u and %u, not %u and %u", e, he_face_of(m, h).i,
                          he_face_of(m, t).i, o->left[a][b], o->left[b][a]);
        }
    }
    return true;
}

static bool faces_match(const or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive != he_face_is_live(m, (he_face){f})) {
            return differ(text, "face %u should be %s", f, o->face[f].alive ? "alive" : "dead");
        }
        or_face there;
        if (o->face[f].alive && (!read_face(m, f, &there) || !or_same_cycle(&o->face[f], &there))) {
            return differ(text, "face %u has other corners than expected", f);
        }
    }
    return true;
}

/* Returns whether turning around the vertex v, from its stored half-edge on, visits each fan of
 * faces from its first neighbour to its last; the order of the fans is hedge's choice. */
static bool ring_matches(const or_mesh *o, const he_mesh *m, uint32_t v, char text[OR_TEXT])
{
    uint32_t degree = or_degree(o, v);
    he_halfedge first = he_vertex_halfedge(m, (he_vertex){v});
    if (degree == 0 || first.i == HE_NONE) {
        return degree == 0 && first.i == HE_NONE
                   ? true
                   : differ(text, "vertex %u of degree %u stores half-edge %u", v, degree, first.i);
    }
    if (or_on_boundary(o, v) != (he_face_of(m, first).i == HE_NONE)) {
        return differ(text, "vertex %u stores half-edge %u on the wrong side", v, first.i);
    }
    he_halfedge h = first;
    uint32_t seen = 0;
    do {
        uint32_t x = he_target(m, h).i;
        he_halfedge turned = he_swing_ccw(m, h);
        uint32_t y = he_target(m, turned).i;
        uint32_t next = or_turn(o, v, x);
        if (he_origin(m, h).i != v || o->joined[v][x] == OR_NONE ||
            (next != OR_NONE ? y != next : o->left[y][v] != OR_NONE)) {
            return differ(text, "ring of vertex %u turns from %u to %u", v, x, y);
        }
        h = turned;
        seen++;
    } while (h.i != first.i && seen <= degree);
    return seen == degree
               ? true
               : differ(text, "ring of vertex %u has %u half-edges, not %u", v, seen, degree);
}

bool or_matches(or_mesh *o, const he_mesh *m, char text[OR_TEXT])
{
    const uint32_t expected[6] = {o->vertices,         o->edges,         o->faces,
                                  or_live_vertices(o), or_live_edges(o), or_live_faces(o)};
    const uint32_t there[6] = {
        he_mesh_issued(m, HE_VERTEX), he_mesh_issued(m, HE_EDGE), he_mesh_issued(m, HE_FACE),
        he_mesh_vertices(m),          he_mesh_edges(m),           he_mesh_faces(m)};
    static const char *const what[6] = {"vertices issued", "edges issued", "faces issued",
                                        "vertices",        "edges",        "faces"};
    for (int i = 0; i < 6; i++) {
        if (expected[i] != there[i]) {
            return differ(text, "%u %s, not %u", there[i], what[i], expected[i]);
        }
    }
    he_problem problem;
    size_t problems = 0;
    if (he_check(m, &problem, 1, &problems, NULL) != HE_OK || problems > 0) {
        return differ(text, "I%d: %s", problem.rule, problem.text);
    }
    if (!vertices_match(o, m, text) || !edges_match(o, m, text) || !faces_match(o, m, text)) {
        return false;
    }
    uint32_t boundary = 0;
    for (uint32_t e = 0; e < o->edges; e++) {
        const or_edge *edge = &o->edge[e];
        boundary += edge->alive &&
                    (o->left[edge->a][edge->b] == OR_NONE || o->left[edge->b][edge->a] == OR_NONE);
    }
    if (boundary != he_mesh_boundary_halfedges(m)) {
        return differ(text, "%u boundary half-edges, not %u", he_mesh_boundary_halfedges(m),
                      boundary);
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive && !ring_matches(o, m, v, text)) {
            return false;
        }
    }
    return true;
}
