/* Deformation with CGAL, whose solver is Eigen's SparseLU if CGAL_EIGEN3_ENABLED is defined. */
#define CGAL_EIGEN3_ENABLED
#include "bench/peers/cgal.h"

#include <CGAL/Surface_mesh_deformation.h>

namespace
{
typedef CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::ORIGINAL_ARAP>
    Deformation;

void prepare(bench_side *side, Deformation &deformation, const Mesh &mesh)
{
    for (Vertex v : mesh.vertices()) {
        deformation.insert_roi_vertex(v);
        if (bench_deform_part(side, v) != BENCH_FREE) {
            deformation.insert_control_vertex(v);
        }
    }
    if (!deformation.preprocess()) {
        std::fprintf(stderr, "CGAL cannot solve the equations\n");
        std::exit(1);
    }
}

void move(bench_side *side, Deformation &deformation, const Mesh &mesh)
{
    for (Vertex v : mesh.vertices()) {
        if (bench_deform_part(side, v) == BENCH_HANDLE) {
            double to[3];
            bench_deform_goal(side, v, to);
            deformation.set_target_position(v, Point(to[0], to[1], to[2]));
        }
    }
}

void deform(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    const double start = bench_seconds();
    Deformation deformation(mesh);
    prepare(side, deformation, mesh);
    move(side, deformation, mesh);
    deformation.deform(10, 0);
    out->value = bench_seconds() - start;
    out->amount = side->input.vertices;
    cgal_write_points(side, "deformed.bin", mesh, mesh.vertices());
}

void deform_drag(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    Deformation deformation(mesh);
    prepare(side, deformation, mesh);
    move(side, deformation, mesh);
    const double start = bench_seconds();
    deformation.deform(1, 0);
    out->value = bench_seconds() - start;
    out->amount = side->input.vertices;
    cgal_write_points(side, "deformed.bin", mesh, mesh.vertices());
}
} // namespace

const bench_row cgal_deform_rows[] = {
    {"deform", deform}, {"deform_drag", deform_drag}, {nullptr, nullptr}};
