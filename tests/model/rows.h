/* rows.h - one line for each row of the table: how the model draws its arguments and plays it. */
#ifndef TESTS_MODEL_ROWS_H
#define TESTS_MODEL_ROWS_H

#include "model/arguments.h"

typedef struct md_row {
    const char *name;
    int growth; /* of the mesh, roughly: rows above 0 wait while there is no room */
    /* What md_draw, md_play and md_follow of calls.h say of one row. */
    bool (*draw)(md_draft *d);
    uint64_t (*play)(const md_call *c, or_mesh *o, const he_mesh *m);
    bool (*follow)(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT]);
    bool far; /* right even where coordinates are as large as doubles get */
} md_row;

/* Beside those of calls.c; each array ends in a row without a name. */
extern const md_row md_border_rows[];
extern const md_row md_weld_rows[];
extern const md_row md_corner_rows[];
extern const md_row md_loop_rows[];
extern const md_row md_region_rows[];
extern const md_row md_refine_rows[];
extern const md_row md_decimate_rows[];
extern const md_row md_material_rows[];

#endif
