/* rebase.c - makes a newer base for a mesh with many records. The base is the mesh data with which
 * a load of the mesh begins; later records are then applied. A newer base bounds the time of a load
 * and the disk space of the mesh.
 *
 *     base ... records ... | ... records ...
 *                          |
 *                          snapshot; later the new base
 *
 * A snapshot of the mesh is taken when the records since the last snapshot have more bytes than the
 * mesh data, and at least ST_BASE_BYTES. It is written to the disk while edits go on. When no
 * revision before the snapshot can be undone, redone or read any more, the snapshot becomes the
 * base, and the records before it are deleted.
 *
 * A snapshot becomes useless if a change before it is undone, because the records after the undo
 * need the records before the snapshot. It also becomes useless if a record contains all mesh data
 * and ends the history, such as the record of a PUT: that record is then the new base. When a mesh
 * is evicted (removed from memory), its snapshot is dropped unless it is the base already. */
#include "store/table.h"
#include "system/lock.h"

#include <string.h>

/* Returns true if the mesh can be loaded from this record without any record before it. */
static bool is_base(const st_record *record)
{
    return record->barrier && !record->staged_edit &&
           (record->kind == ST_RECORD_CONTENT || record->stage != NULL);
}

/* FRAME_BYTES: about how many bytes a record takes without its body. PACKED_SHARE: about how many
 * times smaller mesh data is on the disk than in memory. */
enum { FRAME_BYTES = 200, PACKED_SHARE = 2 };

/* A snapshot of the data of a mesh. It may become the base, from which the mesh is loaded. */
struct st_next_base {
    /* True while a thread writes the snapshot to the disk. Only this thread may then change the
     * struct. */
    bool taking;
    bool spoiled;
    st_stage *stage;
    uint64_t before; /* value of st_mesh.appended when the snapshot was taken */
    st_record facts; /* name, revision and counts of the mesh when the snapshot was taken */
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

/* If no revision before the snapshot is needed any more, makes the snapshot the base of the mesh,
 * from which it is loaded. Then drops from the history in memory the entries that cannot be loaded
 * from the new base. The caller holds the exclusive lock of the mesh; the snapshot is on the
 * disk. */
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

/* Takes an immutable copy of the mesh with its name, revision and counts. The caller holds the
 * shared lock of the mesh. */
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

/* Takes a snapshot of the mesh and writes it to the disk. Runs on a thread of the pool. */
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
        /* Memory or disk space is out. The next snapshot is tried only when the mesh has as many
         * bytes of further records again. */
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
