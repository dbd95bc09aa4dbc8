/* replay.h - a copy of a mesh that travels along the log of its deltas.
 *
 * The deltas belong to a mesh that goes on changing; they are shared and only read. A copy crosses
 * one at a time, forwards (as its edit was made) or backwards (as it was undone), and is then what
 * the mesh was at that point of its log: every live row, every column, and the high-water marks.
 *
 *     log     ... 40 --D--> 41 --E--> 42 --D undone ...      crossing D at 42 again leads to 41's
 *     copy              <------- 42                          links, but keeps what 42 has issued
 *
 * A record of words holds both of its sides. What a column or a whole content was replaced by does
 * not fit in a record: the delta holds the side that the mesh is not at, and only that one. So the
 * first time a copy crosses such a delta, the delta must hold the side that is wanted (`held`), and
 * from then on the copy keeps for itself what the crossing took out of it. Crossings of one delta
 * alternate, forwards and backwards, since undo and redo of one edit do. */
#ifndef HE_MESH_REPLAY_H
#define HE_MESH_REPLAY_H

#include "mesh/delta.h"

typedef struct he_replay he_replay;

typedef struct he_crossing {
    uint64_t key; /* names the delta among all that the copy will ever cross */
    const he_delta *delta;
    bool undo;              /* backwards */
    bool held;              /* its objects are those of the side that the crossing leads to */
    const uint32_t *issued; /* the high-water marks there, indexed by kind */
} he_crossing;

/* A copy of `mesh` as it is, which keeps its long faces (long_faces.h) until it moves on.
 * HE_NO_MEMORY. */
HE_NODISCARD he_status he_replay_new(const he_mesh *mesh, he_replay **out, he_error *err);
void he_replay_free(he_replay *replay);
/* Where it is. The mesh stays the same one for as long as the replay lives. */
const he_mesh *he_replay_mesh(const he_replay *replay);
/* The copy and what it keeps of the other sides. */
size_t he_replay_bytes(const he_replay *replay);

/* HE_UNSUPPORTED when the side it leads to is nowhere to be had: neither kept from a crossing
 * before nor `held`; nothing has changed then. After HE_NO_MEMORY the copy is between two points
 * and good only to be freed. */
HE_NODISCARD he_status he_replay_cross(he_replay *replay, const he_crossing *crossing,
                                       he_error *err);

#endif
