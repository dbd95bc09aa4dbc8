/* followers.h - what happens to a mesh, told to those who listen.
 *
 * Each change is rendered once (st_render), under the mesh's write lock, when it gets its number,
 * and put into the mesh's queue under its position; listeners get it when that is durable (D1), and
 * are cut off where it is lost. While nobody listens nothing is rendered. Messages that are no
 * change, such as the news of a job, are put beside the changes, and are not in the history. */
#ifndef HE_STORE_FOLLOWERS_H
#define HE_STORE_FOLLOWERS_H

#include "store/broadcast_queue.h"
#include "store/store.h"

/* Where a listener wants to go on. */
typedef struct st_since {
    bool given;
    bool has_incarnation;
    uint64_t incarnation, revision;
} st_since;

/* What a listener missed of what it asked for. */
typedef enum st_missed {
    ST_MISSED_NOTHING, /* it begins at the present, or where it asked for */
    ST_MISSED_HISTORY, /* the changes after since->revision are in the history at best */
    ST_MISSED_FOREIGN, /* it followed another mesh of this id */
    ST_MISSED_FUTURE   /* it asks for a revision that does not exist yet */
} st_missed;

/* Begins to listen to a mesh: from after `since`, or from the present revision, whose facts go to
 * `info`. ST_ABSENT when the mesh was removed, ST_LOST, ST_LISTENERS when as many listen as may. */
st_status st_follow(st_mesh *mesh, st_listener *listener, const st_since *since, st_missed *missed,
                    st_mesh_info *info);
void st_unfollow(st_mesh *mesh, st_listener *listener);
/* Does anybody listen to the mesh, so that a message is worth making? */
bool st_is_followed(st_mesh *mesh);
/* Adds a message beside the changes, without a lock. NULL bytes: those who read up to here are told
 * that they are behind. */
void st_follow_tell(st_mesh *mesh, const char *bytes, size_t length);
/* How many listen to meshes of the store. */
size_t st_listeners(st_store *store);

#endif
