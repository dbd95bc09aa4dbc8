#include "draw/draw_arrays.h"

#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "geometry/triangulation.h"

#include <assert.h>
#include <string.h>

/* --- the frame --- */

/* Returns the smallest exponent for which 2^exponent is at least `half`, which is half of the
 * longest side of a box. */
static int exponent_of(double half)
{
    int exponent = 0;
    double part = frexp(half, &exponent);
    /* if `part` is 0.5, `half` is a power of two */
    return part == 0.5 ? exponent - 1 : exponent;
}

/* Rounds a number to the nearest multiple of 2^exponent. Numbers so large that they must be such
 * multiples already are returned unchanged, because scaling them could overflow. */
static double snapped(double x, int exponent)
{
    int own = 0;
    (void)frexp(x, &own);
    return own > exponent + 52 ? x : ldexp(rint(ldexp(x, -exponent)), exponent);
}

/* The frame is the box to which the coordinates of a drawing are scaled (draw_arrays.h). An
 * isolated vertex is inside the frame if its distance from the centre of the surface's box is at
 * most FAR times half of the longest side of this box. */
static const double FAR = 4096;

static void include(he_box *box, he_vec3 p)
{
    box->min = (he_vec3){fmin(box->min.x, p.x), fmin(box->min.y, p.y), fmin(box->min.z, p.z)};
    box->max = (he_vec3){fmax(box->max.x, p.x), fmax(box->max.y, p.y), fmax(box->max.z, p.z)};
}

/* Returns half of the vector from one point to another. The points are halved before the
 * subtraction, because the difference of two large doubles may overflow. */
static he_vec3 half_way(he_vec3 from, he_vec3 to)
{
    return he_vec3_sub(he_vec3_scale(to, 0.5), he_vec3_scale(from, 0.5));
}

/* Finds the box that must be inside the frame. Returns false if the mesh has no vertices. */
static bool find_box(const he_mesh *m, he_box *out)
{
    he_box box;
    double half = he_surface_box(m, &box) ? he_vec3_extent(half_way(box.min, box.max)) : 0;
    if (!(half > 0)) {
        return he_mesh_box(m, out);
    }
    *out = box;
    he_vec3 center = he_vec3_add(he_vec3_scale(box.min, 0.5), he_vec3_scale(box.max, 0.5));
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        he_vec3 p = m->c.position[v];
        if (m->c.vertex_halfedge[v] == HE_NONE &&
            he_vec3_extent(half_way(center, p)) <= 0.5 * FAR * half) {
            include(out, p);
        }
    }
    return true;
}

/* Returns the frame (origin and scale) of the coordinates in which a mesh is drawn. On each axis,
 * half of the box's side is at most 2^e, and the origin of the frame is at most 2^(e - 3) from the
 * centre of the box. So positions scaled by 2^-(e + 1) are at most 9/16 from 0 on each axis, and
 * lie within the unit ball. */
he_frame he_frame_of(const he_mesh *m)
{
    he_box box;
    if (!find_box(m, &box)) {
        return (he_frame){{0, 0, 0}, 1};
    }
    he_vec3 center = he_vec3_add(he_vec3_scale(box.min, 0.5), he_vec3_scale(box.max, 0.5));
    double half = he_vec3_extent(half_way(box.min, box.max));
    if (!(half > 0)) {
        return (he_frame){box.min, 1};
    }
    int e = exponent_of(half), most = 0;
    (void)frexp(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)), &most);
    /* If a box is small but far from zero, a scale that fits its size would make its coordinates
     * overflow. So the largest coordinate limits the scale. */
    e = e < most - 900 ? most - 900 : e;
    e = e < -1022 ? -1022 : e;
    he_vec3 origin = {snapped(center.x, e - 2), snapped(center.y, e - 2), snapped(center.z, e - 2)};
    return (he_frame){origin, ldexp(1, -(e + 1))};
}

/* Returns the position of a corner in the coordinates of the frame. Scaling before the subtraction
 * avoids an overflow. */
static he_vec3 place(const he_draw_arrays *d, uint32_t halfedge)
{
    he_vec3 p = he_position(d->mesh, he_origin(d->mesh, (he_halfedge){halfedge}));
    return he_vec3_sub(he_vec3_scale(p, d->frame.scale),
                       he_vec3_scale(d->frame.origin, d->frame.scale));
}

/* --- faces that are drawn as fans of triangles --- */

/* A triangle counts as degenerate if twice its area is at most THIN times the sum of its squared
 * sides. planar_loop.c uses an equal limit, so the two files agree on which triangles are
 * degenerate. */
static const double THIN = 1e-12;

/* Returns true if the triangle with corners 0, u and v is counter-clockwise as seen from the side
 * to which `normal` points. `length` is the length of `normal`. */
static bool turns(he_vec3 u, he_vec3 v, he_vec3 normal, double length)
{
    he_vec3 w = he_vec3_sub(v, u);
    double sides = he_vec3_dot(u, u) + he_vec3_dot(v, v) + he_vec3_dot(w, w);
    return he_vec3_dot(he_vec3_cross(u, v), normal) > THIN * sides * length;
}

/* Returns the Newell normal of the loop of half-edge `first` (twice the vector area of the
 * polygon), and sets *degree to its number of corners. */
static he_vec3 normal_of(const he_draw_arrays *d, uint32_t first, uint32_t *degree)
{
    he_vec3 base = place(d, first), normal = {0, 0, 0}, u = {0, 0, 0};
    *degree = 1;
    for (uint32_t h = d->mesh->c.next[first]; h != first; h = d->mesh->c.next[h]) {
        he_vec3 v = he_vec3_sub(place(d, h), base);
        normal = he_vec3_add(normal, he_vec3_cross(u, v));
        u = v;
        ++*degree;
    }
    return normal;
}

static bool is_fan(const he_draw_arrays *d, uint32_t first, he_vec3 normal)
{
    const uint32_t *next = d->mesh->c.next;
    double length = he_vec3_length(normal);
    he_vec3 base = place(d, first), u = he_vec3_sub(place(d, next[first]), base);
    for (uint32_t h = next[next[first]]; h != first; h = next[h]) {
        he_vec3 v = he_vec3_sub(place(d, h), base);
        if (!turns(u, v, normal, length)) {
            return false;
        }
        u = v;
    }
    return true;
}

/* Returns the corner of a quadrilateral at which its diagonal begins. If the two diagonals are
 * about equally long, it is the first corner, so that all faces of a regular mesh are divided in
 * one direction. */
static uint32_t apex_of_quad(const he_draw_arrays *d, uint32_t first)
{
    static const double CLEARLY = 1 - 1e-6;
    const uint32_t *next = d->mesh->c.next;
    uint32_t h[4] = {first, next[first], next[next[first]], next[next[next[first]]]};
    he_vec3 p[4];
    for (int i = 0; i < 4; i++) {
        p[i] = place(d, h[i]);
    }
    he_vec3 across = he_vec3_sub(p[2], p[0]), other = he_vec3_sub(p[3], p[1]);
    he_vec3 normal = he_vec3_cross(across, other);
    double length = he_vec3_length(normal);
    int bad[2] = {0, 0};
    for (int i = 0; i < 4; i++) {
        int k = (i + 1) % 4, l = (i + 2) % 4;
        /* The triangle i, k, l is made by the diagonal from corner 0 if k is odd, by the diagonal
         * from corner 1 if k is even. */
        bad[k % 2 == 0] += !turns(he_vec3_sub(p[k], p[i]), he_vec3_sub(p[l], p[i]), normal, length);
    }
    if (bad[0] != bad[1]) {
        return bad[0] < bad[1] ? h[0] : h[1];
    }
    return he_vec3_dot(other, other) < CLEARLY * he_vec3_dot(across, across) ? h[1] : h[0];
}

/* --- faces that are not drawn as fans --- */

static uint32_t side(uint32_t a, uint32_t b, uint32_t n, unsigned bit)
{
    return (uint32_t)(a + 1 == b || (a + 1 == n && b == 0)) << (HE_DRAWN_SIDES + bit);
}

static he_status cut(he_draw_arrays *d, uint32_t face, he_error *err)
{
    he_triangulation t;
    he_halfedge first = {d->mesh->c.face_halfedge[face]};
    he_status status = he_triangulation_make(d->mesh, first, HE_ANY_DIAGONALS, NULL, &t, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t n = t.flat.n;
    size_t need = d->cut_rows + n - 2;
    if (need > d->cut_capacity) {
        size_t grown = he_mem_grown(d->cut_capacity, need);
        uint32_t *rows = he_mem_array(d->cut, grown, HE_DRAWN_ROW * sizeof *rows);
        if (rows == NULL) {
            he_triangulation_clear(&t);
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the triangles of a face");
        }
        d->cut = rows;
        d->cut_capacity = grown;
    }
    for (uint32_t k = 0; k + 2 < n; k++) {
        const uint32_t *corner = t.corners + 3 * (size_t)k;
        uint32_t *row = d->cut + HE_DRAWN_ROW * d->cut_rows++;
        row[3] = face;
        for (unsigned i = 0; i < 3; i++) {
            row[i] = d->mesh->c.origin[t.flat.halfedge[corner[i]]];
            row[3] |= side(corner[i], corner[(i + 1) % 3], n, i);
        }
    }
    he_triangulation_clear(&t);
    return HE_OK;
}

/* --- faces of both kinds, drawn as fans or not --- */

void he_draw_arrays_clear(he_draw_arrays *drawing)
{
    he_mem_free(drawing->cut);
    *drawing = (he_draw_arrays){.mesh = NULL};
}

/* Triangulates a face, unless it can be drawn as a fan of triangles from its first corner.
 * Subtracts the cost of the triangulation from *most, the number of steps that are allowed. */
static he_status prepare(he_draw_arrays *d, uint32_t face, uint64_t *most, he_error *err)
{
    const uint32_t *next = d->mesh->c.next;
    uint32_t first = d->mesh->c.face_halfedge[face], degree;
    uint32_t fourth = next[next[next[first]]];
    if (fourth == first || next[fourth] == first) {
        return HE_OK; /* a triangle or quadrilateral is always drawn as a fan */
    }
    he_vec3 normal = normal_of(d, first, &degree);
    if (is_fan(d, first, normal)) {
        return HE_OK;
    }
    uint64_t most_of_each = degree < HE_EXACT_CORNERS ? degree : HE_EXACT_CORNERS;
    uint64_t cost = most_of_each * degree;
    if (cost > *most) {
        return he_fail(err, HE_LIMIT, HE_FACE, face,
                       "face %u has %u corners, too many to triangulate", face, degree);
    }
    *most -= cost;
    return cut(d, face, err);
}

static he_status check_ids(const he_mesh *m, he_error *err)
{
    uint32_t faces = m->c.faces.issued;
    if (faces > (uint32_t)1 << HE_DRAWN_SIDES) {
        return he_fail(
            err, HE_IDS_EXHAUSTED, HE_FACE, faces - 1,
            "the id of face %u needs more than %d bits, so the mesh cannot be drawn: compact it",
            faces - 1, HE_DRAWN_SIDES);
    }
    return HE_OK;
}

he_status he_draw_arrays_init(he_draw_arrays *drawing, const he_mesh *m, const he_frame *frame,
                              he_error *err)
{
    he_draw_arrays d = {.mesh = m, .frame = *frame};
    he_status status = check_ids(m, err);
    uint64_t most = UINT64_MAX;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        if (m->c.face_halfedge[f] != HE_DEAD) {
            status = prepare(&d, f, &most, err);
        }
    }
    if (status != HE_OK) {
        he_draw_arrays_clear(&d);
        return status;
    }
    *drawing = d;
    return HE_OK;
}

he_status he_draw_arrays_init_faces(he_draw_arrays *drawing, const he_mesh *m,
                                    const he_frame *frame, const uint32_t *faces, size_t count,
                                    uint64_t most, he_error *err)
{
    he_draw_arrays d = {.mesh = m, .frame = *frame};
    he_status status = check_ids(m, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        status = prepare(&d, faces[i], &most, err);
    }
    if (status != HE_OK) {
        he_draw_arrays_clear(&d);
        return status;
    }
    *drawing = d;
    return HE_OK;
}

void he_draw_arrays_vertex(const he_draw_arrays *d, uint32_t id, float out[HE_DRAWN_ROW])
{
    uint32_t halfedge = d->mesh->c.vertex_halfedge[id];
    memset(out, 0, HE_DRAWN_ROW * sizeof *out);
    if (halfedge == HE_DEAD) {
        return;
    }
    he_vec3 p = he_vec3_sub(he_vec3_scale(d->mesh->c.position[id], d->frame.scale),
                            he_vec3_scale(d->frame.origin, d->frame.scale));
    if (!(he_vec3_dot(p, p) <= 1)) {
        he_vec3_normalise(half_way(d->frame.origin, d->mesh->c.position[id]), &p);
    }
    out[0] = (float)p.x;
    out[1] = (float)p.y;
    out[2] = (float)p.z;
    out[3] = halfedge == HE_NONE ? HE_DRAWN_ISOLATED : HE_DRAWN_USED;
}

/* Returns the first of the triangles into which prepare() has divided a face, or NULL if the face
 * is drawn as a fan. */
static const uint32_t *find_cut(const he_draw_arrays *d, uint32_t face)
{
    const uint32_t mask = ((uint32_t)1 << HE_DRAWN_SIDES) - 1;
    size_t low = 0, high = d->cut_rows;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((d->cut[HE_DRAWN_ROW * middle + 3] & mask) < face) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    bool found = low < d->cut_rows && (d->cut[HE_DRAWN_ROW * low + 3] & mask) == face;
    return found ? d->cut + HE_DRAWN_ROW * low : NULL;
}

void he_draw_arrays_begin(const he_draw_arrays *d, uint32_t face, he_draw_arrays_walk *walk)
{
    const he_content *c = &d->mesh->c;
    uint32_t first = c->face_halfedge[face];
    walk->face = face;
    walk->left = he_face_degree(d->mesh, (he_face){face}) - 2;
    walk->cut = walk->left > 2 ? find_cut(d, face) : NULL;
    walk->apex = walk->left == 2 ? apex_of_quad(d, first) : first;
    walk->at = c->next[walk->apex];
}

bool he_draw_arrays_next(const he_draw_arrays *d, he_draw_arrays_walk *walk,
                         uint32_t out[HE_DRAWN_ROW])
{
    if (walk->left == 0) {
        return false;
    }
    walk->left--;
    if (walk->cut != NULL) {
        memcpy(out, walk->cut, HE_DRAWN_ROW * sizeof *out);
        walk->cut += HE_DRAWN_ROW;
        return true;
    }
    const he_content *c = &d->mesh->c;
    uint32_t from = walk->at, to = c->next[from];
    out[0] = c->origin[walk->apex];
    out[1] = c->origin[from];
    out[2] = c->origin[to];
    out[3] = walk->face | (uint32_t)1 << (HE_DRAWN_SIDES + 1);
    out[3] |= (uint32_t)(c->next[walk->apex] == from) << HE_DRAWN_SIDES;
    out[3] |= (uint32_t)(c->next[to] == walk->apex) << (HE_DRAWN_SIDES + 2);
    walk->at = to;
    return true;
}
