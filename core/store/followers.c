#include "store/followers.h"

#include "base/mem.h"
#include "store/stored_mesh.h"
#include "system/lock.h"

#include <stddef.h>

static void is_known(st_wait *wait);
static bool end_wait(st_mesh *mesh);

/* Allows listeners to read the messages whose records are durable, and waits for the records of the
 * other messages. A mesh has at most one such wait. If there is one already, newer messages are
 * handled when it ends. */
static void allow(st_mesh *mesh)
{
    st_waits *waits = mesh->followers->waits;
    for (;;) {
        uint64_t newest = st_queue_newest(&mesh->queue);
        const st_shown shown = {newest, newest - 1, mesh->info.incarnation};
        if (st_waits_is_durable(waits, &shown)) {
            st_queue_allow(&mesh->queue, newest);
            return;
        }
        if (atomic_exchange(&mesh->waiting, true)) {
            return;
        }
        st_hold(mesh);
        mesh->wait = (st_wait){.shown = shown, .resume = is_known};
        if (st_waits_add(waits, &mesh->wait) || !end_wait(mesh)) {
            return;
        }
    }
}

/* Ends the wait of the mesh's queue of messages for durable records. Returns true if listeners may
 * perhaps read more messages now. */
static bool end_wait(st_mesh *mesh)
{
    const st_wait wait = mesh->wait;
    bool durable = wait.end == ST_WAIT_DURABLE;
    if (durable) {
        st_queue_allow(&mesh->queue, wait.shown.position);
    } else if (wait.end == ST_WAIT_LOST) {
        st_queue_lose(&mesh->queue);
    }
    atomic_store(&mesh->waiting, false);
    st_release(mesh);
    return durable;
}

static void is_known(st_wait *wait)
{
    st_mesh *mesh = (st_mesh *)((char *)wait - offsetof(st_mesh, wait));
    st_hold(mesh);
    if (end_wait(mesh)) {
        allow(mesh);
    }
    st_release(mesh);
}

void st_event_write(const st_mesh *mesh, const st_mesh_info *info, const st_change *change,
                    st_event *out)
{
    if (!mesh->followers->render(info, change, &out->bytes, &out->length)) {
        *out = (st_event){NULL, 0};
    }
}

/* Puts the messages about a group of records into the queue for the mesh's listeners. The records
 * of a group become durable together, so listeners may read all its messages from one moment on. */
void st_mesh_tell(st_mesh *mesh, const st_group *group)
{
    bool followed = st_queue_is_followed(&mesh->queue);
    for (size_t i = 0; i < group->count; i++) {
        const st_record *record = &group->records[i];
        st_event event = {NULL, 0};
        if (group->events != NULL) {
            event = group->events[i];
            group->events[i] = (st_event){NULL, 0};
        } else if (followed) {
            st_event_write(mesh, &mesh->info, &group->changes[i], &event);
        }
        st_place place = {.stamp = mesh->info.position, .key = record->revision};
        st_queue_add(&mesh->queue, place, event.bytes, event.length);
        he_mem_free(event.bytes);
        if (record->kind == ST_RECORD_REMOVE) {
            st_queue_end(&mesh->queue);
        }
    }
    if (followed) {
        allow(mesh);
    }
}

bool st_is_followed(st_mesh *mesh)
{
    return st_queue_is_followed(&mesh->queue);
}

void st_follow_tell(st_mesh *mesh, const char *bytes, size_t length)
{
    st_queue_add_beside(&mesh->queue, bytes, length);
    allow(mesh);
}

void st_follow_nudge(st_mesh *mesh, uint64_t incarnation)
{
    /* The incarnation of a mesh never changes, so it is read without the lock. */
    if (mesh->info.incarnation == incarnation) {
        st_queue_nudge(&mesh->queue);
    }
}

/* Makes a listener begin with the messages after the revision `since`, or after the present
 * revision if `since` is NULL. The caller holds the mesh's lock. */
static st_missed begin(st_listener *listener, const st_since *since, const st_mesh_info *info)
{
    if (!since->given) {
        return ST_MISSED_NOTHING;
    }
    if (since->has_incarnation && since->incarnation != info->incarnation) {
        return ST_MISSED_FOREIGN;
    }
    if (since->revision > info->revision) {
        return ST_MISSED_FUTURE;
    }
    return st_queue_rewind(listener, since->revision) ? ST_MISSED_NOTHING : ST_MISSED_HISTORY;
}

st_status st_follow(st_mesh *mesh, st_listener *listener, const st_since *since, st_missed *missed,
                    st_mesh_info *info)
{
    st_followers *followers = mesh->followers;
    st_status status = ST_OK;
    if (atomic_fetch_add(&followers->count, 1) >= followers->most) {
        atomic_fetch_sub(&followers->count, 1);
        return ST_LISTENERS;
    }
    st_lock_read(&mesh->lock);
    st_mesh_facts(mesh, info);
    if (info->removed || info->lost) {
        status = info->lost ? ST_LOST : ST_ABSENT;
    } else if (!st_queue_listen(&mesh->queue, listener, followers->most_of_mesh)) {
        status = ST_LISTENERS;
    } else {
        *missed = begin(listener, since, info);
    }
    pthread_rwlock_unlock(&mesh->lock);
    if (status != ST_OK) {
        atomic_fetch_sub(&followers->count, 1);
    }
    return status;
}

void st_unfollow(st_mesh *mesh, st_listener *listener)
{
    st_queue_leave(listener);
    atomic_fetch_sub(&mesh->followers->count, 1);
}
