#include "server/store/store.h"

#include "server/store/held.h"
#include "server/store/mesh_events.h"
#include "server/store/stored_mesh.h"
#include "server/system/clock.h"
#include "server/system/memory.h"
#include "server/system/random.h"

#include <assert.h>
#include <string.h>

struct srv_store {
    srv_journal journal;
    uint64_t undo_budget;
    uint64_t max_meshes;
    srv_events events;
    pthread_rwlock_t lock; /* of the table */
    api_mesh **meshes;     /* in the order of ids, each with a use */
    size_t count, capacity;
    uint64_t secret[2];
    srv_keys keys; /* of what makes a mesh */
};

enum { ID_LENGTH = 10, SHED_BATCH = 64 };

srv_store *srv_store_new(const srv_store_options *options)
{
    srv_store *store = he_mem_zero(1, sizeof *store);
    if (store == NULL) {
        return NULL;
    }
    if (pthread_rwlock_init(&store->lock, NULL) != 0) {
        he_mem_free(store);
        return NULL;
    }
    store->journal = options->journal;
    store->undo_budget = options->undo_budget;
    store->max_meshes = options->max_meshes;
    store->secret[0] = srv_random();
    store->secret[1] = srv_random();
    srv_keys_init(&store->keys, store->secret);
    store->events = (srv_events){
        .most = options->listeners,
        .most_of_mesh = options->mesh_listeners,
        .pool = options->pool,
        .held = srv_held_new(store),
    };
    if (store->events.held == NULL) {
        pthread_rwlock_destroy(&store->lock);
        he_mem_free(store);
        return NULL;
    }
    return store;
}

void srv_store_free(srv_store *store)
{
    if (store == NULL) {
        return;
    }
    for (size_t i = 0; i < store->count; i++) {
        srv_mesh_release(store->meshes[i]);
    }
    he_mem_free(store->meshes);
    srv_keys_clear(&store->keys);
    srv_held_free(store->events.held);
    store->journal.close(store->journal.self);
    pthread_rwlock_destroy(&store->lock);
    he_mem_free(store);
}

/* The first mesh whose id is not below `id`; *found when it is that id. Under the table's lock. */
static size_t position_of(const srv_store *store, const char *id, bool *found)
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

static api_mesh *add_use(api_mesh *mesh)
{
    atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    return mesh;
}

static api_store_status find(void *self, const char *id, api_mesh **out)
{
    srv_store *store = self;
    bool found;
    pthread_rwlock_rdlock(&store->lock);
    size_t i = position_of(store, id, &found);
    if (found) {
        *out = add_use(store->meshes[i]);
    }
    pthread_rwlock_unlock(&store->lock);
    return found ? API_STORE_OK : API_STORE_ABSENT;
}

static void release(void *self, api_mesh *mesh)
{
    (void)self;
    srv_mesh_release(mesh);
}

static bool reserve_place(srv_store *store)
{
    if (store->count < store->capacity) {
        return true;
    }
    size_t capacity = he_mem_grown(store->capacity, store->count + 1);
    api_mesh **meshes = he_mem_array(store->meshes, capacity, sizeof(api_mesh *));
    if (meshes == NULL) {
        return false;
    }
    store->meshes = meshes;
    store->capacity = capacity;
    return true;
}

/* Under the table's exclusive lock. */
static api_store_status insert(srv_store *store, api_mesh *mesh)
{
    bool found;
    size_t place = position_of(store, mesh->info.id, &found);
    if (found) {
        return API_STORE_TAKEN;
    }
    if (store->count >= store->max_meshes) {
        return API_STORE_TOO_MANY;
    }
    if (!reserve_place(store)) {
        return API_STORE_NO_MEMORY;
    }
    memmove(store->meshes + place + 1, store->meshes + place,
            (store->count - place) * sizeof(api_mesh *));
    store->meshes[place] = mesh;
    store->count++;
    return API_STORE_OK;
}

static api_store_status create_as(srv_store *store, const char *id, const char *name,
                                  he_mesh *content, const api_claim *claim, api_mesh **out)
{
    api_mesh *mesh =
        srv_mesh_new(id, name, content, store->undo_budget, &store->journal, store->secret);
    if (mesh == NULL) {
        return API_STORE_NO_MEMORY;
    }
    mesh->events = &store->events;
    /* Whoever finds it waits until the journal has its first record. */
    pthread_rwlock_wrlock(&mesh->lock);
    pthread_rwlock_wrlock(&store->lock);
    api_store_status status = insert(store, mesh);
    pthread_rwlock_unlock(&store->lock);
    if (status == API_STORE_OK) {
        *out = add_use(mesh);
        mesh->claim = claim;
        srv_mesh_append(mesh, API_REPLACE, NULL, false);
        mesh->claim = NULL;
    } else {
        mesh->content = NULL; /* still the caller's */
    }
    pthread_rwlock_unlock(&mesh->lock);
    if (status != API_STORE_OK) {
        srv_mesh_release(mesh);
    }
    return status;
}

static api_store_status create(void *self, const char *id, const char *name, he_mesh *content,
                               const api_claim *claim, api_mesh **out)
{
    srv_store *store = self;
    if (srv_memory_is_full()) {
        srv_store_shed(store);
        if (srv_memory_is_full()) {
            return API_STORE_BUDGET;
        }
    }
    if (id != NULL) {
        return create_as(store, id, name, content, claim, out);
    }
    api_store_status status;
    do {
        char made[ID_LENGTH + 1];
        srv_random_id(made, ID_LENGTH);
        status = create_as(store, made, name, content, claim, out);
    } while (status == API_STORE_TAKEN);
    return status;
}

static api_store_status remove_mesh(void *self, api_mesh *mesh, api_mesh_info *info)
{
    srv_store *store = self;
    if (mesh->info.removed) {
        return API_STORE_ABSENT;
    }
    mesh->info.removed = true;
    srv_mesh_append(mesh, API_REPLACE, NULL, false);
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
    /* Only now may the id be another's. */
    bool found;
    pthread_rwlock_wrlock(&store->lock);
    size_t place = position_of(store, mesh->info.id, &found);
    assert(found && store->meshes[place] == mesh);
    store->count--;
    memmove(store->meshes + place, store->meshes + place + 1,
            (store->count - place) * sizeof(api_mesh *));
    pthread_rwlock_unlock(&store->lock);
    srv_mesh_release(mesh);
    return API_STORE_OK;
}

static size_t list(void *self, const char *after, api_mesh **out, size_t limit)
{
    srv_store *store = self;
    bool found;
    size_t given = 0;
    pthread_rwlock_rdlock(&store->lock);
    size_t i = position_of(store, after, &found);
    for (i += found ? 1 : 0; i < store->count && given < limit; i++) {
        out[given++] = add_use(store->meshes[i]);
    }
    pthread_rwlock_unlock(&store->lock);
    return given;
}

static api_claim_status claim_key(void *self, api_mesh *mesh, const api_key *key, api_claim **out)
{
    srv_store *store = self;
    srv_keys *keys = mesh == NULL ? &store->keys : &mesh->keys;
    api_claim_status status = srv_keys_claim(keys, key, srv_clock_utc(), out);
    if (status == API_CLAIM_NEW) {
        (*out)->of_store = mesh == NULL;
    }
    return status;
}

static const api_kept *kept(const api_claim *claim)
{
    return &claim->answer;
}

static void keep(void *self, api_claim *claim, const api_kept *answer)
{
    (void)self;
    srv_keys_keep(claim, answer);
}

static void claim_end(void *self, api_claim *claim)
{
    (void)self;
    srv_keys_end(claim);
}

static size_t listeners(void *self)
{
    srv_store *store = self;
    return atomic_load(&store->events.count);
}

static uint64_t random_number(void *self)
{
    (void)self;
    return srv_random();
}

api_store srv_store_interface(srv_store *store)
{
    return (api_store){
        .self = store,
        .secret = {store->secret[0], store->secret[1]},
        .find = find,
        .release = release,
        .create = create,
        .remove = remove_mesh,
        .list = list,
        .read_begin = srv_read_begin,
        .read_end = srv_read_end,
        .snapshot = srv_snapshot,
        .snapshot_at = srv_snapshot_at,
        .snapshot_held = srv_snapshot_held,
        .snapshot_content = srv_snapshot_content,
        .snapshot_release = srv_snapshot_release,
        .cache_get = srv_cache_get,
        .cache_put = srv_cache_put,
        .derived_begin = srv_derived_begin,
        .derived_end = srv_derived_end,
        .derived_wait = srv_derived_wait,
        .revision_delta = srv_revision_delta,
        .random = random_number,
        .write_begin = srv_write_begin,
        .write_keyed = srv_write_keyed,
        .write_commit = srv_write_commit,
        .write_abort = srv_write_abort,
        .tally = srv_tally,
        .undoable = srv_undoable,
        .steps_to = srv_steps_to,
        .step = srv_step_apply,
        .write_end = srv_write_end,
        .claim = srv_claim,
        .publish = srv_publish,
        .unclaim = srv_unclaim,
        .replace = srv_mesh_replace,
        .rename = srv_mesh_rename,
        .claim_key = claim_key,
        .kept = kept,
        .keep = keep,
        .claim_end = claim_end,
        .follow = srv_follow,
        .listeners = listeners,
        .history = srv_history,
        .history_facts = srv_history_facts,
    };
}

bool srv_store_is_durable(const srv_store *store, const api_mesh *mesh, uint64_t record)
{
    const srv_journal *journal = &store->journal;
    return journal->durable(journal->self, mesh->info.id, mesh->info.incarnation) >= record;
}

void srv_store_listen(srv_store *store, void (*notify)(void *context), void *context)
{
    store->journal.listen(store->journal.self, notify, context);
}

srv_held *srv_store_held(srv_store *store)
{
    return store->events.held;
}

size_t srv_store_count(srv_store *store)
{
    pthread_rwlock_rdlock(&store->lock);
    size_t count = store->count;
    pthread_rwlock_unlock(&store->lock);
    return count;
}

void srv_store_shed(srv_store *store)
{
    srv_keys_shed(&store->keys);
    api_mesh *batch[SHED_BATCH];
    char after[API_MESH_ID + 1] = "";
    size_t count;
    while ((count = list(store, after, batch, SHED_BATCH)) > 0) {
        memcpy(after, batch[count - 1]->info.id, sizeof after);
        for (size_t i = 0; i < count; i++) {
            srv_mesh_shed(batch[i]);
            srv_mesh_release(batch[i]);
        }
    }
}
