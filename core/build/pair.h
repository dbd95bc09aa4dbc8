/* pair.h - finds faces and edges of a soup that a mesh cannot represent, and pairs the corners
 * along one edge. he_build refuses by these, and repairs start from them. */
#ifndef HE_BUILD_PAIR_H
#define HE_BUILD_PAIR_H

#include "build/build.h"

/* Appends a defect to a report, which may be NULL, and counts it in `*total`. */
void he_report_add(he_report *report, uint64_t *total, he_defect defect);

/* Finds the faces that no mesh can represent: too few corners, bad indices, repeated corners.
 * Counts them in *total. */
HE_NODISCARD he_status he_soup_check_faces(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* Returns the first corner of a face that repeats an earlier one, or `count` if none does. For a
 * face of more than HE_SMALL_FACE corners the caller passes `stamp`, with one word a vertex, and a
 * `mark` that it uses for no other face: so no face costs more than its corners. For smaller ones
 * `stamp` may be NULL. */
enum { HE_SMALL_FACE = 16 };
uint32_t he_soup_find_repeat(const uint32_t *corners, uint32_t count, uint32_t *stamp,
                             uint32_t mark);

/* Counts in *total the edges with three faces, or with two in one direction. All faces must have
 * passed he_soup_check_faces. */
HE_NODISCARD he_status he_soup_check_edges(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* Numbers the edges: edge[c] becomes the number of the edge from corner c to the next of its face,
 * whatever its direction and however many faces share it. `edge` has a word for each corner; all
 * faces must have passed he_soup_check_faces. */
HE_NODISCARD he_status he_soup_number_edges(const he_soup *soup, uint32_t *edge, size_t *edges,
                                            he_error *err);

/* Returns the number of the corner after the last corner of face f. */
static inline uint32_t he_soup_end(const he_soup *soup, size_t f)
{
    return f + 1 < soup->face_count ? soup->starts[f + 1] : (uint32_t)soup->corner_count;
}

#endif
