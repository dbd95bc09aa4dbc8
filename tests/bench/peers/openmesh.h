/* openmesh.h - types and functions for all rows (benchmark tasks) in the program that runs
 * OpenMesh. Positions and normals are doubles, as in hedge. */
#ifndef TESTS_BENCH_PEERS_OPENMESH_H
#define TESTS_BENCH_PEERS_OPENMESH_H

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <cstdlib>
#include <vector>

extern "C" {
#include "bench/side/side.h"
}

typedef OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble> TriMesh;
typedef OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble> PolyMesh;

/* Builds the mesh of the input, with space reserved, since the counts are known. */
template <class Mesh> void fill(const bench_input &in, Mesh &mesh)
{
    size_t corners = static_cast<size_t>(in.faces) * in.degree;
    std::vector<typename Mesh::VertexHandle> face(in.degree);
    mesh.reserve(in.vertices, corners / 2 + (in.degree == 4 ? 4000 : 0), in.faces);
    for (uint32_t v = 0; v < in.vertices; v++) {
        const double *p = in.positions + 3 * static_cast<size_t>(v);
        mesh.add_vertex(typename Mesh::Point(p[0], p[1], p[2]));
    }
    for (uint32_t f = 0; f < in.faces; f++) {
        for (uint32_t k = 0; k < in.degree; k++) {
            face[k] = typename Mesh::VertexHandle(static_cast<int>(in.corners[f * in.degree + k]));
        }
        mesh.add_face(face);
    }
}

template <class Mesh> uint64_t counts(const Mesh &mesh, uint64_t hash)
{
    uint64_t vertices = 0, edges = 0, faces = 0;
    for (auto v : mesh.vertices()) {
        (void)v;
        vertices++;
    }
    for (auto e : mesh.edges()) {
        (void)e;
        edges++;
    }
    for (auto f : mesh.faces()) {
        (void)f;
        faces++;
    }
    return bench_counts(hash, vertices, edges, faces);
}

template <class Mesh> uint64_t mesh_hash(const Mesh &mesh)
{
    uint64_t hash = 0;
    std::vector<uint32_t> corners;
    for (auto f : mesh.faces()) {
        corners.clear();
        for (auto h : mesh.fh_range(f)) {
            corners.push_back(static_cast<uint32_t>(mesh.from_vertex_handle(h).idx()));
        }
        hash += bench_face_hash(corners.data(), corners.size());
    }
    return counts(mesh, hash);
}

/* Returns the mesh of the input, which the first call makes. A program may call it for only one
 * type of mesh. */
template <class Mesh> Mesh &mesh_of(bench_side *side)
{
    if (side->mesh == nullptr) {
        Mesh *mesh = new Mesh;
        fill(side->input, *mesh);
        side->mesh = mesh;
    }
    return *static_cast<Mesh *>(side->mesh);
}

extern const bench_row openmesh_kernel_rows[];
extern const bench_row openmesh_edit_rows[];
extern const bench_row openmesh_file_rows[];
extern const bench_row openmesh_whole_rows[];

#endif
