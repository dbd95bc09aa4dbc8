/* writing.h - functions that tests call to change a stored mesh with one or two calls. */
#ifndef TESTS_WRITING_H
#define TESTS_WRITING_H

#include "store/write.h"

/* Begins a write. Returns the stored mesh as an object that the test may edit and whose changes are
 * recorded; NULL on failure. */
he_mesh *writing_begin(st_mesh *mesh, st_write *write);

/* Commits an edit. The mesh's new revision and times are copied to `info` unless it is NULL. If
 * memory is out while the changed elements are listed, the write is aborted and the function
 * returns false. */
bool writing_commit(st_write *write, const char *ops, st_mesh_info *info);

/* Undoes or redoes steps of the mesh's history as one write. */
st_status writing_step(st_mesh *mesh, st_action which, uint32_t steps);

/* Replaces the elements and attributes of the stored mesh by those of `takes`, which then belongs
 * to the stored mesh. Sets the name of the mesh unless `name` is NULL. */
st_status writing_replace(st_mesh *mesh, he_mesh *takes, const char *name, st_mesh_info *info);

/* Removes the mesh from its store. */
st_status writing_remove(st_mesh *mesh);

#endif
