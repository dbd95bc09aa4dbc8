/* The kernel's side of the bench: side.h says how it is spoken to. */
#include "bench/ours/ours.h"

int main(int argc, char **argv)
{
    static const bench_row *const tables[] = {bench_build_rows,    bench_walk_rows,
                                              bench_edit_rows,     bench_file_rows,
                                              bench_document_rows, NULL};
    return bench_serve(argc, argv, tables);
}
