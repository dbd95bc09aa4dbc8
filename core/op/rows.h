/* rows.h - the arrays of rows of the operation table, for table.c and op.c, and the functions with
 * which rows fill in results. */
#ifndef HE_OP_ROWS_H
#define HE_OP_ROWS_H

#include "op/op.h"

/* Rows by the kind of element they edit; each array ends in a row without a name. */
extern const he_op he_vertex_rows[];
extern const he_op he_edge_rows[];
extern const he_op he_border_rows[];
extern const he_op he_face_rows[];
extern const he_op he_loop_rows[];
extern const he_op he_mesh_rows[];
extern const he_op he_weld_rows[];
extern const he_op he_region_rows[];
extern const he_op he_whole_rows[];
extern const he_op he_refine_rows[];
extern const he_op he_decimate_rows[];
extern const he_op he_material_rows[];

/* Returns the row with this number, in the order of the table; NULL past the last row. */
const he_op *he_table_row(size_t i);
/* Returns the number of a row of the table. */
size_t he_table_number(const he_op *op);

/* An adapter, run_NAME, reads the arguments of the operation NAME and gives its results by slots:
 *
 *     enum { EDGE_BISECT_EDGE, EDGE_BISECT_T };                    indices of args
 *     enum { EDGE_BISECT_OUT_VERTEX, EDGE_BISECT_OUT_EDGE };       indices of results
 *
 * The row places each parameter and result at its slot (index), `[EDGE_BISECT_T] = {.name = "t",
 * ...}`, so that an adapter and its row cannot mean different parameters. A slot is named after the
 * operation and the parameter (its plural if there is one) or, behind OUT, the result:
 * .ci/lint-slots compares the names. */

/* Sets the result in a slot to one element, which may be HE_NONE, or to one choice. */
void he_results_set(he_results *out, size_t slot, uint32_t id);
void he_results_set_number(he_results *out, size_t slot, double number);
/* Makes room for the result in a slot, a list of at most `count` ids. It must be called before the
 * edit, because nothing may fail after it.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_results_reserve(he_results *out, size_t slot, size_t count,
                                          he_error *err);
/* Appends to the list in a slot. */
void he_results_add(he_results *out, size_t slot, uint32_t id);
/* Makes `takes` the whole list in a slot; `takes` is empty afterwards. */
void he_results_set_list(he_results *out, size_t slot, he_ids *takes);

#endif
