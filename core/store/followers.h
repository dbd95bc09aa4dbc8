/* followers.h - sends the changes of a mesh to its listeners.
 *
 * Each change is rendered once (st_render), under the mesh's write lock, when it gets its number,
 * and put into the mesh's queue with the position of its record in the journal. Listeners get it
 * when the record is durable (rule D1 of publish/durability_wait.h); if the record is lost, they
 * are cut off. Without listeners nothing is rendered. Messages that are no change, such as the
 * state of a job, are queued after the newest change, and are not in the history. */
#ifndef HE_STORE_FOLLOWERS_H
#define HE_STORE_FOLLOWERS_H

#include "store/publish/broadcast_queue.h"
#include "store/store.h"

/* Where a listener wants to continue. */
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
    ST_MISSED_FOREIGN, /* the listener followed another mesh that had this id */
    ST_MISSED_FUTURE   /* the listener asks for a revision that does not exist yet */
} st_missed;

/* Begins to listen to the changes of a mesh: those after `since`, if it is given, else those after
 * the present revision. The present facts of the mesh are written to `info`.
 * Returns ST_ABSENT if the mesh was removed.
 * Returns ST_LOST if the mesh has a change that was lost.
 * Returns ST_LISTENERS if the limit of listeners is reached. */
st_status st_follow(st_mesh *mesh, st_listener *listener, const st_since *since, st_missed *missed,
                    st_mesh_info *info);
void st_unfollow(st_mesh *mesh, st_listener *listener);
/* Returns true if the mesh has a listener, so that a message is worth making. */
bool st_is_followed(st_mesh *mesh);
/* Adds a message that is no change of the mesh; the caller needs no lock. With NULL bytes, every
 * listener that has not read all messages by now is behind and must fetch the mesh again. */
void st_follow_tell(st_mesh *mesh, const char *bytes, size_t length);
/* Returns the number of listeners of all meshes of the store. */
size_t st_listeners(st_store *store);

#endif
