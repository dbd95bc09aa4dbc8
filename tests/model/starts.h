/* starts.h - the meshes from which random edits start, and the number of edits for each: every
 * family of shapes.h, and files of the shared corpus. */
#ifndef TESTS_MODEL_STARTS_H
#define TESTS_MODEL_STARTS_H

#include "model/random.h"
#include "oracle/oracle.h"

enum { MD_START_NAME = 64 };

typedef struct md_start {
    char name[MD_START_NAME];
    double share; /* fraction of all edits that begin from this start; the fractions of all starts
                     add up to 1 */
    /* The function that fills the oracle with a random mesh; NULL if the start is a file. */
    void (*fill)(or_mesh *o, md_random *r);
    he_mesh *file;
    /* Coordinates go up to the largest doubles, so operations that compute with them are not
     * drawn. */
    bool far;
} md_start;

typedef struct md_starts {
    md_start *start;
    size_t count;
    size_t files; /* number of starts that are files, which come last in the list */
} md_starts;

/* Finds all starts. The environment variable CORPUS names the folder of mesh files, by default
 * ../shared/corpus. Files are used if he_build accepts their mesh and the oracle's tables have
 * space for it to grow. Their meshes are scaled into the box of the random shapes, for which the
 * oracle's tolerances are made. */
md_starts md_starts_find(void);
void md_starts_clear(md_starts *starts);

/* Makes a new mesh of this start, both in the oracle and in hedge. Returns NULL if he_build refuses
 * it. */
he_mesh *md_begin(const md_start *start, or_mesh *o, md_random *r);

#endif
