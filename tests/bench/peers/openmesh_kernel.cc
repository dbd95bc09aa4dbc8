/* Building and reading a whole mesh with OpenMesh: with its triangle mesh if all faces are
 * triangles, else with its polygon mesh. */
#include "bench/peers/openmesh.h"

#include <cmath>

namespace
{
template <class Mesh> void build_as(bench_side *side, bench_result *out)
{
    double start = bench_seconds();
    Mesh *mesh = new Mesh;
    fill(side->input, *mesh);
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, mesh_hash(*mesh));
    delete mesh;
}

void build(bench_side *side, bench_result *out)
{
    side->input.degree == 3 ? build_as<TriMesh>(side, out) : build_as<PolyMesh>(side, out);
}

template <class Mesh> void one_ring_as(bench_side *side, bench_result *out)
{
    const Mesh &mesh = mesh_of<Mesh>(side);
    double sum = 0, start = bench_seconds();
    uint64_t visited = 0;
    for (auto v : mesh.vertices()) {
        for (auto vv = mesh.cvv_iter(v); vv.is_valid(); ++vv) {
            const auto &p = mesh.point(*vv);
            sum += p[0] + p[1] + p[2];
            visited++;
        }
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(visited);
    bench_near(out, sum);
}

void one_ring(bench_side *side, bench_result *out)
{
    side->input.degree == 3 ? one_ring_as<TriMesh>(side, out) : one_ring_as<PolyMesh>(side, out);
}

template <class Normal> double weigh(const Normal &n)
{
    return std::fabs(n[0]) + 2 * std::fabs(n[1]) + 3 * std::fabs(n[2]);
}

void face_normals(bench_side *side, bench_result *out)
{
    TriMesh &mesh = mesh_of<TriMesh>(side);
    mesh.request_face_normals();
    double start = bench_seconds();
    mesh.update_face_normals();
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh.n_faces());
    double sum = 0;
    for (auto f : mesh.faces()) {
        sum += weigh(mesh.normal(f));
    }
    bench_near(out, sum);
    mesh.release_face_normals();
}

/* OpenMesh computes vertex normals from face normals, so those are part of the measured work. */
void vertex_normals(bench_side *side, bench_result *out)
{
    TriMesh &mesh = mesh_of<TriMesh>(side);
    mesh.request_face_normals();
    mesh.request_vertex_normals();
    double start = bench_seconds();
    mesh.update_face_normals();
    mesh.update_vertex_normals();
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh.n_vertices());
    double sum = 0;
    for (auto v : mesh.vertices()) {
        sum += weigh(mesh.normal(v));
    }
    bench_near(out, sum);
    mesh.release_vertex_normals();
    mesh.release_face_normals();
}

/* Finds the boundary loops. OpenMesh has no function for this; the loop is what its users write. */
void loops(bench_side *side, bench_result *out)
{
    const PolyMesh &mesh = mesh_of<PolyMesh>(side);
    double start = bench_seconds();
    std::vector<bool> seen(mesh.n_halfedges());
    std::vector<std::pair<uint32_t, uint32_t>> found;
    for (size_t i = 0; i < mesh.n_halfedges(); i++) {
        PolyMesh::HalfedgeHandle first(static_cast<int>(i)), h = first;
        if (!mesh.is_boundary(h) || seen[i]) {
            continue;
        }
        uint32_t length = 0;
        do {
            seen[static_cast<size_t>(h.idx())] = true;
            length++;
            h = mesh.next_halfedge_handle(h);
        } while (h != first);
        found.emplace_back(i, length);
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh.n_halfedges());
    uint64_t hash = found.size();
    for (auto &one : found) {
        hash += static_cast<uint64_t>(one.second) * one.second << 20;
    }
    bench_exact(out, hash);
}

/* Finds the components, by a flood fill over faces, because OpenMesh has no function for this. */
void components(bench_side *side, bench_result *out)
{
    const TriMesh &mesh = mesh_of<TriMesh>(side);
    double start = bench_seconds();
    std::vector<int> label(mesh.n_faces(), -1);
    std::vector<uint64_t> sizes;
    std::vector<TriMesh::FaceHandle> open;
    for (size_t i = 0; i < mesh.n_faces(); i++) {
        if (label[i] >= 0) {
            continue;
        }
        int component = static_cast<int>(sizes.size());
        sizes.push_back(0);
        label[i] = component;
        open.push_back(TriMesh::FaceHandle(static_cast<int>(i)));
        while (!open.empty()) {
            TriMesh::FaceHandle f = open.back();
            open.pop_back();
            sizes.back()++;
            for (auto ff = mesh.cff_iter(f); ff.is_valid(); ++ff) {
                int &of = label[static_cast<size_t>(ff->idx())];
                if (of < 0) {
                    of = component;
                    open.push_back(*ff);
                }
            }
        }
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh.n_faces());
    uint64_t hash = sizes.size();
    for (uint64_t size : sizes) {
        hash += size * size << 8;
    }
    bench_exact(out, hash);
}
} // namespace

const bench_row openmesh_kernel_rows[] = {{"build", build},
                                          {"one_ring", one_ring},
                                          {"face_normals", face_normals},
                                          {"vertex_normals", vertex_normals},
                                          {"loops", loops},
                                          {"components", components},
                                          {nullptr, nullptr}};
