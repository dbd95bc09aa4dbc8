/* defects.h - finds properties that a valid mesh may have and its owner may not want.
 *
 *     bowtie                a vertex of two fans or more; `value` is how many
 *     isolated_vertex       a vertex without an edge
 *     duplicate_position    a vertex no farther than `merge` from an earlier one that is not itself
 *                           listed, which is `other`; `value` is the distance
 *     zero_length_edge      an edge no longer than `merge`; `value` is the length
 *     degenerate_face       a face without area: its area vector is rounding noise, or its width
 *                           across its longest edge is at most `merge`; `value` is that width
 *     nonplanar_face        of four corners or more, one of them farther than `flat` from the plane
 *                           through their mean across the area vector; `value` is the distance
 *     small_component       faces joined by edges in a box whose diagonal is no longer than
 *                           `small`, which is `value`; named by the lowest face
 *     inside_out_component  a component by edges without a boundary whose volume, `value`, is
 *                           negative; named by the lowest face. One that bounds a cavity within
 *                           another is correct, and listed all the same: only the mesh's owner
 *                           knows which of two is the cavity. A component more than about 1e107
 *                           times smaller than the mesh's largest coordinate is not listed: its
 *                           volume counts as 0
 *     self_intersection     a face that intersects `other`: see bvh.h, not searched here
 *
 * Values are in the mesh's own lengths, never more than DBL_MAX. The time is linear in the mesh. */
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

/* he_defect_name returns the name of a defect, such as "bowtie"; he_defect_kind returns the kind of
 * the elements that have the defect. */
const char *he_defect_name(he_defect_code code);
he_kind he_defect_kind(he_defect_code code);

/* The lengths below or above which an element counts as a defect. */
typedef struct he_thresholds {
    double merge, flat, small;
    /* Seed for hashing positions. Clients must not know the seed: a client that knows it could make
     * a mesh of which all positions have one hash. */
    uint64_t seed;
} he_thresholds;

/* Returns default thresholds: 1e-9, 1e-4 and 1e-2 of the diagonal of the box around the vertices
 * that have edges, or around all vertices if none has an edge. The seed is 0. */
he_thresholds he_thresholds_of(const he_mesh *m);

/* The most defects of each code (kind of defect) that are listed: those with the lowest ids. All
 * are counted. */
enum { HE_DEFECTS_LISTED = 100 };

typedef struct he_defect_found {
    uint32_t id;
    /* The second element concerned, such as the vertex at the same position; HE_NONE: there is
     * none. */
    uint32_t other;
    /* the measured value that the table at the head of defects.h names for this defect; 0 if it
     * names none */
    double value;
} he_defect_found;

typedef struct he_defect_list {
    uint64_t total;
    uint32_t count;
    he_defect_found listed[HE_DEFECTS_LISTED];
} he_defect_list;

typedef struct he_defects {
    he_defect_list of[HE_DEFECTS];
} he_defects;

/* Counts a defect, and lists it unless HE_DEFECTS_LISTED defects of its code (kind of defect) are
 * listed already. */
void he_defects_add(he_defects *defects, he_defect_code code, uint32_t id, uint32_t other,
                    double value);

/* Finds all defects except self-intersections in a mesh that passed he_check. Progress is reported
 * to `progress`, which may be NULL, and not to the watch of the mesh, so other threads may read the
 * mesh meanwhile.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_defects_find(const he_mesh *m, const he_thresholds *thresholds,
                                       he_progress *progress, he_defects *out, he_error *err);

/* --- the parts of he_defects_find, which add what they find to `out` --- */
HE_NODISCARD he_status he_defects_of_positions(const he_mesh *m, double merge, uint64_t seed,
                                               he_progress *progress, he_defects *out,
                                               he_error *err);
HE_NODISCARD he_status he_defects_of_components(const he_mesh *m, double small,
                                                he_progress *progress, he_defects *out,
                                                he_error *err);

#endif
