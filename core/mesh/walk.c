#include "mesh/walk.h"

uint32_t he_vertex_degree(const he_mesh *m, he_vertex v)
{
    if (he_is_isolated(m, v)) {
        return 0;
    }
    uint32_t degree = 0;
    he_halfedge first = he_vertex_halfedge(m, v), h = first;
    do {
        degree++;
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return degree;
}

uint32_t he_face_degree(const he_mesh *m, he_face f)
{
    return he_loop_length(m, he_face_halfedge(m, f));
}

uint32_t he_loop_length(const he_mesh *m, he_halfedge h)
{
    uint32_t length = 0;
    he_halfedge x = h;
    do {
        length++;
        x = he_next(m, x);
    } while (x.i != h.i);
    return length;
}

uint32_t he_vertex_fans(const he_mesh *m, he_vertex v)
{
    if (he_is_isolated(m, v)) {
        return 0;
    }
    uint32_t fans = 0;
    he_halfedge first = he_vertex_halfedge(m, v), h = first;
    do {
        fans += he_is_boundary_halfedge(m, h);
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return fans == 0 ? 1 : fans;
}

/* Makes a step of a walk around a vertex in two directions: `up` goes counter-clockwise and `down`
 * clockwise. The processor can read the links of `up` and of `down` at one time, so waiting for
 * memory takes half as long as in a walk in one direction. Returns true if `up` and `down` have
 * met: all half-edges around the vertex have then been visited. */
static inline bool meet(const he_mesh *m, he_halfedge *up, he_halfedge *down)
{
    if (up->i == down->i) {
        return true;
    }
    *up = he_swing_ccw(m, *up);
    if (up->i == down->i) {
        return true;
    }
    *down = he_swing_cw(m, *down);
    return false;
}

/* A search for the half-edge between two vertices takes this many steps around the first vertex
 * before it searches around the second vertex, too. Most vertices have fewer edges, so the search
 * seldom needs to read the second vertex, which would cost another cache miss. */
enum { ALONE = 8 };

static he_halfedge find_from(const he_mesh *m, he_halfedge leaving, he_vertex b, uint64_t *steps)
{
    const he_halfedge none = {HE_NONE};
    he_vertex a = he_origin(m, leaving);
    he_halfedge up = leaving, down = he_swing_cw(m, up), up_b = none, down_b = none;
    for (uint32_t round = 0;; round++) {
        *steps += 2;
        if (he_target(m, up).i == b.i) {
            return up;
        }
        if (he_target(m, down).i == b.i) {
            return down;
        }
        if (meet(m, &up, &down)) {
            return none;
        }
        if (round < ALONE) {
            continue;
        }
        if (round == ALONE) {
            up_b = he_vertex_halfedge(m, b);
            if (up_b.i == HE_NONE) {
                return none;
            }
            down_b = he_swing_cw(m, up_b);
        }
        *steps += 2;
        if (he_target(m, up_b).i == a.i) {
            return he_twin(up_b);
        }
        if (he_target(m, down_b).i == a.i) {
            return he_twin(down_b);
        }
        if (meet(m, &up_b, &down_b)) {
            return none;
        }
    }
}

he_halfedge he_find_halfedge_from(const he_mesh *m, he_halfedge leaving, he_vertex to)
{
    uint64_t steps = 0;
    return find_from(m, leaving, to, &steps);
}

he_halfedge he_find_halfedge(const he_mesh *m, he_vertex a, he_vertex b)
{
    uint64_t steps = 0;
    return he_find_halfedge_counted(m, a, b, &steps);
}

he_halfedge he_find_halfedge_counted(const he_mesh *m, he_vertex a, he_vertex b, uint64_t *steps)
{
    return he_is_isolated(m, a) ? (he_halfedge){HE_NONE}
                                : find_from(m, he_vertex_halfedge(m, a), b, steps);
}
