#include "op/rows.h"

#include <assert.h>

static const he_op *const groups[] = {
    he_vertex_rows,   he_edge_rows,   he_border_rows, he_face_rows,  he_region_rows,
    he_loop_rows,     he_mesh_rows,   he_weld_rows,   he_whole_rows, he_refine_rows,
    he_decimate_rows, he_remesh_rows, he_smooth_rows, he_fill_rows,  he_deform_rows,
    he_material_rows, he_select_rows, he_compare_rows};

size_t he_table_number(const he_op *op)
{
    size_t number = 0;
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        for (const he_op *row = groups[g]; row->name != NULL; row++) {
            if (row == op) {
                return number;
            }
            number++;
        }
    }
    assert(false);
    return number;
}

const he_op *he_table_row(size_t i)
{
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        for (const he_op *row = groups[g]; row->name != NULL; row++) {
            if (i-- == 0) {
                return row;
            }
        }
    }
    return NULL;
}
