#include "model/adopt.h"

#include "mesh/walk.h"

#include <assert.h>

he_vertex md_corner(const he_mesh *m, uint32_t f, uint32_t i)
{
    he_halfedge h = he_face_halfedge(m, (he_face){f});
    for (; i > 0; i--) {
        h = he_next(m, h);
    }
    return he_origin(m, h);
}

static void take_face(or_mesh *o, const he_mesh *made, uint32_t f)
{
    uint32_t v[OR_CORNERS], count = 0;
    const he_halfedge first = he_face_halfedge(made, (he_face){f});
    he_halfedge h = first;
    do {
        assert(count < OR_CORNERS);
        v[count++] = he_origin(made, h).i;
        h = he_next(made, h);
    } while (h.i != first.i);
    if (f >= o->faces) {
        (void)or_add_face(o, v, count);
        return;
    }
    assert(count == o->face[f].count);
    for (uint32_t i = 0; i < count; i++) {
        o->face[f].v[i] = v[i];
    }
}

void md_adopt_mesh(or_mesh *o, const he_mesh *made)
{
    for (uint32_t v = 0; v < he_mesh_issued(made, HE_VERTEX); v++) {
        he_vec3 at = he_position(made, (he_vertex){v});
        if (v >= o->vertices) {
            (void)or_add_vertex(o, at);
            continue;
        }
        o->vertex[v].alive = he_mesh_is_live(made, HE_VERTEX, v);
        if (o->vertex[v].alive) {
            o->vertex[v].at = at;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        o->edge[e].alive = he_mesh_is_live(made, HE_EDGE, e);
        if (o->edge[e].alive) {
            o->edge[e].a = he_origin(made, (he_halfedge){2 * e}).i;
            o->edge[e].b = he_target(made, (he_halfedge){2 * e}).i;
        }
    }
    for (uint32_t f = 0; f < he_mesh_issued(made, HE_FACE); f++) {
        const bool alive = he_mesh_is_live(made, HE_FACE, f);
        if (f < o->faces) {
            o->face[f].alive = alive;
        }
        if (alive) {
            take_face(o, made, f);
        }
    }
}
