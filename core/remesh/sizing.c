#include "remesh/sizing.h"

#include "geometry/scale.h"

static void add(he_bending *to, const he_bending *of)
{
    to->xx += of->xx;
    to->xy += of->xy;
    to->xz += of->xz;
    to->yy += of->yy;
    to->yz += of->yz;
    to->zz += of->zz;
    to->area += of->area;
}

static he_vec3 area_of(const he_net *n, uint32_t t)
{
    const uint32_t *v = n->triangles[t].v;
    he_vec3 a = he_net_place(n, v[0]);
    return he_vec3_cross(he_vec3_sub(he_net_place(n, v[1]), a),
                         he_vec3_sub(he_net_place(n, v[2]), a));
}

void he_sizing_bend(he_vec3 way, he_vec3 left, he_vec3 right, he_bending *to)
{
    he_vec3 along;
    if (he_vec3_normalise(way, &along)) {
        double sine = he_vec3_dot(he_vec3_cross(left, right), along);
        double bend = 0.5 * atan2(sine, he_vec3_dot(left, right)) * he_vec3_length(way);
        const he_bending half = {bend * along.x * along.x,
                                 bend * along.x * along.y,
                                 bend * along.x * along.z,
                                 bend * along.y * along.y,
                                 bend * along.y * along.z,
                                 bend * along.z * along.z,
                                 0};
        add(to, &half);
    }
}

/* Adds half of an edge to the tensors of each of its ends. */
static void add_edge(const he_net *n, uint32_t c, he_bending *of)
{
    uint32_t twin = he_net_twin(n, c), from = he_net_origin(n, c), to = he_net_target(n, c);
    he_vec3 left, right;
    he_vec3 way = he_vec3_sub(he_net_place(n, to), he_net_place(n, from));
    if (he_vec3_normalise(area_of(n, c >> 2), &left) &&
        he_vec3_normalise(area_of(n, twin >> 2), &right)) {
        he_sizing_bend(way, left, right, &of[from]);
        he_sizing_bend(way, left, right, &of[to]);
    }
}

static he_status find_tensors(const he_net *n, he_bending *of, he_progress *progress, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t t = 0; t < n->triangle_count && status == HE_OK; t++) {
        status = he_progress_at(progress, t + 1, n->triangle_count, err);
        double third = he_vec3_length(area_of(n, t)) / 6;
        for (uint32_t c = 4 * t; c < 4 * t + 3; c++) {
            uint32_t twin = he_net_twin(n, c);
            of[he_net_origin(n, c)].area += third;
            if (twin != HE_NONE && c < twin && !he_net_is_held(n, c)) {
                add_edge(n, c, of);
            }
        }
    }
    return status;
}

/* Adds to the tensor of each vertex those of its neighbours, except across held edges. */
static void gather_tensors(const he_net *n, const he_bending *of, he_bending *to)
{
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        to[v] = of[v];
    }
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        if ((c & 3) != 3 && !he_net_is_held(n, c)) {
            add(&to[he_net_origin(n, c)], &of[he_net_target(n, c)]);
        }
    }
}

/* Returns the greatest magnitude of the curvatures. One of the three eigenvalues, that in the
 * direction of the normal, is nearly zero, so the others follow from the trace and the sum of the
 * squares. */
static double greatest(const he_bending *t)
{
    if (!(t->area > 0)) {
        return 0;
    }
    double trace = (t->xx + t->yy + t->zz) / t->area;
    double squares = (t->xx * t->xx + t->yy * t->yy + t->zz * t->zz +
                      2 * (t->xy * t->xy + t->xz * t->xz + t->yz * t->yz)) /
                     t->area / t->area;
    return 0.5 * (fabs(trace) + sqrt(fmax(2 * squares - trace * trace, 0)));
}

/* Returns the wanted length where a surface has this curvature. */
static double length_for(double curvature, const he_sizing *s)
{
    double square = curvature > 0 ? 6 * s->error / curvature - 3 * s->error * s->error : HUGE_VAL;
    double length = square > 0 ? sqrt(square) : 0;
    return fmin(fmax(length, s->least), s->most);
}

double he_sizing_length(const he_bending *of, const he_sizing *s)
{
    return length_for(greatest(of), s);
}

/* Shortens the wanted lengths at the vertices inside lines that are curved. */
static void follow_lines(he_net *n, const he_sizing *s)
{
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        uint32_t line = (c & 3) == 3 ? HE_NONE : he_net_line_of(n, c);
        uint32_t v = line == HE_NONE ? HE_NONE : he_net_origin(n, c);
        if (v == HE_NONE || !he_net_has(n, v, HE_NET_LINE)) {
            continue;
        }
        const he_net_line *of = &n->lines.line[line];
        const double *arcs = n->lines.arc + of->first;
        const he_vec3 *points = n->lines.point + of->first;
        uint32_t low = 1, high = of->count - 2;
        while (low < high) {
            uint32_t middle = low + (high - low) / 2;
            if (arcs[middle] < n->arc[v]) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        he_vec3 in = he_vec3_sub(points[low], points[low - 1]);
        he_vec3 out = he_vec3_sub(points[low + 1], points[low]);
        double half = 0.5 * (arcs[low + 1] - arcs[low - 1]);
        double length = length_for(half > 0 ? he_vec3_angle(in, out) / half : 0, s);
        n->vertices[v].size = fminf(n->vertices[v].size, (float)length);
    }
}

/* The most sweeps over all edges, in alternating directions, that make lengths change slowly. */
enum { SWEEPS = 24 };

static bool limit_slope(he_net *n, uint32_t c)
{
    he_net_vertex *a = &n->vertices[he_net_origin(n, c)], *b = &n->vertices[he_net_target(n, c)];
    double rise = HE_SIZING_SLOPE * he_vec3_length(he_vec3_sub(b->p, a->p));
    float most_a = b->size + (float)rise, most_b = a->size + (float)rise;
    bool any = a->size > most_a || b->size > most_b;
    a->size = fminf(a->size, most_a);
    b->size = fminf(b->size, most_b);
    return any;
}

static he_status limit_slopes(he_net *n, he_progress *progress, he_error *err)
{
    uint32_t count = n->triangle_count;
    he_status status = HE_OK;
    bool any = true;
    for (unsigned sweep = 0; sweep < SWEEPS && any && status == HE_OK; sweep++) {
        any = false;
        for (uint32_t i = 0; i < count && status == HE_OK; i++) {
            uint32_t t = sweep % 2 == 0 ? i : count - 1 - i;
            status = he_progress_at(progress, i + 1, count, err);
            for (uint32_t c = 4 * t; c < 4 * t + 3; c++) {
                any |= limit_slope(n, c);
            }
        }
    }
    return status;
}

he_status he_sizing_find(he_net *n, const he_sizing *sizing, he_progress *progress, he_error *err)
{
    he_bending *own = he_mem_zero((size_t)n->vertex_count + 1, sizeof *own);
    he_bending *sum = he_mem_array(NULL, (size_t)n->vertex_count + 1, sizeof *sum);
    he_status status = HE_OK;
    if (own == NULL || sum == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the curvature at %u vertices",
                               n->vertex_count);
    }
    if (status == HE_OK) {
        status = find_tensors(n, own, progress, err);
    }
    if (status == HE_OK) {
        gather_tensors(n, own, sum);
        for (uint32_t v = 0; v < n->vertex_count; v++) {
            n->vertices[v].size = (float)he_sizing_length(&sum[v], sizing);
        }
        follow_lines(n, sizing);
        status = limit_slopes(n, progress, err);
    }
    he_mem_free(own);
    he_mem_free(sum);
    return status;
}
