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

he_halfedge he_find_halfedge_counted(const he_mesh *m, he_vertex a, he_vertex b, uint64_t *steps)
{
    he_halfedge none = {HE_NONE};
    if (he_is_isolated(m, a) || he_is_isolated(m, b)) {
        return none;
    }
    he_halfedge from_a = he_vertex_halfedge(m, a), from_b = he_vertex_halfedge(m, b);
    he_halfedge h = from_a, k = from_b;
    do {
        ++*steps;
        if (he_target(m, h).i == b.i) {
            return h;
        }
        if (he_target(m, k).i == a.i) {
            return he_twin(k);
        }
        h = he_turn_ccw(m, h);
        k = he_turn_ccw(m, k);
    } while (h.i != from_a.i && k.i != from_b.i);
    return none;
}
