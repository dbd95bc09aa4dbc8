/* Tests of the quotas of access tokens, in a store on a disk. The counts for a token must include
 * all its meshes, whether they are in memory or not; concurrent requests must not exceed the
 * limits; and the counts must be corrected when changes are lost. */
#include "tests/disk.h"
#include "tests/store_folder.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/poke.h"
#include "store/holder/holders.h"
#include "stored/stored.h"
#include "system/memory.h"
#include "tests/failing.h"

#include <pthread.h>
#include <sched.h>

#define QUAD "0123"

static char folder[FOLDER_PATH];
static st_store *store;

static void open_store(void)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test"};
    if (!st_sqlite_open(&options, &out)) {
        fail_msg("%s", out.message);
    }
    store = st_store_new(
        &(st_store_options){.undo_budget = 1 << 20, .max_meshes = 1000, .journal = out.journal});
    assert_non_null(store);
}

static void open_again(void)
{
    st_store_free(store);
    open_store();
}

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    open_store();
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    st_store_free(store);
    folder_remove(folder);
    return 0;
}

/* Makes a store in memory. Such a store has no threads of its own, so the test can change the
 * allocation hook. */
static int keep_in_memory(void **state)
{
    (void)state;
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20, .max_meshes = 1000, .journal = st_journal_memory()});
    return store == NULL;
}

static int forget(void **state)
{
    (void)state;
    st_store_free(store);
    return 0;
}

static st_status create(const char *id, const char *holder)
{
    st_mesh *mesh = NULL;
    he_mesh *content = fixture_mesh(QUAD);
    const st_cause cause = {.holder = holder};
    st_status status = st_create(store, id, "", content, &cause, &mesh);
    if (status != ST_OK) {
        he_mesh_free(content);
    }
    st_release(mesh);
    return status;
}

static st_mesh *load(const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_load(store, id, &mesh), ST_OK);
    return mesh;
}

static void destroy(const char *id)
{
    st_mesh *mesh = load(id);
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_remove(&w);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    st_release(mesh);
}

/* Divides faces of the mesh until the mesh takes more memory. */
static st_status grow(const char *id)
{
    st_mesh *mesh = load(id);
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    const size_t bytes = he_mesh_bytes(w.content);
    for (uint32_t f = 0; he_mesh_bytes(w.content) == bytes; f++) {
        assert_int_equal(he_face_poke(w.content, (he_face){f}, NULL, NULL, NULL, NULL, NULL),
                         HE_OK);
    }
    assert_int_equal(st_write_changes(&w, NULL), HE_OK);
    st_status status = st_write_commit(&w, "face_poke");
    st_release(mesh);
    return status;
}

static void expect(const char *holder, uint64_t meshes)
{
    st_usage usage;
    st_holder_usage(store, holder, &usage);
    if (usage.meshes != meshes || (meshes == 0) != (usage.bytes == 0)) {
        fail_msg("%s has %llu meshes of %llu bytes instead of %llu", holder,
                 (unsigned long long)usage.meshes, (unsigned long long)usage.bytes,
                 (unsigned long long)meshes);
    }
}

static uint64_t bytes_of(const char *holder)
{
    st_usage usage;
    st_holder_usage(store, holder, &usage);
    return usage.bytes;
}

static void limit(const char *holder, uint64_t meshes, uint64_t bytes)
{
    const st_holder_limit one = {holder, meshes, bytes};
    assert_int_equal(st_limit_holders(store, &one, 1), ST_OK);
}

static void a_holder_s_meshes_are_counted_in_memory_or_not_and_given_back(void **state)
{
    (void)state;
    limit("alice", 2, 0);
    assert_int_equal(create("a", "alice"), ST_OK);
    assert_int_equal(create("b", "alice"), ST_OK);
    assert_int_equal(create("c", "alice"), ST_QUOTA);
    assert_int_equal(create("c", "bob"), ST_OK);
    assert_int_equal(create("d", NULL), ST_OK);
    expect("alice", 2);
    expect("bob", 1);
    expect("nobody", 0);
    const uint64_t bytes = bytes_of("alice");

    open_again();
    limit("alice", 2, 0);
    expect("alice", 2);
    assert_int_equal(bytes_of("alice"), bytes);
    assert_int_equal(create("e", "alice"),
                     ST_QUOTA); /* the meshes of the token "alice" are not in memory */
    st_mesh *mesh = load("a");
    assert_string_equal(st_holder_of(mesh), "alice");
    st_release(mesh);
    expect("alice", 2);
    destroy("a");
    expect("alice", 1);
    assert_int_equal(create("e", "alice"), ST_OK);
    assert_int_equal(create("f", "alice"), ST_QUOTA);
    limit("bob", 1, 0); /* ends the limit of alice */
    assert_int_equal(create("f", "alice"), ST_OK);
    assert_int_equal(create("g", "bob"), ST_QUOTA);

    open_again();
    expect("alice", 3);
    expect("bob", 1);
    destroy("b");
    destroy("e");
    destroy("f");
    expect("alice", 0);
}

static unsigned char *bytes_of_content(const char *id, size_t *size)
{
    st_mesh *mesh = load(id);
    const he_mesh *content = st_read_begin(mesh, NULL);
    unsigned char *bytes = malloc(he_stored_content_bound(content));
    assert_non_null(bytes);
    *size = he_stored_content_write(content, bytes);
    st_read_end(mesh);
    st_release(mesh);
    return bytes;
}

static void what_would_grow_beyond_the_bytes_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    assert_int_equal(create("m", "alice"), ST_OK);
    const uint64_t small = bytes_of("alice");
    assert_int_equal(grow("m"), ST_OK);
    const uint64_t grown = bytes_of("alice");
    assert_true(grown > small);
    limit("alice", 0, grown);
    size_t size, after;
    unsigned char *before = bytes_of_content("m", &size);
    assert_int_equal(grow("m"), ST_QUOTA);
    unsigned char *now = bytes_of_content("m", &after);
    assert_int_equal(size, after);
    assert_memory_equal(before, now, size);
    free(before);
    free(now);
    assert_int_equal(bytes_of("alice"), grown);
    assert_int_equal(create("n", "alice"), ST_QUOTA);

    /* The mesh belongs to the token "alice", which is over its quota. A write that makes the mesh
     * smaller must be accepted with any token; a write that makes the mesh larger must be refused
     * with any token. */
    st_mesh *mesh = load("m");
    st_write w;
    assert_int_equal(st_write_begin(mesh, &(st_cause){.holder = "bob"}, &w), ST_OK);
    st_write_replace(&w, fixture_mesh(QUAD), NULL);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    st_release(mesh);
    assert_true(bytes_of("alice") < grown);
    expect("bob", 0);
    limit("alice", 1, bytes_of("alice"));
    assert_int_equal(grow("m"), ST_QUOTA);
    mesh = load("m");
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    he_soup soup;
    he_mesh *large = NULL;
    fixture_soup(&soup, "012,213,234,435,456,657,678");
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &large, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_true(he_mesh_bytes(large) > bytes_of("alice"));
    st_write_replace(&w, large, NULL);
    assert_int_equal(st_write_commit(&w, NULL), ST_QUOTA);
    st_release(mesh);
    expect("alice", 1);
    destroy("m");
    expect("alice", 0);
}

enum { THREADS = 4, TRIES = 25, MOST = 30 };

static void *create_many(void *context)
{
    const int *first = context;
    for (int i = 0; i < TRIES; i++) {
        char id[20];
        st_mesh *mesh = NULL;
        he_soup soup;
        he_mesh *content = NULL;
        snprintf(id, sizeof id, "t%d-%d", *first, i);
        fixture_soup(&soup, QUAD);
        if (he_build(&soup, HE_BUILD_TAKE, &content, NULL, NULL) != HE_OK ||
            st_create(store, id, "", content, &(st_cause){.holder = "crowd"}, &mesh) != ST_OK) {
            he_mesh_free(content);
        }
        he_soup_clear(&soup);
        st_release(mesh);
    }
    return NULL;
}

static void many_who_make_meshes_at_once_never_make_more_than_they_may(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    int numbers[THREADS];
    limit("crowd", MOST, 0);
    for (int i = 0; i < THREADS; i++) {
        numbers[i] = i;
        assert_int_equal(pthread_create(&threads[i], NULL, create_many, &numbers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    }
    expect("crowd", MOST);
    assert_int_equal(st_store_count(store), MOST);
    const uint64_t bytes = bytes_of("crowd");
    open_again();
    expect("crowd", MOST);
    assert_int_equal(bytes_of("crowd"), bytes);
}

typedef struct grower {
    char id[8];
    int grown, refused;
    bool beyond; /* whether the thread saw the quota exceeded */
    uint64_t most;
} grower;

enum { GROWTHS = 6 };

/* Makes the mesh larger several times; if the quota refuses one of these changes, the function
 * continues with the next. */
static void *grow_often(void *context)
{
    grower *g = context;
    st_mesh *mesh = NULL;
    if (st_load(store, g->id, &mesh) != ST_OK) {
        return NULL;
    }
    for (int i = 0; i < GROWTHS; i++) {
        st_write w;
        st_status status = st_write_begin(mesh, NULL, &w);
        if (status != ST_OK) {
            break;
        }
        const size_t bytes = he_mesh_bytes(w.content);
        he_status poked = HE_OK;
        for (uint32_t f = 0; poked == HE_OK && he_mesh_bytes(w.content) == bytes; f++) {
            poked = he_face_poke(w.content, (he_face){f}, NULL, NULL, NULL, NULL, NULL);
        }
        if (poked != HE_OK || st_write_changes(&w, NULL) != HE_OK) {
            st_write_abort(&w);
            break;
        }
        status = st_write_commit(&w, "face_poke");
        g->grown += status == ST_OK;
        g->refused += status == ST_QUOTA;
        g->beyond = g->beyond || bytes_of("crowd") > g->most;
    }
    st_release(mesh);
    return NULL;
}

static void many_who_grow_meshes_at_once_never_take_more_than_they_may(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    grower growers[THREADS];
    int grown = 0, refused = 0;
    for (int i = 0; i < THREADS; i++) {
        growers[i] = (grower){.grown = 0};
        snprintf(growers[i].id, sizeof growers[i].id, "g%d", i);
        assert_int_equal(create(growers[i].id, "crowd"), ST_OK);
    }
    const uint64_t most = 3 * bytes_of("crowd");
    limit("crowd", 0, most);
    for (int i = 0; i < THREADS; i++) {
        growers[i].most = most;
        assert_int_equal(pthread_create(&threads[i], NULL, grow_often, &growers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(growers[i].grown + growers[i].refused, GROWTHS);
        assert_false(growers[i].beyond);
        grown += growers[i].grown;
        refused += growers[i].refused;
    }
    assert_true(grown > 0 && refused > 0);
    const uint64_t bytes = bytes_of("crowd");
    assert_true(bytes <= most);
    open_again();
    assert_int_equal(bytes_of("crowd"), bytes);
}

static void what_was_lost_counts_no_more(void **state)
{
    (void)state;
    st_mesh_info info;
    assert_int_equal(create("m", "alice"), ST_OK);
    const uint64_t bytes = bytes_of("alice");
    st_mesh *mesh = load("m");
    for (bool durable = false; !durable; sched_yield()) {
        (void)st_read_begin(mesh, &info);
        st_read_end(mesh);
        const st_shown shown = st_shown_of(&info);
        durable = st_waits_is_durable(st_store_waits(store), &shown);
    }
    disk_fill(true);
    assert_int_equal(grow("m"), ST_OK);
    for (info.lost = false; !info.lost; sched_yield()) {
        (void)st_read_begin(mesh, &info);
        st_read_end(mesh);
    }
    st_release(mesh);
    disk_fill(false);
    st_health health = {.status = ST_FULL};
    for (; health.status == ST_FULL; sched_yield()) {
        st_store_health(store, &health);
    }
    expect("alice", 1);
    assert_int_equal(bytes_of("alice"), bytes);
    assert_int_equal(grow("m"), ST_OK);
    assert_true(bytes_of("alice") > bytes);
}

static void limits_are_set_whole_or_not_at_all(void **state)
{
    (void)state;
    const st_holder_limit limits[] = {{"x", 1, 0}, {"y", 1, 0}, {"z", 1, 0}};
    limit("alice", 1, 0);
    failing f = {0};
    while (failing_next(&f)) {
        st_usage usage;
        assert_true(f.n < 10);
        bool is_set = failing_end(&f, st_limit_holders(store, limits, 3) == ST_OK);
        st_holder_usage(store, "alice", &usage);
        assert_int_equal(usage.most_meshes, is_set ? 0 : 1);
        st_holder_usage(store, "z", &usage);
        assert_int_equal(usage.most_meshes, is_set ? 1 : 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            a_holder_s_meshes_are_counted_in_memory_or_not_and_given_back, make_folder,
            remove_folder),
        cmocka_unit_test_setup_teardown(
            what_would_grow_beyond_the_bytes_is_refused_and_changes_nothing, make_folder,
            remove_folder),
        cmocka_unit_test_setup_teardown(many_who_make_meshes_at_once_never_make_more_than_they_may,
                                        make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(many_who_grow_meshes_at_once_never_take_more_than_they_may,
                                        make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_was_lost_counts_no_more, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(limits_are_set_whole_or_not_at_all, keep_in_memory, forget),
    };
    disk_install();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
