/* ours.h - the kernel's side of the bench. A row's work is between two calls of bench_seconds; what
 * it needs before and what is compared afterwards is not measured. */
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
extern const bench_row bench_scaling_rows[];
extern const bench_row bench_subdivide_rows[];
extern const bench_row bench_memory_rows[];
extern const bench_row bench_growth_rows[];
extern const bench_row bench_stored_rows[];

/* Ends the program with the status' title unless it is HE_OK. */
void bench_require(he_status status);
/* The input as a soup that borrows its arrays: not to be cleared. */
he_soup bench_soup(const bench_side *side);
/* The mesh of the input, made at the first call. */
he_mesh *bench_mesh(bench_side *side);
/* A file of the folder, fed to a reader in pieces; cleared by the caller. */
void bench_read(const bench_side *side, const char *format, const char *name, he_import *out);
/* And written; `encoding` may be empty. */
void bench_write(const bench_side *side, const he_mesh *m, const char *format, const char *encoding,
                 const char *name);
/* Vertices, edges, faces and every face's corners. */
uint64_t bench_mesh_hash(const he_mesh *m);

#endif
