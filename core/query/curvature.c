#include "query/curvature.h"

#include "draw/draw_arrays.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"

/* --- chosen elements --- */

/* The elements whose curvature is computed. The sums of an element are in an array, at the index
 * that row_of returns: the id of the element if all elements are chosen, else the index of the id
 * in `ids`. */
typedef struct chosen {
    bool all;
    he_ids ids; /* ids of the chosen elements, sorted, each once; empty if `all` is true */
    /* ids of the faces beside the chosen elements, sorted, each once; empty if `all` is true */
    he_ids faces;
} chosen;

static void clear(chosen *c)
{
    he_ids_clear(&c->ids);
    he_ids_clear(&c->faces);
}

/* Returns the index at which the sums of an element are stored; HE_NONE if the element is not
 * chosen. */
static uint32_t row_of(const chosen *c, uint32_t id)
{
    if (c->all) {
        return id;
    }
    size_t low = 0, high = c->ids.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (c->ids.ids[middle] < id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < c->ids.count && c->ids.ids[low] == id ? (uint32_t)low : HE_NONE;
}

static he_status add_face(chosen *c, uint32_t face, he_error *err)
{
    return face == HE_NONE ? HE_OK : he_ids_add(&c->faces, face, err);
}

static he_status add_faces(chosen *c, const he_mesh *m, he_kind kind, uint32_t id, he_error *err)
{
    if (kind == HE_EDGE) {
        he_status status = add_face(c, m->c.face[2u * id], err);
        return status == HE_OK ? add_face(c, m->c.face[2u * id + 1u], err) : status;
    }
    uint32_t first = m->c.vertex_halfedge[id], h = first;
    he_status status = HE_OK;
    while (h != HE_NONE && status == HE_OK) {
        status = add_face(c, m->c.face[h], err);
        h = m->c.prev[h] ^ 1u;
        h = h == first ? HE_NONE : h;
    }
    return status;
}

static he_status choose(chosen *c, const he_mesh *m, he_kind kind, const uint32_t *of, size_t count,
                        he_error *err)
{
    *c = (chosen){.all = of == NULL};
    if (c->all) {
        return HE_OK;
    }
    he_status status = he_ids_reserve(&c->ids, count, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        status = he_ids_add(&c->ids, of[i], err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&c->ids, err);
    }
    for (size_t i = 0; i < c->ids.count && status == HE_OK; i++) {
        status = add_faces(c, m, kind, c->ids.ids[i], err);
    }
    return status == HE_OK ? he_ids_sort(&c->faces, err) : status;
}

static size_t rows_of(const chosen *c, const he_mesh *m, he_kind kind)
{
    return c->all ? he_mesh_issued(m, kind) : c->ids.count;
}

/* --- triangles --- */

typedef struct triangle {
    uint32_t corner[3];
    bool is_side[3]; /* true if the side from corner i to the next corner is an edge of the mesh */
    double length[3];
    double angle[3], cosine[3], sine[3]; /* angles at the corners, with their cosines and sines */
    he_vec3 along[3];                    /* unit vectors along the sides */
    /* unit normal of the triangle; zero if the triangle is degenerate */
    he_vec3 normal;
    bool degenerate;
} triangle;

/* Two sides count as parallel if the sine of the angle between them is at most this. */
static const double THIN = 16 * DBL_EPSILON;

static void measure(triangle *t, const he_mesh *m, const uint32_t row[HE_DRAWN_ROW])
{
    bool whole[3];
    for (int i = 0; i < 3; i++) {
        t->corner[i] = row[i];
        t->is_side[i] = (row[3] >> (HE_DRAWN_SIDES + i) & 1) != 0;
        t->along[i] =
            he_direction(m->c.position[row[i]], m->c.position[row[(i + 1) % 3]], &t->length[i]);
        whole[i] = t->length[i] > 0;
    }
    t->degenerate = false;
    for (int i = 0; i < 3; i++) {
        int k = (i + 2) % 3;
        he_vec3 back = he_vec3_scale(t->along[k], -1);
        he_vec3 cross = he_vec3_cross(t->along[i], back);
        t->sine[i] = he_vec3_length(cross);
        t->cosine[i] = he_vec3_dot(t->along[i], back);
        t->angle[i] = atan2(t->sine[i], t->cosine[i]);
        if (!whole[i] || !whole[k]) {
            t->angle[i] = whole[i] || whole[k] ? HE_PI / 2 : HE_PI / 3;
        }
        t->degenerate |= !(t->sine[i] > THIN);
        if (i == 0) {
            t->normal = he_vec3_scale(cross, t->degenerate ? 0 : 1 / t->sine[0]);
        }
    }
}

/* Returns the coordinate frame in which one face is cut into triangles. The frame depends on this
 * face alone, so the curvature of an element is equal whether it is computed alone or together with
 * all other elements. */
static he_frame frame_of(const he_mesh *m, uint32_t first)
{
    he_vec3 base = m->c.position[m->c.origin[first]];
    double reach = 0, largest = he_vec3_extent(base);
    for (uint32_t h = m->c.next[first]; h != first; h = m->c.next[h]) {
        he_vec3 p = m->c.position[m->c.origin[h]];
        reach = fmax(reach, he_vec3_extent(he_vec3_sub(p, base)));
        largest = fmax(largest, he_vec3_extent(p));
    }
    int exponent = he_exponent_of(isfinite(reach) ? reach : largest) + 1;
    return (he_frame){base, ldexp(1, -exponent)};
}

typedef void (*visitor)(const triangle *t, void *context);

static he_status visit_face(const he_mesh *m, uint32_t face, uint64_t *most, visitor visit,
                            void *context, he_error *err)
{
    uint32_t first = m->c.face_halfedge[face], row[HE_DRAWN_ROW];
    he_draw_arrays d = {.mesh = m, .frame = {{0, 0, 0}, 1}};
    triangle t;
    if (m->c.next[m->c.next[m->c.next[first]]] != first) {
        uint32_t degree = he_face_degree(m, (he_face){face});
        uint64_t cost = degree > 4 ? (uint64_t)degree * degree : 0;
        if (cost > *most) {
            return he_fail(err, HE_LIMIT, HE_FACE, face,
                           "face %u has %u corners, too many to triangulate for its curvature",
                           face, degree);
        }
        *most -= cost;
        he_frame frame = frame_of(m, first);
        he_status status = he_draw_arrays_init_faces(&d, m, &frame, &face, 1, UINT64_MAX, err);
        if (status != HE_OK) {
            return status;
        }
    }
    he_draw_arrays_walk walk;
    he_draw_arrays_begin(&d, face, &walk);
    while (he_draw_arrays_next(&d, &walk, row)) {
        measure(&t, m, row);
        visit(&t, context);
    }
    he_draw_arrays_clear(&d);
    return HE_OK;
}

static he_status for_each(const he_mesh *m, const chosen *c, uint64_t most, he_progress *progress,
                          visitor visit, void *context, he_error *err)
{
    he_status status = HE_OK;
    size_t count = c->all ? m->c.faces.issued : c->faces.count;
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        uint32_t face = c->all ? (uint32_t)i : c->faces.ids[i];
        status = he_progress_at(progress, i, count, err);
        if (status == HE_OK && he_face_is_live(m, (he_face){face})) {
            status = visit_face(m, face, &most, visit, context, err);
        }
    }
    return status;
}

/* --- curvature --- */

/* Sums over the triangles at one vertex. Lengths are divided by 2^exponent, which is about the
 * longest side that was added so far, so that the sums neither overflow nor underflow. */
typedef struct sums {
    double angle, area;
    he_vec3 bend;   /* sum of cotangents times the side vectors that point towards the vertex */
    he_vec3 normal; /* sum of the triangles' normals, weighted by angle */
    int exponent;
    bool any;
} sums;

typedef struct bending {
    const chosen *chosen;
    sums *rows;
} bending;

static void rescale(sums *s, int exponent)
{
    if (!s->any) {
        s->exponent = exponent;
        s->any = true;
    }
    if (exponent > s->exponent) {
        int down = s->exponent - exponent;
        s->area = ldexp(s->area, 2 * down);
        s->bend = he_vec3_scale(s->bend, ldexp(1, down));
        s->exponent = exponent;
    }
}

/* Returns the share of the triangle's area that belongs to corner i (mixed area, curvature.h). If
 * no angle is obtuse, this is the area of the points of the triangle that are nearer to corner i
 * than to the other two corners. In an obtuse triangle the corner with the obtuse angle gets half
 * of the area, and each other corner a quarter. */
static double share(const triangle *t, int i, double ahead, double behind)
{
    int j = (i + 1) % 3, k = (i + 2) % 3;
    if (t->cosine[i] < 0 || t->cosine[j] < 0 || t->cosine[k] < 0) {
        double area = ahead * behind * t->sine[i] / 2;
        return t->cosine[i] < 0 ? area / 2 : area / 4;
    }
    return (behind * behind * t->cosine[j] / t->sine[j] +
            ahead * ahead * t->cosine[k] / t->sine[k]) /
           8;
}

static void add_bend(const triangle *t, void *context)
{
    bending *b = context;
    for (int i = 0; i < 3; i++) {
        uint32_t row = row_of(b->chosen, t->corner[i]);
        if (row == HE_NONE) {
            continue;
        }
        sums *s = &b->rows[row];
        s->angle += t->angle[i];
        if (t->degenerate) {
            continue;
        }
        int j = (i + 1) % 3, k = (i + 2) % 3;
        rescale(s, he_exponent_of(fmax(t->length[i], t->length[k])));
        double ahead = ldexp(t->length[i], -s->exponent);
        double behind = ldexp(t->length[k], -s->exponent);
        s->area += share(t, i, ahead, behind);
        s->normal = he_vec3_add(s->normal, he_vec3_scale(t->normal, t->angle[i]));
        /* The cotangent formula weights each side by the cotangent of the opposite angle. Corner k
         * is opposite to the side ahead of the corner, corner j to the side behind the corner. */
        s->bend = he_vec3_add(
            s->bend, he_vec3_sub(he_vec3_scale(t->along[k], behind * t->cosine[j] / t->sine[j]),
                                 he_vec3_scale(t->along[i], ahead * t->cosine[k] / t->sine[k])));
    }
}

static uint32_t open_fans(const he_mesh *m, uint32_t v)
{
    uint32_t first = m->c.vertex_halfedge[v], h = first, fans = 0;
    do {
        fans += m->c.face[h] == HE_NONE;
        h = m->c.prev[h] ^ 1u;
    } while (h != first);
    return fans;
}

static he_curvature conclude(const he_mesh *m, uint32_t v, const sums *s)
{
    he_curvature c = {NAN, he_saturated(ldexp(s->area, 2 * s->exponent)), NAN, NAN};
    if (m->c.vertex_halfedge[v] == HE_NONE) {
        return c;
    }
    uint32_t fans = open_fans(m, v);
    c.angle_defect = (2 - (double)fans) * HE_PI - s->angle;
    if (fans == 0 && s->area > 0) {
        double mean = he_vec3_length(s->bend) / (4 * s->area);
        mean = he_vec3_dot(s->bend, s->normal) < 0 ? -mean : mean;
        c.mean = he_clamped(ldexp(mean, -s->exponent));
        c.gaussian = he_clamped(ldexp(c.angle_defect / s->area, -2 * s->exponent));
    }
    return c;
}

he_status he_curvatures(const he_mesh *m, const uint32_t *of, size_t count, uint64_t most,
                        he_progress *progress, he_curvature *out, he_error *err)
{
    chosen c;
    bending b = {&c, NULL};
    he_status status = choose(&c, m, HE_VERTEX, of, count, err);
    if (status != HE_OK) {
        goto done;
    }
    b.rows = he_mem_zero(rows_of(&c, m, HE_VERTEX) + 1, sizeof *b.rows);
    if (b.rows == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to sum up curvature");
        goto done;
    }
    status = for_each(m, &c, most, progress, add_bend, &b, err);
    for (uint32_t v = 0; c.all && v < m->c.vertices.issued && status == HE_OK; v++) {
        if (he_vertex_is_live(m, (he_vertex){v})) {
            *out++ = conclude(m, v, &b.rows[v]);
        }
    }
    for (size_t i = 0; !c.all && i < count && status == HE_OK; i++) {
        out[i] = conclude(m, of[i], &b.rows[row_of(&c, of[i])]);
    }
done:
    he_mem_free(b.rows);
    clear(&c);
    return status;
}

/* --- cotangents --- */

typedef struct weighing {
    const he_mesh *m;
    const chosen *chosen;
    double *rows;
} weighing;

static void add_cotangent(const triangle *t, void *context)
{
    weighing *w = context;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        if (!t->is_side[i]) {
            continue;
        }
        uint32_t edge =
            he_find_halfedge(w->m, (he_vertex){t->corner[i]}, (he_vertex){t->corner[j]}).i >> 1;
        uint32_t row = row_of(w->chosen, edge);
        if (row != HE_NONE) {
            w->rows[row] += t->degenerate ? NAN : t->cosine[k] / t->sine[k] / 2;
        }
    }
}

he_status he_edge_cotangents(const he_mesh *m, const uint32_t *of, size_t count, uint64_t most,
                             he_progress *progress, double *out, he_error *err)
{
    chosen c;
    weighing w = {m, &c, NULL};
    he_status status = choose(&c, m, HE_EDGE, of, count, err);
    if (status != HE_OK) {
        goto done;
    }
    w.rows = he_mem_zero(rows_of(&c, m, HE_EDGE) + 1, sizeof *w.rows);
    if (w.rows == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to sum up cotangents");
        goto done;
    }
    status = for_each(m, &c, most, progress, add_cotangent, &w, err);
    for (uint32_t e = 0; c.all && e < m->c.edges.issued && status == HE_OK; e++) {
        if (he_edge_is_live(m, (he_edge){e})) {
            *out++ = w.rows[e];
        }
    }
    for (size_t i = 0; !c.all && i < count && status == HE_OK; i++) {
        out[i] = w.rows[row_of(&c, of[i])];
    }
done:
    he_mem_free(w.rows);
    clear(&c);
    return status;
}
