/* Filling a hole with CGAL, whose solver is Eigen's SparseLU if CGAL_EIGEN3_ENABLED is defined. */
#define CGAL_EIGEN3_ENABLED
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>
#include <vector>

namespace
{
Halfedge cut(const bench_side *side, Mesh &mesh)
{
    std::vector<Face> gone;
    for (Face f : mesh.faces()) {
        bool all = true;
        for (Vertex v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
            all = all && bench_in_cap(side, v);
        }
        if (all) {
            gone.push_back(f);
        }
    }
    for (Face f : gone) {
        CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
    }
    for (Halfedge h : mesh.halfedges()) {
        if (mesh.is_border(h)) {
            return h;
        }
    }
    std::exit(1);
}

void fill(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    const Halfedge hole = cut(side, mesh);
    std::vector<Face> faces;
    std::vector<Vertex> vertices;
    const double start = bench_seconds();
    CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(
        mesh, hole, std::back_inserter(faces), std::back_inserter(vertices));
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(faces.size());
    cgal_write_points(side, "filled.bin", mesh, vertices);
}
} // namespace

const bench_row cgal_fill_rows[] = {{"fill", fill}, {nullptr, nullptr}};
