#include "geometry/ears.h"

#include "geometry/corner_tree.h"

/* --- circular, doubly linked lists of corners; a list has a head node, which is no corner --- */

typedef struct ring {
    uint32_t *next, *prev;
} ring;

/* Links element i to itself. If i is the head node of a list, the list is then empty; if i is a
 * corner, the corner is then in no list. */
static void isolate(ring r, uint32_t i)
{
    r.next[i] = r.prev[i] = i;
}

static void insert_after(ring r, uint32_t before, uint32_t i)
{
    uint32_t after = r.next[before];
    r.next[before] = r.prev[after] = i;
    r.prev[i] = before;
    r.next[i] = after;
}

static void take_out(ring r, uint32_t i)
{
    r.next[r.prev[i]] = r.next[i];
    r.prev[r.next[i]] = r.prev[i];
    isolate(r, i);
}

/* --- ears --- */

typedef enum state {
    CANDIDATE, /* the corner turns left; whether it is an ear is not known yet */
    PIERCED,   /* the corner turns left, and another corner lies in its triangle */
    FLAT,      /* the corner does not turn left */
    TAKEN      /* the corner would be an ear, but its diagonal is an edge of the mesh */
} state;

typedef struct ears {
    const he_mesh *m;
    const he_planar_loop *f;
    bool avoid; /* true if no diagonal may join two vertices that an edge of the mesh joins */
    ring loop;  /* circular list, without a head node, of the corners that are not cut off yet */
    /* Three lists: of the CANDIDATE, of the PIERCED and of the FLAT corners. The head node of the
     * list of a state is n + state, where n is the number of corners of the loop. */
    ring kinds;
    /* Lists of PIERCED corners. The list with the head node n + q has the corners in whose triangle
     * corner q was found. The list with the head node 2n has the corners that must be tried again,
     * because the corner found in their triangle was cut off or turns left now. */
    ring watch;
    uint8_t *state;
    he_corner_tree tree; /* the corners that have not turned left so far and are not cut off yet */
    /* `left`: number of corners that are not cut off yet; `at`: the CANDIDATE to try next; `last`:
     * a corner of the triangle that remains at the end */
    uint32_t left, at, last;
    uint32_t taken; /* number of corners in state TAKEN */
    /* when more steps than this were taken, triangles are no longer tested for being empty */
    uint64_t most;
    he_triangulation_work *work;
} ears;

static bool is_taken(const ears *e, uint32_t a, uint32_t c)
{
    return e->avoid && he_diagonal_exists(e->m, e->f, a, c, e->work);
}

static uint32_t list_of(const ears *e, state s)
{
    return e->f->n + (uint32_t)s;
}

/* Removes a corner from the tree after it was cut off or began to turn left. The PIERCED corners in
 * whose triangle this corner was found move to the list of corners that must be tried again. */
static void leave_tree(ears *e, uint32_t corner)
{
    uint32_t list = e->f->n + corner, waiting = 2 * e->f->n, i;
    he_corner_tree_remove(&e->tree, corner);
    while ((i = e->watch.next[list]) != list) {
        take_out(e->watch, i);
        insert_after(e->watch, e->watch.prev[waiting], i);
    }
}

/* Updates the state of corner i after a neighbour of corner i was cut off. If corner i turns left,
 * it is inserted into the list of candidates behind the corner `before`. */
static void look_at(ears *e, uint32_t i, uint32_t before)
{
    take_out(e->kinds, i);
    take_out(e->watch, i);
    e->taken -= e->state[i] == TAKEN;
    bool convex = he_planar_loop_turns_left(e->f, e->loop.prev[i], i, e->loop.next[i]);
    if (convex && he_corner_tree_has(&e->tree, i)) {
        leave_tree(e, i);
    }
    e->state[i] = convex ? CANDIDATE : FLAT;
    insert_after(e->kinds, convex ? before : e->kinds.prev[list_of(e, FLAT)], i);
}

/* Returns true if the steps allowed for cutting ears are used up. Steps of searches for edges do
 * not count, so that the flag HE_AVOID_EDGES does not change which ears are found. */
static bool is_exhausted(const ears *e)
{
    return e->work->steps - e->work->searched >= e->most;
}

static bool is_ear(ears *e, uint32_t i)
{
    uint32_t a = e->loop.prev[i], c = e->loop.next[i];
    e->work->steps++;
    uint32_t in_the_way = HE_NONE;
    if (!is_exhausted(e)) {
        in_the_way = he_corner_tree_find(&e->tree, a, i, c, &e->work->steps);
    }
    if (in_the_way != HE_NONE) {
        take_out(e->kinds, i);
        insert_after(e->kinds, e->kinds.prev[list_of(e, PIERCED)], i);
        insert_after(e->watch, e->f->n + in_the_way, i);
        e->state[i] = PIERCED;
        return false;
    }
    if (is_taken(e, a, c)) {
        take_out(e->kinds, i);
        e->state[i] = TAKEN;
        e->taken++;
        return false;
    }
    return true;
}

/* Finds an ear. Returns HE_NONE if the loop has no ear, or if all its ears are in state TAKEN. */
static uint32_t find_ear(ears *e)
{
    uint32_t list = list_of(e, CANDIDATE), waiting = 2 * e->f->n, i;
    for (;;) {
        while (e->kinds.next[list] != list) {
            i = e->at == list ? e->kinds.next[list] : e->at;
            e->at = e->kinds.next[i];
            if (is_ear(e, i)) {
                return i;
            }
        }
        if (e->watch.next[waiting] == waiting) {
            return HE_NONE;
        }
        while ((i = e->watch.next[waiting]) != waiting) {
            take_out(e->watch, i);
            take_out(e->kinds, i);
            insert_after(e->kinds, e->kinds.prev[list], i);
            e->state[i] = CANDIDATE;
        }
        e->at = list;
    }
}

/* Returns a corner that can be cut off although it is no ear, if possible one that turns left;
 * HE_NONE if every corner has a diagonal that is an edge and must be avoided. A corner with such a
 * diagonal leaves its list, so that it is not tested again before one of its neighbours is
 * cut off. */
static uint32_t find_corner(ears *e)
{
    for (state s = PIERCED; s <= FLAT; s++) {
        uint32_t list = list_of(e, s), i;
        while ((i = e->kinds.next[list]) != list) {
            e->work->steps++;
            if (!is_taken(e, e->loop.prev[i], e->loop.next[i])) {
                return i;
            }
            take_out(e->kinds, i);
        }
    }
    return HE_NONE;
}

static void write_triangle(ears *e, uint32_t i, uint32_t *corners)
{
    uint32_t *triangle = corners + 3 * (size_t)(e->f->n - e->left);
    triangle[0] = e->loop.prev[i];
    triangle[1] = i;
    triangle[2] = e->loop.next[i];
}

static void cut_off(ears *e, uint32_t i, uint32_t *corners)
{
    uint32_t a = e->loop.prev[i], c = e->loop.next[i];
    write_triangle(e, i, corners);
    take_out(e->loop, i);
    take_out(e->watch, i);
    if (he_corner_tree_has(&e->tree, i)) {
        leave_tree(e, i);
    }
    if (e->state[i] != CANDIDATE) {
        take_out(e->kinds, i);
        insert_after(e->kinds, list_of(e, CANDIDATE), i);
    }
    e->left--;
    /* The corners a and c are the neighbours of the corner i that was cut off. If they turn left,
     * they take the place of corner i in the list of candidates. */
    look_at(e, c, i);
    take_out(e->kinds, a);
    look_at(e, a, e->kinds.prev[i]);
    e->at = e->kinds.next[e->state[c] == CANDIDATE ? c : i];
    take_out(e->kinds, i);
    e->last = e->loop.next[c];
}

static he_status cut_all(ears *e, bool any_corner, he_triangulation *plan, bool *stuck,
                         he_error *err)
{
    while (e->left > 3) {
        he_status status = he_triangulation_step(e->m, e->work, err);
        if (status != HE_OK) {
            return status;
        }
        uint32_t i = find_ear(e);
        bool found = i != HE_NONE && !is_exhausted(e);
        if (!found && e->taken == 0 && !any_corner) {
            *stuck = true;
            return HE_OK;
        }
        if (i == HE_NONE && e->taken == 0) {
            i = find_corner(e);
        }
        if (i == HE_NONE) {
            return he_diagonals_refuse(e->m, e->f, err);
        }
        plan->degenerate |= !found;
        cut_off(e, i, plan->corners);
    }
    plan->degenerate |=
        !he_planar_loop_turns_left(e->f, e->loop.prev[e->last], e->last, e->loop.next[e->last]);
    write_triangle(e, e->last, plan->corners);
    return HE_OK;
}

static void lay_out(ears *e, uint32_t *block)
{
    uint32_t n = e->f->n;
    e->loop = (ring){block, block + n};
    e->kinds = (ring){block + 2 * (size_t)n, block + 3 * (size_t)n + 3};
    e->watch = (ring){block + 4 * (size_t)n + 6, block + 6 * (size_t)n + 7};
    e->state = (uint8_t *)(block + 8 * (size_t)n + 8);
    for (uint32_t i = 0; i < n; i++) {
        e->loop.next[i] = i + 1 == n ? 0 : i + 1;
        e->loop.prev[i] = i == 0 ? n - 1 : i - 1;
    }
    for (uint32_t i = n; i < n + 3; i++) {
        isolate(e->kinds, i);
    }
    for (uint32_t i = 0; i < 2 * n + 1; i++) {
        isolate(e->watch, i);
    }
}

/* Puts every corner into the list of its state, and the corners that do not turn left also into the
 * tree. `room` is scratch space for n corners; the caller passes the array of the result, which is
 * not filled yet. */
static he_status sort_corners(ears *e, uint32_t *room, he_error *err)
{
    uint32_t n = e->f->n, flat = 0;
    for (uint32_t i = 0; i < n; i++) {
        bool convex = he_planar_loop_turns_left(e->f, e->loop.prev[i], i, e->loop.next[i]);
        e->state[i] = convex ? CANDIDATE : FLAT;
        insert_after(e->kinds, e->kinds.prev[list_of(e, e->state[i])], i);
        if (!convex) {
            room[flat++] = i;
        }
    }
    e->at = list_of(e, CANDIDATE);
    return he_corner_tree_make(&e->tree, e->f, room, flat, err);
}

/* Returns how many steps he_ears_cut may take for a loop of n corners: HE_EAR_STEPS * n * log2(n),
 * which is enough for ordinary polygons of any size. */
static uint64_t most_steps(uint32_t n)
{
    uint64_t steps = 0;
    for (uint32_t rest = n; rest > 0; rest /= 2) {
        steps += HE_EAR_STEPS;
    }
    return steps * n;
}

he_status he_ears_cut(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                      he_triangulation *plan, bool *stuck, he_error *err)
{
    uint32_t n = plan->flat.n;
    ears e = {.m = m,
              .f = &plan->flat,
              .avoid = (flags & HE_AVOID_EDGES) != 0,
              .left = n,
              .most = work->steps - work->searched + most_steps(n),
              .work = work};
    uint32_t *block = he_mem_array(NULL, (size_t)n + 1, 8 * sizeof *block + sizeof *e.state);
    if (block == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop of %u corners", n);
    }
    plan->degenerate = false;
    *stuck = false;
    lay_out(&e, block);
    he_status status = sort_corners(&e, plan->corners, err);
    if (status == HE_OK) {
        status = cut_all(&e, (flags & HE_ANY_CORNER) != 0, plan, stuck, err);
    }
    he_corner_tree_clear(&e.tree);
    he_mem_free(block);
    return status;
}
