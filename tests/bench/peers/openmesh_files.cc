/* Mesh files with OpenMesh, as its users read and write them. */
#include "bench/peers/openmesh.h"

#include <cmath>
#include <cstdio>

namespace
{
enum { PATH = 512 };

void import(bench_side *side, const char *name, bench_result *out)
{
    char path[PATH];
    bench_path(side, name, path, sizeof path);
    double start = bench_seconds();
    TriMesh *mesh = new TriMesh;
    if (!OpenMesh::IO::read_mesh(*mesh, path)) {
        std::fprintf(stderr, "OpenMesh cannot read %s\n", path);
        std::exit(1);
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh->n_faces());
    double sum = 0;
    for (auto v : mesh->vertices()) {
        const TriMesh::Point &p = mesh->point(v);
        sum += std::fabs(p[0]) + 2 * std::fabs(p[1]) + 3 * std::fabs(p[2]);
    }
    bench_exact(out, bench_counts(0, mesh->n_vertices(), mesh->n_edges(), mesh->n_faces()));
    bench_near(out, sum);
    delete mesh;
}

/* Writes text with 17 digits, from which any double is read back exactly. */
void write(bench_side *side, const char *name, OpenMesh::IO::Options options, bench_result *out)
{
    char path[PATH];
    const TriMesh &mesh = mesh_of<TriMesh>(side);
    bench_path(side, name, path, sizeof path);
    double start = bench_seconds();
    if (!OpenMesh::IO::write_mesh(mesh, path, options, 17)) {
        std::fprintf(stderr, "OpenMesh cannot write %s\n", path);
        std::exit(1);
    }
    out->value = bench_seconds() - start;
    out->amount = static_cast<double>(mesh.n_faces());
}

void import_obj(bench_side *side, bench_result *out)
{
    import(side, "input.obj", out);
}
void import_off(bench_side *side, bench_result *out)
{
    import(side, "input.off", out);
}
void import_ply(bench_side *side, bench_result *out)
{
    import(side, "input.ply", out);
}
void import_stl(bench_side *side, bench_result *out)
{
    import(side, "input.stl", out);
}
void export_obj(bench_side *side, bench_result *out)
{
    write(side, "output.obj", OpenMesh::IO::Options::Default, out);
}
void export_ply(bench_side *side, bench_result *out)
{
    write(side, "output.ply", OpenMesh::IO::Options::Binary, out);
}
} // namespace

const bench_row openmesh_file_rows[] = {{"import_obj", import_obj}, {"import_off", import_off},
                                        {"import_ply", import_ply}, {"import_stl", import_stl},
                                        {"export_obj", export_obj}, {"export_ply", export_ply},
                                        {nullptr, nullptr}};
