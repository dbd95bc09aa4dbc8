/* mesh_commit.h - functions that mesh_write.c and mesh_commit.c share. */
#ifndef HE_STORE_MESH_COMMIT_H
#define HE_STORE_MESH_COMMIT_H

#include "store/stored_mesh.h"
#include "store/write.h"

/* Ends the claim of a mesh, which reserved it for an edit that works on a copy. The caller holds
 * the mesh's exclusive lock. */
void st_mesh_unclaim(st_mesh *mesh);
/* Does the work of st_write_abort, which ends a write without a change. The caller holds the mesh's
 * exclusive lock. */
void st_write_give_up(st_write *write);
/* Releases the mesh's lock, and frees `discard` and everything that the write owns. */
void st_write_end(st_write *write, he_mesh *discard);

#endif
