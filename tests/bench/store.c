/* Benchmark of durability: edits per second of one writer and of 64, on 64 meshes and on one; each
 * writer waits until its edit is durable before the next one. Three ways are measured in turn on
 * one file system: a growing file, to which the bytes of each edit are written with fdatasync after
 * each; the store on SQLite; the store in memory, where nothing has to become durable.
 *
 *     build/tests/bench/store FOLDER [ROUNDS [SECONDS]]      FOLDER on the disk to measure */
#include "base/mem.h"
#include "build/build.h"
#include "edit/local/vertex.h"
#include "journal/record_bytes.h"
#include "journal/sqlite/sqlite_journal.h"
#include "store/write.h"
#include "system/memory.h"

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MOST_WRITERS = 64, MOST_ROUNDS = 101, RECORD_ROOM = 1 << 12 };

typedef enum row {
    RAW,         /* one file, one writer */
    ONE,         /* SQLite, one writer */
    MANY,        /* the store on SQLite: 64 writers on 64 meshes */
    MANY_ON_ONE, /* the store on SQLite: 64 writers on one mesh */
    MEMORY,
    MEMORY_ON_ONE,
    ROWS
} row;

static const char *const names[ROWS] = {
    [RAW] = "write and fdatasync, one writer",  [ONE] = "SQLite, one writer",
    [MANY] = "SQLite, 64 writers, 64 meshes",   [MANY_ON_ONE] = "SQLite, 64 writers, one mesh",
    [MEMORY] = "memory, 64 writers, 64 meshes", [MEMORY_ON_ONE] = "memory, 64 writers, one mesh",
};

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void require(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "store: %s\n", what);
        exit(1);
    }
}

/* --- counting records --- */

/* The store's own journal. The journal of this test counts the records and passes them on to this
 * one. */
static st_journal below;
static atomic_size_t record_bytes, records;

/* Counts the bytes that a record takes on the disk, and passes the record on. */
static uint64_t append(void *self, st_room *room, const st_record *list, size_t count)
{
    unsigned char head[RECORD_ROOM];
    for (size_t i = 0; i < count && list[i].kind == ST_RECORD_EDIT && list[i].stage == NULL; i++) {
        st_record bare = list[i];
        bare.body_size = 0;
        bare.body = NULL;
        atomic_fetch_add(&record_bytes, st_frame_write(&bare, head) + list[i].body_size);
        atomic_fetch_add(&records, 1);
    }
    return below.append(self, room, list, count);
}

/* --- writers --- */

static _Atomic bool ending;

typedef struct writer {
    pthread_t thread;
    st_store *store;
    st_mesh *mesh;
    st_wait wait;
    sem_t ended;
    uint64_t edits;
} writer;

static void resume(st_wait *wait)
{
    writer *w = (writer *)((char *)wait - offsetof(writer, wait));
    sem_post(&w->ended);
}

static void edit(writer *w)
{
    st_write write;
    const uint32_t vertex = (uint32_t)(w->edits % 4);
    const he_vec3 to = {(double)w->edits, 1, 2};
    require(st_write_begin(w->mesh, NULL, &write) == ST_OK, "no write");
    require(he_vertex_move(write.content, &vertex, 1, HE_MOVE_TO, &to, 1, NULL) == HE_OK &&
                st_write_changes(&write, NULL) == HE_OK &&
                st_write_commit(&write, "vertex_move") == ST_OK,
            "no edit");
    w->wait = (st_wait){.shown = st_shown_of(&write.info), .resume = resume};
    if (st_waits_add(st_store_waits(w->store), &w->wait)) {
        while (sem_wait(&w->ended) != 0) {
        }
    }
    require(w->wait.end == ST_WAIT_DURABLE, "an edit was lost");
    w->edits++;
}

static void *write_on(void *context)
{
    writer *w = context;
    while (!ending) {
        edit(w);
    }
    return NULL;
}

/* --- rows --- */

static he_mesh *tetrahedron(void)
{
    static const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    he_soup soup;
    he_mesh *mesh = NULL;
    bool good = true;
    he_soup_init(&soup, NULL);
    for (int i = 0; i < 4; i++) {
        he_vec3 p = {corners[i][0], corners[i][1], corners[i][2]};
        good = good && he_soup_add_vertex(&soup, p, NULL) == HE_OK;
    }
    for (int i = 0; i < 4; i++) {
        good = good && he_soup_add_face(&soup, faces[i], 3, NULL) == HE_OK;
    }
    require(good && he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL) == HE_OK, "no tetrahedron");
    he_soup_clear(&soup);
    return mesh;
}

static void wait_for(double time)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += (time_t)time;
    until.tv_nsec += (long)(1e9 * (time - (double)(time_t)time));
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
}

/* Runs the writers for some seconds; returns the edits per second. */
static double run_writers(const st_journal *journal, size_t writers, size_t meshes, double time)
{
    static writer all[MOST_WRITERS];
    below = *journal;
    st_journal counted = *journal;
    counted.append = append;
    st_store *store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20, .max_meshes = MOST_WRITERS, .journal = counted});
    require(store != NULL, "no store");
    for (size_t i = 0; i < writers; i++) {
        char id[16];
        all[i] = (writer){.store = store};
        sem_init(&all[i].ended, 0, 0);
        snprintf(id, sizeof id, "m%zu", i % meshes);
        require((i < meshes ? st_create(store, id, "", tetrahedron(), NULL, &all[i].mesh)
                            : st_find(store, id, &all[i].mesh)) == ST_OK,
                "no mesh");
    }
    ending = false;
    double begun = seconds();
    for (size_t i = 0; i < writers; i++) {
        require(pthread_create(&all[i].thread, NULL, write_on, &all[i]) == 0, "no thread");
    }
    wait_for(time);
    ending = true;
    uint64_t edits = 0;
    for (size_t i = 0; i < writers; i++) {
        pthread_join(all[i].thread, NULL);
        edits += all[i].edits;
    }
    double rate = (double)edits / (seconds() - begun);
    for (size_t i = 0; i < writers; i++) {
        sem_destroy(&all[i].ended);
        st_release(all[i].mesh);
    }
    st_store_free(store);
    return rate;
}

static void remove_store(const char *folder)
{
    static const char *const files[] = {"hedge.db",   "hedge.db-wal", "hedge.db-shm",
                                        "hedge.mark", "ballast",      "lock"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, files[i]);
        (void)unlink(path);
    }
    (void)rmdir(folder);
}

static double run_sqlite(const char *folder, size_t writers, size_t meshes, double time)
{
    char path[1000];
    st_sqlite_opened opened;
    snprintf(path, sizeof path, "%s/bench-store", folder);
    remove_store(path);
    require(st_sqlite_open(&(st_sqlite_options){.folder = path, .release = "bench"}, &opened),
            opened.message);
    double rate = run_writers(&opened.journal, writers, meshes, time);
    remove_store(path);
    return rate;
}

static double run_memory(size_t meshes, double time)
{
    st_journal journal = st_journal_memory();
    return run_writers(&journal, MOST_WRITERS, meshes, time);
}

/* Appends as many bytes as a record has to a file and syncs it, again and again; returns how often
 * per second. */
static double run_raw(const char *folder, size_t size, double time)
{
    char path[1000], bytes[RECORD_ROOM];
    snprintf(path, sizeof path, "%s/bench-raw", folder);
    memset(bytes, 'r', sizeof bytes);
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    require(file >= 0, "no file");
    uint64_t count = 0;
    double begun = seconds(), now;
    do {
        require(write(file, bytes, size) == (ssize_t)size && fdatasync(file) == 0, "no write");
        count++;
        now = seconds();
    } while (now - begun < time);
    close(file);
    (void)unlink(path);
    return (double)count / (now - begun);
}

static int compare(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void tell(const char *what, double ratio, double target)
{
    printf("%-52s %6.2f   target %.2f   %s\n", what, ratio, target,
           ratio >= target ? "met" : "falls short");
}

int main(int count, char **arguments)
{
    require(count > 1, "which folder?");
    const char *folder = arguments[1];
    const long asked = count > 2 ? strtol(arguments[2], NULL, 10) : 7;
    const size_t rounds = asked > 0 && asked <= MOST_ROUNDS ? (size_t)asked : 7;
    const double time = count > 3 ? strtod(arguments[3], NULL) : 1;
    double rates[ROWS][MOST_ROUNDS], median[ROWS];
    st_memory_install(0);
    (void)run_sqlite(folder, 1, 1, 0.1); /* the writers run once to find the size of a record */
    const size_t size = record_bytes / (records > 0 ? records : 1);
    for (size_t i = 0; i < rounds; i++) {
        rates[RAW][i] = run_raw(folder, size, time);
        rates[ONE][i] = run_sqlite(folder, 1, 1, time);
        rates[MANY][i] = run_sqlite(folder, MOST_WRITERS, MOST_WRITERS, time);
        rates[MANY_ON_ONE][i] = run_sqlite(folder, MOST_WRITERS, 1, time);
        rates[MEMORY][i] = run_memory(MOST_WRITERS, time);
        rates[MEMORY_ON_ONE][i] = run_memory(1, time);
    }
    printf("medians of %zu rounds of %g s; a record takes %zu bytes\n", rounds, time, size);
    for (int r = 0; r < ROWS; r++) {
        qsort(rates[r], rounds, sizeof **rates, compare);
        median[r] = rates[r][rounds / 2];
        printf("%-34s %9.0f edits/s   %.0f to %.0f\n", names[r], median[r], rates[r][0],
               rates[r][rounds - 1]);
    }
    tell("one writer, of write and fdatasync", median[ONE] / median[RAW], 0.6);
    for (row r = MANY; r <= MANY_ON_ONE; r++) {
        const double memory = median[r == MANY ? MEMORY : MEMORY_ON_ONE];
        const bool by_one = 8 * median[ONE] < 0.4 * memory;
        char what[80];
        snprintf(what, sizeof what, "%s, of %s", names[r], by_one ? "one writer" : "memory");
        tell(what, median[r] / (by_one ? median[ONE] : memory), by_one ? 8 : 0.4);
    }
    return 0;
}
