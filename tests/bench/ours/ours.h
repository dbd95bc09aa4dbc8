/* ours.h - functions for all rows (benchmark tasks) in the program that runs hedge's kernel. A row
 * measures its work between two calls of bench_seconds; what it prepares before and compares
 * afterwards is not measured. */
#ifndef TESTS_BENCH_OURS_OURS_H
#define TESTS_BENCH_OURS_OURS_H

#include "bench/side/side.h"
#include "build/build.h"
#include "format/io/format.h"

extern const bench_row bench_build_rows[];
extern const bench_row bench_walk_rows[];
extern const bench_row bench_edit_rows[];
extern const bench_row bench_file_rows[];
extern const bench_row bench_document_rows[];
extern const bench_row bench_decimate_rows[];
extern const bench_row bench_error_rows[];
extern const bench_row bench_remesh_rows[];
extern const bench_row bench_scaling_rows[];
extern const bench_row bench_subdivide_rows[];
extern const bench_row bench_memory_rows[];
extern const bench_row bench_growth_rows[];
extern const bench_row bench_stored_rows[];
extern const bench_row bench_segment_rows[];
extern const bench_row bench_deform_rows[];
extern const bench_row bench_fill_rows[];
extern const bench_row bench_smooth_rows[];
extern const bench_row bench_solve_rows[];
extern const bench_row bench_compare_rows[];

/* Ends the program if the status is not HE_OK, and prints the title of the status. */
void bench_require(he_status status);
/* Returns the input as a soup that borrows the arrays of the input, so it must not be cleared. */
he_soup bench_soup(const bench_side *side);
/* Returns the mesh of the input, which the first call makes. */
he_mesh *bench_mesh(bench_side *side);
/* Reads a file of the benchmark's folder in pieces; the caller must clear `out`. */
void bench_read(const bench_side *side, const char *format, const char *name, he_import *out);
/* Writes the mesh to a file of the benchmark's folder; `encoding` may be empty. */
void bench_write(const bench_side *side, const he_mesh *m, const char *format, const char *encoding,
                 const char *name);
/* Writes the positions of the vertices of a mesh, from number `first` on, into a file of the
 * benchmark's folder. */
void bench_write_positions(const bench_side *side, const char *name, const he_mesh *m,
                           uint32_t first);
/* Measures the distance in both directions between the input and a mesh of triangles in a PLY file
 * of the benchmark's folder, and reports the larger one. VALUE: the root mean square; NEAR: the
 * farthest distance, which estimates the Hausdorff distance; AMOUNT: points where a face is turned
 * over. */
void bench_distance(bench_side *side, const char *name, bench_result *out);
/* Returns a copy of the input whose vertices bench_bend has moved. */
he_mesh *bench_bent(bench_side *side);
/* Returns a hash of the vertices, edges, faces and the corners of every face. */
uint64_t bench_mesh_hash(const he_mesh *m);

#endif
