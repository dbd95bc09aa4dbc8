#include "select/rules.h"

#include "edit/piece/list.h"
#include "mesh/marks.h"
#include "select/smooth_normals.h"

/* Checks the seeds, adds them to `reached`, and appends them to `queue`. */
static he_status plant(const he_mesh *m, const he_select_rule *rule, he_set *reached, he_ids *queue,
                       he_error *err)
{
    he_status status = he_list_require(m, rule->seed_kind, rule->seeds, rule->seed_count,
                                       HE_REPEATED_ELEMENT, err);
    if (status == HE_OK) {
        status = he_ids_reserve(queue, rule->seed_count, err);
    }
    for (size_t i = 0; i < rule->seed_count && status == HE_OK; i++) {
        he_set_add(reached, rule->seeds[i]);
        queue->ids[queue->count++] = rule->seeds[i];
    }
    return status;
}

static he_status require_seeds(const he_select_rule *rule, const char *what, he_error *err)
{
    return rule->seed_count > 0
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE,
                               "there are no %s from which a %s could begin: the list or set is "
                               "empty",
                               he_kind_plural(rule->seed_kind), what);
}

/* --- regions --- */

typedef struct region {
    const he_mesh *m;
    const he_vec3 *normals;
    const he_column *barrier; /* the mark `feature`, or NULL */
    double square;            /* he_square_chord of the angle */
} region;

/* Appends to the queue the neighbours of face f that belong to its region and are not in `faces`
 * yet, and adds them to `faces`. */
static he_status spread(const region *r, uint32_t f, he_set *faces, he_ids *queue, he_error *err)
{
    he_halfedge first = he_face_halfedge(r->m, (he_face){f}), h = first;
    he_status status = HE_OK;
    do {
        const uint32_t g = he_face_of(r->m, he_twin(h)).i;
        if (g != HE_NONE && !he_set_has(faces, g) && !he_is_marked(r->barrier, he_edge_of(h).i) &&
            he_is_within_chord(r->normals[f], r->normals[g], r->square)) {
            he_set_add(faces, g);
            status = he_ids_add(queue, g, err);
        }
        h = he_next(r->m, h);
    } while (h.i != first.i && status == HE_OK);
    return status;
}

he_status he_pick_region(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_set faces = {.bits = NULL};
    he_ids queue = {0};
    he_vec3 *normals = NULL;
    he_status status = require_seeds(rule, "region", err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_FACE, &faces, err);
    }
    if (status == HE_OK) {
        status = plant(m, rule, &faces, &queue, err);
    }
    if (status == HE_OK) {
        status = he_smooth_normals(m, &normals, err);
    }
    const region r = {m, normals, rule->cross_features ? NULL : he_mark_find(m, HE_EDGE, "feature"),
                      he_square_chord(rule->angle)};
    for (size_t i = 0; i < queue.count && status == HE_OK; i++) {
        status = he_progress_at(m->progress, i, m->c.faces.live, err);
        if (status == HE_OK) {
            status = spread(&r, queue.ids[i], &faces, &queue, err);
        }
    }
    if (status == HE_OK) {
        status = he_set_of_faces(m, &faces, out, err);
    }
    he_mem_free(normals);
    he_ids_clear(&queue);
    he_set_clear(&faces);
    return status;
}

/* --- components --- */

/* Adds a vertex to the set and the queue, unless the set has it already. */
static he_status reach(he_set *vertices, uint32_t v, he_ids *queue, he_error *err)
{
    if (he_set_has(vertices, v)) {
        return HE_OK;
    }
    he_set_add(vertices, v);
    return he_ids_add(queue, v, err);
}

/* Adds a vertex of each seed. */
static he_status reach_seeds(const he_mesh *m, const he_select_rule *rule, he_set *vertices,
                             he_ids *queue, he_error *err)
{
    he_status status = he_list_require(m, rule->seed_kind, rule->seeds, rule->seed_count,
                                       HE_REPEATED_ELEMENT, err);
    for (size_t i = 0; i < rule->seed_count && status == HE_OK; i++) {
        const uint32_t id = rule->seeds[i];
        uint32_t v = id;
        if (rule->seed_kind == HE_EDGE) {
            v = m->c.origin[2u * id];
        } else if (rule->seed_kind == HE_FACE) {
            v = he_origin(m, he_face_halfedge(m, (he_face){id})).i;
        }
        status = reach(vertices, v, queue, err);
    }
    return status;
}

he_status he_pick_component(const he_mesh *m, const he_select_rule *rule, he_set *out,
                            he_error *err)
{
    he_set vertices = {.bits = NULL};
    he_ids queue = {0};
    he_status status = require_seeds(rule, "component", err);
    if (status == HE_OK) {
        status = he_set_new(m, HE_VERTEX, &vertices, err);
    }
    if (status == HE_OK) {
        status = reach_seeds(m, rule, &vertices, &queue, err);
    }
    for (size_t i = 0; i < queue.count && status == HE_OK; i++) {
        const he_halfedge first = he_vertex_halfedge(m, (he_vertex){queue.ids[i]});
        he_halfedge h = first;
        status = he_progress_at(m->progress, i, m->c.vertices.live, err);
        while (h.i != HE_NONE && status == HE_OK) {
            status = reach(&vertices, he_target(m, h).i, &queue, err);
            h = he_swing_ccw(m, h);
            h.i = h.i == first.i ? HE_NONE : h.i;
        }
    }
    if (status == HE_OK) {
        status = he_set_of_vertices(m, &vertices, HE_ANY_CORNER, out, err);
    }
    he_ids_clear(&queue);
    he_set_clear(&vertices);
    return status;
}

/* --- growing and shrinking --- */

static he_status require_kind(const he_select_rule *rule, he_error *err)
{
    return rule->seed_kind == rule->of
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE,
                               "a set of %s can only grow to %s or shrink to them, not to %s",
                               he_kind_plural(rule->seed_kind), he_kind_plural(rule->seed_kind),
                               he_kind_plural(rule->of));
}

/* Adds to the set, and appends to the queue, all elements of its kind at vertex v; if the kind is
 * vertices, the other ends of the edges at v. */
static he_status reach_about(const he_mesh *m, uint32_t v, he_set *set, he_ids *queue,
                             he_error *err)
{
    const he_halfedge first = he_vertex_halfedge(m, (he_vertex){v});
    he_halfedge h = first;
    he_status status = HE_OK;
    while (h.i != HE_NONE && status == HE_OK) {
        const uint32_t id = set->kind == HE_VERTEX ? he_target(m, h).i
                            : set->kind == HE_EDGE ? he_edge_of(h).i
                                                   : he_face_of(m, h).i;
        status = id == HE_NONE ? HE_OK : reach(set, id, queue, err);
        h = he_swing_ccw(m, h);
        h.i = h.i == first.i ? HE_NONE : h.i;
    }
    return status;
}

/* Does the same at each vertex of the element `id` that is not in `done` yet, and adds these
 * vertices to `done`: so the search turns around each vertex only once. */
static he_status reach_from(const he_mesh *m, uint32_t id, he_set *set, he_set *done, he_ids *queue,
                            he_error *err)
{
    he_halfedge first = {HE_NONE};
    if (set->kind == HE_VERTEX) {
        return reach_about(m, id, set, queue, err);
    }
    if (set->kind == HE_EDGE) {
        first = he_edge_halfedge((he_edge){id}, 0);
    } else {
        first = he_face_halfedge(m, (he_face){id});
    }
    he_halfedge h = first;
    he_status status = HE_OK;
    do {
        const uint32_t v = he_origin(m, h).i;
        if (!he_set_has(done, v)) {
            he_set_add(done, v);
            status = reach_about(m, v, set, queue, err);
        }
        h = set->kind == HE_EDGE ? he_twin(h) : he_next(m, h);
    } while (h.i != first.i && status == HE_OK);
    return status;
}

/* Grows the set by a number of steps. At first `queue` has all its elements. */
static he_status grow(const he_mesh *m, he_set *set, he_ids *queue, uint32_t steps, he_error *err)
{
    he_set done = {.bits = NULL};
    he_status status = he_set_new(m, HE_VERTEX, &done, err);
    size_t from = 0, to = queue->count;
    for (uint32_t step = 0; step < steps && from < to && status == HE_OK; step++) {
        for (size_t i = from; i < to && status == HE_OK; i++) {
            status = he_progress_at(m->progress, i, set->issued, err);
            if (status == HE_OK) {
                status = reach_from(m, queue->ids[i], set, &done, queue, err);
            }
        }
        from = to;
        to = queue->count;
    }
    he_set_clear(&done);
    return status;
}

he_status he_pick_grown(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_ids queue = {0};
    he_status status = require_kind(rule, err);
    if (status == HE_OK) {
        status = plant(m, rule, out, &queue, err);
    }
    if (status == HE_OK) {
        status = grow(m, out, &queue, rule->steps, err);
    }
    he_ids_clear(&queue);
    return status;
}

/* Grows the elements that are no seeds, and takes those that they do not reach. */
he_status he_pick_shrunk(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_ids queue = {0};
    he_status status = require_kind(rule, err);
    if (status == HE_OK) {
        status = plant(m, rule, out, &queue, err);
    }
    if (status == HE_OK) {
        queue.count = 0;
        he_set_invert(m, out);
        status = he_ids_reserve(&queue, he_mesh_count(m, rule->of) - rule->seed_count, err);
    }
    for (uint32_t id = 0; id < out->issued && status == HE_OK; id++) {
        if (he_set_has(out, id)) {
            queue.ids[queue.count++] = id;
        }
    }
    if (status == HE_OK) {
        status = grow(m, out, &queue, rule->steps, err);
    }
    if (status == HE_OK) {
        he_set_invert(m, out);
    }
    he_ids_clear(&queue);
    return status;
}

/* --- the boundary --- */

/* Returns whether the half-edge has a face of the set on its left and not on its right. If `faces`
 * is NULL, all faces are in the set. */
static bool is_border(const he_mesh *m, const he_set *faces, he_halfedge h)
{
    const uint32_t left = he_face_of(m, h).i, right = he_face_of(m, he_twin(h)).i;
    return left != HE_NONE && (faces == NULL || he_set_has(faces, left)) &&
           !(right != HE_NONE && (faces == NULL || he_set_has(faces, right)));
}

static void add_border(const he_mesh *m, he_halfedge h, he_set *out)
{
    if (out->kind == HE_VERTEX) {
        he_set_add(out, he_origin(m, h).i);
        he_set_add(out, he_target(m, h).i);
    } else {
        he_set_add(out, out->kind == HE_EDGE ? he_edge_of(h).i : he_face_of(m, h).i);
    }
}

he_status he_pick_boundary(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    he_set faces = {.bits = NULL};
    he_ids queue = {0};
    he_status status = HE_OK;
    if (rule->seeds != NULL) {
        status = he_set_new(m, HE_FACE, &faces, err);
        if (status == HE_OK) {
            status = plant(m, rule, &faces, &queue, err);
        }
    }
    const he_set *of = rule->seeds != NULL ? &faces : NULL;
    for (uint32_t e = 0; e < m->c.edges.issued && status == HE_OK; e++) {
        status = he_progress_at(m->progress, e, m->c.edges.issued, err);
        for (unsigned side = 0; side < 2 && he_edge_is_live(m, (he_edge){e}); side++) {
            he_halfedge h = he_edge_halfedge((he_edge){e}, side);
            if (is_border(m, of, h)) {
                add_border(m, h, out);
            }
        }
    }
    he_ids_clear(&queue);
    he_set_clear(&faces);
    return status;
}
