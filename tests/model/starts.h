/* starts.h - the meshes random edits start from, and how many of the edits each gets: every family
 * of shapes.h, and the files of the shared corpus that there are. */
#ifndef TESTS_MODEL_STARTS_H
#define TESTS_MODEL_STARTS_H

#include "model/random.h"
#include "oracle/oracle.h"

enum { MD_START_NAME = 64 };

typedef struct md_start {
    char name[MD_START_NAME];
    double share;                           /* of all edits; they sum up to 1 */
    void (*fill)(or_mesh *o, md_random *r); /* NULL for a file */
    he_mesh *file;
    bool far; /* coordinates up to the end of doubles: not for rows that compute with them */
} md_start;

typedef struct md_starts {
    md_start *start;
    size_t count;
    size_t files; /* the last ones */
} md_starts;

/* Files are read from CORPUS=, ../shared/corpus when that is not set: those with a mesh in them
 * that he_build takes as it is and that leaves the oracle room. They are brought into the box the
 * shapes are in, since the oracle's tolerances are made for that. */
md_starts md_starts_find(void);
void md_starts_clear(md_starts *starts);

/* A new mesh of this start, in the oracle and in hedge. NULL when he_build refuses. */
he_mesh *md_begin(const md_start *start, or_mesh *o, md_random *r);

#endif
