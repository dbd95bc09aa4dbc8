/* Tests of finding the kernel's memory limit of the process, wherever the limit is in the tree of
 * control groups, both outside and inside of a container. Each test makes the files of /proc and
 * /sys that it needs in a folder of its own. */
#define _XOPEN_SOURCE 700 /* makes ftw.h declare nftw */

#include "tests/unit/fixture.h"

#include "system/memory_limit.h"

#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define MIB (UINT64_C(1) << 20)

enum { MACHINE_MIB = 4096 };

static char root[64];

static int make_root(void **state)
{
    (void)state;
    snprintf(root, sizeof root, "%s/hedged-limit-XXXXXX", P_tmpdir);
    return mkdtemp(root) == NULL;
}

static int remove_one(const char *path, const struct stat *stat, int kind, struct FTW *ftw)
{
    (void)stat;
    (void)kind;
    (void)ftw;
    return remove(path);
}

static int remove_root(void **state)
{
    (void)state;
    return nftw(root, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* Writes a file as in /proc or /sys, and makes the folders above it. */
static void put(const char *name, const char *text)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s%s", root, name);
    for (char *slash = strchr(path + strlen(root) + 1, '/'); slash != NULL;
         slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0700);
        *slash = '/';
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void expect(uint64_t bytes, const char *source)
{
    st_memory_limit limit = st_memory_limit_find(root, MACHINE_MIB * MIB);
    assert_string_equal(limit.source, source);
    assert_true(limit.bytes == bytes);
}

static const char unified[] = "25 24 0:22 / /proc rw - proc proc rw\n"
                              "30 24 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 "
                              "rw,nsdelegate\n";

static void without_control_groups_the_machine_is_the_limit(void **state)
{
    (void)state;
    expect(MACHINE_MIB * MIB, "the machine");
    put("/proc/self/cgroup", "0::/\n");
    put("/proc/self/mountinfo", unified);
    expect(MACHINE_MIB * MIB, "the machine");
    put("/sys/fs/cgroup/memory.max", "max\n");
    expect(MACHINE_MIB * MIB, "the machine");
    st_memory_limit unknown = st_memory_limit_find(root, 0);
    assert_true(unknown.bytes == UINT64_MAX);
}

static void the_process_own_group_limits_it(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "0::/system.slice/hedged.service\n");
    put("/proc/self/mountinfo", unified);
    put("/sys/fs/cgroup/system.slice/hedged.service/memory.max", "314572800\n");
    put("/sys/fs/cgroup/system.slice/memory.max", "max\n");
    put("/sys/fs/cgroup/other/memory.max", "1048576\n");
    expect(300 * MIB, "/sys/fs/cgroup/system.slice/hedged.service/memory.max");
}

static void a_group_above_with_less_wins(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "0::/a/b/c\n");
    put("/proc/self/mountinfo", unified);
    put("/sys/fs/cgroup/a/b/c/memory.max", "838860800\n");
    put("/sys/fs/cgroup/a/b/memory.max", "max\n");
    put("/sys/fs/cgroup/a/memory.max", "314572800\n");
    expect(300 * MIB, "/sys/fs/cgroup/a/memory.max");
    put("/sys/fs/cgroup/memory.max", "209715200\n");
    expect(200 * MIB, "/sys/fs/cgroup/memory.max");
    put("/sys/fs/cgroup/a/b/memory.high", "104857600\n");
    expect(100 * MIB, "/sys/fs/cgroup/a/b/memory.high");
}

static void version_1_and_a_mixed_system_are_read(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "9:cpu,cpuacct:/x\n4:memory:/user/one\n1:name=systemd:/z\n0::/user\n");
    put("/proc/self/mountinfo",
        "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
        "36 31 0:33 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu,cpuacct\n"
        "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
    put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    put("/sys/fs/cgroup/memory/user/memory.limit_in_bytes", "9223372036854771712\n");
    put("/sys/fs/cgroup/memory/user/one/memory.limit_in_bytes", "314572800\n");
    put("/sys/fs/cgroup/cpu/x/memory.limit_in_bytes", "1\n");
    expect(300 * MIB, "/sys/fs/cgroup/memory/user/one/memory.limit_in_bytes");
    put("/sys/fs/cgroup/unified/user/memory.max", "104857600\n");
    expect(100 * MIB, "/sys/fs/cgroup/unified/user/memory.max");
}

/* In a container with control groups of version 1, the root of the mounted tree is the container's
 * own group, but /proc shows the path of this group on the host. */
static void a_bind_mount_of_the_own_group_is_found(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "4:memory:/docker/abc\n");
    put("/proc/self/mountinfo",
        "35 31 0:32 /docker/abc /sys/fs/cgroup/memory ro master:9 - cgroup cgroup rw,memory\n");
    put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "314572800\n");
    expect(300 * MIB, "/sys/fs/cgroup/memory/memory.limit_in_bytes");
    put("/proc/self/cgroup", "4:memory:/docker/abc/inner\n");
    put("/sys/fs/cgroup/memory/inner/memory.limit_in_bytes", "104857600\n");
    expect(100 * MIB, "/sys/fs/cgroup/memory/inner/memory.limit_in_bytes");
    /* The group of the process is /docker/abcd/inner. It is not inside the mounted group
     * /docker/abc, although its name begins in the same way: only the limit at the root of the
     * mount applies. */
    put("/proc/self/cgroup", "4:memory:/docker/abcd/inner\n");
    expect(300 * MIB, "/sys/fs/cgroup/memory/memory.limit_in_bytes");
}

/* In a namespace of control groups, the path of the process's own group is "/", and groups outside
 * of the namespace begin with "/..". */
static void a_namespace_is_read_from_inside(void **state)
{
    (void)state;
    put("/proc/self/cgroup", "0::/\n");
    put("/proc/self/mountinfo", unified);
    put("/sys/fs/cgroup/memory.max", "314572800\n");
    expect(300 * MIB, "/sys/fs/cgroup/memory.max");
    put("/proc/self/mountinfo",
        "30 24 0:26 /../.. /sys/fs/cgroup rw - cgroup2 cgroup2 rw,nsdelegate\n");
    expect(300 * MIB, "/sys/fs/cgroup/memory.max");
    put("/proc/self/cgroup", "0::/../sibling\n");
    put("/proc/self/mountinfo", unified);
    expect(300 * MIB, "/sys/fs/cgroup/memory.max");
}

static void blanks_and_long_lines_are_no_obstacle(void **state)
{
    (void)state;
    enum { LONG = 20000 };
    char *text = malloc(LONG + 512);
    assert_non_null(text);
    int length = snprintf(text, 64, "20 1 0:20 / / rw - overlay overlay rw,lowerdir=");
    memset(text + length, 'x', (size_t)(LONG - length));
    snprintf(text + LONG, 512,
             "\nbroken\n- -\n1 2 3\n30 24 0:26 / /my\\040groups rw a:1 b:2 - cgroup2 none rw\n");
    put("/proc/self/mountinfo", text);
    free(text);
    put("/proc/self/cgroup", "nonsense\n0::/a:b\n");
    put("/my groups/a:b/memory.max", "314572800\n");
    expect(300 * MIB, "/my groups/a:b/memory.max");
}

int main(void)
{
#define TEST(f) cmocka_unit_test_setup_teardown(f, make_root, remove_root)
    const struct CMUnitTest tests[] = {
        TEST(without_control_groups_the_machine_is_the_limit),
        TEST(the_process_own_group_limits_it),
        TEST(a_group_above_with_less_wins),
        TEST(version_1_and_a_mixed_system_are_read),
        TEST(a_bind_mount_of_the_own_group_is_found),
        TEST(a_namespace_is_read_from_inside),
        TEST(blanks_and_long_lines_are_no_obstacle),
    };
#undef TEST
    return cmocka_run_group_tests(tests, NULL, NULL);
}
