/* damage.c - damages the files of a small store at every byte or bit, one copy of the store for
 * each place, and checks what the store does with each damaged copy. `cut` ends a file at a byte
 * (promise D6 in core/store), `flip` inverts a bit (promise D7).
 *
 *     damage cut|flip FOLDER [EVERY [SEED [WORKERS]]]
 *
 * The program works below FOLDER, which should be in memory. It tries every EVERY-th place,
 * beginning with one drawn from SEED. WORKERS processes share the places. The last lines of the
 * output count the verdicts, as in `3 refused`; the exit status is 0 if no copy was judged
 * wrong. */
#include "durable/damage/specimen.h"

#include "model/random.h"
#include "tests/store_folder.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FILES = 3, WORKERS = 16, PATIENCE = 120, BALLAST = 8 << 20 };

static const char *const names[FILES] = {"hedge.db", "hedge.db-wal", "hedge.mark"};

static struct {
    unsigned char *bytes[FILES]; /* the undamaged contents of the store's files */
    size_t sizes[FILES];
    /* `total` is the number of places (bytes or bits) that can be damaged. Of these, the place
     * `first` and every `every`-th one after it are tried. */
    size_t total, every, first;
    bool cuts;
} plan;

/* Shared memory of all workers. */
typedef struct shared {
    atomic_size_t next;
    atomic_size_t at[WORKERS]; /* the place that each worker is trying */
    atomic_uint verdicts[SPECIMEN_WRONG + 1], crashes;
} shared;

static shared *common;

/* --- places: where a file is cut or a bit is inverted --- */

static size_t places_of(size_t file)
{
    return plan.cuts ? plan.sizes[file] : 8 * plan.sizes[file];
}

static size_t file_of(size_t *place)
{
    size_t file = 0;
    while (*place >= places_of(file)) {
        *place -= places_of(file++);
    }
    return file;
}

static void describe(size_t place, char out[80])
{
    size_t file = file_of(&place);
    if (plan.cuts) {
        (void)snprintf(out, 80, "%s cut at byte %zu", names[file], place);
    } else {
        (void)snprintf(out, 80, "%s, byte %zu, bit %zu", names[file], place / 8, place % 8);
    }
}

/* --- one place after the other --- */

/* Writes the undamaged files of the store into a folder. The file "ballast" only reserves disk
 * space, so zeros are written in place of its contents. */
static void lay_out(const char *folder)
{
    char path[2 * FOLDER_PATH];
    for (size_t i = 0; i < FILES; i++) {
        folder_write(folder, names[i], plan.bytes[i], plan.sizes[i]);
    }
    (void)snprintf(path, sizeof path, "%s/hedge.db-shm", folder);
    (void)unlink(path);
    (void)snprintf(path, sizeof path, "%s/ballast", folder);
    FILE *ballast = fopen(path, "ab");
    if (ballast == NULL || ftruncate(fileno(ballast), BALLAST) != 0 || fclose(ballast) != 0) {
        perror(path);
        abort();
    }
}

static specimen_verdict try_place(const char *folder, size_t place, char why[SPECIMEN_WHY])
{
    size_t file = file_of(&place);
    lay_out(folder);
    if (plan.cuts) {
        folder_write(folder, names[file], plan.bytes[file], place);
    } else {
        unsigned char *byte = &plan.bytes[file][place / 8];
        const unsigned char bit = (unsigned char)(1u << place % 8);
        *byte ^= bit;
        folder_write(folder, names[file], plan.bytes[file], plan.sizes[file]);
        *byte ^= bit;
    }
    return specimen_judge(folder, why);
}

static void work(const char *base, unsigned worker)
{
    char folder[FOLDER_PATH], why[SPECIMEN_WHY], where[80];
    size_t place;
    (void)snprintf(folder, sizeof folder, "%.200s/%u", base, worker);
    (void)mkdir(folder, 0700);
    while ((place = plan.first + plan.every * common->next++) < plan.total) {
        common->at[worker] = place;
        alarm(PATIENCE);
        specimen_verdict verdict = try_place(folder, place, why);
        common->verdicts[verdict]++;
        if (verdict == SPECIMEN_WRONG) {
            describe(place, where);
            printf("WRONG %s: %s\n", where, why);
            (void)fflush(stdout);
        }
    }
    alarm(0);
    folder_remove(folder);
}

/* --- workers --- */

static pid_t start(const char *base, unsigned worker)
{
    (void)fflush(stdout);
    pid_t pid = fork();
    if (pid == 0) {
        work(base, worker);
        exit(0);
    }
    return pid;
}

/* Runs the workers. If a damaged place crashes a worker, the crash is counted, and a new worker
 * goes on with the next place. */
static void run(const char *base, unsigned count)
{
    pid_t workers[WORKERS];
    for (unsigned i = 0; i < count; i++) {
        workers[i] = start(base, i);
    }
    for (unsigned left = count; left > 0;) {
        int status;
        char where[80];
        pid_t pid = wait(&status);
        unsigned worker = 0;
        while (worker < count && workers[worker] != pid) {
            worker++;
        }
        if (worker == count || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
            left -= worker < count;
            continue;
        }
        describe(common->at[worker], where);
        printf("WRONG %s: %s %d\n", where, WIFSIGNALED(status) ? "signal" : "exit status",
               WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
        common->crashes++;
        workers[worker] = start(base, worker);
    }
}

/* --- would the test notice a loss? --- */

/* Checks that the test would notice a loss. The undamaged store must be judged whole. Without the
 * files hedge.db-wal and hedge.mark the store is in an older state, which must be judged wrong. */
static bool sees(const char *base)
{
    char folder[FOLDER_PATH], why[SPECIMEN_WHY], path[2 * FOLDER_PATH];
    (void)snprintf(folder, sizeof folder, "%.200s/sees", base);
    (void)mkdir(folder, 0700);
    lay_out(folder);
    const bool whole = specimen_judge(folder, why) == SPECIMEN_WHOLE;
    if (!whole) {
        printf("WRONG undamaged: %s\n", why);
    }
    lay_out(folder);
    for (size_t i = 1; i < FILES; i++) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        (void)unlink(path);
    }
    const bool wrong = specimen_judge(folder, why) == SPECIMEN_WRONG;
    if (!wrong) {
        printf("WRONG an older state of the store passes: %s\n", why);
    }
    folder_remove(folder);
    return whole && wrong;
}

/* Runs sees() in a process of its own, because it starts threads, and the workers must be forked
 * from a process without threads. */
static bool is_seen(const char *base)
{
    int status;
    (void)fflush(stdout);
    pid_t pid = fork();
    if (pid == 0) {
        exit(sees(base) ? 0 : 1);
    }
    return waitpid(pid, &status, 0) == pid && status == 0;
}

static void make_plan(const char *base, bool cuts)
{
    char made[FOLDER_PATH], killed[FOLDER_PATH];
    (void)snprintf(made, sizeof made, "%.200s/made", base);
    (void)snprintf(killed, sizeof killed, "%.200s/killed", base);
    folder_remove(made);
    folder_remove(killed);
    (void)mkdir(made, 0700);
    (void)mkdir(killed, 0700);
    specimen_make(made, killed);
    plan.cuts = cuts;
    for (size_t i = 0; i < FILES; i++) {
        plan.bytes[i] = folder_read(killed, names[i], &plan.sizes[i]);
        if (plan.bytes[i] == NULL) {
            (void)fprintf(stderr, "no %s\n", names[i]);
            exit(2);
        }
        printf("%zu bytes of %s\n", plan.sizes[i], names[i]);
        plan.total += places_of(i);
    }
    folder_remove(made);
    folder_remove(killed);
}

static size_t argument(int argc, char **argv, int at, size_t otherwise)
{
    return argc > at ? (size_t)strtoull(argv[at], NULL, 10) : otherwise;
}

int main(int argc, char **argv)
{
    if (argc < 3 || (strcmp(argv[1], "cut") != 0 && strcmp(argv[1], "flip") != 0)) {
        (void)fprintf(stderr, "usage: damage cut|flip FOLDER [EVERY [SEED [WORKERS]]]\n");
        return 2;
    }
    const char *base = argv[2];
    plan.every = argument(argc, argv, 3, 1);
    md_random random = {argument(argc, argv, 4, 1)};
    plan.first = md_below(&random, (uint32_t)plan.every);
    size_t workers = argument(argc, argv, 5, 1);
    common = mmap(NULL, sizeof *common, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (common == MAP_FAILED) {
        perror("mmap");
        return 2;
    }
    make_plan(base, strcmp(argv[1], "cut") == 0);
    const bool seen = is_seen(base);
    run(base, workers < WORKERS ? (unsigned)workers : WORKERS);
    const unsigned bad = common->verdicts[SPECIMEN_WRONG] + common->crashes;
    printf("%zu places\n%u whole\n%u named\n%u stopped\n%u refused\n%u wrong\n", plan.total,
           common->verdicts[SPECIMEN_WHOLE], common->verdicts[SPECIMEN_NAMED],
           common->verdicts[SPECIMEN_STOPPED], common->verdicts[SPECIMEN_REFUSED], bad);
    for (size_t i = 0; i < FILES; i++) {
        free(plan.bytes[i]);
    }
    return seen && bad == 0 ? 0 : 1;
}
