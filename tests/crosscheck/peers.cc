// peers.cpp - what OpenMesh and CGAL read from mesh files: for each file a line
//
//     openmesh|cgal FILE VERTICES EDGES FACES CORNERS
//
// where EDGES is - of a reader that makes no edges, and everything is - where it refuses the file.
// With --write FOLDER FILE they write what they have read as FOLDER/openmesh.EXT, FOLDER/cgal.EXT.
#include <CGAL/Simple_cartesian.h>
#include <CGAL/IO/polygon_soup_io.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace
{

using point = CGAL::Simple_cartesian<double>::Point_3;
using open_mesh = OpenMesh::PolyMesh_ArrayKernelT<>;

struct soup {
    std::vector<point> points;
    std::vector<std::vector<std::size_t>> polygons;
};

void print_refusal(const char *who, const char *file)
{
    std::printf("%s %s - - - -\n", who, file);
}

bool read_openmesh(const char *file, open_mesh &mesh)
{
    try {
        return OpenMesh::IO::read_mesh(mesh, file);
    } catch (...) {
        return false;
    }
}

bool read_cgal(const char *file, soup &s)
{
    try {
        return CGAL::IO::read_polygon_soup(file, s.points, s.polygons);
    } catch (...) {
        return false;
    }
}

void look_at(const char *file)
{
    open_mesh mesh;
    if (read_openmesh(file, mesh)) {
        std::size_t corners = 0;
        for (auto face : mesh.faces()) {
            corners += mesh.valence(face);
        }
        std::printf("openmesh %s %zu %zu %zu %zu\n", file, mesh.n_vertices(), mesh.n_edges(),
                    mesh.n_faces(), corners);
    } else {
        print_refusal("openmesh", file);
    }
    soup s;
    if (read_cgal(file, s)) {
        std::size_t corners = 0;
        for (const auto &polygon : s.polygons) {
            corners += polygon.size();
        }
        std::printf("cgal %s %zu - %zu %zu\n", file, s.points.size(), s.polygons.size(), corners);
    } else {
        print_refusal("cgal", file);
    }
}

bool write_as(const std::string &folder, const char *file)
{
    open_mesh mesh;
    soup s;
    if (!read_openmesh(file, mesh) || !read_cgal(file, s)) {
        return false;
    }
    bool good = true;
    for (const char *extension : {".obj", ".off", ".ply", ".stl"}) {
        good = OpenMesh::IO::write_mesh(mesh, folder + "/openmesh" + extension) && good;
        good = CGAL::IO::write_polygon_soup(folder + "/cgal" + extension, s.points, s.polygons) &&
               good;
    }
    return good;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc == 4 && std::strcmp(argv[1], "--write") == 0) {
        return write_as(argv[2], argv[3]) ? 0 : 1;
    }
    for (int i = 1; i < argc; i++) {
        look_at(argv[i]);
    }
    return 0;
}
