/* corpus.h - meshes of files, as the oracle's. */
#ifndef TESTS_MODEL_CORPUS_H
#define TESTS_MODEL_CORPUS_H

#include "model/starts.h"

typedef struct md_file {
    char name[MD_START_NAME];
    he_mesh *mesh;
} md_file;

/* How many files there are, by name; both the list and the meshes are the caller's. */
size_t md_corpus_read(md_file **out);
/* Fill an empty oracle with what lives in a mesh that has no dead elements. */
void md_take(or_mesh *o, const he_mesh *m);

#endif
