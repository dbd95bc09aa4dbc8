#include "store/lookup.h"

#include "store/mesh_load.h"
#include "store/table.h"
#include "system/clock.h"
#include "system/lock.h"

#include <string.h>

/* How long, in microseconds, a thread waits while another thread looks up an id on the disk. */
enum { LOOKUP_MICROS = 30 * 1000 * 1000 };

struct st_lookup {
    char id[ST_MESH_ID + 1];
    /* Number of threads that use this lookup: the thread that searches the disk, and the threads
     * that wait for its result. */
    size_t uses;
    bool ended;
    /* the result: ST_OK if the mesh is in memory now, else the reason why it is not */
    st_status status;
    st_lookup *next;
};

void st_lookups_init(st_lookups *lookups)
{
    pthread_mutex_init(&lookups->lock, NULL);
    st_clock_condition(&lookups->ended);
    lookups->first = NULL;
}

void st_lookups_clear(st_lookups *lookups)
{
    pthread_cond_destroy(&lookups->ended);
    pthread_mutex_destroy(&lookups->lock);
}

/* --- functions that need the lock of the lookups --- */

static st_lookup *find(const st_lookups *lookups, const char *id)
{
    st_lookup *at = lookups->first;
    while (at != NULL && strcmp(at->id, id) != 0) {
        at = at->next;
    }
    return at;
}

static void release(st_lookup *lookup)
{
    if (--lookup->uses == 0) {
        he_mem_free(lookup);
    }
}

static st_status add(st_lookups *lookups, const char *id, st_lookup **out)
{
    st_lookup *lookup = he_mem_zero(1, sizeof *lookup);
    if (lookup == NULL) {
        return ST_NO_MEMORY;
    }
    memcpy(lookup->id, id, strlen(id) + 1);
    lookup->uses = 1;
    lookup->next = lookups->first;
    lookups->first = lookup;
    *out = lookup;
    return ST_OK;
}

/* Waits until another thread has ended its lookup of an id. If the result is ST_OK, the caller must
 * search the table of meshes again. */
static st_status await(st_lookups *lookups, st_lookup *lookup, uint64_t until)
{
    const uint64_t since = st_clock_micros();
    bool in_time = true;
    lookup->uses++;
    while (!lookup->ended && in_time) {
        in_time = st_clock_wait(&lookups->ended, &lookups->lock, until);
    }
    st_lock_count(since);
    st_status status = lookup->ended ? lookup->status : ST_LOADING;
    release(lookup);
    return status;
}

st_status st_lookup_begin(st_store *store, const char *id, st_mesh **mesh, st_lookup **out)
{
    st_lookups *lookups = &store->lookups;
    const uint64_t until = st_clock_micros() + LOOKUP_MICROS;
    st_status status = ST_OK;
    *mesh = NULL;
    *out = NULL;
    pthread_mutex_lock(&lookups->lock);
    while (status == ST_OK && *mesh == NULL && *out == NULL) {
        st_lookup *other = find(lookups, id);
        if (other != NULL) {
            status = await(lookups, other, until);
        } else if (st_find(store, id, mesh) != ST_OK) {
            *mesh = NULL;
            status = add(lookups, id, out);
        }
    }
    pthread_mutex_unlock(&lookups->lock);
    return status;
}

static void end(st_store *store, st_lookup *lookup, st_status status)
{
    st_lookups *lookups = &store->lookups;
    pthread_mutex_lock(&lookups->lock);
    st_lookup **at = &lookups->first;
    while (*at != lookup) {
        at = &(*at)->next;
    }
    *at = lookup->next;
    lookup->ended = true;
    lookup->status = status;
    pthread_cond_broadcast(&lookups->ended);
    release(lookup);
    pthread_mutex_unlock(&lookups->lock);
}

/* --- an id for a new mesh --- */

st_status st_lookup_free_id(st_store *store, const char *id, st_lookup **out)
{
    const st_journal *journal = &store->journal;
    st_mesh *mesh;
    st_card card;
    *out = NULL;
    if (!journal->keeps) {
        return ST_OK;
    }
    st_status status;
    do {
        status = st_lookup_begin(store, id, &mesh, out);
        /* the lookup of another thread found no mesh with this id, so the id may be free */
    } while (status == ST_ABSENT);
    if (status != ST_OK) {
        return status;
    }
    if (mesh != NULL) {
        st_release(mesh);
        return ST_TAKEN;
    }
    status = journal->open(journal->self, id, &card, NULL);
    if (status == ST_ABSENT) {
        return ST_OK;
    }
    end(store, *out, ST_OK);
    *out = NULL;
    return status == ST_OK || status == ST_DAMAGED ? ST_TAKEN : status;
}

void st_lookup_end(st_store *store, st_lookup *lookup)
{
    if (lookup != NULL) {
        end(store, lookup, ST_OK);
    }
}

/* --- a mesh that is on the disk --- */

/* Makes a substitute for a mesh that cannot be loaded. It has no mesh data, but the id, name and
 * counts of the mesh's card (short description). */
static st_status stand_in(const st_mesh_options *options, const st_card *card, st_status why,
                          st_mesh **out)
{
    st_mesh *mesh = st_mesh_bare(options, card);
    if (mesh != NULL) {
        const st_point begin_at = {
            .revision = card->revision, .state = card->revision, .time = card->modified};
        mesh->content = he_mesh_new();
        mesh->damage = he_mem_alloc(ST_DAMAGE);
        if (mesh->content != NULL && mesh->damage != NULL) {
            memcpy(mesh->damage, card->damage, ST_DAMAGE);
            mesh->info.unreadable = why;
            st_log_init(&mesh->log, options->undo_budget, &begin_at, mesh->content);
            *out = mesh;
            return ST_OK;
        }
    }
    st_release(mesh);
    return ST_NO_MEMORY;
}

static st_status load_mesh(st_store *store, const char *id, st_mesh **out)
{
    const st_journal *journal = &store->journal;
    const st_mesh_options options = st_store_mesh_options(store);
    st_reader *reader = NULL;
    st_card card;
    st_status status = journal->open(journal->self, id, &card, &reader);
    if (status == ST_OK) {
        status = st_mesh_load(&options, &card, reader, 0, out);
        journal->shut(reader);
        if (status == ST_OK) {
            status = journal->keys(journal->self, id, st_keys_restore, &(*out)->keys);
            if (status != ST_OK) {
                st_release(*out);
                *out = NULL;
            }
        }
    }
    return status == ST_DAMAGED || status == ST_NEWER ? stand_in(&options, &card, status, out)
                                                      : status;
}

st_status st_salvage(st_store *store, const char *id, st_mesh **out, char damage[ST_DAMAGE])
{
    const st_journal *journal = &store->journal;
    const st_mesh_options options = st_store_mesh_options(store);
    st_reader *reader = NULL;
    st_card card;
    st_status status = journal->open(journal->self, id, &card, &reader);
    damage[0] = '\0';
    if (status == ST_OK) {
        status = st_mesh_salvage(&options, &card, reader, out, damage);
        journal->shut(reader);
    }
    return status;
}

static st_status put_in(st_store *store, st_mesh *mesh)
{
    st_lock_write(&store->lock);
    st_status status = st_table_insert(store, mesh);
    if (status == ST_OK) {
        st_hold(mesh);
    }
    pthread_rwlock_unlock(&store->lock);
    return status;
}

/* Counts a load of a mesh from the disk for monitoring. `mesh` is NULL if no mesh was found. If the
 * mesh could not be read, its `content` is NULL. */
static void count_load(st_store *store, st_status status, const st_mesh *mesh, uint64_t micros)
{
    st_store_counts *counts = &store->followers.counts;
    const st_loaded loaded = status == ST_ABSENT            ? ST_LOADED_NOTHING
                             : status != ST_OK              ? ST_LOADED_FAILED
                             : st_unreadable(mesh) != ST_OK ? ST_LOADED_DAMAGED
                                                            : ST_LOADED_WHOLE;
    st_count(&counts->loads[loaded], 1);
    if (loaded == ST_LOADED_WHOLE) {
        st_histogram_add(&counts->load_time, st_scale_micros, micros);
    }
}

st_status st_load(st_store *store, const char *id, st_mesh **out)
{
    st_lookup *lookup;
    st_mesh *mesh;
    if (!store->journal.keeps) {
        return st_find(store, id, out);
    }
    st_status status = st_lookup_begin(store, id, &mesh, &lookup);
    if (status == ST_OK && mesh == NULL) {
        const uint64_t begun = st_clock_micros();
        status = load_mesh(store, id, &mesh);
        count_load(store, status, mesh, st_clock_micros() - begun);
        if (status == ST_OK) {
            st_mesh_weigh(mesh);
            st_mesh_use(mesh);
            status = put_in(store, mesh);
        }
        if (status != ST_OK) {
            st_release(mesh);
        }
        end(store, lookup, status);
    }
    if (status == ST_OK) {
        *out = mesh;
    }
    return status;
}

/* --- meshes that are not loaded --- */

st_status st_cold_begin(st_store *store, const char *id, st_mesh **mesh, st_cold *out)
{
    const st_journal *journal = &store->journal;
    st_lookup *lookup;
    st_status status = st_lookup_begin(store, id, mesh, &lookup);
    if (status != ST_OK || *mesh != NULL) {
        return status;
    }
    *out = (st_cold){.store = store, .lookup = lookup};
    status = journal->open(journal->self, id, &out->card, NULL);
    if (status != ST_OK) {
        st_lookup_end(store, lookup);
        return status;
    }
    const st_card *card = &out->card;
    out->info = (st_mesh_info){.incarnation = card->incarnation,
                               .metadata = card->metadata,
                               .revision = card->revision,
                               .record = card->record,
                               .created = card->created,
                               .modified = card->modified};
    memcpy(out->info.id, card->id, sizeof card->id);
    memcpy(out->info.name, card->name, sizeof card->name);
    return ST_OK;
}

/* Makes a substitute without mesh data for a mesh that is not in memory, so that the removal of
 * that mesh can be appended to the journal. The substitute is never in the table of meshes. */
static st_mesh *new_stand_in(const st_cold *cold)
{
    const st_mesh_options options = st_store_mesh_options(cold->store);
    st_mesh *mesh = st_mesh_bare(&options, &cold->card);
    if (mesh != NULL) {
        const st_point begin_at = {.revision = mesh->info.revision, .state = mesh->info.revision};
        mesh->content = he_mesh_new();
        if (mesh->content != NULL) {
            st_log_init(&mesh->log, options.undo_budget, &begin_at, mesh->content);
            return mesh;
        }
    }
    st_release(mesh);
    return NULL;
}

st_status st_cold_remove(st_cold *cold)
{
    const st_room_need need = {.records = 1, .freeing = true};
    const st_change change = {.action = ST_REPLACE, .removed = true};
    st_booking booking = {NULL};
    st_mesh *mesh = new_stand_in(cold);
    if (mesh == NULL) {
        return ST_NO_MEMORY;
    }
    st_status status = st_book(&cold->store->journal, &need, &booking);
    if (status == ST_OK) {
        mesh->info.removed = true;
        st_record record = st_mesh_record(mesh, ST_RECORD_REMOVE, NULL);
        st_mesh_publish(
            mesh,
            &(st_group){.booking = &booking, .records = &record, .changes = &change, .count = 1});
        st_mesh_facts(mesh, &cold->info);
    }
    st_release(mesh);
    return status;
}

void st_cold_end(st_cold *cold)
{
    st_lookup_end(cold->store, cold->lookup);
}
