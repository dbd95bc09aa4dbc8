/* In a control group with little memory, the daemon must refuse requests before the kernel kills
 * it.
 *
 * The test creates a group below its own one, in the version of control groups that limits memory
 * on this machine. To try it by hand, as root: mkdir /sys/fs/cgroup/small; echo 300M
 * >/sys/fs/cgroup/small/memory.max; echo $$ >/sys/fs/cgroup/small/cgroup.procs; build/hedged (in
 * version 1 the files are below /sys/fs/cgroup/memory and the limit is memory.limit_in_bytes). If
 * no group can be created, the test says so and gives the daemon the memory budget that it would
 * derive from 300 MiB. */
#include "tests/e2e/client.h"
#include "tests/sanitized.h"

#include "system/memory_limit.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define MIB (UINT64_C(1) << 20)

/* A sanitizer needs memory of its own, more than the limit of the group. */
enum { IN_GROUP = !SANITIZED };

enum { LIMIT_MIB = 300, MANY = 400, PATH_BYTES = 512 };

typedef struct group {
    char parent[PATH_BYTES], own[PATH_BYTES + 32];
    const char *usage; /* the file that tells the peak of the group's memory */
} group;

static bool write_text(const char *folder, const char *name, const char *text)
{
    char path[2 * PATH_BYTES];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    bool good = file != NULL && fputs(text, file) >= 0;
    return file != NULL && fclose(file) == 0 && good;
}

/* Finds the control group of this process, a folder below `mount`. In the list of the process's
 * groups, the line of this group contains `key`: ":memory:" in version 1 of control groups, "0::"
 * in version 2. */
static bool find_parent(const char *key, const char *mount, char out[PATH_BYTES])
{
    char line[PATH_BYTES];
    bool found = false;
    FILE *file = fopen("/proc/self/cgroup", "r");
    while (file != NULL && !found && fgets(line, sizeof line, file) != NULL) {
        const char *at = strstr(line, key);
        line[strcspn(line, "\n")] = '\0';
        found = at != NULL;
        if (found) {
            const char *path = at + strlen(key);
            snprintf(out, PATH_BYTES, "%s%.300s", mount, strcmp(path, "/") == 0 ? "" : path);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return found;
}

static bool make_group(group *g)
{
    static const struct {
        const char *key, *mount, *limit, *usage;
    } kinds[] = {
        {":memory:", "/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.max_usage_in_bytes"},
        {"0::", "/sys/fs/cgroup", "memory.max", "memory.peak"}};
    char limit[32], pid[32];
    snprintf(limit, sizeof limit, "%llu", (unsigned long long)(LIMIT_MIB * MIB));
    snprintf(pid, sizeof pid, "%d", (int)getpid());
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (!find_parent(kinds[i].key, kinds[i].mount, g->parent)) {
            continue;
        }
        g->usage = kinds[i].usage;
        snprintf(g->own, sizeof g->own, "%s/hedged-%d", g->parent, (int)getpid());
        if (mkdir(g->own, 0755) == 0) {
            if (write_text(g->own, kinds[i].limit, limit) &&
                write_text(g->own, "cgroup.procs", pid)) {
                return true;
            }
            rmdir(g->own);
        }
    }
    return false;
}

/* Moves this process back to its former control group; the daemon stays in the small group. */
static void leave_group(const group *g)
{
    char pid[32];
    snprintf(pid, sizeof pid, "%d", (int)getpid());
    assert_true(write_text(g->parent, "cgroup.procs", pid));
}

static void end_group(const group *g)
{
    char path[2 * PATH_BYTES], text[64] = "0";
    snprintf(path, sizeof path, "%s/%s", g->own, g->usage);
    FILE *file = fopen(path, "r");
    if (file != NULL && fgets(text, sizeof text, file) != NULL) {
        print_message("note: in a control group of %d MiB at most %llu MiB were used\n", LIMIT_MIB,
                      strtoull(text, NULL, 10) / (unsigned long long)MIB);
    }
    if (file != NULL) {
        fclose(file);
    }
    assert_int_equal(rmdir(g->own), 0);
}

/* Requires that the daemon's first log lines contain `words`, which are about its memory budget. */
static void expect_budget(daemon_process *d, client *c, const char *words)
{
    char *log = daemon_wait_log(d, "listening on", 1);
    if (strstr(log, words) == NULL) {
        fail_msg("no \"%s\" in: %s", words, log);
    }
    free(log);
    reply r = reply_expect(200, client_get(c, "/v1/meshes"));
    const uint64_t budget = (uint64_t)LIMIT_MIB * MIB / 4 * 3;
    assert_true(reply_number(&r, "memory_budget") == (double)budget);
    reply_free(&r);
}

static void tori_are_refused_before_the_kernel_steps_in(void **state)
{
    (void)state;
    group g = {.usage = NULL};
    bool made = IN_GROUP && make_group(&g);
    char told[32], said[64];
    snprintf(told, sizeof told, "%llu", (unsigned long long)(LIMIT_MIB * MIB / 4 * 3));
    daemon_process *d =
        daemon_start(made ? (const char *const[]){"--log", "off", NULL}
                          : (const char *const[]){"--log", "off", "--memory-budget", told, NULL});
    if (made) {
        leave_group(&g);
    } else {
        print_message("note: the daemon is in no control group here: it is told its budget\n");
    }
    client *c = client_new(d);
    snprintf(said, sizeof said, made ? "of the %d MiB that /" : "as configured", LIMIT_MIB);
    expect_budget(d, c, said);

    static const char body[] =
        "{\"shape\":\"torus\",\"major_segments\":256,\"minor_segments\":256}";
    long status = 201;
    int count = 0;
    for (; count < MANY && status == 201; count++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/t%d", count);
        reply r = client_send(c, "PUT", path, NULL, body);
        status = r.status;
        reply_free(&r);
    }
    assert_int_equal(status, 507);
    assert_true(count > 10 && count < MANY);
    for (int i = 0; i < count; i++) {
        reply r = client_send(c, "PUT", "/v1/meshes/more", NULL, body);
        assert_int_equal(r.status, 507);
        reply_free(&r);
    }
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/t0/vertices/0/faces")));
    for (int i = 0; i < 4; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/t%d", i);
        reply_done(reply_expect(204, client_send(c, "DELETE", path, NULL, NULL)));
    }
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/t4/content?format=stl")));
    reply_done(reply_expect(201, client_send(c, "PUT", "/v1/meshes/more", NULL, body)));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    if (made) {
        end_group(&g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tori_are_refused_before_the_kernel_steps_in)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
