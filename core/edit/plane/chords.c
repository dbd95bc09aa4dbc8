#include "edit/plane/chords.h"

#include "geometry/vec3.h"

#include <assert.h>

/* A corner that a face has in the cutting plane. */
typedef struct he_line_crossing {
    double along; /* the corner's position along the line in which the face meets the plane */
    uint32_t at;  /* the corner's index in the loop of the face */
} he_line_crossing;

/* Bits that say on which sides of the plane a part of a face has corners. The bits times BESIDE say
 * on which sides the part must have corners, because a neighbouring part is on the opposite
 * side. */
enum { ABOVE = 1, BELOW = 2, BOTH = 3, BESIDE = 4 };

static int side_at(const he_mesh *m, const he_sides *sides, const he_chords *c, uint32_t i)
{
    return he_side_of(sides, he_origin(m, (he_halfedge){c->corner.ids[i]}));
}

/* --- sorting the corners in the plane along the line --- */

static bool comes_before(const he_line_crossing *a, const he_line_crossing *b)
{
    return a->along < b->along || (a->along <= b->along && a->at < b->at);
}

static void sift(he_line_crossing *heap, size_t count, size_t i)
{
    he_line_crossing moved = heap[i];
    for (size_t child = 2 * i + 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && comes_before(&heap[child], &heap[child + 1])) {
            child++;
        }
        if (!comes_before(&moved, &heap[child])) {
            break;
        }
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = moved;
}

/* Sorts corners by their position along the line. Heapsort (J. W. J. Williams, 1964) needs no extra
 * memory and is fast whatever the order of the input. */
static void sort(he_line_crossing *line, size_t count)
{
    for (size_t i = count / 2; i-- > 0;) {
        sift(line, count, i);
    }
    for (size_t left = count; left-- > 1;) {
        he_line_crossing last = line[left];
        line[left] = line[0];
        line[0] = last;
        sift(line, left, 0);
    }
}

static he_vec3 place(const he_mesh *m, const he_sides *sides, const he_chords *c, uint32_t i)
{
    he_vertex v = he_origin(m, (he_halfedge){c->corner.ids[i]});
    return he_vec3_scale(he_position(m, v), sides->scale);
}

/* Sorts the corners of a face that lie in the plane by their position along an axis, which points
 * from the first of them to the one farthest from it. If the corners lie on a line, this is their
 * order along the line. */
static void order_along_line(const he_mesh *m, const he_sides *sides, he_chords *c, size_t count)
{
    he_vec3 first = place(m, sides, c, c->line[0].at), axis = {0, 0, 0};
    double furthest = 0;
    for (size_t i = 1; i < count; i++) {
        he_vec3 way = he_vec3_sub(place(m, sides, c, c->line[i].at), first);
        double distance = he_vec3_dot(way, way);
        if (distance > furthest) {
            furthest = distance;
            axis = way;
        }
    }
    for (size_t i = 0; i < count; i++) {
        he_vec3 way = he_vec3_sub(place(m, sides, c, c->line[i].at), first);
        c->line[i].along = he_vec3_dot(axis, way);
    }
    sort(c->line, count);
}

/* --- choosing chords --- */

static void forget_partners(he_chords *c)
{
    for (size_t i = 0; i < 2 * (size_t)c->n; i++) {
        c->partners.ids[i] = HE_NONE;
    }
}

/* Records a chord between corners a and b, which become partners. A corner has at most two
 * partners: its neighbours on the line. */
static void join(he_chords *c, uint32_t a, uint32_t b)
{
    c->partners.ids[2 * (size_t)a + (c->partners.ids[2 * (size_t)a] != HE_NONE)] = b;
    c->partners.ids[2 * (size_t)b + (c->partners.ids[2 * (size_t)b] != HE_NONE)] = a;
}

static void join_along_line(const he_mesh *m, const he_sides *sides, he_chords *c, size_t count)
{
    bool above = false, below = false;
    forget_partners(c);
    for (size_t i = 0; i < count; i++) {
        uint32_t at = c->line[i].at;
        if (above && below) {
            join(c, c->line[i - 1].at, at);
        }
        int before = side_at(m, sides, c, at == 0 ? c->n - 1 : at - 1);
        int after = side_at(m, sides, c, at + 1 == c->n ? 0 : at + 1);
        above ^= (before > 0) ^ (after > 0);
        below ^= (before < 0) ^ (after < 0);
    }
}

/* Plans chords for a face in which the chords along the line fail (see chords.h). Let S be the side
 * of the plane on which the first corner outside the plane lies. Each chord planned here cuts off a
 * sequence of successive corners that lie on the side opposite to S. */
static void join_around_runs(const he_mesh *m, const he_sides *sides, he_chords *c)
{
    uint32_t first = 0, in_plane = HE_NONE, start = HE_NONE, end = HE_NONE;
    forget_partners(c);
    while (side_at(m, sides, c, first) == 0) {
        first++;
    }
    int kept = side_at(m, sides, c, first);
    bool inside = false;
    for (uint32_t k = 1; k <= c->n; k++) {
        uint32_t i = (first + k) % c->n;
        int side = side_at(m, sides, c, i);
        if (side == 0) {
            in_plane = i;
            end = end == HE_NONE ? i : end;
        } else if (side != kept) {
            start = inside ? start : in_plane;
            end = HE_NONE;
            inside = true;
        } else if (inside) {
            join(c, start, end);
            inside = false;
        }
    }
}

/* --- checking that chords nest like brackets --- */

/* The list `open` begins with one number: the side bits (see above) of the part of the face outside
 * all chords. Then come CHORD numbers for each chord that has begun but not ended: the indices of
 * its two corners, and the side bits of the part of the face inside the chord. */
enum { CHORD = 3 };

static bool is_one_sided(uint32_t part)
{
    uint32_t has = part % BESIDE, must = part / BESIDE;
    return (has == ABOVE || has == BELOW) && (has | must) != BOTH;
}

/* Ends the chords that end at corner i, from the innermost outwards. Returns false if the part of
 * the face inside one of them is not on the side of the plane on which it must be. */
static bool close_at(he_chords *c, uint32_t i)
{
    he_ids *open = &c->open;
    while (open->count > 1 && open->ids[open->count - 2] == i) {
        uint32_t inside = open->ids[open->count - 1];
        c->pairs.ids[c->pairs.count++] = open->ids[open->count - CHORD];
        c->pairs.ids[c->pairs.count++] = i;
        if (!is_one_sided(inside)) {
            return false;
        }
        open->count -= CHORD;
        open->ids[open->count - 1] |= (inside % BESIDE ^ BOTH) * BESIDE;
    }
    return true;
}

/* Begins the chord from corner i to corner `end`. Returns false if the chord joins neighbouring
 * corners or crosses a chord that has begun but not ended. */
static bool open_at(he_chords *c, uint32_t i, uint32_t end)
{
    he_ids *open = &c->open;
    bool crosses = open->count > 1 && open->ids[open->count - 2] < end;
    if (crosses || end == i + 1 || (i == 0 && end + 1 == c->n)) {
        return false;
    }
    open->ids[open->count++] = i;
    open->ids[open->count++] = end;
    open->ids[open->count++] = 0;
    return true;
}

/* Lists the chords in the order in which they end. Returns false if the chords break one of the
 * rules that the head of chords.h states. */
static bool list_pairs(const he_mesh *m, const he_sides *sides, he_chords *c)
{
    c->pairs.count = 0;
    c->open.count = 1;
    c->open.ids[0] = 0;
    for (uint32_t i = 0; i < c->n; i++) {
        if (!close_at(c, i)) {
            return false;
        }
        uint32_t a = c->partners.ids[2 * (size_t)i], b = c->partners.ids[2 * (size_t)i + 1];
        uint32_t ends[2] = {a, b};
        if (a == HE_NONE || (b != HE_NONE && a < b)) {
            ends[0] = b;
            ends[1] = a;
        }
        for (unsigned k = 0; k < 2; k++) {
            if (ends[k] != HE_NONE && ends[k] > i && !open_at(c, i, ends[k])) {
                return false;
            }
        }
        int side = side_at(m, sides, c, i);
        c->open.ids[c->open.count - 1] |= side > 0 ? ABOVE : side < 0 ? BELOW : 0u;
    }
    return c->open.count == 1 && is_one_sided(c->open.ids[0]);
}

/* --- the plan of a face's chords --- */

static bool has_both_sides(const he_mesh *m, he_face f, const he_sides *sides, uint32_t *corners)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    bool above = false, below = false;
    *corners = 0;
    do {
        int side = he_side_of(sides, he_origin(m, h));
        above |= side > 0;
        below |= side < 0;
        ++*corners;
        h = he_next(m, h);
    } while (h.i != first.i);
    return above && below;
}

static he_status make_room(he_chords *c, uint32_t n, he_error *err)
{
    c->corner.count = c->partners.count = c->pairs.count = c->open.count = 0;
    he_status status = he_ids_reserve(&c->corner, n, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&c->partners, 2 * (size_t)n, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&c->pairs, 2 * (size_t)n, err);
    }
    if (status == HE_OK) {
        status = he_ids_reserve(&c->open, 1 + CHORD * (size_t)n, err);
    }
    if (status == HE_OK && c->line_capacity < n) {
        size_t capacity = he_mem_grown(c->line_capacity, n);
        he_line_crossing *line = he_mem_array(c->line, capacity, sizeof *line);
        if (line == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to cut a face of %u corners", n);
        }
        c->line = line;
        c->line_capacity = capacity;
    }
    return status;
}

he_status he_chords_plan(const he_mesh *m, he_face f, const he_sides *sides, he_chords *chords,
                         he_error *err)
{
    he_chords *c = chords;
    uint32_t corners = 0;
    c->pairs.count = 0;
    if (!has_both_sides(m, f, sides, &corners)) {
        return HE_OK;
    }
    he_status status = make_room(c, corners, err);
    if (status != HE_OK) {
        return status;
    }
    size_t count = 0;
    he_halfedge h = he_face_halfedge(m, f);
    c->n = corners;
    for (uint32_t i = 0; i < corners; i++) {
        h = he_next(m, h);
        c->corner.ids[i] = h.i;
        if (he_side_of(sides, he_origin(m, h)) == 0) {
            c->line[count++] = (he_line_crossing){0, i};
        }
    }
    order_along_line(m, sides, c, count);
    join_along_line(m, sides, c, count);
    if (!list_pairs(m, sides, c)) {
        join_around_runs(m, sides, c);
        bool holds = list_pairs(m, sides, c);
        assert(holds);
        (void)holds;
    }
    return HE_OK;
}

void he_chords_clear(he_chords *chords)
{
    he_ids_clear(&chords->corner);
    he_ids_clear(&chords->pairs);
    he_ids_clear(&chords->partners);
    he_ids_clear(&chords->open);
    he_mem_free(chords->line);
    *chords = (he_chords){.n = 0};
}
