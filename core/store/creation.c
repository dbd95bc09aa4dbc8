/* creation.c - adds meshes to the store: under a free id, or in place of a damaged one. */
#include "store/table.h"
#include "system/lock.h"
#include "system/memory.h"
#include "system/random.h"

enum { ID_LENGTH = 10 };

static st_status book(const st_store *store, const he_mesh *content, size_t records,
                      st_booking *out)
{
    st_stage *stage;
    st_status status = st_book_stage(&store->journal, content, &stage);
    if (status != ST_OK) {
        return status;
    }
    status = st_book_content(&store->journal, content, stage, records, out);
    if (status != ST_OK) {
        st_store_unstage(store, stage);
    }
    return status;
}

/* Returns true if the store has reached its limit of meshes. The caller holds the exclusive lock of
 * the table of meshes. */
static bool is_full(const st_store *store)
{
    const st_journal *journal = &store->journal;
    uint64_t count = journal->keeps ? journal->count(journal->self) : store->count;
    return count >= store->max_meshes;
}

/* Adds the mesh to the store's table of meshes and counts it for its holder (the owner of the
 * mesh). The caller holds the exclusive lock of the table. */
static st_status insert(st_store *store, st_mesh *mesh)
{
    const st_holding none = {NULL, 0};
    const st_holding come = {mesh->holding.holder, he_mesh_bytes(mesh->content)};
    st_status status = st_holders_move(&store->holders, &none, &come);
    if (status != ST_OK) {
        return status;
    }
    mesh->holding = come;
    status = st_table_insert(store, mesh);
    if (status != ST_OK) {
        st_holders_note(&store->holders, &come, &none);
    }
    return status;
}

/* Appends the first record of a new mesh to the journal and puts the mesh into the store's table.
 * The record is appended while the table is locked. So if another thread finds the mesh in the
 * table, or finds that the id is taken, the journal has the record. */
static st_status publish(st_store *store, st_mesh *mesh, const st_cause *cause, st_booking *booking)
{
    st_lock_write(&store->lock);
    bool found;
    (void)st_table_place(store, mesh->info.id, &found);
    st_status status = found ? ST_TAKEN : is_full(store) ? ST_TOO_MANY : insert(store, mesh);
    if (status == ST_OK) {
        st_hold(mesh);
        st_record record = st_mesh_record(mesh, ST_RECORD_CONTENT, cause);
        const st_change change = {.action = ST_REPLACE, .content = mesh->content};
        st_mesh_publish(
            mesh,
            &(st_group){.booking = booking, .records = &record, .changes = &change, .count = 1});
    }
    pthread_rwlock_unlock(&store->lock);
    return status;
}

/* Makes a stored mesh from the data in `content`, without putting it into the store's table, and
 * reserves space for `records` records in the journal. */
static st_status prepare(st_store *store, const st_new_mesh *made, he_mesh *content, size_t records,
                         st_booking *booking, st_mesh **out)
{
    const st_mesh_options options = st_store_mesh_options(store);
    st_status status = book(store, content, records, booking);
    if (status != ST_OK) {
        return status;
    }
    *out = st_mesh_new(&options, made->id, made->name, made->cause, content);
    if (*out == NULL) {
        st_booking_leave(&store->journal, booking);
        return ST_NO_MEMORY;
    }
    return ST_OK;
}

/* Frees a stored mesh that was not added to the store. Its mesh data is not freed, because the
 * caller of st_create still owns it. */
static void discard(st_store *store, st_mesh *mesh, st_booking *booking)
{
    mesh->content = NULL;
    st_release(mesh);
    st_booking_leave(&store->journal, booking);
}

static st_status make(st_store *store, const st_new_mesh *made, he_mesh *content, st_mesh **out)
{
    st_booking booking = {NULL};
    st_mesh *mesh;
    st_status status = prepare(store, made, content, 1, &booking, &mesh);
    if (status == ST_OK) {
        /* The time of last use is set before the mesh is in the table. Without it, the mesh would
         * be the first to be evicted (removed from memory). */
        st_mesh_use(mesh);
        /* Space for the record of the new mesh is reserved in the journal already. So if the
         * records of `made->from` are lost after this check, the record of the new mesh is lost,
         * too. */
        const bool lost =
            made->from != NULL && st_waits_is_lost(store->followers.waits, made->from);
        status = lost ? ST_LOST : publish(store, mesh, made->cause, &booking);
        if (status == ST_OK) {
            *out = mesh;
        } else {
            discard(store, mesh, &booking);
        }
    }
    return status;
}

static st_status create_as(st_store *store, const st_new_mesh *made, he_mesh *content,
                           st_mesh **out)
{
    st_lookup *lookup;
    st_status status = st_lookup_free_id(store, made->id, &lookup);
    if (status == ST_OK) {
        status = make(store, made, content, out);
        st_lookup_end(store, lookup);
    }
    return status;
}

/* Returns true if there is memory for another mesh. If memory is short, much more memory is freed
 * than the mesh needs, because other threads would take a few free bytes at once. */
static bool has_room(st_store *store)
{
    st_make_room(store, st_memory_budget() / ST_MEMORY_SHORT_SHARE);
    return !st_memory_is_full();
}

st_status st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content, st_mesh **out)
{
    if (!has_room(store)) {
        return ST_BUDGET;
    }
    if (made->id != NULL) {
        return create_as(store, made, content, out);
    }
    char id[ID_LENGTH + 1];
    st_new_mesh named = *made;
    named.id = id;
    st_status status;
    do {
        st_random_id(id, ID_LENGTH);
        status = create_as(store, &named, content, out);
    } while (status == ST_TAKEN);
    return status;
}

st_status st_create(st_store *store, const char *id, const char *name, he_mesh *content,
                    const st_cause *cause, st_mesh **out)
{
    const st_new_mesh made = {.id = id, .name = name, .cause = cause};
    return st_create_from(store, &made, content, out);
}

/* --- replacing a damaged mesh --- */

/* Appends the removal of the old mesh and the first record of the new mesh to the journal, as one
 * group of records. The caller holds the exclusive lock of the old mesh. */
static void publish_over(st_store *store, st_mesh *old, st_mesh *fresh, const st_cause *cause,
                         st_booking *booking)
{
    const st_journal *journal = &store->journal;
    const st_change changes[2] = {{.action = ST_REPLACE, .removed = true},
                                  {.action = ST_REPLACE, .content = fresh->content}};
    bool found;
    st_lock_write(&store->lock);
    size_t place = st_table_place(store, old->info.id, &found);
    store->meshes[place] = st_hold(fresh);
    old->info.removed = true;
    st_record records[2] = {st_mesh_record(old, ST_RECORD_REMOVE, NULL),
                            st_mesh_record(fresh, ST_RECORD_CONTENT, cause)};
    st_booking_fill(booking, &records[1]);
    uint64_t position = journal->append(journal->self, booking->room, records, 2);
    *booking = (st_booking){NULL};
    old->info.position = fresh->info.position = position;
    st_mesh_weigh(fresh);
    st_count(&store->followers.counts.revisions, 1);
    st_waits_appended(store->followers.waits, position);
    st_mesh_tell(old, &(st_group){.records = &records[0], .count = 1, .changes = &changes[0]});
    st_mesh_tell(fresh, &(st_group){.records = &records[1], .count = 1, .changes = &changes[1]});
    pthread_rwlock_unlock(&store->lock);
}

/* Counts the new mesh for its holder (owner), and no longer counts the old mesh for the old mesh's
 * holder. Refuses if the new mesh exceeds the limit of its holder. The caller holds the exclusive
 * lock of the old mesh. */
static st_status count_over(st_store *store, const st_mesh *old, st_mesh *fresh)
{
    const st_holding come = {fresh->holding.holder, he_mesh_bytes(fresh->content)};
    fresh->holding = come;
    return st_holders_move(&store->holders, &old->holding, &come);
}

st_status st_create_over(st_store *store, st_mesh *damaged, const char *name, he_mesh *content,
                         const st_cause *cause, st_mesh **out)
{
    st_booking booking = {NULL};
    st_mesh *fresh;
    const st_new_mesh made = {.id = damaged->info.id, .name = name, .cause = cause};
    st_status status = prepare(store, &made, content, 2, &booking, &fresh);
    if (status != ST_OK) {
        return status;
    }
    st_mesh_use(fresh);
    st_lock_write(&damaged->lock);
    status = damaged->info.removed ? ST_ABSENT : count_over(store, damaged, fresh);
    if (status == ST_OK) {
        publish_over(store, damaged, fresh, cause, &booking);
    }
    pthread_rwlock_unlock(&damaged->lock);
    if (status != ST_OK) {
        discard(store, fresh, &booking);
        return status;
    }
    st_release(damaged); /* releases the reference of the store's table to the old mesh */
    *out = fresh;
    return ST_OK;
}
