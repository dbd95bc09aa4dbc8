/* The kernel's program in the benchmark; side.h describes its input and output. */
#include "bench/ours/ours.h"

#include "system/memory.h"

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {
        bench_build_rows,    bench_walk_rows,     bench_edit_rows,    bench_file_rows,
        bench_document_rows, bench_decimate_rows, bench_error_rows,   bench_subdivide_rows,
        bench_memory_rows,   bench_growth_rows,   bench_scaling_rows, bench_stored_rows,
        bench_segment_rows,  bench_remesh_rows,   bench_solve_rows,   bench_deform_rows,
        bench_fill_rows,     bench_smooth_rows,   bench_compare_rows, NULL};
    /* The program allocates memory as the daemon does: memory is counted, and large blocks are
     * mappings of their own. */
    st_memory_install(0);
    return bench_serve(argc, argv, tables);
}
