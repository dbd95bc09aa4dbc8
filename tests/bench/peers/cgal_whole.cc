/* Subdivision and decimation with CGAL. */
#include "bench/peers/cgal.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh/IO.h>
#include <CGAL/boost/graph/IO/PLY.h>
#include <CGAL/subdivision_method_3.h>

#include <cstdio>

namespace
{
void loop(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    double start = bench_seconds();
    CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(1));
    out->value = bench_seconds() - start;
    cgal_describe(mesh, out);
}

void catmull_clark(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    double start = bench_seconds();
    CGAL::Subdivision_method_3::CatmullClark_subdivision(mesh,
                                                         CGAL::parameters::number_of_iterations(1));
    out->value = bench_seconds() - start;
    cgal_describe(mesh, out);
}

/* Decimates to a tenth of the faces. The result stays in the folder, so that its error can be
 * measured. */
void decimate(bench_side *side, bench_result *out)
{
    namespace SMS = CGAL::Surface_mesh_simplification;
    typedef SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> Policies;
    char path[512];
    Mesh mesh = cgal_mesh(side);
    double start = bench_seconds();
    Policies policies(mesh);
    SMS::Bounded_normal_change_filter<> filter;
    /* The ratio is of the number of edges; a closed mesh has three edges for two faces, so it holds
     * for faces, too. */
    SMS::Count_ratio_stop_predicate<Mesh> stop(0.1);
    SMS::edge_collapse(mesh, stop,
                       CGAL::parameters::get_cost(policies.get_cost())
                           .get_placement(policies.get_placement())
                           .filter(filter));
    mesh.collect_garbage();
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, mesh.number_of_faces());
    bench_path(side, "decimated.ply", path, sizeof path);
    if (!CGAL::IO::write_PLY(path, mesh, CGAL::parameters::use_binary_mode(true))) {
        std::fprintf(stderr, "CGAL cannot write %s\n", path);
        std::exit(1);
    }
}
} // namespace

const bench_row cgal_whole_rows[] = {
    {"loop", loop}, {"catmull_clark", catmull_clark}, {"decimate", decimate}, {nullptr, nullptr}};
