/* smooth.h - moves vertices so that a surface becomes smoother; its links do not change.
 *
 * METHODS. Each does the same again in every step:
 *
 *     laplacian   An implicit step of the flow that moves each point by the Laplacian of its
 *                 position, for the time `time` in square units of the mesh (Desbrun, Meyer,
 *                 Schroeder and Barr, Implicit fairing of irregular meshes using diffusion and
 *                 curvature flow, 1999). The weights are those of the intrinsic Delaunay
 *                 triangulation (core/solve), so thin triangles do no harm. A sphere of radius 1
 *                 shrinks by the factor 1 / (1 + 2 time).
 *     taubin      Towards the mean of the neighbours by a half, and then away from it by a little
 *                 more, so that the surface hardly shrinks (Taubin, A signal processing approach to
 *                 fair surface design, 1995). A mode of the graph with the frequency k is
 * multiplied by (1 - k / 2) (1 + k / 1.9). bilateral   The normals of faces become the mean of
 * those of the faces around them, weighted by area, distance and likeness; then the vertices follow
 * the normals. Sharp edges stay sharp (Zheng, Fu, Au and Tai, Bilateral normal filtering for mesh
 * denoising, 2011). tangential  Each vertex moves along the surface, half of the way to the mean of
 * the centres of its faces, weighted by area: triangles become more even, and the shape stays.
 *
 * WHAT STAYS. Vertices of boundaries and of edges that are marked `feature`, locked vertices and
 * vertices of locked edges and faces, vertices without faces, and those that are not listed. */
#ifndef HE_SMOOTH_SMOOTH_H
#define HE_SMOOTH_SMOOTH_H

#include "mesh/mesh.h"

enum { HE_SMOOTH_STEPS = 1000, HE_SMOOTH_STEPS_USUAL = 5 };

typedef enum he_smooth_method {
    HE_SMOOTH_LAPLACIAN,
    HE_SMOOTH_TAUBIN,
    HE_SMOOTH_BILATERAL,
    HE_SMOOTH_TANGENTIAL,
    HE_SMOOTH_METHODS
} he_smooth_method;

typedef struct he_smooth_options {
    he_smooth_method method;
    unsigned steps; /* 1 to HE_SMOOTH_STEPS */
    /* The time of a step of laplacian, above 0. 0 stands for a tenth of the square of the mean
     * length that the edges at the vertices that may move have before the step. */
    double time;
    bool keep_volume;         /* after the steps, the surface is moved along its normals until its
                                 volume is that from before */
    const uint32_t *vertices; /* the vertices that may move; NULL stands for all */
    size_t vertex_count;
} he_smooth_options;

typedef struct he_smoothed {
    uint32_t moved;       /* vertices with another position */
    double largest, mean; /* how far these vertices moved */
    double volume;        /* by how much the volume grew; 0 if the surface is not closed */
} he_smoothed;

/* smooth: V, E and F stay.
 *
 * `out` may be NULL.
 * Returns HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT or HE_REPEATED_ELEMENT if a listed vertex is not
 * live or is listed twice.
 * Returns HE_NOT_TRIANGLE naming a face, if a face of a vertex that may move is no triangle; taubin
 * takes any faces.
 * Returns HE_BOUNDARY_EDGE naming an edge, if the volume of a surface with a boundary is to be
 * kept. Returns HE_BAD_VALUE if an option is outside its range. Returns HE_NOT_FINITE if a vertex
 * would have a position that is not finite. Returns HE_LIMIT if the system of equations would be
 * too large, HE_CANCELLED if the work was cancelled, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_smooth(he_mesh *m, const he_smooth_options *options, he_smoothed *out,
                                 he_error *err);

#endif
