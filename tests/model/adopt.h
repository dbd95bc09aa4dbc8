/* adopt.h - makes the oracle equal to a mesh of which hedge chose the new elements. */
#ifndef TESTS_MODEL_ADOPT_H
#define TESTS_MODEL_ADOPT_H

#include "model/arguments.h"

/* Returns the vertex at corner i of a face, counted from the face's stored half-edge. */
he_vertex md_corner(const he_mesh *m, uint32_t f, uint32_t i);
/* Makes the oracle equal to a mesh that came from the oracle's mesh. New edges and faces have no
 * ids yet. */
void md_adopt_mesh(or_mesh *o, const he_mesh *made);

#endif
