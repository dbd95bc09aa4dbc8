#include "edit/merge/merge_plan.h"

#include "base/word_hash.h"
#include "edit/piece/list.h"

/* Walks backwards from h in its loop. Returns the first half-edge whose ends are not merged into
 * one vertex. */
static he_halfedge before(const he_merge_plan *p, he_halfedge h)
{
    do {
        h = he_prev(p->m, h);
    } while (he_merge_shrinks(p, h));
    return h;
}

/* Returns the half-edge whose present face will be left of h after the merge. Returns HE_NONE if h
 * will be a boundary half-edge. */
static he_halfedge occupant_of(const he_merge_plan *p, he_halfedge h)
{
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    if (i != HE_NONE) {
        return (he_halfedge){p->fates[i].occupant[h.i & 1]};
    }
    return he_is_boundary_halfedge(p->m, h) ? (he_halfedge){HE_NONE} : h;
}

/* Returns what he_swing_ccw(h) will return after the merge. Half-edge h must have a face then. */
static he_halfedge swing(const he_merge_plan *p, he_halfedge h)
{
    return he_twin(he_merge_heir(p, before(p, occupant_of(p, h))));
}

static uint32_t *new_list(size_t count, he_error *err)
{
    uint32_t *list = he_mem_array(NULL, count + 1, sizeof *list);
    if (list == NULL) {
        (void)he_fail_plain(err, HE_NO_MEMORY, "no memory to merge %zu elements", count);
    }
    return list;
}

/* --- elements that the merge changes --- */

he_status he_merge_find_group(he_merge_plan *p, he_error *err)
{
    const he_merge *how = p->how;
    he_status status = he_ids_reserve(&p->group, 2 * how->count, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < how->count; i++) {
        p->group.ids[p->group.count++] = how->gone[i];
        p->group.ids[p->group.count++] = how->into[i];
    }
    status = he_ids_sort(&p->group, err);
    if (status != HE_OK) {
        return status;
    }
    p->rep = new_list(p->group.count, err);
    p->next = new_list(p->group.count, err);
    if (p->rep == NULL || p->next == NULL) {
        return HE_NO_MEMORY;
    }
    for (size_t i = 0; i < p->group.count; i++) {
        p->rep[i] = p->group.ids[i];
        p->next[i] = HE_NONE;
    }
    /* The loop inserts each vertex directly after the head of its list. It runs backwards, so that
     * each list has the caller's order in the end. */
    for (size_t i = how->count; i-- > 0;) {
        uint32_t gone = he_merge_index(&p->group, how->gone[i]),
                 into = he_merge_index(&p->group, how->into[i]);
        p->rep[gone] = how->into[i];
        p->next[gone] = p->next[into];
        p->next[into] = how->gone[i];
    }
    return HE_OK;
}

he_status he_merge_find_rings(he_merge_plan *p, he_error *err)
{
    const he_mesh *m = p->m;
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < p->group.count; i++) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){p->group.ids[i]}), h = first;
        while (status == HE_OK && first.i != HE_NONE) {
            status = he_ids_add(&p->edges, he_edge_of(h).i, err);
            if (status == HE_OK && !he_is_boundary_halfedge(m, h)) {
                status = he_ids_add(&p->faces, he_face_of(m, h).i, err);
            }
            h = he_swing_ccw(m, h);
            if (h.i == first.i) {
                break;
            }
        }
    }
    return status == HE_OK ? he_ids_sort(&p->faces, err) : status;
}

/* Counts the corners that face i of the plan keeps. A face that keeps fewer than three is deleted,
 * and all its edges are added to the plan. */
static he_status measure_face(he_merge_plan *p, size_t i, he_error *err)
{
    const he_mesh *m = p->m;
    he_halfedge first = he_face_halfedge(m, (he_face){p->faces.ids[i]}), h = first;
    uint32_t kept = 0, count = 0;
    do {
        kept += !he_merge_shrinks(p, h);
        count++;
        h = he_next(m, h);
    } while (h.i != first.i);
    p->corners += count;
    p->goes[i] = kept < 3 ? HE_DEAD : HE_NONE;
    he_status status = HE_OK;
    while (status == HE_OK && kept < 3) {
        status = he_ids_add(&p->edges, he_edge_of(h).i, err);
        h = he_next(m, h);
        if (h.i == first.i) {
            break;
        }
    }
    return status;
}

/* Checks that face i of the plan, which stays, does not pass a vertex twice after the merge. */
static he_status check_corners(const he_merge_plan *p, size_t i, he_ids *corners, he_error *err)
{
    const he_mesh *m = p->m;
    he_face f = {p->faces.ids[i]};
    he_halfedge first = he_face_halfedge(m, f), h = first;
    corners->count = 0;
    do {
        he_status status = he_merge_shrinks(p, h)
                               ? HE_OK
                               : he_ids_add(corners, he_merge_rep(p, he_origin(m, h)).i, err);
        if (status != HE_OK) {
            return status;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    size_t at = 0;
    he_status status = he_list_repeat(corners->ids, corners->count, &at, err);
    if (status == HE_OK && at < corners->count) {
        status = he_fail(err, HE_REPEATED_CORNER, HE_FACE, f.i, "face %u would use vertex %u twice",
                         f.i, corners->ids[at]);
    }
    return status;
}

he_status he_merge_find_faces(he_merge_plan *p, he_error *err)
{
    he_ids corners = {0};
    he_status status = HE_OK;
    p->goes = new_list(p->faces.count, err);
    if (p->goes == NULL) {
        return HE_NO_MEMORY;
    }
    for (size_t i = 0; status == HE_OK && i < p->faces.count; i++) {
        status = he_progress_at(p->m->progress, i, p->faces.count, err);
        if (status == HE_OK) {
            status = measure_face(p, i, err);
        }
        if (status == HE_OK && p->goes[i] == HE_NONE) {
            status = check_corners(p, i, &corners, err);
        }
    }
    he_ids_clear(&corners);
    return status == HE_OK ? he_ids_sort(&p->edges, err) : status;
}

/* --- edges that coincide -------------------------------------------------------------------- */

static size_t slot_of(const he_merge_plan *p, uint32_t a, uint32_t b)
{
    uint64_t low = a < b ? a : b, high = a < b ? b : a;
    uint64_t h = he_word_hash((uintptr_t)p->slots, low << 32 | high);
    return (size_t)(h >> 32) & (p->slot_count - 1);
}

/* Decides what becomes of edge i of the plan. If its ends become one vertex, it is deleted. If an
 * earlier edge will join its two vertices, it is merged into that edge. Otherwise it stays. */
static void enter(he_merge_plan *p, uint32_t i)
{
    he_halfedge h = {2 * p->edges.ids[i]};
    uint32_t a = he_merge_rep(p, he_origin(p->m, h)).i, b = he_merge_rep(p, he_target(p->m, h)).i;
    he_merge_fate *mine = &p->fates[i];
    if (a == b) {
        mine->into = HE_NONE;
        return;
    }
    size_t slot = slot_of(p, a, b);
    for (; p->slots[slot] != 0; slot = (slot + 1) & (p->slot_count - 1)) {
        const uint32_t other = p->slots[slot] - 1;
        he_halfedge k = {2 * p->edges.ids[other]};
        uint32_t c = he_merge_rep(p, he_origin(p->m, k)).i,
                 d = he_merge_rep(p, he_target(p->m, k)).i;
        if ((a != c || b != d) && (a != d || b != c)) {
            continue;
        }
        mine->into = p->edges.ids[other];
        mine->turned = a != c;
        return;
    }
    p->slots[slot] = i + 1;
    mine->into = p->edges.ids[i];
}

he_status he_merge_pair_edges(he_merge_plan *p, he_error *err)
{
    size_t count = p->edges.count;
    for (p->slot_count = 4; p->slot_count < 2 * count; p->slot_count *= 2) {
    }
    p->slots = he_mem_zero(p->slot_count, sizeof *p->slots);
    p->fates = he_mem_zero(count + 1, sizeof *p->fates);
    if (p->slots == NULL || p->fates == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to pair %zu edges", count);
    }
    for (size_t i = 0; i < count; i++) {
        p->fates[i] = (he_merge_fate){.occupant = {HE_NONE, HE_NONE}};
    }
    for (uint32_t i = 0; i < count; i++) {
        enter(p, i);
    }
    return HE_OK;
}

/* --- the faces beside the edges that stay --- */

/* Returns true if the faces of half-edges a and b will be equal after the merge: two walks around
 * these faces, from a and from b, then visit equal half-edges in every step. */
static bool is_same_face(const he_merge_plan *p, he_halfedge a, he_halfedge b)
{
    he_halfedge h = a, k = b;
    do {
        if (he_merge_heir(p, h).i != he_merge_heir(p, k).i) {
            return false;
        }
        h = he_merge_after(p, h);
        k = he_merge_after(p, k);
    } while (h.i != a.i && k.i != b.i);
    return h.i == a.i && k.i == b.i;
}

static void occupy(const he_merge_plan *p, he_halfedge old)
{
    he_halfedge h = he_merge_heir(p, old);
    uint32_t i = he_merge_index(&p->edges, he_edge_of(h).i);
    if (i != HE_NONE) {
        he_merge_fate *to = &p->fates[i];
        to->uses[h.i & 1]++;
        if (to->occupant[h.i & 1] == HE_NONE) {
            to->occupant[h.i & 1] = old.i;
        }
    }
}

static void occupy_face(const he_merge_plan *p, size_t i)
{
    he_halfedge first = he_face_halfedge(p->m, (he_face){p->faces.ids[i]});
    first = he_merge_shrinks(p, first) ? he_merge_after(p, first) : first;
    /* If this face will be equal to an earlier face, each of its half-edges is merged into a
     * half-edge of that face. Testing one half-edge therefore suffices. */
    uint32_t at = he_merge_index(&p->edges, he_edge_of(he_merge_heir(p, first)).i);
    if (at != HE_NONE && p->fates[at].occupant[he_merge_heir(p, first).i & 1] != HE_NONE) {
        he_halfedge other = {p->fates[at].occupant[he_merge_heir(p, first).i & 1]};
        if (is_same_face(p, first, other)) {
            p->goes[i] = he_face_of(p->m, other).i;
            return;
        }
    }
    he_halfedge h = first;
    do {
        occupy(p, h);
        h = he_merge_after(p, h);
    } while (h.i != first.i);
}

he_status he_merge_occupy_edges(he_merge_plan *p, he_error *err)
{
    const he_mesh *m = p->m;
    for (size_t i = 0; i < p->faces.count; i++) {
        he_status status = he_progress_at(m->progress, i, p->faces.count, err);
        if (status != HE_OK) {
            return status;
        }
        if (p->goes[i] == HE_NONE) {
            occupy_face(p, i);
        }
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        he_merge_fate *f = &p->fates[i];
        uint32_t e = p->edges.ids[i];
        for (unsigned side = 0; f->into == e && side < 2; side++) {
            /* A face beside a deleted face may have no merged vertex, so that it is not in the
             * plan. Such a face stays, and its half-edge h is counted here. */
            he_halfedge h = he_edge_halfedge((he_edge){e}, side);
            if (!he_is_boundary_halfedge(m, h) &&
                he_merge_index(&p->faces, he_face_of(m, h).i) == HE_NONE) {
                f->occupant[side] = h.i;
                f->uses[side]++;
            }
        }
        if (f->uses[0] + f->uses[1] > 2) {
            return he_fail(err, HE_NONMANIFOLD_EDGE, HE_EDGE, e, "edge %u would have %u faces", e,
                           f->uses[0] + f->uses[1]);
        }
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        if (p->fates[i].uses[0] > 1 || p->fates[i].uses[1] > 1) {
            uint32_t e = p->edges.ids[i];
            return he_fail(err, HE_ORIENTATION, HE_EDGE, e,
                           "two faces would run along edge %u in the same direction", e);
        }
    }
    return HE_OK;
}

/* --- rings: the half-edges around a vertex --- */

static he_status find_rim(he_merge_plan *p, he_error *err)
{
    he_status status = he_ids_reserve(&p->rim, 2 * p->edges.count, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        he_halfedge h = {2 * p->edges.ids[i]};
        p->rim.ids[p->rim.count++] = he_merge_rep(p, he_origin(p->m, h)).i;
        p->rim.ids[p->rim.count++] = he_merge_rep(p, he_target(p->m, h)).i;
    }
    status = he_ids_sort(&p->rim, err);
    if (status == HE_OK) {
        p->stored = new_list(p->rim.count, err);
        status = p->stored == NULL ? HE_NO_MEMORY : HE_OK;
    }
    return status;
}

/* Lists the half-edges that will leave vertex v after the merge, not necessarily in their order
 * around v. */
static he_status find_ring(const he_merge_plan *p, he_vertex v, he_ids *ring, he_error *err)
{
    const he_mesh *m = p->m;
    he_status status = HE_OK;
    uint32_t member = v.i;
    ring->count = 0;
    while (member != HE_NONE) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){member}), h = first;
        while (first.i != HE_NONE) {
            if (he_merge_stays(p, h)) {
                status = he_ids_add(ring, h.i, err);
            }
            h = he_swing_ccw(m, h);
            if (status != HE_OK || h.i == first.i) {
                break;
            }
        }
        uint32_t i = he_merge_index(&p->group, member);
        member = status != HE_OK || i == HE_NONE ? HE_NONE : p->next[i];
    }
    return status;
}

static bool is_boundary(const he_merge_plan *p, he_halfedge h)
{
    return occupant_of(p, h).i == HE_NONE;
}

/* Plans how the fans of vertex i of the list `rim` are linked to each other after the merge, and
 * which half-edge this vertex will store. `ring` lists the half-edges that will leave the
 * vertex. */
static he_status link_fans(he_merge_plan *p, size_t i, const he_ids *ring, he_error *err)
{
    he_vertex v = {p->rim.ids[i]};
    he_halfedge old = he_vertex_halfedge(p->m, v);
    he_halfedge first_in = {HE_NONE}, out = {HE_NONE};
    size_t seen = 0;
    he_status status = HE_OK;
    p->stored[i] = he_merge_index(&p->group, v.i) == HE_NONE ? HE_DEAD : HE_NONE;
    for (size_t k = 0; status == HE_OK && k < ring->count; k++) {
        he_halfedge h = {ring->ids[k]};
        if (is_boundary(p, h) || !is_boundary(p, he_twin(h))) {
            continue;
        }
        /* Half-edge h begins a fan. Its twin is a boundary half-edge that arrives at the vertex.
         * After the merge, the half-edge that follows this twin is `out`, with which the previous
         * fan ends. */
        if (out.i != HE_NONE) {
            status = he_ids_add(&p->holes, he_twin(h).i, err);
            if (status == HE_OK) {
                status = he_ids_add(&p->holes, out.i, err);
            }
        } else {
            first_in = he_twin(h);
        }
        for (; !is_boundary(p, h) && seen < ring->count; seen++) {
            h = swing(p, h);
        }
        seen++;
        out = h;
        p->stored[i] = p->stored[i] >= HE_DEAD || out.i == old.i ? out.i : p->stored[i];
    }
    if (status == HE_OK && out.i != HE_NONE) {
        status = he_ids_add(&p->holes, first_in.i, err);
        if (status == HE_OK) {
            status = he_ids_add(&p->holes, out.i, err);
        }
    } else if (status == HE_OK && ring->count > 0) {
        he_halfedge first = {ring->ids[0]}, h = first;
        do {
            h = swing(p, h);
            seen++;
        } while (h.i != first.i && seen < ring->count);
        p->stored[i] = old.i < HE_DEAD && he_merge_stays(p, old) ? old.i : first.i;
    }
    if (status == HE_OK && seen != ring->count) {
        return he_fail(err, HE_CLOSED_FAN, HE_VERTEX, v.i,
                       "a closed fan of faces would form around vertex %u, which also belongs to "
                       "another fan of faces",
                       v.i);
    }
    return status;
}

he_status he_merge_find_fans(he_merge_plan *p, he_error *err)
{
    he_ids ring = {0};
    he_status status = find_rim(p, err);
    for (size_t i = 0; status == HE_OK && i < p->rim.count; i++) {
        status = he_progress_at(p->m->progress, i, p->rim.count, err);
        if (status == HE_OK) {
            status = find_ring(p, (he_vertex){p->rim.ids[i]}, &ring, err);
        }
        if (status == HE_OK) {
            status = link_fans(p, i, &ring, err);
        }
    }
    he_ids_clear(&ring);
    return status;
}
