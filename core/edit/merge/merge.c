#include "edit/merge/merge.h"

#include "edit/merge/merge_plan.h"
#include "edit/piece/keep.h"
#include "edit/piece/point.h"
#include "mesh/marks.h"

static void clear(he_merge_plan *p)
{
    he_ids_clear(&p->group);
    he_ids_clear(&p->edges);
    he_ids_clear(&p->faces);
    he_ids_clear(&p->rim);
    he_ids_clear(&p->holes);
    he_mem_free(p->rep);
    he_mem_free(p->next);
    he_mem_free(p->fates);
    he_mem_free(p->slots);
    he_mem_free(p->goes);
    he_mem_free(p->stored);
}

/* --- marks ---------------------------------------------------------------------------------- */

static bool goes_into_another(const he_merge_plan *p, he_vertex v)
{
    return he_merge_rep(p, v).i != v.i;
}

static he_vec3 place(const he_merge_plan *p, uint32_t i)
{
    const he_mesh *m = p->m;
    he_vec3 mean = he_position(m, (he_vertex){p->group.ids[i]});
    if (p->how->place == HE_MERGE_INTO) {
        return mean;
    }
    double count = 1;
    for (uint32_t v = p->next[i]; v != HE_NONE; v = p->next[he_merge_index(&p->group, v)]) {
        he_vec3 at = he_position(m, (he_vertex){v});
        count++;
        mean = he_point_between(mean, at, 1 / count);
    }
    return mean;
}

static bool moves(const he_merge_plan *p, uint32_t i)
{
    he_vec3 from = he_position(p->m, (he_vertex){p->group.ids[i]}), to = place(p, i);
    return from.x != to.x || from.y != to.y || from.z != to.z;
}

static he_status check_faces(const he_merge_plan *p, const he_marks *marks, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < p->faces.count; i++) {
        he_face f = {p->faces.ids[i]};
        if (!he_is_locked(marks, HE_FACE, f.i)) {
            continue;
        }
        bool changes = p->goes[i] != HE_NONE;
        he_halfedge first = he_face_halfedge(p->m, f), h = first;
        do {
            changes = changes || goes_into_another(p, he_origin(p->m, h));
            h = he_next(p->m, h);
        } while (h.i != first.i);
        status = changes ? he_require_unlocked(marks, HE_FACE, f.i, err) : HE_OK;
    }
    return status;
}

static he_status check_marks(he_merge_plan *p, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(p->m, &marks)) {
        return HE_OK;
    }
    he_status status = check_faces(p, &marks, err);
    for (uint32_t i = 0; status == HE_OK && i < p->group.count; i++) {
        he_vertex v = {p->group.ids[i]};
        /* moves() walks through all vertices that are merged into a vertex. So it is called only
         * for vertices that stay, because many calls for one list of merged vertices would be
         * slow. */
        if (goes_into_another(p, v) || moves(p, i)) {
            status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
        }
    }
    for (size_t i = 0; status == HE_OK && i < p->rim.count; i++) {
        if (p->stored[i] == HE_DEAD) {
            status = he_require_unlocked(&marks, HE_VERTEX, p->rim.ids[i], err);
        }
    }
    for (size_t i = 0; status == HE_OK && i < p->edges.count; i++) {
        he_halfedge h = {2 * p->edges.ids[i]};
        if (!he_merge_stays(p, h) || goes_into_another(p, he_origin(p->m, h)) ||
            goes_into_another(p, he_target(p->m, h))) {
            status = he_require_unlocked(&marks, HE_EDGE, p->edges.ids[i], err);
        }
    }
    return status;
}

/* --- writing -------------------------------------------------------------------------------- */

static he_status reserve(he_merge_plan *p, he_error *err)
{
    he_reservation need = {.deleted_edges = p->edges.count, .deleted_faces = p->faces.count};
    need.deleted_vertices = p->how->count + p->rim.count;
    need.links =
        3 * p->corners + p->faces.count + 4 * p->edges.count + p->holes.count + p->rim.count;
    need.positions = p->group.count;
    need.attributes = p->corners + p->edges.count + p->group.count;
    need.lineage = p->edges.count + p->faces.count + p->group.count;
    return he_reserve(p->m, need, err);
}

/* Walks around a face and replaces each half-edge that is merged into another one by the half-edge
 * into which it is merged. The values of the corner move there as well. Each link is read before it
 * is overwritten. */
static void relink_face(const he_merge_plan *p, he_face f)
{
    he_mesh *m = p->m;
    he_halfedge stored = he_face_halfedge(m, f);
    he_halfedge first = he_merge_shrinks(p, stored) ? he_merge_after(p, stored) : stored, h = first;
    do {
        he_halfedge next = he_merge_after(p, h), mine = he_merge_heir(p, h);
        if (mine.i != h.i) {
            he_set_face(m, mine, f);
            he_attributes_move(m, HE_HALFEDGE, mine.i, h.i);
        }
        he_link(m, mine, he_merge_heir(p, next));
        h = next;
    } while (h.i != first.i);
    if (he_merge_heir(p, first).i != stored.i) {
        he_set_face_halfedge(m, f, he_merge_heir(p, first));
    }
}

static void write_vertices(const he_merge_plan *p)
{
    he_mesh *m = p->m;
    for (uint32_t i = 0; i < p->group.count; i++) {
        if (p->rep[i] == p->group.ids[i]) {
            he_set_position(m, (he_vertex){p->group.ids[i]}, place(p, i));
        }
    }
    for (size_t i = 0; i < p->rim.count; i++) {
        if (p->stored[i] == HE_DEAD) {
            he_delete_vertex(m, (he_vertex){p->rim.ids[i]});
        } else {
            he_set_vertex_halfedge(m, (he_vertex){p->rim.ids[i]}, (he_halfedge){p->stored[i]});
        }
    }
    for (uint32_t i = 0; i < p->group.count; i++) {
        if (p->rep[i] != p->group.ids[i]) {
            he_note_merged(m, HE_VERTEX, p->group.ids[i], p->rep[i]);
            he_delete_vertex(m, (he_vertex){p->group.ids[i]});
        }
    }
}

static void write_edges(const he_merge_plan *p)
{
    he_mesh *m = p->m;
    for (size_t i = 0; i < p->edges.count; i++) {
        he_edge e = {p->edges.ids[i]};
        const he_merge_fate *f = &p->fates[i];
        he_halfedge h = he_edge_halfedge(e, 0);
        if (he_merge_stays(p, h)) {
            for (unsigned side = 0; side < 2; side++) {
                he_halfedge k = he_edge_halfedge(e, side);
                he_vertex v = he_merge_rep(p, he_origin(m, k));
                if (v.i != he_origin(m, k).i) {
                    he_set_origin(m, k, v);
                }
                if (f->occupant[side] == HE_NONE && !he_is_boundary_halfedge(m, k)) {
                    he_set_face(m, k, (he_face){HE_NONE});
                }
            }
            continue;
        }
        if (f->into != HE_NONE && f->into != e.i && he_merge_stays(p, he_merge_heir(p, h))) {
            he_note_merged(m, HE_EDGE, e.i, f->into);
        }
    }
}

static void commit(const he_merge_plan *p)
{
    he_mesh *m = p->m;
    for (size_t i = 0; i < p->faces.count; i++) {
        he_progress_note(m->progress, i, p->faces.count);
        if (p->goes[i] == HE_NONE) {
            relink_face(p, (he_face){p->faces.ids[i]});
        }
    }
    for (size_t i = 0; i + 1 < p->holes.count; i += 2) {
        he_link(m, (he_halfedge){p->holes.ids[i]}, (he_halfedge){p->holes.ids[i + 1]});
    }
    write_edges(p);
    for (size_t i = 0; i < p->faces.count; i++) {
        if (p->goes[i] != HE_NONE) {
            if (p->goes[i] != HE_DEAD) {
                he_note_merged(m, HE_FACE, p->faces.ids[i], p->goes[i]);
            }
            he_delete_face(m, (he_face){p->faces.ids[i]});
        }
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        if (!he_merge_stays(p, he_edge_halfedge((he_edge){p->edges.ids[i]}, 0))) {
            he_delete_edge(m, (he_edge){p->edges.ids[i]});
        }
    }
    write_vertices(p);
}

/* Performs the merge. First moves the attribute values that merged vertices would lose to corners;
 * if the merge fails, moves them back. */
static he_status write(he_merge_plan *p, uint64_t *moved, he_error *err)
{
    const he_keep_pairs pairs = {p->how->gone, p->how->into, p->how->count};
    he_keeping kept;
    he_status status = he_keep_begin(p->m, &pairs, &kept, err);
    if (status != HE_OK) {
        return status;
    }
    status = reserve(p, err);
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(p);
    }
    return he_keep_end(p->m, &kept, status, moved);
}

he_status he_merge_vertices(he_mesh *m, const he_merge *how, uint64_t *moved, he_error *err)
{
    static const struct {
        he_status (*run)(he_merge_plan *p, he_error *err);
        const char *phase;
        double to;
    } parts[] = {
        {he_merge_find_group, "finding vertices", 0.5},
        {he_merge_find_rings, "finding faces", 0.55},
        {he_merge_find_faces, "measuring faces", 0.65},
        {he_merge_pair_edges, "pairing edges", 0.7},
        {he_merge_occupy_edges, "checking edges", 0.8},
        {he_merge_find_fans, "checking fans", 0.9},
        {check_marks, "checking marks", 0.92},
    };
    he_merge_plan p = {.m = m, .how = how};
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < sizeof parts / sizeof *parts; i++) {
        status = he_progress_phase(m->progress, parts[i].phase, parts[i].to, err);
        if (status == HE_OK) {
            status = parts[i].run(&p, err);
        }
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "merging", 1, err);
    }
    if (status == HE_OK) {
        status = write(&p, moved, err);
    }
    clear(&p);
    return status;
}
