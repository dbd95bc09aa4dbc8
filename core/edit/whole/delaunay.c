#include "edit/whole/delaunay.h"

#include "edit/local/flip.h"
#include "edit/piece/list.h"
#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "mesh/write.h"

static const double PI = 3.14159265358979323846;

/* The state of one he_delaunay. */
typedef struct flipper {
    he_mesh *m;
    bool marked; /* true if the mesh has marks (locked or feature elements) */
    he_marks marks;
    uint32_t *queue; /* the edges to test: a ring buffer of `room` entries */
    size_t room, head, waiting;
    uint64_t *queued; /* a bit for each edge: set if the edge is in the queue */
    he_ids stuck;     /* edges that he_edge_flip has refused */
    /* the number of flips that were done when the edges in `stuck` were last tried */
    size_t stuck_at;
    he_ids flips;
    uint64_t steps, limit;
    uint64_t dequeued;
    uint64_t work; /* the amount of work since progress was last reported */
    /* `from`: the number of records in the delta (the log of writes, for undo) before this edit.
     * `fold_at`: the number of records at which records are next merged. */
    size_t from, fold_at;
} flipper;

/* When this edit has written this many records for each edge of the mesh, all records of one link
 * are merged into one record. */
enum { RECORDS_OF_EDGE = 4 };

/* Progress is reported after WORK_PER_LOOK units of work. A step around a vertex is one unit;
 * testing an edge takes as long as WORK_OF_EDGE such steps. */
enum { WORK_OF_EDGE = 16, WORK_PER_LOOK = WORK_OF_EDGE * HE_PROGRESS_STRIDE / 2 };

static void enqueue(flipper *q, he_edge e)
{
    if (!he_bits_get(q->queued, e.i)) {
        he_bits_set(q->queued, e.i);
        q->queue[(q->head + q->waiting++) % q->room] = e.i;
    }
}

static he_edge dequeue(flipper *q)
{
    uint32_t e = q->queue[q->head];
    q->head = (q->head + 1) % q->room;
    q->waiting--;
    q->queued[e >> 6] &= ~((uint64_t)1 << (e & 63));
    return (he_edge){e};
}

/* Returns the i-th edge in the queue, or HE_NONE if the queue is shorter. */
static he_edge waiting_at(const flipper *q, size_t i)
{
    return (he_edge){i < q->waiting ? q->queue[(q->head + i) % q->room] : HE_NONE};
}

/* Returns true if marks (locked or feature elements, see marks.h) forbid flipping edge e, which
 * must not be on the boundary. */
static bool is_held(const flipper *q, he_edge e)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    return q->marked && (he_is_feature(&q->marks, e) || he_is_locked(&q->marks, HE_EDGE, e.i) ||
                         he_is_locked(&q->marks, HE_FACE, he_face_of(q->m, h).i) ||
                         he_is_locked(&q->marks, HE_FACE, he_face_of(q->m, he_twin(h)).i));
}

/* Returns true if the edge violates the Delaunay criterion, so that it should be flipped. */
static bool is_crooked(const flipper *q, he_edge e)
{
    const he_mesh *m = q->m;
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    if (he_is_boundary_edge(m, e) || is_held(q, e) || !he_is_triangle(m, h) ||
        !he_is_triangle(m, t)) {
        return false;
    }
    double alpha = he_corner_angle(m, he_prev(m, h)), beta = he_corner_angle(m, he_prev(m, t));
    return alpha + beta > PI + HE_DELAUNAY_EPSILON;
}

/* Returns the number of steps that he_edge_flip() will take to search for an edge between the
 * corners opposite to edge e. */
static uint32_t search_steps(const he_mesh *m, he_edge e)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    he_halfedge c = he_prev(m, h), d = he_prev(m, he_twin(h)), x = c, y = d;
    uint32_t n = 0;
    do {
        n++;
        x = he_swing_ccw(m, x);
        y = he_swing_ccw(m, y);
    } while (x.i != c.i && y.i != d.i);
    return n;
}

/* If the delta has many records, merges all records of one link into one record. The number of
 * records is then proportional to the size of the mesh, not to the number of flips. */
static he_status fold(flipper *q, he_error *err)
{
    he_delta *delta = q->m->delta;
    if (delta->count < q->fold_at) {
        return HE_OK;
    }
    he_status status = he_delta_fold(delta, q->from, q->m->progress, err);
    size_t left = delta->count - q->from;
    q->fold_at = delta->count + left + RECORDS_OF_EDGE * (size_t)q->m->c.edges.live;
    return status;
}

static he_status flip(flipper *q, he_edge e, he_error *err)
{
    const he_mesh *m = q->m;
    he_status status = he_ids_reserve(&q->flips, 1, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&q->stuck, 1, err);
    }
    if (status != HE_OK) {
        return status;
    }
    uint32_t search = search_steps(m, e);
    q->steps += search;
    q->work += search;
    status = he_edge_flip(q->m, e, NULL);
    if (status == HE_NO_MEMORY) {
        return he_fail(err, status, HE_EDGE, e.i, "no memory to flip edge %u", e.i);
    }
    if (status != HE_OK) {
        q->stuck.ids[q->stuck.count++] = e.i;
        return HE_OK;
    }
    q->flips.ids[q->flips.count++] = e.i;
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    enqueue(q, he_edge_of(he_next(m, h)));
    enqueue(q, he_edge_of(he_prev(m, h)));
    enqueue(q, he_edge_of(he_next(m, t)));
    enqueue(q, he_edge_of(he_prev(m, t)));
    return fold(q, err);
}

/* Reports progress from time to time. Flips put more edges into the queue, so the total work is not
 * known; the ratio of tested edges to tested and waiting edges is an estimate. */
static he_status look(flipper *q, he_error *err)
{
    q->work += WORK_OF_EDGE;
    if (q->work < WORK_PER_LOOK) {
        return HE_OK;
    }
    q->work = 0;
    return he_progress_step(q->m->progress, q->dequeued, q->dequeued + q->waiting, err);
}

static he_status empty_queue(flipper *q, he_error *err)
{
    he_status status = HE_OK;
    while (status == HE_OK && q->waiting > 0) {
        he_edge e = dequeue(q);
        q->dequeued++;
        status = look(q, err);
        if (status != HE_OK) {
            return status;
        }
        if (++q->steps > q->limit) {
            return he_fail_plain(err, HE_LIMIT,
                                 "the flips take more than %llu steps; %zu flips were made before "
                                 "the limit was reached",
                                 (unsigned long long)q->limit, q->flips.count);
        }
        he_prefetch_coming(q->m, waiting_at(q, 2), waiting_at(q, 4));
        if (is_crooked(q, e)) {
            status = flip(q, e, err);
        }
    }
    return status;
}

/* Puts the edges whose flips were refused back into the queue, because flips of other edges may
 * have made their flips possible. */
static void try_again(flipper *q)
{
    if (q->flips.count > q->stuck_at) {
        for (size_t i = 0; i < q->stuck.count; i++) {
            enqueue(q, (he_edge){q->stuck.ids[i]});
        }
        q->stuck.count = 0;
        q->stuck_at = q->flips.count;
    }
}

static he_status begin(flipper *q, const uint32_t *edges, size_t count, he_error *err)
{
    he_mesh *m = q->m;
    q->room = m->c.edges.issued;
    q->limit = HE_DELAUNAY_STEPS * (uint64_t)m->c.edges.live;
    q->marked = he_marks_find(m, &q->marks);
    q->queue = he_mem_array(NULL, q->room + 1, sizeof *q->queue);
    q->queued = he_bits_new(q->room + 1);
    if (q->queue == NULL || q->queued == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a queue of %zu edges", q->room);
    }
    size_t first = edges != NULL ? count : q->room;
    he_status status = he_progress_phase(m->progress, "flipping", 1, err);
    for (size_t i = 0; i < first && status == HE_OK; i++) {
        status = i % HE_PROGRESS_STRIDE == 0 ? he_progress_step(m->progress, 0, 1, err) : HE_OK;
        he_edge e = {edges != NULL ? edges[i] : (uint32_t)i};
        if (he_edge_is_live(m, e)) {
            enqueue(q, e);
        }
    }
    return status;
}

he_status he_delaunay(he_mesh *m, const uint32_t *edges, size_t count, he_ids *flips, he_error *err)
{
    flipper q = {.m = m};
    he_bracket bracket;
    he_status status = HE_OK;
    if (edges != NULL) {
        status = he_list_require(m, HE_EDGE, edges, count, HE_REPEATED_ELEMENT, err);
    }
    if (status == HE_OK) {
        status = begin(&q, edges, count, err);
    }
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    q.from = bracket.mark.records;
    q.fold_at = q.from + RECORDS_OF_EDGE * (size_t)m->c.edges.live;
    while (status == HE_OK && q.waiting > 0) {
        status = empty_queue(&q, err);
        try_again(&q);
    }
    status = he_edit_end(m, &bracket, status);
    if (status == HE_OK && flips != NULL) {
        he_ids_clear(flips);
        *flips = q.flips;
        q.flips = (he_ids){0};
    }
out:
    he_mem_free(q.queue);
    he_mem_free(q.queued);
    he_ids_clear(&q.stuck);
    he_ids_clear(&q.flips);
    return status;
}
