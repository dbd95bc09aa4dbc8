/* CGAL's program in the benchmark; side.h describes its input and output. */
#include "bench/peers/cgal.h"

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {
        cgal_kernel_rows,  cgal_edit_rows,    cgal_file_rows,   cgal_whole_rows,
        cgal_segment_rows, cgal_remesh_rows,  cgal_deform_rows, cgal_fill_rows,
        cgal_smooth_rows,  cgal_compare_rows, nullptr};
    return bench_serve(argc, argv, tables);
}
