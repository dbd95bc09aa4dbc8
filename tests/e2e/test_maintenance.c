/* hedged --backup and --restore: a store that goes back to what it was. */
#include "tests/e2e/client.h"
#include "tests/e2e/daemon.h"
#include "tests/store_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static char folder[FOLDER_PATH], store[FOLDER_PATH + 8], file[FOLDER_PATH + 8];
static char output[4096];

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    (void)snprintf(store, sizeof store, "sqlite:%s", folder);
    (void)snprintf(file, sizeof file, "%s.db", folder);
    return 0;
}

static int remove_folder(void **state)
{
    char command[3 * FOLDER_PATH];
    (void)state;
    (void)snprintf(command, sizeof command, "rm -rf '%s'", folder);
    (void)unlink(file);
    return system(command); /* a restore leaves a folder in it */
}

static void expect_run(const char *const *arguments, int status, const char *says)
{
    int ended = daemon_run(arguments, output, sizeof output);
    if (ended != status || strstr(output, says) == NULL) {
        fail_msg("ended with %d: %s", ended, output);
    }
}

static void a_backup_is_made_beside_the_daemon_and_restored_without_it(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--store", store, "--samples"));
    expect_run(ARGUMENTS("--store", store, "--backup", file), 0, "holds 3 meshes");
    client *c = client_new(d);
    reply_done(reply_expect(201, client_post(c, "/v1/meshes?id=more", "{\"shape\":\"cube\"}")));
    client_free(c);
    expect_run(ARGUMENTS("--store", store, "--restore", file), 1, "is in use by process");
    assert_int_equal(daemon_stop(d), 0);
    expect_run(ARGUMENTS("--store", store, "--restore", file), 0, "is restored from");
    expect_run(ARGUMENTS("--store", store, "--backup", file), 0, "holds 3 meshes");
    expect_run(ARGUMENTS("--store", store, "--restore", "/proc/1/none"), 1, "/proc/1/none");
    expect_run(ARGUMENTS("--store", store, "--backup", "/proc/1/none"), 1, "/proc/1/none");
    expect_run(ARGUMENTS("--store", "memory", "--backup", file), 1, "--store sqlite:DIR");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_backup_is_made_beside_the_daemon_and_restored_without_it,
                                        make_folder, remove_folder),
    };
    return cmocka_run_group_tests_name("maintenance", tests, NULL, NULL);
}
