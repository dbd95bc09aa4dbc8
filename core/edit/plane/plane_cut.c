#include "edit/plane/plane_cut.h"

#include "edit/border/hole.h"
#include "edit/local/erase.h"
#include "edit/plane/plane.h"
#include "edit/plane/plane_split.h"
#include "geometry/geometry.h"
#include "geometry/vec3.h"
#include "mesh/write.h"

void he_cut_parts_clear(he_cut_parts *parts)
{
    he_ids_clear(&parts->caps);
}

/* The state of one plane_cut. */
typedef struct cutter {
    he_mesh *m;
    he_sides sides;
    const he_plane *plane;
    int away;        /* the side that is cut off: 1 above, -1 below */
    uint64_t *going; /* a bit for each face: set if the face will be deleted */
    he_ids faces;    /* the ids of the faces that will be deleted */
    he_ids rim;      /* the half-edges of faces to delete whose twins belong to faces that stay */
    he_cut_parts made;
} cutter;

/* Returns 1 if face f lies above the plane, -1 if it lies below. The faces have been split, so none
 * has corners on both sides of the plane. A face in the plane counts as below if it faces up, else
 * as above. */
static int side_of_face(const cutter *c, he_face f)
{
    he_halfedge first = he_face_halfedge(c->m, f), h = first;
    he_vec3 up;
    do {
        int side = he_side_of(&c->sides, he_origin(c->m, h));
        if (side != 0) {
            return side;
        }
        h = he_next(c->m, h);
    } while (h.i != first.i);
    (void)he_face_normal(c->m, f, &up);
    return he_vec3_dot(up, c->plane->normal) > 0 ? -1 : 1;
}

static he_status find_faces(cutter *c, he_error *err)
{
    uint32_t issued = c->m->c.faces.issued;
    he_status status = HE_OK;
    c->going = he_bits_new(issued);
    if (c->going == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a set of faces");
    }
    for (uint32_t f = 0; status == HE_OK && f < issued; f++) {
        status = he_progress_at(c->m->progress, f, issued, err);
        if (status == HE_OK && he_face_is_live(c->m, (he_face){f}) &&
            side_of_face(c, (he_face){f}) == c->away) {
            he_bits_set(c->going, f);
            status = he_ids_add(&c->faces, f, err);
        }
    }
    return status;
}

static he_status find_rim(cutter *c, he_error *err)
{
    const he_mesh *m = c->m;
    he_status status = HE_OK;
    for (size_t i = 0; i < c->faces.count; i++) {
        he_halfedge first = he_face_halfedge(m, (he_face){c->faces.ids[i]}), h = first;
        status = he_progress_at(m->progress, i, c->faces.count, err);
        do {
            he_face beyond = he_face_of(m, he_twin(h));
            if (beyond.i != HE_NONE && !he_bits_get(c->going, beyond.i)) {
                status = he_ids_add(&c->rim, h.i, err);
            }
            h = he_next(m, h);
        } while (status == HE_OK && h.i != first.i);
        if (status != HE_OK) {
            return status;
        }
    }
    return he_ids_sort(&c->rim, err);
}

static he_status erase_isolated(cutter *c, he_error *err)
{
    he_mesh *m = c->m;
    he_status status = HE_OK;
    for (uint32_t v = 0; status == HE_OK && v < m->c.vertices.issued; v++) {
        status = he_progress_at(m->progress, v, m->c.vertices.issued, err);
        if (status == HE_OK && he_vertex_is_live(m, (he_vertex){v}) &&
            he_is_isolated(m, (he_vertex){v}) && he_side_of(&c->sides, (he_vertex){v}) == c->away) {
            status = he_vertex_delete(m, (he_vertex){v}, HE_DROP_ISOLATED, err);
        }
    }
    return status;
}

static he_status check_loop(const cutter *c, he_halfedge h, he_error *err)
{
    he_halfedge k = h;
    do {
        he_vertex v = he_origin(c->m, k);
        if (he_side_of(&c->sides, v) != 0) {
            return he_fail(err, HE_OPEN_LOOP, HE_VERTEX, v.i,
                           "no flat face can close the cut, because the loop of the cut leaves the "
                           "plane at vertex %u",
                           v.i);
        }
        k = he_next(c->m, k);
    } while (k.i != h.i);
    return HE_OK;
}

static he_status cap_loops(cutter *c, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < c->rim.count; i++) {
        he_halfedge h = {c->rim.ids[i]};
        he_filled filled = {.vertex = {HE_NONE}};
        status = he_progress_at(c->m->progress, i, c->rim.count, err);
        if (status != HE_OK || !he_is_boundary_halfedge(c->m, h)) {
            continue; /* a face that an earlier iteration made already fills this hole */
        }
        status = check_loop(c, h, err);
        if (status == HE_OK) {
            status = he_hole_fill(c->m, h, HE_FILL_POLYGON, &filled, err);
        }
        if (status == HE_OK) {
            status = he_ids_add(&c->made.caps, filled.faces.ids[0], err);
        }
        he_filled_clear(&filled);
    }
    return status;
}

static he_status split(cutter *c, he_error *err)
{
    he_plane_parts parts = {.faces_split = 0};
    he_status status = he_plane_split(c->m, c->plane, NULL, 0, &parts, err);
    if (status == HE_OK) {
        c->made.edges_split = (uint32_t)parts.vertices.count;
        c->made.faces_split = parts.faces_split;
    }
    he_plane_parts_clear(&parts);
    return status;
}

static he_status erase(cutter *c, he_error *err)
{
    c->made.faces_deleted = (uint32_t)c->faces.count;
    return he_face_delete(c->m, c->faces.ids, c->faces.count, HE_DROP_ISOLATED, err);
}

static he_status cut(cutter *c, bool cap, he_error *err)
{
    /* Each step reports its own progress from 0 to 1. `to` is the part of the whole edit that is
     * done when the step ends. */
    const struct {
        he_status (*run)(cutter *c, he_error *err);
        /* The name of the step in progress reports; NULL if the step itself names its progress. */
        const char *phase;
        double to;
        bool wanted;
    } parts[] = {
        {split, NULL, 0.5, true},
        {find_faces, "choosing faces", 0.6, true},
        {find_rim, "finding the cut", 0.65, cap},
        {erase, "deleting faces", 0.85, true},
        {erase_isolated, "deleting vertices", 0.9, true},
        {cap_loops, "closing the cut", 1, cap},
    };
    he_progress *progress = c->m->progress;
    const double from = progress == NULL ? 0 : progress->done,
                 to = progress == NULL ? 1 : progress->span_to;
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < sizeof parts / sizeof *parts; i++) {
        he_progress_span(progress, from + parts[i].to * (to - from));
        if (parts[i].wanted && parts[i].phase != NULL) {
            status = he_progress_phase(progress, parts[i].phase, 1, err);
        }
        if (status == HE_OK && parts[i].wanted) {
            status = parts[i].run(c, err);
        }
    }
    he_progress_span(progress, to);
    return status;
}

he_status he_plane_cut(he_mesh *m, const he_plane *plane, he_cut_side keep, bool cap,
                       he_cut_parts *out, he_error *err)
{
    cutter c = {.m = m, .plane = plane};
    he_bracket bracket;
    c.away = keep == HE_CUT_ABOVE ? -1 : 1;
    /* Distances from the plane are measured before the faces are split. A vertex that the split
     * makes has no measured distance, so it counts as lying in the plane. */
    he_status status = he_sides_find(m, plane, &c.sides, err);
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
    }
    if (status == HE_OK) {
        status = he_edit_end(m, &bracket, cut(&c, cap, err));
    }
    if (status == HE_OK && out != NULL) {
        *out = c.made;
        c.made.caps = (he_ids){0};
    }
    he_cut_parts_clear(&c.made);
    he_ids_clear(&c.rim);
    he_ids_clear(&c.faces);
    he_mem_free(c.going);
    he_sides_clear(&c.sides);
    return status;
}
