/* check.h - validation: decides whether a mesh satisfies the invariants of mesh.h.
 *
 * The check tests the invariants I1 to I13 on any mesh, even one with corrupt links, in time linear
 * in the size of the mesh. If a link names an element that is not live, only such links are
 * reported, because the tests of the other invariants follow links. */
#ifndef HE_MESH_CHECK_H
#define HE_MESH_CHECK_H

#include "mesh/mesh.h"

enum { HE_PROBLEM_TEXT = 160 };

typedef struct he_problem {
    int rule; /* number of the broken invariant: 1..13 for I1..I13 */
    he_kind kind;
    uint32_t id;
    char text[HE_PROBLEM_TEXT];
} he_problem;

/* Writes up to `capacity` broken invariants to `problems`, and the number of all broken invariants,
 * which may exceed `capacity`, to *total; 0 means that the mesh is valid. With capacity 1 the check
 * stops at the first broken invariant.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_check(const he_mesh *mesh, he_problem *problems, size_t capacity,
                                size_t *total, he_error *err);
/* Checks like he_check, and reports its progress to `progress` after each pass over the mesh.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_check_with_progress(const he_mesh *mesh, he_progress *progress,
                                              he_problem *problems, size_t capacity, size_t *total,
                                              he_error *err);

#endif
