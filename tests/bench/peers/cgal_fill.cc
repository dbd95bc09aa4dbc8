/* Filling a hole with CGAL, whose solver is Eigen's SparseLU if CGAL_EIGEN3_ENABLED is defined. */
#define CGAL_EIGEN3_ENABLED
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>
#include <vector>

namespace
{
Halfedge cut(const bench_side *side, Mesh &mesh, bool left)
{
    std::vector<Face> gone;
    for (Face f : mesh.faces()) {
        bool all = true;
        for (Vertex v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
            all = all && bench_in_cap(side, v, left);
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

// Fills the hole to the right. If `again` is true, the one to the left was filled before.
void fill_one(bench_side *side, bool again, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    std::vector<Face> faces;
    std::vector<Vertex> vertices;
    if (again) {
        CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(
            mesh, cut(side, mesh, true), std::back_inserter(faces), std::back_inserter(vertices));
        faces.clear();
        vertices.clear();
    }
    const Halfedge hole = cut(side, mesh, false);
    const double start = bench_seconds();
    CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(
        mesh, hole, std::back_inserter(faces), std::back_inserter(vertices));
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(faces.size());
    cgal_write_points(side, "filled.bin", mesh, vertices);
}

void fill(bench_side *side, bench_result *out)
{
    fill_one(side, false, out);
}

void fill_again(bench_side *side, bench_result *out)
{
    fill_one(side, true, out);
}
} // namespace

const bench_row cgal_fill_rows[] = {{"fill", fill}, {"fill_again", fill_again}, {nullptr, nullptr}};
