/* The options for maintenance of a store: hedged --backup, --restore, --verify and --dump. */
#include "tests/e2e/client.h"
#include "tests/e2e/daemon.h"
#include "tests/e2e/listener.h"
#include "tests/store_sql.h"

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
    /* rmdir would not do, because the test of --restore leaves a folder in this folder */
    return system(command);
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

static reply back_up(client *c, const char *prefer)
{
    return client_send(c, "POST", "/v1/admin/backup", prefer == NULL ? NULL : ARGUMENTS(prefer),
                       NULL);
}

static void save(const reply *r)
{
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(r->body, 1, r->length, out), r->length);
    assert_int_equal(fclose(out), 0);
}

static void a_backup_is_asked_for_and_fetched(void **state)
{
    (void)state;
    char job[100], result[120], left[FOLDER_PATH + 16];
    daemon_process *d = daemon_start(ARGUMENTS("--store", store, "--samples"));
    client *c = client_new(d);
    reply r = reply_expect(202, back_up(c, NULL));
    (void)reply_header(&r, "Location", job, sizeof job);
    reply_done(r);
    (void)snprintf(result, sizeof result, "%s/events", job);
    listener *l = listener_open(d, result, NULL, 0);
    while (strcmp(listener_next(l, true), "") != 0) {
    }
    listener_close(l);
    r = reply_expect(409, back_up(c, "Prefer: wait=60"));
    assert_string_equal(reply_string(&r, "code"), "backup_kept");
    reply_done(r);
    (void)snprintf(result, sizeof result, "%s/result", job);
    for (int again = 0; again < 2; again++) {
        r = reply_expect(200, client_get(c, result));
        char type[64];
        assert_string_equal(reply_header(&r, "Content-Type", type, sizeof type),
                            "application/vnd.sqlite3");
        save(&r);
        reply_done(r);
        expect_run(ARGUMENTS("--verify", file), 0, "torus");
    }
    (void)snprintf(left, sizeof left, "%s/sent.db", folder);
    assert_int_not_equal(access(left, F_OK), 0);
    reply_done(reply_expect(204, client_send(c, "DELETE", job, NULL, NULL)));
    r = reply_expect(200, back_up(c, "Prefer: wait=60"));
    save(&r);
    reply_done(r);
    expect_run(ARGUMENTS("--verify", file), 0, "torus");
    reply_done(reply_expect(200, back_up(c, "Prefer: wait=60")));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    expect_run(ARGUMENTS("--store", store, "--restore", file), 0, "is restored from");
}

static void assert_glb(const char *name, bool there)
{
    char path[64];
    size_t size = 0;
    (void)snprintf(path, sizeof path, "dump/%s", name);
    unsigned char *bytes = folder_read(folder, path, &size);
    assert_int_equal(bytes != NULL, there);
    assert_true(!there || (size > 100 && memcmp(bytes, "glTF", 4) == 0));
    free(bytes);
}

static void what_is_damaged_is_named_and_the_rest_is_saved(void **state)
{
    (void)state;
    char dump[FOLDER_PATH + 16];
    (void)snprintf(dump, sizeof dump, "%s/dump", folder);
    daemon_process *d = daemon_start(ARGUMENTS("--store", store, "--samples"));
    client *c = client_new(d);
    for (int i = 0; i < 3; i++) {
        reply_done(reply_expect(
            200, client_post(c, "/v1/meshes/cube/edits", "{\"op\":\"edge_split\",\"edge\":0}")));
    }
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/cube/undo", "{}")));
    client_free(c);
    /* The store can be verified and backed up while the daemon runs. */
    expect_run(ARGUMENTS("--store", store, "--verify"), 0, "cube: whole, revision 5");
    assert_non_null(strstr(output, "3 meshes whole, 0 not"));
    expect_run(ARGUMENTS("--store", store, "--backup", file), 0, "holds 3 meshes");
    assert_int_equal(daemon_stop(d), 0);
    expect_run(ARGUMENTS("--verify", file), 0, "3 meshes whole, 0 not");
    expect_run(ARGUMENTS("--store", store, "--dump", dump), 0, "3 meshes written, 0 not");
    assert_glb("cube.glb", true);
    store_sql_run(folder,
                  "DELETE FROM record WHERE mesh = (SELECT key FROM mesh WHERE id = 'cube') "
                  "AND number = 3");
    expect_run(ARGUMENTS("--store", store, "--verify"), 1, "cube: DAMAGED: record 3 is missing");
    assert_non_null(
        strstr(output, "cube: only an earlier state of the mesh is undamaged, revision 2"));
    assert_non_null(strstr(output, "2 meshes whole, 1 not"));
    (void)snprintf(dump, sizeof dump, "%s/dump/cube.glb", folder);
    (void)unlink(dump);
    (void)snprintf(dump, sizeof dump, "%s/dump", folder);
    expect_run(ARGUMENTS("--store", store, "--dump", dump), 1, "2 meshes written, 1 not");
    assert_non_null(strstr(output, "cube: saved as it was at revision 2"));
    assert_glb("cube.glb", false);
    assert_glb("cube.revision-2.glb", true);
    assert_glb("torus.glb", true);
    /* A damaged row has an id that is not a valid mesh id. It must not be used as a file name,
     * because it could name a file outside the folder. */
    store_sql_run(folder, "UPDATE mesh SET id = '../torus' WHERE id = 'torus'");
    expect_run(ARGUMENTS("--store", store, "--dump", dump), 1, "its id cannot be read");
    assert_glb("../torus.glb", false);
    /* The index of the mesh ids is damaged so that it lists no mesh. The verification must still
     * find the meshes in the table. */
    store_sql_run(
        folder, "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = (SELECT rootpage "
                "FROM sqlite_schema WHERE name = 'kept_by_time') "
                "WHERE name = 'sqlite_autoindex_mesh_1'");
    expect_run(ARGUMENTS("--store", store, "--verify"), 1, "the database file itself is damaged");
    assert_non_null(strstr(output, "cube: DAMAGED: record 3 is missing"));
    assert_non_null(strstr(output, "1 meshes whole, 2 not"));
    folder_write(folder, "hedge.db", (const unsigned char *)"nothing", 7);
    expect_run(ARGUMENTS("--store", store, "--verify"), 1, "is damaged");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_backup_is_made_beside_the_daemon_and_restored_without_it,
                                        make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_backup_is_asked_for_and_fetched, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(what_is_damaged_is_named_and_the_rest_is_saved, make_folder,
                                        remove_folder),
    };
    return cmocka_run_group_tests_name("maintenance", tests, NULL, NULL);
}
