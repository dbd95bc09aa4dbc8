#include "oracle/oracle.h"

#include <math.h>
#include <stdio.h>

/* If the sum of the angles is closer to pi than this, the edge may be flipped or not. */
static const double SLACK = 1e-6;

static bool is_triangle(const or_mesh *o, uint32_t f)
{
    return f != OR_NONE && o->face[f].count == 3;
}

/* Returns the angle at the vertex c between the directions to the vertices a and b; 0 if a or b is
 * at the position of c. */
static double angle_at(const or_mesh *o, uint32_t c, uint32_t a, uint32_t b)
{
    he_vec3 at = o->vertex[c].at;
    he_vec3 p = o->vertex[a].at;
    he_vec3 q = o->vertex[b].at;
    p = (he_vec3){p.x - at.x, p.y - at.y, p.z - at.z};
    q = (he_vec3){q.x - at.x, q.y - at.y, q.z - at.z};
    he_vec3 n = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    double along = p.x * q.x + p.y * q.y + p.z * q.z;
    return along == 0 && n.x == 0 && n.y == 0 && n.z == 0
               ? 0
               : atan2(sqrt(n.x * n.x + n.y * n.y + n.z * n.z), along);
}

/* Returns by how much the two angles opposite to an edge exceed pi, if the edge is between two
 * triangles; -4 for any other edge. */
static double excess(const or_mesh *o, uint32_t e)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t f = o->left[a][b];
    uint32_t g = o->left[b][a];
    if (!is_triangle(o, f) || !is_triangle(o, g)) {
        return -4;
    }
    return angle_at(o, or_after(&o->face[f], b), a, b) +
           angle_at(o, or_after(&o->face[g], a), a, b) - acos(-1);
}

/* Stores `what` as the face on the left of each side of the face f. */
static void say(or_mesh *o, uint32_t f, uint32_t what)
{
    for (uint32_t i = 0; i < o->face[f].count; i++) {
        or_set_left(o, o->face[f].v[i], or_after(&o->face[f], o->face[f].v[i]), what);
    }
}

bool or_delaunay_flip(or_mesh *o, uint32_t e, bool looked[], char *text, size_t room)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    double much = o->edge[e].alive ? excess(o, e) : -4;
    if (much < -SLACK) {
        (void)snprintf(text, room, "edge %u was flipped although its angles are %g from pi", e,
                       much);
        return false;
    }
    uint32_t f = o->left[a][b];
    uint32_t g = o->left[b][a];
    or_face was[2] = {o->face[f], o->face[g]};
    uint64_t refused = or_edge_flip(o, e);
    if (refused != 0) {
        (void)snprintf(text, room, "edge %u was flipped although that is refused: %#llx", e,
                       (unsigned long long)refused);
        return false;
    }
    for (int i = 0; i < 2; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            or_set_left(o, was[i].v[k], or_after(&was[i], was[i].v[k]), OR_NONE);
            looked[o->joined[was[i].v[k]][or_after(&was[i], was[i].v[k])]] = true;
        }
    }
    o->joined[a][b] = o->joined[b][a] = OR_NONE;
    or_set_joined(o, e);
    say(o, f, f);
    say(o, g, g);
    return true;
}

bool or_delaunay_done(or_mesh *o, const bool looked[], char *text, size_t room)
{
    for (uint32_t e = 0; e < o->edges; e++) {
        if (o->edge[e].alive && looked[e] && excess(o, e) > SLACK && or_edge_flip(o, e) == 0) {
            (void)snprintf(text, room, "edge %u should have been flipped", e);
            return false;
        }
    }
    return true;
}
