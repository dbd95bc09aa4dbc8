/* writing.h - writes to a stored mesh in one call each, for tests. */
#ifndef TESTS_WRITING_H
#define TESTS_WRITING_H

#include "store/write.h"

/* Begins a write; returns the content, which records the changes made to it, or NULL on failure. */
he_mesh *writing_begin(st_mesh *mesh, st_write *write);

/* Commits an edit and copies the mesh's new revision and times to `info` unless it is NULL. If
 * there is no memory to compute what the edit changed, aborts the write and returns false. */
bool writing_commit(st_write *write, const char *ops, st_mesh_info *info);

/* Undoes or redoes steps in one write. */
st_status writing_step(st_mesh *mesh, st_action which, uint32_t steps);

/* Replaces the content of the mesh by `takes`, which then belongs to it, and sets the name unless
 * it is NULL. */
st_status writing_replace(st_mesh *mesh, he_mesh *takes, const char *name, st_mesh_info *info);

/* Removes the mesh from its store. */
st_status writing_remove(st_mesh *mesh);

#endif
