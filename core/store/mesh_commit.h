/* mesh_commit.h - what mesh_write.c and mesh_commit.c share of a write. */
#ifndef HE_STORE_MESH_COMMIT_H
#define HE_STORE_MESH_COMMIT_H

#include "store/stored_mesh.h"
#include "store/write.h"

/* Under the lock: forgets the claim. */
void st_mesh_unclaim(st_mesh *mesh);
/* Under the lock: what st_write_abort does. */
void st_write_give_up(st_write *write);
/* Gives the lock back and frees `discard` and what the write held. */
void st_write_end(st_write *write, he_mesh *discard);

#endif
