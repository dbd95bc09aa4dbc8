/* soup_check.h - finds the faces and edges of a soup that a mesh cannot represent, and numbers the
 * edges. he_build refuses a soup with such faces or edges; repairs begin by finding them. */
#ifndef HE_BUILD_SOUP_CHECK_H
#define HE_BUILD_SOUP_CHECK_H

#include "build/build.h"

/* Appends a defect to a report, which may be NULL, and counts it in `*total`. */
void he_report_add(he_report *report, uint64_t *total, he_defect defect);

/* Finds the faces that no mesh can represent: too few corners, bad indices, repeated corners.
 * Counts them in *total. */
HE_NODISCARD he_status he_soup_check_faces(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* he_soup_find_repeat returns the index of the first corner in a face that is at the vertex of an
 * earlier corner, or `count` if there is none. A face of more than HE_SMALL_FACE corners needs
 * `stamp`, an array of one word for each vertex, and a `mark` that the caller uses for no other
 * face; the search then takes time linear in the corners. If the face is smaller, `stamp` may be
 * NULL. */
enum { HE_SMALL_FACE = 16 };
uint32_t he_soup_find_repeat(const uint32_t *corners, uint32_t count, uint32_t *stamp,
                             uint32_t mark);

/* Counts in *total each face at an edge that has two faces already, and each edge along which its
 * two faces run in the same direction. All faces must have passed he_soup_check_faces. */
HE_NODISCARD he_status he_soup_check_edges(const he_soup *soup, he_report *report, uint64_t *total,
                                           he_error *err);

/* Numbers the edges: edge[c] becomes the number of the edge from corner c to the next corner of its
 * face. All corners whose sides are the same edge get the same number, whatever their direction and
 * number. `edge` must have an entry for each corner; all faces must have passed
 * he_soup_check_faces. */
HE_NODISCARD he_status he_soup_number_edges(const he_soup *soup, uint32_t *edge, size_t *edges,
                                            he_error *err);

/* Returns the number of the corner after the last corner of face f. */
static inline uint32_t he_soup_end(const he_soup *soup, size_t f)
{
    return f + 1 < soup->face_count ? soup->starts[f + 1] : (uint32_t)soup->corner_count;
}

#endif
