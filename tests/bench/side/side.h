/* side.h - the main loop of each program in the benchmark, one for each library; compare.mjs starts
 * the programs and compares what they print.
 *
 *     PROGRAM INPUT natural|shuffled SIDE FOLDER
 *
 * makes its input and then, for each line `ROW` on its standard input, runs that row once and
 * prints
 *
 *     VALUE AMOUNT EXACT NEAR SYSTEM FAULTS
 *
 * VALUE is the measurement, AMOUNT the number of elements, EXACT a hash that must be equal in all
 * programs, NEAR a number that must be equal up to the row's tolerance; "-" is printed if the row
 * has none. A row that the program does not have is answered by `unknown`. Files are read from and
 * written to FOLDER.
 *
 * The measurement is in seconds of processor time between the row's two calls of bench_seconds.
 * SYSTEM is the part spent in the system, FAULTS the number of page faults. A word before the row's
 * name measures bytes instead:
 *
 *     heap ROW    allocated on the heap at the second call minus those at the first
 *     peak ROW    the maximum of resident bytes between them minus those at the first
 *
 * Both need a process that has not freed much memory before, because freed memory would be used
 * again. With BENCH_SMALL_PAGES in the environment no huge pages are used. */
#ifndef TESTS_BENCH_SIDE_SIDE_H
#define TESTS_BENCH_SIDE_SIDE_H

#include "bench/side/input.h"

#include <stdio.h>

typedef struct bench_result {
    double value, amount, near;
    uint64_t exact;
    bool has_exact, has_near;
} bench_result;

/* The argument of the function that runs a row. `mesh` belongs to the program and stays as it is
 * between rows. */
typedef struct bench_side {
    bench_input input;
    const char *folder;
    void *mesh;
} bench_side;

typedef struct bench_row {
    const char *name;
    void (*run)(bench_side *side, bench_result *out);
} bench_row;

/* Runs the program with these tables of rows; `tables` and each table end in NULL. */
int bench_serve(int argc, char **argv, const bench_row *const *tables);

/* Returns the processor time of this program in seconds, which does not depend on other programs.
 * It is called at the beginning and the end of a row's work. */
double bench_seconds(void);

/* Returns the length of edges with which the torus of the input is remeshed: regular triangles with
 * such sides, as many as the input has faces, have the area of the torus. */
double bench_remesh_length(const bench_side *side);

/* What a vertex of the torus is in the rows about deformation. */
typedef enum bench_part { BENCH_FREE, BENCH_FIXED, BENCH_HANDLE } bench_part;

/* Returns what a vertex is: those far to the left are fixed, those far to the right handles. */
bench_part bench_deform_part(const bench_side *side, uint32_t vertex);
/* Computes where a handle goes: it is turned and lifted. */
void bench_deform_goal(const bench_side *side, uint32_t vertex, double to[3]);

/* The time of the step of smoothing, in square units of the torus. */
#define BENCH_SMOOTH_TIME 1e-3

/* Returns true if a vertex of the torus is in a cap that is cut off in the rows about filling
 * holes: the one to the right, or the one to the left if `left` is true. */
bool bench_in_cap(const bench_side *side, uint32_t vertex, bool left);

/* Moves a point by a few hundredths, as waves in space say, so that a mesh is a little bent. Bent
 * meshes are compared with a bound of BENCH_COMPARE_BOUND. */
#define BENCH_COMPARE_BOUND 1e-4
void bench_bend(double point[3]);

/* Writes the path of a file in the benchmark's folder, at most `size` bytes. */
void bench_path(const bench_side *side, const char *name, char *path, size_t size);
/* Opens a file of the benchmark's folder; ends the program if that fails. */
FILE *bench_open(const bench_side *side, const char *name, const char *mode);

/* Set the values of a row that are compared between programs. */
void bench_exact(bench_result *out, uint64_t exact);
void bench_near(bench_result *out, double near);
/* Folds counts of vertices, edges and faces into a hash. */
uint64_t bench_counts(uint64_t faces_hash, uint64_t vertices, uint64_t edges, uint64_t faces);

#endif
