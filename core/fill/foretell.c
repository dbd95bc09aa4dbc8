/* foretell.c - how many faces will fill a hole, before any is made, and the limits of their number.
 */
#include "fill/patch.h"

#include "geometry/geometry.h"
#include "mesh/layout.h"

/* --- limits --- */

double he_fill_most(const he_mesh *m)
{
    return fmax(HE_FILL_ALL_FACES, he_mesh_faces(m));
}

he_status he_fill_within(double faces, double edge_length, he_error *err)
{
    if (faces <= HE_FILL_FACES) {
        return HE_OK;
    }
    if (!isfinite(faces)) {
        return he_fail_plain(err, HE_LIMIT,
                             "edge_length %.3g would fill a hole with more than %d faces",
                             edge_length, (int)HE_FILL_FACES);
    }
    return he_fail_plain(err, HE_LIMIT,
                         "edge_length %.3g would fill a hole with about %.3g faces, and at most %d "
                         "are allowed: it must be about %.3g or more",
                         edge_length, faces, (int)HE_FILL_FACES,
                         edge_length * sqrt(faces / HE_FILL_FACES));
}

he_status he_fill_within_all(double faces, double left, he_error *err)
{
    return faces > left ? he_fail_plain(err, HE_LIMIT,
                                        "all holes together would be filled with more than %d "
                                        "faces, and more than the mesh has: give a larger "
                                        "edge_length, or leave holes by max_edges or max_size",
                                        (int)HE_FILL_ALL_FACES)
                        : HE_OK;
}

/* --- one hole --- */

/* Returns how many equilateral triangles with edges of length 1 have this area: one has the area
 * sqrt(3) / 4. */
static double triangles_of(double area)
{
    static const double OF_ONE = 0.43301270189221932;
    return area / OF_ONE;
}

/* No surface that fills a hole is smaller than the area of its boundary's projection on any plane,
 * which is largest on the plane at right angles to the sum of cross products that is computed here.
 * The area is in units of the square of `unit`. */
typedef struct rim {
    double edges, area;
    double mean_square; /* of the lengths of its edges */
} rim;

static rim measure(const he_mesh *m, he_halfedge h, double unit, uint64_t *steps)
{
    rim found = {.edges = 0};
    he_vec3 sum = {0, 0, 0}, last = {0, 0, 0};
    const he_vec3 base = he_vec3_scale(he_position(m, he_origin(m, h)), 1 / unit);
    he_halfedge k = h;
    do {
        k = he_next(m, k);
        /* is divided first: the difference of two positions may be larger than the largest
         * double */
        const he_vec3 scaled = he_vec3_scale(he_position(m, he_origin(m, k)), 1 / unit);
        const he_vec3 at = he_vec3_sub(scaled, base), edge = he_vec3_sub(at, last);
        sum = he_vec3_add(sum, he_vec3_cross(last, at));
        found.mean_square += he_vec3_dot(edge, edge);
        found.edges++;
        last = at;
        --*steps;
    } while (k.i != h.i && *steps > 0);
    found.area = he_vec3_length(sum) / 2;
    found.mean_square /= found.edges;
    return found;
}

double he_fill_foretell(const he_mesh *m, he_halfedge h, const he_smooth_fill *options,
                        uint64_t *steps)
{
    static const double MANY = 50000, FOR_EACH_EDGE = 8;
    const bool asked = options->edge_length > 0;
    if (*steps == 0 || h.i >= he_mesh_issued(m, HE_HALFEDGE) ||
        !he_edge_is_live(m, he_edge_of(h)) || !he_is_boundary_halfedge(m, h)) {
        return 0;
    }
    const rim found = measure(m, h, asked ? options->edge_length : 1, steps);
    const double even = triangles_of(found.area / (asked ? 1 : found.mean_square));
    /* without a wanted length, edges grow inwards in a hole that would get more */
    const double faces = asked || even <= MANY ? even : FOR_EACH_EDGE * found.edges;
    return isfinite(faces) ? fmax(faces, found.edges - 2) : 0;
}

/* --- all holes --- */

/* Returns the mean length of the boundary edges among a few thousand edges; that of all of these if
 * none is a boundary edge; 0 if there are no edges. */
static double sample_length(const he_mesh *m)
{
    enum { SAMPLES = 4096 };
    const uint32_t issued = he_mesh_issued(m, HE_EDGE), stride = issued / SAMPLES + 1;
    double sums[2] = {0, 0}, counts[2] = {0, 0};
    for (uint32_t e = 0; e < issued; e += stride) {
        if (he_edge_is_live(m, (he_edge){e})) {
            const bool boundary = he_is_boundary_edge(m, (he_edge){e});
            sums[boundary] += he_edge_length(m, (he_edge){e});
            counts[boundary]++;
        }
    }
    const int which = counts[1] > 0;
    return counts[which] > 0 ? sums[which] / counts[which] : 0;
}

/* Returns about how many faces fill a round hole, whose edges have the length 1. No surface of
 * least area is larger than that of a circle as long as its boundary, and a triangle of the wanted
 * length has the area sqrt(3) / 4 of its square. */
static double foretell_round(double edges, double edge_length)
{
    static const double OF_SQUARE = 1 / (4 * 3.14159265358979323846);
    /* without a wanted length, edges grow inwards in a hole that would get more */
    static const double MANY = 50000, FOR_EACH_EDGE = 8;
    const double wanted = edge_length > 0 ? edge_length : 1;
    const double even = triangles_of(OF_SQUARE * (edges / wanted) * (edges / wanted));
    const double growing = fmax(MANY, FOR_EACH_EDGE * edges);
    return edges + (edge_length > 0 ? fmin(even, HE_FILL_FACES) : fmin(even, growing));
}

double he_fill_holes_foretell(const he_mesh *m, const he_fill_holes_options *options)
{
    const double edges = he_mesh_boundary_halfedges(m);
    const bool limited = options->max_edges > 0 && options->max_edges < edges;
    const double each = limited ? options->max_edges : edges;
    if (edges <= 0 || options->method != HE_FILL_ALL_SMOOTH) {
        return edges; /* no other method makes more faces than a hole has edges */
    }
    const double length = options->smooth.edge_length > 0 ? sample_length(m) : 0;
    const double wanted = length > 0 ? options->smooth.edge_length / length : 0;
    return fmin(edges / each * foretell_round(each, wanted), he_fill_most(m));
}
