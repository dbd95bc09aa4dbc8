/* replay.h - a copy of a mesh that moves from revision to revision, by undoing and redoing the
 * mesh's edits. Each edit has a delta (the log of what it wrote; delta.h); the deltas of successive
 * revisions are the log of the mesh.
 *
 * The deltas belong to the original mesh, which may be edited meanwhile; the copy only reads them.
 * The copy crosses one delta at a time, forwards (as the edit was made) or backwards (as it is
 * undone). Afterwards the copy equals the mesh at that point of the log in every live element, in
 * every column, and in the numbers of issued ids.
 *
 *     log     ... 40 --D--> 41 --E--> 42 --D undone ...      crossing D at 42 again leads to 41's
 *     copy              <------- 42                          links, but keeps what 42 has issued
 *
 * A record of a changed word has the values before and after the change. A column or content (all
 * data of a mesh) that was replaced does not fit into a record: the delta owns it as an object. A
 * delta owns only one of the two objects, the one from before or the one from after the edit,
 * whichever is not in the mesh now. So when the copy crosses such a delta for the first time, the
 * delta must own the objects that are in the mesh after the crossing (he_crossing.held). From then
 * on the copy keeps the objects that each crossing has taken out of it. Crossings of one delta
 * alternate between forwards and backwards, because undo and redo of one edit alternate. */
#ifndef HE_MESH_REPLAY_H
#define HE_MESH_REPLAY_H

#include "mesh/delta.h"

typedef struct he_replay he_replay;

typedef struct he_crossing {
    /* A number that identifies the delta among all deltas that the copy will ever cross. */
    uint64_t key;
    const he_delta *delta;
    bool undo; /* true if the delta is crossed backwards: its edit is undone */
    /* true if the delta owns the objects (columns, materials, a content) that are in the mesh
     * after the crossing */
    bool held;
    const uint32_t *issued; /* how many ids of each kind the mesh has issued after the crossing */
} he_crossing;

/* Makes a copy of `mesh` as it is now. Until the copy first moves, it has a cache of long faces
 * (long_faces.h).
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_replay_new(const he_mesh *mesh, he_replay **out, he_error *err);
void he_replay_free(he_replay *replay);
/* Returns the copy of the mesh, at the revision to which it was moved last. The pointer is always
 * the same, and is valid as long as the replay exists. */
const he_mesh *he_replay_mesh(const he_replay *replay);
/* Returns the bytes of memory of the copy and of the objects (columns, materials, contents) that it
 * keeps for later crossings. */
size_t he_replay_bytes(const he_replay *replay);

/* Moves the copy across one delta: undoes or redoes one edit.
 * Returns HE_UNSUPPORTED if the objects (columns, materials, a content) that the copy needs are
 * neither kept from an earlier crossing nor `held` by the delta; the copy is then as it was.
 * Returns HE_NO_MEMORY if memory is out; the copy is then between two revisions, and the caller can
 * only free it. */
HE_NODISCARD he_status he_replay_cross(he_replay *replay, const he_crossing *crossing,
                                       he_error *err);

/* Moves the copy to the present revision of the original mesh `mesh` across a delta that has only
 * one record, of all positions: takes the positions from the mesh. This needs no object that the
 * delta owns, but the copy cannot cross this delta backwards later. */
void he_replay_take_positions(he_replay *replay, const he_mesh *mesh);

#endif
