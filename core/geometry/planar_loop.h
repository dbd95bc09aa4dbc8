/* planar_loop.h - a loop of half-edges, projected into its Newell plane.
 *
 * The normal of the plane is the sum of the cross products of the positions of successive corners
 * (M. E. Newell's method; I. E. Sutherland, R. F. Sproull and R. A. Schumacker, "A characterization
 * of ten hidden-surface algorithms", 1974). This sum is twice the area vector of the loop. So a
 * loop that is not planar is projected in the direction from which it looks largest, and its
 * projection runs counter-clockwise. Coordinates are scaled by a power of two to lie within [-2,
 * 2], so that nothing overflows or underflows, however large or small the mesh is. */
#ifndef HE_GEOMETRY_PLANAR_LOOP_H
#define HE_GEOMETRY_PLANAR_LOOP_H

#include "mesh/walk.h"

typedef struct he_planar_loop {
    uint32_t n;
    uint32_t *halfedge; /* the half-edge that leaves corner i */
    double *x, *y;
    /* true if the loop has no area and so no plane; all coordinates are then zero */
    bool degenerate;
    void *memory; /* one block that contains the arrays */
} he_planar_loop;

/* Projects the loop of half-edge `first` into its plane. he_planar_loop_clear frees the result.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_planar_loop_init(he_planar_loop *flat, const he_mesh *m,
                                           he_halfedge first, he_error *err);
void he_planar_loop_clear(he_planar_loop *flat);

/* A triangle or loop counts as having no area if twice its area, divided by the sum of the squared
 * lengths of its sides, is below this limit. */
#define HE_PLANAR_LOOP_THIN 1e-12

/* Returns true if the triangle of corners a, b, c turns counter-clockwise, by more than rounding
 * errors. */
static inline bool he_planar_loop_turns_left(const he_planar_loop *f, uint32_t a, uint32_t b,
                                             uint32_t c)
{
    double abx = f->x[b] - f->x[a], aby = f->y[b] - f->y[a];
    double acx = f->x[c] - f->x[a], acy = f->y[c] - f->y[a];
    double bcx = acx - abx, bcy = acy - aby;
    double sides = abx * abx + aby * aby + acx * acx + acy * acy + bcx * bcx + bcy * bcy;
    return abx * acy - aby * acx > HE_PLANAR_LOOP_THIN * sides;
}

#endif
