#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>

uint64_t or_vertex_add(or_mesh *o, he_vec3 at)
{
    (void)or_add_vertex(o, at);
    return 0;
}

uint64_t or_vertex_move(or_mesh *o, const uint32_t *v, const he_vec3 *to, uint32_t count)
{
    uint64_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool finite = isfinite(to[i].x) && isfinite(to[i].y) && isfinite(to[i].z);
        refused |= finite ? 0 : OR_BIT(HE_NOT_FINITE);
        refused |= o->vertex[v[i]].locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
    }
    for (uint32_t i = 0; i < count && refused == 0; i++) {
        o->vertex[v[i]].at = to[i];
        o->vertex[v[i]].near = true;
    }
    return refused;
}

/* Deletes faces, then the edges that have no faces left, then (unless isolated vertices are kept)
 * those of the faces' vertices that have no face left. */
static void delete_faces(or_mesh *o, const bool *gone, bool keep_isolated)
{
    bool corner[OR_VERTICES] = {false};
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && gone[f]) {
            o->face[f].alive = false;
            for (uint32_t i = 0; i < o->face[f].count; i++) {
                corner[o->face[f].v[i]] = true;
            }
        }
    }
    (void)or_derive(o);
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t a = o->edge[e].a;
        uint32_t b = o->edge[e].b;
        if (o->edge[e].alive && o->left[a][b] == OR_NONE && o->left[b][a] == OR_NONE) {
            o->edge[e].alive = false;
        }
    }
    for (uint32_t v = 0; v < o->vertices && !keep_isolated; v++) {
        if (corner[v] && or_degree(o, v) == 0) {
            o->vertex[v].alive = false;
        }
    }
}

static bool would_go(const bool *gone, uint32_t f)
{
    return f == OR_NONE || gone[f];
}

/* Returns whether a deleted face, or an edge or vertex that is deleted together with the faces, is
 * locked; the vertex `alone` is deleted, too. */
static uint64_t locked_among(const or_mesh *o, const bool *gone, uint32_t alone, bool keep_isolated)
{
    bool locked = alone != OR_NONE && o->vertex[alone].locked;
    for (uint32_t f = 0; f < o->faces; f++) {
        locked |= o->face[f].alive && gone[f] && o->face[f].locked;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t a = o->edge[e].a;
        uint32_t b = o->edge[e].b;
        locked |= o->edge[e].alive && o->edge[e].locked && would_go(gone, o->left[a][b]) &&
                  would_go(gone, o->left[b][a]);
    }
    for (uint32_t v = 0; v < o->vertices && !keep_isolated; v++) {
        if (o->vertex[v].alive && o->vertex[v].locked && or_degree(o, v) > 0) {
            bool last = true;
            for (uint32_t f = 0; f < o->faces; f++) {
                last &= !o->face[f].alive || or_place(&o->face[f], v) == OR_NONE || gone[f];
            }
            locked |= last;
        }
    }
    return locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
}

uint64_t or_vertex_delete(or_mesh *o, uint32_t v, bool keep_isolated)
{
    bool gone[OR_FACES] = {false};
    for (uint32_t f = 0; f < o->faces; f++) {
        gone[f] = o->face[f].alive && or_place(&o->face[f], v) != OR_NONE;
    }
    uint64_t refused = locked_among(o, gone, v, keep_isolated);
    if (refused != 0) {
        return refused;
    }
    delete_faces(o, gone, keep_isolated);
    o->vertex[v].alive = false;
    return 0;
}

uint64_t or_face_delete(or_mesh *o, const uint32_t *f, uint32_t count, bool keep_isolated)
{
    bool gone[OR_FACES] = {false};
    uint64_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        refused |= gone[f[i]] ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
        gone[f[i]] = true;
    }
    refused |= locked_among(o, gone, OR_NONE, keep_isolated);
    if (refused == 0) {
        delete_faces(o, gone, keep_isolated);
    }
    return refused;
}

/* Returns the first neighbour of the vertex v, counter-clockwise, in its only fan of faces, which
 * is open: no face comes before this neighbour. */
static uint32_t fan_start(const or_mesh *o, uint32_t v)
{
    for (uint32_t i = 0; i < or_degree(o, v); i++) {
        uint32_t x = o->around[v][i];
        if (o->left[v][x] != OR_NONE && o->left[x][v] == OR_NONE) {
            return x;
        }
    }
    return OR_NONE;
}

uint64_t or_vertex_split(or_mesh *o, uint32_t v, uint32_t left, uint32_t right, const he_vec3 *to)
{
    uint64_t refused = 0;
    if (or_fans(o, v) > 1) {
        refused |= OR_BIT(HE_BOWTIE);
    }
    if (left == right) {
        refused |= OR_BIT(left == OR_NONE ? HE_BAD_VALUE : HE_REPEATED_ELEMENT);
    }
    if ((left == OR_NONE || right == OR_NONE) && !or_on_boundary(o, v)) {
        refused |= OR_BIT(HE_NOT_BOUNDARY);
    }
    if ((left == OR_NONE || right == OR_NONE) && or_degree(o, v) == 0) {
        refused |= OR_BIT(HE_NO_SECTOR) | OR_BIT(HE_NOT_NEIGHBOUR);
    }
    if ((left != OR_NONE && o->joined[v][left] == OR_NONE) ||
        (right != OR_NONE && o->joined[v][right] == OR_NONE)) {
        refused |= OR_BIT(HE_NOT_NEIGHBOUR);
    }
    if (refused != 0) {
        return refused;
    }

    /* Visits the sectors (the angles of faces at the vertex v) counter-clockwise from `left` to
     * `right`. If the gap between two fans lies on the way, the visit continues after the gap. */
    uint32_t moved[OR_VERTICES];
    uint32_t count = 0;
    uint32_t x = left == OR_NONE ? fan_start(o, v) : left;
    while (x != right) {
        if (o->left[v][x] != OR_NONE) {
            moved[count++] = o->left[v][x];
            x = or_turn(o, v, x);
        } else if (right == OR_NONE) {
            break;
        } else {
            x = fan_start(o, v);
        }
    }
    if (count == 0) {
        return OR_BIT(HE_NO_SECTOR);
    }

    uint32_t w = or_add_vertex(o, to != NULL ? *to : o->vertex[v].at);
    o->vertex[w].near = true;
    for (uint32_t i = 0; i < count; i++) {
        or_face *f = &o->face[moved[i]];
        f->v[or_place(f, v)] = w;
    }
    if (left != OR_NONE) {
        (void)or_add_face(o, (uint32_t[]){v, left, w}, 3);
    }
    if (right != OR_NONE) {
        (void)or_add_face(o, (uint32_t[]){v, w, right}, 3);
    }
    /* An edge at the vertex v moves to the new vertex if only moved sectors have the edge; the
     * edges to `left` and `right` stay. */
    (void)or_derive(o);
    for (uint32_t e = 0; e < o->edges; e++) {
        or_edge *edge = &o->edge[e];
        if (edge->alive && (edge->a == v || edge->b == v)) {
            uint32_t other = edge->a == v ? edge->b : edge->a;
            if (o->left[v][other] == OR_NONE && o->left[other][v] == OR_NONE) {
                *(edge->a == v ? &edge->a : &edge->b) = w;
            }
        }
    }
    return 0;
}

uint64_t or_transform(or_mesh *o, const double matrix[16], const uint32_t *v, uint32_t count)
{
    bool chosen[OR_VERTICES] = {false};
    uint64_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        refused |= chosen[v[i]] ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
        chosen[v[i]] = true;
    }
    he_vec3 moved[OR_VERTICES];
    for (uint32_t i = 0; i < o->vertices && (refused & OR_BIT(HE_REPEATED_ELEMENT)) == 0; i++) {
        chosen[i] = o->vertex[i].alive && (count == 0 || chosen[i]);
        if (chosen[i]) {
            refused |= o->vertex[i].locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
        }
    }
    for (uint32_t i = 0; i < o->vertices && (refused & ~OR_BIT(HE_LOCKED_ELEMENT)) == 0; i++) {
        if (chosen[i]) {
            he_vec3 at = o->vertex[i].at;
            const double in[4] = {at.x, at.y, at.z, 1};
            double out[3] = {0, 0, 0};
            for (int row = 0; row < 3; row++) {
                for (int k = 0; k < 4; k++) {
                    out[row] += matrix[4 * row + k] * in[k];
                }
            }
            moved[i] = (he_vec3){out[0], out[1], out[2]};
            if (!isfinite(out[0]) || !isfinite(out[1]) || !isfinite(out[2])) {
                refused |= OR_BIT(HE_NOT_FINITE);
            }
        }
    }
    for (uint32_t i = 0; i < o->vertices && refused == 0; i++) {
        if (chosen[i]) {
            o->vertex[i].at = moved[i];
            o->vertex[i].near = true;
        }
    }
    return refused;
}

void or_compact(or_mesh *o)
{
    uint32_t name[OR_VERTICES];
    uint32_t n = 0;
    for (uint32_t v = 0; v < o->vertices; v++) {
        name[v] = OR_NONE;
        if (o->vertex[v].alive) {
            name[v] = n;
            o->vertex[n++] = o->vertex[v];
        }
    }
    uint32_t vertices = n;
    n = 0;
    for (uint32_t e = 0; e < o->edges; e++) {
        if (o->edge[e].alive) {
            o->edge[n++] =
                (or_edge){.alive = true, .a = name[o->edge[e].a], .b = name[o->edge[e].b]};
        }
    }
    o->edges = n;
    n = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive) {
            for (uint32_t i = 0; i < o->face[f].count; i++) {
                o->face[f].v[i] = name[o->face[f].v[i]];
            }
            o->face[n++] = o->face[f];
        }
    }
    o->faces = n;
    o->vertices = vertices;
    uint64_t wrong = or_derive(o);
    assert(wrong == 0);
    (void)wrong;
}
