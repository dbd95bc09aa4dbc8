/* subdivide_split.c - writes the links for the schemes that cut every edge in halves: loop,
 * catmull_clark and linear. */
#include "algo/subdivide_step.h"
#include "base/parallel.h"

/* The functions below return the new vertex in the middle of half-edge h, and the halves of h:
 *
 *     half-edge h    o ----first(h)----> o ----second(h)----> o
 *                  origin              middle               target */
static uint32_t middle(const he_subdivide_step *s, uint32_t h)
{
    return s->from->vertices.issued + he_subdivide_edge_rank(s, h >> 1);
}
static uint32_t other_half(const he_subdivide_step *s, uint32_t h)
{
    return 2 * (s->from->edges.issued + he_subdivide_edge_rank(s, h >> 1)) | (h & 1);
}
static uint32_t first(const he_subdivide_step *s, uint32_t h)
{
    return (h & 1) == 0 ? h : other_half(s, h);
}
static uint32_t second(const he_subdivide_step *s, uint32_t h)
{
    return (h & 1) == 0 ? other_half(s, h) : h;
}

/* The ids of the next new vertex, edge and face that are made when a face is cut. */
typedef struct fresh {
    uint32_t vertex, edge, face;
} fresh;

static void note_faces(const he_subdivide_step *s, uint32_t f, uint32_t first_face, uint32_t count)
{
    for (uint32_t i = 0; s->face_from != NULL && i < count; i++) {
        s->face_from[first_face + i - s->from->faces.issued] = f;
    }
}

/* Records how to compute the corner values of the two halves of half-edge h: `first` leaves the
 * origin of h, `second` leaves the middle of h. */
static void note_corner(const he_subdivide_step *s, uint32_t h, uint32_t next)
{
    s->corner_from[first(s, h)] = (he_corner_source){h, HE_NONE, HE_FROM_ROW};
    s->corner_from[second(s, h)] = (he_corner_source){h, next, HE_FROM_MIDDLE};
}

static void cut_triangle(const he_subdivide_step *s, uint32_t f, const uint32_t h[3], fresh *at)
{
    const he_content *from = s->from;
    he_content *to = s->to;
    uint32_t part[3] = {f, at->face, at->face + 1}, centre = at->face + 2;
    uint32_t m[3], lo[3], hi[3], in[3];
    for (unsigned i = 0; i < 3; i++) {
        m[i] = middle(s, h[i]);
        lo[i] = first(s, h[i]);
        hi[i] = second(s, h[i]);
        /* The half-edge from the middle of h[i] to the middle of the half-edge before h[i]. It is
         * in the new face at the origin of h[i]. */
        in[i] = 2 * (at->edge + i);
    }
    for (unsigned i = 0; i < 3; i++) {
        unsigned p = i == 0 ? 2 : i - 1, n = i == 2 ? 0 : i + 1;
        he_subdivide_set(to, lo[i],
                         (he_subdivide_links){in[i], hi[p], from->origin[h[i]], part[i]});
        he_subdivide_set(to, in[i], (he_subdivide_links){hi[p], lo[i], m[i], part[i]});
        he_subdivide_set(to, hi[p], (he_subdivide_links){lo[i], in[i], m[p], part[i]});
        he_subdivide_set(to, in[i] + 1, (he_subdivide_links){in[n] + 1, in[p] + 1, m[p], centre});
        to->face_halfedge[part[i]] = lo[i];
        if (s->corner_from != NULL) {
            note_corner(s, h[i], h[n]);
            s->corner_from[in[i]] = (he_corner_source){h[i], h[n], HE_FROM_MIDDLE};
            s->corner_from[in[i] + 1] = (he_corner_source){h[p], h[i], HE_FROM_MIDDLE};
        }
    }
    to->face_halfedge[centre] = in[0] + 1;
    note_faces(s, f, at->face, 3);
    at->edge += 3;
    at->face += 3;
}

/* Cuts face f into quads, one at each of its corners, which all share a new vertex inside the face.
 * The i-th new edge joins the middle of the face's i-th half-edge to this vertex. */
static void cut_polygon(const he_subdivide_step *s, uint32_t f, uint32_t first_halfedge, fresh *at)
{
    const he_content *from = s->from;
    he_content *to = s->to;
    uint32_t h = first_halfedge, p = from->prev[h], count = 0;
    do {
        h = from->next[h];
        count++;
    } while (h != first_halfedge);
    uint32_t before = 2 * (at->edge + count - 1), centre_halfedge = 2 * at->edge + 1;
    uint32_t hi = second(s, p), m = middle(s, p);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t part = i == 0 ? f : at->face + i - 1, in = 2 * (at->edge + i);
        uint32_t lo = first(s, h), next_m = middle(s, h), next = from->next[h];
        he_subdivide_set(to, lo, (he_subdivide_links){in, hi, from->origin[h], part});
        he_subdivide_set(to, in, (he_subdivide_links){before + 1, lo, next_m, part});
        he_subdivide_set(to, before + 1, (he_subdivide_links){hi, in, at->vertex, part});
        he_subdivide_set(to, hi, (he_subdivide_links){lo, before + 1, m, part});
        to->face_halfedge[part] = lo;
        if (s->corner_from != NULL) {
            note_corner(s, h, next);
            s->corner_from[in] = (he_corner_source){h, next, HE_FROM_MIDDLE};
            s->corner_from[in + 1] =
                i == 0 ? (he_corner_source){h, HE_NONE, HE_FROM_FACE}
                       : (he_corner_source){centre_halfedge, HE_NONE, HE_FROM_NEW};
        }
        before = in;
        hi = second(s, h);
        m = next_m;
        h = next;
    }
    to->vertex_halfedge[at->vertex] = centre_halfedge;
    note_faces(s, f, at->face, count - 1);
    if (s->vertex_from != NULL) {
        s->vertex_from[at->vertex - from->vertices.issued] = from->origin[first_halfedge];
    }
    at->vertex++;
    at->edge += count;
    at->face += count - 1;
}

static he_status refuse_polygon(uint32_t f, he_error *err)
{
    return he_fail(err, HE_NOT_TRIANGLE, HE_FACE, f,
                   "face %u is not a triangle, and the scheme loop needs triangles", f);
}

static he_status cut_face(const he_subdivide_step *s, uint32_t f, fresh *at, he_error *err)
{
    const he_content *from = s->from;
    uint32_t h[3] = {from->face_halfedge[f]};
    if (s->scheme == HE_CATMULL_CLARK) {
        cut_polygon(s, f, h[0], at);
        return HE_OK;
    }
    h[1] = from->next[h[0]];
    h[2] = from->next[h[1]];
    if (from->next[h[2]] != h[0]) {
        if (s->scheme == HE_LOOP) {
            return refuse_polygon(f, err);
        }
        cut_polygon(s, f, h[0], at);
        return HE_OK;
    }
    if (he_subdivide_is_doubled(from, h[0] ^ 1, h[1])) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, h[0] >> 1,
                       "the subdivision would join the midpoints of edges %u and %u by two edges",
                       h[0] >> 1, h[1] >> 1);
    }
    cut_triangle(s, f, h, at);
    return HE_OK;
}

/* Counts the new elements that cutting face f makes. The face must be live. The arrays of the finer
 * mesh have room for what the scheme makes of faces that it accepts. A face that the scheme refuses
 * must not be counted, because later lanes would then write beyond the end of these arrays. */
static he_status count_face(const he_subdivide_step *s, uint32_t f, fresh *at, he_error *err)
{
    const he_content *from = s->from;
    uint32_t h = from->face_halfedge[f], i = from->next[h], count = 3;
    if (from->next[from->next[i]] == h && s->scheme != HE_CATMULL_CLARK) {
        at->edge += 3;
        at->face += 3;
        return HE_OK;
    }
    if (s->scheme == HE_LOOP) {
        return refuse_polygon(f, err);
    }
    for (i = from->next[from->next[i]]; i != h; i = from->next[i]) {
        count++;
    }
    at->vertex++;
    at->edge += count;
    at->face += count - 1;
    return HE_OK;
}

/* The data for cutting faces in parallel. Each thread handles a lane, which is a range of
 * consecutive faces. `at` has the ids that the next new elements of each lane get, so the elements
 * of earlier lanes must be counted first. */
typedef struct cutting {
    const he_subdivide_step *s;
    fresh at[HE_MOST_LANES];
} cutting;

static he_status count_lane(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    cutting *c = context;
    fresh at = c->at[lane];
    he_status status = HE_OK;
    for (size_t f = from; f < to && status == HE_OK; f++) {
        if (he_subdivide_is_live(c->s->from->face_halfedge, (uint32_t)f)) {
            status = count_face(c->s, (uint32_t)f, &at, err);
        }
    }
    c->at[lane] = at;
    return status;
}

static he_status cut_lane(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    cutting *c = context;
    const he_subdivide_step *s = c->s;
    /* The lane works on a local copy of its ids. The entries of several lanes share a cache line,
     * and threads that write to one cache line slow each other down (false sharing). */
    fresh at = c->at[lane];
    he_status status = HE_OK;
    for (size_t f = from; f < to && status == HE_OK; f++) {
        if (!he_subdivide_is_live(s->from->face_halfedge, (uint32_t)f)) {
            s->to->face_halfedge[f] = HE_DEAD;
        } else {
            status = cut_face(s, (uint32_t)f, &at, err);
        }
    }
    c->at[lane] = at;
    return status;
}

static he_status cut_faces(const he_subdivide_step *s, uint32_t lanes, he_error *err)
{
    const he_content *from = s->from;
    fresh at = {.vertex = from->vertices.issued + from->edges.live,
                .edge = from->edges.issued + from->edges.live,
                .face = from->faces.issued};
    cutting c = {.s = s};
    he_status status = HE_OK;
    if (lanes > 1) {
        status = he_run_lanes(s->progress, lanes, from->faces.issued, count_lane, &c, err);
    }
    for (uint32_t lane = 0; lane < lanes; lane++) {
        fresh made = c.at[lane];
        c.at[lane] = at;
        at.vertex += made.vertex;
        at.edge += made.edge;
        at.face += made.face;
    }
    if (status == HE_OK) {
        status = he_run_lanes(s->progress, lanes, from->faces.issued, cut_lane, &c, err);
    }
    /* If several lanes run in parallel, the reported error may be that of a later face. Running
     * again with one lane finds the error of the first face, so that the result does not depend on
     * the number of threads. */
    return lanes > 1 && status != HE_OK && status != HE_CANCELLED ? cut_faces(s, 1, err) : status;
}

static void cut_boundary(const he_subdivide_step *s, uint32_t h)
{
    const he_content *from = s->from;
    uint32_t lo = first(s, h), hi = second(s, h);
    he_subdivide_set(s->to, lo,
                     (he_subdivide_links){hi, second(s, from->prev[h]), from->origin[h], HE_NONE});
    he_subdivide_set(s->to, hi,
                     (he_subdivide_links){first(s, from->next[h]), lo, middle(s, h), HE_NONE});
    if (s->corner_from != NULL) {
        s->corner_from[lo] = (he_corner_source){h, HE_NONE, HE_FROM_ROW};
    }
}

static void cut_edge(const he_subdivide_step *s, uint32_t e)
{
    const he_content *from = s->from;
    uint32_t rank = he_subdivide_edge_rank(s, e), boundary = HE_NONE;
    for (uint32_t h = 2 * e; h <= 2 * e + 1; h++) {
        if (from->face[h] == HE_NONE) {
            boundary = h;
            cut_boundary(s, h);
        }
    }
    s->to->vertex_halfedge[from->vertices.issued + rank] =
        second(s, boundary == HE_NONE ? 2 * e : boundary);
    if (s->vertex_from != NULL) {
        s->vertex_from[rank] = from->origin[2 * e];
    }
    if (s->edge_from != NULL) {
        s->edge_from[rank] = e;
    }
    if (s->feature != NULL && he_bits_get(s->feature, e)) {
        he_bits_set(s->feature_next, e);
        he_bits_set(s->feature_next, from->edges.issued + rank);
    }
}

static he_status cut_edges(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const he_subdivide_step *s = context;
    (void)part;
    (void)err;
    for (size_t e = from; e < to; e++) {
        if (s->from->next[2 * e] == HE_DEAD) {
            he_subdivide_set(s->to, (uint32_t)(2 * e),
                             (he_subdivide_links){HE_DEAD, HE_DEAD, HE_DEAD, HE_DEAD});
            he_subdivide_set(s->to, (uint32_t)(2 * e + 1),
                             (he_subdivide_links){HE_DEAD, HE_DEAD, HE_DEAD, HE_DEAD});
        } else {
            cut_edge(s, (uint32_t)e);
        }
    }
    return HE_OK;
}

static he_status keep_vertices(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const he_subdivide_step *s = context;
    (void)part;
    (void)err;
    for (size_t v = from; v < to; v++) {
        uint32_t h = s->from->vertex_halfedge[v];
        s->to->vertex_halfedge[v] = h == HE_DEAD || h == HE_NONE ? h : first(s, h);
    }
    return HE_OK;
}

he_status he_subdivide_split(he_subdivide_step *s, he_error *err)
{
    const he_content *from = s->from;
    he_status status = cut_faces(s, he_lanes(s->progress, from->faces.issued), err);
    if (status == HE_OK) {
        /* Feature flags are single bits. The flags of neighbouring edges share a word, and two
         * threads must not write to one word, so this loop runs on one thread. */
        status = s->feature != NULL
                     ? he_run_lanes(s->progress, 1, from->edges.issued, cut_edges, s, err)
                     : he_run_ranges(s->progress, from->edges.issued, cut_edges, s, err);
    }
    return status == HE_OK
               ? he_run_ranges(s->progress, from->vertices.issued, keep_vertices, s, err)
               : status;
}
