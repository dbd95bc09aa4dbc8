/* decimate_step.c - performs one collapse of a decimation. */
#include "algo/decimation.h"

#include "edit/local/collapse.h"
#include "edit/piece/point.h"

/* The square of the cosine of the largest angle, 60 degrees, by which one collapse may turn a
 * face. */
static const double TURN = 0.25;
/* A triangle counts as having area if (2 * area)^2 / (longest side)^4 is above SLIVER. */
static const double SLIVER = 1e-12;

static he_vec3 place_of(const he_decimation *d, uint32_t vertex)
{
    return he_decimation_inside(d, d->mesh->c.position[vertex]);
}

/* Lists in out[0] the half-edges that leave the origin of h, beginning with h, and in out[1] those
 * that leave its target, beginning with twin(h). If `ends` is 1, only out[0] is filled. The walks
 * around the two vertices alternate, because each step of a walk waits for memory. Returns false if
 * more than HE_DECIMATE_DEGREE half-edges leave one of the vertices. */
static bool gather(const he_mesh *m, he_halfedge h, unsigned ends, he_spokes out[2])
{
    const he_halfedge first[2] = {h, he_twin(h)};
    he_halfedge at[2] = {h, he_twin(h)};
    bool open[2] = {true, ends == 2};
    out[0].count = out[1].count = 0;
    while (open[0] || open[1]) {
        for (unsigned i = 0; i < 2; i++) {
            he_spokes *s = &out[i];
            if (!open[i]) {
                continue;
            }
            if (s->count == HE_DECIMATE_DEGREE) {
                return false;
            }
            uint32_t target = he_target(m, at[i]).i;
            __builtin_prefetch(&m->c.position[target]);
            s->out[s->count] = at[i].i;
            s->target[s->count++] = target;
            at[i] = he_swing_ccw(m, at[i]);
            open[i] = at[i].i != first[i].i;
        }
    }
    return true;
}

/* Returns true if the triangle p, q, r may change to the triangle `to`, q, r: its normal must not
 * turn too far, and it must not lose its area. */
static bool stays_upright(he_vec3 p, he_vec3 q, he_vec3 r, he_vec3 to)
{
    he_vec3 side = he_vec3_sub(r, q), left = he_vec3_sub(q, to), right = he_vec3_sub(r, to);
    he_vec3 old = he_vec3_cross(he_vec3_sub(q, p), side);
    he_vec3 new = he_vec3_cross(left, side);
    double old_square = he_vec3_dot(old, old), new_square = he_vec3_dot(new, new);
    double longest =
        fmax(he_vec3_dot(side, side), fmax(he_vec3_dot(left, left), he_vec3_dot(right, right)));
    if (new_square <= SLIVER * longest * longest) {
        return old_square <= new_square;
    }
    double along = he_vec3_dot(old, new);
    return old_square == 0 || (along > 0 && along * along >= TURN * old_square * new_square);
}

/* Returns true if the faces around a vertex may be changed by moving the vertex from `from` to
 * `to`: no normal may turn too far, and no face may lose its area. `spokes` lists the half-edges
 * that leave the vertex. The collapse deletes the two faces beside the first half-edge, so these
 * are not tested. */
static bool stay_upright(const he_decimation *d, const he_spokes *spokes, he_vec3 from, he_vec3 to)
{
    const he_mesh *m = d->mesh;
    he_halfedge h = {spokes->out[0]};
    uint32_t left = he_face_of(m, h).i, right = he_face_of(m, he_twin(h)).i;
    he_vec3 next = place_of(d, spokes->target[0]);
    for (uint32_t i = 0; i < spokes->count; i++) {
        he_vec3 here = next;
        uint32_t after = i + 1 < spokes->count ? i + 1 : 0;
        uint32_t face = he_face_of(m, (he_halfedge){spokes->out[i]}).i;
        next = place_of(d, spokes->target[after]);
        if (face == HE_NONE || face == left || face == right) {
            continue;
        }
        if (!stays_upright(from, here, next, to)) {
            return false;
        }
    }
    return true;
}

he_edge_place he_decimation_judge(const he_decimation *d, he_edge e, he_candidate *what)
{
    if (!he_decimation_cost(d, e, what)) {
        return HE_EDGE_ASIDE;
    }
    return what->error > d->most ? HE_EDGE_DEAR : HE_EDGE_QUEUED;
}

void he_decimation_put(he_decimation *d, he_edge e, he_edge_place place, const he_candidate *what)
{
    d->places[e.i] = (uint8_t)place;
    if (place == HE_EDGE_QUEUED) {
        he_queue_put(&d->queue, e.i, what->priority);
        return;
    }
    uint8_t flag = place == HE_EDGE_DEAR ? HE_NODE_DEAR : HE_NODE_ASIDE;
    d->flags[he_origin(d->mesh, he_edge_halfedge(e, 0)).i] |= flag;
    d->flags[he_origin(d->mesh, he_edge_halfedge(e, 1)).i] |= flag;
}

static void bring_back_now(he_decimation *d, uint32_t vertex, bool grown)
{
    const he_mesh *m = d->mesh;
    uint8_t flags = HE_NODE_LATE | HE_NODE_GREW | HE_NODE_ASIDE;
    he_halfedge first = he_vertex_halfedge(m, (he_vertex){vertex}), h = first;
    grown = grown || (d->flags[vertex] & HE_NODE_GREW) != 0;
    flags |= grown ? HE_NODE_DEAR : 0;
    d->flags[vertex] &= (uint8_t)~flags;
    d->nodes[vertex].changes = 0;
    do {
        he_edge e = he_edge_of(h);
        uint8_t place = d->places[e.i];
        if (place == HE_EDGE_ASIDE || (grown && place == HE_EDGE_DEAR)) {
            he_candidate what;
            d->work++;
            he_decimation_put(d, e, he_decimation_judge(d, e, &what), &what);
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
}

/* Returns true if the refused edges of a vertex should not go back into the queue yet, because the
 * vertex has very many edges and few faces around it have changed (HE_DECIMATE_PATIENT). If so, the
 * function adds the vertex to the list `late`, which is handled later. */
static bool is_late(he_decimation *d, uint32_t vertex)
{
    he_node *node = &d->nodes[vertex];
    if (node->degree <= HE_DECIMATE_PATIENT || ++node->changes >= node->degree / HE_DECIMATE_PART) {
        return false;
    }
    return (d->flags[vertex] & HE_NODE_LATE) != 0 || he_ids_add(&d->late, vertex, NULL) == HE_OK;
}

/* Puts those edges of a vertex back into the queue that are ASIDE (their collapse was refused). If
 * `grown` is true, another vertex was merged into this one, and edges that are DEAR (too expensive)
 * are tried again, too. */
static void bring_back(he_decimation *d, uint32_t vertex, bool grown)
{
    uint8_t flags = grown ? HE_NODE_ASIDE | HE_NODE_DEAR : HE_NODE_ASIDE;
    if ((d->flags[vertex] & flags) == 0 || he_node_is_hub(&d->nodes[vertex])) {
        return;
    }
    if (is_late(d, vertex)) {
        d->flags[vertex] |= grown ? HE_NODE_LATE | HE_NODE_GREW : HE_NODE_LATE;
        return;
    }
    bring_back_now(d, vertex, grown);
}

bool he_decimation_catch_up(he_decimation *d)
{
    bool any = false;
    for (size_t i = 0; i < d->late.count; i++) {
        uint32_t v = d->late.ids[i];
        if ((d->flags[v] & HE_NODE_LATE) != 0 && he_vertex_is_live(d->mesh, (he_vertex){v}) &&
            !he_node_is_hub(&d->nodes[v])) {
            bring_back_now(d, v, false);
            any = true;
        }
    }
    d->late.count = 0;
    return any;
}

/* Returns where the projection of `place` onto the segment from `from` to `to` lies: 0 at `from`, 1
 * at `to`, linear in between. */
static double between(he_vec3 from, he_vec3 to, he_vec3 place)
{
    he_vec3 across = he_vec3_sub(to, from);
    double length = he_vec3_dot(across, across);
    double t = length > 0 ? he_vec3_dot(across, he_vec3_sub(place, from)) / length : 0.5;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* Converts a point from the scaled coordinates of the decimation to coordinates of the mesh. The
 * result never overflows. */
static he_vec3 outside(const he_decimation *d, he_vec3 place)
{
    return (he_vec3){d->middle.x + ldexp(place.x, d->exponent),
                     d->middle.y + ldexp(place.y, d->exponent),
                     d->middle.z + ldexp(place.z, d->exponent)};
}

/* Makes room in the log for one more collapse and the faces around one vertex. */
static he_status make_room(he_progressive *log)
{
    if (log->count == log->capacity) {
        size_t capacity = 2 * log->capacity + 64;
        he_progressive_split *splits = he_mem_array(log->splits, capacity, sizeof *splits);
        if (splits == NULL) {
            return HE_NO_MEMORY;
        }
        log->splits = splits;
        log->capacity = capacity;
    }
    return he_ids_reserve(&log->moved, HE_DECIMATE_DEGREE, NULL);
}

/* Writes to the log how to undo the collapse of the first half-edge of `about`. The function must
 * be called before the collapse, because it reads the links. */
static void remember(const he_decimation *d, const he_spokes *about)
{
    const he_mesh *m = d->mesh;
    he_progressive *log = d->log;
    he_halfedge h = {about->out[0]}, back = he_twin(h);
    he_progressive_split *split = &log->splits[log->count];
    *split = (he_progressive_split){.vertex = he_origin(m, h).i,
                                    .from = he_target(m, h).i,
                                    .left = HE_NONE,
                                    .right = HE_NONE,
                                    .halfedge = h.i,
                                    .left_halfedge = HE_NONE,
                                    .right_halfedge = HE_NONE,
                                    .left_face = he_face_of(m, h).i,
                                    .right_face = he_face_of(m, back).i,
                                    .first_moved = log->moved.count,
                                    .at = he_position(m, he_origin(m, h)),
                                    .from_at = he_position(m, he_target(m, h))};
    if (split->left_face != HE_NONE) {
        split->left_halfedge = he_twin(he_prev(m, h)).i;
        split->left = he_origin(m, he_prev(m, h)).i;
    }
    if (split->right_face != HE_NONE) {
        split->right_halfedge = he_next(m, back).i;
        split->right = he_origin(m, he_prev(m, back)).i;
    }
    for (uint32_t i = 0; i < about->count; i++) {
        uint32_t face = he_face_of(m, (he_halfedge){about->out[i]}).i;
        if (face != HE_NONE && face != split->left_face && face != split->right_face) {
            log->moved.ids[log->moved.count++] = face;
            split->moved++;
        }
    }
}

/* Records which vertices and edges the collapse of h merges. The function must be called before the
 * collapse, because it reads the links. */
static he_status note_merges(const he_decimation *d, he_halfedge h)
{
    const he_mesh *m = d->mesh;
    he_ids *vertices = &d->merges->vertices, *edges = &d->merges->edges;
    if (he_ids_reserve(vertices, 2, NULL) != HE_OK || he_ids_reserve(edges, 4, NULL) != HE_OK) {
        return HE_NO_MEMORY;
    }
    vertices->ids[vertices->count++] = he_origin(m, h).i;
    vertices->ids[vertices->count++] = he_target(m, h).i;
    he_halfedge back = he_twin(h);
    if (!he_is_boundary_halfedge(m, h)) {
        edges->ids[edges->count++] = he_edge_of(he_prev(m, h)).i;
        edges->ids[edges->count++] = he_edge_of(he_next(m, h)).i;
    }
    if (!he_is_boundary_halfedge(m, back)) {
        edges->ids[edges->count++] = he_edge_of(he_next(m, back)).i;
        edges->ids[edges->count++] = he_edge_of(he_prev(m, back)).i;
    }
    return HE_OK;
}

static void lose_edge(he_decimation *d, uint32_t vertex)
{
    he_node *node = &d->nodes[vertex];
    node->degree--;
    if (node->degree == HE_DECIMATE_DEGREE) {
        bring_back(d, vertex, true);
    }
}

/* Collapses the first half-edge of `about`. Records the collapse in the log, and the merged
 * elements in `merges`, if the decimation has a log or a list of merges. */
static he_status collapse(const he_decimation *d, const he_spokes *about, double t, he_vec3 to)
{
    he_halfedge h = {about->out[0]};
    he_progressive *log = d->log;
    he_merges *merges = d->merges;
    size_t moved = log != NULL ? log->moved.count : 0;
    size_t vertices = merges != NULL ? merges->vertices.count : 0;
    size_t edges = merges != NULL ? merges->edges.count : 0;
    if ((log != NULL && make_room(log) != HE_OK) ||
        (merges != NULL && note_merges(d, h) != HE_OK)) {
        return HE_NO_MEMORY;
    }
    if (log != NULL) {
        remember(d, about);
    }
    he_status status = he_edge_collapse_at(d->mesh, h, t, to, NULL);
    if (status != HE_OK && merges != NULL) {
        merges->vertices.count = vertices;
        merges->edges.count = edges;
    }
    if (log != NULL) {
        log->count += status == HE_OK;
        log->moved.count = status == HE_OK ? log->moved.count : moved;
    }
    return status;
}

enum { SPOKES_OF_WORK = 8 };

he_status he_decimation_collapse(he_decimation *d, const he_candidate *what)
{
    he_mesh *m = d->mesh;
    he_halfedge h = what->h, back = he_twin(h);
    uint32_t u = he_origin(m, h).i, v = he_target(m, h).i;
    he_node *gone = &d->nodes[u], *kept = &d->nodes[v];
    he_spokes about[2];
    const he_spokes *about_u = &about[0], *about_v = &about[1];
    d->work += 1 + (gone->degree + (what->moves ? kept->degree : 0)) / SPOKES_OF_WORK;
    if (!gather(m, h, what->moves ? 2 : 1, about) ||
        !stay_upright(d, about_u, gone->place, what->place) ||
        (what->moves && !stay_upright(d, about_v, kept->place, what->place))) {
        return HE_LIMIT;
    }
    uint32_t left = he_face_of(m, h).i, right = he_face_of(m, back).i;
    uint32_t c = left != HE_NONE ? he_origin(m, he_prev(m, h)).i : HE_NONE;
    uint32_t e = right != HE_NONE ? he_origin(m, he_prev(m, back)).i : HE_NONE;
    double t = what->moves ? between(gone->place, kept->place, what->place) : 1;
    he_vec3 to = what->moves ? outside(d, what->place) : he_position(m, (he_vertex){v});
    he_status status = collapse(d, about_u, t, to);
    if (status != HE_OK) {
        return status;
    }
    he_quadric_shift(&gone->quadric, he_vec3_sub(what->place, gone->place));
    he_quadric_shift(&kept->quadric, he_vec3_sub(what->place, kept->place));
    he_quadric_add(&kept->quadric, &gone->quadric);
    kept->place = what->place;
    d->flags[v] |= d->flags[u] & (HE_NODE_ASIDE | HE_NODE_DEAR);
    kept->degree += gone->degree - 2 - (c != HE_NONE) - (e != HE_NONE);
    d->error = fmax(d->error, what->error);
    for (uint32_t i = 1; i < about_u->count; i++) {
        bring_back(d, about_u->target[i], false);
    }
    for (uint32_t i = 1; what->moves && i < about_v->count; i++) {
        bring_back(d, about_v->target[i], false);
    }
    bring_back(d, v, true);
    if (c != HE_NONE) {
        lose_edge(d, c);
    }
    if (e != HE_NONE) {
        lose_edge(d, e);
    }
    return HE_OK;
}
