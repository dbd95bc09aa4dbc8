/* replay_walk.h - following a mesh through its history, one revision after the other.
 *
 * A walk owns a copy of the mesh at a revision that the history still reaches, and brings it
 * forward on demand: after each step the copy is the mesh as that revision left it, links,
 * attributes and high-water marks included, whatever the mesh has become since.
 *
 *     srv_walk *walk;
 *     srv_walk_begin(mesh, 41, &walk);
 *     while (srv_walk_next(walk, &step) == API_STORE_OK) {
 *         ... step.content is revision step.revision, which step.delta led to ...
 *     }
 *     srv_walk_end(walk);
 *
 * The mesh's shared lock is taken inside, for no longer than a copy or a replay takes, and none is
 * held between calls. A walk is for one thread at a time, and not for a worker: it may copy. */
#ifndef HE_SERVER_STORE_REPLAY_WALK_H
#define HE_SERVER_STORE_REPLAY_WALK_H

#include "server/store/stored_mesh.h"

typedef struct srv_walk srv_walk;

typedef struct srv_walk_step {
    uint64_t revision;
    api_action action;
    const he_delta *delta; /* its words, for he_changes_find; its objects are another's */
    bool undone;           /* the delta was applied backwards */
    const he_mesh *content;
} srv_walk_step;

/* Keeps a use of the mesh. API_STORE_AHEAD when there is no such revision yet, API_STORE_GONE when
 * the history does not reach back to it, API_STORE_NO_MEMORY, API_STORE_BUDGET. */
api_store_status srv_walk_begin(api_mesh *mesh, uint64_t revision, srv_walk **out);
/* Where it is, before the first step too. */
const he_mesh *srv_walk_content(const srv_walk *walk);
uint64_t srv_walk_revision(const srv_walk *walk);
/* One revision further; what `out` lends is valid until the next call. API_STORE_NOTHING at the
 * newest revision. API_STORE_GONE when the history was cut off between (a replace, an edit beyond
 * the budget, or so many edits that the next one was dropped): begin anew. After any other failure
 * the walk can only be ended. */
api_store_status srv_walk_next(srv_walk *walk, srv_walk_step *out);
void srv_walk_end(srv_walk *walk); /* takes NULL */

/* Bring a copy of `mesh` that is at *at to `revision`, or make one where *replay is NULL; what
 * srv_walk_begin and snapshots of earlier revisions are made with. On failure there is none. */
api_store_status srv_replay_to(api_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision);

#endif
