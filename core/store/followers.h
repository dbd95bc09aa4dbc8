/* followers.h - sends the changes of a mesh to its listeners.
 *
 * Each change is rendered once (st_render), under the mesh's write lock, when it gets its number,
 * and put into the mesh's queue under its position; listeners get it when that is durable (D1), and
 * are cut off if it is lost. Without listeners nothing is rendered. Messages that are no change,
 * such as the state of a job, are put beside the changes, and are not in the history. */
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
    ST_MISSED_NOTHING, /* it begins at the present, or where it asked for */
    ST_MISSED_HISTORY, /* the changes after since->revision are not in the queue, at best in the
                          history */
    ST_MISSED_FOREIGN, /* it followed another mesh that had this id */
    ST_MISSED_FUTURE   /* it asks for a revision that does not exist yet */
} st_missed;

/* Begins to listen to a mesh: from after `since`, or from the present revision, whose facts are
 * written to `info`.
 * Returns ST_ABSENT if the mesh was removed.
 * Returns ST_LOST if the mesh has a change that was lost.
 * Returns ST_LISTENERS if the limit of listeners is reached. */
st_status st_follow(st_mesh *mesh, st_listener *listener, const st_since *since, st_missed *missed,
                    st_mesh_info *info);
void st_unfollow(st_mesh *mesh, st_listener *listener);
/* Returns true if the mesh has a listener, so that a message is worth making. */
bool st_is_followed(st_mesh *mesh);
/* Adds a message that is no change of the mesh, without a lock. With NULL bytes, every listener
 * that has not read beyond this point is behind and must fetch the mesh again. */
void st_follow_tell(st_mesh *mesh, const char *bytes, size_t length);
/* Returns the number of listeners to meshes of the store. */
size_t st_listeners(st_store *store);

#endif
