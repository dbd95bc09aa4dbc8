#include "draw/draw_slots.h"

#include "geometry/vec3.h"
#include "mesh/walk.h"

#include <assert.h>
#include <string.h>

/* --- freed runs of slots ---
 *
 * A slot is room for one triangle of the drawing. The slots of a face are consecutive: they are a
 * run. Freed runs form linked lists, one for each length and one for all long runs; `bin` has the
 * first slot of the first run in each list. `owner` has a word for each slot. In a freed run, the
 * word of the first slot is the first slot of the next run in the list, and in the list of long
 * runs the word of the second slot is the length of the run. In all these words the bit
 * HE_DRAW_SLOT_DEAD is set. */

enum { LONG_RUN = HE_DRAW_SLOT_BINS, TRIES = 8 };
static const uint32_t LAST = HE_DRAW_SLOT_DEAD - 1; /* marks the end of a linked list */

static uint32_t bin_of(uint32_t length)
{
    return length < LONG_RUN ? length : 0;
}

static void put_run(he_draw_slots *s, uint32_t slot, uint32_t length)
{
    uint32_t bin = bin_of(length);
    for (uint32_t i = 0; i < length; i++) {
        s->owner[slot + i] = HE_DRAW_SLOT_DEAD | LAST;
    }
    s->owner[slot] = HE_DRAW_SLOT_DEAD | s->bin[bin];
    if (bin == 0) {
        s->owner[slot + 1] = HE_DRAW_SLOT_DEAD | length;
    }
    s->bin[bin] = slot;
    s->filled |= (uint64_t)1 << bin;
}

/* Removes a run of slots from its linked list and returns the first slot of the run. `link` is the
 * word that leads to the run. */
static uint32_t unlink_run(he_draw_slots *s, uint32_t bin, uint32_t *link)
{
    uint32_t slot = *link & ~HE_DRAW_SLOT_DEAD;
    *link = (*link & HE_DRAW_SLOT_DEAD) | (s->owner[slot] & ~HE_DRAW_SLOT_DEAD);
    if (s->bin[bin] == LAST) {
        s->filled &= ~((uint64_t)1 << bin);
    }
    return slot;
}

/* Finds a free run of at least `length` slots, removes it from its linked list, and sets *found to
 * its length. Returns LAST if no run is found. Only the first TRIES runs in the list of long runs
 * are examined. */
static uint32_t find_run(he_draw_slots *s, uint32_t length, uint32_t *found)
{
    uint64_t bins = length < LONG_RUN ? s->filled >> length << length : 0;
    bins &= ~(uint64_t)1;
    if (bins != 0) {
        uint32_t bin = (uint32_t)__builtin_ctzll(bins);
        *found = bin;
        return unlink_run(s, bin, &s->bin[bin]);
    }
    uint32_t *link = &s->bin[0];
    for (int i = 0; i < TRIES && (*link & ~HE_DRAW_SLOT_DEAD) != LAST; i++) {
        uint32_t slot = *link & ~HE_DRAW_SLOT_DEAD;
        *found = s->owner[slot + 1] & ~HE_DRAW_SLOT_DEAD;
        if (*found >= length) {
            return unlink_run(s, 0, link);
        }
        link = &s->owner[slot];
    }
    return LAST;
}

static void give_run(he_draw_slots *s, uint32_t face, uint32_t length)
{
    uint32_t found = 0, slot = find_run(s, length, &found);
    if (slot == LAST) {
        slot = s->count;
        s->count += length;
    } else {
        s->dead -= length;
        if (found > length) {
            put_run(s, slot + length, found - length);
        }
    }
    for (uint32_t i = 0; i < length; i++) {
        s->owner[slot + i] = face;
    }
    s->first[face] = slot;
}

/* Returns how many slots a face has, one for each triangle by which the face is drawn. */
static uint32_t run_of(const he_draw_slots *s, uint32_t face)
{
    uint32_t length = 0;
    if (face < s->faces && s->first[face] != HE_NONE) {
        uint32_t slot = s->first[face];
        while (slot + length < s->count && s->owner[slot + length] == face) {
            length++;
        }
    }
    return length;
}

static void free_run(he_draw_slots *s, uint32_t face, uint32_t length)
{
    put_run(s, s->first[face], length);
    s->first[face] = HE_NONE;
    s->dead += length;
}

/* --- making --- */

void he_draw_slots_free(he_draw_slots *s)
{
    if (s != NULL) {
        he_mem_free(s->owner);
        he_mem_free(s->first);
        he_mem_free(s->steps);
        he_ids_clear(&s->changed_vertices);
        he_ids_clear(&s->changed_slots);
        he_mem_free(s);
    }
}

static he_status check_ids(const he_mesh *m, uint64_t slots, he_error *err)
{
    uint32_t faces = m->c.faces.issued;
    if (faces > (uint32_t)1 << HE_DRAWN_SIDES || slots >= LAST) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED, "%u faces have too many triangles to draw",
                             faces);
    }
    return HE_OK;
}

static bool grow(uint32_t **array, size_t *capacity, size_t need)
{
    if (need <= *capacity) {
        return true;
    }
    size_t grown = he_mem_grown(*capacity, need);
    uint32_t *words = he_mem_array(*array, grown, sizeof *words);
    if (words == NULL) {
        return false;
    }
    *array = words;
    *capacity = grown;
    return true;
}

static he_status reserve(he_draw_slots *s, const he_mesh *m, uint64_t slots, he_error *err)
{
    he_status status = check_ids(m, slots, err);
    if (status != HE_OK) {
        return status;
    }
    if (!grow(&s->first, &s->first_capacity, m->c.faces.issued) ||
        !grow(&s->owner, &s->owner_capacity, (size_t)slots)) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for the positions of triangles in the arrays");
    }
    return HE_OK;
}

static void issue_faces(he_draw_slots *s, uint32_t issued)
{
    for (; s->faces < issued; s->faces++) {
        s->first[s->faces] = HE_NONE;
    }
}

he_status he_draw_slots_new(const he_mesh *m, uint64_t layout, uint64_t revision,
                            he_draw_slots **out, he_error *err)
{
    he_draw_slots *s = he_mem_zero(1, sizeof *s);
    if (s == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for the positions of triangles in the arrays");
    }
    uint64_t corners = 2 * (uint64_t)m->c.edges.live - m->c.boundary_halfedges;
    he_status status = reserve(s, m, corners - 2 * (uint64_t)m->c.faces.live, err);
    if (status != HE_OK) {
        he_draw_slots_free(s);
        return status;
    }
    s->layout = layout;
    s->revision = s->known = revision;
    s->frame = he_frame_of(m);
    s->vertices = m->c.vertices.issued;
    for (uint32_t bin = 0; bin < HE_DRAW_SLOT_BINS; bin++) {
        s->bin[bin] = LAST;
    }
    issue_faces(s, m->c.faces.issued);
    for (uint32_t f = 0; f < s->faces; f++) {
        if (m->c.face_halfedge[f] != HE_DEAD) {
            give_run(s, f, he_face_degree(m, (he_face){f}) - 2);
        }
    }
    *out = s;
    return HE_OK;
}

/* --- remembering changes --- */

static size_t rows_of(const he_draw_slots *s)
{
    return (size_t)s->vertices + s->count;
}

static void forget_front(he_ids *list, size_t count)
{
    list->count -= count;
    if (list->count > 0) {
        memmove(list->ids, list->ids + count, list->count * sizeof *list->ids);
    }
}

/* Forgets the changes of the oldest steps (updates of the drawing) if `more` new changes would be
 * too many to remember. Half of the memory is freed at once, so that the next calls need not forget
 * anything. */
static void forget_steps(he_draw_slots *s, size_t more)
{
    size_t most = rows_of(s) / 2 + HE_DRAW_SLOT_CHANGES, gone = 0;
    if (s->changed_vertices.count + s->changed_slots.count + more <= most) {
        return;
    }
    size_t vertices = 0, slots = 0;
    while (gone < s->step_count &&
           s->changed_vertices.count - vertices + s->changed_slots.count - slots + more >
               most / 2) {
        vertices = s->steps[gone].vertices;
        slots = s->steps[gone].slots;
        s->known = s->steps[gone++].revision;
    }
    forget_front(&s->changed_vertices, vertices);
    forget_front(&s->changed_slots, slots);
    s->step_count -= gone;
    for (size_t i = 0; i < s->step_count; i++) {
        s->steps[i] = s->steps[i + gone];
        s->steps[i].vertices -= vertices;
        s->steps[i].slots -= slots;
    }
}

static he_status reserve_step(he_draw_slots *s, size_t vertices, size_t slots, he_error *err)
{
    he_status status = he_ids_reserve(&s->changed_vertices, vertices, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&s->changed_slots, slots, err);
    }
    if (status == HE_OK && s->step_count == s->step_capacity) {
        size_t capacity = he_mem_grown(s->step_capacity, s->step_count + 1);
        he_draw_slot_step *steps = he_mem_array(s->steps, capacity, sizeof *steps);
        if (steps == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to record the changes");
        }
        s->steps = steps;
        s->step_capacity = capacity;
    }
    return status;
}

static void note_run(he_draw_slots *s, uint32_t slot, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        s->changed_slots.ids[s->changed_slots.count++] = slot + i;
    }
}

he_status he_draw_slots_changed(const he_draw_slots *s, uint64_t since, uint64_t most,
                                he_ids *vertices, he_ids *triangles, he_error *err)
{
    if (since < s->known) {
        return he_fail_plain(err, HE_UNSUPPORTED,
                             "the changes since the client's revision are no longer recorded");
    }
    size_t step = s->step_count;
    while (step > 0 && s->steps[step - 1].revision > since) {
        step--;
    }
    if (step == s->step_count) {
        return HE_OK;
    }
    size_t v = step == 0 ? 0 : s->steps[step - 1].vertices;
    size_t t = step == 0 ? 0 : s->steps[step - 1].slots;
    size_t v_count = s->changed_vertices.count - v, t_count = s->changed_slots.count - t;
    if (v_count + t_count > most) {
        return he_fail_plain(
            err, HE_LIMIT,
            "%zu vertices and triangles changed, which are too many to list one by one",
            v_count + t_count);
    }
    he_status status = he_ids_reserve(vertices, v_count, err);
    if (status == HE_OK) {
        status = he_ids_reserve(triangles, t_count, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (v_count > 0) {
        memcpy(vertices->ids, s->changed_vertices.ids + v, v_count * sizeof *vertices->ids);
    }
    if (t_count > 0) {
        memcpy(triangles->ids, s->changed_slots.ids + t, t_count * sizeof *triangles->ids);
    }
    vertices->count = v_count;
    triangles->count = t_count;
    status = he_ids_sort(vertices, err);
    if (status == HE_OK) {
        status = he_ids_sort(triangles, err);
    }
    if (status == HE_OK && vertices->count + triangles->count > rows_of(s) / 2) {
        return he_fail_plain(err, HE_UNSUPPORTED,
                             "more than half of the vertices and triangles changed");
    }
    return status;
}

/* --- bringing forward --- */

static bool is_used(uint32_t vertex_halfedge)
{
    return vertex_halfedge != HE_DEAD && vertex_halfedge != HE_NONE;
}

static he_status touch_face(he_touched *t, uint32_t face, he_error *err)
{
    return face == HE_NONE || face == HE_DEAD ? HE_OK : he_ids_add(&t->faces, face, err);
}

/* Adds the elements whose entries in the drawing may change because of one record of a delta. A
 * half-edge that moves to another face has a record of the column `face` with the old and the new
 * face. So for a record of another column of a half-edge, only its present face is added. */
static he_status touch_all(he_touched *t, uint32_t vertices, he_error *err)
{
    he_status status = he_ids_reserve(&t->moved, vertices, err);
    for (uint32_t v = 0; v < vertices && status == HE_OK; v++) {
        t->moved.ids[t->moved.count++] = v;
    }
    return status;
}

static he_status touch(he_touched *t, const he_mesh *m, const he_record *r, he_error *err)
{
    he_status status = HE_OK;
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
    case HE_COL_ORIGIN:
        return touch_face(t, m->c.face[r->row], err);
    case HE_COL_FACE:
        status = touch_face(t, r->before, err);
        return status != HE_OK ? status : touch_face(t, r->after, err);
    case HE_COL_VERTEX_HALFEDGE:
        return is_used(r->before) && is_used(r->after) ? HE_OK
                                                       : he_ids_add(&t->vertices, r->row, err);
    case HE_COL_FACE_HALFEDGE:
        return he_ids_add(&t->faces, r->row, err);
    case HE_COL_POSITION:
        return he_ids_add(&t->moved, r->row, err);
    case HE_COL_POSITIONS:
        return touch_all(t, r->row, err);
    case HE_COL_REPLACED:
        return he_fail_plain(err, HE_UNSUPPORTED, "the whole content of the mesh was replaced");
    case HE_COL_PREV:
    case HE_COL_PARENT:
    case HE_COL_MERGED:
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
    case HE_COL_MATERIAL:
    case HE_COL_ATTRIBUTE:
        break;
    }
    return HE_OK;
}

he_status he_touched_add(he_touched *touched, const he_mesh *m, const he_delta *delta,
                         he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < delta->count && status == HE_OK; i++) {
        status = touch(touched, m, &delta->records[i], err);
    }
    return status;
}

void he_touched_clear(he_touched *touched)
{
    he_ids_clear(&touched->vertices);
    he_ids_clear(&touched->faces);
    he_ids_clear(&touched->moved);
}

/* The number of steps of work that are still allowed before the update is refused. */
typedef struct budget {
    uint64_t left;
} budget;

static he_status spend(budget *b, uint64_t steps, he_error *err)
{
    if (steps > b->left) {
        return he_fail_plain(err, HE_LIMIT,
                             "updating the arrays of triangles would take too many steps");
    }
    b->left -= steps;
    return HE_OK;
}

static bool is_in_ball(const he_frame *frame, he_vec3 p)
{
    he_vec3 v =
        he_vec3_sub(he_vec3_scale(p, frame->scale), he_vec3_scale(frame->origin, frame->scale));
    return he_vec3_dot(v, v) <= 1; /* false for NaN too */
}

static bool is_triangle(const he_mesh *m, uint32_t face)
{
    uint32_t first = m->c.face_halfedge[face];
    return m->c.next[m->c.next[m->c.next[first]]] == first;
}

/* Adds the moved vertices to `t->vertices` and the faces around them to `t->faces`. Triangles are
 * left out, because only the triangulation of a larger face can change when a vertex moves. */
static he_status spread(const he_mesh *m, he_touched *t, budget *b, he_error *err)
{
    he_status status = he_ids_sort(&t->moved, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&t->vertices, t->moved.count, err);
    }
    for (size_t i = 0; i < t->moved.count && status == HE_OK; i++) {
        uint32_t v = t->moved.ids[i], first = m->c.vertex_halfedge[v], h = first;
        t->vertices.ids[t->vertices.count++] = v;
        while (is_used(first) && status == HE_OK) {
            status = spend(b, 1, err);
            if (status == HE_OK && m->c.face[h] != HE_NONE && !is_triangle(m, m->c.face[h])) {
                status = he_ids_add(&t->faces, m->c.face[h], err);
            }
            h = m->c.prev[h] ^ 1u;
            if (h == first) {
                break;
            }
        }
    }
    return status;
}

/* Checks that every new or moved vertex is still inside the frame of the drawing. If more than half
 * of the vertices moved, also checks that the frame would be equal if it were computed now. */
static he_status check_frame(const he_draw_slots *s, const he_mesh *m, const he_touched *t,
                             he_error *err)
{
    for (size_t i = 0; i < t->vertices.count; i++) {
        uint32_t v = t->vertices.ids[i];
        if (m->c.vertex_halfedge[v] != HE_DEAD && !is_in_ball(&s->frame, m->c.position[v])) {
            return he_fail(err, HE_UNSUPPORTED, HE_VERTEX, v,
                           "vertex %u moved outside the bounds of the drawing", v);
        }
    }
    if (t->moved.count > m->c.vertices.live / 2) {
        he_frame frame = he_frame_of(m);
        he_vec3 shift = he_vec3_sub(frame.origin, s->frame.origin);
        if (frame.scale != s->frame.scale || he_vec3_extent(shift) != 0) {
            return he_fail_plain(err, HE_UNSUPPORTED,
                                 "most vertices moved, so that the drawing needs other bounds");
        }
    }
    return HE_OK;
}

/* The numbers of slots of the touched faces. `length` has two entries for each face: the number
 * before the update and the number after it. `before` and `after` are the sums over all faces. */
typedef struct runs {
    uint32_t *length;
    uint64_t before, after;
} runs;

static he_status measure(const he_draw_slots *s, const he_mesh *m, const he_touched *t, runs *out,
                         budget *b, he_error *err)
{
    out->length = he_mem_array(NULL, t->faces.count + 1, 2 * sizeof *out->length);
    if (out->length == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu faces", t->faces.count);
    }
    he_status status = HE_OK;
    for (size_t i = 0; i < t->faces.count && status == HE_OK; i++) {
        he_face f = {t->faces.ids[i]};
        out->length[2 * i] = run_of(s, f.i);
        out->length[2 * i + 1] = he_face_is_live(m, f) ? he_face_degree(m, f) - 2 : 0;
        out->before += out->length[2 * i];
        out->after += out->length[2 * i + 1];
        status = spend(b, 1 + (uint64_t)out->length[2 * i] + out->length[2 * i + 1], err);
    }
    return status;
}

static void commit(he_draw_slots *s, const he_mesh *m, const he_touched *t, const runs *r)
{
    issue_faces(s, m->c.faces.issued);
    s->vertices = m->c.vertices.issued;
    /* All slots that faces no longer need are freed before any slots are taken, so that the freed
     * slots can be used again at once. */
    for (size_t i = 0; i < t->faces.count; i++) {
        uint32_t face = t->faces.ids[i], before = r->length[2 * i];
        if (before > 0) {
            note_run(s, s->first[face], before);
            if (before != r->length[2 * i + 1]) {
                free_run(s, face, before);
            }
        }
    }
    for (size_t i = 0; i < t->faces.count; i++) {
        uint32_t face = t->faces.ids[i], after = r->length[2 * i + 1];
        if (after > 0 && s->first[face] == HE_NONE) {
            give_run(s, face, after);
            note_run(s, s->first[face], after);
        }
    }
    if (t->vertices.count > 0) {
        memcpy(s->changed_vertices.ids + s->changed_vertices.count, t->vertices.ids,
               t->vertices.count * sizeof *t->vertices.ids);
        s->changed_vertices.count += t->vertices.count;
    }
}

he_status he_draw_slots_advance(he_draw_slots *s, const he_mesh *m, he_touched *t,
                                uint64_t revision, uint64_t most, he_error *err)
{
    budget b = {most};
    runs r = {NULL, 0, 0};
    he_status status = spread(m, t, &b, err);
    if (status == HE_OK) {
        status = he_ids_sort(&t->vertices, err);
    }
    if (status == HE_OK) {
        status = check_frame(s, m, t, err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&t->faces, err);
    }
    if (status == HE_OK) {
        status = measure(s, m, t, &r, &b, err);
    }
    if (status == HE_OK) {
        status = reserve(s, m, s->count + r.after, err);
    }
    if (status == HE_OK) {
        forget_steps(s, t->vertices.count + (size_t)(r.before + r.after));
        status = reserve_step(s, t->vertices.count, (size_t)(r.before + r.after), err);
    }
    if (status == HE_OK) {
        commit(s, m, t, &r);
        s->revision = revision;
        if (t->vertices.count + t->faces.count > 0) {
            s->steps[s->step_count++] =
                (he_draw_slot_step){revision, s->changed_vertices.count, s->changed_slots.count};
        }
        if (s->dead > s->count / 2) {
            status = he_fail_plain(err, HE_UNSUPPORTED,
                                   "more than half of the rows of triangles are unused");
        }
    }
    he_mem_free(r.length);
    return status;
}
