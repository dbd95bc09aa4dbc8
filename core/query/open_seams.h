/* open_seams.h - counts boundary edges that are open only because their ends are several vertices
 * at one position. */
#ifndef HE_QUERY_OPEN_SEAMS_H
#define HE_QUERY_OPEN_SEAMS_H

#include "mesh/mesh.h"

/* Counts the pairs of boundary half-edges that run between two positions in opposite directions:
 * welding the mesh with tolerance 0 would make one edge of each pair. 0 and -0 are equal positions;
 * a half-edge with both ends at one position is skipped. Takes time linear in the boundary.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_open_seams_count(const he_mesh *m, uint64_t *out, he_error *err);

#endif
