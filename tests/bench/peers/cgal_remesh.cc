/* Remeshing with CGAL. */
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/boost/graph/IO/PLY.h>

#include <cstdio>

namespace
{
/* Remeshes with three iterations, as in CGAL's manual; the default is one. The result stays in the
 * folder, so that it can be measured. */
void run(bench_side *side, double times, bench_result *out)
{
    char path[512];
    Mesh mesh = cgal_mesh(side);
    double length = times * bench_remesh_length(side);
    double start = bench_seconds();
    CGAL::Polygon_mesh_processing::isotropic_remeshing(mesh.faces(), length, mesh,
                                                       CGAL::parameters::number_of_iterations(3));
    mesh.collect_garbage();
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, mesh.number_of_faces());
    bench_path(side, "remeshed.ply", path, sizeof path);
    if (!CGAL::IO::write_PLY(path, mesh, CGAL::parameters::use_binary_mode(true))) {
        std::fprintf(stderr, "CGAL cannot write %s\n", path);
        std::exit(1);
    }
}

void remesh(bench_side *side, bench_result *out)
{
    run(side, 1, out);
}
void remesh_coarse(bench_side *side, bench_result *out)
{
    run(side, 3, out);
}
} // namespace

const bench_row cgal_remesh_rows[] = {
    {"remesh", remesh}, {"remesh_coarse", remesh_coarse}, {nullptr, nullptr}};
