/* replay.h - a copy of a mesh that moves along the log of the mesh's deltas.
 *
 * The deltas belong to a mesh that goes on changing; they are shared and only read. A copy crosses
 * one at a time, forwards (as its edit was made) or backwards (as it was undone), and then equals
 * the mesh at that point of its log: every live row, every column, and the high-water marks.
 *
 *     log     ... 40 --D--> 41 --E--> 42 --D undone ...      crossing D at 42 again leads to 41's
 *     copy              <------- 42                          links, but keeps what 42 has issued
 *
 * A record of words holds both sides, before and after. A replaced column or content does not fit
 * in a record: the delta owns it as an object, and only the side that the mesh is not at. So the
 * first time a copy crosses such a delta, the delta must own the side that is needed (`held`); from
 * then on the copy keeps the objects that the crossing took out of it. Crossings of one delta
 * alternate between forwards and backwards, because undo and redo of one edit do. */
#ifndef HE_MESH_REPLAY_H
#define HE_MESH_REPLAY_H

#include "mesh/delta.h"

typedef struct he_replay he_replay;

typedef struct he_crossing {
    uint64_t key; /* names the delta among all that the copy will ever cross */
    const he_delta *delta;
    bool undo; /* backwards */
    bool held; /* the delta's objects are those of the side that the crossing leads to */
    const uint32_t *issued; /* the high-water marks after the crossing, indexed by kind */
} he_crossing;

/* Makes a copy of `mesh` as it is now. It has a cache of long faces (long_faces.h) until it moves
 * on.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_replay_new(const he_mesh *mesh, he_replay **out, he_error *err);
void he_replay_free(he_replay *replay);
/* Returns the copy at its present point. The pointer stays valid and the same as long as the replay
 * lives. */
const he_mesh *he_replay_mesh(const he_replay *replay);
/* Returns the memory of the copy and of the objects it keeps. */
size_t he_replay_bytes(const he_replay *replay);

/* Moves the copy across one delta.
 * Returns HE_UNSUPPORTED if the needed side is neither kept from an earlier crossing nor `held`;
 * the copy is then as it was.
 * Returns HE_NO_MEMORY if memory is out; the copy is then between two points, and the caller can
 * only free it. */
HE_NODISCARD he_status he_replay_cross(he_replay *replay, const he_crossing *crossing,
                                       he_error *err);

#endif
