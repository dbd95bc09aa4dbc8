/* deform.h - moves some vertices, the handles, to given points; the surface follows.
 *
 * VERTICES. Each vertex has one of these parts:
 *
 *     handle     it moves to its goal
 *     fixed      it stays: vertices that are listed as fixed, locked vertices, and vertices of
 *                locked edges and faces, unless they are handles
 *     free       it follows: vertices that are connected with a handle by edges between free ones
 *     the rest   it stays: vertices behind fixed ones, and of components without a handle
 *
 * METHODS.
 *
 *     arap        The surface is bent as little as possible: around each vertex it should be moved
 *                 rigidly (Sorkine and Alexa, As-rigid-as-possible surface modeling, 2007). With
 *                 the old positions p and the new ones q,
 *
 *                     energy = sum of w |(q_i - q_j) - R_i (p_i - p_j)|^2
 *
 *                 over all pairs of neighbours i and j, of which R_i is a rotation for i. It starts
 *                 with one rotation for all, the one that fits the handles and the fixed vertices
 *                 best. Each step chooses the rotations for the positions, and then the positions
 *                 for the rotations, so the energy never grows.
 *     biharmonic  The Laplacian of the Laplacian of the displacement is 0. The surface does not
 *                 turn with its handles, but there is one system of equations to solve only, and
 *                 the displacement is smooth at the handles and fixed vertices.
 *
 * The weights w and the neighbours are those of the intrinsic Delaunay triangulation (core/solve),
 * so thin triangles do no harm. Faces with more than three corners are cut into fans of triangles
 * for it; the mesh keeps them. If all handles and fixed vertices of a component move by the same
 * translation, so does all that is free, and with arap it also follows the same rotation. */
#ifndef HE_DEFORM_DEFORM_H
#define HE_DEFORM_DEFORM_H

#include "base/progress.h"
#include "mesh/mesh.h"

enum { HE_DEFORM_STEPS = 1000, HE_DEFORM_STEPS_USUAL = 10 };

/* The most neighbours of a vertex with biharmonic: its equations join each of them with each other
 * one, so the time grows with the third power of their number. */
enum { HE_DEFORM_NEIGHBOURS = 4096 };

typedef enum he_deform_method {
    HE_DEFORM_ARAP,
    HE_DEFORM_BIHARMONIC,
    HE_DEFORM_METHODS
} he_deform_method;

/* Which vertices are handles, which are fixed, and how the free ones follow. */
typedef struct he_deform_sets {
    he_deform_method method;
    const uint32_t *handles;
    size_t handle_count;
    const uint32_t *fixed;
    size_t fixed_count;
} he_deform_sets;

/* Where the handles go: one of the pointers is not NULL. */
typedef struct he_deform_goal {
    const he_vec3 *to;    /* points */
    const he_vec3 *by;    /* vectors to add to the positions */
    size_t count;         /* of points or vectors: 1 for all handles, or one for each handle */
    const double *matrix; /* 16 numbers, row by row, for all handles; the last row is 0 0 0 1 */
} he_deform_goal;

typedef struct he_deformed {
    uint32_t moved;       /* vertices with another position */
    double largest, mean; /* how far these vertices moved, at most DBL_MAX */
    double energy;        /* that of arap, in square units of the mesh, at most DBL_MAX; 0 with
                             biharmonic */
} he_deformed;

/* deform: V, E and F stay. No attribute changes, not even normals. `steps` is the number of steps
 * of arap, 1 to HE_DEFORM_STEPS.
 *
 * `out` may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if a listed vertex is not live.
 * Returns HE_REPEATED_ELEMENT if a vertex is listed twice, in one list or in both.
 * Returns HE_LOCKED_ELEMENT if a handle that is locked would move.
 * Returns HE_BAD_VALUE if there is no handle, if `steps` is outside its range, if the goal has
 * another number of points than there are handles, if the last row of the matrix is not 0 0 0 1, or
 * if the triangles are so thin that the system of equations has no solution.
 * Returns HE_NOT_FINITE if a vertex would have a position that is not finite.
 * Returns HE_LIMIT if a vertex has more than HE_DEFORM_NEIGHBOURS neighbours, with biharmonic, or
 * if the patch of free vertices is too large for one system of equations. Returns HE_CANCELLED if
 * the mesh's progress is cancelled, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_deform(he_mesh *m, const he_deform_sets *sets, const he_deform_goal *goal,
                                 unsigned steps, he_deformed *out, he_error *err);

/* --- the parts of he_deform, for a preview that is computed often for other goals --- */

/* The factored system of equations of a mesh, with its handles and fixed vertices. It keeps no
 * pointer to the mesh or to the lists. */
typedef struct he_deformer he_deformer;

/* Checks the lists. Returns HE_BAD_VALUE, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
 * HE_REPEATED_ELEMENT or HE_NO_MEMORY as he_deform does. */
HE_NODISCARD he_status he_deform_check(const he_mesh *m, const he_deform_sets *sets, he_error *err);

/* Makes the system, for lists that were checked. Returns HE_BAD_VALUE, HE_LIMIT, HE_CANCELLED or
 * HE_NO_MEMORY as he_deform does. */
HE_NODISCARD he_status he_deformer_make(const he_mesh *m, const he_deform_sets *sets,
                                        he_progress *progress, he_deformer **out, he_error *err);
void he_deformer_free(he_deformer *d);
size_t he_deformer_bytes(const he_deformer *d);
/* Returns the free vertices, ascending. */
const uint32_t *he_deformer_vertices(const he_deformer *d, uint32_t *count);

/* Computes the points of the handles, in their order. `out` has sets->handle_count entries. The
 * handles must be live. Returns HE_BAD_VALUE, HE_NOT_FINITE or HE_LOCKED_ELEMENT as he_deform does;
 * `out` has then no meaning. */
HE_NODISCARD he_status he_deform_goals(const he_mesh *m, const he_deform_sets *sets,
                                       const he_deform_goal *goal, he_vec3 *out, he_error *err);

/* A question to a deformer, and its answer. */
typedef struct he_deform_motion {
    const he_vec3 *goals; /* the points of the handles, in their order */
    unsigned steps;       /* of arap */
    he_vec3
        *positions; /* room for those of the free vertices, as he_deformer_vertices lists them */
    double energy;  /* as in he_deformed */
} he_deform_motion;

/* Computes the new positions of the free vertices, and the energy. The deformer does not change, so
 * several threads may use it.
 * Returns HE_BAD_VALUE if `steps` is outside its range, HE_NOT_FINITE, HE_CANCELLED or
 * HE_NO_MEMORY; the answer has then no meaning. */
HE_NODISCARD he_status he_deformer_solve(const he_deformer *d, he_deform_motion *motion,
                                         he_progress *progress, he_error *err);

#endif
