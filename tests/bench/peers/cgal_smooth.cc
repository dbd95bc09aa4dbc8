/* Smoothing with CGAL, whose solver is Eigen's SimplicialLDLT if CGAL_EIGEN3_ENABLED is defined. */
#define CGAL_EIGEN3_ENABLED
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/smooth_shape.h>

namespace
{
void smooth(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    const double start = bench_seconds();
    CGAL::Polygon_mesh_processing::smooth_shape(mesh, BENCH_SMOOTH_TIME,
                                                CGAL::parameters::number_of_iterations(1));
    out->value = bench_seconds() - start;
    out->amount = side->input.vertices;
    cgal_write_points(side, "smoothed.bin", mesh, mesh.vertices());
}
} // namespace

const bench_row cgal_smooth_rows[] = {{"smooth", smooth}, {nullptr, nullptr}};
