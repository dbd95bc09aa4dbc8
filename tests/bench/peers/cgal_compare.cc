/* The Hausdorff distance with CGAL. */
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/distance.h>

namespace
{
void compare(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side), bent = cgal_mesh(side);
    for (Vertex v : bent.vertices()) {
        Point &p = bent.point(v);
        double moved[3] = {p.x(), p.y(), p.z()};
        bench_bend(moved);
        p = Point(moved[0], moved[1], moved[2]);
    }
    double start = bench_seconds();
    double distance = CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<
        CGAL::Sequential_tag>(mesh, bent, BENCH_COMPARE_BOUND);
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, distance);
}
} // namespace

const bench_row cgal_compare_rows[] = {{"compare", compare}, {nullptr, nullptr}};
