#include "query/adjacency.h"

#include "mesh/walk.h"
#include "query/idmap.h"

#include <string.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))

typedef struct he_gather {
    /* Ids of the elements whose neighbours are listed. NULL: the neighbours of every live element
     * are listed. */
    const uint32_t *of;
    size_t count; /* number of entries of `of`; if `of` is NULL, the number of ids ever issued */
    he_ids *ids;
    /* Where the next offset is written: the index in `ids` at which the neighbours of an element
     * end. NULL if no offsets are needed. */
    uint32_t *offsets;
    uint64_t budget; /* number of half-edges that may still be visited */
    bool capped;     /* true if the size of the mesh limits `budget`, not the caller */
    unsigned flags;
} he_gather;

static he_status corrupt(he_kind kind, uint32_t id, he_error *err)
{
    return he_fail(err, HE_CORRUPT, kind, id, "the half-edges around %s %u do not form a loop",
                   he_kind_name(kind), id);
}

static he_status exhausted(const he_gather *g, he_kind kind, uint32_t id, he_error *err)
{
    if (g->capped) {
        return corrupt(kind, id, err);
    }
    return he_fail(err, HE_LIMIT, kind, id, "the answer is too long: its limit is reached at %s %u",
                   he_kind_name(kind), id);
}

static void turn_clockwise(he_ids *ids, size_t from)
{
    size_t i = from + 1, j = ids->count;
    while (i + 1 < j) {
        uint32_t id = ids->ids[i];
        ids->ids[i++] = ids->ids[--j];
        ids->ids[j] = id;
    }
}

/* What a walk over half-edges lists for each half-edge that it visits: the half-edge itself, its
 * twin, edge, origin, target or face. */
typedef enum reading { ITSELF, TWIN, EDGE, ORIGIN, TARGET, FACE } reading;
/* Which half-edge a walk visits next: TURN is the next half-edge around the origin, NEXT the next
 * half-edge around the face. */
typedef enum way { TURN, NEXT } way;

static ALWAYS_INLINE uint32_t read(const he_mesh *m, uint32_t h, reading what)
{
    switch (what) {
    case ITSELF:
        return h;
    case TWIN:
        return h ^ 1u;
    case EDGE:
        return h >> 1;
    case ORIGIN:
        return m->c.origin[h];
    case TARGET:
        return m->c.origin[h ^ 1u];
    case FACE:
        return m->c.face[h];
    }
    return HE_NONE;
}

/* Returns the half-edge at which the walk around an element begins; HE_NONE if the element is an
 * isolated vertex. */
static ALWAYS_INLINE uint32_t start_of(const he_mesh *m, he_kind kind, uint32_t id)
{
    if (kind == HE_VERTEX) {
        return m->c.vertex_halfedge[id];
    }
    return kind == HE_FACE ? m->c.face_halfedge[id] : id;
}

/* Lists the neighbours of elements by walking over half-edges. The function is inlined into the
 * function of each relation with constant `kind`, `path` and `what`, so a query for a million
 * vertices never branches on these three parameters. Where a link is missing or leads to a deleted
 * element, it holds an id beyond all half-edges, so each id is compared with `end` before it is
 * used as an index. */
static ALWAYS_INLINE he_status walk(const he_mesh *m, he_gather *g, he_kind kind, way path,
                                    reading what, he_error *err)
{
    const uint32_t *follow = path == TURN ? m->c.prev : m->c.next;
    const uint32_t flip = path == TURN ? 1u : 0u;
    const uint32_t end = 2u * m->c.edges.issued;
    const uint32_t longest = end;
    uint32_t *out = g->ids->ids;
    size_t n = g->ids->count, room = g->ids->capacity;
    uint64_t budget = g->budget;
    uint32_t *offsets = g->offsets;
    for (size_t i = 0; i < g->count; i++) {
        uint32_t id = (uint32_t)i;
        if (g->of != NULL) {
            id = g->of[i];
        } else if (!(kind == HE_VERTEX ? he_vertex_is_live(m, (he_vertex){id})
                     : kind == HE_FACE ? he_face_is_live(m, (he_face){id})
                                       : he_edge_is_live(m, (he_edge){id >> 1}))) {
            continue;
        }
        size_t from = n;
        uint32_t first = start_of(m, kind, id);
        if (first != HE_NONE) {
            uint32_t h = first, steps = 0;
            do {
                if (h >= end || steps++ == longest) {
                    return corrupt(kind, id, err);
                }
                if (budget-- == 0) {
                    return exhausted(g, kind, id, err);
                }
                if (n == room) {
                    g->ids->count = n;
                    he_status status = he_ids_reserve(g->ids, 1, err);
                    if (status != HE_OK) {
                        return status;
                    }
                    out = g->ids->ids;
                    room = g->ids->capacity;
                }
                uint32_t value = read(m, h, what);
                out[n] = value;
                n += what != FACE || value != HE_NONE;
                h = follow[h] ^ flip;
            } while (h != first);
        }
        g->ids->count = n;
        if (g->flags & HE_CLOCKWISE) {
            turn_clockwise(g->ids, from);
        }
        if (offsets != NULL) {
            *offsets++ = (uint32_t)n;
        }
    }
    g->budget = budget;
    g->offsets = offsets;
    return HE_OK;
}

static he_status vertex_vertices(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_VERTEX, TURN, TARGET, err);
}

static he_status vertex_outgoing(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_VERTEX, TURN, ITSELF, err);
}

static he_status vertex_incoming(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_VERTEX, TURN, TWIN, err);
}

static he_status vertex_edges(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_VERTEX, TURN, EDGE, err);
}

static he_status vertex_faces(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_VERTEX, TURN, FACE, err);
}

static he_status face_vertices(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_FACE, NEXT, ORIGIN, err);
}

static he_status face_halfedges(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_FACE, NEXT, ITSELF, err);
}

static he_status face_edges(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_FACE, NEXT, EDGE, err);
}

static he_status halfedge_loop(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_HALFEDGE, NEXT, ITSELF, err);
}

static he_status halfedge_ring(const he_mesh *m, he_gather *g, he_error *err)
{
    return walk(m, g, HE_HALFEDGE, TURN, ITSELF, err);
}

/* As long as an element has fewer neighbours than FEW, each new neighbour is compared with all
 * earlier ones to find repeats. With more neighbours, the repeats are found by the set `seen`. */
enum { FEW = 16 };

/* Appends `face` to the neighbours of an element unless `face` is already one of these neighbours,
 * which begin at index `from`. */
static he_status add_once(he_ids *ids, size_t from, he_idmap *seen, uint32_t face, he_error *err)
{
    uint32_t index;
    bool added = true;
    size_t run = ids->count - from;
    if (run < FEW) {
        for (size_t i = from; i < ids->count; i++) {
            added = added && ids->ids[i] != face;
        }
    } else {
        for (size_t i = seen->ids.count; i < run; i++) {
            he_status status = he_idmap_add(seen, ids->ids[from + i], &index, &added, err);
            if (status != HE_OK) {
                return status;
            }
        }
        added = he_idmap_find(seen, face) == HE_NONE;
    }
    return added ? he_ids_add(ids, face, err) : HE_OK;
}

static he_status faces_across(const he_mesh *m, he_gather *g, uint32_t id, he_error *err)
{
    const uint32_t end = 2u * m->c.edges.issued;
    size_t from = g->ids->count;
    he_idmap seen = {0};
    he_status status = HE_OK;
    uint32_t first = m->c.face_halfedge[id], h = first, steps = 0;
    do {
        if (h >= end || steps++ == end) {
            status = corrupt(HE_FACE, id, err);
        } else if (g->budget-- == 0) {
            status = exhausted(g, HE_FACE, id, err);
        } else {
            uint32_t face = m->c.face[h ^ 1u];
            if (face != HE_NONE) {
                status = add_once(g->ids, from, &seen, face, err);
            }
            h = m->c.next[h];
        }
    } while (status == HE_OK && h != first);
    he_idmap_clear(&seen);
    return status;
}

static he_status face_faces(const he_mesh *m, he_gather *g, he_error *err)
{
    for (size_t i = 0; i < g->count; i++) {
        uint32_t id = g->of != NULL ? g->of[i] : (uint32_t)i;
        if (g->of == NULL && !he_face_is_live(m, (he_face){id})) {
            continue;
        }
        size_t from = g->ids->count;
        he_status status = faces_across(m, g, id, err);
        if (status != HE_OK) {
            return status;
        }
        if (g->flags & HE_CLOCKWISE) {
            turn_clockwise(g->ids, from);
        }
        if (g->offsets != NULL) {
            *g->offsets++ = (uint32_t)g->ids->count;
        }
    }
    return HE_OK;
}

/* Lists what `what` selects of the two half-edges of each edge: their faces, for example. A list of
 * at most two elements is both clockwise and counter-clockwise, so the flag HE_CLOCKWISE changes
 * nothing. */
static ALWAYS_INLINE he_status sides(const he_mesh *m, he_gather *g, reading what, he_error *err)
{
    for (size_t i = 0; i < g->count; i++) {
        uint32_t id = g->of != NULL ? g->of[i] : (uint32_t)i;
        if (g->of == NULL && !he_edge_is_live(m, (he_edge){id})) {
            continue;
        }
        if (g->budget < 2) {
            return exhausted(g, HE_EDGE, id, err);
        }
        g->budget -= 2;
        he_status status = he_ids_reserve(g->ids, 2, err);
        if (status != HE_OK) {
            return status;
        }
        uint32_t a = read(m, 2u * id, what), b = read(m, 2u * id + 1u, what);
        uint32_t *out = g->ids->ids + g->ids->count;
        size_t n = 0;
        if (a != HE_NONE) {
            out[n++] = a;
        }
        if (b != HE_NONE && b != a) {
            out[n++] = b;
        }
        g->ids->count += n;
        if (g->offsets != NULL) {
            *g->offsets++ = (uint32_t)g->ids->count;
        }
    }
    return HE_OK;
}

static he_status edge_vertices(const he_mesh *m, he_gather *g, he_error *err)
{
    return sides(m, g, ORIGIN, err);
}

static he_status edge_halfedges(const he_mesh *m, he_gather *g, he_error *err)
{
    return sides(m, g, ITSELF, err);
}

static he_status edge_faces(const he_mesh *m, he_gather *g, he_error *err)
{
    return sides(m, g, FACE, err);
}

static const he_relation relations[] = {
    {HE_VERTEX, HE_VERTEX, "vertices", vertex_vertices},
    {HE_VERTEX, HE_HALFEDGE, "outgoing", vertex_outgoing},
    {HE_VERTEX, HE_HALFEDGE, "incoming", vertex_incoming},
    {HE_VERTEX, HE_EDGE, "edges", vertex_edges},
    {HE_VERTEX, HE_FACE, "faces", vertex_faces},
    {HE_FACE, HE_VERTEX, "vertices", face_vertices},
    {HE_FACE, HE_HALFEDGE, "halfedges", face_halfedges},
    {HE_FACE, HE_EDGE, "edges", face_edges},
    {HE_FACE, HE_FACE, "faces", face_faces},
    {HE_EDGE, HE_VERTEX, "vertices", edge_vertices},
    {HE_EDGE, HE_HALFEDGE, "halfedges", edge_halfedges},
    {HE_EDGE, HE_FACE, "faces", edge_faces},
    {HE_HALFEDGE, HE_HALFEDGE, "loop", halfedge_loop},
    {HE_HALFEDGE, HE_HALFEDGE, "ring", halfedge_ring},
};

size_t he_relation_count(void)
{
    return sizeof relations / sizeof relations[0];
}

const he_relation *he_relation_at(size_t i)
{
    return &relations[i];
}

const he_relation *he_relation_find(he_kind of, const char *name, size_t length)
{
    for (size_t i = 0; i < he_relation_count(); i++) {
        const char *own = relations[i].name;
        if (relations[i].of == of && strlen(own) == length && memcmp(own, name, length) == 0) {
            return &relations[i];
        }
    }
    return NULL;
}

he_status he_relation_append(const he_mesh *m, const he_relation *relation, uint32_t id,
                             unsigned flags, he_ids *out, he_error *err)
{
    he_status status = he_mesh_require(m, relation->of, id, err);
    if (status != HE_OK) {
        return status;
    }
    size_t before = out->count;
    he_gather g = {.of = &id, .count = 1, .ids = out, .budget = UINT64_MAX, .flags = flags};
    status = relation->append(m, &g, err);
    if (status != HE_OK) {
        out->count = before;
    }
    return status;
}

/* Returns an upper bound of the number of neighbours that a relation lists for all elements of the
 * mesh together; the bound is exact for most relations. Returns 0 for relations of half-edges, for
 * which the size of the mesh gives no bound: the relation `loop` lists a whole loop for each
 * half-edge of the loop. */
static uint64_t bound(const he_mesh *m, const he_relation *relation)
{
    return relation->of == HE_HALFEDGE ? 0 : 2u * (uint64_t)m->c.edges.live;
}

he_status he_relation_dense(const he_mesh *m, const he_neighbours *asked, uint64_t limit,
                            he_dense *out, he_error *err)
{
    const he_relation *relation = asked->relation;
    const uint32_t *of = asked->of;
    if (limit == 0 || limit > UINT32_MAX) {
        limit = UINT32_MAX;
    }
    he_gather g = {.of = of, .count = asked->count, .budget = limit, .flags = asked->flags};
    he_dense dense = {0};
    g.ids = &dense.ids;
    he_status status = HE_OK;
    if (of == NULL) {
        g.count = he_mesh_issued(m, relation->of);
        uint64_t most = bound(m, relation);
        if (most > 0 && most <= limit) {
            g.budget = most;
            g.capped = true;
            status = he_ids_reserve(&dense.ids, most, err);
        }
    }
    for (size_t i = 0; of != NULL && i < asked->count && status == HE_OK; i++) {
        status = he_mesh_require(m, relation->of, of[i], err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&dense.offsets, g.count + 1, err);
    }
    if (status == HE_OK) {
        dense.offsets.ids[0] = 0;
        g.offsets = dense.offsets.ids + 1;
        status = relation->append(m, &g, err);
        dense.offsets.count = (size_t)(g.offsets - dense.offsets.ids);
    }
    if (status != HE_OK) {
        he_dense_clear(&dense);
        return status;
    }
    *out = dense;
    return HE_OK;
}

void he_dense_clear(he_dense *dense)
{
    he_ids_clear(&dense->offsets);
    he_ids_clear(&dense->ids);
}

he_status he_common_faces(const he_mesh *m, he_vertex a, he_vertex b, he_ids *out, he_error *err)
{
    const he_relation *faces = he_relation_find(HE_VERTEX, "faces", strlen("faces"));
    he_ids about_a = {0}, about_b = {0};
    he_idmap at_b = {0};
    size_t before = out->count;
    he_status status = he_relation_append(m, faces, a.i, 0, &about_a, err);
    if (status == HE_OK) {
        status = he_relation_append(m, faces, b.i, 0, &about_b, err);
    }
    for (size_t i = 0; status == HE_OK && i < about_b.count; i++) {
        uint32_t index;
        bool added;
        status = he_idmap_add(&at_b, about_b.ids[i], &index, &added, err);
    }
    for (size_t i = 0; status == HE_OK && i < about_a.count; i++) {
        if (he_idmap_find(&at_b, about_a.ids[i]) != HE_NONE) {
            status = he_ids_add(out, about_a.ids[i], err);
        }
    }
    if (status != HE_OK) {
        out->count = before;
    }
    he_ids_clear(&about_a);
    he_ids_clear(&about_b);
    he_idmap_clear(&at_b);
    return status;
}
