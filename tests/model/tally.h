/* tally.h - what was seen of each row of the table, start by start and in all. */
#ifndef TESTS_MODEL_TALLY_H
#define TESTS_MODEL_TALLY_H

#include "op/op.h"

enum { MD_ROWS = 64 };

typedef struct md_row_tally {
    uint64_t done;
    uint64_t refused[HE_STATUS_COUNT];
    uint32_t starved; /* the highest N for which the N-th allocation failed */
} md_row_tally;

typedef struct md_tally {
    uint64_t edits, meshes, undone, rolled_back;
    uint32_t faces; /* of the largest mesh */
    md_row_tally row[MD_ROWS];
} md_tally;

void md_tally_add(md_tally *sum, const md_tally *part);
/* One line. */
void md_tally_print(const md_tally *tally, const char *name);
/* A line for each row, each after `before`: how often it was done, each refusal given, and after
 * `never:` those it declares that were not. */
void md_tally_print_rows(const md_tally *tally, const char *before);
/* Rows that never succeeded; refusals declared and never given. */
size_t md_tally_idle(const md_tally *tally);
size_t md_tally_missing(const md_tally *tally);

#endif
