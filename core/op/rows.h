/* rows.h - for the files of core/op only: the arrays of rows that make up the operation table, and
 * the functions with which operations store their results. */
#ifndef HE_OP_ROWS_H
#define HE_OP_ROWS_H

#include "op/op.h"

/* The rows of the operation table, grouped by what they edit. Each array ends in a row without a
 * name. */
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
extern const he_op he_remesh_rows[];
extern const he_op he_smooth_rows[];
extern const he_op he_fill_rows[];
extern const he_op he_deform_rows[];
extern const he_op he_material_rows[];
extern const he_op he_select_rows[];
extern const he_op he_compare_rows[];

/* Returns the row with this number, in the order of the table; NULL past the last row. */
const he_op *he_table_row(size_t i);
/* Returns the number of a row of the table. */
size_t he_table_number(const he_op *op);

/* An adapter is a function run_NAME that calls he_NAME for the operation NAME. It reads arguments
 * and stores results by slots, which are indices with names:
 *
 *     enum { EDGE_BISECT_EDGE, EDGE_BISECT_T };                    indices of args
 *     enum { EDGE_BISECT_OUT_VERTEX, EDGE_BISECT_OUT_EDGE };       indices of results
 *
 * The row uses the slots as designators, as in `[EDGE_BISECT_T] = {.name = "t", ...}`, so that an
 * adapter and its row cannot mean different parameters. The name of a slot consists of the names of
 * the operation and of the parameter (the plural if it has one), or of the operation, OUT and the
 * result. .ci/lint-slots checks these names. */

/* Runs an operation once for each item of the list that was given for its parameter `each`
 * (he_op_each). `out` is empty. Returns what the operation returns, or HE_NO_MEMORY; on failure the
 * mesh is as it was, `out` may have results, and out->runs is the index of the item at fault. */
HE_NODISCARD he_status he_run_each(const he_op *op, he_mesh *mesh, const he_arg args[HE_OP_PARAMS],
                                   he_results *out, he_error *err);

/* Sets the result in a slot to the id of an element (or HE_NONE), or to the index of a choice. */
void he_results_set(he_results *out, size_t slot, uint32_t id);
void he_results_set_number(he_results *out, size_t slot, double number);
/* Leaves out a result that the operation does not have with the arguments of this call. */
void he_results_omit(he_results *out, size_t slot);
/* Reserves memory for a result that is a list of at most `count` ids. An adapter must call it
 * before the edit, because nothing may fail after the edit.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_results_reserve(he_results *out, size_t slot, size_t count,
                                          he_error *err);
/* Appends an id to the result in a slot, which is a list. */
void he_results_add(he_results *out, size_t slot, uint32_t id);
/* Replaces the list in a slot by the list `takes`, which is empty afterwards. */
void he_results_set_list(he_results *out, size_t slot, he_ids *takes);

#endif
