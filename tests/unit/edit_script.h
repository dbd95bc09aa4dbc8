/* edit_script.h - meshes and operations written as short texts, for the tests of core/edit.
 *
 * A mesh: "012,023" are faces by vertex digit, 0-9 then a-z; the vertices are as many as the
 * largest names, or as "+" signs at the end add. An operation: its name and arguments,
 *
 *     edge_split edge=4-5 t=0.25           an edge, or half-edge, by its ends (or by id: edge=#7)
 *     face_add vertices=0,1,2              a list
 *     vertex_move vertex=0,1 by=0,0,1      points are three numbers each
 *     vertex_split vertex=1 left=null right=0 to=0,0,1
 *     append mesh=012,023*                 another mesh, with "*" one that has the columns of
 *                                          script_add_columns and `locked` numbers on faces
 *
 * and a script is operations separated by ";". A name that is not found fails the test. */
#ifndef TESTS_UNIT_EDIT_SCRIPT_H
#define TESTS_UNIT_EDIT_SCRIPT_H

#include "mesh/delta.h"
#include "op/op.h"

/* Makes a mesh with vertices in general position, or at `positions` if that is not NULL. */
he_mesh *script_mesh(const char *faces, const he_vec3 *positions);

/* Adds columns with every rule for every kind of element, so that edits have values to move. */
void script_add_columns(he_mesh *m);

/* Runs one operation. `results` may be NULL. */
he_status script_run(he_mesh *m, const char *operation, he_results *results, he_error *err);
/* Runs all operations of a script; each must succeed. `script` NULL: none. "mark locked face=0" is
 * no operation: it sets the mark `locked` of these elements, and adds the column of this mark if
 * there is none. */
void script_prepare(he_mesh *m, const char *script);
/* Returns the row of the table of operations for the name at the beginning of `operation`. */
const he_op *script_op(const char *operation);

/* assert_valid fails the test, with a sentence, if an invariant of the mesh is broken. */
void assert_valid(const he_mesh *m);
void assert_counts(const he_mesh *m, uint32_t vertices, uint32_t edges, uint32_t faces);
/* Requires that face f has these vertices in this order, whichever of them is first. */
void assert_face(const he_mesh *m, uint32_t f, const char *vertices);
void assert_equal(const he_mesh *m, const he_mesh *other);
/* Requires that the boundary loops have these lengths, given as digits in ascending order, as in
 * "345". */
void assert_loops(const he_mesh *m, const char *lengths);
he_mesh *copy_of(const he_mesh *m);
/* Requires exactly these ids, written with blanks between them. */
void assert_ids(const he_ids *list, const char *expected);

int euler_of(const he_mesh *m); /* V - E + F */
double area_of(const he_mesh *m);

he_halfedge halfedge_between(const he_mesh *m, uint32_t a, uint32_t b);
he_edge edge_between(const he_mesh *m, uint32_t a, uint32_t b);

#endif
