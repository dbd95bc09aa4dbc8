/* adopt.h - for operations of which hedge chooses the result: whether the result suits the oracle,
 * and how the oracle takes it over. */
#ifndef TESTS_MODEL_ADOPT_H
#define TESTS_MODEL_ADOPT_H

#include "model/arguments.h"

/* Returns the vertex at corner i of a face, counted from the face's stored half-edge. */
he_vertex md_corner(const he_mesh *m, uint32_t f, uint32_t i);
/* Makes the oracle equal to a mesh that came from the oracle's mesh. New edges and faces have no
 * ids yet. */
void md_adopt_mesh(or_mesh *o, const he_mesh *made);

/* Runs the operation that was drawn on a copy of the mesh. Returns false if the result has more new
 * vertices than the oracle has room for, or is so much larger than the mesh that rounding errors of
 * later operations would be, too. */
bool md_is_tame(const md_draft *d);

#endif
