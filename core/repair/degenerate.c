/* degenerate.c - the repair drop_degenerate: removes from each face that repeats a vertex the parts
 * without area, or drops the face if no other part is left.
 *
 *     1 2 3 3  ->  1 2 3            a vertex twice in a row
 *     1 2 3 4 3  ->  1 2 3          a spike: from 3 to 4 and straight back
 *
 *     3-----------2    A keyhole such as 0 1 2 3 0 4 7 6 5 4 runs around its outer rim, along an
 *     | 7-----6   |    edge to the rim of a hole, around the hole, and back along that edge. Such a
 *     | |     |   |    loop, which visits a vertex twice, is cut into triangles; for this, each
 *     | 4-----5   |    corner gets a vertex of its own. A triangle with two copies of one vertex
 *     |/          |    has no area and is left out, so that its neighbours meet.
 *     0-----------1
 *
 * A loop such as 0 1 2 0 3 4, whose parts touch in a vertex, becomes separate faces if its parts
 * have one orientation. Otherwise a part is a hole in another part, and the whole loop is cut into
 * triangles.
 *
 * A loop that runs along an edge twice in one direction, for example because it goes around twice,
 * bounds no area and is dropped. A loop is also dropped if its triangles run along an edge twice in
 * one direction. */
#include "build/soup_check.h"
#include "geometry/triangulation.h"
#include "geometry/vec3.h"
#include "repair/mend.h"

#include <stdlib.h>
#include <string.h>

/* Data of the repair: the degenerate faces in their order, and the loops (parts of these faces)
 * that are kept. */
typedef struct mending {
    const he_mend *m;
    uint64_t *bad;   /* one bit for each face: set if the face is degenerate */
    uint32_t *stamp; /* a mark for each vertex, used by he_soup_find_repeat */
    he_ids loops;    /* the corners of all kept loops: their numbers in the soup, loop after loop */
    he_ids ends;     /* index in `loops` at which each loop ends */
    /* The number of the face in `flat` that is cut into triangles in place of each loop; HE_NONE if
     * the loop stays one face. */
    he_ids cut;
    /* for each degenerate face, the number of loops of all degenerate faces up to it */
    he_ids done;
    he_ids stack;    /* corners of the loop that is being divided */
    uint32_t *place; /* index in `stack` of the last corner at each vertex */
    /* The loops that are cut into triangles, as faces of which each corner has a vertex of its
     * own. */
    he_soup flat;
    he_mesh *mesh;  /* mesh made from `flat` */
    he_ids list;    /* the vertices of the loop, or of its triangles, that run_twice tests */
    uint64_t *runs; /* the edges of `list`, each as a pair of vertices, sorted */
    size_t run_capacity;

    he_soup made; /* the faces after the repair */
    he_ids face_from, corner_from;
    he_triangulation_work work;
} mending;

static uint32_t vertex(const mending *g, size_t i)
{
    return g->m->soup->corners[g->loops.ids[i]];
}

/* Shortens the last loop of `loops`, whose first corner is at index `from`, at its end: removes
 * corners that repeat the vertex before them, and spikes, which run along an edge and straight
 * back. */
static void shorten_end(mending *g, size_t from)
{
    he_ids *loops = &g->loops;
    for (;;) {
        size_t n = loops->count - from, last = loops->count - 1;
        if (n >= 2 && vertex(g, last) == vertex(g, last - 1)) {
            loops->count--;
        } else if (n >= 3 && vertex(g, last) == vertex(g, last - 2)) {
            loops->count -= 2;
        } else {
            return;
        }
    }
}

/* Shortens the last loop of `loops`, whose first corner is at index `from`, where its end meets its
 * beginning: removes repeated vertices and spikes (edges that run back on each other) there.
 * Returns the index of the first corner that is left. */
static size_t shorten_both(mending *g, size_t from)
{
    he_ids *loops = &g->loops;
    for (;;) {
        size_t n = loops->count - from, last = loops->count - 1;
        if (n >= 2 && vertex(g, last) == vertex(g, from)) {
            loops->count--;
        } else if (n >= 3 && vertex(g, last - 1) == vertex(g, from)) {
            loops->count -= 2;
        } else if (n >= 3 && vertex(g, last) == vertex(g, from + 1)) {
            loops->count--;
            from++;
        } else {
            return from;
        }
    }
}

/* Adds the corners of face f to `loops`, except corners that repeat the vertex of the corner before
 * and spikes, which run along an edge and straight back. */
static he_status add_loop(mending *g, uint32_t f, he_error *err)
{
    const he_soup *soup = g->m->soup;
    he_ids *loops = &g->loops;
    size_t from = loops->count, kept = from;
    uint32_t begin = soup->starts[f], end = he_soup_end(soup, f);
    he_status status = he_ids_reserve(loops, end - begin, err);
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t c = begin; c < end; c++) {
        loops->ids[loops->count++] = c;
        shorten_end(g, from);
    }
    size_t first = shorten_both(g, from);
    for (size_t i = first; loops->count - first >= 3 && i < loops->count; i++) {
        loops->ids[kept++] = loops->ids[i];
    }
    loops->count = kept;
    return HE_OK;
}

/* Ends a loop, which consists of all corners that were added to `loops` since the previous loop
 * ended. */
static he_status end_loop(mending *g, uint32_t cut, he_error *err)
{
    he_status status = he_ids_add(&g->ends, (uint32_t)g->loops.count, err);
    return status == HE_OK ? he_ids_add(&g->cut, cut, err) : status;
}

static int compare(const void *a, const void *b)
{
    uint64_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Decides whether loops run along an edge twice in one direction. The array `list` has the vertices
 * of these loops, one loop after another, each of `degree` vertices. */
static he_status run_twice(mending *g, size_t degree, bool *out, he_error *err)
{
    const uint32_t *list = g->list.ids;
    size_t count = g->list.count;
    if (count > g->run_capacity) {
        size_t capacity = he_mem_grown(g->run_capacity, count);
        uint64_t *runs = he_mem_array(g->runs, capacity, sizeof *runs);
        if (runs == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for a face of %zu corners", count);
        }
        g->runs = runs;
        g->run_capacity = capacity;
    }
    for (size_t i = 0; i < count; i++) {
        size_t next = (i + 1) % degree == 0 ? i + 1 - degree : i + 1;
        g->runs[i] = (uint64_t)list[i] << 32 | list[next];
    }
    *out = false;
    /* `runs` may be NULL if `count` is 0, and qsort must not be called with NULL */
    if (count > 0) {
        qsort(g->runs, count, sizeof *g->runs, compare);
    }
    for (size_t i = 1; i < count; i++) {
        *out = *out || g->runs[i] == g->runs[i - 1];
    }
    return HE_OK;
}

/* Returns twice the vector area of the loop whose corners are the entries `from` to `end` - 1 of
 * `loops`. */
static he_vec3 area_of(const mending *g, size_t from, size_t end)
{
    const he_vec3 *p = g->m->soup->positions;
    he_vec3 sum = {0, 0, 0}, a = {0, 0, 0};
    for (size_t i = from + 1; i < end; i++) {
        he_vec3 b = he_vec3_sub(p[vertex(g, i)], p[vertex(g, from)]);
        sum = he_vec3_add(sum, he_vec3_cross(a, b));
        a = b;
    }
    return sum;
}

/* Returns true if the loops from number `first` on, into which one loop was divided, all have the
 * orientation of the undivided loop. */
static bool agree(const mending *g, size_t from, size_t first)
{
    he_vec3 sum = {0, 0, 0};
    bool good = true;
    for (size_t i = first, begin = from; i < g->ends.count; begin = g->ends.ids[i++]) {
        sum = he_vec3_add(sum, area_of(g, begin, g->ends.ids[i]));
    }
    for (size_t i = first, begin = from; i < g->ends.count && good; begin = g->ends.ids[i++]) {
        good =
            g->ends.ids[i] - begin >= 3 && he_vec3_dot(area_of(g, begin, g->ends.ids[i]), sum) > 0;
    }
    return good;
}

/* Ends a loop, which consists of the corners on the stack from index `at` on, and takes these
 * corners off the stack. */
static he_status pop_loop(mending *g, size_t at, he_error *err)
{
    for (size_t i = at; i < g->stack.count; i++) {
        g->loops.ids[g->loops.count++] = g->stack.ids[i];
    }
    g->stack.count = at;
    return end_loop(g, HE_NONE, err);
}

/* Divides the last loop of `loops`, whose first corner is at index `from`, at the vertices that it
 * visits more than once. If the parts cannot be separate faces, because their orientations differ,
 * the loop stays whole and *apart becomes false. */
static he_status take_apart(mending *g, size_t from, bool *apart, he_error *err)
{
    const uint32_t *corners = g->m->soup->corners;
    size_t first = g->ends.count, end = g->loops.count, count = end - from;
    he_status status = he_ids_reserve(&g->stack, count, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&g->loops, count, err);
    }
    if (status == HE_OK && g->place == NULL) {
        g->place = he_mem_zero(g->m->soup->vertex_count, sizeof *g->place);
        status = g->place != NULL ? HE_OK
                                  : he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu vertices",
                                                  g->m->soup->vertex_count);
    }
    g->stack.count = 0;
    for (size_t i = from; i < end && status == HE_OK; i++) {
        uint32_t c = g->loops.ids[i], at = g->place[corners[c]];
        /* place[v] may be an index that was stored for another loop or for corners that have left
         * the stack, so the entry of the stack is checked. */
        if (at < g->stack.count && corners[g->stack.ids[at]] == corners[c]) {
            status = pop_loop(g, at, err);
        }
        g->place[corners[c]] = (uint32_t)g->stack.count;
        g->stack.ids[g->stack.count++] = c;
    }
    if (status == HE_OK) {
        status = pop_loop(g, 0, err);
    }
    if (status != HE_OK) {
        return status;
    }
    *apart = agree(g, end, first);
    if (*apart) { /* moves the parts, which were added behind the whole loop, over the whole loop */
        memmove(g->loops.ids + from, g->loops.ids + end, count * sizeof *g->loops.ids);
        for (size_t i = first; i < g->ends.count; i++) {
            g->ends.ids[i] -= (uint32_t)count;
        }
    } else {
        g->ends.count = g->cut.count = first;
    }
    g->loops.count = end;
    return HE_OK;
}

/* Ends the last loop of `loops`, whose first corner is at index `from`. If the loop visits a vertex
 * twice, it is divided into separate faces, or else cut into triangles. It is dropped if it runs
 * along an edge twice in one direction. */
static he_status add_cut(mending *g, size_t from, uint32_t mark, he_error *err)
{
    const he_soup *soup = g->m->soup;
    size_t count = g->loops.count - from;
    bool twice = false, apart = false;
    g->list.count = 0;
    he_status status = he_ids_reserve(&g->list, count, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        g->list.ids[g->list.count++] = vertex(g, from + i);
    }
    if (status != HE_OK || count == 0) {
        return status;
    }
    if (he_soup_find_repeat(g->list.ids, (uint32_t)count, g->stamp, mark) == count) {
        return end_loop(g, HE_NONE, err);
    }
    status = run_twice(g, count, &twice, err);
    if (status == HE_OK && twice) {
        g->loops.count = from;
        return HE_OK;
    }
    if (status == HE_OK) {
        status = take_apart(g, from, &apart, err);
    }
    if (status != HE_OK || apart) {
        return status;
    }
    status = he_soup_begin_face(&g->flat, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        status = he_soup_add_corner(&g->flat, (uint32_t)g->flat.vertex_count, err);
        if (status == HE_OK) {
            status = he_soup_add_vertex(&g->flat, soup->positions[g->list.ids[i]], err);
        }
    }
    return status == HE_OK ? end_loop(g, (uint32_t)g->flat.face_count - 1, err) : status;
}

/* Finds the degenerate faces, which repeat a vertex or have fewer than three vertices, and the
 * loops of them that are kept. */
static he_status find(mending *g, he_error *err)
{
    const he_soup *soup = g->m->soup;
    uint32_t faces = (uint32_t)soup->face_count;
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        uint32_t begin = soup->starts[f], count = he_soup_end(soup, f) - begin;
        status = he_progress_at(soup->limits.progress, f, 2 * (size_t)faces, err);
        if (status != HE_OK || (count >= 3 && he_soup_find_repeat(soup->corners + begin, count,
                                                                  g->stamp, f + 1) == count)) {
            continue;
        }
        size_t from = g->loops.count;
        he_bits_set(g->bad, f);
        status = add_loop(g, f, err);
        if (status == HE_OK) {
            status = add_cut(g, from, faces + 1 + f, err);
        }
        if (status == HE_OK) {
            status = he_ids_add(&g->done, (uint32_t)g->ends.count, err);
        }
    }
    if (status == HE_OK && g->flat.face_count > 0) {
        status = he_build(&g->flat, HE_BUILD_TAKE, &g->mesh, NULL, err);
    }
    return status;
}

/* --- the faces after the repair --- */

static he_status add_face(mending *g, const uint32_t *corners, size_t count, uint32_t from,
                          he_error *err)
{
    const he_mend *m = g->m;
    he_status status = he_soup_begin_face(&g->made, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        status = he_soup_add_corner(&g->made, m->soup->corners[corners[i]], err);
        if (status == HE_OK && m->has_corner_values) {
            status = he_ids_add(&g->corner_from, he_mend_input(m->corner_from, corners[i]), err);
        }
    }
    return status == HE_OK ? he_ids_add(&g->face_from, he_mend_input(m->out->face_from, from), err)
                           : status;
}

/* Adds the triangles of the loop whose first corner is at index `from` of `loops`. */
static he_status add_triangles(mending *g, uint32_t face, uint32_t cut, size_t from, he_error *err)
{
    he_triangulation triangles;
    he_halfedge first = he_face_halfedge(g->mesh, (he_face){cut});
    uint32_t base = he_origin(g->mesh, first).i;
    he_status status =
        he_triangulation_make(g->mesh, first, HE_ANY_DIAGONALS, &g->work, &triangles, err);
    if (status != HE_OK) {
        return status;
    }
    size_t count = 3 * ((size_t)triangles.flat.n - 2), kept = 0;
    /* The entries are corners of the triangulation at first; the loop below overwrites them with
     * corners of the soup. */
    uint32_t *corners = triangles.corners;
    bool twice = true;
    g->list.count = 0;
    status = he_ids_reserve(&g->list, count, err);
    for (size_t t = 0; t < count && status == HE_OK; t += 3) {
        uint32_t vertices[3];
        for (size_t i = 0; i < 3; i++) {
            he_halfedge h = {triangles.flat.halfedge[corners[t + i]]};
            corners[kept + i] = g->loops.ids[from + (he_origin(g->mesh, h).i - base)];
            vertices[i] = g->m->soup->corners[corners[kept + i]];
        }
        if (he_soup_find_repeat(vertices, 3, NULL, 0) == 3) {
            memcpy(g->list.ids + kept, vertices, sizeof vertices);
            g->list.count = kept += 3;
        }
    }
    if (status == HE_OK) {
        status = run_twice(g, 3, &twice, err);
    }
    for (size_t t = 0; t < kept && status == HE_OK && !twice; t += 3) {
        status = add_face(g, corners + t, 3, face, err);
    }
    he_triangulation_clear(&triangles);
    return status;
}

static he_status add_mended(mending *g, uint32_t face, size_t k, he_error *err)
{
    he_repair_account *account = &g->m->out->accounts[HE_REPAIR_DROP_DEGENERATE];
    size_t before = g->made.face_count;
    he_status status = HE_OK;
    for (size_t i = k == 0 ? 0 : g->done.ids[k - 1]; i < g->done.ids[k] && status == HE_OK; i++) {
        size_t from = i == 0 ? 0 : g->ends.ids[i - 1];
        status = g->cut.ids[i] != HE_NONE
                     ? add_triangles(g, face, g->cut.ids[i], from, err)
                     : add_face(g, g->loops.ids + from, g->ends.ids[i] - from, face, err);
    }
    size_t made = g->made.face_count - before;
    if (status == HE_OK) {
        account->count += made == 0;
        account->parts += made > 0;
        he_mend_name(account, he_mend_input(g->m->out->face_from, face), (uint32_t)made);
    }
    return status;
}

static he_status add_all(mending *g, he_error *err)
{
    const he_soup *soup = g->m->soup;
    he_status status = HE_OK;
    size_t k = 0;
    size_t faces = soup->face_count;
    for (uint32_t f = 0; f < faces && status == HE_OK; f++) {
        g->work.done = f;
        status = he_progress_at(soup->limits.progress, f + faces, 2 * faces, err);
        if (status == HE_OK && he_bits_get(g->bad, f)) {
            status = add_mended(g, f, k++, err);
            continue;
        }
        if (status != HE_OK) {
            break;
        }
        uint32_t begin = soup->starts[f], count = he_soup_end(soup, f) - begin;
        g->list.count = 0;
        status = he_ids_reserve(&g->list, count, err);
        for (uint32_t i = 0; i < count && status == HE_OK; i++) {
            g->list.ids[g->list.count++] = begin + i;
        }
        if (status == HE_OK) {
            status = add_face(g, g->list.ids, count, f, err);
        }
    }
    return status;
}

/* Puts the new faces into the soup. Cannot fail. */
static void put_in_place(he_mend *m, mending *g)
{
    he_soup *soup = m->soup;
    he_repaired *out = m->out;
    he_mem_free(soup->corners);
    he_mem_free(soup->starts);
    soup->corners = g->made.corners;
    soup->corner_count = g->made.corner_count;
    soup->corner_capacity = g->made.corner_capacity;
    soup->starts = g->made.starts;
    soup->face_count = out->faces = g->made.face_count;
    soup->face_capacity = g->made.face_capacity;
    he_mem_free(out->face_from);
    out->face_from = g->face_from.ids;
    if (m->has_corner_values) {
        he_mem_free(m->corner_from);
        m->corner_from = g->corner_from.ids;
        g->corner_from = (he_ids){0};
    }
    g->made.corners = g->made.starts = NULL;
    g->face_from = (he_ids){0};
}

he_status he_mend_drop_degenerate(he_mend *m, he_error *err)
{
    he_soup *soup = m->soup;
    mending g = {.m = m,
                 .bad = he_bits_new(soup->face_count),
                 .stamp = he_mem_zero(soup->vertex_count + 1, sizeof *g.stamp)};
    he_status status = HE_OK;
    he_soup_init(&g.made, &soup->limits);
    he_soup_init(&g.flat, NULL);
    g.flat.limits.bytes = soup->limits.bytes;
    g.work.progress = soup->limits.progress;
    g.work.of = soup->face_count;
    if (g.bad == NULL || g.stamp == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory to examine %zu faces", soup->face_count);
    }
    if (status == HE_OK) {
        status = find(&g, err);
    }
    if (status == HE_OK && g.done.count > 0) {
        /* An array face_from that is not NULL says that the repair changed the soup, so it is
         * allocated even if no face is left. */
        status = he_ids_reserve(&g.face_from, 1, err);
        if (status == HE_OK && m->has_corner_values) {
            status = he_ids_reserve(&g.corner_from, 1, err);
        }
        if (status == HE_OK) {
            status = add_all(&g, err);
        }
        if (status == HE_OK) {
            put_in_place(m, &g);
        }
    }
    he_soup_clear(&g.made);
    he_soup_clear(&g.flat);
    he_mesh_free(g.mesh);
    he_triangulation_work_clear(&g.work);
    he_ids_clear(&g.loops);
    he_ids_clear(&g.ends);
    he_ids_clear(&g.cut);
    he_ids_clear(&g.done);
    he_ids_clear(&g.stack);
    he_mem_free(g.place);
    he_ids_clear(&g.list);
    he_ids_clear(&g.face_from);
    he_ids_clear(&g.corner_from);
    he_mem_free(g.runs);
    he_mem_free(g.bad);
    he_mem_free(g.stamp);
    return status;
}
