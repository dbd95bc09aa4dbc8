/* patch_write.c - he_patch_write: makes the patch a part of the mesh. */
#include "fill/patch.h"

#include "edit/piece/ring.h"
#include "mesh/write.h"

/* The ids of the new elements. */
typedef struct writing {
    he_mesh *m;
    const he_patch *p;
    uint32_t *halfedges; /* of each side */
    uint32_t *vertices;  /* the id of each vertex of the patch */
} writing;

static void make_vertices(const writing *w, const he_patch_values *values)
{
    const he_patch *p = w->p;
    for (uint32_t v = 0; v < p->vertices; v++) {
        if (v < p->rim) {
            w->vertices[v] = he_origin(w->m, (he_halfedge){p->loop[v]}).i;
            continue;
        }
        const he_vertex made = he_new_vertex(w->m);
        w->vertices[v] = made.i;
        he_set_position(w->m, made, he_patch_outside(p, p->at[v]));
        for (size_t i = 0; i < values->count; i++) {
            if (values->columns[i] != NULL) {
                const size_t bytes = w->m->c.columns[i]->row_bytes;
                he_set_attribute(w->m, i, made.i,
                                 values->columns[i] + (size_t)(v - p->rim) * bytes);
            }
        }
    }
}

static void make_edges(const writing *w, he_ids *edges)
{
    const he_patch *p = w->p;
    for (uint32_t s = 0; s < 3 * p->triangles; s++) {
        const uint32_t twin = p->twins[s];
        if (twin == UINT32_MAX) {
            w->halfedges[s] = p->loop[p->corners[s]];
        } else if (s < twin) {
            const he_edge e = he_new_edge(w->m);
            edges->ids[edges->count++] = e.i;
            w->halfedges[s] = he_edge_halfedge(e, 0).i;
            w->halfedges[twin] = he_edge_halfedge(e, 1).i;
        }
    }
}

static void make_faces(const writing *w, he_ids *faces)
{
    const he_patch *p = w->p;
    for (uint32_t t = 0; t < p->triangles; t++) {
        const he_face f = he_new_face(w->m);
        faces->ids[faces->count++] = f.i;
        he_set_face_halfedge(w->m, f, (he_halfedge){w->halfedges[3 * t]});
        for (uint32_t s = 3 * t; s < 3 * t + 3; s++) {
            const he_halfedge h = {w->halfedges[s]}, next = {w->halfedges[he_patch_next(s)]},
                              prev = {w->halfedges[he_patch_prev(s)]};
            const he_vertex v = {w->vertices[p->corners[s]]};
            he_set_halfedge(w->m, h, next, prev, v, f);
            if (p->corners[s] >= p->rim && w->m->c.vertex_halfedge[v.i] == HE_DEAD) {
                he_set_vertex_halfedge(w->m, v, h);
            }
        }
    }
}

he_status he_patch_write(he_mesh *m, const he_patch *p, const he_patch_values *values,
                         he_ids *edges, he_ids *faces, he_error *err)
{
    const size_t sides = 3 * (size_t)p->triangles;
    const he_reservation need = {.vertices = p->vertices - p->rim,
                                 .edges = (uint32_t)((sides - p->rim) / 2),
                                 .faces = p->triangles,
                                 .links = (size_t)p->rim * (4 + HE_SETTLE_LINKS)};
    writing w = {.m = m, .p = p};
    w.halfedges = he_mem_array(NULL, sides, sizeof *w.halfedges);
    w.vertices = he_mem_array(NULL, p->vertices, sizeof *w.vertices);
    he_status status =
        w.halfedges == NULL || w.vertices == NULL
            ? he_fail_plain(err, HE_NO_MEMORY, "no memory to write %u triangles", p->triangles)
            : he_ids_reserve(edges, need.edges, err);
    if (status == HE_OK) {
        status = he_ids_reserve(faces, need.faces, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        make_vertices(&w, values);
        make_edges(&w, edges);
        make_faces(&w, faces);
        for (uint32_t i = 0; i < p->rim; i++) {
            const he_halfedge h = {p->loop[i]};
            he_ring_settle(m, he_origin(m, h), h);
        }
    }
    he_mem_free(w.halfedges);
    he_mem_free(w.vertices);
    return status;
}
