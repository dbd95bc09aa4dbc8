/* mesh_load.h - loads a mesh from the journal.
 *
 *     base:                [content]                            the history begins here
 *     records after it:    [edit] [edit] [undo] [rename] ...    each change is made again
 *     end:                 the mesh must agree with its card and pass he_check
 *
 * After the load, the mesh has the content, the undo and redo stacks, the entries of the history,
 * the name and all counters that it had after the last record. */
#ifndef HE_STORE_MESH_LOAD_H
#define HE_STORE_MESH_LOAD_H

#include "store/stored_mesh.h"

/* Makes room in memory and loads a mesh from the pieces that `reader` reads. `until` is the
 * revision at which the load stops, with the history as it was then; 0 loads the newest revision.
 * If it returns ST_DAMAGED or ST_NEWER, card->damage says what is wrong.
 * Returns ST_GONE if the first content on the disk is of a later revision than `until`, or if no
 * record leads to exactly `until`.
 * Returns ST_DAMAGED if the pieces make no valid mesh, or not the mesh that the card describes; the
 * card is then marked as damaged.
 * Returns ST_NEWER if a newer release wrote a piece.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_mesh_load(const st_mesh_options *options, st_card *card, st_reader *reader,
                       uint64_t until, st_mesh **out);
/* Loads as much of a mesh as is intact: up to the last revision that can be read. `damage` says
 * what prevents reading more, "" if nothing does.
 * Returns ST_DAMAGED with `damage` if no revision can be read.
 * Returns ST_NEWER with `damage` if a newer release wrote the first piece.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_mesh_salvage(const st_mesh_options *options, const st_card *card, st_reader *reader,
                          st_mesh **out, char damage[ST_DAMAGE]);
/* Loads a second copy of a mesh, up to a revision (0: the newest), with all of the history that is
 * on the disk, without the limit of the undo budget. The copy is not in the store's table of
 * meshes; st_release frees it. Waits for the disk; the caller must hold no lock. On failure *out is
 * NULL.
 * Returns ST_GONE if the records do not reach back to the revision.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_mesh_load_apart(st_mesh *mesh, uint64_t until, st_mesh **out);

#endif
