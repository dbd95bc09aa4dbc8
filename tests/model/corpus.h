/* corpus.h - meshes read from files, as starts for the model test. */
#ifndef TESTS_MODEL_CORPUS_H
#define TESTS_MODEL_CORPUS_H

#include "model/starts.h"

typedef struct md_file {
    char name[MD_START_NAME];
    he_mesh *mesh;
} md_file;

/* Reads the mesh files of the corpus, sorted by name, and returns their number; the caller must
 * free the list and the meshes. */
size_t md_corpus_read(md_file **out);
/* Copies the elements of a mesh, none of which is deleted, into an empty oracle. */
void md_take(or_mesh *o, const he_mesh *m);

#endif
