#include "store/stored_mesh.h"
#include "system/clock.h"
#include "system/lock.h"
#include "system/random.h"

#include <string.h>

static void copy_name(char *out, size_t size, const char *name)
{
    size_t length = strlen(name);
    if (length >= size) {
        length = size - 1;
        /* The name is cut before a character, never inside a UTF-8 sequence. */
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) {
            length--;
        }
    }
    memcpy(out, name, length);
    out[length] = '\0';
}

/* Initialises a readers-writer lock that prefers writers, so that many readers cannot make a writer
 * wait for ever. */
static int init_lock(pthread_rwlock_t *lock)
{
    pthread_rwlockattr_t attributes;
    pthread_rwlockattr_init(&attributes);
#ifdef __GLIBC__
    pthread_rwlockattr_setkind_np(&attributes, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP);
#endif
    int failed = pthread_rwlock_init(lock, &attributes);
    pthread_rwlockattr_destroy(&attributes);
    return failed;
}

st_mesh *st_mesh_bare(const st_mesh_options *options, const st_card *card)
{
    st_mesh *mesh = he_mem_zero(1, sizeof *mesh);
    if (mesh == NULL || init_lock(&mesh->lock) != 0) {
        he_mem_free(mesh);
        return NULL;
    }
    pthread_mutex_init(&mesh->snapshot_lock, NULL);
    pthread_mutex_init(&mesh->past_lock, NULL);
    pthread_mutex_init(&mesh->cache_lock, NULL);
    st_keys_init(&mesh->keys, options->secret);
    for (int kind = 0; kind < ST_DERIVED_COUNT; kind++) {
        pthread_mutex_init(&mesh->derived[kind].lock, NULL);
        st_clock_condition(&mesh->derived[kind].ended);
    }
    atomic_init(&mesh->uses, 1);
    mesh->store = options->store;
    mesh->journal = options->journal;
    mesh->followers = options->followers;
    mesh->holders = options->holders;
    mesh->sorted = options->journal->keeps ? NULL : st_sorted_entry_new();
    mesh->holding.bytes = card->bytes;
    mesh->info.incarnation = card->incarnation;
    mesh->info.metadata = card->metadata;
    mesh->info.revision = card->revision;
    mesh->info.record = card->record;
    mesh->info.created = card->created;
    mesh->info.modified = card->modified;
    copy_name(mesh->info.id, sizeof mesh->info.id, card->id);
    copy_name(mesh->info.name, sizeof mesh->info.name, card->name);
    st_queue_init(&mesh->queue, (st_place){.key = card->revision}, &mesh->followers->counts.queues);
    mesh->base = card->revision;
    const bool unsorted = mesh->sorted == NULL && !options->journal->keeps;
    if (unsorted ||
        st_holders_find(options->holders, card->holder, &mesh->holding.holder) != ST_OK) {
        st_release(mesh);
        return NULL;
    }
    st_mesh_weigh(mesh);
    return mesh;
}

st_mesh *st_mesh_new(const st_mesh_options *options, const char *id, const char *name,
                     const st_cause *cause, he_mesh *content)
{
    double now = st_clock_utc();
    st_card card = {
        .incarnation = st_random(), .metadata = 1, .revision = 1, .created = now, .modified = now};
    copy_name(card.id, sizeof card.id, id);
    copy_name(card.name, sizeof card.name, name == NULL ? "" : name);
    st_copy_text(card.holder, cause == NULL || cause->holder == NULL ? "" : cause->holder,
                 ST_HOLDER);
    st_mesh *mesh = st_mesh_bare(options, &card);
    if (mesh != NULL) {
        const st_point begin = {.revision = 1, .state = 1, .time = now};
        mesh->content = content;
        st_log_init(&mesh->log, options->undo_budget, &begin, content);
    }
    return mesh;
}

static void put_weights(st_mesh *mesh, const uint64_t weights[ST_WEIGHT_COUNT])
{
    st_store_counts *counts = &mesh->followers->counts;
    for (size_t i = 0; i < ST_WEIGHT_COUNT; i++) {
        if (weights[i] != mesh->weights[i]) {
            /* The subtraction is unsigned and wraps around, so adding its result is right even if
             * the weight has become smaller. */
            st_count(&counts->weights[i], weights[i] - mesh->weights[i]);
            mesh->weights[i] = weights[i];
        }
    }
}

void st_mesh_weigh(st_mesh *mesh)
{
    const he_mesh *content = mesh->content;
    uint64_t weights[ST_WEIGHT_COUNT] = {[ST_WEIGHT_MESHES] = 1};
    if (content != NULL) {
        weights[ST_WEIGHT_VERTICES] = he_mesh_vertices(content);
        weights[ST_WEIGHT_EDGES] = he_mesh_edges(content);
        weights[ST_WEIGHT_FACES] = he_mesh_faces(content);
        weights[ST_WEIGHT_CONTENT] = he_mesh_bytes(content);
        weights[ST_WEIGHT_HISTORY] = mesh->log.bytes;
    }
    put_weights(mesh, weights);
}

static void drop_derived(st_mesh *mesh)
{
    for (int kind = 0; kind < ST_DERIVED_COUNT; kind++) {
        st_derived *place = st_derived_begin(mesh, (st_derived_kind)kind);
        if (place->value != NULL) {
            place->destroy(place->value);
            *place = (st_derived){NULL, NULL};
        }
        st_derived_end(mesh, (st_derived_kind)kind);
    }
}

st_mesh *st_hold(st_mesh *mesh)
{
    atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    return mesh;
}

void st_release(st_mesh *mesh)
{
    if (mesh == NULL || atomic_fetch_sub_explicit(&mesh->uses, 1, memory_order_acq_rel) > 1) {
        return;
    }
    const uint64_t nothing[ST_WEIGHT_COUNT] = {0};
    put_weights(mesh, nothing);
    st_rebase_drop(mesh);
    st_log_clear(&mesh->log);
    st_queue_clear(&mesh->queue);
    he_mesh_free(mesh->content);
    st_copy_release(mesh->copy);
    st_copy_release(mesh->past);
    st_sorted_entry_free(mesh->sorted);
    he_mem_free(mesh->cache);
    he_mem_free(mesh->damage);
    st_keys_clear(&mesh->keys);
    drop_derived(mesh);
    pthread_rwlock_destroy(&mesh->lock);
    pthread_mutex_destroy(&mesh->snapshot_lock);
    pthread_mutex_destroy(&mesh->past_lock);
    pthread_mutex_destroy(&mesh->cache_lock);
    for (int kind = 0; kind < ST_DERIVED_COUNT; kind++) {
        pthread_mutex_destroy(&mesh->derived[kind].lock);
        pthread_cond_destroy(&mesh->derived[kind].ended);
    }
    he_mem_free(mesh);
}

st_status st_unreadable(const st_mesh *mesh)
{
    return mesh->info.unreadable;
}

const char *st_damage(const st_mesh *mesh)
{
    return mesh->damage == NULL ? "" : mesh->damage;
}

void st_mesh_facts(const st_mesh *mesh, st_mesh_info *out)
{
    *out = mesh->info;
    out->undo = mesh->log.undo_count;
    out->redo = mesh->log.redo_count;
    out->busy = mesh->claimed;
}

st_counts st_counts_of(const he_mesh *content)
{
    return (st_counts){.vertices = he_mesh_vertices(content),
                       .edges = he_mesh_edges(content),
                       .faces = he_mesh_faces(content),
                       .boundary = he_mesh_boundary_halfedges(content)};
}

st_record st_mesh_facts_record(const st_mesh *mesh, st_record_kind kind)
{
    st_record record = {
        .kind = kind,
        .id = mesh->info.id,
        .name = mesh->info.name,
        .holder = st_holder_of(mesh),
        .incarnation = mesh->info.incarnation,
        .number = mesh->info.record,
        .revision = mesh->info.revision,
        .metadata = mesh->info.metadata,
        .created = mesh->info.created,
        .time = mesh->info.modified,
        .counts = st_counts_of(mesh->content),
        .bytes = he_mesh_bytes(mesh->content),
    };
    st_log_fill_record(&mesh->log, &record);
    return record;
}

st_record st_mesh_record(st_mesh *mesh, st_record_kind kind, const st_cause *cause)
{
    mesh->info.record++;
    st_record record = st_mesh_facts_record(mesh, kind);
    if (cause != NULL) {
        record.key = cause->keyed == NULL ? NULL : &cause->keyed->key;
        record.job = cause->job;
    }
    return record;
}

/* If this record has all mesh data and ends the history before it, notes that the mesh can be
 * loaded from this record on. */
static void note_base(st_mesh *mesh, const st_record *record)
{
    if (record->barrier && (record->kind == ST_RECORD_CONTENT || record->stage != NULL)) {
        mesh->base = record->revision;
    }
}

st_status st_mesh_grow(st_mesh *mesh, uint64_t bytes)
{
    const st_holding come = {mesh->holding.holder, bytes};
    st_status status = st_holders_move(mesh->holders, &mesh->holding, &come);
    if (status == ST_OK) {
        mesh->holding = come;
    }
    return status;
}

/* Sets how many bytes the mesh counts for its holder (owner) to the number in its newest record.
 * st_holders_count gets equal numbers when it reads the cards in the journal. */
static void count_held(st_mesh *mesh, const st_record *record)
{
    const bool removed = record->kind == ST_RECORD_REMOVE;
    const st_holding come = {removed ? NULL : mesh->holding.holder, record->bytes};
    if (removed || record->bytes != mesh->holding.bytes) {
        st_holders_note(mesh->holders, &mesh->holding, &come);
        mesh->holding.bytes = come.bytes;
    }
}

static bool is_revision(st_record_kind kind)
{
    return kind <= ST_RECORD_CONTENT;
}

static void count_revisions(st_mesh *mesh, const st_record *records, size_t count)
{
    uint64_t revisions = 0;
    for (size_t i = 0; i < count; i++) {
        revisions += is_revision(records[i].kind);
    }
    st_count(&mesh->followers->counts.revisions, revisions);
}

void st_mesh_publish(st_mesh *mesh, const st_group *group)
{
    const st_journal *journal = mesh->journal;
    st_booking_fill(group->booking, group->records);
    mesh->info.position =
        journal->append(journal->self, group->booking->room, group->records, group->count);
    *group->booking = (st_booking){NULL};
    count_held(mesh, &group->records[group->count - 1]);
    st_store_sort(mesh->store, mesh, &group->records[group->count - 1]);
    for (size_t i = 0; i < group->count; i++) {
        note_base(mesh, &group->records[i]);
    }
    st_mesh_weigh(mesh);
    count_revisions(mesh, group->records, group->count);
    st_waits_appended(mesh->followers->waits, mesh->info.position);
    st_mesh_tell(mesh, group);
    st_rebase_note(mesh, group);
}

static bool is_lost(const st_mesh_info *info, const st_loss *loss)
{
    return !info->removed && !info->lost && info->position >= loss->from &&
           info->position <= loss->to &&
           (loss->incarnation == 0 || loss->incarnation == info->incarnation);
}

void st_mesh_lose(st_mesh *mesh, const st_loss *loss)
{
    st_lock_read(&mesh->lock);
    bool found = is_lost(&mesh->info, loss);
    pthread_rwlock_unlock(&mesh->lock);
    if (found) {
        st_lock_write(&mesh->lock);
        /* The check is repeated under the lock: the mesh may have been removed in the meantime, and
         * then the removal is its newest change and may be lost, too. */
        if (is_lost(&mesh->info, loss)) {
            mesh->info.lost = true;
            st_queue_lose(&mesh->queue);
            st_store_take_out(mesh->store, mesh);
        }
        pthread_rwlock_unlock(&mesh->lock);
    }
}

const he_mesh *st_read_begin(st_mesh *mesh, st_mesh_info *info)
{
    st_lock_read(&mesh->lock);
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
    return mesh->content;
}

void st_read_end(st_mesh *mesh)
{
    pthread_rwlock_unlock(&mesh->lock);
}

uint64_t st_read_card(st_mesh *mesh, st_mesh_info *info)
{
    const he_mesh *content = st_read_begin(mesh, info);
    uint64_t issued = (uint64_t)he_mesh_issued(content, HE_VERTEX) +
                      he_mesh_issued(content, HE_HALFEDGE) + he_mesh_issued(content, HE_FACE);
    st_read_end(mesh);
    return issued;
}

bool st_history_entry(st_mesh *mesh, size_t i, st_entry *out)
{
    return st_log_entry(&mesh->log, i, out);
}

void st_history_reach(st_mesh *mesh, st_history *out)
{
    const st_revision_log *log = &mesh->log;
    const bool on_disk = mesh->journal->keeps && mesh->base < log->oldest;
    *out = (st_history){.oldest = on_disk ? mesh->base : log->oldest,
                        .dropped = log->dropped,
                        .bytes = log->bytes,
                        .budget = log->budget};
}

bool st_cache_get(st_mesh *mesh, void *value, size_t size)
{
    pthread_mutex_lock(&mesh->cache_lock);
    bool found = mesh->cache != NULL && mesh->cache_size == size &&
                 mesh->cache_revision == mesh->info.revision;
    if (found) {
        memcpy(value, mesh->cache, size);
    }
    pthread_mutex_unlock(&mesh->cache_lock);
    return found;
}

/* Keeps a value that was derived from the mesh. If memory is out, the value is not kept and must be
 * derived again. */
void st_cache_put(st_mesh *mesh, const void *value, size_t size)
{
    pthread_mutex_lock(&mesh->cache_lock);
    if (mesh->cache_size != size) {
        he_mem_free(mesh->cache);
        mesh->cache = he_mem_alloc(size);
        mesh->cache_size = mesh->cache == NULL ? 0 : size;
    }
    if (mesh->cache != NULL) {
        memcpy(mesh->cache, value, size);
        mesh->cache_revision = mesh->info.revision;
    }
    pthread_mutex_unlock(&mesh->cache_lock);
}

void st_cache_put_of(st_mesh *mesh, const st_mesh_info *of, const void *value, size_t size)
{
    st_mesh_info now;
    (void)st_read_begin(mesh, &now);
    if (now.revision == of->revision && now.incarnation == of->incarnation) {
        st_cache_put(mesh, value, size);
    }
    st_read_end(mesh);
}

st_derived *st_derived_begin(st_mesh *mesh, st_derived_kind kind)
{
    pthread_mutex_lock(&mesh->derived[kind].lock);
    return &mesh->derived[kind].place;
}

void st_derived_end(st_mesh *mesh, st_derived_kind kind)
{
    pthread_cond_broadcast(&mesh->derived[kind].ended);
    pthread_mutex_unlock(&mesh->derived[kind].lock);
}

void st_derived_wait(st_mesh *mesh, st_derived_kind kind)
{
    const uint64_t since = st_clock_micros();
    (void)st_clock_wait(&mesh->derived[kind].ended, &mesh->derived[kind].lock,
                        since + ST_DERIVED_MILLIS * 1000);
    st_lock_count(since);
}

const he_delta *st_revision_delta(st_mesh *mesh, uint64_t revision)
{
    return st_log_delta(&mesh->log, revision);
}

void st_mesh_shed(st_mesh *mesh)
{
    st_copy_shed(mesh);
    st_keys_shed(&mesh->keys);
    drop_derived(mesh);
}
