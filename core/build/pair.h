/* pair.h - what is wrong with the faces and edges of a soup, and which of its corners run along the
 * same edge: what he_build refuses by, and repairs start from. */
#ifndef HE_BUILD_PAIR_H
#define HE_BUILD_PAIR_H

#include "build/build.h"

/* Append to a report; `report` may be NULL. */
void he_report_add(he_report *report, uint64_t *total, he_defect defect);

/* Faces the structure cannot hold by themselves: too few corners, bad indices, repeated corners.
 * Counts them in *total. */
HE_NODISCARD he_status he_soup_check_faces(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* The first corner of a face that repeats an earlier one, or `count`. A face of more than
 * HE_SMALL_FACE corners marks its vertices with `mark`, its own, in `stamp`, which has a word a
 * vertex: so no face costs more than its corners. Smaller ones take NULL. */
enum { HE_SMALL_FACE = 16 };
uint32_t he_soup_find_repeat(const uint32_t *corners, uint32_t count, uint32_t *stamp,
                             uint32_t mark);

/* Edges with three faces, or two in one direction, are counted in *total. All faces must have
 * passed he_soup_check_faces. */
HE_NODISCARD he_status he_soup_check_edges(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* edge[c] = the number of the edge from corner c to the next of its face, whatever the direction
 * and however many faces share it. Room and faces as above. */
HE_NODISCARD he_status he_soup_number_edges(const he_soup *soup, uint32_t *edge, size_t *edges,
                                            he_error *err);

/* The end of face f's corners. */
static inline uint32_t he_soup_end(const he_soup *soup, size_t f)
{
    return f + 1 < soup->face_count ? soup->starts[f + 1] : (uint32_t)soup->corner_count;
}

#endif
