/* check.h - validation: decides whether a mesh satisfies the invariants of mesh.h.
 *
 * Tests I1 to I13 on any content, corrupt links included, in time linear in the mesh. If a link
 * names no live element, only the links are reported: the other tests would have to follow them. */
#ifndef HE_MESH_CHECK_H
#define HE_MESH_CHECK_H

#include "mesh/mesh.h"

enum { HE_PROBLEM_TEXT = 160 };

typedef struct he_problem {
    int rule; /* 1..13 for I1..I13 */
    he_kind kind;
    uint32_t id;
    char text[HE_PROBLEM_TEXT];
} he_problem;

/* Writes up to `capacity` broken invariants to `problems`, and to `*total` how many there are in
 * all (which may exceed capacity; 0 if the mesh is valid). With capacity 1 the check stops at the
 * first.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_check(const he_mesh *mesh, he_problem *problems, size_t capacity,
                                size_t *total, he_error *err);
/* Checks like he_check, with a report of progress between the passes.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_check_with_progress(const he_mesh *mesh, he_progress *progress,
                                              he_problem *problems, size_t capacity, size_t *total,
                                              he_error *err);

#endif
