#include "durable/damage/specimen.h"

#include "tests/store_folder.h"
#include "tests/writing.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "base/siphash.h"
#include "store/write.h"
#include "stored/stored.h"

#include <semaphore.h>
#include <sqlite3.h>

enum { MESHES = 5, ID = 4, STATES = 2 };

/* What the store may show for a mesh id after it was opened again. */
typedef struct expected {
    char id[ID];
    bool absent;
    unsigned states; /* number of states in `digests`; the mesh may be in any of these states */
    uint64_t digests[STATES][2];
} expected;

static uint64_t key_revision; /* revision in the answer that is stored with the idempotency key */
static expected acknowledged[MESHES] = {
    {.id = "a"}, {.id = "b"}, {.id = "c"}, {.id = "d"}, {.id = "e"}};

/* --- a hash of all that can be seen of a mesh --- */

static void add(he_siphash *hash, const void *bytes, size_t size)
{
    he_siphash_add(hash, bytes, size);
}

static void add_text(he_siphash *hash, const char *text)
{
    add(hash, text, strlen(text) + 1);
}

static void add_content(he_siphash *hash, const he_mesh *content)
{
    unsigned char *bytes = malloc(he_stored_content_bound(content));
    assert_non_null(bytes);
    add(hash, bytes, he_stored_content_write(content, bytes));
    free(bytes);
}

static void add_info(he_siphash *hash, const st_mesh_info *info)
{
    const uint64_t numbers[] = {info->incarnation, info->metadata, info->revision,
                                info->record,      info->undo,     info->redo};
    const double times[] = {info->created, info->modified};
    add_text(hash, info->id);
    add_text(hash, info->name);
    add(hash, numbers, sizeof numbers);
    add(hash, times, sizeof times);
}

/* Adds the mesh's history to a hash and returns the oldest revision that can be reached. Older
 * entries are left out, because a mesh that was loaded does not list them. */
static uint64_t add_history(he_siphash *hash, st_mesh *mesh)
{
    st_history reach;
    st_entry entry;
    st_history_reach(mesh, &reach);
    add(hash, &reach.oldest, sizeof reach.oldest);
    for (size_t i = 0; st_history_entry(mesh, i, &entry) && entry.revision > reach.oldest; i++) {
        const uint64_t numbers[] = {entry.revision, entry.inverts, entry.action, entry.undoable};
        add(hash, numbers, sizeof numbers);
        add(hash, &entry.time, sizeof entry.time);
        add(hash, &entry.tally, sizeof entry.tally);
        add_text(hash, entry.ops);
    }
    return reach.oldest;
}

static void digest(st_mesh *mesh, uint64_t out[2])
{
    static const uint64_t seed[2] = {1, 2};
    he_siphash hash;
    st_mesh_info info;
    he_siphash_begin(&hash, seed);
    const he_mesh *content = st_read_begin(mesh, &info);
    add_info(&hash, &info);
    add_content(&hash, content);
    uint64_t revision = add_history(&hash, mesh);
    st_read_end(mesh);
    for (; revision < info.revision; revision++) {
        st_snapshot *earlier = NULL;
        st_status status = st_snapshot_at(mesh, revision, &earlier);
        add(&hash, &status, sizeof status);
        if (status == ST_OK) {
            add_content(&hash, st_snapshot_content(earlier, NULL));
            st_snapshot_release(earlier);
        }
    }
    he_siphash_end(&hash, out);
}

/* --- the store --- */

/* Opens a store. Returns NULL if it cannot be opened; `why` then becomes a sentence with the
 * reason. */
static st_store *open_with(const char *folder, uint64_t budget, st_pool *pool,
                           char why[SPECIMEN_WHY])
{
    st_sqlite_opened opened;
    if (!st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = "test"}, &opened)) {
        (void)snprintf(why, SPECIMEN_WHY, "%.*s", SPECIMEN_WHY - 1, opened.message);
        return NULL;
    }
    st_store *store = st_store_new(&(st_store_options){.undo_budget = budget,
                                                       .max_meshes = 1000,
                                                       .journal = opened.journal,
                                                       .pool = pool,
                                                       .base_bytes = 1});
    assert_non_null(store);
    return store;
}

static st_store *open_store(const char *folder, char why[SPECIMEN_WHY])
{
    return open_with(folder, 1 << 20, NULL, why);
}

static void resume(st_wait *wait)
{
    sem_t *ended = (sem_t *)(void *)(wait + 1);
    sem_post(ended);
}

/* Waits until the newest change is durable or lost; returns true if it is durable. */
static bool is_kept(st_store *store)
{
    struct {
        st_wait wait;
        sem_t ended;
    } w = {.wait = {.shown.position = st_waits_newest(st_store_waits(store)), .resume = resume}};
    sem_init(&w.ended, 0, 0);
    if (st_waits_add(st_store_waits(store), &w.wait)) {
        sem_wait(&w.ended);
    }
    sem_destroy(&w.ended);
    return w.wait.end == ST_WAIT_DURABLE;
}

/* --- making the store --- */

static st_mesh *make(st_store *store, const char *id)
{
    st_mesh *mesh = NULL;
    he_mesh *content = script_mesh("012,023,034", NULL);
    script_add_columns(content);
    assert_int_equal(st_create(store, id, id, content, NULL, &mesh), ST_OK);
    return mesh;
}

static st_status edit_keyed(st_mesh *mesh, const char *operations, const st_keyed *keyed)
{
    st_write w;
    st_status status = st_write_begin(mesh, &(st_cause){.keyed = keyed}, &w);
    if (status != ST_OK) {
        return status;
    }
    script_prepare(w.content, operations);
    if (st_write_changes(&w, NULL) != HE_OK) {
        st_write_abort(&w);
        return ST_NO_MEMORY;
    }
    return st_write_commit(&w, operations);
}

static st_status edit(st_mesh *mesh, const char *operations)
{
    return edit_keyed(mesh, operations, NULL);
}

static const st_key key = {.text = "a key", .digest = {1, 2}};

/* Makes an edit with an idempotency key, so that the store keeps the key with the answer. */
static void edit_once(st_store *store, st_mesh *mesh)
{
    st_keyed *keyed;
    st_mesh_info info;
    assert_int_equal(st_keyed_begin(store, mesh, &key, &keyed), ST_KEYED_NEW);
    assert_int_equal(edit_keyed(mesh, "face_delete face=#0", keyed), ST_OK);
    (void)st_read_begin(mesh, &info);
    st_read_end(mesh);
    const st_kept answer = {.status = 200, .changed = true, .revision = info.revision};
    key_revision = info.revision;
    st_keyed_keep(keyed, &answer);
    st_keyed_end(keyed);
}

static void rename_to(st_mesh *mesh, const char *name)
{
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_rename(&w, name);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
}

static void post(void *context)
{
    sem_post(context);
}

/* Waits until the thread pool has finished all earlier tasks about the mesh `id`. */
static void await_base(st_pool *pool, const char *id)
{
    sem_t done;
    sem_init(&done, 0, 0);
    const st_task task = {
        .work = post, .context = &done, .share = ST_SHARE_JOB, .flow = st_pool_flow("", id)};
    assert_true(st_pool_submit(pool, &task));
    sem_wait(&done);
    sem_destroy(&done);
}

static int snapshots_in(const char *folder)
{
    char path[2 * FOLDER_PATH];
    sqlite3 *db;
    sqlite3_stmt *s;
    (void)snprintf(path, sizeof path, "%s/hedge.db", folder);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(
        sqlite3_prepare_v2(db, "SELECT count(*) FROM snapshot WHERE mesh > 0", -1, &s, NULL),
        SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_ROW);
    const int count = sqlite3_column_int(s, 0);
    sqlite3_finalize(s);
    sqlite3_close(db);
    return count;
}

/* Makes the mesh "b", which is later loaded from a snapshot, so that edits from before the snapshot
 * can no longer be undone. */
static void make_based(const char *folder)
{
    char why[SPECIMEN_WHY];
    st_pool *pool = st_pool_new("bases", 3, 100);
    st_store *store = open_with(folder, 2000, pool, why);
    assert_non_null(store);
    st_mesh *b = make(store, "b");
    for (unsigned i = 0; i < 100 && snapshots_in(folder) == 0; i++) {
        assert_int_equal(edit(b, "vertex_move vertex=0 by=0,0,1"), ST_OK);
        await_base(pool, "b");
        assert_true(is_kept(store));
    }
    st_release(b);
    st_store_free(store);
    st_pool_free(pool);
    assert_true(snapshots_in(folder) > 0);
}

static void make_others(const char *folder)
{
    char why[SPECIMEN_WHY];
    st_store *store = open_store(folder, why);
    assert_non_null(store);
    st_mesh *a = make(store, "a");
    assert_int_equal(edit(a, "face_poke face=#1;vertex_add position=1,2,3"), ST_OK);
    assert_int_equal(edit(a, "mark locked face=0"), ST_OK);
    assert_int_equal(writing_step(a, ST_UNDO, 2), ST_OK);
    st_release(a);
    st_release(make(store, "c"));
    st_release(make(store, "d"));
    st_store_free(store);
}

static st_mesh *load(st_store *store, const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_load(store, id, &mesh), ST_OK);
    assert_string_equal(st_damage(mesh), "");
    return mesh;
}

static void note(expected *e, st_mesh *mesh)
{
    digest(mesh, e->digests[0]);
    e->states = 1;
    st_release(mesh);
}

void specimen_make(const char *made, const char *killed)
{
    char why[SPECIMEN_WHY];
    make_based(made);
    make_others(made);
    st_store *store = open_store(made, why);
    assert_non_null(store);
    st_mesh *a = load(store, "a"), *b = load(store, "b"), *c = load(store, "c"),
            *d = load(store, "d");
    assert_int_equal(writing_step(a, ST_REDO, 1), ST_OK);
    assert_true(is_kept(store));
    rename_to(a, "another name");
    assert_int_equal(writing_replace(c, script_mesh("0123", NULL), "replaced", NULL), ST_OK);
    assert_int_equal(writing_remove(d), ST_OK);
    assert_true(is_kept(store));
    assert_true(is_kept(store));
    edit_once(store, b);
    assert_true(is_kept(store));
    note(&acknowledged[0], a);
    note(&acknowledged[1], b);
    note(&acknowledged[2], c);
    st_release(d);
    acknowledged[3].absent = acknowledged[4].absent = true;
    folder_copy(made, killed);
    st_store_free(store);
}

/* --- comparing what the store shows --- */

__attribute__((format(printf, 2, 3))) static specimen_verdict wrong(char why[SPECIMEN_WHY],
                                                                    const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(why, SPECIMEN_WHY, format, arguments);
    va_end(arguments);
    return SPECIMEN_WRONG;
}

static specimen_verdict judge_content(const expected *e, st_mesh *mesh, const char *when,
                                      char why[SPECIMEN_WHY])
{
    uint64_t found[2];
    digest(mesh, found);
    for (unsigned i = 0; i < e->states; i++) {
        if (memcmp(found, e->digests[i], sizeof found) == 0) {
            return SPECIMEN_WHOLE;
        }
    }
    return wrong(why, "%s: mesh %s is %s", when, e->id,
                 e->states == 0 ? "there, and was removed" : "another one than it was");
}

/* Set if the store reported a damaged idempotency key when it was opened. The store may forget a
 * damaged key, but must never give another answer for it. */
static bool key_was_told;

static specimen_verdict judge_key(st_store *store, st_mesh *mesh, char why[SPECIMEN_WHY])
{
    st_keyed *keyed;
    st_health health;
    specimen_verdict verdict = SPECIMEN_WHOLE;
    st_store_health(store, &health);
    key_was_told |= health.damaged_keys > 0;
    switch (st_keyed_begin(store, mesh, &key, &keyed)) {
    case ST_KEYED_NEW:
        (void)snprintf(why, SPECIMEN_WHY, "the key is forgotten");
        verdict = key_was_told ? SPECIMEN_NAMED : wrong(why, "the key is forgotten without a word");
        st_keyed_end(keyed);
        break;
    case ST_KEYED_DAMAGED:
        (void)snprintf(why, SPECIMEN_WHY, "the key is damaged");
        verdict = key_was_told ? SPECIMEN_NAMED : wrong(why, "a damaged key is not told");
        break;
    case ST_KEYED_KEPT:
        if (st_keyed_answer(keyed)->revision != key_revision) {
            verdict = wrong(why, "the key's answer is another one");
        }
        st_keyed_end(keyed);
        break;
    case ST_KEYED_BUSY:
    case ST_KEYED_OTHER:
    case ST_KEYED_NO_MEMORY:
        verdict = wrong(why, "the key is one of another request");
    }
    return verdict;
}

static specimen_verdict judge_mesh(st_store *store, const expected *e, const char *when,
                                   char why[SPECIMEN_WHY])
{
    st_mesh *mesh = NULL;
    st_status status = st_load(store, e->id, &mesh);
    specimen_verdict verdict = SPECIMEN_NAMED;
    if (status == ST_ABSENT) {
        return e->absent ? SPECIMEN_WHOLE : wrong(why, "%s: mesh %s is not there", when, e->id);
    }
    if (status != ST_OK) {
        return wrong(why, "%s: loading mesh %s is status %d", when, e->id, (int)status);
    }
    if (st_damage(mesh)[0] == '\0') {
        verdict = judge_content(e, mesh, when, why);
        if (verdict == SPECIMEN_WHOLE && e->id[0] == 'b') {
            verdict = judge_key(store, mesh, why);
        }
    } else {
        (void)snprintf(why, SPECIMEN_WHY, "%s: mesh %s: %.200s", when, e->id, st_damage(mesh));
    }
    st_release(mesh);
    return verdict;
}

static specimen_verdict judge_list(st_store *store, const expected *all, const char *when,
                                   char why[SPECIMEN_WHY])
{
    st_card cards[2 * MESHES];
    size_t count = 0, at = 0;
    st_status status = st_cards(store, "", cards, 2 * MESHES, &count);
    if (status != ST_OK) {
        return wrong(why, "%s: listing is status %d", when, (int)status);
    }
    for (size_t i = 0; i < MESHES; i++) {
        if (at < count && strcmp(cards[at].id, all[i].id) == 0) {
            if (all[i].states == 0 && cards[at].damage[0] == '\0') {
                return wrong(why, "%s: %s is listed", when, all[i].id);
            }
            at++;
        } else if (!all[i].absent) {
            return wrong(why, "%s: %s is not listed", when, all[i].id);
        }
    }
    return at == count ? SPECIMEN_WHOLE : wrong(why, "%s: \"%s\" is listed", when, cards[at].id);
}

static specimen_verdict judge_all(st_store *store, const expected *all, const char *when,
                                  char why[SPECIMEN_WHY])
{
    specimen_verdict worst = judge_list(store, all, when, why);
    for (size_t i = 0; i < MESHES && worst != SPECIMEN_WRONG; i++) {
        specimen_verdict verdict = judge_mesh(store, &all[i], when, why);
        worst = verdict > worst ? verdict : worst;
    }
    return worst;
}

/* --- changing the store that was opened --- */

/* Records that a mesh was changed, and returns whether the change became durable. If it did not,
 * the mesh may later have the old state or the new one. */
static bool is_changed(st_store *store, expected *e, st_mesh *mesh)
{
    uint64_t after[2];
    digest(mesh, after);
    const bool kept = is_kept(store);
    if (kept) {
        e->states = 0;
        e->absent = false;
    }
    memcpy(e->digests[e->states++], after, sizeof after);
    return kept;
}

static bool is_removed(st_store *store, expected *e, st_mesh *mesh)
{
    if (writing_remove(mesh) != ST_OK) {
        return false;
    }
    const bool kept = is_kept(store);
    e->absent = true;
    e->states = kept ? 0 : e->states;
    return kept;
}

/* Changes, creates and removes meshes; returns whether the store accepted all these writes. A
 * damaged mesh is only removed. */
static bool go_on(st_store *store, expected all[MESHES])
{
    bool taken = true;
    st_mesh *mesh = NULL;
    for (unsigned i = 0; i < 3; i++) {
        if (st_load(store, all[i].id, &mesh) != ST_OK) {
            continue;
        }
        if (i == 1) {
            taken = is_removed(store, &all[i], mesh) && taken;
        } else if (st_damage(mesh)[0] == '\0') {
            taken = edit(mesh, "vertex_add position=1,1,1") == ST_OK &&
                    is_changed(store, &all[i], mesh) && taken;
        }
        st_release(mesh);
    }
    if (st_create(store, "e", "new", script_mesh("012", NULL), NULL, &mesh) != ST_OK) {
        return false;
    }
    taken = is_changed(store, &all[4], mesh) && taken;
    st_release(mesh);
    return taken;
}

specimen_verdict specimen_judge(const char *folder, char why[SPECIMEN_WHY])
{
    expected all[MESHES];
    memcpy(all, acknowledged, sizeof all);
    key_was_told = false;
    why[0] = '\0';
    st_store *store = open_store(folder, why);
    if (store == NULL) {
        return why[0] != '\0' ? SPECIMEN_REFUSED : wrong(why, "it is refused without a word");
    }
    specimen_verdict verdict = judge_all(store, all, "as found", why);
    if (verdict == SPECIMEN_WRONG) {
        st_store_free(store);
        return verdict;
    }
    if (!go_on(store, all) && verdict < SPECIMEN_STOPPED) {
        verdict = SPECIMEN_STOPPED;
        (void)snprintf(why, SPECIMEN_WHY, "changes are refused");
    }
    st_store_free(store);
    store = open_store(folder, why);
    if (store == NULL) {
        return why[0] != '\0' ? SPECIMEN_REFUSED : wrong(why, "it is refused without a word");
    }
    specimen_verdict later = judge_all(store, all, "after more changes", why);
    st_store_free(store);
    return later > verdict ? later : verdict;
}
