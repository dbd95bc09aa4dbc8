/* rebase.c - makes a newer base for a mesh with many records. A base is the content from which a
 * mesh is loaded, so loading time and disk space stay bounded.
 *
 *     base ... records ... | ... records ...
 *                          +-- snapshot, staged while edits go on; when no revision before the
 *                              snapshot can be undone, redone or read any more, the snapshot
 *                              becomes the base, and the records before it are deleted
 *
 * A snapshot is due when the records since the last snapshot take more bytes than the content, and
 * at least ST_BASE_BYTES. A snapshot is staged: written to the disk before it is published. If a
 * change before the snapshot is undone, the snapshot becomes useless, because the records after the
 * undo need the records before the snapshot. The snapshot also becomes useless if a record holds
 * the whole content and ends the history, as that of a PUT does: that record is a base itself. A
 * snapshot that waits to become the base is dropped when its mesh is evicted. */
#include "store/table.h"
#include "system/lock.h"

#include <string.h>

/* Returns true if the mesh can be loaded from this record on, without any record before it. */
static bool is_base(const st_record *record)
{
    return record->barrier && !record->staged_edit &&
           (record->kind == ST_RECORD_CONTENT || record->stage != NULL);
}

/* Two estimates: FRAME_BYTES is how many bytes a record without its body takes, PACKED_SHARE is by
 * which factor a content is smaller on the disk than in memory. */
enum { FRAME_BYTES = 200, PACKED_SHARE = 2 };

/* A snapshot of a mesh's content that may become its base, from which the mesh is loaded. */
struct st_next_base {
    /* The snapshot is being staged (written to the disk): only the thread that stages it may change
     * this struct. */
    bool taking;
    bool spoiled;
    st_stage *stage;
    uint64_t before; /* value of st_mesh.appended when the snapshot was taken */
    st_record facts; /* describes the mesh (name, revision, counts) when the snapshot was taken */
    char name[ST_MESH_NAME + 1];
};

uint64_t st_rebase_bytes(const st_record *record)
{
    const bool has_content = record->stage != NULL && !record->staged_edit;
    return FRAME_BYTES + record->body_size + (has_content ? record->bytes / PACKED_SHARE : 0);
}

void st_rebase_drop(st_mesh *mesh)
{
    st_next_base *next = mesh->next_base;
    if (next != NULL && next->stage != NULL) {
        mesh->journal->unstage(mesh->journal->self, next->stage);
    }
    he_mem_free(next);
    mesh->next_base = NULL;
}

/* Makes the snapshot the base of the mesh if no revision before the snapshot is needed any more.
 * Entries of the history that cannot be loaded from the new base are then dropped in memory, too.
 * The caller holds the mesh's exclusive lock, and the snapshot is on the disk. */
static void settle(st_mesh *mesh)
{
    st_next_base *next = mesh->next_base;
    const uint64_t revision = next->facts.revision;
    if (next->spoiled) {
        st_rebase_drop(mesh);
    } else if (st_log_stands_on(&mesh->log, revision)) {
        st_log_drop(&mesh->log, revision);
        mesh->base = revision > mesh->base ? revision : mesh->base;
        next->facts.reach = revision;
        mesh->journal->rebase(mesh->journal->self, next->stage, &next->facts, revision);
        next->stage = NULL;
        st_rebase_drop(mesh);
    }
}

/* Takes an immutable copy of the mesh, and its description. The caller holds the mesh's shared
 * lock. */
static st_status begin(st_mesh *mesh, st_snapshot **out)
{
    st_next_base *next = mesh->next_base;
    st_point point;
    if (mesh->info.removed || mesh->info.lost) {
        return ST_ABSENT;
    }
    st_log_point(&mesh->log, mesh->info.revision, &point);
    next->facts = st_mesh_facts_record(mesh, ST_RECORD_CONTENT);
    next->facts.inverts = point.state == mesh->info.revision ? 0 : point.state;
    memcpy(next->name, mesh->info.name, sizeof next->name);
    next->facts.name = next->name;
    next->spoiled = false;
    next->before = mesh->appended;
    return st_snapshot_held(mesh, out);
}

/* Takes a snapshot of the mesh and writes it to the disk. It runs on a thread of the pool. */
static void take(void *context)
{
    st_mesh *mesh = context;
    const st_journal *journal = mesh->journal;
    st_next_base *next = mesh->next_base;
    st_snapshot *snapshot = NULL;
    st_stage *stage = NULL;
    st_lock_read(&mesh->lock);
    st_status status = begin(mesh, &snapshot);
    pthread_rwlock_unlock(&mesh->lock);
    if (status == ST_OK) {
        status = journal->stage(journal->self, st_snapshot_content(snapshot, NULL), &stage);
        st_snapshot_release(snapshot);
    }
    st_lock_write(&mesh->lock);
    next->taking = false;
    if (status == ST_OK) {
        next->stage = stage;
        mesh->appended -= next->before;
        settle(mesh);
    } else {
        /* If memory or disk space is out, another snapshot is tried only after further records of
         * as many bytes. */
        mesh->appended = 0;
        st_rebase_drop(mesh);
    }
    pthread_rwlock_unlock(&mesh->lock);
    st_release(mesh);
}

static bool is_due(const st_mesh *mesh)
{
    return mesh->next_base == NULL && mesh->appended > mesh->store->base_bytes &&
           mesh->appended > he_mesh_bytes(mesh->content);
}

static void begin_to_take(st_mesh *mesh)
{
    mesh->next_base = he_mem_zero(1, sizeof *mesh->next_base);
    if (mesh->next_base == NULL) {
        return;
    }
    mesh->next_base->taking = true;
    const st_task task = {.work = take,
                          .context = st_hold(mesh),
                          .share = ST_SHARE_JOB,
                          .cost = (double)he_mesh_bytes(mesh->content) / 1e8,
                          .flow = st_pool_flow("", mesh->info.id)};
    if (!st_pool_submit(mesh->store->pool, &task)) {
        st_rebase_drop(mesh);
        st_release(mesh);
    }
}

void st_rebase_note(st_mesh *mesh, const st_group *group)
{
    st_next_base *next = mesh->next_base;
    if (mesh->store->pool == NULL || !mesh->journal->keeps || mesh->info.removed) {
        return;
    }
    for (size_t i = 0; i < group->count; i++) {
        const st_record *record = &group->records[i];
        mesh->appended = is_base(record) ? 0 : mesh->appended + st_rebase_bytes(record);
        if (next != NULL && is_base(record)) {
            next->before = 0;
            next->spoiled = true;
        } else if (next != NULL && record->inverts != 0 &&
                   record->inverts <= next->facts.revision) {
            next->spoiled = true;
        }
    }
    if (next != NULL && !next->taking) {
        settle(mesh);
    }
    if (is_due(mesh)) {
        begin_to_take(mesh);
    }
}
