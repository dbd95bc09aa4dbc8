/* Mesh files with CGAL, as its users read and write them. */
#include "bench/peers/cgal.h"

#include <CGAL/Surface_mesh/IO.h>
#include <CGAL/boost/graph/IO/OBJ.h>
#include <CGAL/boost/graph/IO/OFF.h>
#include <CGAL/boost/graph/IO/PLY.h>
#include <CGAL/boost/graph/IO/STL.h>

#include <cstdio>
#include <string>

namespace
{
enum { PATH = 512 };

std::string file_in(const bench_side *side, const char *name)
{
    char path[PATH];
    bench_path(side, name, path, sizeof path);
    return path;
}

void require(bool good, const std::string &path)
{
    if (!good) {
        std::fprintf(stderr, "CGAL cannot read or write %s\n", path.c_str());
        std::exit(1);
    }
}

template <class Read> void import(bench_side *side, const char *name, Read read, bench_result *out)
{
    std::string path = file_in(side, name);
    double start = bench_seconds();
    Mesh *mesh = new Mesh;
    require(read(path, *mesh), path);
    out->value = bench_seconds() - start;
    cgal_describe(*mesh, out);
    delete mesh;
}

void import_obj(bench_side *side, bench_result *out)
{
    import(
        side, "input.obj",
        [](const std::string &path, Mesh &mesh) { return CGAL::IO::read_OBJ(path, mesh);
}, out);
} // namespace
void import_off(bench_side *side, bench_result *out)
{
    import(
        side, "input.off",
        [](const std::string &path, Mesh &mesh) { return CGAL::IO::read_OFF(path, mesh);
}, out);
}
void import_ply(bench_side *side, bench_result *out)
{
    import(
        side, "input.ply",
        [](const std::string &path, Mesh &mesh) { return CGAL::IO::read_PLY(path, mesh);
}, out);
}
void import_stl(bench_side *side, bench_result *out)
{
    import(
        side, "input.stl",
        [](const std::string &path, Mesh &mesh) { return CGAL::IO::read_STL(path, mesh);
}, out);
}

/* Writes text with 17 digits, from which any double is read back exactly. */
void export_obj(bench_side *side, bench_result *out)
{
    std::string path = file_in(side, "output.obj");
    const Mesh &mesh = cgal_mesh(side);
    double start = bench_seconds();
    require(CGAL::IO::write_OBJ(path, mesh, CGAL::parameters::stream_precision(17)), path);
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_faces();
}

void export_ply(bench_side *side, bench_result *out)
{
    std::string path = file_in(side, "output.ply");
    const Mesh &mesh = cgal_mesh(side);
    double start = bench_seconds();
    require(CGAL::IO::write_PLY(path, mesh, CGAL::parameters::use_binary_mode(true)), path);
    out->value = bench_seconds() - start;
    out->amount = mesh.number_of_faces();
}
} // namespace

const bench_row cgal_file_rows[] = {{"import_obj", import_obj}, {"import_off", import_off},
                                    {"import_ply", import_ply}, {"import_stl", import_stl},
                                    {"export_obj", export_obj}, {"export_ply", export_ply},
                                    {nullptr, nullptr}};
