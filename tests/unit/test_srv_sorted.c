/* Tests of the sorted lists of meshes (st_cards_by), for a store in memory and for one on the disk:
 * each is compared with a slow oracle, which sorts what is known of the meshes. */
#include "tests/pace.h"
#include "tests/sanitized.h"
#include "tests/seed.h"
#include "tests/store_sql.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "journal/sqlite/sqlite_schema.h"
#include "model/random.h"
#include "store/sorted_cards.h"
#include "system/clock.h"

#include <pthread.h>
#include <stdatomic.h>

enum { SETTLE_MICROS = 60 * 1000 * 1000 };
enum { MESHES = 40, ROUNDS = 600, PAGE = 7 };

static char folder[FOLDER_PATH];
static bool on_disk;
static st_store *store;

static void open_store(void)
{
    st_sqlite_opened out = {.journal = st_journal_memory()};
    if (on_disk &&
        !st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = "test"}, &out)) {
        fail_msg("%s", out.message);
    }
    store = st_store_new(
        &(st_store_options){.undo_budget = 1 << 20, .max_meshes = 1 << 20, .journal = out.journal});
    assert_non_null(store);
}

static void close_store(void)
{
    st_store_free(store);
    store = NULL;
}

static int setup(void **state)
{
    folder_make(folder);
    on_disk = *(const bool *)*state;
    open_store();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    close_store();
    folder_remove(folder);
    return 0;
}

/* Waits until every change is durable, because a list shows durable changes only. */
static void settle(void)
{
    assert_true(st_waits_block(st_store_waits(store), st_shown_all(store, 0).position,
                               st_clock_micros() + SETTLE_MICROS));
}

/* --- the oracle --- */

static int letter_of(char c)
{
    return c >= 'A' && c <= 'Z' ? c + 32 : (unsigned char)c;
}

/* Returns true if the mesh `a` must be listed before `b`. */
static bool precedes(st_card_order order, const st_card *a, const st_card *b)
{
    size_t i = 0;
    if (order == ST_BY_NAME) {
        while (a->name[i] != '\0' && letter_of(a->name[i]) == letter_of(b->name[i])) {
            i++;
        }
        const int x = letter_of(a->name[i]), y = letter_of(b->name[i]);
        return x < y || (x == y && strcmp(a->id, b->id) < 0);
    }
    if (order == ST_BY_MODIFIED && a->modified != b->modified) {
        return a->modified > b->modified;
    }
    if (order == ST_BY_BYTES && a->bytes != b->bytes) {
        return a->bytes > b->bytes;
    }
    return strcmp(a->id, b->id) > 0;
}

static st_card known[MESHES]; /* what was last done to each mesh; an id of "" means: no such mesh */

/* Sorts those of the known meshes that come after `after`, which may be NULL. */
static size_t sort_known(st_card_order order, const st_card *after, const st_card *out[MESHES])
{
    size_t count = 0;
    for (size_t i = 0; i < MESHES; i++) {
        const st_card *card = &known[i];
        if (card->id[0] == '\0' || (after != NULL && !precedes(order, after, card))) {
            continue;
        }
        size_t at = count++;
        for (; at > 0 && precedes(order, card, out[at - 1]); at--) {
            out[at] = out[at - 1];
        }
        out[at] = card;
    }
    return count;
}

static void expect_card(const st_card *is, const st_card *wanted)
{
    assert_string_equal(is->id, wanted->id);
    assert_string_equal(is->name, wanted->name);
    assert_string_equal(is->damage, "");
    assert_true(is->modified == wanted->modified);
    assert_int_equal(is->bytes, wanted->bytes);
    assert_int_equal(is->revision, wanted->revision);
    assert_int_equal(is->metadata, wanted->metadata);
    assert_int_equal(is->incarnation, wanted->incarnation);
    assert_memory_equal(&is->counts, &wanted->counts, sizeof wanted->counts);
}

/* Reads the list in pages of `limit` meshes, and compares it with the oracle. */
static void expect_list(st_card_order order, const st_card *from, size_t limit)
{
    const st_card *wanted[MESHES];
    st_card cards[MESHES + 1], after;
    const size_t all = sort_known(order, from, wanted);
    size_t given = 0, count;
    st_card_page page = {order, from, limit};
    do {
        assert_int_equal(st_cards_by(store, &page, cards, &count), ST_OK);
        assert_true(count <= limit && given + count <= all);
        for (size_t i = 0; i < count; i++) {
            expect_card(&cards[i], wanted[given++]);
        }
        if (count > 0) {
            /* only these members of the last card matter */
            after =
                (st_card){.modified = cards[count - 1].modified, .bytes = cards[count - 1].bytes};
            memcpy(after.id, cards[count - 1].id, sizeof after.id);
            memcpy(after.name, cards[count - 1].name, sizeof after.name);
            page.after = &after;
        }
    } while (count == limit);
    assert_int_equal(given, all);
}

/* Lists begin after the place of any card, even if no mesh has it. */
static st_card any_place(md_random *r)
{
    st_card place = known[md_below(r, MESHES)];
    (void)snprintf(place.id, sizeof place.id, "m%02u", (unsigned)md_below(r, MESHES));
    if (md_below(r, 2) == 0) {
        place.bytes += md_below(r, 3) - 1;
        place.modified += 1e-6;
        place.name[0] = (char)('a' + md_below(r, 3));
    }
    return place;
}

static void expect_lists(md_random *r)
{
    settle();
    for (int order = 0; order < ST_CARD_ORDERS; order++) {
        const st_card place = any_place(r);
        expect_list((st_card_order)order, NULL, 1 + md_below(r, PAGE));
        expect_list((st_card_order)order, &place, 1 + md_below(r, PAGE));
    }
}

/* --- random changes --- */

/* Chooses a name of few letters, so that many names are equal but for their case. */
static const char *any_name(md_random *r, char out[ST_MESH_NAME + 1])
{
    static const char *const parts[] = {"a", "A", "b", "B", "[", "_", "z", "Z", "\xc3\xa9", " "};
    const size_t count = md_below(r, 4);
    out[0] = '\0';
    for (size_t i = 0, used = 0; i < count; i++) {
        const char *part = parts[md_below(r, sizeof parts / sizeof *parts)];
        used += (size_t)snprintf(out + used, ST_MESH_NAME + 1 - used, "%s", part);
    }
    return out;
}

static he_mesh *any_content(md_random *r)
{
    static const char *const faces[] = {"012", "012,023", "012,023,034", "012,023,034,045"};
    return fixture_mesh(faces[md_below(r, 4)]);
}

/* Notes what a mesh is after a change. */
static void know(size_t i, st_mesh *mesh)
{
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    known[i] = (st_card){.incarnation = info.incarnation,
                         .revision = info.revision,
                         .metadata = info.metadata,
                         .modified = info.modified,
                         .bytes = he_mesh_bytes(content),
                         .counts = {he_mesh_vertices(content), he_mesh_edges(content),
                                    he_mesh_faces(content), he_mesh_boundary_halfedges(content)}};
    memcpy(known[i].id, info.id, sizeof info.id);
    memcpy(known[i].name, info.name, sizeof info.name);
    if (info.removed) {
        known[i].id[0] = '\0';
    }
    st_read_end(mesh);
}

static void rename_mesh(st_mesh *mesh, const char *name)
{
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_rename(&w, name);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
}

static void move(st_mesh *mesh, double x)
{
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    const he_vec3 point = {x, 0, 0};
    const uint32_t vertex = 0;
    assert_non_null(content);
    assert_int_equal(he_vertex_move(content, &vertex, 1, HE_MOVE_TO, &point, 1, NULL), HE_OK);
    assert_true(writing_commit(&w, "vertex_move", NULL));
}

static void change(md_random *r)
{
    char id[16], name[ST_MESH_NAME + 1];
    const size_t i = md_below(r, MESHES);
    st_mesh *mesh = NULL;
    (void)snprintf(id, sizeof id, "m%02zu", i);
    if (known[i].id[0] == '\0') {
        assert_int_equal(st_create(store, id, any_name(r, name), any_content(r), NULL, &mesh),
                         ST_OK);
    } else {
        assert_int_equal(st_load(store, id, &mesh), ST_OK);
        switch (md_below(r, 7)) {
        case 0:
            assert_int_equal(writing_remove(mesh), ST_OK);
            break;
        case 1:
        case 2:
            rename_mesh(mesh, any_name(r, name));
            break;
        case 3:
            assert_int_equal(writing_replace(mesh, any_content(r), NULL, NULL), ST_OK);
            break;
        case 4:
            assert_int_equal(writing_replace(mesh, any_content(r), any_name(r, name), NULL), ST_OK);
            break;
        case 5:
            (void)writing_step(mesh, md_below(r, 2) == 0 ? ST_UNDO : ST_REDO, 1);
            break;
        default:
            move(mesh, (double)md_below(r, 100));
            break;
        }
    }
    know(i, mesh);
    st_release(mesh);
}

static void lists_are_as_the_oracle_sorts_them(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    memset(known, 0, sizeof known);
    for (size_t round = 0; round < ROUNDS; round++) {
        change(&r);
        if (md_below(&r, 8) == 0) {
            expect_lists(&r);
        }
        if (on_disk && md_below(&r, 100) == 0) {
            st_store_free(store);
            open_store();
            expect_lists(&r);
        }
    }
    expect_lists(&r);
}

/* --- threads --- */

enum { STABLE = 30, NOISY = 8, WRITERS = 2, READERS = 2, PASSES = 60 };

static _Atomic bool reading;
static _Atomic int broken; /* line of the source at which a check failed; 0: no check failed */

static void expect_at(bool good, int line)
{
    if (!good) {
        atomic_store(&broken, line);
    }
}
#define expect(good) expect_at(good, __LINE__)

/* Changes, removes and creates the meshes with the numbers `first`, `first` + WRITERS, ... */
static void *write_noise(void *number)
{
    const size_t first = *(const size_t *)number;
    md_random r = {1 + first};
    char id[16], name[ST_MESH_NAME + 1];
    while (atomic_load(&reading)) {
        const size_t i = first + WRITERS * md_below(&r, NOISY / WRITERS);
        st_mesh *mesh = NULL;
        st_write w;
        (void)snprintf(id, sizeof id, "n%zu", i);
        if (st_load(store, id, &mesh) != ST_OK) {
            he_mesh *content = any_content(&r);
            expect(st_create(store, id, any_name(&r, name), content, NULL, &mesh) == ST_OK);
        } else if (st_write_begin(mesh, NULL, &w) == ST_OK) {
            if (md_below(&r, 4) == 0) {
                st_write_remove(&w);
            } else {
                st_write_rename(&w, any_name(&r, name));
            }
            expect(st_write_commit(&w, NULL) == ST_OK);
        }
        st_release(mesh);
    }
    return NULL;
}

/* Counts how often each mesh is in a page, and adds the numbers of those that do not change. */
static void count_page(const st_card_page *page, const st_card *cards, size_t count,
                       unsigned seen[STABLE])
{
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < i; k++) {
            expect(strcmp(cards[i].id, cards[k].id) != 0);
        }
        if (i > 0) {
            expect(precedes(page->order, &cards[i - 1], &cards[i]));
        } else if (page->after != NULL) {
            expect(precedes(page->order, page->after, &cards[i]));
        }
        if (cards[i].id[0] == 's') {
            seen[strtoul(cards[i].id + 1, NULL, 10)]++;
        }
    }
}

static void *read_lists(void *number)
{
    (void)number;
    for (size_t pass = 0; pass < PASSES; pass++) {
        unsigned seen[STABLE] = {0};
        st_card cards[PAGE], last;
        st_card_page page = {(st_card_order)(pass % ST_CARD_ORDERS), NULL, PAGE};
        size_t count;
        do {
            expect(st_cards_by(store, &page, cards, &count) == ST_OK);
            count_page(&page, cards, count, seen);
            if (count > 0) {
                last = cards[count - 1];
                page.after = &last;
            }
        } while (count == PAGE && atomic_load(&broken) == 0);
        for (size_t i = 0; i < STABLE; i++) {
            expect(seen[i] == 1);
        }
    }
    return NULL;
}

/* Meshes that do not change are in each list exactly once, whatever other meshes become while the
 * list is read page by page. */
static void a_mesh_that_keeps_its_place_is_listed_once(void **state)
{
    (void)state;
    pthread_t writers[WRITERS], readers[READERS];
    size_t numbers[WRITERS];
    md_random r = {seed_of_run()};
    char id[16], name[ST_MESH_NAME + 1];
    for (size_t i = 0; i < STABLE; i++) {
        st_mesh *mesh;
        (void)snprintf(id, sizeof id, "s%02zu", i);
        assert_int_equal(st_create(store, id, any_name(&r, name), any_content(&r), NULL, &mesh),
                         ST_OK);
        st_release(mesh);
    }
    settle();
    atomic_store(&reading, true);
    atomic_store(&broken, 0);
    for (size_t i = 0; i < WRITERS; i++) {
        numbers[i] = i;
        assert_int_equal(pthread_create(&writers[i], NULL, write_noise, &numbers[i]), 0);
    }
    for (size_t i = 0; i < READERS; i++) {
        assert_int_equal(pthread_create(&readers[i], NULL, read_lists, NULL), 0);
    }
    for (size_t i = 0; i < READERS; i++) {
        pthread_join(readers[i], NULL);
    }
    atomic_store(&reading, false);
    for (size_t i = 0; i < WRITERS; i++) {
        pthread_join(writers[i], NULL);
    }
    assert_int_equal(atomic_load(&broken), 0);
}

/* --- large stores --- */

enum { LARGE = SANITIZED ? 20000 : 100000, LARGE_PAGE = 100 };

/* Reads a whole list in pages, and requires that it has `size` meshes in order. */
static double page_through(st_card_order order, size_t size)
{
    st_card cards[LARGE_PAGE], last;
    st_card_page page = {order, NULL, LARGE_PAGE};
    size_t count, given = 0;
    const double begun = pace_seconds();
    do {
        assert_int_equal(st_cards_by(store, &page, cards, &count), ST_OK);
        for (size_t i = 0; i < count; i++) {
            assert_true(page.after == NULL || precedes(order, page.after, &cards[i]));
            last = cards[i];
            page.after = &last;
        }
        given += count;
    } while (count == LARGE_PAGE);
    assert_int_equal(given, size);
    return pace_seconds() - begun;
}

/* Makes a closed store of `meshes` meshes by SQL, because creating them takes long. Their rows have
 * wrong checksums, which the lists report as damage. */
static void make_rows(size_t meshes)
{
    static uint64_t commits = 0;
    char text[1024];
    commits += 1000; /* more than the store has counted so far */
    const st_progress progress = {.commits = commits, .position = commits, .meshes = meshes};
    (void)snprintf(
        text, sizeof text,
        "BEGIN; DELETE FROM mesh; "
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < %zu) "
        "INSERT INTO mesh(id, name, incarnation, origin, metadata, revision, record, chain, "
        "created, modified, vertices, edges, faces, boundary, bytes, base, damage, sum) "
        "SELECT 'mesh-' || (i * 7919 %% 1000003), 'part ' || i %% 11, "
        "i * 7919 %% 1000003, 1, 1, 1, 1, 1, 1, i * 17 %% 1009, 1, 1, 1, 1, 1000 + i %% 7, 1, '', "
        "1 "
        "FROM n; UPDATE state SET commits = %lu, position = %lu, meshes = %zu, sum = %lu; COMMIT",
        meshes, (unsigned long)commits, (unsigned long)commits, meshes,
        (unsigned long)st_progress_sum(&progress));
    store_sql_run(folder, text);
}

static double page_on_disk(const void *context, size_t size)
{
    double all = 0;
    (void)context;
    close_store();
    make_rows(size);
    open_store();
    for (int order = 0; order < ST_CARD_ORDERS; order++) {
        const double spent = page_through((st_card_order)order, size);
        printf("note: a page of %d of %zu meshes on the disk took %.2f ms in order %d\n",
               LARGE_PAGE, size, spent * 1000 * LARGE_PAGE / (double)size, order);
        all += spent;
    }
    return all;
}

/* Reads a list of `size` cards in memory, without the meshes, which would take much memory. */
static double page_in_memory(const void *context, size_t size)
{
    st_sorted sorted;
    st_card cards[LARGE_PAGE], last;
    st_sorted_entry **entries = calloc(size, sizeof(st_sorted_entry *));
    (void)context;
    assert_non_null(entries);
    st_sorted_init(&sorted);
    const double begun = pace_seconds();
    for (size_t i = 0; i < size; i++) {
        st_card card = {.bytes = 1000 + i % 7, .modified = (double)(i * 17 % 1009)};
        (void)snprintf(card.id, sizeof card.id, "mesh-%zu", i * 7919 % 1000003);
        (void)snprintf(card.name, sizeof card.name, "part %zu", i % 11);
        entries[i] = st_sorted_entry_new();
        assert_non_null(entries[i]);
        st_sorted_put(&sorted, entries[i], &card);
    }
    const double made = pace_seconds();
    for (int order = 0; order < ST_CARD_ORDERS; order++) {
        st_card_page page = {(st_card_order)order, NULL, LARGE_PAGE};
        size_t count, given = 0;
        do {
            count = st_sorted_list(&sorted, &page, cards);
            given += count;
            last = cards[count == 0 ? 0 : count - 1];
            page.after = &last;
        } while (count == LARGE_PAGE);
        assert_int_equal(given, size);
    }
    const double all = pace_seconds() - begun;
    printf("note: of %zu meshes in memory, sorting one took %.2f us, a page of %d %.3f ms\n", size,
           (made - begun) * 1e6 / (double)size, LARGE_PAGE,
           (all - made + begun) * 1000 * LARGE_PAGE / (double)size / ST_CARD_ORDERS);
    for (size_t i = 0; i < size; i++) {
        st_sorted_remove(&sorted, entries[i]);
        st_sorted_entry_free(entries[i]);
    }
    assert_int_equal(st_sorted_list(&sorted, &(st_card_page){ST_BY_NAME, NULL, 1}, cards), 0);
    st_sorted_clear(&sorted);
    free(entries);
    return all;
}

/* If a page took time in proportion to the number of meshes, a whole list would take ten times ten
 * times as long for ten times as many meshes. */
static void a_page_of_a_large_store_takes_no_longer(void **state)
{
    (void)state;
    pace_require_linear("reading a sorted list", on_disk ? page_on_disk : page_in_memory, NULL,
                        LARGE);
}

/* --- older databases --- */

/* A database of version 3 has no indexes for sorted lists: the start with this release makes
 * them. */
static void an_older_database_gets_the_indexes(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    memset(known, 0, sizeof known);
    for (size_t round = 0; round < 3 * MESHES; round++) {
        change(&r);
    }
    close_store();
    store_sql_run(folder, "DROP INDEX mesh_by_name; DROP INDEX mesh_by_modified; "
                          "DROP INDEX mesh_by_bytes; PRAGMA user_version = 3");
    open_store();
    expect_lists(&r);
    change(&r);
    expect_lists(&r);
    assert_int_equal(store_sql_number(folder, "PRAGMA user_version"), ST_SCHEMA_VERSION);
}

int main(void)
{
    static bool memory = false, disk = true;
    const struct CMUnitTest tests[] = {
#define STORE_TEST(test, where) {#test " (" #where ")", test, setup, teardown, &(where)}
        STORE_TEST(lists_are_as_the_oracle_sorts_them, memory),
        STORE_TEST(lists_are_as_the_oracle_sorts_them, disk),
        STORE_TEST(a_mesh_that_keeps_its_place_is_listed_once, memory),
        STORE_TEST(a_mesh_that_keeps_its_place_is_listed_once, disk),
        STORE_TEST(a_page_of_a_large_store_takes_no_longer, memory),
        STORE_TEST(a_page_of_a_large_store_takes_no_longer, disk),
        STORE_TEST(an_older_database_gets_the_indexes, disk),
#undef STORE_TEST
    };
    return cmocka_run_group_tests_name("sorted", tests, NULL, NULL);
}
