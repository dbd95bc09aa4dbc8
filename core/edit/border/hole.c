#include "edit/border/hole.h"

#include "edit/local/poke.h"
#include "edit/piece/list.h"
#include "edit/piece/ring.h"
#include "edit/piece/triangles.h"

void he_filled_clear(he_filled *filled)
{
    he_ids_clear(&filled->edges);
    he_ids_clear(&filled->faces);
    he_ids_clear(&filled->loop);
}

he_status he_hole_loop(const he_mesh *m, he_halfedge h, he_ids *loop, he_error *err)
{
    he_ids vertices = {0};
    he_status status = he_mesh_require(m, HE_HALFEDGE, h.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (!he_is_boundary_halfedge(m, h)) {
        return he_fail(err, HE_NOT_BOUNDARY, HE_HALFEDGE, h.i,
                       "half-edge %u belongs to face %u, so it is not on a boundary", h.i,
                       he_face_of(m, h).i);
    }
    he_halfedge k = h;
    do {
        status = he_ids_add(loop, k.i, err);
        if (status == HE_OK) {
            status = he_ids_add(&vertices, he_origin(m, k).i, err);
        }
        k = he_next(m, k);
    } while (status == HE_OK && k.i != h.i);
    size_t at = 0;
    if (status == HE_OK) {
        status = he_list_repeat(vertices.ids, vertices.count, &at, err);
    }
    if (status == HE_OK && at < vertices.count) {
        status =
            he_fail(err, HE_REPEATED_CORNER, HE_VERTEX, vertices.ids[at],
                    "the boundary of the hole passes vertex %u twice, so one face cannot fill it",
                    vertices.ids[at]);
    }
    he_ids_clear(&vertices);
    return status;
}

static void fill_polygon(he_mesh *m, const he_ids *loop, he_filled *out)
{
    he_face f = he_new_face(m);
    he_set_face_halfedge(m, f, (he_halfedge){loop->ids[0]});
    for (size_t i = 0; i < loop->count; i++) {
        he_set_face(m, (he_halfedge){loop->ids[i]}, f);
    }
    out->faces.ids[out->faces.count++] = f.i;
}

he_status he_hole_fill(he_mesh *m, he_halfedge h, he_fill method, he_filled *out, he_error *err)
{
    he_ids loop = {0};
    he_poke poke = {.keep = false};
    he_triangles triangles = {.side = NULL};
    he_filled made = {.vertex = {HE_NONE}};
    he_reservation need = {0};
    he_status status = he_hole_loop(m, h, &loop, err);
    if (status != HE_OK) {
        goto out;
    }
    switch (method) {
    case HE_FILL_POLYGON:
        need = (he_reservation){.faces = 1, .links = loop.count};
        break;
    case HE_FILL_FAN:
        status = he_poke_plan(m, h, false, &poke, &need, err);
        break;
    case HE_FILL_TRIANGULATE:
        status = he_triangles_plan(m, h, NULL, &triangles, err);
        if (status == HE_OK) {
            he_triangles_reservation(&triangles, false, &need);
        }
        break;
    }
    need.links += loop.count * HE_SETTLE_LINKS;
    if (status == HE_OK) {
        status = he_ids_reserve(&made.edges, need.edges, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&made.faces, need.faces, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    /* Nothing below can fail. */
    switch (method) {
    case HE_FILL_POLYGON:
        fill_polygon(m, &loop, &made);
        break;
    case HE_FILL_FAN:
        made.vertex = he_poke_commit(m, &poke, &made.edges, &made.faces);
        break;
    case HE_FILL_TRIANGULATE:
        he_triangles_commit(m, &triangles, false, &made.edges, &made.faces);
        break;
    }
    for (size_t i = 0; i < loop.count; i++) {
        he_halfedge k = {loop.ids[i]};
        he_ring_settle(m, he_origin(m, k), k);
    }
    if (out != NULL) {
        made.loop = loop;
        loop = (he_ids){0};
        *out = made;
        made = (he_filled){.vertex = {HE_NONE}};
    }
out:
    he_filled_clear(&made);
    he_triangles_clear(&triangles);
    he_poke_clear(&poke);
    he_ids_clear(&loop);
    return status;
}
