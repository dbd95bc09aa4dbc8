#include "edit/plane/plane_split.h"

#include "edit/local/bisect.h"
#include "edit/local/cut.h"
#include "edit/piece/list.h"
#include "edit/plane/chords.h"

void he_plane_parts_clear(he_plane_parts *parts)
{
    he_ids_clear(&parts->vertices);
    he_ids_clear(&parts->edges);
    he_ids_clear(&parts->faces);
    *parts = (he_plane_parts){.faces_split = 0};
}

/* The state of one plane_split. */
typedef struct splitter {
    he_mesh *m;
    he_sides sides;
    /* a bit for each face: set if the plane may split it; NULL: the plane may split all faces */
    uint64_t *chosen;
    he_chords chords;
    he_plane_parts made;
} splitter;

static he_status choose(splitter *s, const uint32_t *faces, size_t count, he_error *err)
{
    if (faces == NULL) {
        return HE_OK;
    }
    he_status status = he_list_require(s->m, HE_FACE, faces, count, HE_REPEATED_ELEMENT, err);
    if (status != HE_OK) {
        return status;
    }
    s->chosen = he_bits_new(s->m->c.faces.issued);
    if (s->chosen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a set of faces");
    }
    for (size_t i = 0; i < count; i++) {
        he_bits_set(s->chosen, faces[i]);
    }
    return HE_OK;
}

static bool is_chosen(const splitter *s, he_face f)
{
    return f.i != HE_NONE && (s->chosen == NULL || he_bits_get(s->chosen, f.i));
}

/* --- edges --- */

static bool is_crossed(const splitter *s, he_edge e)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    return he_edge_is_live(s->m, e) &&
           he_side_of(&s->sides, he_origin(s->m, h)) * he_side_of(&s->sides, he_target(s->m, h)) <
               0 &&
           (is_chosen(s, he_face_of(s->m, h)) || is_chosen(s, he_face_of(s->m, he_twin(h))));
}

static he_status split_edges(splitter *s, he_error *err)
{
    he_mesh *m = s->m;
    uint32_t issued = m->c.edges.issued, crossed = 0;
    he_reservation one = {0};
    he_status status = HE_OK;
    for (uint32_t e = 0; e < issued && status == HE_OK; e++) {
        crossed += is_crossed(s, (he_edge){e});
        status = he_progress_at(m->progress, e, 2 * (uint64_t)issued, err);
    }
    he_bisect_reservation(&one);
    he_reservation need = {.vertices = crossed * one.vertices,
                           .edges = crossed * one.edges,
                           .links = crossed * one.links,
                           .attributes = crossed * one.attributes,
                           .lineage = crossed * one.lineage};
    if (status == HE_OK) {
        status = he_ids_reserve(&s->made.vertices, crossed, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    for (uint32_t e = 0; e < issued; e++) {
        he_progress_note(m->progress, (uint64_t)issued + e, 2 * (uint64_t)issued);
        if (is_crossed(s, (he_edge){e})) {
            he_halfedge h = {2 * e};
            double from = s->sides.distance[he_origin(m, h).i];
            double to = s->sides.distance[he_target(m, h).i];
            he_halfedge on = he_bisect_commit(m, (he_edge){e}, from / (from - to));
            s->made.vertices.ids[s->made.vertices.count++] = he_origin(m, on).i;
        }
    }
    return HE_OK;
}

/* --- faces --- */

static uint32_t steps_between(const he_mesh *m, he_halfedge from, he_halfedge to)
{
    uint32_t n = 0;
    for (; from.i != to.i; from = he_next(m, from)) {
        n++;
    }
    return n;
}

/* Splits a face along the chord from corner a to corner b. Chords whose corners lie between a and b
 * must have been made before: each has shortened the path from a to b along the face. Counting the
 * steps of these paths for all chords of a face therefore takes time linear in the corners of the
 * face. */
static he_status cut_chord(splitter *s, uint32_t a, uint32_t b, he_error *err)
{
    he_mesh *m = s->m;
    he_halfedge from = {s->chords.corner.ids[a]}, to = {s->chords.corner.ids[b]};
    he_vertex v = he_origin(m, from), w = he_origin(m, to);
    he_halfedge joined = he_find_halfedge(m, v, w);
    if (joined.i != HE_NONE) {
        return he_fail(
            err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(joined).i,
            "the plane would cut face %u from vertex %u to %u, but edge %u already joins them",
            he_face_of(m, from).i, v.i, w.i, he_edge_of(joined).i);
    }
    he_reservation need = {0};
    he_cut_reservation(steps_between(m, from, to), &need);
    he_status status = he_ids_reserve(&s->made.edges, 1, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&s->made.faces, 1, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge diagonal = he_cut_commit(m, from, to);
    s->chords.corner.ids[a] = diagonal.i;
    s->made.edges.ids[s->made.edges.count++] = he_edge_of(diagonal).i;
    s->made.faces.ids[s->made.faces.count++] = he_face_of(m, he_twin(diagonal)).i;
    return HE_OK;
}

static he_status split_faces(splitter *s, he_error *err)
{
    uint32_t issued = s->m->c.faces.issued;
    const he_ids *pairs = &s->chords.pairs;
    he_status status = HE_OK;
    for (uint32_t f = 0; status == HE_OK && f < issued; f++) {
        status = he_progress_at(s->m->progress, f, issued, err);
        if (status != HE_OK || !he_face_is_live(s->m, (he_face){f}) ||
            !is_chosen(s, (he_face){f})) {
            continue;
        }
        status = he_chords_plan(s->m, (he_face){f}, &s->sides, &s->chords, err);
        s->made.faces_split += status == HE_OK && pairs->count > 0;
        for (size_t i = 0; status == HE_OK && i < pairs->count; i += 2) {
            status = cut_chord(s, pairs->ids[i], pairs->ids[i + 1], err);
        }
    }
    return status;
}

he_status he_plane_split(he_mesh *m, const he_plane *plane, const uint32_t *faces, size_t count,
                         he_plane_parts *out, he_error *err)
{
    splitter s = {.m = m};
    he_bracket bracket;
    he_status status = choose(&s, faces, count, err);
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "measuring", 0.2, err);
    }
    if (status == HE_OK) {
        status = he_sides_find(m, plane, &s.sides, err);
    }
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    /* Faces are split after edges, because diagonals end at the new vertices of edges. Faces are
     * split one after the other, because no diagonal may join two vertices that an earlier diagonal
     * joins. */
    status = he_progress_phase(m->progress, "splitting edges", 0.5, err);
    if (status == HE_OK) {
        status = split_edges(&s, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "splitting faces", 1, err);
    }
    if (status == HE_OK) {
        status = split_faces(&s, err);
    }
    status = he_edit_end(m, &bracket, status);
    if (status == HE_OK && out != NULL) {
        *out = s.made;
        s.made = (he_plane_parts){.faces_split = 0};
    }
out:
    he_plane_parts_clear(&s.made);
    he_chords_clear(&s.chords);
    he_sides_clear(&s.sides);
    he_mem_free(s.chosen);
    return status;
}
