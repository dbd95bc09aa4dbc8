/* mesh_load.h - a mesh comes back from the journal.
 *
 *     base:                [content]                            the history begins here
 *     records after it:    [edit] [edit] [undo] [rename] ...    each by the functions that made it
 *     end:                 what the card says must be so, he_check
 *
 * The content, the undo and redo stacks, the entries of the history and the facts are then what
 * they were when the last of the records was made. */
#ifndef HE_STORE_MESH_LOAD_H
#define HE_STORE_MESH_LOAD_H

#include "store/stored_mesh.h"

/* Makes room in memory and reads all pieces of a mesh. `until` is a revision: what comes after it
 * is not applied, and the history is the one of then; 0 for all. ST_GONE: the base is of a later
 * revision, or no record leads to just that one; only the first costs less than a load. ST_DAMAGED
 * where the pieces make no mesh or another than the card's, which condemns it; ST_NEWER where one
 * is of a version that is not known: `damage` says what is wrong. ST_FAILED, ST_NO_MEMORY,
 * ST_BUDGET. */
st_status st_mesh_load(const st_mesh_options *options, const st_card *card, st_reader *reader,
                       uint64_t until, st_mesh **out, char damage[ST_DAMAGE]);
/* As far as the pieces make a mesh: it is at the revision up to which they do, and `damage` says
 * what is wrong after it, "" where nothing is. ST_DAMAGED, with `damage`, where they make none;
 * ST_NEWER likewise; ST_FAILED, ST_NO_MEMORY, ST_BUDGET. */
st_status st_mesh_salvage(const st_mesh_options *options, const st_card *card, st_reader *reader,
                          st_mesh **out, char damage[ST_DAMAGE]);
/* A second copy of a mesh, up to a revision (0: the newest), with all of the history that the disk
 * has of it and no budget; in no table, and freed by st_release. Waits, without a lock. ST_GONE
 * where the records do not reach back to the revision; *out is NULL then and after ST_FAILED,
 * ST_NO_MEMORY, ST_BUDGET. */
st_status st_mesh_load_apart(st_mesh *mesh, uint64_t until, st_mesh **out);

#endif
