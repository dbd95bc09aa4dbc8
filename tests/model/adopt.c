#include "model/adopt.h"

#include "mesh/walk.h"
#include "op/op.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

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

/* Returns the largest coordinate of a mesh, without its sign. */
static double reach(const he_mesh *m)
{
    double most = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            most = fmax(most, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
        }
    }
    return most;
}

bool md_is_tame(const md_draft *d)
{
    enum { ROOM = 300 };
    const or_mesh *o = d->o;
    he_mesh *copy = NULL;
    he_results results = {.present = {false}};
    if (o->vertices + ROOM > OR_VERTICES || o->edges + 8 * ROOM > OR_EDGES ||
        o->faces + 4 * ROOM > OR_FACES) {
        return false;
    }
    if (he_mesh_copy(d->m, &copy, NULL) != HE_OK) {
        abort();
    }
    const he_status status = he_op_run(d->c->op, copy, d->c->args, &results, NULL);
    const bool tame = status != HE_OK ||
                      (reach(copy) <= 2 * reach(d->m) + 2 &&
                       he_mesh_issued(copy, HE_VERTEX) <= he_mesh_issued(d->m, HE_VERTEX) + ROOM &&
                       he_mesh_issued(copy, HE_FACE) <= he_mesh_issued(d->m, HE_FACE) + 4 * ROOM);
    he_results_clear(&results);
    he_mesh_free(copy);
    return tame;
}
