#include "edit/merge.h"

#include "edit/list.h"
#include "edit/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

/* What becomes of an edge with an end in a merge, or beside a face that goes. */
typedef struct fate {
    uint32_t into;     /* the edge that takes its place, itself, or HE_NONE when its ends are one */
    uint32_t turned;   /* 1 when half-edge 2e takes the place of 2 * into + 1 */
    uint32_t claim[2]; /* of one that stays: the old half-edge that runs there with its face now */
    uint32_t uses[2];  /* how many faces run along either side */
    uint32_t taken;    /* how many became one with it */
} fate;

/* Lists of ids are sorted unless they say otherwise, and arrays run along with them. */
typedef struct plan {
    he_mesh *m;
    const he_merge *how;
    he_ids group;   /* the vertices that take part */
    uint32_t *rep;  /* which one each becomes */
    uint32_t *next; /* the one that follows among those that become one, from rep on; HE_NONE */
    he_ids edges;
    fate *fates;
    uint32_t *slots; /* a hash table of those that stay, by their ends: index in edges + 1 */
    size_t slot_count;
    he_ids faces;
    uint32_t *goes;   /* HE_NONE: it stays; HE_DEAD: it goes; else the face it is the same as */
    he_ids rim;       /* the vertices whose rings change, as far as they stay */
    uint32_t *stored; /* the half-edge each of those stores then; HE_DEAD when it goes */
    he_ids holes;     /* pairs of boundary half-edges that follow each other; in no order */
    size_t corners;   /* of the faces */
} plan;

static void clear(plan *p)
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

/* The place of an id in a sorted list, or HE_NONE. */
static uint32_t place_of(const he_ids *list, uint32_t id)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        size_t mid = low + (high - low) / 2;
        if (list->ids[mid] < id) {
            low = mid + 1;
        } else {
            high = mid;
        }
    }
    return low < list->count && list->ids[low] == id ? (uint32_t)low : HE_NONE;
}

static he_vertex rep(const plan *p, he_vertex v)
{
    uint32_t i = place_of(&p->group, v.i);
    return i == HE_NONE ? v : (he_vertex){p->rep[i]};
}

static bool is_drawn_together(const plan *p, he_halfedge h)
{
    return rep(p, he_origin(p->m, h)).i == rep(p, he_target(p->m, h)).i;
}

/* The half-edge of the same loop after h, or before it, that keeps its ends apart. One of the loop
 * must. */
static he_halfedge after(const plan *p, he_halfedge h)
{
    do {
        h = he_next(p->m, h);
    } while (is_drawn_together(p, h));
    return h;
}

static he_halfedge before(const plan *p, he_halfedge h)
{
    do {
        h = he_prev(p->m, h);
    } while (is_drawn_together(p, h));
    return h;
}

/* The half-edge that takes the place of h. */
static he_halfedge heir(const plan *p, he_halfedge h)
{
    uint32_t i = place_of(&p->edges, he_edge_of(h).i);
    return i == HE_NONE ? h
                        : (he_halfedge){2 * p->fates[i].into + ((h.i & 1) ^ p->fates[i].turned)};
}

/* The old half-edge whose face runs along h afterwards, HE_NONE at a boundary. */
static he_halfedge claimant(const plan *p, he_halfedge h)
{
    uint32_t i = place_of(&p->edges, he_edge_of(h).i);
    if (i != HE_NONE) {
        return (he_halfedge){p->fates[i].claim[h.i & 1]};
    }
    return he_is_boundary_halfedge(p->m, h) ? (he_halfedge){HE_NONE} : h;
}

/* Is h's edge there afterwards, and is it h that stands for it? */
static bool stays(const plan *p, he_halfedge h)
{
    uint32_t i = place_of(&p->edges, he_edge_of(h).i);
    return i == HE_NONE || (p->fates[i].into == he_edge_of(h).i &&
                            (p->fates[i].claim[0] != HE_NONE || p->fates[i].claim[1] != HE_NONE));
}

/* he_turn_ccw as it will be, for a half-edge with a face. */
static he_halfedge turn(const plan *p, he_halfedge h)
{
    return he_twin(heir(p, before(p, claimant(p, h))));
}

static uint32_t *new_list(size_t count, he_error *err)
{
    uint32_t *list = he_mem_array(NULL, count + 1, sizeof *list);
    if (list == NULL) {
        (void)he_fail_plain(err, HE_NO_MEMORY, "no memory to merge %zu elements", count);
    }
    return list;
}

/* --- what takes part ------------------------------------------------------------------------ */

static he_status find_group(plan *p, he_error *err)
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
    /* Backwards, so that each list is in the caller's order. */
    for (size_t i = how->count; i-- > 0;) {
        uint32_t gone = place_of(&p->group, how->gone[i]), into = place_of(&p->group, how->into[i]);
        p->rep[gone] = how->into[i];
        p->next[gone] = p->next[into];
        p->next[into] = how->gone[i];
    }
    return HE_OK;
}

static he_status find_rings(plan *p, he_error *err)
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
            h = he_turn_ccw(m, h);
            if (h.i == first.i) {
                break;
            }
        }
    }
    return status == HE_OK ? he_ids_sort(&p->faces, err) : status;
}

/* Corners a face keeps; all its edges become part of the plan when it goes. */
static he_status measure_face(plan *p, size_t i, he_error *err)
{
    const he_mesh *m = p->m;
    he_halfedge first = he_face_halfedge(m, (he_face){p->faces.ids[i]}), h = first;
    uint32_t kept = 0, count = 0;
    do {
        kept += !is_drawn_together(p, h);
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

/* No corner of a face that stays may be there twice. */
static he_status check_corners(const plan *p, size_t i, he_ids *corners, he_error *err)
{
    const he_mesh *m = p->m;
    he_face f = {p->faces.ids[i]};
    he_halfedge first = he_face_halfedge(m, f), h = first;
    corners->count = 0;
    do {
        he_status status =
            is_drawn_together(p, h) ? HE_OK : he_ids_add(corners, rep(p, he_origin(m, h)).i, err);
        if (status != HE_OK) {
            return status;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    size_t at = 0;
    he_status status = he_list_repeat(corners->ids, corners->count, &at, err);
    if (status == HE_OK && at < corners->count) {
        status = he_fail(err, HE_REPEATED_CORNER, HE_FACE, f.i,
                         "face %u would pass vertex %u twice", f.i, corners->ids[at]);
    }
    return status;
}

static he_status find_faces(plan *p, he_error *err)
{
    he_ids corners = {0};
    he_status status = HE_OK;
    p->goes = new_list(p->faces.count, err);
    if (p->goes == NULL) {
        return HE_NO_MEMORY;
    }
    for (size_t i = 0; status == HE_OK && i < p->faces.count; i++) {
        status = he_watch_at(p->m->watch, i, p->faces.count, err);
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

static size_t slot_of(const plan *p, uint32_t a, uint32_t b)
{
    uint64_t low = a < b ? a : b, high = a < b ? b : a;
    uint64_t h = (low << 32 | high) * UINT64_C(0x9E3779B97F4A7C15);
    return (size_t)((h ^ h >> 32) * UINT64_C(0xBF58476D1CE4E5B9) >> 32) & (p->slot_count - 1);
}

/* Let edge i stay, or go into the one that is there. */
static void enter(plan *p, uint32_t i)
{
    he_halfedge h = {2 * p->edges.ids[i]};
    uint32_t a = rep(p, he_origin(p->m, h)).i, b = rep(p, he_target(p->m, h)).i;
    fate *mine = &p->fates[i];
    if (a == b) {
        mine->into = HE_NONE;
        return;
    }
    size_t slot = slot_of(p, a, b);
    for (; p->slots[slot] != 0; slot = (slot + 1) & (p->slot_count - 1)) {
        const uint32_t other = p->slots[slot] - 1;
        he_halfedge k = {2 * p->edges.ids[other]};
        uint32_t c = rep(p, he_origin(p->m, k)).i, d = rep(p, he_target(p->m, k)).i;
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

static he_status pair_edges(plan *p, he_error *err)
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
        p->fates[i] = (fate){.claim = {HE_NONE, HE_NONE}, .taken = 1};
    }
    for (uint32_t i = 0; i < count; i++) {
        enter(p, i);
    }
    return HE_OK;
}

/* --- faces along them ----------------------------------------------------------------------- */

/* Do the faces of two old half-edges run through the same corners, from these on? */
static bool is_same_face(const plan *p, he_halfedge a, he_halfedge b)
{
    he_halfedge h = a, k = b;
    do {
        if (heir(p, h).i != heir(p, k).i) {
            return false;
        }
        h = after(p, h);
        k = after(p, k);
    } while (h.i != a.i && k.i != b.i);
    return h.i == a.i && k.i == b.i;
}

static void claim(const plan *p, he_halfedge old)
{
    he_halfedge h = heir(p, old);
    uint32_t i = place_of(&p->edges, he_edge_of(h).i);
    if (i != HE_NONE) {
        fate *to = &p->fates[i];
        to->uses[h.i & 1]++;
        if (to->claim[h.i & 1] == HE_NONE) {
            to->claim[h.i & 1] = old.i;
        }
    }
}

static void claim_face(const plan *p, size_t i)
{
    he_halfedge first = he_face_halfedge(p->m, (he_face){p->faces.ids[i]});
    first = is_drawn_together(p, first) ? after(p, first) : first;
    /* Any half-edge of a face that is the same as another is one with a side of that. */
    uint32_t at = place_of(&p->edges, he_edge_of(heir(p, first)).i);
    if (at != HE_NONE && p->fates[at].claim[heir(p, first).i & 1] != HE_NONE) {
        he_halfedge other = {p->fates[at].claim[heir(p, first).i & 1]};
        if (is_same_face(p, first, other)) {
            p->goes[i] = he_face_of(p->m, other).i;
            return;
        }
    }
    he_halfedge h = first;
    do {
        claim(p, h);
        h = after(p, h);
    } while (h.i != first.i);
}

static he_status claim_edges(plan *p, he_error *err)
{
    const he_mesh *m = p->m;
    for (size_t i = 0; i < p->faces.count; i++) {
        he_status status = he_watch_at(m->watch, i, p->faces.count, err);
        if (status != HE_OK) {
            return status;
        }
        if (p->goes[i] == HE_NONE) {
            claim_face(p, i);
        }
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        fate *f = &p->fates[i];
        uint32_t e = p->edges.ids[i];
        for (unsigned side = 0; f->into == e && side < 2; side++) {
            /* Beside a face that goes may lie one that the merge does not touch. */
            he_halfedge h = he_edge_halfedge((he_edge){e}, side);
            if (!he_is_boundary_halfedge(m, h) &&
                place_of(&p->faces, he_face_of(m, h).i) == HE_NONE) {
                f->claim[side] = h.i;
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
                           "two faces would run along edge %u in one direction", e);
        }
    }
    return HE_OK;
}

/* --- rings ---------------------------------------------------------------------------------- */

static he_status find_rim(plan *p, he_error *err)
{
    he_status status = he_ids_reserve(&p->rim, 2 * p->edges.count, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < p->edges.count; i++) {
        he_halfedge h = {2 * p->edges.ids[i]};
        p->rim.ids[p->rim.count++] = rep(p, he_origin(p->m, h)).i;
        p->rim.ids[p->rim.count++] = rep(p, he_target(p->m, h)).i;
    }
    status = he_ids_sort(&p->rim, err);
    if (status == HE_OK) {
        p->stored = new_list(p->rim.count, err);
        status = p->stored == NULL ? HE_NO_MEMORY : HE_OK;
    }
    return status;
}

/* The half-edges that will leave rim vertex v, into `ring`. */
static he_status find_ring(const plan *p, he_vertex v, he_ids *ring, he_error *err)
{
    const he_mesh *m = p->m;
    he_status status = HE_OK;
    uint32_t member = v.i;
    ring->count = 0;
    while (member != HE_NONE) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){member}), h = first;
        while (first.i != HE_NONE) {
            if (stays(p, h)) {
                status = he_ids_add(ring, h.i, err);
            }
            h = he_turn_ccw(m, h);
            if (status != HE_OK || h.i == first.i) {
                break;
            }
        }
        uint32_t i = place_of(&p->group, member);
        member = status != HE_OK || i == HE_NONE ? HE_NONE : p->next[i];
    }
    return status;
}

static bool is_boundary(const plan *p, he_halfedge h)
{
    return claimant(p, h).i == HE_NONE;
}

/* Link the fans about rim vertex i, and choose what it stores. */
static he_status link_fans(plan *p, size_t i, const he_ids *ring, he_error *err)
{
    he_vertex v = {p->rim.ids[i]};
    he_halfedge old = he_vertex_halfedge(p->m, v);
    he_halfedge first_in = {HE_NONE}, out = {HE_NONE};
    size_t seen = 0;
    he_status status = HE_OK;
    p->stored[i] = place_of(&p->group, v.i) == HE_NONE ? HE_DEAD : HE_NONE;
    for (size_t k = 0; status == HE_OK && k < ring->count; k++) {
        he_halfedge h = {ring->ids[k]};
        if (is_boundary(p, h) || !is_boundary(p, he_twin(h))) {
            continue;
        }
        /* A fan begins; what leaves the one before it follows what enters this one. */
        if (out.i != HE_NONE) {
            status = he_ids_add(&p->holes, he_twin(h).i, err);
            if (status == HE_OK) {
                status = he_ids_add(&p->holes, out.i, err);
            }
        } else {
            first_in = he_twin(h);
        }
        for (; !is_boundary(p, h) && seen < ring->count; seen++) {
            h = turn(p, h);
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
            h = turn(p, h);
            seen++;
        } while (h.i != first.i && seen < ring->count);
        p->stored[i] = old.i < HE_DEAD && stays(p, old) ? old.i : first.i;
    }
    if (status == HE_OK && seen != ring->count) {
        return he_fail(err, HE_CLOSED_FAN, HE_VERTEX, v.i,
                       "vertex %u would have a closed fan and another", v.i);
    }
    return status;
}

static he_status find_fans(plan *p, he_error *err)
{
    he_ids ring = {0};
    he_status status = find_rim(p, err);
    for (size_t i = 0; status == HE_OK && i < p->rim.count; i++) {
        status = he_watch_at(p->m->watch, i, p->rim.count, err);
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

/* --- marks ---------------------------------------------------------------------------------- */

static bool goes_into_another(const plan *p, he_vertex v)
{
    return rep(p, v).i != v.i;
}

static he_vec3 place(const plan *p, uint32_t i)
{
    const he_mesh *m = p->m;
    he_vec3 mean = he_position(m, (he_vertex){p->group.ids[i]});
    if (p->how->place == HE_MERGE_INTO) {
        return mean;
    }
    double count = 1;
    for (uint32_t v = p->next[i]; v != HE_NONE; v = p->next[place_of(&p->group, v)]) {
        he_vec3 at = he_position(m, (he_vertex){v});
        count++;
        mean = he_point_between(mean, at, 1 / count);
    }
    return mean;
}

static he_status check_faces(const plan *p, const he_marks *marks, he_error *err)
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

static he_status check_marks(plan *p, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(p->m, &marks)) {
        return HE_OK;
    }
    he_status status = check_faces(p, &marks, err);
    for (uint32_t i = 0; status == HE_OK && i < p->group.count; i++) {
        he_vertex v = {p->group.ids[i]};
        he_vec3 from = he_position(p->m, v), to = place(p, i);
        bool moves = from.x != to.x || from.y != to.y || from.z != to.z;
        if (goes_into_another(p, v) || moves) {
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
        if (!stays(p, h) || goes_into_another(p, he_origin(p->m, h)) ||
            goes_into_another(p, he_target(p->m, h))) {
            status = he_require_unlocked(&marks, HE_EDGE, p->edges.ids[i], err);
        }
    }
    return status;
}

/* --- writing -------------------------------------------------------------------------------- */

static he_status reserve(plan *p, he_error *err)
{
    he_need need = {.deleted_edges = p->edges.count, .deleted_faces = p->faces.count};
    need.deleted_vertices = p->how->count + p->rim.count;
    need.links =
        3 * p->corners + p->faces.count + 4 * p->edges.count + p->holes.count + p->rim.count;
    need.positions = p->group.count;
    need.attributes = p->corners + p->edges.count + p->group.count;
    need.lineage = p->edges.count + p->faces.count + p->group.count;
    return he_reserve(p->m, need, err);
}

/* Corners of a face move to the half-edges that take the place of theirs. Each is read before
 * anything is written that leads to it. */
static void relink_face(const plan *p, he_face f)
{
    he_mesh *m = p->m;
    he_halfedge stored = he_face_halfedge(m, f);
    he_halfedge first = is_drawn_together(p, stored) ? after(p, stored) : stored, h = first;
    do {
        he_halfedge next = after(p, h), mine = heir(p, h);
        if (mine.i != h.i) {
            he_set_face(m, mine, f);
            he_carry_move(m, HE_HALFEDGE, mine.i, h.i);
        }
        he_link(m, mine, heir(p, next));
        h = next;
    } while (h.i != first.i);
    if (heir(p, first).i != stored.i) {
        he_set_face_halfedge(m, f, heir(p, first));
    }
}

/* The means of all that became one, one after another. */
static void carry_vertices(const plan *p, uint32_t i)
{
    double count = 1;
    if (p->how->place == HE_MERGE_INTO) {
        return;
    }
    for (uint32_t v = p->next[i]; v != HE_NONE; v = p->next[place_of(&p->group, v)]) {
        he_carry_merge(p->m, HE_VERTEX, p->group.ids[i], v, count / (count + 1));
        count++;
    }
}

static void write_vertices(const plan *p)
{
    he_mesh *m = p->m;
    for (uint32_t i = 0; i < p->group.count; i++) {
        if (p->rep[i] == p->group.ids[i]) {
            he_vertex v = {p->group.ids[i]};
            he_set_position(m, v, place(p, i));
            carry_vertices(p, i);
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

static void write_edges(const plan *p)
{
    he_mesh *m = p->m;
    for (size_t i = 0; i < p->edges.count; i++) {
        he_edge e = {p->edges.ids[i]};
        fate *f = &p->fates[i];
        he_halfedge h = he_edge_halfedge(e, 0);
        if (stays(p, h)) {
            for (unsigned side = 0; side < 2; side++) {
                he_halfedge k = he_edge_halfedge(e, side);
                he_vertex v = rep(p, he_origin(m, k));
                if (v.i != he_origin(m, k).i) {
                    he_set_origin(m, k, v);
                }
                if (f->claim[side] == HE_NONE && !he_is_boundary_halfedge(m, k)) {
                    he_set_face(m, k, (he_face){HE_NONE});
                }
            }
            continue;
        }
        if (f->into != HE_NONE && f->into != e.i && stays(p, heir(p, h))) {
            fate *to = &p->fates[place_of(&p->edges, f->into)];
            double taken = to->taken++;
            he_carry_merge(m, HE_EDGE, f->into, e.i, taken / (taken + 1));
            he_note_merged(m, HE_EDGE, e.i, f->into);
        }
    }
}

static void commit(const plan *p)
{
    he_mesh *m = p->m;
    for (size_t i = 0; i < p->faces.count; i++) {
        he_watch_note(m->watch, i, p->faces.count);
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
        if (!stays(p, he_edge_halfedge((he_edge){p->edges.ids[i]}, 0))) {
            he_delete_edge(m, (he_edge){p->edges.ids[i]});
        }
    }
    write_vertices(p);
}

he_status he_merge_vertices(he_mesh *m, const he_merge *how, he_error *err)
{
    static const struct {
        he_status (*run)(plan *p, he_error *err);
        const char *phase;
        double to;
    } parts[] = {
        {find_group, "finding vertices", 0.5}, {find_rings, "finding faces", 0.55},
        {find_faces, "measuring faces", 0.65}, {pair_edges, "pairing edges", 0.7},
        {claim_edges, "checking edges", 0.8},  {find_fans, "checking fans", 0.9},
        {check_marks, "checking marks", 0.92}, {reserve, "merging", 1},
    };
    plan p = {.m = m, .how = how};
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < sizeof parts / sizeof *parts; i++) {
        status = he_watch_phase(m->watch, parts[i].phase, parts[i].to, err);
        if (status == HE_OK) {
            status = parts[i].run(&p, err);
        }
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(&p);
    }
    clear(&p);
    return status;
}
