/* Building and reading a whole mesh with CGAL. */
#include "bench/peers/cgal.h"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>

#include <cmath>

void cgal_fill(const bench_input &in, Mesh &mesh)
{
    size_t corners = static_cast<size_t>(in.faces) * in.degree;
    std::vector<Vertex> face(in.degree);
    mesh.reserve(in.vertices, static_cast<uint32_t>(corners / 2 + (in.degree == 4 ? 4000 : 0)),
                 in.faces);
    for (uint32_t v = 0; v < in.vertices; v++) {
        const double *p = in.positions + 3 * static_cast<size_t>(v);
        mesh.add_vertex(Point(p[0], p[1], p[2]));
    }
    for (uint32_t f = 0; f < in.faces; f++) {
        for (uint32_t k = 0; k < in.degree; k++) {
            face[k] = Vertex(in.corners[f * in.degree + k]);
        }
        mesh.add_face(face);
    }
}

Mesh &cgal_mesh(bench_side *side)
{
    if (side->mesh == nullptr) {
        Mesh *mesh = new Mesh;
        cgal_fill(side->input, *mesh);
        side->mesh = mesh;
    }
    return *static_cast<Mesh *>(side->mesh);
}

static uint64_t counts(const Mesh &mesh, uint64_t hash)
{
    return bench_counts(hash, mesh.number_of_vertices(), mesh.number_of_edges(),
                        mesh.number_of_faces());
}

uint64_t cgal_hash(const Mesh &mesh)
{
    uint64_t hash = 0;
    std::vector<uint32_t> corners;
    for (Face f : mesh.faces()) {
        corners.clear();
        for (Vertex v : vertices_around_face(mesh.halfedge(f), mesh)) {
            corners.push_back(v);
        }
        hash += bench_face_hash(corners.data(), corners.size());
    }
    return counts(mesh, hash);
}

void cgal_describe(const Mesh &mesh, bench_result *out)
{
    double sum = 0;
    for (Vertex v : mesh.vertices()) {
        const Point &p = mesh.point(v);
        sum += std::fabs(p.x()) + 2 * std::fabs(p.y()) + 3 * std::fabs(p.z());
    }
    out->amount = mesh.number_of_faces();
    bench_exact(out, counts(mesh, 0));
    bench_near(out, sum);
}

namespace
{
namespace PMP = CGAL::Polygon_mesh_processing;

void build(bench_side *side, bench_result *out)
{
    double start = bench_seconds();
    Mesh *mesh = new Mesh;
    cgal_fill(side->input, *mesh);
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, cgal_hash(*mesh));
    delete mesh;
}

void one_ring(bench_side *side, bench_result *out)
{
    const Mesh &mesh = cgal_mesh(side);
    double sum = 0, start = bench_seconds();
    uint64_t visited = 0;
    for (Vertex v : mesh.vertices()) {
        for (Vertex w : vertices_around_target(mesh.halfedge(v), mesh)) {
            const Point &p = mesh.point(w);
            sum += p.x() + p.y() + p.z();
            visited++;
        }
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(visited);
    bench_near(out, sum);
}

double weigh(const Vector &n)
{
    return std::fabs(n.x()) + 2 * std::fabs(n.y()) + 3 * std::fabs(n.z());
}

void face_normals(bench_side *side, bench_result *out)
{
    Mesh &mesh = cgal_mesh(side);
    auto normals = mesh.add_property_map<Face, Vector>("f:normal").first;
    double start = bench_seconds();
    PMP::compute_face_normals(mesh, normals);
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_faces();
    double sum = 0;
    for (Face f : mesh.faces()) {
        sum += weigh(normals[f]);
    }
    bench_near(out, sum);
    mesh.remove_property_map(normals);
}

void vertex_normals(bench_side *side, bench_result *out)
{
    Mesh &mesh = cgal_mesh(side);
    auto normals = mesh.add_property_map<Vertex, Vector>("v:normal").first;
    double start = bench_seconds();
    PMP::compute_vertex_normals(mesh, normals);
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_vertices();
    double sum = 0;
    for (Vertex v : mesh.vertices()) {
        sum += weigh(normals[v]);
    }
    bench_near(out, sum);
    mesh.remove_property_map(normals);
}

/* Finds the boundary loops and their lengths, by the walk that CGAL's own functions about borders
 * make. */
void loops(bench_side *side, bench_result *out)
{
    const Mesh &mesh = cgal_mesh(side);
    double start = bench_seconds();
    std::vector<bool> seen(mesh.num_halfedges());
    std::vector<std::pair<Halfedge, uint32_t>> found;
    for (Halfedge h : mesh.halfedges()) {
        if (!mesh.is_border(h) || seen[h]) {
            continue;
        }
        uint32_t length = 0;
        for (Halfedge k : halfedges_around_face(h, mesh)) {
            seen[k] = true;
            length++;
        }
        found.emplace_back(h, length);
    }
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_halfedges();
    uint64_t hash = found.size();
    for (auto &one : found) {
        hash += static_cast<uint64_t>(one.second) * one.second << 20;
    }
    bench_exact(out, hash);
}

void components(bench_side *side, bench_result *out)
{
    Mesh &mesh = cgal_mesh(side);
    auto label = mesh.add_property_map<Face, uint32_t>("f:component").first;
    double start = bench_seconds();
    size_t count = PMP::connected_components(mesh, label);
    std::vector<uint64_t> sizes(count);
    for (Face f : mesh.faces()) {
        sizes[label[f]]++;
    }
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_faces();
    uint64_t hash = count;
    for (uint64_t size : sizes) {
        hash += size * size << 8;
    }
    bench_exact(out, hash);
    mesh.remove_property_map(label);
}
} // namespace

const bench_row cgal_kernel_rows[] = {{"build", build},
                                      {"one_ring", one_ring},
                                      {"face_normals", face_normals},
                                      {"vertex_normals", vertex_normals},
                                      {"loops", loops},
                                      {"components", components},
                                      {nullptr, nullptr}};
