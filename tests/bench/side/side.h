/* side.h - one side of the bench: a program that answers the driver, compare.mjs.
 *
 *     PROGRAM INPUT natural|shuffled SIDE FOLDER
 *
 * makes its input and then, for each line `ROW` on its standard input, runs that row once and
 * prints
 *
 *     VALUE AMOUNT EXACT NEAR SYSTEM FAULTS
 *
 * VALUE is what was measured, AMOUNT the elements it is for,
 * EXACT a hash that all sides must share, NEAR a number that they must share up to the row's
 * tolerance; "-" stands for one that the row does not have. A row that this side does not know is
 * answered by `unknown`. Files are found and left in FOLDER.
 *
 * What is measured is seconds of processor time between the row's two calls of bench_seconds, of
 * which SYSTEM were spent in the system, and FAULTS pages had to be found. A word before the row's
 * name asks for bytes:
 *
 *     heap ROW    that the heap has given out at the second call less those at the first
 *     peak ROW    the most that were resident between them less those at the first
 *
 * Both want a process that has not freed much: its memory would be used again. With
 * BENCH_SMALL_PAGES in the environment the system gives no huge pages. */
#ifndef TESTS_BENCH_SIDE_SIDE_H
#define TESTS_BENCH_SIDE_SIDE_H

#include "bench/side/input.h"

#include <stdio.h>

typedef struct bench_result {
    double value, amount, near;
    uint64_t exact;
    bool has_exact, has_near;
} bench_result;

/* What a row is run with. `mesh` is the program's own, kept between rows. */
typedef struct bench_side {
    bench_input input;
    const char *folder;
    void *mesh;
} bench_side;

typedef struct bench_row {
    const char *name;
    void (*run)(bench_side *side, bench_result *out);
} bench_row;

/* The main program. `tables` and each table end with a row, and a table, of NULL. */
int bench_serve(int argc, char **argv, const bench_row *const *tables);

/* Seconds of this program's processor time: what other programs take does not count. Called where
 * the work of a row begins and where it ends. */
double bench_seconds(void);

/* The path of a file in the folder, of at most `size` bytes. */
void bench_path(const bench_side *side, const char *name, char *path, size_t size);
/* That file, opened; the program ends where it cannot be. */
FILE *bench_open(const bench_side *side, const char *name, const char *mode);

/* Set what the sides compare. */
void bench_exact(bench_result *out, uint64_t exact);
void bench_near(bench_result *out, double near);
/* Counts of vertices, edges and faces, folded into a hash. */
uint64_t bench_counts(uint64_t faces_hash, uint64_t vertices, uint64_t edges, uint64_t faces);

#endif
