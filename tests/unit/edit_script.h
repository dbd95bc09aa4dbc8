/* edit_script.h - meshes and operations written as short texts, for the tests of core/edit.
 *
 * A mesh is written as a list of faces: in "012,023" each face is a string of vertex numbers, one
 * digit (0-9, then a-z) for each. The mesh has all vertices up to the largest number, and one more
 * for each "+" at the end. An operation is written as its name and arguments,
 *
 *     edge_split edge=4-5 t=0.25           an edge or half-edge from 4 to 5; edge=#7 has the id 7
 *     face_add vertices=0,1,2              a list
 *     vertex_move vertex=0,1 by=0,0,1      points are three numbers each
 *     vertex_split vertex=1 left=null right=0 to=0,0,1
 *     append mesh=012,023*                 another mesh; "*" adds the columns of
 *                                          script_add_columns() and numbers `locked` on faces
 *
 * and a script is a list of operations separated by ";". The test fails if a script has the name of
 * an operation, argument or element that does not exist. */
#ifndef TESTS_UNIT_EDIT_SCRIPT_H
#define TESTS_UNIT_EDIT_SCRIPT_H

#include "mesh/delta.h"
#include "op/op.h"

/* Makes a mesh of faces written like "012,023". If `positions` is NULL, the vertices get positions
 * in general position (no special cases, such as three on a line). */
he_mesh *script_mesh(const char *faces, const he_vec3 *positions);

/* Adds attribute columns for every kind of element and with every rule by which edits can set
 * values. */
void script_add_columns(he_mesh *m);

/* Runs one operation, written like "edge_split edge=4-5 t=0.25". `results` may be NULL. */
he_status script_run(he_mesh *m, const char *operation, he_results *results, he_error *err);
/* Runs all operations of a script, which may be NULL; each must succeed. A script may also contain
 * "mark locked face=0", which sets the mark `locked` of face 0 and adds a column for this mark if
 * there is none. */
void script_prepare(he_mesh *m, const char *script);
/* Returns the description of the operation whose name is at the beginning of `operation`. */
const he_op *script_op(const char *operation);

/* assert_valid() fails the test and names the broken rule if an invariant of the mesh is broken. */
void assert_valid(const he_mesh *m);
void assert_counts(const he_mesh *m, uint32_t vertices, uint32_t edges, uint32_t faces);
/* Requires that face f has the given vertices in the given order, starting at any of them. */
void assert_face(const he_mesh *m, uint32_t f, const char *vertices);
void assert_equal(const he_mesh *m, const he_mesh *other);
/* Requires that the boundary loops of the mesh have these lengths: one digit for each loop, in
 * ascending order, as in "345". */
void assert_loops(const he_mesh *m, const char *lengths);
he_mesh *copy_of(const he_mesh *m);
/* Requires that the list has exactly the ids in the text `expected`, where they are separated by
 * blanks. */
void assert_ids(const he_ids *list, const char *expected);

int euler_of(const he_mesh *m); /* Euler characteristic, V - E + F */
double area_of(const he_mesh *m);

he_halfedge halfedge_between(const he_mesh *m, uint32_t a, uint32_t b);
he_edge edge_between(const he_mesh *m, uint32_t a, uint32_t b);

#endif
