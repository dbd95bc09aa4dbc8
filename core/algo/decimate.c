#include "algo/decimate.h"

#include "algo/decimation.h"
#include "algo/result_write.h"
#include "base/parallel.h"
#include "geometry/scale.h"
#include "mesh/marks.h"
#include "mesh/write.h"

const char *const he_decimate_stop_names[HE_STOP_COUNT + 1] = {"faces", "max_error", "exhausted",
                                                               NULL};

static he_status check(const he_mesh *m, const he_decimate_options *options, he_error *err)
{
    if (!(options->max_error >= 0)) {
        return he_fail_plain(err, HE_BAD_VALUE, "max_error must be at least 0, not %g",
                             options->max_error);
    }
    if (!(options->boundary_weight >= 0 && options->boundary_weight <= HE_BOUNDARY_WEIGHT_MAX)) {
        return he_fail_plain(err, HE_BAD_VALUE, "boundary_weight must be from 0 to %g, not %g",
                             HE_BOUNDARY_WEIGHT_MAX, options->boundary_weight);
    }
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        if (he_next(m, he_next(m, h)).i != he_prev(m, h).i) {
            return he_fail(err, HE_NOT_TRIANGLE, HE_FACE, f,
                           "face %u has more than three corners: triangulate first", f);
        }
    }
    return HE_OK;
}

he_vec3 he_decimation_inside(const he_decimation *d, he_vec3 outside)
{
    he_vec3 p = he_vec3_sub(outside, d->middle);
    return he_vec3_scale(p, d->inward);
}

static void find_frame(he_decimation *d)
{
    const he_mesh *m = d->mesh;
    he_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) && m->c.vertex_halfedge[v] != HE_NONE) {
            he_vec3 p = m->c.position[v];
            low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
            high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
        }
    }
    if (!(low.x <= high.x)) {
        low = high = (he_vec3){0, 0, 0};
    }
    d->middle = he_vec3_add(he_vec3_scale(low, 0.5), he_vec3_scale(high, 0.5));
    he_vec3 half = he_vec3_sub(he_vec3_scale(high, 0.5), he_vec3_scale(low, 0.5));
    d->exponent = he_exponent_of(he_vec3_extent(half));
    d->inward = ldexp(1, -d->exponent);
}

static void count_feature(const he_decimation *d, he_edge e, uint32_t vertex)
{
    he_node *node = &d->nodes[vertex];
    if (d->feature != NULL && *he_column_value(d->feature, e.i) != 0 && node->features < 3) {
        node->features++;
    }
}

/* Adds a plane to the quadrics of the two ends of half-edge h. The plane contains the edge of h and
 * is perpendicular to the face of h, whose normal is given. */
static void add_wall(const he_decimation *d, he_halfedge h, he_vec3 normal)
{
    he_node *a = &d->nodes[he_origin(d->mesh, h).i], *b = &d->nodes[he_target(d->mesh, h).i];
    he_vec3 along = he_vec3_sub(b->place, a->place), out;
    if (he_vec3_normalise(he_vec3_cross(along, normal), &out)) {
        double weight = d->boundary_weight * he_vec3_dot(along, along);
        he_quadric_add_plane(&a->quadric, out, weight);
        he_quadric_add_plane(&b->quadric, out, weight);
    }
}

static void weigh_face(const he_decimation *d, he_face f)
{
    const he_mesh *m = d->mesh;
    he_halfedge h = he_face_halfedge(m, f);
    he_node *corner[3];
    for (unsigned i = 0; i < 3; i++) {
        corner[i] = &d->nodes[he_origin(m, h).i];
        h = he_next(m, h);
    }
    he_vec3 normal = he_vec3_cross(he_vec3_sub(corner[1]->place, corner[0]->place),
                                   he_vec3_sub(corner[2]->place, corner[0]->place));
    double area = 0.5 * he_vec3_length(normal);
    if (!he_vec3_normalise(normal, &normal)) {
        return;
    }
    for (unsigned i = 0; i < 3; i++) {
        he_edge e = he_edge_of(h);
        he_quadric_add_plane(&corner[i]->quadric, normal, area);
        if (he_is_boundary_edge(m, e) ||
            (d->feature != NULL && *he_column_value(d->feature, e.i) != 0)) {
            add_wall(d, h, normal);
        }
        h = he_next(m, h);
    }
}

static void heed_locks(const he_decimation *d, const he_marks *marks)
{
    const he_mesh *m = d->mesh;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_is_locked(marks, HE_VERTEX, v)) {
            d->flags[v] |= HE_NODE_LOCKED;
        }
    }
    for (uint32_t i = 0; i < 2 * m->c.edges.issued; i++) {
        he_halfedge h = {i};
        if (!he_edge_is_live(m, he_edge_of(h))) {
            continue;
        }
        uint32_t face = he_face_of(m, h).i;
        if (he_is_locked(marks, HE_EDGE, i >> 1) ||
            (face != HE_NONE && he_is_locked(marks, HE_FACE, face))) {
            d->flags[he_origin(m, h).i] |= HE_NODE_HELD;
            d->flags[he_target(m, h).i] |= HE_NODE_HELD;
        }
    }
}

/* Begins the nodes of vertices. The nodes of vertices without edges stay unwritten: writing would
 * touch memory pages that were not used yet, which is slow. */
static he_status begin_nodes(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const he_decimation *d = context;
    const he_content *c = &d->mesh->c;
    (void)part, (void)err;
    for (size_t v = from; v < to; v++) {
        if (c->vertex_halfedge[v] < 2 * c->edges.issued) {
            d->nodes[v] = (he_node){.place = he_decimation_inside(d, c->position[v])};
        }
    }
    return HE_OK;
}

static he_status weigh(he_decimation *d, he_error *err)
{
    const he_mesh *m = d->mesh;
    he_marks marks;
    he_status status = he_progress_phase(m->progress, "preparing vertices", 0.05, err);
    find_frame(d);
    if (he_marks_find(m, &marks)) {
        d->feature = marks.feature;
        heed_locks(d, &marks);
    }
    if (status == HE_OK) {
        status = he_run_ranges(m->progress, m->c.vertices.issued, begin_nodes, d, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "weighing faces", 0.15, err);
    }
    for (uint32_t h = 0; h < 2 * m->c.edges.issued && status == HE_OK; h++) {
        if (he_edge_is_live(m, (he_edge){h >> 1})) {
            d->nodes[m->c.origin[h]].degree++;
            count_feature(d, (he_edge){h >> 1}, m->c.origin[h]);
        }
    }
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f, m->c.faces.issued, err);
        if (he_face_is_live(m, (he_face){f})) {
            weigh_face(d, (he_face){f});
        }
    }
    return status;
}

/* The costs of all edges, before the first collapse. */
typedef struct costs {
    he_decimation *d;
    float *priorities; /* those of the edges that belong in the queue */
} costs;

/* Computes where edges belong, and their priorities. */
static he_status judge_range(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const costs *all = context;
    (void)part, (void)err;
    for (uint32_t e = (uint32_t)from; e < to; e++) {
        he_candidate what;
        if (he_edge_is_live(all->d->mesh, (he_edge){e})) {
            he_edge_place place = he_decimation_judge(all->d, (he_edge){e}, &what);
            all->d->places[e] = (uint8_t)place;
            all->priorities[e] = place == HE_EDGE_QUEUED ? what.priority : 0;
        }
    }
    return HE_OK;
}

/* Fills the queue. Several threads compute the costs; the edges are put into the queue in the order
 * of their ids, so that the result does not depend on the number of threads. */
static he_status fill_queue(he_decimation *d, he_error *err)
{
    const he_mesh *m = d->mesh;
    uint32_t issued = m->c.edges.issued;
    costs all = {d, he_mem_array(NULL, issued, sizeof *all.priorities)};
    if (all.priorities == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the costs of %u edges", issued);
    }
    he_status status = he_progress_phase(m->progress, "computing costs of edges", 0.3, err);
    if (status == HE_OK) {
        status = he_run_ranges(m->progress, issued, judge_range, &all, err);
    }
    for (uint32_t e = 0; e < issued && status == HE_OK; e++) {
        if (he_edge_is_live(m, (he_edge){e})) {
            he_candidate what = {.priority = all.priorities[e]};
            he_decimation_put(d, (he_edge){e}, (he_edge_place)d->places[e], &what);
        }
    }
    he_mem_free(all.priorities);
    return status;
}

/* Tries to collapse edge e. The edge was taken from `bucket`, the first bucket of the queue that is
 * not empty. */
static he_status collapse_one(he_decimation *d, he_edge e, uint32_t bucket, he_error *err)
{
    he_candidate what;
    he_edge_place place = he_decimation_judge(d, e, &what);
    if (place == HE_EDGE_QUEUED && he_queue_bucket(what.priority) <= bucket) {
        he_status status = he_decimation_collapse(d, &what);
        if (status == HE_OK) {
            return HE_OK;
        }
        if (status == HE_NO_MEMORY) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to collapse edge %u", e.i);
        }
        place = HE_EDGE_ASIDE;
    }
    he_decimation_put(d, e, place, &what);
    return HE_OK;
}

/* Prefetches from memory the ids of the end vertices of edges. */
static void ask_for_edges(const he_decimation *d, const uint32_t *edges, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        __builtin_prefetch(&d->mesh->c.origin[2 * (size_t)edges[i]]);
    }
}

/* Prefetches from memory the nodes of the end vertices of an edge. A node fills two cache lines. */
static void ask_for_ends(const he_decimation *d, uint32_t edge)
{
    for (unsigned i = 0; i < 2; i++) {
        uint32_t end = d->mesh->c.origin[2 * (size_t)edge + i];
        if (end != HE_DEAD) {
            __builtin_prefetch((const char *)&d->nodes[end]);
            __builtin_prefetch((const char *)&d->nodes[end] + 64);
        }
    }
}

enum { AHEAD = 4 };

/* Tries to collapse the edges of an array, which were first in the queue. Stops when the mesh has
 * only `faces` faces left. */
static he_status collapse_some(he_decimation *d, const uint32_t *edges, uint32_t count,
                               uint32_t bucket, uint32_t faces, he_error *err)
{
    const he_mesh *m = d->mesh;
    he_status status = HE_OK;
    ask_for_edges(d, edges, count);
    for (uint32_t i = 0; i < AHEAD && i < count; i++) {
        ask_for_ends(d, edges[i]);
    }
    for (uint32_t i = 0; i < count && he_mesh_faces(m) > faces && status == HE_OK; i++) {
        if (i + AHEAD < count) {
            ask_for_ends(d, edges[i + AHEAD]);
        }
        if (he_edge_is_live(m, (he_edge){edges[i]})) {
            status = collapse_one(d, (he_edge){edges[i]}, bucket, err);
        }
    }
    return status;
}

/* Progress is reported each time TAKES_PER_LOOK chunks of edges were taken from the queue, and each
 * time WORK_PER_LOOK units of work were done. */
enum { TAKES_PER_LOOK = 256, WORK_PER_LOOK = 2 * HE_PROGRESS_STRIDE };

he_status he_decimation_go(he_decimation *d, uint32_t faces, he_error *err)
{
    const he_mesh *m = d->mesh;
    uint32_t before = he_mesh_faces(m);
    he_status status = he_progress_phase(m->progress, "collapsing edges", 1, err);
    uint64_t next = WORK_PER_LOOK;
    for (uint64_t step = 0; status == HE_OK && he_mesh_faces(m) > faces; step++) {
        uint32_t edges[HE_QUEUE_CHUNK], bucket = 0;
        uint32_t count = he_queue_take(&d->queue, edges, &bucket);
        if (count == 0 && !he_decimation_catch_up(d)) {
            break;
        }
        if (step % TAKES_PER_LOOK == 0 || d->work >= next) {
            next = d->work + WORK_PER_LOOK;
            status = he_progress_step(m->progress, before - he_mesh_faces(m), before - faces, err);
        }
        if (status == HE_OK) {
            status = collapse_some(d, edges, count, bucket, faces, err);
        }
    }
    return status;
}

static he_decimate_stop find_stop(const he_decimation *d, uint32_t faces)
{
    const he_mesh *m = d->mesh;
    if (he_mesh_faces(m) <= faces) {
        return HE_STOP_FACES;
    }
    for (uint32_t e = 0; e < m->c.edges.issued; e++) {
        if (he_edge_is_live(m, (he_edge){e}) && d->places[e] == HE_EDGE_DEAR) {
            return HE_STOP_ERROR;
        }
    }
    return HE_STOP_EXHAUSTED;
}

/* Returns the address at which the array of nodes begins in a block of memory: the first address
 * that is aligned to a cache line. The block must have room for one node more than needed. */
static he_node *align(void *memory)
{
    uintptr_t over = (uintptr_t)memory % HE_CACHE_LINE;
    return (he_node *)((char *)memory + (over == 0 ? 0 : HE_CACHE_LINE - over));
}

he_status he_decimation_begin(he_decimation *d, const he_decimate_options *options, he_error *err)
{
    const he_mesh *m = d->mesh;
    d->boundary_weight = options->boundary_weight;
    d->memory = he_mem_array(NULL, (size_t)m->c.vertices.issued + 1, sizeof *d->nodes);
    d->nodes = align(d->memory);
    d->flags = he_mem_zero(m->c.vertices.issued, sizeof *d->flags);
    d->places = he_mem_zero(m->c.edges.issued, sizeof *d->places);
    he_status status = he_queue_init(&d->queue, m->c.edges.live, err);
    if (status == HE_OK && (d->memory == NULL || d->flags == NULL || d->places == NULL)) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the weights of the faces");
    }
    if (status == HE_OK) {
        status = weigh(d, err);
    }
    d->most = ldexp(options->max_error, -d->exponent);
    return status == HE_OK ? fill_queue(d, err) : status;
}

void he_decimation_end(he_decimation *d)
{
    he_mem_free(d->memory);
    he_mem_free(d->flags);
    he_mem_free(d->places);
    he_queue_clear(&d->queue);
    he_ids_clear(&d->late);
}

static he_status run(he_mesh *m, const he_decimate_options *options, he_progressive *log,
                     he_merges *merges, he_decimated *out, he_error *err)
{
    he_decimation d = {.mesh = m, .log = log, .merges = merges};
    he_status status = he_decimation_begin(&d, options, err);
    if (status == HE_OK) {
        status = he_decimation_go(&d, options->faces, err);
    }
    if (status == HE_OK) {
        *out = (he_decimated){find_stop(&d, options->faces), ldexp(d.error, d.exponent)};
    }
    he_decimation_end(&d);
    return status;
}

he_status he_decimation_run(he_mesh *m, const he_decimate_options *options, he_progressive *log,
                            he_decimated *out, he_error *err)
{
    he_status status = check(m, options, err);
    return status == HE_OK ? run(m, options, log, NULL, out, err) : status;
}

static void note(he_mesh *m, he_kind kind, const he_ids *pairs)
{
    for (size_t i = 0; i + 1 < pairs->count; i += 2) {
        he_note_merged(m, kind, pairs->ids[i], pairs->ids[i + 1]);
    }
}

static he_status finish(he_mesh *m, he_mesh **copy, const he_merges *merges, bool replace,
                        he_error *err)
{
    if (!replace) {
        size_t lineage = (merges->vertices.count + merges->edges.count) / 2;
        he_status written = he_result_write(m, *copy, lineage, err);
        if (written == HE_OK) {
            note(m, HE_VERTEX, &merges->vertices);
            note(m, HE_EDGE, &merges->edges);
        }
        return written;
    }
    he_status status = he_mesh_replace(m, *copy, HE_KEEPS_IDS, err);
    if (status == HE_OK) {
        *copy = NULL;
    }
    return status;
}

he_status he_decimate(he_mesh *m, const he_decimate_options *options, he_decimated *out,
                      he_error *err)
{
    uint32_t faces = he_mesh_faces(m);
    he_decimated done = {.stop = HE_STOP_FACES};
    he_merges merges = {.vertices = {0}};
    he_mesh *copy = NULL;
    he_status status = check(m, options, err);
    if (status == HE_OK && faces > options->faces) {
        bool replace = faces - options->faces > HE_DECIMATE_RECORDED;
        status = he_mesh_copy(m, &copy, err);
        if (status == HE_OK) {
            he_mesh_set_progress(copy, m->progress);
            status = run(copy, options, NULL, replace ? NULL : &merges, &done, err);
        }
        /* Each collapse deletes a vertex. So if the decimated copy has as many vertices as the
         * mesh, nothing was collapsed. */
        if (status == HE_OK && he_mesh_vertices(copy) < he_mesh_vertices(m)) {
            status = finish(m, &copy, &merges, replace, err);
        }
    }
    he_mesh_free(copy);
    he_ids_clear(&merges.vertices);
    he_ids_clear(&merges.edges);
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    return status;
}
