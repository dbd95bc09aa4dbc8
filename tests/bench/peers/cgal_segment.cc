/* Patches of faces with CGAL: by sharp edges, and by planes (variational shape approximation). */
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Variational_shape_approximation.h>

#include <cmath>

namespace
{
namespace PMP = CGAL::Polygon_mesh_processing;
typedef Mesh::Property_map<Face, std::size_t> Patches;

/* Returns a hash of the patches, whatever their numbers are: of each face and the first face of its
 * patch. */
uint64_t hash_of(const Mesh &mesh, const Patches &patches, std::size_t count)
{
    std::vector<uint32_t> first(count + 1, UINT32_MAX);
    uint64_t hash = 0;
    for (Face f : mesh.faces()) {
        uint32_t &one = first[patches[f]];
        one = std::min<uint32_t>(one, f.idx());
        const uint32_t pair[2] = {static_cast<uint32_t>(f.idx()), one};
        hash += bench_face_hash(pair, 2);
    }
    return hash;
}

void by_angle(bench_side *side, bench_result *out)
{
    Mesh mesh = cgal_mesh(side);
    Patches patches = mesh.add_property_map<Face, std::size_t>("f:patch").first;
    auto sharp = mesh.add_property_map<Edge, bool>("e:sharp", false).first;
    double start = bench_seconds();
    std::size_t count = PMP::sharp_edges_segmentation(mesh, 30, sharp, patches);
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, hash_of(mesh, patches, count));
    /* CGAL marks the edges on the boundary, too. */
    std::size_t inner = 0;
    for (Edge e : mesh.edges()) {
        inner += sharp[e] && !mesh.is_border(e);
    }
    bench_near(out, static_cast<double>(inner));
}

/* Returns the root mean square, weighted by area, of the distance between the unit normals of a
 * face and of its patch. */
double deviation_of(const Mesh &mesh, const Patches &patches, std::size_t count)
{
    std::vector<Vector> sums(count, CGAL::NULL_VECTOR);
    std::vector<double> areas(count, 0);
    double all = 0, error = 0;
    for (Face f : mesh.faces()) {
        const double area = PMP::face_area(f, mesh);
        sums[patches[f]] = sums[patches[f]] + area * PMP::compute_face_normal(f, mesh);
        areas[patches[f]] += area;
        all += area;
    }
    for (std::size_t p = 0; p < count; p++) {
        error += 2 * (areas[p] - std::sqrt(sums[p].squared_length()));
    }
    return std::sqrt(error / all);
}

void by_planes(bench_side *side, bench_result *out)
{
    namespace VSA = CGAL::Surface_mesh_approximation;
    typedef Mesh::Property_map<Vertex, Point> Points;
    typedef CGAL::Variational_shape_approximation<Mesh, Points> Approximation;
    enum { PLANES = 64, ROUNDS = 10 };
    Mesh mesh = cgal_mesh(side);
    Patches patches = mesh.add_property_map<Face, std::size_t>("f:patch").first;
    double start = bench_seconds();
    Approximation::Error_metric metric(mesh, mesh.points());
    Approximation approximation(mesh, mesh.points(), metric);
    approximation.initialize_seeds(CGAL::parameters::seeding_method(VSA::HIERARCHICAL)
                                       .max_number_of_proxies(PLANES)
                                       .number_of_relaxations(2));
    approximation.run(ROUNDS);
    approximation.proxy_map(patches);
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, deviation_of(mesh, patches, approximation.number_of_proxies()));
}
} // namespace

const bench_row cgal_segment_rows[] = {
    {"segment_angle", by_angle}, {"segment_planes", by_planes}, {nullptr, nullptr}};
