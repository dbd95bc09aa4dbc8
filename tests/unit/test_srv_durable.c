/* Threads write, read and listen to a few meshes, which are created and deleted. The journal is
 * slow, and its disk is sometimes full. No answer or event may show a change before the change is
 * durable, nor a change that was lost. A group of records must be written completely or not at all,
 * and no durable change may depend on a lost one. */
#include "tests/seed.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "model/random.h"
#include "store/followers.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum {
    MESHES = 3,
    WRITERS = 3,
    READERS = 2,
    LISTENERS = 2,
    ROUNDS = 3000,
    MOST_STEPS = 4,
    NOTES = WRITERS * ROUNDS * MOST_STEPS
};

static const char *const ids[MESHES] = {"a", "b", "c"};

/* --- a journal that makes records durable late, and loses some --- */

/* What the test's journal remembers about a record. The index of a note in the array `notes` is the
 * position of its record in the journal. */
typedef struct note {
    uint64_t incarnation, number, revision;
    uint64_t group; /* position of the last record in the record's group */
    bool lost;
} note;

static struct {
    pthread_mutex_t lock;
    note notes[NOTES + 1];
    uint64_t newest;
    bool losing;              /* whether the disk is full */
    size_t out;               /* reservations that have not ended */
    uint64_t removed[MESHES]; /* for each mesh id, position of the record that last deleted a mesh
                                 with this id */
    _Atomic uint64_t durable;
    st_journal_listener listener;
} journal = {.lock = PTHREAD_MUTEX_INITIALIZER};

static _Atomic bool writing;
static _Atomic int broken; /* line of the source at which a check failed; 0: no check failed */

static void expect_at(bool good, int line)
{
    if (!good) {
        atomic_store(&broken, line);
    }
}
#define expect(good) expect_at(good, __LINE__)

static _Atomic size_t refused;

static st_status reserve(void *self, const st_room_need *need, st_room **out)
{
    (void)self;
    (void)need;
    pthread_mutex_lock(&journal.lock);
    st_status status = journal.losing ? ST_FULL : ST_OK;
    if (status == ST_OK) {
        *out = he_mem_zero(1, sizeof **out);
        journal.out++;
    }
    pthread_mutex_unlock(&journal.lock);
    atomic_fetch_add(&refused, status == ST_OK ? 0 : 1);
    return status;
}

static void leave(void *self, st_room *room)
{
    (void)self;
    pthread_mutex_lock(&journal.lock);
    journal.out--;
    pthread_mutex_unlock(&journal.lock);
    he_mem_free(room);
}

static uint64_t append(void *self, st_room *room, const st_record *records, size_t count)
{
    (void)self;
    he_mem_free(room);
    pthread_mutex_lock(&journal.lock);
    uint64_t last = journal.newest + count;
    journal.out--;
    for (size_t i = 0; i < count && last <= NOTES; i++) {
        journal.notes[++journal.newest] = (note){.incarnation = records[i].incarnation,
                                                 .number = records[i].number,
                                                 .revision = records[i].revision,
                                                 .group = last,
                                                 .lost = journal.losing};
        if (records[i].kind == ST_RECORD_REMOVE) {
            journal.removed[records[i].id[0] - 'a'] = journal.newest;
        }
    }
    pthread_mutex_unlock(&journal.lock);
    expect(last <= NOTES);
    return last;
}

static void listen_to(void *self, const st_journal_listener *listener)
{
    (void)self;
    if (listener != NULL) {
        journal.listener = *listener;
    }
}

static void close_journal(void *self)
{
    (void)self;
}

static void advance(uint64_t position)
{
    atomic_store(&journal.durable, position);
    journal.listener.moved(journal.listener.context, position);
}

static void lose(uint64_t from, uint64_t to)
{
    static const char reason[] = "the disk is full";
    const st_loss loss = {.from = from, .to = to, .status = ST_FULL, .reason = reason};
    if (from <= to) {
        journal.listener.lost(journal.listener.context, &loss);
    }
}

static _Atomic size_t incidents;

/* Makes the disk full: the journal loses all records that are not durable, and all records for
 * which a writer has already reserved space. Returns the position of the last lost record. */
static uint64_t fill_up(uint64_t at)
{
    pthread_mutex_lock(&journal.lock);
    journal.losing = true;
    for (uint64_t i = at + 1; i <= journal.newest; i++) {
        journal.notes[i].lost = true;
    }
    while (journal.out > 0 || at < journal.newest) {
        uint64_t told = at;
        at = journal.newest;
        pthread_mutex_unlock(&journal.lock);
        lose(told + 1, at);
        sched_yield();
        pthread_mutex_lock(&journal.lock);
    }
    journal.losing = false;
    pthread_mutex_unlock(&journal.lock);
    atomic_fetch_add(&incidents, 1);
    return at;
}

/* Makes records durable some time after they were appended; the records of one group become durable
 * together. */
static void *lag_behind(void *context)
{
    md_random *random = context;
    uint64_t at = 0, full_at = 100;
    while (atomic_load(&writing)) {
        pthread_mutex_lock(&journal.lock);
        uint64_t newest = journal.newest, to = at;
        if (newest > at) {
            to = at + 1 + md_below(random, (uint32_t)(newest - at));
            to = journal.notes[to].group == to ? to : at;
        }
        pthread_mutex_unlock(&journal.lock);
        if (newest > at && newest >= full_at) {
            at = fill_up(at);
            full_at = at + md_from(random, 1, 200);
            advance(at);
        } else if (to > at && md_chance(random, 30)) {
            at = to;
            advance(at);
        } else {
            sched_yield();
        }
    }
    return NULL;
}

/* --- which records must be durable before an answer may be sent --- */

static uint64_t position_of_record(uint64_t incarnation, uint64_t number)
{
    pthread_mutex_lock(&journal.lock);
    uint64_t at = journal.newest;
    while (at > 0 &&
           (journal.notes[at].incarnation != incarnation || journal.notes[at].number != number)) {
        at--;
    }
    pthread_mutex_unlock(&journal.lock);
    expect(at > 0);
    return at;
}

static uint64_t position_of_revision(uint64_t incarnation, uint64_t revision)
{
    pthread_mutex_lock(&journal.lock);
    uint64_t at = journal.newest, found = 0;
    for (; at > 0; at--) {
        const note *n = &journal.notes[at];
        if (n->incarnation == incarnation && n->revision <= revision) {
            found = n->revision == revision ? at : found;
            if (n->revision < revision) {
                break;
            }
        }
    }
    pthread_mutex_unlock(&journal.lock);
    expect(found > 0);
    return found;
}

/* --- answers that wait until they may be sent --- */

typedef struct answer {
    st_wait wait;
    uint64_t
        needs[MESHES]; /* for each mesh, the position of its newest record that the answer shows */
    _Atomic bool over;
} answer;

static bool was_kept(uint64_t position)
{
    pthread_mutex_lock(&journal.lock);
    bool good = position <= atomic_load(&journal.durable) && !journal.notes[position].lost;
    pthread_mutex_unlock(&journal.lock);
    return good;
}

static _Atomic size_t sent, lost;

static void end(answer *a)
{
    bool durable = a->wait.end == ST_WAIT_DURABLE;
    for (size_t i = 0; i < MESHES && durable; i++) {
        expect(was_kept(a->needs[i]));
    }
    expect(a->wait.end != ST_WAIT_STOPPED && !atomic_load(&a->over));
    atomic_store(&a->over, true);
    atomic_fetch_add(durable ? &sent : &lost, 1);
}

static void resume(st_wait *wait)
{
    end((answer *)wait);
}

static void send_when_durable(st_store *store, answer *a, st_shown shown,
                              const uint64_t needs[MESHES])
{
    *a = (answer){.wait = {.shown = shown, .resume = resume}};
    for (size_t i = 0; i < MESHES; i++) {
        a->needs[i] = needs[i];
        expect(shown.position >= needs[i]);
    }
    if (!st_waits_add(st_store_waits(store), &a->wait)) {
        end(a);
    }
}

static void show_mesh(st_store *store, answer *a, const st_mesh_info *info)
{
    const uint64_t needs[MESHES] = {position_of_record(info->incarnation, info->record)};
    send_when_durable(store, a, st_shown_of(info), needs);
}

/* --- threads --- */

typedef struct worker {
    pthread_t thread;
    st_store *store;
    md_random random;
    answer *answers;
    size_t made;
} worker;

static void create(worker *w, const char *id)
{
    st_mesh *mesh = NULL;
    he_mesh *content = fixture_mesh("012,023");
    st_status status = st_create(w->store, id, "new", content, NULL, &mesh);
    if (status == ST_OK) {
        st_mesh_info info;
        st_read_begin(mesh, &info);
        st_read_end(mesh);
        show_mesh(w->store, &w->answers[w->made++], &info);
        st_release(mesh);
    } else {
        expect(status == ST_TAKEN || status == ST_FULL);
        he_mesh_free(content);
    }
}

static bool edit(worker *w, st_write *write)
{
    uint32_t vertex = md_below(&w->random, 4);
    he_vec3 by = {1, md_unit(&w->random), 0};
    return he_vertex_move(write->content, &vertex, 1, HE_MOVE_BY, &by, 1, NULL) == HE_OK &&
           st_write_changes(write, NULL) == HE_OK;
}

static bool prepare(worker *w, st_write *write)
{
    switch (md_below(&w->random, 16)) {
    case 0:
        st_write_remove(write);
        return true;
    case 1:
        st_write_replace(write, fixture_mesh("012,023,034"), NULL);
        st_write_rename(write, "replaced");
        return true;
    case 2:
        st_write_rename(write, "renamed");
        return true;
    case 3:
    case 4:
    case 5:
    case 6:
        return st_write_step(write, md_chance(&w->random, 60) ? ST_UNDO : ST_REDO,
                             md_from(&w->random, 1, MOST_STEPS)) == ST_OK;
    default:
        return edit(w, write) && !md_chance(&w->random, 10);
    }
}

static void *write_some(void *context)
{
    worker *w = context;
    for (int i = 0; i < ROUNDS; i++) {
        const char *id = ids[md_below(&w->random, MESHES)];
        st_mesh *mesh = NULL;
        st_write write;
        if (st_find(w->store, id, &mesh) != ST_OK) {
            create(w, id);
            continue;
        }
        bool claims = md_chance(&w->random, 10);
        st_status status =
            claims ? st_write_claim(mesh, NULL, &write) : st_write_begin(mesh, NULL, &write);
        expect(status == ST_OK || status == ST_ABSENT || status == ST_LOST ||
               (claims && status == ST_BUSY));
        if (status == ST_OK && claims) {
            expect(st_write_copy(&write, NULL, NULL) == HE_OK && edit(w, &write));
            sched_yield();
            status = st_write_commit(&write, "vertex_move");
            expect(status == ST_OK || status == ST_ABSENT || status == ST_LOST ||
                   status == ST_FULL);
        } else if (status == ST_OK && (write.info.busy || !prepare(w, &write))) {
            st_write_abort(&write);
            status = ST_BUSY;
        } else if (status == ST_OK) {
            status = st_write_commit(&write, "vertex_move");
            expect(status == ST_OK || status == ST_FULL);
        }
        if (status == ST_OK) {
            show_mesh(w->store, &w->answers[w->made++], &write.info);
        } else if (status == ST_FULL) {
            i--;
            sched_yield();
        }
        st_release(mesh);
    }
    return NULL;
}

static void read_list(worker *w)
{
    uint64_t since = st_waits_durable(st_store_waits(w->store)), needs[MESHES] = {0};
    st_mesh *meshes[MESHES];
    size_t count = st_list(w->store, "", meshes, MESHES);
    for (size_t i = 0; i < count; i++) {
        st_mesh_info info;
        st_read_begin(meshes[i], &info);
        st_read_end(meshes[i]);
        uint64_t at = position_of_record(info.incarnation, info.record);
        needs[i] = at > since ? at : 0;
        st_release(meshes[i]);
    }
    send_when_durable(w->store, &w->answers[w->made++], st_shown_all(w->store, since), needs);
}

static void read_one(worker *w)
{
    uint32_t i = md_below(&w->random, MESHES);
    uint64_t since = st_waits_durable(st_store_waits(w->store));
    pthread_mutex_lock(&journal.lock);
    uint64_t removed = journal.removed[i];
    pthread_mutex_unlock(&journal.lock);
    st_mesh *mesh = NULL;
    st_mesh_info info = {.removed = true};
    if (st_find(w->store, ids[i], &mesh) == ST_OK) {
        st_read_begin(mesh, &info);
        st_read_end(mesh);
        st_release(mesh);
    }
    if (!info.removed) {
        show_mesh(w->store, &w->answers[w->made++], &info);
    } else if (mesh == NULL) {
        /* The mesh was not found, so the answer depends on the last deletion of a mesh with this
         * id, unless the deletion was durable before the search began. */
        bool shows = removed > since && removed < st_waits_newest(st_store_waits(w->store));
        const uint64_t needs[MESHES] = {shows ? removed : 0};
        send_when_durable(w->store, &w->answers[w->made++], st_shown_all(w->store, since), needs);
    }
}

static void *read_some(void *context)
{
    worker *w = context;
    for (int i = 0; i < ROUNDS && atomic_load(&writing); i++) {
        if (md_chance(&w->random, 30)) {
            read_list(w);
        } else {
            read_one(w);
        }
        sched_yield();
    }
    return NULL;
}

typedef struct told {
    uint64_t incarnation, revision;
} told;

static bool render(const st_mesh_info *info, const st_change *change, char **bytes, size_t *length)
{
    const told event = {info->incarnation, info->revision};
    (void)change;
    *bytes = he_mem_alloc(sizeof event);
    *length = sizeof event;
    if (*bytes != NULL) {
        memcpy(*bytes, &event, sizeof event);
    }
    return *bytes != NULL;
}

static void wake(void *context)
{
    (void)context;
}

static _Atomic size_t events;

/* Reads events until the mesh is deleted or the test ends. Returns false if the next event has not
 * arrived yet. */
static bool hear(st_listener *listener, bool *ended)
{
    told event;
    size_t got = 0;
    switch (st_queue_read(listener, (char *)&event, sizeof event, &got)) {
    case ST_QUEUE_GOT:
        expect(got == sizeof event);
        expect(was_kept(position_of_revision(event.incarnation, event.revision)));
        atomic_fetch_add(&events, 1);
        return true;
    case ST_QUEUE_WAIT:
    case ST_QUEUE_NUDGED:
        return false;
    case ST_QUEUE_BEHIND:
        (void)st_queue_skip(listener);
        return true;
    case ST_QUEUE_LOST:
    case ST_QUEUE_ENDED:
        break;
    }
    *ended = true;
    return false;
}

static void *listen_some(void *context)
{
    worker *w = context;
    while (atomic_load(&writing)) {
        st_mesh *mesh = NULL;
        st_listener listener;
        st_missed missed;
        st_mesh_info info;
        if (st_find(w->store, ids[md_below(&w->random, MESHES)], &mesh) != ST_OK) {
            sched_yield();
            continue;
        }
        const st_since since = {.given = false};
        if (st_follow(mesh, &listener, &since, &missed, &info) == ST_OK) {
            bool ended = false;
            st_queue_wake(&listener, wake, NULL);
            while (!ended && atomic_load(&writing)) {
                if (!hear(&listener, &ended)) {
                    sched_yield();
                }
            }
            st_unfollow(mesh, &listener);
        }
        st_release(mesh);
    }
    return NULL;
}

/* --- the run --- */

/* Requires that the records of each mesh, in the order of their positions, have consecutive
 * numbers, and that no record was kept that comes after a lost record. */
static void expect_order(void)
{
    for (uint64_t at = 1; at <= journal.newest; at++) {
        const note *n = &journal.notes[at];
        uint64_t before = at - 1;
        while (before > 0 && journal.notes[before].incarnation != n->incarnation) {
            before--;
        }
        assert_int_equal(n->number, before == 0 ? 1 : journal.notes[before].number + 1);
        assert_true(n->lost || !journal.notes[before].lost);
    }
}

static bool shows_lost(const st_shown *shown)
{
    for (uint64_t at = shown->since + 1; at <= shown->position; at++) {
        const note *n = &journal.notes[at];
        if (n->lost && (shown->incarnation == 0 || shown->incarnation == n->incarnation)) {
            return true;
        }
    }
    return false;
}

static void start(worker *w, void *(*run)(void *context), st_store *store, md_random *random)
{
    w->store = store;
    w->random = (md_random){md_bits(random)};
    w->answers = calloc(ROUNDS, sizeof *w->answers);
    assert_non_null(w->answers);
    assert_int_equal(pthread_create(&w->thread, NULL, run, w), 0);
}

static void nothing_is_shown_before_it_is_durable(void **state)
{
    (void)state;
    md_random random = {seed_of_run()}, lag = {md_bits(&random)};
    st_store *store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 16,
        .max_meshes = MESHES,
        .journal = {.reserve = reserve,
                    .leave = leave,
                    .append = append,
                    .listen = listen_to,
                    .close = close_journal},
        .render = render,
        .listeners = LISTENERS,
        .mesh_listeners = LISTENERS,
    });
    static worker workers[WRITERS + READERS + LISTENERS];
    pthread_t lagging;
    atomic_store(&writing, true);
    /* The thread that fills the disk must start before the other threads. Otherwise it might not
     * run before the writers have nearly ended. */
    assert_int_equal(pthread_create(&lagging, NULL, lag_behind, &lag), 0);
    for (int i = 0; i < WRITERS + READERS + LISTENERS; i++) {
        start(&workers[i],
              i < WRITERS             ? write_some
              : i < WRITERS + READERS ? read_some
                                      : listen_some,
              store, &random);
    }
    for (int i = 0; i < WRITERS; i++) {
        pthread_join(workers[i].thread, NULL);
    }
    atomic_store(&writing, false);
    for (int i = WRITERS; i < WRITERS + READERS + LISTENERS; i++) {
        pthread_join(workers[i].thread, NULL);
    }
    pthread_join(lagging, NULL);

    /* Records that are not durable at the end of the test count as lost. No answer that shows one
     * of these records may have been sent. */
    advance(fill_up(atomic_load(&journal.durable)));
    assert_int_equal(journal.out, 0);
    size_t made = 0;
    for (int i = 0; i < WRITERS + READERS + LISTENERS; i++) {
        for (size_t k = 0; k < workers[i].made; k++) {
            const answer *a = &workers[i].answers[k];
            assert_true(atomic_load(&a->over));
            assert_int_equal(a->wait.end,
                             shows_lost(&a->wait.shown) ? ST_WAIT_LOST : ST_WAIT_DURABLE);
        }
        made += workers[i].made;
        free(workers[i].answers);
    }
    assert_int_equal(atomic_load(&broken), 0);
    assert_int_equal(atomic_load(&sent) + atomic_load(&lost), made);
    expect_order();
    assert_true(atomic_load(&incidents) > 2);
    printf("note: %llu records, %zu answers sent, %zu lost, %zu events; %zu times full, %zu writes "
           "refused\n",
           (unsigned long long)journal.newest, atomic_load(&sent), atomic_load(&lost),
           atomic_load(&events), atomic_load(&incidents), atomic_load(&refused));
    st_store_free(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_shown_before_it_is_durable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
