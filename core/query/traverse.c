#include "query/traverse.h"

#include "mesh/walk.h"
#include "query/idmap.h"

#include <string.h>

/* Returns the number of half-edges ever issued. A link that is not below this number leads to no
 * half-edge. */
static uint32_t halfedge_end(const he_mesh *m)
{
    return 2u * m->c.edges.issued;
}

static he_status corrupt(he_kind kind, uint32_t id, he_error *err)
{
    return he_fail(err, HE_CORRUPT, kind, id,
                   "the links of the mesh are damaged: a walk from %s %u does not end",
                   he_kind_name(kind), id);
}

static he_status append(he_ids *out, const he_ids *more, he_error *err)
{
    he_status status = he_ids_reserve(out, more->count, err);
    if (status == HE_OK && more->count > 0) {
        memcpy(out->ids + out->count, more->ids, more->count * sizeof *more->ids);
        out->count += more->count;
    }
    return status;
}

static uint32_t take(const he_mesh *m, uint32_t h, he_step step)
{
    switch (step) {
    case HE_STEP_NEXT:
        return m->c.next[h];
    case HE_STEP_PREV:
        return m->c.prev[h];
    case HE_STEP_TWIN:
        return h ^ 1u;
    }
    return HE_NONE;
}

static he_status walk_path(const he_mesh *m, he_halfedge from, const he_path_steps *steps,
                           he_progress *progress, he_ids *out, he_error *err)
{
    const uint32_t end = halfedge_end(m);
    uint32_t h = from.i;
    uint64_t taken = 0;
    he_status status = he_ids_add(out, h, err);
    for (uint64_t round = 0; round < steps->repeat && status == HE_OK; round++) {
        if (steps->until != HE_UNTIL_COUNT && round == end) {
            return corrupt(HE_HALFEDGE, from.i, err);
        }
        for (size_t i = 0; i < steps->count && status == HE_OK; i++) {
            /* The number of steps is not known in advance, so no progress is reported; the call
             * only checks whether the request was cancelled. */
            status = he_progress_at(progress, taken, UINT64_MAX, err);
            if (status != HE_OK) {
                return status;
            }
            if (taken++ == steps->limit && steps->limit != 0) {
                return he_fail_plain(err, HE_LIMIT,
                                     "the path of the walk is longer than %llu steps",
                                     (unsigned long long)steps->limit);
            }
            h = take(m, h, steps->list[i]);
            if (h >= end) {
                return corrupt(HE_HALFEDGE, from.i, err);
            }
            status = he_ids_add(out, h, err);
            if ((steps->until == HE_UNTIL_START && h == from.i) ||
                (steps->until == HE_UNTIL_BOUNDARY && m->c.face[h] == HE_NONE)) {
                return status;
            }
        }
        if (steps->until == HE_UNTIL_BOUNDARY && h == from.i) {
            return status;
        }
    }
    return status;
}

he_status he_traverse_path(const he_mesh *m, he_halfedge from, const he_path_steps *steps,
                           he_progress *progress, he_ids *out, he_error *err)
{
    he_status status = he_mesh_require(m, HE_HALFEDGE, from.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (steps->count == 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "a path needs at least one step");
    }
    size_t before = out->count;
    status = walk_path(m, from, steps, progress, out, err);
    if (status != HE_OK) {
        out->count = before;
    }
    return status;
}

he_status he_traverse_loop(const he_mesh *m, he_halfedge from, he_ids *out, he_error *err)
{
    he_status status = he_mesh_require(m, HE_HALFEDGE, from.i, err);
    if (status != HE_OK) {
        return status;
    }
    size_t before = out->count;
    uint32_t h = from.i, steps = 0;
    do {
        if (h >= halfedge_end(m) || steps++ == halfedge_end(m)) {
            status = corrupt(HE_HALFEDGE, from.i, err);
        } else {
            status = he_ids_add(out, h, err);
            h = m->c.next[h];
        }
    } while (status == HE_OK && h != from.i);
    if (status != HE_OK) {
        out->count = before;
    }
    return status;
}

/* The elements that a breadth-first walk has reached, in the order in which it reached them, and
 * the depth of each. */
typedef struct flood {
    he_idmap met;
    he_ids depths;
} flood;

static void flood_clear(flood *f)
{
    he_idmap_clear(&f->met);
    he_ids_clear(&f->depths);
}

static he_status meet(flood *f, uint32_t id, uint32_t depth, he_error *err)
{
    uint32_t index;
    bool added;
    he_status status = he_ids_reserve(&f->depths, 1, err);
    if (status == HE_OK) {
        status = he_idmap_add(&f->met, id, &index, &added, err);
    }
    if (status == HE_OK && added) {
        f->depths.ids[f->depths.count++] = depth;
    }
    return status;
}

/* Visits elements in breadth-first order from the element `walk->from`. The whole walk visits each
 * half-edge at most once; if it would visit more, links of the mesh are damaged. */
static he_status flood_from(const he_mesh *m, const he_breadth_first *walk, flood *f, he_error *err)
{
    const he_kind kind = walk->kind;
    const size_t limit = walk->limit;
    const uint32_t end = halfedge_end(m);
    uint32_t steps = 0;
    he_status status = meet(f, walk->from, 0, err);
    for (size_t i = 0; i < f->met.ids.count && status == HE_OK; i++) {
        uint32_t id = f->met.ids.ids[i], at = f->depths.ids[i];
        if (at >= walk->depth || (limit != 0 && f->met.ids.count >= limit)) {
            break;
        }
        uint32_t first = kind == HE_VERTEX ? m->c.vertex_halfedge[id] : m->c.face_halfedge[id];
        if (first == HE_NONE) {
            continue;
        }
        uint32_t h = first;
        do {
            if (h >= end || steps++ == end) {
                return corrupt(kind, walk->from, err);
            }
            uint32_t beside = kind == HE_VERTEX ? m->c.origin[h ^ 1u] : m->c.face[h ^ 1u];
            uint32_t issued = kind == HE_VERTEX ? m->c.vertices.issued : m->c.faces.issued;
            if (beside < issued) {
                status = meet(f, beside, at + 1, err);
            } else if (kind == HE_VERTEX || beside != HE_NONE) {
                return corrupt(kind, walk->from, err);
            }
            h = kind == HE_VERTEX ? m->c.prev[h] ^ 1u : m->c.next[h];
        } while (status == HE_OK && h != first && (limit == 0 || f->met.ids.count < limit));
    }
    return status;
}

he_status he_traverse_breadth_first(const he_mesh *m, const he_breadth_first *walk, he_ids *ids,
                                    he_ids *depths, he_error *err)
{
    if (walk->kind != HE_VERTEX && walk->kind != HE_FACE) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "a breadth-first walk must begin at a vertex or a face");
    }
    he_status status = he_mesh_require(m, walk->kind, walk->from, err);
    if (status != HE_OK) {
        return status;
    }
    flood f = {0};
    size_t ids_before = ids->count, depths_before = depths->count;
    status = flood_from(m, walk, &f, err);
    if (status == HE_OK) {
        status = append(ids, &f.met.ids, err);
    }
    if (status == HE_OK) {
        status = append(depths, &f.depths, err);
    }
    if (status != HE_OK) {
        ids->count = ids_before;
        depths->count = depths_before;
    }
    flood_clear(&f);
    return status;
}

/* A function that returns the half-edge after `h` in an edge loop or an edge ring. It returns
 * HE_NONE if the loop or ring ends at `h`, HE_DEAD if links of the mesh are damaged. */
typedef uint32_t (*onward)(const he_mesh *m, uint32_t h);

/* Continues an edge loop beyond the target of `h`: if the target is inside the mesh and has four
 * edges, returns the half-edge opposite to `h` there. */
static uint32_t straight_on(const he_mesh *m, uint32_t h)
{
    uint32_t around[5] = {h ^ 1u};
    for (int i = 1; i < 5; i++) {
        around[i] = m->c.prev[around[i - 1]] ^ 1u;
        if (around[i] >= halfedge_end(m)) {
            return HE_DEAD;
        }
        if (m->c.face[around[i]] == HE_NONE) {
            return HE_NONE;
        }
        if (around[i] == around[0] && i < 4) {
            return HE_NONE;
        }
    }
    return around[4] == around[0] ? around[2] : HE_NONE;
}

/* Continues an edge ring across the face of `h`: if the face has four sides, returns the twin of
 * the side opposite to `h`. */
static uint32_t across(const he_mesh *m, uint32_t h)
{
    if (m->c.face[h] == HE_NONE) {
        return HE_NONE;
    }
    uint32_t around[5] = {h};
    for (int i = 1; i < 5; i++) {
        around[i] = m->c.next[around[i - 1]];
        if (around[i] >= halfedge_end(m)) {
            return HE_DEAD;
        }
        if (around[i] == h && i < 4) {
            return HE_NONE;
        }
    }
    return around[4] == h ? around[2] ^ 1u : HE_NONE;
}

/* Appends to `out` the edges of an edge loop or edge ring after `first`, until the loop or ring
 * ends or returns to `first`. */
static he_status follow(const he_mesh *m, uint32_t first, onward step, he_ids *out, bool *closed,
                        he_error *err)
{
    *closed = false;
    size_t before = out->count;
    for (uint32_t h = step(m, first); h != HE_NONE; h = step(m, h)) {
        if (h == first) {
            *closed = true;
            return HE_OK;
        }
        if (h == HE_DEAD || out->count - before >= m->c.edges.issued) {
            return corrupt(HE_EDGE, first >> 1, err);
        }
        he_status status = he_ids_add(out, h >> 1, err);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

static he_status both_ways(const he_mesh *m, he_edge from, onward step, he_ids *out, bool *closed,
                           he_error *err)
{
    he_status status = he_mesh_require(m, HE_EDGE, from.i, err);
    if (status != HE_OK) {
        return status;
    }
    he_ids ahead = {0}, behind = {0};
    size_t before = out->count;
    bool met = false, met_behind;
    status = follow(m, 2u * from.i, step, &ahead, &met, err);
    if (status == HE_OK && !met) {
        status = follow(m, 2u * from.i + 1u, step, &behind, &met_behind, err);
    }
    he_ids_reverse(&behind);
    if (status == HE_OK) {
        status = append(out, &behind, err);
    }
    if (status == HE_OK) {
        status = he_ids_add(out, from.i, err);
    }
    if (status == HE_OK) {
        status = append(out, &ahead, err);
    }
    if (status == HE_OK) {
        *closed = met;
    } else {
        out->count = before;
    }
    he_ids_clear(&ahead);
    he_ids_clear(&behind);
    return status;
}

he_status he_traverse_edge_loop(const he_mesh *m, he_edge from, he_ids *out, bool *closed,
                                he_error *err)
{
    return both_ways(m, from, straight_on, out, closed, err);
}

he_status he_traverse_edge_ring(const he_mesh *m, he_edge from, he_ids *out, bool *closed,
                                he_error *err)
{
    return both_ways(m, from, across, out, closed, err);
}
