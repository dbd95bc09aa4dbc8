/* subdivide_sqrt3.c - writes the links for the scheme sqrt3, which puts a vertex into every
 * triangle and flips the old edges.
 *
 * The left drawing shows an old half-edge h and the new triangle that belongs to it before old
 * edges are flipped. The `apex` of h is the new vertex in the face of h. The other two sides of the
 * new triangle are half-edges inside the old face, the `legs` of h. The right drawing shows a face
 * with a sharp edge that is cut into three parts. Such a face gets no vertex inside; the points p
 * and q on the sharp edge are the apexes of its half-edges j (from b to c) and k (from c to a).
 *
 *               apex(h)
 *                  o
 *      in_leg(h) .' '.  out_leg(h)
 *      runs    .'     '.  runs up                c                  apex(j) = q
 *      down   v    h     '.                      o                  apex(k) = p
 *            o----------->o                   k /|\ j               out_leg(j) = c to q
 *         origin        target                 / | | \              in_leg(j) = q to b
 *                                             /  | |  \             out_leg(k) = a to p
 *                                          a o---o-o---o b          in_leg(k) = p to c
 *                                                p q                third triangle: p, q, c
 *
 * Flipping an old edge changes its half-edge h: h then runs from the apex of twin(h) to the apex of
 * h, in the new triangle at the old origin of h. */
#include "algo/subdivide_step.h"

/* A face of the coarse mesh and its three half-edges. */
typedef struct triangle {
    uint32_t f, h[3];
    /* index in `h` of the half-edge whose edge is cut into three parts; 3 if there is none */
    unsigned cut;
} triangle;

enum { NO_CUT = 3 };

static triangle triangle_of(const he_subdivide_step *s, uint32_t f)
{
    const he_content *from = s->from;
    triangle t = {.f = f, .h = {from->face_halfedge[f]}, .cut = NO_CUT};
    t.h[1] = from->next[t.h[0]];
    t.h[2] = from->next[t.h[1]];
    for (unsigned i = 0; i < 3 && s->centre[f] == HE_NONE; i++) {
        if (s->third[t.h[i] >> 1] != HE_NONE) {
            t.cut = i;
        }
    }
    return t;
}

static unsigned place_of(const triangle *t, uint32_t h)
{
    return h == t->h[0] ? 0 : h == t->h[1] ? 1 : 2;
}

/* A sharp edge is cut into three parts. segment() returns part j (0 to 2) of half-edge h, and
 * point() the new vertex at which part j ends (j = 0 or 1). */
static uint32_t segment(const he_subdivide_step *s, uint32_t h, unsigned j)
{
    uint32_t e = h >> 1, side = h & 1, more = s->from->edges.issued + 2 * s->third[e];
    unsigned along = side == 0 ? j : 2 - j;
    return 2 * (along == 0 ? e : more + along - 1) | side;
}
static uint32_t point(const he_subdivide_step *s, uint32_t h, unsigned j)
{
    uint32_t first = s->from->vertices.issued + 2 * s->third[h >> 1];
    return first + ((h & 1) == 0 ? j : 1 - j);
}

static uint32_t apex(const he_subdivide_step *s, uint32_t h)
{
    triangle t = triangle_of(s, s->from->face[h]);
    if (t.cut == NO_CUT) {
        return s->centre[t.f];
    }
    return point(s, t.h[t.cut], place_of(&t, h) == (t.cut + 1) % 3 ? 1 : 0);
}

static uint32_t out_leg(const he_subdivide_step *s, uint32_t h)
{
    triangle t = triangle_of(s, s->from->face[h]);
    unsigned i = place_of(&t, h);
    if (t.cut == NO_CUT) {
        return 2 * (s->spoke[t.f] + (i + 1) % 3);
    }
    return i == (t.cut + 1) % 3 ? 2 * (s->spoke[t.f] + 1) + 1 : segment(s, t.h[t.cut], 0);
}

static uint32_t in_leg(const he_subdivide_step *s, uint32_t h)
{
    triangle t = triangle_of(s, s->from->face[h]);
    unsigned i = place_of(&t, h);
    if (t.cut == NO_CUT) {
        return 2 * (s->spoke[t.f] + i) + 1;
    }
    return i == (t.cut + 1) % 3 ? segment(s, t.h[t.cut], 2) : 2 * s->spoke[t.f];
}

/* Returns how to compute the attribute values of a new corner at the apex of h, the new vertex in
 * the face of h. */
static he_corner_source at_apex(const he_subdivide_step *s, uint32_t h)
{
    triangle t = triangle_of(s, s->from->face[h]);
    if (t.cut == NO_CUT) {
        return (he_corner_source){h, HE_NONE, HE_FROM_FACE};
    }
    uint32_t a = t.h[t.cut], b = t.h[(t.cut + 1) % 3];
    return place_of(&t, h) == (t.cut + 1) % 3 ? (he_corner_source){b, a, HE_FROM_THIRD}
                                              : (he_corner_source){a, b, HE_FROM_THIRD};
}

static he_corner_source at_row(uint32_t h)
{
    return (he_corner_source){h, HE_NONE, HE_FROM_ROW};
}

/* A corner of a new triangle: its half-edge, the origin of this half-edge, and how to compute the
 * attribute values of the corner. */
typedef struct corner {
    uint32_t h, origin;
    he_corner_source source;
} corner;

static void put(const he_subdivide_step *s, uint32_t face, const corner c[3])
{
    for (unsigned i = 0; i < 3; i++) {
        he_subdivide_set(
            s->to, c[i].h,
            (he_subdivide_links){c[(i + 1) % 3].h, c[(i + 2) % 3].h, c[i].origin, face});
        if (s->corner_from != NULL) {
            s->corner_from[c[i].h] = c[i].source;
        }
    }
    s->to->face_halfedge[face] = c[0].h;
}

/* Writes the new triangle that belongs to half-edge i of an old face. */
static void put_part(const he_subdivide_step *s, const triangle *t, unsigned i, uint32_t face)
{
    const he_content *from = s->from;
    uint32_t h = t->h[i], next = t->h[(i + 1) % 3], last = t->h[(i + 2) % 3];
    if (i == t->cut) {
        const corner parts[3] = {
            {segment(s, h, 1), point(s, h, 0), {h, next, HE_FROM_THIRD}},
            {2 * (s->spoke[t->f] + 1), point(s, h, 1), {next, h, HE_FROM_THIRD}},
            {2 * s->spoke[t->f] + 1, from->origin[last], at_row(last)},
        };
        put(s, face, parts);
    } else if (he_subdivide_is_sharp(s, h >> 1)) {
        const corner parts[3] = {
            {h, from->origin[h], at_row(h)},
            {out_leg(s, h), from->origin[next], at_row(next)},
            {in_leg(s, h), apex(s, h), at_apex(s, h)},
        };
        put(s, face, parts);
    } else {
        const corner parts[3] = {
            {out_leg(s, h ^ 1), from->origin[h], at_row(h)},
            {h, apex(s, h ^ 1), at_apex(s, h ^ 1)},
            {in_leg(s, h), apex(s, h), at_apex(s, h)},
        };
        put(s, face, parts);
    }
}

static void put_face(const he_subdivide_step *s, uint32_t f)
{
    const he_content *from = s->from;
    triangle t = triangle_of(s, f);
    uint32_t rank = he_subdivide_face_rank(s, f), first = from->faces.issued + 2 * rank;
    for (unsigned i = 0; i < 3; i++) {
        put_part(s, &t, i, i == 0 ? f : first + i - 1);
    }
    if (s->centre[f] != HE_NONE) {
        s->to->vertex_halfedge[s->centre[f]] = 2 * s->spoke[f] + 1;
        if (s->vertex_from != NULL) {
            s->vertex_from[s->centre[f] - from->vertices.issued] = from->origin[t.h[0]];
        }
    }
    if (s->face_from != NULL) {
        s->face_from[2 * rank] = s->face_from[2 * rank + 1] = f;
    }
}

/* Writes the links of a boundary half-edge, or of its three parts if it is cut. */
static void put_boundary(const he_subdivide_step *s, uint32_t h)
{
    const he_content *from = s->from;
    uint32_t next = from->next[h], prev = from->prev[h];
    bool cut = s->thirds;
    for (unsigned j = 0; j < (cut ? 3 : 1); j++) {
        uint32_t at = cut ? segment(s, h, j) : h;
        uint32_t after = !cut ? next : j < 2 ? segment(s, h, j + 1) : segment(s, next, 0);
        uint32_t before = !cut ? prev : j > 0 ? segment(s, h, j - 1) : segment(s, prev, 2);
        he_subdivide_set(s->to, at,
                         (he_subdivide_links){after, before,
                                              j == 0 ? from->origin[h] : point(s, h, j - 1),
                                              HE_NONE});
        if (s->corner_from != NULL && j == 0) {
            s->corner_from[at] = at_row(h);
        }
    }
}

static void put_thirds(const he_subdivide_step *s, uint32_t e, uint32_t along)
{
    const he_content *from = s->from;
    for (unsigned j = 0; j < 2; j++) {
        uint32_t p = point(s, along, j);
        s->to->vertex_halfedge[p] = segment(s, along, j + 1);
        if (s->vertex_from != NULL) {
            s->vertex_from[p - from->vertices.issued] = from->origin[along ^ j];
        }
        if (s->edge_from != NULL) {
            s->edge_from[2 * s->third[e] + j] = e;
        }
    }
}

static void put_edge(const he_subdivide_step *s, uint32_t e)
{
    const he_content *from = s->from;
    uint32_t along = 2 * e;
    for (uint32_t h = 2 * e; h <= 2 * e + 1; h++) {
        if (from->face[h] == HE_NONE) {
            put_boundary(s, h);
            along = h;
        }
    }
    if (s->third[e] != HE_NONE) {
        put_thirds(s, e, along);
    }
    if (s->feature != NULL && he_bits_get(s->feature, e)) {
        for (unsigned j = 0; j < (s->thirds ? 3 : 1); j++) {
            he_bits_set(s->feature_next, s->thirds ? segment(s, 2 * e, j) >> 1 : e);
        }
    }
}

static void put_vertex(const he_subdivide_step *s, uint32_t v)
{
    uint32_t h = s->from->vertex_halfedge[v];
    if (h != HE_DEAD && h != HE_NONE) {
        bool sharp = he_subdivide_is_sharp(s, h >> 1);
        h = !sharp ? out_leg(s, h ^ 1) : s->thirds ? segment(s, h, 0) : h;
    }
    s->to->vertex_halfedge[v] = h;
}

/* Assigns ids to the new elements, in the order that subdivide.h states. */
static he_status find_places(he_subdivide_step *s, he_error *err)
{
    const he_content *from = s->from;
    uint32_t thirds = 0;
    for (uint32_t e = 0; e < from->edges.issued; e++) {
        bool cut = s->thirds && from->next[2 * e] != HE_DEAD && he_subdivide_is_sharp(s, e);
        s->third[e] = cut ? thirds++ : HE_NONE;
    }
    uint32_t spoke = from->edges.issued + 2 * thirds;
    uint32_t centre = from->vertices.issued + 2 * thirds;
    for (uint32_t f = 0; f < from->faces.issued; f++) {
        uint32_t h = from->face_halfedge[f], n, last;
        if (h == HE_DEAD) {
            s->to->face_halfedge[f] = HE_DEAD;
            continue;
        }
        n = from->next[h];
        last = from->next[n];
        if (from->next[last] != h) {
            return he_fail(err, HE_NOT_TRIANGLE, HE_FACE, f,
                           "face %u is not a triangle, and the scheme sqrt3 needs triangles", f);
        }
        if (he_subdivide_is_doubled(from, h ^ 1, n)) {
            return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, h >> 1,
                           "the centres of faces %u and %u would be joined by two edges, across "
                           "edges %u and %u",
                           f, from->face[h ^ 1], h >> 1, n >> 1);
        }
        bool cut = s->third[h >> 1] != HE_NONE || s->third[n >> 1] != HE_NONE ||
                   s->third[last >> 1] != HE_NONE;
        s->centre[f] = cut ? HE_NONE : centre++;
        s->spoke[f] = spoke;
        spoke += cut ? 2 : 3;
    }
    return HE_OK;
}

he_status he_subdivide_sqrt3(he_subdivide_step *s, he_error *err)
{
    const he_content *from = s->from;
    s->centre = he_mem_array(NULL, from->faces.issued, sizeof *s->centre);
    s->spoke = he_mem_array(NULL, from->faces.issued, sizeof *s->spoke);
    s->third = he_mem_array(NULL, from->edges.issued, sizeof *s->third);
    if (s->centre == NULL || s->spoke == NULL || s->third == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory to number the parts into which %u faces are cut",
                             from->faces.live);
    }
    he_status status = find_places(s, err);
    for (uint32_t f = 0; f < from->faces.issued && status == HE_OK; f++) {
        status = he_progress_at(s->progress, f, from->faces.issued, err);
        if (status == HE_OK && he_subdivide_is_live(from->face_halfedge, f)) {
            put_face(s, f);
        }
    }
    for (uint32_t e = 0; e < from->edges.issued && status == HE_OK; e++) {
        status = he_progress_at(s->progress, e, from->edges.issued, err);
        if (from->next[2 * e] == HE_DEAD) {
            for (uint32_t h = 2 * e; h <= 2 * e + 1; h++) {
                he_subdivide_set(s->to, h,
                                 (he_subdivide_links){HE_DEAD, HE_DEAD, HE_DEAD, HE_DEAD});
            }
        } else {
            put_edge(s, e);
        }
    }
    for (uint32_t v = 0; v < from->vertices.issued && status == HE_OK; v++) {
        put_vertex(s, v);
    }
    return status;
}
