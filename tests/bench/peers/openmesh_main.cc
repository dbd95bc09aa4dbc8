/* OpenMesh's program in the benchmark; side.h describes its input and output. */
#include "bench/peers/openmesh.h"

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {openmesh_kernel_rows, openmesh_edit_rows,
                                              openmesh_file_rows, openmesh_whole_rows, nullptr};
    omlog().disable();
    omerr().disable();
    return bench_serve(argc, argv, tables);
}
