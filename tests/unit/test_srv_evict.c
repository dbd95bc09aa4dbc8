/* Meshes leave memory and are loaded again while threads find, change, create, delete and list
 * them: a mesh must be loaded only once for all threads that need it, and no change may be lost or
 * made twice. */
#include "tests/kept_journal.h"
#include "tests/seed.h"
#include "tests/slow_journal.h"
#include "tests/unit/dense.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "store/table.h"
#include "system/memory.h"
#include "system/resident.h"
#include "tests/model/random.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/mman.h>

enum { MESHES = 5, THREADS = 4, OPERATIONS = 4000 };
static const uint64_t BUDGET = (uint64_t)1 << 30;

static const char *const ids[MESHES] = {"a", "b", "c", "d", "e"};

static kept_journal *journal;
static st_store *store;
static _Atomic bool broken;
static _Atomic unsigned made, removed, edited, loaded, seen;

static st_store *open_store(st_pool *pool)
{
    return st_store_new(&(st_store_options){.undo_budget = 2000,
                                            .max_meshes = MESHES,
                                            .journal = kept_journal_open(journal),
                                            .pool = pool,
                                            .base_bytes = 3000});
}

static void expect(bool good)
{
    if (!good) {
        atomic_store(&broken, true);
    }
}

/* Removes every mesh that is not in use from memory. */
static void evict(void)
{
    st_make_room(store, BUDGET - BUDGET / 16);
}

static void make(const char *id)
{
    st_mesh *mesh = NULL;
    he_mesh *content = fixture_mesh("012,023,031");
    st_status status = st_create(store, id, "", content, NULL, &mesh);
    expect(status == ST_OK || status == ST_TAKEN);
    if (status == ST_OK) {
        st_release(mesh);
        atomic_fetch_add(&made, 1);
    } else {
        he_mesh_free(content);
    }
}

/* Returns whether the mesh has this revision, which the x coordinate of vertex 0 shows: each edit
 * sets it to the number of its revision. */
static bool is_whole(const he_mesh *m, uint64_t revision)
{
    double x = he_position(m, (he_vertex){0}).x;
    return revision == 1 || x == (double)revision;
}

static void edit(st_mesh *mesh)
{
    st_write w;
    st_status status = st_write_begin(mesh, NULL, &w);
    expect(status == ST_OK || status == ST_ABSENT);
    if (status != ST_OK) {
        return;
    }
    const uint32_t vertex = 0;
    const he_vec3 to = {(double)(w.info.revision + 1), 0, 0};
    expect(is_whole(w.content, w.info.revision));
    expect(he_vertex_move(w.content, &vertex, 1, HE_MOVE_TO, &to, 1, NULL) == HE_OK);
    expect(writing_commit(&w, "vertex_move", NULL));
    atomic_fetch_add(&edited, 1);
}

static void look(st_mesh *mesh)
{
    st_mesh_info info;
    const he_mesh *m = st_read_begin(mesh, &info);
    expect(info.removed || is_whole(m, info.revision));
    st_read_end(mesh);
    atomic_fetch_add(&seen, 1);
}

static void list(void)
{
    st_card cards[MESHES];
    size_t count = 0;
    expect(st_cards(store, "", cards, MESHES, &count) == ST_OK && count <= MESHES);
    for (size_t i = 1; i < count; i++) {
        expect(strcmp(cards[i - 1].id, cards[i].id) < 0);
    }
}

static void remove_one(st_mesh *mesh)
{
    st_status status = writing_remove(mesh);
    expect(status == ST_OK || status == ST_ABSENT);
    atomic_fetch_add(&removed, status == ST_OK ? 1 : 0);
}

static void *run(void *context)
{
    md_random *random = context;
    for (int i = 0; i < OPERATIONS; i++) {
        const char *id = ids[md_below(random, MESHES)];
        uint32_t what = md_below(random, 20);
        st_mesh *mesh = NULL;
        if (what == 0) {
            evict();
            continue;
        }
        if (what == 1) {
            list();
            continue;
        }
        st_status status = st_find(store, id, &mesh);
        if (status == ST_COLD) {
            status = st_load(store, id, &mesh);
            atomic_fetch_add(&loaded, status == ST_OK ? 1 : 0);
        }
        expect(status == ST_OK || status == ST_ABSENT);
        if (status != ST_OK) {
            make(id);
            continue;
        }
        expect(st_damage(mesh)[0] == '\0');
        if (what == 2) {
            remove_one(mesh);
        } else if (what < 12) {
            edit(mesh);
        } else {
            look(mesh);
        }
        st_release(mesh);
    }
    return NULL;
}

static void threads_find_evict_make_and_remove(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    md_random random = {seed_of_run()}, of_thread[THREADS];
    st_memory_install(BUDGET);
    journal = kept_journal_new();
    st_pool *pool = st_pool_new("bases", 3, 100);
    store = open_store(pool);
    for (int i = 0; i < THREADS; i++) {
        of_thread[i] = (md_random){md_bits(&random)};
        assert_int_equal(pthread_create(&threads[i], NULL, run, &of_thread[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
    }
    st_pool_free(pool);
    assert_false(atomic_load(&broken));
    assert_int_equal(st_store_count(store), atomic_load(&made) - atomic_load(&removed));
    printf("note: %u made, %u removed, %u edits, %u looks, %u times from the disk\n",
           atomic_load(&made), atomic_load(&removed), atomic_load(&edited), atomic_load(&seen),
           atomic_load(&loaded));
    assert_true(atomic_load(&loaded) > 50);
    store->pool = NULL;
    st_store *other = open_store(NULL);
    for (int i = 0; i < MESHES; i++) {
        st_mesh *was = NULL, *is = NULL;
        st_status status = st_load(store, ids[i], &was);
        assert_int_equal(st_load(other, ids[i], &is), status);
        if (status == ST_OK) {
            st_mesh_info a, b;
            assert_true(he_mesh_equal(st_read_begin(was, &a), st_read_begin(is, &b)));
            assert_true(a.record == b.record && a.undo == b.undo && a.redo == b.redo);
            st_read_end(was);
            st_read_end(is);
            st_release(was);
            st_release(is);
        }
    }
    st_store_free(other);
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

/* --- threads that need a mesh share one load --- */

enum { ASKERS = 6 };

static void *ask(void *context)
{
    st_mesh *mesh = NULL;
    (void)context;
    expect(st_load(store, "m", &mesh) == ST_OK);
    st_release(mesh);
    return NULL;
}

static void a_mesh_is_loaded_once_for_all_who_ask(void **state)
{
    (void)state;
    pthread_t threads[ASKERS];
    journal = kept_journal_new();
    store = open_store(NULL);
    make("m");
    st_store_free(store);
    store = open_store(NULL);
    kept_journal_stop(journal);
    for (int i = 0; i < ASKERS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, ask, NULL), 0);
    }
    kept_journal_await(journal, 1);
    kept_journal_go(journal);
    for (int i = 0; i < ASKERS; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_false(atomic_load(&broken));
    assert_int_equal(kept_journal_facts(journal, "m").opened, 1);
    st_store_free(store);
    kept_journal_free(journal);
}

static void what_is_used_stays_in_memory(void **state)
{
    (void)state;
    st_mesh *mesh = NULL, *found = NULL;
    st_memory_install(BUDGET);
    journal = kept_journal_new();
    store = open_store(NULL);
    make("a");
    make("b");
    assert_int_equal(st_find(store, "a", &mesh), ST_OK);
    evict();
    assert_int_equal(st_find(store, "a", &found), ST_OK);
    assert_ptr_equal(found, mesh);
    st_release(found);
    assert_int_equal(st_find(store, "b", &found), ST_COLD);
    assert_int_equal(st_store_count(store), 2);
    st_release(mesh);
    evict();
    assert_int_equal(st_find(store, "a", &found), ST_COLD);
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

/* The meshes that were not used for the longest time must leave memory first. No more meshes than
 * necessary may leave memory. */
static void the_least_recently_used_go_first(void **state)
{
    (void)state;
    enum { MANY = MESHES };
    st_memory_install(BUDGET);
    journal = kept_journal_new();
    store = open_store(NULL);
    for (int i = 0; i < MANY; i++) {
        make(ids[i]);
    }
    for (int i = 0; i < MANY; i++) {
        atomic_store(&store->meshes[i]->used, (uint64_t)1000 * (uint64_t)(MANY - i));
    }
    /* The store must free an eighth of the memory budget, which is about the memory of one mesh. */
    st_memory_set_budget(st_memory_used());
    st_make_room(store, 0);
    st_memory_set_budget(BUDGET);
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(store, ids[MANY - 1], &mesh), ST_COLD);
    for (int i = 0; i < MANY - 1; i++) {
        assert_int_equal(st_find(store, ids[i], &mesh), ST_OK);
        st_release(mesh);
    }
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

static void for_what_never_fits_nothing_goes(void **state)
{
    (void)state;
    st_mesh *mesh = NULL;
    st_memory_install(BUDGET);
    journal = kept_journal_new();
    store = open_store(NULL);
    make("a");
    st_make_room(store, BUDGET - BUDGET / 16 + 1);
    st_make_room(store, UINT64_MAX);
    assert_int_equal(st_find(store, "a", &mesh), ST_OK);
    st_release(mesh);
    evict();
    assert_int_equal(st_find(store, "a", &mesh), ST_COLD);
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

/* --- memory that a request needs and that meshes must leave for it --- */

enum { LARGE = 1 << 20, SIDE = 128 };

/* Makes a store whose meshes use almost all of the memory budget. */
static void open_full(void)
{
    st_memory_install(BUDGET);
    journal = kept_journal_new();
    store = open_store(NULL);
    for (int i = 0; i < MESHES; i++) {
        he_mesh *content = dense_grid(SIDE, NULL, 1);
        st_mesh *mesh = NULL;
        assert_int_equal(st_create(store, ids[i], "", content, NULL, &mesh), ST_OK);
        st_release(mesh);
    }
    st_memory_set_budget(st_memory_used() + LARGE / 4);
}

static void close_full(void)
{
    st_memory_set_budget(BUDGET);
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

static size_t in_memory(void)
{
    st_mesh *meshes[MESHES];
    const size_t count = st_list(store, "", meshes, MESHES);
    for (size_t i = 0; i < count; i++) {
        st_release(meshes[i]);
    }
    return count;
}

static void a_request_gets_what_cold_meshes_hold(void **state)
{
    (void)state;
    open_full();
    assert_null(he_mem_alloc(LARGE));
    assert_int_equal(in_memory(), MESHES);
    st_store_serve(store);
    void *memory = he_mem_alloc(LARGE);
    assert_non_null(memory);
    const size_t left = in_memory();
    assert_true(left < MESHES);
    /* If a request needs more memory than the whole budget, no mesh may be removed from memory for
     * this request. */
    assert_null(he_mem_alloc(st_memory_budget()));
    assert_int_equal(in_memory(), left);
    st_store_serve(NULL);
    he_mem_free(memory);
    close_full();
}

/* While a thread holds the lock of the store, no mesh can leave memory: an allocation that does not
 * fit into the budget must fail at once, without waiting. */
static void a_request_under_locks_is_not_stopped(void **state)
{
    (void)state;
    st_mesh *mesh = NULL;
    open_full();
    assert_int_equal(st_find(store, "a", &mesh), ST_OK);
    st_store_serve(store);
    pthread_rwlock_wrlock(&store->lock);
    assert_null(he_mem_alloc(LARGE));
    pthread_rwlock_unlock(&store->lock);
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    const size_t before = in_memory();
    void *first = he_mem_alloc(LARGE), *second = he_mem_alloc(LARGE);
    assert_true(first != NULL && second != NULL && in_memory() < before);
    /* A mesh with a write in progress must stay in memory. */
    st_mesh *found = NULL;
    assert_int_equal(st_find(store, "a", &found), ST_OK);
    st_release(found);
    st_write_abort(&w);
    st_store_serve(NULL);
    he_mem_free(first);
    he_mem_free(second);
    st_release(mesh);
    close_full();
}

/* --- meshes that cannot leave memory until their changes are on the disk --- */

static slow_journal slow;
static bool disk_moves; /* whether changes become durable on the disk while a thread waits */
static unsigned waits;

bool __real_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);

/* Replaces the store's wait for the disk. The function returns at once: either all changes have
 * become durable on the disk, or the wait has timed out. */
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until)
{
    if (!slow.is_heard) {
        return __real_st_clock_wait(condition, lock, until);
    }
    waits++;
    if (disk_moves) {
        pthread_mutex_unlock(lock);
        slow_journal_advance(&slow, slow_journal_newest(&slow));
        pthread_mutex_lock(lock);
    }
    return disk_moves;
}

/* Makes a store with one mesh, which uses almost all of the memory budget. The mesh cannot leave
 * memory, because its changes are not on the disk yet. */
static void open_full_and_slow(void)
{
    st_mesh *mesh = NULL;
    st_memory_install(BUDGET);
    store = st_store_new(&(st_store_options){
        .undo_budget = 2000, .max_meshes = 10, .journal = slow_journal_open_keeping(&slow)});
    he_mesh *content = dense_grid(SIDE, NULL, 1);
    assert_int_equal(st_create(store, "a", "", content, NULL, &mesh), ST_OK);
    st_release(mesh);
    st_memory_set_budget(st_memory_used() + LARGE / 64);
    waits = 0;
}

static void close_slow(void)
{
    disk_moves = true;
    slow_journal_advance(&slow, slow_journal_newest(&slow));
    st_store_serve(NULL);
    st_memory_set_budget(BUDGET);
    st_store_free(store);
    he_mem_set_hook(NULL);
}

static st_status make_small(void)
{
    st_mesh *mesh = NULL;
    he_mesh *content = fixture_mesh("012,023,031");
    const st_status status = st_create(store, "b", "", content, NULL, &mesh);
    if (status == ST_OK) {
        st_release(mesh);
    } else {
        he_mesh_free(content);
    }
    return status;
}

static void a_creation_waits_for_the_disk_before_it_is_refused(void **state)
{
    (void)state;
    open_full_and_slow();
    disk_moves = false;
    assert_int_equal(make_small(), ST_BUDGET);
    assert_int_equal(waits, 1);
    disk_moves = true;
    assert_int_equal(make_small(), ST_OK);
    assert_int_equal(waits, 2);
    assert_int_equal(in_memory(), 1);
    close_slow();
}

static void memory_is_full_when_no_mesh_can_leave_it(void **state)
{
    (void)state;
    open_full_and_slow();
    disk_moves = false;
    assert_true(st_memory_is_short());
    assert_true(st_store_is_full(store));
    assert_int_equal(in_memory(), 1);
    disk_moves = true;
    assert_false(st_store_is_full(store));
    assert_int_equal(in_memory(), 0);
    close_slow();
}

static void a_request_waits_for_the_disk_before_it_is_refused(void **state)
{
    (void)state;
    open_full_and_slow();
    st_store_serve(store);
    disk_moves = true;
    void *memory = he_mem_alloc(LARGE / 2);
    assert_non_null(memory);
    assert_int_equal(waits, 1);
    assert_int_equal(in_memory(), 0);
    /* All changes are on the disk, so a wait for the disk could not free more memory and must not
     * take place. */
    assert_null(he_mem_alloc(st_memory_budget() - st_memory_budget() / 8));
    assert_int_equal(waits, 1);
    he_mem_free(memory);
    close_slow();
}

static void what_was_not_used_for_a_minute_leaves(void **state)
{
    (void)state;
    open_full();
    st_store_rest(store);
    assert_int_equal(in_memory(), MESHES);
    atomic_store(&store->meshes[1]->used, 1);
    st_store_rest(store);
    assert_int_equal(in_memory(), MESHES - 1);
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(store, ids[1], &mesh), ST_COLD);
    /* As long as there is enough memory, all meshes must stay in memory. */
    st_memory_set_budget(BUDGET);
    for (size_t i = 0; i < store->count; i++) {
        atomic_store(&store->meshes[i]->used, 1);
    }
    st_store_rest(store);
    assert_int_equal(in_memory(), MESHES - 1);
    close_full();
}

/* Resident memory that is not allocated in counted blocks also uses up the budget, so meshes must
 * leave memory for it. In this test it is a mapping; in a daemon it is the program and the gaps
 * between blocks. */
static void what_is_resident_beside_counted_blocks_has_meshes_leave(void **state)
{
    (void)state;
    enum { SMALL_BUDGET = 64 << 20, COUNTED = 30 << 20, BESIDE = 128 << 20 };
    st_mesh *mesh = NULL;
    st_memory_install(SMALL_BUDGET);
    journal = kept_journal_new();
    store = open_store(NULL);
    make("a");
    void *counted = he_mem_alloc(COUNTED);
    unsigned char *beside =
        mmap(NULL, BESIDE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_non_null(counted);
    assert_ptr_not_equal(beside, MAP_FAILED);
    memset(beside, 1, BESIDE);
    st_make_room(store, 0);
    st_store_rest(store);
    assert_int_equal(st_find(store, "a", &mesh), ST_OK); /* resident memory was not measured yet */
    st_release(mesh);
    st_resident_watch();
    assert_int_equal(st_resident_beside(), SMALL_BUDGET / 2); /* half the budget at most */
    st_make_room(store, 0);
    assert_int_equal(st_find(store, "a", &mesh), ST_COLD);

    assert_int_equal(st_load(store, "a", &mesh), ST_OK);
    st_release(mesh);
    st_store_rest(
        store); /* resident memory exceeds the budget, so even recently used meshes must leave */
    assert_int_equal(st_find(store, "a", &mesh), ST_COLD);
    assert_int_equal(st_load(store, "a", &mesh), ST_OK);
    st_release(mesh);
    st_store_rest(store); /* resident memory did not grow: the mesh must stay in memory */
    assert_int_equal(st_find(store, "a", &mesh), ST_OK);
    st_release(mesh);
    munmap(beside, BESIDE);
    he_mem_free(counted);
    st_store_free(store);
    kept_journal_free(journal);
    he_mem_set_hook(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_find_evict_make_and_remove),
        cmocka_unit_test(a_mesh_is_loaded_once_for_all_who_ask),
        cmocka_unit_test(what_is_used_stays_in_memory),
        cmocka_unit_test(the_least_recently_used_go_first),
        cmocka_unit_test(for_what_never_fits_nothing_goes),
        cmocka_unit_test(a_request_gets_what_cold_meshes_hold),
        cmocka_unit_test(a_request_under_locks_is_not_stopped),
        cmocka_unit_test(a_creation_waits_for_the_disk_before_it_is_refused),
        cmocka_unit_test(memory_is_full_when_no_mesh_can_leave_it),
        cmocka_unit_test(a_request_waits_for_the_disk_before_it_is_refused),
        cmocka_unit_test(what_was_not_used_for_a_minute_leaves),
        cmocka_unit_test(what_is_resident_beside_counted_blocks_has_meshes_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
