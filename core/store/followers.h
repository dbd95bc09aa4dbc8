/* followers.h - sends the changes of a mesh to its listeners.
 *
 * Each change is rendered once as a message (st_render), under the mesh's write lock, when the
 * change gets its number. The message is put into the mesh's queue with the position of the
 * change's record in the journal. Listeners get the message when the record is durable (rule D1 of
 * publish/durability_wait.h); if the record is lost, the listeners are cut off. Without listeners
 * nothing is rendered. Messages that describe no change, such as the state of a job, are queued
 * after the newest change, and are not in the history. */
#ifndef HE_STORE_FOLLOWERS_H
#define HE_STORE_FOLLOWERS_H

#include "store/publish/broadcast_queue.h"
#include "store/store.h"

/* The revision of a mesh after which a listener wants to continue. */
typedef struct st_since {
    bool given;
    bool has_incarnation;
    uint64_t incarnation, revision;
} st_since;

/* Says whether a listener gets all messages that it asked for and, if not, why. */
typedef enum st_missed {
    ST_MISSED_NOTHING, /* the listener begins at the present revision, or where it asked to begin */
    /* The queue no longer has the changes after since->revision; the history may have them. */
    ST_MISSED_HISTORY,
    /* the listener asks to continue after a revision of an earlier mesh that had this id */
    ST_MISSED_FOREIGN,
    ST_MISSED_FUTURE /* the listener asks for a revision that does not exist yet */
} st_missed;

/* Begins to listen to the changes of a mesh: those after `since`, if `since` is not NULL, else
 * those after the present revision. `info` gets the present description of the mesh.
 * Returns ST_ABSENT if the mesh was removed.
 * Returns ST_LOST if the mesh has a change that was lost.
 * Returns ST_LISTENERS if the limit of listeners is reached. */
st_status st_follow(st_mesh *mesh, st_listener *listener, const st_since *since, st_missed *missed,
                    st_mesh_info *info);
void st_unfollow(st_mesh *mesh, st_listener *listener);
/* Returns true if the mesh has listeners; if it has none, no message need be made. */
bool st_is_followed(st_mesh *mesh);
/* Sends listeners a message that is no change of the mesh, such as the state of a job; the caller
 * needs no lock. If the bytes are NULL, every listener that has not read all earlier messages by
 * now is told that it is behind and must fetch the mesh again. */
void st_follow_tell(st_mesh *mesh, const char *bytes, size_t length);
/* Wakes the listeners of the mesh if it has this incarnation, because something that is no message
 * has changed for them: their next read returns ST_QUEUE_NUDGED. The caller needs no lock. */
void st_follow_nudge(st_mesh *mesh, uint64_t incarnation);
/* Returns the number of present listeners of all meshes of the store. */
size_t st_listeners(st_store *store);

#endif
