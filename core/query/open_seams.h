/* open_seams.h - edges that are open only because their ends are several vertices at one place. */
#ifndef HE_QUERY_OPEN_SEAMS_H
#define HE_QUERY_OPEN_SEAMS_H

#include "mesh/mesh.h"

/* How many pairs of boundary half-edges run between the same two positions in opposite directions:
 * a weld with tolerance 0 would make an edge of each pair. 0 and -0 are equal; what begins and ends
 * at one position is passed over. Linear in the boundary. HE_NO_MEMORY. */
HE_NODISCARD he_status he_open_seams_count(const he_mesh *m, uint64_t *out, he_error *err);

#endif
