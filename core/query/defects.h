/* defects.h - what a valid mesh may have and its owner may not want.
 *
 *     bowtie                a vertex of two fans or more; `value` is how many
 *     isolated_vertex       a vertex without an edge
 *     duplicate_position    a vertex no farther than `merge` from an earlier one that is not itself
 *                           listed, which is `other`; `value` is the distance
 *     zero_length_edge      an edge no longer than `merge`; `value` is the length
 *     degenerate_face       a face without area: what is left of its area vector is rounding noise,
 *                           or it is no wider than `merge` across its longest edge, which is what
 *                           `value` tells
 *     nonplanar_face        of four corners or more, one of them farther than `flat` from the plane
 *                           through their mean across the area vector; `value` is how far
 *     small_component       faces joined by edges in a box whose diagonal is no longer than
 *                           `small`, which is `value`; told by the lowest face
 *     inside_out_component  a component by edges without a boundary whose volume, `value`, is
 *                           negative; told likewise. One that bounds a hollow within another is as
 *                           it should be, and listed all the same: which of two is the hollow one,
 *                           only the mesh's owner knows. A component more than about 1e107 times
 *                           smaller than the mesh's largest coordinate is not listed: its volume
 *                           is taken for 0
 *     self_intersection     a face that meets `other` where it should not: bvh.h. This is not
 *                           looked for here
 *
 * Values are in the mesh's own lengths, never more than DBL_MAX. All in time linear in the mesh. */
#ifndef HE_QUERY_DEFECTS_H
#define HE_QUERY_DEFECTS_H

#include "mesh/mesh.h"

typedef enum he_defect_code {
    HE_DEFECT_BOWTIE,
    HE_DEFECT_ISOLATED,
    HE_DEFECT_DUPLICATE,
    HE_DEFECT_SHORT,
    HE_DEFECT_DEGENERATE,
    HE_DEFECT_NONPLANAR,
    HE_DEFECT_SMALL,
    HE_DEFECT_INSIDE_OUT,
    HE_DEFECT_INTERSECTION,
    HE_DEFECTS
} he_defect_code;

/* "bowtie", and the kind of the elements that have it. */
const char *he_defect_name(he_defect_code code);
he_kind he_defect_kind(he_defect_code code);

/* Lengths from which on something is a defect, or up to which. */
typedef struct he_thresholds {
    double merge, flat, small;
    /* Of the hashes of places. Whoever makes the mesh must not know it, or he could make all places
     * collide. */
    uint64_t seed;
} he_thresholds;

/* Parts of the diagonal of the box around the vertices that have edges, of all vertices where none
 * has: 1e-9, 1e-4 and 1e-2. The seed is 0. */
he_thresholds he_thresholds_of(const he_mesh *m);

/* The first of each, by rising id, and how many there are. */
enum { HE_DEFECTS_LISTED = 100 };

typedef struct he_defect_found {
    uint32_t id;
    uint32_t other; /* HE_NONE where there is none */
    double value;   /* 0 where none is told */
} he_defect_found;

typedef struct he_defect_list {
    uint64_t total;
    uint32_t count;
    he_defect_found listed[HE_DEFECTS_LISTED];
} he_defect_list;

typedef struct he_defects {
    he_defect_list of[HE_DEFECTS];
} he_defects;

/* One more of a kind. */
void he_defects_add(he_defects *defects, he_defect_code code, uint32_t id, uint32_t other,
                    double value);

/* Of a mesh that he_check passed, all but self-intersections. HE_NO_MEMORY; HE_CANCELLED by the
 * watch, which may be NULL and is not the mesh's: others may read that one meanwhile. */
HE_NODISCARD he_status he_defects_find(const he_mesh *m, const he_thresholds *thresholds,
                                       he_watch *watch, he_defects *out, he_error *err);

/* --- the parts, which add to what was found --- */
HE_NODISCARD he_status he_defects_of_positions(const he_mesh *m, double merge, uint64_t seed,
                                               he_watch *watch, he_defects *out, he_error *err);
HE_NODISCARD he_status he_defects_of_components(const he_mesh *m, double small, he_watch *watch,
                                                he_defects *out, he_error *err);

#endif
