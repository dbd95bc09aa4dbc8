/* cgal.h - types and functions for all rows (benchmark tasks) in the program that runs CGAL; its
 * mesh is a Surface_mesh with doubles. */
#ifndef TESTS_BENCH_PEERS_CGAL_H
#define TESTS_BENCH_PEERS_CGAL_H

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

extern "C" {
#include "bench/side/side.h"
}

typedef CGAL::Simple_cartesian<double> Kernel;
typedef Kernel::Point_3 Point;
typedef Kernel::Vector_3 Vector;
typedef CGAL::Surface_mesh<Point> Mesh;

typedef Mesh::Vertex_index Vertex;
typedef Mesh::Halfedge_index Halfedge;
typedef Mesh::Edge_index Edge;
typedef Mesh::Face_index Face;

/* Builds the mesh of the input, with space reserved, since the counts are known. */
void cgal_fill(const bench_input &in, Mesh &mesh);
/* Returns the mesh of the input, which the first call makes. */
Mesh &cgal_mesh(bench_side *side);
uint64_t cgal_hash(const Mesh &mesh);
/* Reports the counts of a mesh and the sum of its coordinates. */
void cgal_describe(const Mesh &mesh, bench_result *out);

/* Writes the points of vertices of a mesh into a file of the benchmark's folder. */
template <typename Vertices>
void cgal_write_points(const bench_side *side, const char *name, const Mesh &mesh,
                       const Vertices &vertices)
{
    FILE *file = bench_open(side, name, "wb");
    for (Vertex v : vertices) {
        const double c[3] = {mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()};
        if (std::fwrite(c, sizeof c, 1, file) != 1) {
            std::exit(1);
        }
    }
    std::fclose(file);
}

extern const bench_row cgal_kernel_rows[];
extern const bench_row cgal_edit_rows[];
extern const bench_row cgal_file_rows[];
extern const bench_row cgal_whole_rows[];
extern const bench_row cgal_segment_rows[];
extern const bench_row cgal_remesh_rows[];
extern const bench_row cgal_deform_rows[];
extern const bench_row cgal_fill_rows[];
extern const bench_row cgal_smooth_rows[];
extern const bench_row cgal_compare_rows[];

#endif
