#include "store/store.h"

#include "store/followers.h"
#include "store/publish/limits.h"
#include "store/table.h"
#include "system/clock.h"
#include "system/lock.h"

#include <assert.h>
#include <string.h>

enum { MESH_BATCH = 64 };

/* --- functions that the journal calls, on its own thread --- */

static void moved(void *context, uint64_t position)
{
    const st_store *store = context;
    st_waits_moved(store->followers.waits, position);
}

/* Handles a loss of records that the journal reports. The answers that wait for durable records
 * learn of the loss first, so that no answer made from a lost change is sent any more. */
static void lost(void *context, const st_loss *loss)
{
    st_store *store = context;
    st_mesh *batch[MESH_BATCH];
    char after[ST_MESH_ID + 1] = "";
    size_t count;
    st_waits_lose(store->followers.waits, loss);
    while ((count = st_list(store, after, batch, MESH_BATCH)) > 0) {
        memcpy(after, batch[count - 1]->info.id, sizeof after);
        for (size_t i = 0; i < count; i++) {
            st_mesh_lose(batch[i], loss);
            st_release(batch[i]);
        }
    }
    /* Lost changes must no longer count for the holders (owners) of meshes, so what each holder has
     * is read from the journal again. The journal accepts no write until the last loss was
     * reported, so all changes are on the disk at this moment. If reading fails, the counts stay as
     * they were. */
    (void)st_holders_count(&store->holders, &store->journal);
}

st_store *st_store_new(const st_store_options *options)
{
    st_store *store = he_mem_zero(1, sizeof *store);
    if (store == NULL) {
        return NULL;
    }
    if (pthread_rwlock_init(&store->lock, NULL) != 0) {
        he_mem_free(store);
        return NULL;
    }
    pthread_mutex_init(&store->room, NULL);
    store->journal = options->journal;
    store->undo_budget = options->undo_budget;
    store->max_meshes = options->max_meshes;
    store->pool = options->pool;
    st_store_giver(store, &store->giver);
    store->base_bytes = options->base_bytes != 0 ? options->base_bytes : ST_BASE_BYTES;
    st_keys_init(&store->keys, store->journal.secret);
    st_holders_init(&store->holders, store->journal.secret);
    st_lookups_init(&store->lookups);
    st_sorted_init(&store->sorted);
    store->followers = (st_followers){
        .render = options->render,
        .most = options->listeners,
        .most_of_mesh = options->mesh_listeners,
        .waits = st_waits_new(),
    };
    const st_journal *journal = &store->journal;
    bool failed = journal->keeps &&
                  journal->keys(journal->self, NULL, st_keys_restore, &store->keys) != ST_OK;
    failed = st_holders_count(&store->holders, journal) != ST_OK || failed;
    if (store->followers.waits == NULL || failed) {
        st_keys_clear(&store->keys);
        st_holders_clear(&store->holders);
        st_waits_free(store->followers.waits);
        st_lookups_clear(&store->lookups);
        st_sorted_clear(&store->sorted);
        pthread_rwlock_destroy(&store->lock);
        pthread_mutex_destroy(&store->room);
        he_mem_free(store);
        return NULL;
    }
    const st_journal_listener listener = {store, moved, lost};
    store->journal.listen(store->journal.self, &listener);
    return store;
}

void st_store_free(st_store *store)
{
    if (store == NULL) {
        return;
    }
    store->journal.listen(store->journal.self, NULL);
    for (size_t i = 0; i < store->count; i++) {
        st_release(store->meshes[i]);
    }
    he_mem_free(store->meshes);
    st_keys_clear(&store->keys);
    st_holders_clear(&store->holders);
    st_lookups_clear(&store->lookups);
    st_sorted_clear(&store->sorted);
    st_waits_free(store->followers.waits);
    store->journal.close(store->journal.self);
    pthread_rwlock_destroy(&store->lock);
    pthread_mutex_destroy(&store->room);
    he_mem_free(store);
}

size_t st_table_place(const st_store *store, const char *id, bool *found)
{
    size_t low = 0, high = store->count;
    *found = false;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int order = strcmp(store->meshes[middle]->info.id, id);
        if (order == 0) {
            *found = true;
            return middle;
        }
        if (order < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

st_status st_find(st_store *store, const char *id, st_mesh **out)
{
    bool found;
    st_lock_read(&store->lock);
    size_t i = st_table_place(store, id, &found);
    if (found) {
        *out = st_hold(store->meshes[i]);
    }
    pthread_rwlock_unlock(&store->lock);
    if (!store->journal.keeps) {
        return found ? ST_OK : ST_ABSENT;
    }
    if (found) {
        st_mesh_use(*out);
    }
    return found ? ST_OK : ST_COLD;
}

static bool reserve_place(st_store *store)
{
    if (store->count < store->capacity) {
        return true;
    }
    size_t capacity = he_mem_grown(store->capacity, store->count + 1);
    st_mesh **meshes = he_mem_array(store->meshes, capacity, sizeof(st_mesh *));
    if (meshes == NULL) {
        return false;
    }
    store->meshes = meshes;
    store->capacity = capacity;
    return true;
}

st_status st_table_insert(st_store *store, st_mesh *mesh)
{
    bool found;
    size_t place = st_table_place(store, mesh->info.id, &found);
    if (found) {
        return ST_TAKEN;
    }
    if (!reserve_place(store)) {
        return ST_NO_MEMORY;
    }
    memmove(store->meshes + place + 1, store->meshes + place,
            (store->count - place) * sizeof(st_mesh *));
    store->meshes[place] = mesh;
    store->count++;
    return ST_OK;
}

st_status st_store_stage(const st_store *store, const he_mesh *content, st_stage **out)
{
    return st_book_stage(&store->journal, content, out);
}

void st_store_unstage(const st_store *store, st_stage *stage)
{
    if (stage != NULL) {
        store->journal.unstage(store->journal.self, stage);
    }
}

bool st_store_stages(const st_store *store, uint64_t bytes)
{
    return store->journal.keeps && bytes > ST_BODY_BYTES;
}

void st_store_sort(st_store *store, const st_mesh *mesh, const st_record *record)
{
    st_card card = {.damage = ""};
    if (mesh->sorted != NULL && record->kind != ST_RECORD_REMOVE) {
        st_card_of_record(record, &card);
        st_sorted_put(&store->sorted, mesh->sorted, &card);
    }
}

void st_store_take_out(st_store *store, st_mesh *mesh)
{
    bool found;
    st_lock_write(&store->lock);
    size_t place = st_table_place(store, mesh->info.id, &found);
    assert(found && store->meshes[place] == mesh);
    store->count--;
    memmove(store->meshes + place, store->meshes + place + 1,
            (store->count - place) * sizeof(st_mesh *));
    if (mesh->sorted != NULL) {
        st_sorted_remove(&store->sorted, mesh->sorted);
    }
    pthread_rwlock_unlock(&store->lock);
    st_release(mesh);
}

size_t st_list(st_store *store, const char *after, st_mesh **out, size_t limit)
{
    bool found;
    size_t given = 0;
    st_lock_read(&store->lock);
    size_t i = st_table_place(store, after, &found);
    for (i += found ? 1 : 0; i < store->count && given < limit; i++) {
        out[given++] = st_hold(store->meshes[i]);
    }
    pthread_rwlock_unlock(&store->lock);
    return given;
}

/* Returns true if the change that a kept answer reports was lost. Such an answer is not sent again;
 * if the request is repeated, it is executed again. */
static bool is_lost(const st_store *store, const st_kept *kept)
{
    const st_shown shown = {kept->position, kept->position - 1, kept->incarnation};
    return kept->position != 0 && st_waits_is_lost(store->followers.waits, &shown);
}

st_keyed_status st_keyed_begin(st_store *store, st_mesh *mesh, const st_key *key, st_keyed **out)
{
    st_keys *keys = mesh == NULL ? &store->keys : &mesh->keys;
    st_keyed_status status = st_keys_begin(keys, key, st_clock_utc(), out);
    if (status == ST_KEYED_KEPT && is_lost(store, &(*out)->answer)) {
        st_keys_forget(*out);
        status = st_keys_begin(keys, key, st_clock_utc(), out);
    }
    if (status == ST_KEYED_NEW) {
        (*out)->key.of_store = mesh == NULL;
    }
    return status;
}

/* --- notes in the journal --- */

/* Writes a note (the state of a job, or the Idempotency-Key of a request) to the journal. Journals
 * that tests make may lack the function `note`. */
static st_status note(st_store *store, const st_note *what, uint64_t *position)
{
    const st_journal *journal = &store->journal;
    *position = 0;
    if (journal->note == NULL) {
        return ST_OK;
    }
    st_status status = journal->note(journal->self, what, position);
    if (status == ST_OK) {
        st_waits_appended(store->followers.waits, *position);
    }
    return status;
}

void st_keyed_note(st_store *store, const st_keyed *keyed, const st_mesh_info *info,
                   uint64_t *position)
{
    const st_kept_key kept = {.key = keyed->key,
                              .id = info->id,
                              .incarnation = info->incarnation,
                              .revision = info->revision,
                              .metadata = info->metadata};
    if (note(store, &(st_note){.kept = &kept}, position) != ST_OK) {
        *position = 0;
    }
}

st_status st_job_keep(st_store *store, const st_job *job, uint64_t *position)
{
    return note(store, &(st_note){.job = job}, position);
}

st_status st_job_forget(st_store *store, const char *id, uint64_t *position)
{
    return note(store, &(st_note){.forgotten = id}, position);
}

st_status st_jobs_kept(st_store *store, st_take_job *take, void *context)
{
    const st_journal *journal = &store->journal;
    return journal->jobs == NULL ? ST_OK : journal->jobs(journal->self, take, context);
}

size_t st_listeners(st_store *store)
{
    return atomic_load(&store->followers.count);
}

const uint64_t *st_secret(const st_store *store)
{
    return store->journal.secret;
}

st_waits *st_store_waits(st_store *store)
{
    return store->followers.waits;
}

st_shown st_shown_of(const st_mesh_info *info)
{
    return (st_shown){info->position, info->position - 1, info->incarnation};
}

st_shown st_shown_all(st_store *store, uint64_t since)
{
    return (st_shown){.position = st_waits_newest(store->followers.waits), .since = since};
}

uint64_t st_store_count(st_store *store)
{
    if (store->journal.keeps) {
        return store->journal.count(store->journal.self);
    }
    st_lock_read(&store->lock);
    size_t count = store->count;
    pthread_rwlock_unlock(&store->lock);
    return count;
}

bool st_store_waits_for_disk(const st_store *store)
{
    return store->journal.keeps;
}

void st_store_health(const st_store *store, st_health *out)
{
    *out = (st_health){.status = ST_OK};
    if (store->journal.keeps) {
        store->journal.health(store->journal.self, out);
    }
}

/* Measures the store. The numbers may be from slightly different moments. */
void st_store_measure(st_store *store, st_store_measures *out)
{
    st_store_counts *counts = &store->followers.counts;
    *out = (st_store_measures){
        .meshes = st_store_count(store),
        .most_meshes = store->max_meshes,
        .meshes_in_memory = st_counted(&counts->weights[ST_WEIGHT_MESHES]),
        .vertices = st_counted(&counts->weights[ST_WEIGHT_VERTICES]),
        .edges = st_counted(&counts->weights[ST_WEIGHT_EDGES]),
        .faces = st_counted(&counts->weights[ST_WEIGHT_FACES]),
        .content_bytes = st_counted(&counts->weights[ST_WEIGHT_CONTENT]),
        .history_bytes = st_counted(&counts->weights[ST_WEIGHT_HISTORY]),
        .snapshot_bytes = st_counted(&counts->copies),
        .event_bytes = st_counted(&counts->queues.bytes),
        .revisions = st_counted(&counts->revisions),
        .evicted = st_counted(&counts->evicted),
        .listeners = st_listeners(store),
        .most_listeners = store->followers.most,
        .events = st_counted(&counts->queues.messages),
        .listeners_behind = st_counted(&counts->queues.behind),
    };
    for (size_t i = 0; i < ST_LOADED_COUNT; i++) {
        out->loads[i] = st_counted(&counts->loads[i]);
    }
    st_histogram_copy(&counts->load_time, &out->load_time);
    st_histogram_copy(&counts->queues.lag, &out->event_lag);
    if (store->journal.measure != NULL) {
        store->journal.measure(store->journal.self, &out->journal);
    }
}

st_mesh_options st_store_mesh_options(st_store *store)
{
    return (st_mesh_options){.store = store,
                             .journal = &store->journal,
                             .followers = &store->followers,
                             .holders = &store->holders,
                             .undo_budget = store->undo_budget,
                             .secret = store->journal.secret};
}

void st_store_shed(st_store *store)
{
    st_keys_shed(&store->keys);
    st_mesh *batch[MESH_BATCH];
    char after[ST_MESH_ID + 1] = "";
    size_t count;
    while ((count = st_list(store, after, batch, MESH_BATCH)) > 0) {
        memcpy(after, batch[count - 1]->info.id, sizeof after);
        for (size_t i = 0; i < count; i++) {
            st_mesh_shed(batch[i]);
            st_release(batch[i]);
        }
    }
}

void st_store_expire_copies(st_store *store, uint64_t before)
{
    st_mesh *batch[MESH_BATCH];
    char after[ST_MESH_ID + 1] = "";
    size_t count;
    /* Most of the time there are no copies, and the meshes, which may be many, are not visited. */
    while (st_counted(&store->followers.counts.copies) > 0 &&
           (count = st_list(store, after, batch, MESH_BATCH)) > 0) {
        memcpy(after, batch[count - 1]->info.id, sizeof after);
        for (size_t i = 0; i < count; i++) {
            st_copy_expire(batch[i], before);
            st_release(batch[i]);
        }
    }
}

/* --- holders of meshes --- */

st_status st_limit_holders(st_store *store, const st_holder_limit *limits, size_t count)
{
    return st_holders_limit(&store->holders, limits, count);
}

void st_holder_usage(st_store *store, const char *name, st_usage *out)
{
    st_holders_usage(&store->holders, name, out);
}

const char *st_holder_of(const st_mesh *mesh)
{
    return mesh->holding.holder == NULL ? "" : mesh->holding.holder->name;
}
