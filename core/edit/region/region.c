#include "edit/region/region.h"

#include "edit/piece/list.h"
#include "edit/piece/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

/* An upper bound of the links that are written for one half-edge of the rim: its own links, those
 * of its neighbours in the loop, and the half-edges that its face and its origin store. */
enum { RIM_LINKS = 11 };

static void region_clear(he_region *r)
{
    he_idmap_clear(&r->faces);
    he_idmap_clear(&r->corners);
    he_ids_clear(&r->rim);
    he_ids_clear(&r->inner);
    he_ids_clear(&r->inner_at);
}

void he_region_parts_clear(he_region_parts *parts)
{
    he_ids_clear(&parts->vertices);
    he_ids_clear(&parts->edges);
    he_ids_clear(&parts->faces);
}

static bool is_inside(const he_region *r, he_face f)
{
    return f.i != HE_NONE && he_idmap_find(&r->faces, f.i) != HE_NONE;
}

/* Adds to region r all faces of the set `listed` that are connected to r across edges. */
static he_status spread(const he_mesh *m, he_region *r, const he_idmap *listed, he_error *err)
{
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        he_halfedge first = he_face_halfedge(m, (he_face){r->faces.ids.ids[i]}), h = first;
        do {
            he_face f = he_face_of(m, he_twin(h));
            if (f.i != HE_NONE && he_idmap_find(listed, f.i) != HE_NONE) {
                uint32_t index;
                bool added;
                he_status status = he_idmap_add(&r->faces, f.i, &index, &added, err);
                if (status != HE_OK) {
                    return status;
                }
            }
            h = he_next(m, h);
        } while (h.i != first.i);
    }
    return HE_OK;
}

static he_status add_rim(const he_mesh *m, he_region *r, he_halfedge h, he_error *err)
{
    uint32_t index, v = he_origin(m, h).i;
    bool added;
    he_status status = he_idmap_add(&r->corners, v, &index, &added, err);
    if (status != HE_OK) {
        return status;
    }
    if (!added) {
        return he_fail(err, HE_RIM_MEETS_ITSELF, HE_VERTEX, v,
                       "the outline of the faces passes vertex %u twice", v);
    }
    return he_ids_add(&r->rim, h.i, err);
}

static he_status find_rim(const he_mesh *m, he_region *r, he_error *err)
{
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        he_halfedge first = he_face_halfedge(m, (he_face){r->faces.ids.ids[i]}), h = first;
        do {
            he_status status =
                is_inside(r, he_face_of(m, he_twin(h))) ? HE_OK : add_rim(m, r, h, err);
            if (status != HE_OK) {
                return status;
            }
            h = he_next(m, h);
        } while (h.i != first.i);
    }
    if (r->rim.count == 0) {
        uint32_t f = r->faces.ids.ids[0];
        return he_fail(err, HE_NO_RIM, HE_FACE, f,
                       "face %u and the other listed faces are a whole closed component, so they "
                       "have no outline",
                       f);
    }
    return HE_OK;
}

/* Lists in r->inner the half-edges inside the region that leave vertices of the rim. The half-edges
 * of the rim itself are not listed. */
static he_status find_inner(const he_mesh *m, he_region *r, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < r->rim.count; i++) {
        he_halfedge k = he_swing_ccw(m, (he_halfedge){r->rim.ids[i]});
        for (; status == HE_OK && is_inside(r, he_face_of(m, k)); k = he_swing_ccw(m, k)) {
            status = he_ids_add(&r->inner, k.i, err);
            if (status == HE_OK) {
                status = he_ids_add(&r->inner_at, (uint32_t)i, err);
            }
        }
    }
    return status;
}

static he_status check_locks(const he_mesh *m, const he_region *r, he_error *err)
{
    he_marks marks;
    he_status status = HE_OK;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    for (size_t i = 0; status == HE_OK && i < r->rim.count; i++) {
        he_face f = he_face_of(m, (he_halfedge){r->rim.ids[i]});
        status = he_require_unlocked(&marks, HE_FACE, f.i, err);
    }
    for (size_t i = 0; status == HE_OK && i < r->inner.count; i++) {
        he_halfedge h = {r->inner.ids[i]};
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, h).i, err);
        if (status == HE_OK) {
            status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(h).i, err);
        }
    }
    return status;
}

/* Lists the vertices of the region that are not on its rim. */
static he_status find_inside(const he_mesh *m, const he_region *r, he_idmap *out, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < r->faces.ids.count; i++) {
        he_halfedge first = he_face_halfedge(m, (he_face){r->faces.ids.ids[i]}), h = first;
        do {
            uint32_t index, v = he_origin(m, h).i;
            bool added;
            if (he_idmap_find(&r->corners, v) == HE_NONE) {
                status = he_idmap_add(out, v, &index, &added, err);
            }
            h = he_next(m, h);
        } while (status == HE_OK && h.i != first.i);
    }
    return status;
}

static he_status check_inside(const he_mesh *m, const he_idmap *inside, he_vec3 shift,
                              he_error *err)
{
    he_marks marks;
    bool marked = he_marks_find(m, &marks);
    for (size_t i = 0; i < inside->ids.count; i++) {
        he_vertex v = {inside->ids.ids[i]};
        he_vec3 p = he_position(m, v);
        he_status status = marked ? he_require_unlocked(&marks, HE_VERTEX, v.i, err) : HE_OK;
        if (status != HE_OK) {
            return status;
        }
        if (!he_point_is_finite((he_vec3){p.x + shift.x, p.y + shift.y, p.z + shift.z})) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, v.i,
                           "vertex %u would have a position that is not finite", v.i);
        }
    }
    return HE_OK;
}

static he_status check_places(const he_region *r, const he_vec3 *to, he_error *err)
{
    for (size_t i = 0; i < r->corners.ids.count; i++) {
        if (!he_point_is_finite(to[i])) {
            return he_fail(
                err, HE_NOT_FINITE, HE_VERTEX, r->corners.ids.ids[i],
                "the new vertex made from vertex %u would have a position that is not finite",
                r->corners.ids.ids[i]);
        }
    }
    return HE_OK;
}

/* --- COMMIT: writing --- */

/* The lowest new id of each kind of element. Half-edge i of the rim gets vertex `vertex` + i, edges
 * `edge` + 2i and `edge` + 2i + 1, and face `face` + i. */
typedef struct fresh {
    uint32_t vertex, edge, face;
} fresh;

static he_halfedge above(const fresh *n, size_t i)
{
    return (he_halfedge){2 * (n->edge + 2 * (uint32_t)i)};
}
static he_halfedge upright(const fresh *n, size_t i)
{
    return (he_halfedge){2 * (n->edge + 2 * (uint32_t)i + 1)};
}

static void make_rows(he_mesh *m, const he_region *r, const he_vec3 *to, const he_region_mix *mixes)
{
    for (size_t i = 0; i < r->rim.count; i++) {
        he_halfedge h = {r->rim.ids[i]};
        he_vertex a = he_origin(m, h), w = he_new_vertex(m);
        he_set_position(m, w, to[i]);
        if (mixes == NULL) {
            he_attributes_copy(m, HE_VERTEX, w.i, a.i);
        }
        he_note_parent(m, HE_VERTEX, w.i, a.i);
        he_edge e = he_new_edge(m);
        he_attributes_copy(m, HE_EDGE, e.i, he_edge_of(h).i);
        he_note_parent(m, HE_EDGE, e.i, he_edge_of(h).i);
        (void)he_new_edge(m);
        he_face f = he_face_of(m, h), q = he_new_face(m);
        he_attributes_copy(m, HE_FACE, q.i, f.i);
        he_note_parent(m, HE_FACE, q.i, f.i);
    }
}

/* Replaces half-edge i of the rim by a new half-edge in the loop of its face. A neighbour in this
 * loop may also be on the rim. Another call replaces it, so the new half-edge is linked to its
 * replacement. */
static void replace_side(he_mesh *m, const he_region *r, const fresh *n, size_t i)
{
    he_halfedge h = {r->rim.ids[i]}, t = above(n, i);
    he_face f = he_face_of(m, h);
    he_halfedge after = he_next(m, h), before = he_prev(m, h);
    uint32_t k = he_idmap_find(&r->corners, he_target(m, h).i);
    bool rim_after = r->rim.ids[k] == after.i;
    he_set_origin(m, t, (he_vertex){n->vertex + (uint32_t)i});
    he_set_origin(m, he_twin(t), (he_vertex){n->vertex + k});
    he_set_face(m, t, f);
    he_link(m, t, rim_after ? above(n, k) : after);
    if (is_inside(r, he_face_of(m, he_twin(before)))) {
        he_link(m, before, t);
    }
    if (he_face_halfedge(m, f).i == h.i) {
        he_set_face_halfedge(m, f, t);
    }
    he_set_vertex_halfedge(m, (he_vertex){n->vertex + (uint32_t)i}, t);
}

static void carry_corners(he_mesh *m, const he_region *r, const fresh *n, size_t i)
{
    he_halfedge h = {r->rim.ids[i]};
    uint32_t k = he_idmap_find(&r->corners, he_target(m, h).i);
    he_attributes_move(m, HE_HALFEDGE, above(n, i).i, h.i);
    he_attributes_copy(m, HE_HALFEDGE, he_twin(upright(n, i)).i, h.i);
    he_attributes_copy(m, HE_HALFEDGE, upright(n, k).i, he_next(m, h).i);
    he_attributes_copy(m, HE_HALFEDGE, he_twin(above(n, i)).i, he_next(m, h).i);
}

/* Links the four half-edges of the new quad at half-edge i of the rim, in this order: the rim
 * half-edge, the edge from its target to a new vertex, the edge between two new vertices, and the
 * edge from a new vertex to its origin. */
static void build_side(he_mesh *m, const he_region *r, const fresh *n, size_t i)
{
    he_halfedge h = {r->rim.ids[i]};
    uint32_t k = he_idmap_find(&r->corners, he_target(m, h).i);
    he_face q = {n->face + (uint32_t)i};
    const he_halfedge side[4] = {h, upright(n, k), he_twin(above(n, i)), he_twin(upright(n, i))};
    he_set_origin(m, upright(n, i), he_origin(m, h));
    he_set_origin(m, he_twin(upright(n, i)), (he_vertex){n->vertex + (uint32_t)i});
    for (unsigned s = 0; s < 4; s++) {
        he_link(m, side[s], side[(s + 1) % 4]);
        he_set_face(m, side[s], q);
    }
    he_set_face_halfedge(m, q, h);
}

/* Computes the attribute values of the new vertices from `first` to `last`. All are mixtures of the
 * corners of one face. Until the values of vertex `last` are computed, this vertex holds the mean
 * of these corners. */
static void carry_mixes(he_mesh *m, const he_region_mix *mixes, const fresh *n, size_t first,
                        size_t last, he_ids *corners)
{
    const uint32_t mean = n->vertex + (uint32_t)last;
    he_halfedge in = mixes[last].in, h = in;
    corners->count = 0;
    do {
        corners->ids[corners->count++] = he_origin(m, h).i;
        h = he_next(m, h);
    } while (h.i != in.i);
    he_attributes_mean(m, HE_VERTEX, mean, corners->ids, corners->count);
    for (size_t i = first; i <= last; i++) {
        const he_region_mix *mix = &mixes[i];
        uint32_t below = he_origin(m, mix->in).i, w = n->vertex + (uint32_t)i;
        if (w != mean) {
            double rest = 1 - mix->mean;
            he_attributes_copy(m, HE_VERTEX, w, below);
            he_attributes_mix(m, HE_VERTEX, w, mix->beside.i, rest > 0 ? 1 - mix->side / rest : 1);
            he_attributes_mix(m, HE_VERTEX, w, mean, rest);
        } else {
            double rest = 1 - mix->side;
            he_attributes_mix(m, HE_VERTEX, w, below, rest > 0 ? mix->mean / rest : 0);
            he_attributes_mix(m, HE_VERTEX, w, mix->beside.i, rest);
        }
    }
}

static void carry_vertices(he_mesh *m, const he_region *r, const he_region_mix *mixes,
                           const fresh *n, he_ids *corners)
{
    for (size_t first = 0; first < r->rim.count;) {
        size_t last = first;
        while (last + 1 < r->rim.count &&
               he_face_of(m, mixes[last + 1].in).i == he_face_of(m, mixes[first].in).i) {
            last++;
        }
        carry_mixes(m, mixes, n, first, last, corners);
        first = last + 1;
    }
}

static void commit(he_mesh *m, const he_region *r, const he_vec3 *to, const he_region_mix *mixes,
                   he_ids *corners)
{
    const fresh n = {m->c.vertices.issued, m->c.edges.issued, m->c.faces.issued};
    make_rows(m, r, to, mixes);
    if (mixes != NULL) {
        carry_vertices(m, r, mixes, &n, corners);
    }
    for (size_t i = 0; he_has_columns(m, HE_HALFEDGE) && i < r->rim.count; i++) {
        carry_corners(m, r, &n, i);
    }
    for (size_t i = 0; i < r->inner.count; i++) {
        he_set_origin(m, (he_halfedge){r->inner.ids[i]},
                      (he_vertex){n.vertex + r->inner_at.ids[i]});
    }
    for (size_t i = 0; i < r->rim.count; i++) {
        replace_side(m, r, &n, i);
    }
    for (size_t i = 0; i < r->rim.count; i++) {
        build_side(m, r, &n, i);
    }
    for (size_t i = 0; i < r->rim.count; i++) {
        he_halfedge h = {r->rim.ids[i]};
        he_vertex v = he_origin(m, h);
        /* A boundary half-edge that v stored still leaves v. Any other half-edge that v stored may
         * now leave the new vertex. */
        if (he_origin(m, he_vertex_halfedge(m, v)).i != v.i) {
            he_set_vertex_halfedge(m, v, h);
        }
    }
}

/* --- detaching one region, then all regions --- */

static he_status plan(const he_mesh *m, he_region *r, he_error *err)
{
    he_status status = find_rim(m, r, err);
    if (status == HE_OK) {
        status = find_inner(m, r, err);
    }
    return status == HE_OK ? check_locks(m, r, err) : status;
}

static he_status add_parts(const he_mesh *m, const he_region *r, he_region_parts *out,
                           he_error *err)
{
    size_t count = r->rim.count;
    he_status status = he_ids_reserve(&out->vertices, count, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&out->edges, 2 * count, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&out->faces, count, err);
    }
    for (uint32_t i = 0; status == HE_OK && i < count; i++) {
        out->vertices.ids[out->vertices.count++] = m->c.vertices.issued + i;
        out->edges.ids[out->edges.count++] = m->c.edges.issued + 2 * i;
        out->edges.ids[out->edges.count++] = m->c.edges.issued + 2 * i + 1;
        out->faces.ids[out->faces.count++] = m->c.faces.issued + i;
    }
    return status;
}

/* Computes how the attribute values of the new vertices are mixed. *out stays NULL if none are
 * mixed. Reserves memory in `corners` for the corners of the largest face. */
static he_status mix(const he_mesh *m, const he_region *r, he_region_place place, const he_vec3 *to,
                     he_region_mix **out, he_ids *corners, he_error *err)
{
    uint32_t most = 0;
    if (place.mix == NULL || !he_has_columns(m, HE_VERTEX)) {
        return HE_OK;
    }
    *out = he_mem_zero(r->rim.count, sizeof **out);
    if (*out == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the values of new vertices");
    }
    for (size_t i = 0; i < r->faces.ids.count; i++) {
        uint32_t degree = he_face_degree(m, (he_face){r->faces.ids.ids[i]});
        most = degree > most ? degree : most;
    }
    he_status status = he_ids_reserve(corners, most, err);
    return status == HE_OK ? place.mix(m, r, to, *out, err) : status;
}

/* Detaches one region. On entry `r` lists only the faces of the region; on return `r` is
 * cleared. */
static he_status draw_one(he_mesh *m, he_region *r, he_region_place place, he_region_parts *out,
                          he_error *err)
{
    he_idmap inside = {.slots = NULL};
    he_vec3 shift = {0, 0, 0}, *to = NULL;
    he_region_mix *mixes = NULL;
    he_ids corners = {0};
    bool shifts = false;
    he_status status = plan(m, r, err);
    if (status == HE_OK) {
        to = he_mem_array(NULL, r->rim.count, sizeof *to);
        status = to != NULL ? place.place(m, r, place.context, to, &shift, &shifts, err)
                            : he_fail_plain(err, HE_NO_MEMORY, "no memory for the new vertices");
    }
    if (status == HE_OK && shifts) {
        status = find_inside(m, r, &inside, err);
    }
    if (status == HE_OK) {
        status = check_inside(m, &inside, shift, err);
    }
    if (status == HE_OK) {
        status = check_places(r, to, err);
    }
    if (status == HE_OK) {
        status = mix(m, r, place, to, &mixes, &corners, err);
    }
    uint32_t count = (uint32_t)r->rim.count;
    he_reservation need = {.vertices = count,
                           .edges = 2 * count,
                           .faces = count,
                           .links = (size_t)count * RIM_LINKS + r->inner.count,
                           .positions = inside.ids.count,
                           .attributes = mixes != NULL ? 2 * (size_t)count : 0,
                           .lineage = 3 * (size_t)count};
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        status = add_parts(m, r, out, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, r, to, mixes, &corners);
        for (size_t i = 0; i < inside.ids.count; i++) {
            he_vertex v = {inside.ids.ids[i]};
            he_vec3 p = he_position(m, v);
            he_set_position(m, v, (he_vec3){p.x + shift.x, p.y + shift.y, p.z + shift.z});
        }
    }
    he_mem_free(to);
    he_mem_free(mixes);
    he_ids_clear(&corners);
    he_idmap_clear(&inside);
    region_clear(r);
    return status;
}

/* Detaches the regions one after another. Each region starts with the first listed face that is in
 * no earlier region. */
static he_status draw_all(he_mesh *m, const he_idmap *listed, bool joined, he_region_place place,
                          he_region_parts *out, he_error *err)
{
    size_t count = listed->ids.count;
    he_status status = HE_OK;
    uint64_t *done = he_bits_new(count);
    if (done == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to separate the regions");
    }
    status = count > 1 ? he_progress_phase(m->progress, "separating faces", 1, err) : HE_OK;
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        he_region r = {.faces = {.slots = NULL}};
        uint32_t index;
        bool added;
        status = he_progress_at(m->progress, i, count, err);
        if (status != HE_OK || he_bits_get(done, i)) {
            continue;
        }
        status = he_idmap_add(&r.faces, listed->ids.ids[i], &index, &added, err);
        if (status == HE_OK && joined) {
            status = spread(m, &r, listed, err);
        }
        for (size_t k = 0; status == HE_OK && k < r.faces.ids.count; k++) {
            he_bits_set(done, he_idmap_find(listed, r.faces.ids.ids[k]));
        }
        if (status == HE_OK) {
            status = draw_one(m, &r, place, out, err);
        }
        region_clear(&r);
    }
    he_mem_free(done);
    return status;
}

he_status he_region_draw(he_mesh *m, const uint32_t *faces, size_t count, bool joined,
                         he_region_place place, he_region_parts *out, he_error *err)
{
    he_idmap listed = {.slots = NULL};
    he_region_parts made = {.vertices = {0}};
    he_bracket bracket;
    he_status status = he_list_require(m, HE_FACE, faces, count, HE_REPEATED_ELEMENT, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        uint32_t index;
        bool added;
        status = he_idmap_add(&listed, faces[i], &index, &added, err);
    }
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
        if (status == HE_OK) {
            status = draw_all(m, &listed, joined, place, &made, err);
            status = he_edit_end(m, &bracket, status);
        }
    }
    if (status == HE_OK && out != NULL) {
        *out = made;
        made = (he_region_parts){.vertices = {0}};
    }
    he_region_parts_clear(&made);
    he_idmap_clear(&listed);
    return status;
}
