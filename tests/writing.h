/* writing.h - for tests, writes to a stored mesh that take one or two calls. */
#ifndef TESTS_WRITING_H
#define TESTS_WRITING_H

#include "store/write.h"

/* Begins a write. Returns the content of the mesh, in which changes are recorded; NULL on
 * failure. */
he_mesh *writing_begin(st_mesh *mesh, st_write *write);

/* Commits an edit. The mesh's new revision and times are copied to `info` unless it is NULL. If
 * memory is out when the changed elements are collected, aborts the write and returns false. */
bool writing_commit(st_write *write, const char *ops, st_mesh_info *info);

/* Undoes or redoes steps as one write. */
st_status writing_step(st_mesh *mesh, st_action which, uint32_t steps);

/* Replaces the content of the mesh by `takes`, which then belongs to the mesh. Sets the name of the
 * mesh unless `name` is NULL. */
st_status writing_replace(st_mesh *mesh, he_mesh *takes, const char *name, st_mesh_info *info);

/* Removes the mesh from its store. */
st_status writing_remove(st_mesh *mesh);

#endif
