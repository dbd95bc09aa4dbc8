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
        h = he_turn_ccw(m, h);
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
        h = he_turn_ccw(m, h);
    } while (h.i != first.i);
    return fans == 0 ? 1 : fans;
}

he_halfedge he_find_halfedge(const he_mesh *m, he_vertex a, he_vertex b)
{
    uint64_t steps = 0;
    return he_find_halfedge_counted(m, a, b, &steps);
}

/* A ring is turned about both ways at once, half of it each: where links come from memory one after
 * another that takes half the time. Has all of it been seen? */
static inline bool meet(const he_mesh *m, he_halfedge *up, he_halfedge *down)
{
    if (up->i == down->i) {
        return true;
    }
    *up = he_turn_ccw(m, *up);
    if (up->i == down->i) {
        return true;
    }
    *down = he_turn_cw(m, *down);
    return false;
}

he_halfedge he_find_halfedge_counted(const he_mesh *m, he_vertex a, he_vertex b, uint64_t *steps)
{
    he_halfedge none = {HE_NONE};
    if (he_is_isolated(m, a) || he_is_isolated(m, b)) {
        return none;
    }
    he_halfedge up = he_vertex_halfedge(m, a), down = he_turn_cw(m, up);
    he_halfedge up_b = he_vertex_halfedge(m, b), down_b = he_turn_cw(m, up_b);
    do {
        *steps += 2;
        if (he_target(m, up).i == b.i) {
            return up;
        }
        if (he_target(m, down).i == b.i) {
            return down;
        }
        if (he_target(m, up_b).i == a.i) {
            return he_twin(up_b);
        }
        if (he_target(m, down_b).i == a.i) {
            return he_twin(down_b);
        }
    } while (!meet(m, &up, &down) && !meet(m, &up_b, &down_b));
    return none;
}
