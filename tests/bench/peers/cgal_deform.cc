/* Deformation with CGAL, whose solver is Eigen's SparseLU if CGAL_EIGEN3_ENABLED is defined. */
#define CGAL_EIGEN3_ENABLED
#include "bench/peers/cgal.h"

#include <CGAL/Surface_mesh_deformation.h>

#include <cstdio>

namespace
{
typedef CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::ORIGINAL_ARAP>
    Deformation;

void write_positions(const bench_side *side, const Mesh &mesh)
{
    FILE *file = bench_open(side, "deformed.bin", "wb");
    for (Vertex v : mesh.vertices()) {
        const double c[3] = {mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()};
        if (std::fwrite(c, sizeof c, 1, file) != 1) {
            std::exit(1);
        }
    }
    std::fclose(file);
}

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
    write_positions(side, mesh);
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
    write_positions(side, mesh);
}
} // namespace

const bench_row cgal_deform_rows[] = {
    {"deform", deform}, {"deform_drag", deform_drag}, {nullptr, nullptr}};
