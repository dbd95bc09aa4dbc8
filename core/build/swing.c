#include "build/swing.h"

#include "base/parallel.h"
#include "build/soup_check.h"

#include <assert.h>
#include <string.h>

/* Flags that say what was found in a range of faces or vertices. */
enum { LARGE_FACE = 1, BAD_FACE = 2, BAD_EDGE = 4, CLOSED_FAN = 8, LARGE_VERTEX = 16 };

enum { SMALL_VERTEX = 24 };

typedef struct swinging {
    const he_soup *soup;
    const he_corners *corners;
    uint32_t lanes;
    /* An entry for each pair of a lane and a vertex; a lane is a range of faces that one thread
     * handles (parallel.h). The entry is first the number of corners of the lane at the vertex,
     * later the index in `filed` at which the next of these corners is stored. */
    uint32_t *places;
    uint32_t *filed; /* the corners, sorted by vertex */
    uint32_t *swing, *first;
    unsigned char *found; /* the flags found in each range of the parallel loop */
    size_t *matched;      /* number of corners with a swing, for each range of the parallel loop */
    unsigned all;         /* the flags found in any range */
} swinging;

/* --- faces ------------------------------------------------------------------------------------ */

/* Checks a face with few corners. The function is inlined for triangles and quads, where `count` is
 * a constant. */
static inline unsigned check_small(const uint32_t *corners, uint32_t count, size_t vertices)
{
    unsigned bad = 0;
    for (uint32_t i = 0; i < count; i++) {
        bad |= corners[i] >= vertices;
        for (uint32_t k = 0; k < i; k++) {
            bad |= corners[i] == corners[k];
        }
    }
    return BAD_FACE * bad;
}

/* Checks a face. In a large face, repeated corners are not found; he_soup_check_faces finds them
 * later. */
static unsigned check_face(const uint32_t *corners, uint32_t count, size_t vertices)
{
    unsigned bad = 0;
    if (count <= HE_SMALL_FACE) {
        return check_small(corners, count, vertices);
    }
    for (uint32_t i = 0; i < count; i++) {
        bad |= corners[i] >= vertices;
    }
    return bad != 0 ? BAD_FACE : LARGE_FACE;
}

/* Checks the faces of a lane (range of faces), and counts the corners of the lane at each
 * vertex. */
static he_status count_corners(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    swinging *t = context;
    const he_soup *soup = t->soup;
    uint32_t *counts = t->places + lane * soup->vertex_count;
    unsigned found = 0;
    (void)err;
    for (size_t f = from; f < to; f++) {
        const uint32_t first = soup->starts[f], count = he_soup_end(soup, f) - first;
        /* tested first, because a soup without corners may have no array of corners */
        if (count < 3) {
            found |= BAD_FACE;
            break;
        }
        const uint32_t *corners = soup->corners + first;
        found |= count == 3   ? check_small(corners, 3, soup->vertex_count)
                 : count == 4 ? check_small(corners, 4, soup->vertex_count)
                              : check_face(corners, count, soup->vertex_count);
        if ((found & BAD_FACE) != 0) {
            break;
        }
        for (uint32_t i = 0; i < count; i++) {
            counts[corners[i]]++;
        }
    }
    t->found[lane] |= (unsigned char)found;
    return HE_OK;
}

/* Replaces the counts in `places` by indices of `filed`, so that corners will be sorted by vertex,
 * and at each vertex in the order of the soup. */
static void place_corners(swinging *t)
{
    const size_t vertices = t->soup->vertex_count;
    uint32_t at = 0;
    for (size_t v = 0; v < vertices; v++) {
        for (uint32_t lane = 0; lane < t->lanes; lane++) {
            uint32_t *place = &t->places[lane * vertices + v], count = *place;
            *place = at;
            at += count;
        }
    }
}

static he_status file_corners(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    swinging *t = context;
    const he_soup *soup = t->soup;
    uint32_t *place = t->places + lane * soup->vertex_count;
    (void)err;
    for (uint32_t c = soup->starts[from], end = he_soup_end(soup, to - 1); c < end; c++) {
        t->filed[place[soup->corners[c]]++] = c;
    }
    return HE_OK;
}

/* --- vertices --------------------------------------------------------------------------------- */

/* Returns the index in `filed` at which the corners of vertex v begin. It is the index at which the
 * corners of vertex v - 1 end, because sorting has advanced the entries of `places` to the ends. */
static uint32_t begin_of(const swinging *t, size_t v)
{
    return v == 0 ? 0 : t->places[(t->lanes - 1) * t->soup->vertex_count + v - 1];
}

static uint32_t end_of(const swinging *t, size_t v)
{
    return t->places[(t->lanes - 1) * t->soup->vertex_count + v];
}

/* Returns true if every corner of a vertex belongs to an open fan. follow[i] is the swing of corner
 * i (next corner counter-clockwise); it is `count` if corner i has no swing. */
static bool all_open(const uint32_t *follow, uint32_t count)
{
    /* `entered`: a bit for each corner, set if the corner is the swing of another corner; `met`:
     * number of corners that belong to open fans */
    uint32_t entered = 0, met = 0;
    for (uint32_t i = 0; i < count; i++) {
        entered |= follow[i] < count ? 1u << follow[i] : 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = i; (entered >> i & 1) == 0 && k < count && met <= count; k = follow[k]) {
            met++;
        }
    }
    return met == count;
}

static bool leads_twice(const uint32_t *to, uint32_t count)
{
    unsigned twice = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            twice |= to[i] == to[k];
        }
    }
    return twice != 0;
}

/* A vector of four words in one register: an extension of GCC and Clang that works on every
 * processor. */
typedef uint32_t four __attribute__((vector_size(16)));

/* Sets follow[i] to the last k for which to[k] equals from[i], or to `count` if there is no such k.
 * The three arrays have room for SMALL_VERTEX words. */
static void match(const uint32_t *from, const uint32_t *to, uint32_t count, uint32_t *follow)
{
    for (uint32_t begin = 0; begin < count; begin += 8) {
        four low, high, none = {count, count, count, count}, found[2] = {none, none};
        memcpy(&low, from + begin, sizeof low);
        memcpy(&high, from + begin + 4, sizeof high);
        for (uint32_t k = 0; k < count; k++) {
            four one = {to[k], to[k], to[k], to[k]}, to_k = {k, k, k, k};
            found[0] ^= (found[0] ^ to_k) & (four)(low == one);
            found[1] ^= (found[1] ^ to_k) & (four)(high == one);
        }
        memcpy(follow + begin, found, sizeof found);
    }
}

/* The vertices before and behind each corner at a vertex, in the face of the corner. */
typedef struct neighbours {
    uint32_t before[SMALL_VERTEX], behind[SMALL_VERTEX];
} neighbours;

/* Finds the swings (swing.h) of the corners at a vertex that has few corners, and returns flags for
 * what is wrong there. If the swings form a single ring, nothing is wrong; otherwise the cause is
 * found out. The loops have no branches that depend on ids, because irregular ids make such
 * branches slow. Two faces run along an edge in one direction if two corners of this vertex have
 * equal vertices behind them. */
static unsigned swing_few(const swinging *t, const uint32_t *filed, uint32_t count,
                          const neighbours *beside, size_t *matched)
{
    const uint32_t *from = beside->before, *to = beside->behind;
    uint32_t follow[SMALL_VERTEX], open = 0;
    assert(count > 0);
    match(from, to, count, follow);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = follow[i];
        open += k == count;
        t->swing[filed[i]] = k == count ? HE_NONE : filed[k];
    }
    *matched += count - open;
    if (open == 0) {
        uint32_t met = 1;
        for (uint32_t k = follow[0]; k != 0 && met <= count; k = follow[k]) {
            met++;
        }
        if (met == count) {
            return 0;
        }
    }
    return leads_twice(to, count) ? BAD_EDGE : all_open(follow, count) ? 0 : CLOSED_FAN;
}

static inline void find_beside(const swinging *t, const uint32_t *filed, uint32_t count,
                               uint32_t degree, neighbours *out)
{
    for (uint32_t i = 0; i < count; i++) {
        he_corner at = he_corner_find(t->corners, filed[i], degree);
        out->before[i] = t->soup->corners[at.prev];
        out->behind[i] = t->soup->corners[at.next];
    }
}

/* Buffers for finding the swings of the corners at a vertex of high degree. `leads`: for each
 * neighbour, the index in `filed` of the corner whose half-edge leads to it. `follows`: for each
 * corner, the index of its swing (next corner around the vertex). `entered`: a bit for each corner,
 * set if it is the swing of another corner. Values left by other vertices lie outside the range of
 * this vertex, so the arrays need no clearing. */
typedef struct hub_swings {
    uint32_t *leads, *follows;
    uint64_t *entered;
} hub_swings;

/* Returns the number of corners of the fan that begins at index `from`, or `most` + 1 if there are
 * more than `most`: the swings of invalid faces may form a circle that never returns to `from`. */
static uint32_t fan_length(const hub_swings *hub, uint32_t from, uint32_t end, uint32_t most)
{
    uint32_t k = from, met = 0;
    do {
        met++;
        k = hub->follows[k];
    } while (k < end && k != from && met <= most);
    return met;
}

static uint32_t vertex_before(const swinging *t, uint32_t i)
{
    return t->soup->corners[he_corner_find(t->corners, t->filed[i], t->corners->degree).prev];
}

static uint32_t vertex_behind(const swinging *t, uint32_t i)
{
    return t->soup->corners[he_corner_find(t->corners, t->filed[i], t->corners->degree).next];
}

static unsigned swing_many(swinging *t, uint32_t begin, uint32_t end, const hub_swings *hub,
                           size_t *matched)
{
    for (uint32_t i = begin; i < end; i++) {
        uint32_t to = vertex_behind(t, i), k = hub->leads[to];
        if (k >= begin && k < i && vertex_behind(t, k) == to) {
            return BAD_EDGE;
        }
        hub->leads[to] = i;
    }
    uint32_t open = 0, met = 0;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t from = vertex_before(t, i), k = hub->leads[from];
        bool found = k >= begin && k < end && vertex_behind(t, k) == from;
        hub->follows[i] = found ? k : end;
        t->swing[t->filed[i]] = found ? t->filed[k] : HE_NONE;
        open += !found;
        if (found && he_bits_get(hub->entered, k)) {
            return BAD_EDGE; /* two faces run along this edge in the same direction */
        }
        if (found) {
            he_bits_set(hub->entered, k);
        }
    }
    *matched += end - begin - open;
    for (uint32_t i = begin; i < end; i++) {
        if (open == 0 ? i == begin : !he_bits_get(hub->entered, i)) {
            met += fan_length(hub, i, end, end - begin - met);
        }
    }
    return met == end - begin ? 0 : CLOSED_FAN;
}

static inline void swing_range(swinging *t, uint32_t part, size_t from, size_t to, uint32_t degree)
{
    enum { AHEAD = 32 };
    const uint32_t *filed = t->filed, *corners = t->soup->corners;
    const uint32_t last = end_of(t, t->soup->vertex_count - 1);
    neighbours beside = {.before = {0}};
    unsigned found = 0;
    size_t matched = 0;
    uint32_t begin = begin_of(t, from), end;
    for (size_t v = from; v < to; v++, begin = end) {
        end = end_of(t, v);
        /* Words of `corners` and `swing` that the loop will use are prefetched: if the ids of
         * vertices are in no spatial order, these words lie far apart. */
        for (uint32_t i = begin; i < end && last - i > AHEAD; i++) {
            __builtin_prefetch(&corners[filed[i + AHEAD]]);
            __builtin_prefetch(&t->swing[filed[i + AHEAD]], 1);
        }
        t->first[v] = begin == end ? HE_NONE : filed[begin];
        if (end - begin > SMALL_VERTEX) {
            found |= LARGE_VERTEX;
        } else if (end > begin) {
            find_beside(t, filed + begin, end - begin, degree, &beside);
            found |= swing_few(t, filed + begin, end - begin, &beside, &matched);
        }
    }
    t->found[part] |= (unsigned char)found;
    t->matched[part] = matched;
}

static he_status turn_vertices(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    swinging *t = context;
    (void)err;
    switch (t->corners->degree) {
    case 3:
        swing_range(t, part, from, to, 3);
        break;
    case 4:
        swing_range(t, part, from, to, 4);
        break;
    default:
        swing_range(t, part, from, to, 0);
        break;
    }
    return HE_OK;
}

/* --- all together ----------------------------------------------------------------------------- */

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to find the edges of %zu corners",
                         soup->corner_count);
}

/* Finds the swings at vertices of many corners, one vertex after another, because these vertices
 * share the arrays of hub_swings. If `all` is true, also checks every other vertex again, to report
 * those at which a closed fan is beside another fan. Vertices at invalid edges are not reported,
 * because they have no well-defined fans. */
static he_status swing_again(swinging *t, bool all, he_report *report, uint64_t *total,
                             he_error *err)
{
    const he_soup *soup = t->soup;
    he_status status = HE_OK;
    size_t matched = 0;
    neighbours beside = {.before = {0}};
    hub_swings hub = {.leads = he_mem_zero(soup->vertex_count, sizeof(uint32_t)),
                      .follows = he_mem_array(NULL, soup->corner_count, sizeof(uint32_t)),
                      .entered = he_bits_new(soup->corner_count)};
    if (hub.leads == NULL || hub.follows == NULL || hub.entered == NULL) {
        status = no_memory(soup, err);
    }
    for (size_t v = 0; v < soup->vertex_count && status == HE_OK; v++) {
        uint32_t begin = begin_of(t, v), end = end_of(t, v);
        unsigned found = 0;
        status = he_progress_at(soup->limits.progress, v, soup->vertex_count, err);
        if (end - begin > SMALL_VERTEX) {
            found = swing_many(t, begin, end, &hub, &matched);
        } else if (all && end > begin) {
            find_beside(t, t->filed + begin, end - begin, t->corners->degree, &beside);
            found = swing_few(t, t->filed + begin, end - begin, &beside, &matched);
            found |= leads_twice(beside.before, end - begin) ? BAD_EDGE : 0;
        }
        t->all |= found;
        if (all && found == CLOSED_FAN) {
            he_report_add(
                report, total,
                (he_defect){HE_CLOSED_FAN, HE_VERTEX, (uint32_t)v, HE_NONE, HE_NONE, HE_NONE});
        }
    }
    t->matched[0] += all ? 0 : matched;
    he_mem_free(hub.leads);
    he_mem_free(hub.follows);
    he_mem_free(hub.entered);
    return status;
}

/* Combines the flags that were found in the ranges of a parallel loop. */
static void gather(swinging *t, size_t parts)
{
    for (size_t i = 0; i < parts; i++) {
        t->all |= t->found[i];
    }
}

static he_status file_all(swinging *t, he_report *report, uint64_t *total, he_error *err)
{
    const he_soup *soup = t->soup;
    he_progress *progress = soup->limits.progress;
    he_status status = he_progress_phase(progress, "checking", 0.1, err);
    if (status == HE_OK) {
        status = he_run_lanes(progress, t->lanes, soup->face_count, count_corners, t, err);
    }
    gather(t, t->lanes);
    if (status == HE_OK && (t->all & (BAD_FACE | LARGE_FACE)) != 0) {
        status = he_soup_check_faces(soup, report, total, err);
    }
    if (status != HE_OK || *total > 0) {
        return status;
    }
    place_corners(t);
    status = he_progress_phase(progress, "filing", 0.3, err);
    return status == HE_OK
               ? he_run_lanes(progress, t->lanes, soup->face_count, file_corners, t, err)
               : status;
}

static he_status swing_all(swinging *t, he_report *report, uint64_t *total, he_error *err)
{
    const he_soup *soup = t->soup;
    he_progress *progress = soup->limits.progress;
    he_status status = he_progress_phase(progress, "pairing", 0.55, err);
    if (status == HE_OK) {
        status = he_run_ranges(progress, soup->vertex_count, turn_vertices, t, err);
    }
    gather(t, he_ranges(soup->vertex_count));
    if (status == HE_OK && (t->all & LARGE_VERTEX) != 0) {
        status = he_progress_phase(progress, "pairing", 0.6, err);
        if (status == HE_OK) {
            status = swing_again(t, false, NULL, NULL, err);
        }
    }
    unsigned bad = t->all & (BAD_EDGE | CLOSED_FAN);
    if (status == HE_OK && (bad & BAD_EDGE) != 0) {
        status = he_soup_check_edges(soup, report, total, err);
    }
    return status == HE_OK && bad != 0 ? swing_again(t, true, report, total, err) : status;
}

static bool allocate(swinging *t)
{
    const he_soup *soup = t->soup;
    size_t parts = he_ranges(soup->vertex_count) + HE_MOST_LANES;
    t->found = he_mem_zero(parts, sizeof *t->found);
    t->matched = he_mem_zero(parts, sizeof *t->matched);
    t->places = he_mem_zero(soup->vertex_count, t->lanes * sizeof *t->places);
    t->first = he_mem_array(NULL, soup->vertex_count, sizeof *t->first);
    t->swing = he_mem_array(NULL, soup->corner_count, sizeof *t->swing);
    t->filed = he_mem_array(NULL, soup->corner_count, sizeof *t->filed);
    return t->found != NULL && t->matched != NULL && t->places != NULL && t->first != NULL &&
           t->swing != NULL && t->filed != NULL;
}

void he_swings_clear(he_swings *swings)
{
    he_mem_free(swings->spare);
    he_mem_free(swings->swing);
    he_mem_free(swings->first);
    *swings = (he_swings){0};
}

he_status he_soup_swing(const he_corners *corners, he_swings *out, he_report *report,
                        uint64_t *total, he_error *err)
{
    const he_soup *soup = corners->soup;
    swinging t = {.soup = soup,
                  .corners = corners,
                  .lanes = he_lanes(soup->limits.progress, soup->face_count)};
    he_status status = allocate(&t) ? HE_OK : no_memory(soup, err);
    if (status == HE_OK) {
        status = file_all(&t, report, total, err);
    }
    if (status == HE_OK && *total == 0) {
        status = swing_all(&t, report, total, err);
    }
    if (status == HE_OK && *total == 0) {
        size_t matched = 0;
        for (size_t i = 0; i < he_ranges(soup->vertex_count); i++) {
            matched += t.matched[i];
        }
        /* The number of corners is the number of pairs of a face and one of its edges. An edge with
         * two faces is counted twice there, and it gives two corners a swing. So half of the number
         * of swings is subtracted. */
        *out = (he_swings){t.swing, t.first, t.filed, soup->corner_count - matched / 2};
        t.swing = t.first = t.filed = NULL;
    }
    he_mem_free(t.found);
    he_mem_free(t.matched);
    he_mem_free(t.places);
    he_mem_free(t.first);
    he_mem_free(t.swing);
    he_mem_free(t.filed);
    return status;
}
