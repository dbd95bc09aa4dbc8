/* tally.h - counts the outcomes of each operation, for each start and in total. */
#ifndef TESTS_MODEL_TALLY_H
#define TESTS_MODEL_TALLY_H

#include "op/op.h"

enum { MD_ROWS = 64 };

typedef struct md_row_tally {
    uint64_t done;
    uint64_t refused[HE_STATUS_COUNT];
    /* The highest N for which the model test made the N-th allocation of the operation fail. */
    uint32_t starved;
} md_row_tally;

typedef struct md_tally {
    uint64_t edits, meshes, undone, rolled_back;
    uint32_t faces; /* number of faces of the largest mesh */
    md_row_tally row[MD_ROWS];
} md_tally;

void md_tally_add(md_tally *sum, const md_tally *part);
/* Prints the totals in one line. */
void md_tally_print(const md_tally *tally, const char *name);
/* Prints a line for each operation, with `before` in front: how often it succeeded, how often it
 * was refused for each reason, and after `never:` the declared refusals that did not occur. */
void md_tally_print_rows(const md_tally *tally, const char *before);
/* md_tally_idle returns the number of operations that never succeeded, md_tally_missing the number
 * of declared refusals that never occurred. */
size_t md_tally_idle(const md_tally *tally);
size_t md_tally_missing(const md_tally *tally);

#endif
