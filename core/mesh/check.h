/* check.h - is a mesh what mesh.h promises?
 *
 * Tests the invariants I1 to I13 on any content whatever, corrupt links included, in time linear in
 * the mesh. Links that name nothing are reported alone: the other tests could not follow them. */
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

/* Write up to `capacity` broken invariants to `problems` and how many there are in all to `*total`
 * (which may exceed capacity). With capacity 1 it stops at the first. Fails only with
 * HE_NO_MEMORY. A mesh that passes gives total 0. */
HE_NODISCARD he_status he_check(const he_mesh *mesh, he_problem *problems, size_t capacity,
                                size_t *total, he_error *err);
/* he_check for work that is watched: it can also fail with HE_CANCELLED, between its passes. */
HE_NODISCARD he_status he_check_watched(const he_mesh *mesh, he_watch *watch, he_problem *problems,
                                        size_t capacity, size_t *total, he_error *err);

#endif
