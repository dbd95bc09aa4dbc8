/* Subdivision and decimation with OpenMesh. */
#include "bench/peers/openmesh.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>

#include <cmath>
#include <cstdio>

namespace
{
template <class Mesh> void describe(const Mesh &mesh, bench_result *out)
{
    double sum = 0;
    for (auto v : mesh.vertices()) {
        const auto &p = mesh.point(v);
        sum += std::fabs(p[0]) + 2 * std::fabs(p[1]) + 3 * std::fabs(p[2]);
    }
    out->amount = static_cast<double>(mesh.n_faces());
    bench_exact(out, bench_counts(0, mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()));
    bench_near(out, sum);
}

template <class Mesh, class Scheme> void subdivide(bench_side *side, bench_result *out)
{
    Mesh mesh = mesh_of<Mesh>(side);
    Scheme scheme;
    double start = bench_seconds();
    scheme(mesh, 1);
    out->value = bench_seconds() - start;
    describe(mesh, out);
}

void loop(bench_side *side, bench_result *out)
{
    subdivide<TriMesh, OpenMesh::Subdivider::Uniform::LoopT<TriMesh, double>>(side, out);
}

void catmull_clark(bench_side *side, bench_result *out)
{
    subdivide<PolyMesh, OpenMesh::Subdivider::Uniform::CatmullClarkT<PolyMesh, double>>(side, out);
}

/* Decimates to a tenth of the faces. The result stays in the folder, so that its error can be
 * measured. */
void decimate(bench_side *side, bench_result *out)
{
    typedef OpenMesh::Decimater::DecimaterT<TriMesh> Decimater;
    typedef OpenMesh::Decimater::ModQuadricT<TriMesh> Quadric;
    char path[512];
    TriMesh mesh = mesh_of<TriMesh>(side);
    double start = bench_seconds();
    Decimater decimater(mesh);
    Quadric::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, mesh.n_faces() / 10);
    mesh.garbage_collection();
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, static_cast<double>(mesh.n_faces()));
    bench_path(side, "decimated.ply", path, sizeof path);
    if (!OpenMesh::IO::write_mesh(mesh, path, OpenMesh::IO::Options::Binary)) {
        std::fprintf(stderr, "OpenMesh cannot write %s\n", path);
        std::exit(1);
    }
}
} // namespace

const bench_row openmesh_whole_rows[] = {
    {"loop", loop}, {"catmull_clark", catmull_clark}, {"decimate", decimate}, {nullptr, nullptr}};
