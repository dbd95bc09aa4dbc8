/* Tests of a store on a disk while memory or disk space runs out: a request must learn that its
 * change was lost, however late this is known, and no thread may be blocked for ever. In
 * test_srv_starved.c single allocations fail. */
#include "tests/disk.h"
#include "tests/store_folder.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "system/memory.h"

#include <sched.h>
#include <stdatomic.h>

static char folder[FOLDER_PATH];
static st_store *store;

static void open_store(void)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test"};
    assert_true(st_sqlite_open(&options, &out));
    store = st_store_new(
        &(st_store_options){.undo_budget = 1 << 20, .max_meshes = 100, .journal = out.journal});
    assert_non_null(store);
}

static void close_store(void)
{
    st_store_free(store);
    store = NULL;
}

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    disk_fill(false);
    he_mem_set_hook(NULL);
    folder_remove(folder);
    return 0;
}

static void make(const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_create(store, id, "", fixture_mesh("012,023"), NULL, &mesh), ST_OK);
    st_release(mesh);
}

static st_mesh *load(const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_load(store, id, &mesh), ST_OK);
    return mesh;
}

/* Makes an edit that moves vertex 0 to x = revision, so that the position shows which revision the
 * mesh has. */
static st_status edit(st_mesh *mesh, st_mesh_info *info)
{
    const uint32_t vertex = 0;
    st_write w;
    st_status status = st_write_begin(mesh, NULL, &w);
    if (status != ST_OK) {
        return status;
    }
    const he_vec3 to = {(double)(w.info.revision + 1), 0, 0};
    if (he_vertex_move(w.content, &vertex, 1, HE_MOVE_TO, &to, 1, NULL) != HE_OK ||
        st_write_changes(&w, NULL) != HE_OK) {
        st_write_abort(&w);
        return ST_NO_MEMORY;
    }
    status = st_write_commit(&w, "vertex_move");
    if (status == ST_OK) {
        *info = w.info;
    }
    return status;
}

static uint64_t revision_of(st_mesh *mesh)
{
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    const double x = he_position(content, (he_vertex){0}).x;
    assert_true(info.revision == 1 || x == (double)info.revision);
    st_read_end(mesh);
    return info.revision;
}

static st_status disk_status(void)
{
    st_health health;
    st_store_health(store, &health);
    return health.status;
}

/* --- a full disk --- */

static void resume(st_wait *wait)
{
    (void)wait;
    fail_msg("it was over when it was added");
}

/* A request handler pauses right after its commit. Meanwhile the disk becomes full, so that the
 * commit is lost, and then the disk accepts other writes. Only now the handler asks whether its
 * answer may be sent: it must learn that its commit was lost. */
static void a_handler_that_slept_through_a_full_disk_is_told_of_its_loss(void **state)
{
    (void)state;
    st_mesh_info slept, info;
    open_store();
    make("m");
    st_mesh *mesh = load("m");
    st_waits *waits = st_store_waits(store);
    while (st_waits_durable(waits) < 1) {
        sched_yield();
    }
    disk_fill(true);
    assert_int_equal(edit(mesh, &slept), ST_OK);
    assert_int_equal(slept.revision, 2);
    for (bool lost = false; !lost; sched_yield()) {
        (void)st_read_begin(mesh, &info);
        lost = info.lost;
        st_read_end(mesh);
    }
    assert_int_equal(disk_status(), ST_FULL);
    disk_fill(false);
    while (disk_status() == ST_FULL) {
        sched_yield();
    }
    /* Another request makes a new revision, which gets the number of the lost revision. */
    st_mesh *again = load("m");
    assert_int_equal(revision_of(again), 1);
    assert_int_equal(edit(again, &info), ST_OK);
    assert_int_equal(info.revision, 2);
    while (st_waits_durable(waits) < info.position) {
        sched_yield();
    }
    st_wait wait = {.shown = st_shown_of(&slept), .resume = resume};
    assert_false(st_waits_add(waits, &wait));
    assert_int_equal(wait.end, ST_WAIT_LOST);
    assert_int_equal(wait.status, ST_FULL);
    wait = (st_wait){.shown = st_shown_of(&info), .resume = resume};
    assert_false(st_waits_add(waits, &wait));
    assert_int_equal(wait.end, ST_WAIT_DURABLE);
    st_release(mesh);
    st_release(again);
    close_store();
    open_store();
    mesh = load("m");
    assert_int_equal(revision_of(mesh), 2);
    st_release(mesh);
    close_store();
}

/* --- the memory budget --- */

enum { WRITERS = 4, LARGE = 1 << 20, SMALL = 1 << 10 };
static const uint64_t BUDGET = (uint64_t)32 << 20;

typedef struct writer {
    char id[2];
    _Atomic uint64_t committed, refused;
    bool strange;
    pthread_t thread;
} writer;

static _Atomic bool ending;

static void *write_on(void *context)
{
    writer *w = context;
    st_mesh *mesh = load(w->id);
    while (!atomic_load(&ending)) {
        st_mesh_info info;
        st_status status = edit(mesh, &info);
        if (status == ST_OK) {
            atomic_store(&w->committed, info.revision);
        } else {
            w->strange |= status != ST_NO_MEMORY && status != ST_BEHIND;
            atomic_fetch_add(&w->refused, status == ST_NO_MEMORY);
        }
        sched_yield();
    }
    st_release(mesh);
    return NULL;
}

static void await_all(writer writers[WRITERS])
{
    for (int i = 0; i < WRITERS; i++) {
        const uint64_t before = atomic_load(&writers[i].committed);
        while (atomic_load(&writers[i].committed) < before + 5) {
            sched_yield();
        }
    }
}

/* A block of memory that the test allocates only to use up the memory budget. */
typedef struct block {
    struct block *next;
} block;

/* Allocates all memory that the budget has left, and adds the blocks to the list. The function
 * tries repeatedly, because other threads may free memory meanwhile. */
static void take_all(block **list)
{
    for (size_t size = LARGE; size >= SMALL / 16; size /= 4) {
        for (block *b; (b = he_mem_alloc(size)) != NULL; *list = b) {
            b->next = *list;
        }
    }
}

static void free_all(block **list)
{
    while (*list != NULL) {
        block *next = (*list)->next;
        he_mem_free(*list);
        *list = next;
    }
}

static void a_budget_filled_while_four_writers_write_stops_nobody_for_good(void **state)
{
    (void)state;
    block *taken = NULL;
    writer writers[WRITERS] = {{.id = "a"}, {.id = "b"}, {.id = "c"}, {.id = "d"}};
    st_memory_install(BUDGET);
    atomic_store(&ending, false);
    open_store();
    for (int i = 0; i < WRITERS; i++) {
        make(writers[i].id);
        assert_int_equal(pthread_create(&writers[i].thread, NULL, write_on, &writers[i]), 0);
    }
    for (int round = 0; round < 3; round++) {
        await_all(writers);
        for (int i = 0; i < WRITERS; i++) {
            const uint64_t before = atomic_load(&writers[i].refused);
            while (atomic_load(&writers[i].refused) < before + 5) {
                take_all(&taken);
            }
        }
        free_all(&taken);
    }
    await_all(writers);
    assert_int_equal(disk_status(), ST_OK);
    atomic_store(&ending, true);
    for (int i = 0; i < WRITERS; i++) {
        pthread_join(writers[i].thread, NULL);
        assert_false(writers[i].strange);
    }
    close_store();
    open_store();
    for (int i = 0; i < WRITERS; i++) {
        st_mesh *mesh = load(writers[i].id);
        assert_int_equal(revision_of(mesh), atomic_load(&writers[i].committed));
        st_release(mesh);
    }
    close_store();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        STORE_TEST(a_handler_that_slept_through_a_full_disk_is_told_of_its_loss),
        STORE_TEST(a_budget_filled_while_four_writers_write_stops_nobody_for_good),
#undef STORE_TEST
    };
    disk_install();
    return cmocka_run_group_tests_name("disk", tests, NULL, NULL);
}
