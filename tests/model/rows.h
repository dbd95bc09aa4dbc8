/* rows.h - the tables with one line for each operation: how the model test draws its arguments and
 * runs it on the oracle. */
#ifndef TESTS_MODEL_ROWS_H
#define TESTS_MODEL_ROWS_H

#include "model/arguments.h"

typedef struct md_row {
    const char *name;
    /* Roughly how much the operation makes the mesh grow (negative: shrink). Operations with a
     * growth above 0 are not drawn while the mesh should not grow. */
    int growth;
    /* The functions behind md_draw, md_play and md_follow of calls.h for this operation. */
    bool (*draw)(md_draft *d);
    uint64_t (*play)(const md_call *c, or_mesh *o, const he_mesh *m);
    bool (*follow)(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT]);
    bool far; /* the operation is correct even if coordinates are as large as doubles get */
} md_row;

/* The lines (rows) that are not in calls.c; each array ends in a row whose name is NULL. */
extern const md_row md_border_rows[];
extern const md_row md_weld_rows[];
extern const md_row md_corner_rows[];
extern const md_row md_loop_rows[];
extern const md_row md_region_rows[];
extern const md_row md_refine_rows[];
extern const md_row md_decimate_rows[];
extern const md_row md_remesh_rows[];
extern const md_row md_smooth_rows[];
extern const md_row md_fill_rows[];
extern const md_row md_deform_rows[];
extern const md_row md_material_rows[];
extern const md_row md_select_rows[];
extern const md_row md_segment_rows[];
extern const md_row md_compare_rows[];

#endif
