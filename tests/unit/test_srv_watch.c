/* Tests of what the daemon's main thread reports to systemd about the disk: the test makes the disk
 * full and makes it fail. */
#include "tests/disk.h"
#include "tests/store_folder.h"
#include "tests/unit/fixture.h"

#include "server/boot/watch.h"

#include <fcntl.h>
#include <sched.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define URL "http://127.0.0.1:1"

/* Opens a socket that receives the messages for systemd. The name of the socket is in the abstract
 * namespace of Linux, not in the file system. */
static int be_systemd(void)
{
    struct sockaddr_un own = {.sun_family = AF_UNIX};
    char name[64];
    const int length = snprintf(name, sizeof name, "@hedge-watch-%d", (int)getpid());
    memcpy(own.sun_path, name, (size_t)length);
    own.sun_path[0] = '\0';
    int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    assert_true(fd >= 0);
    assert_int_equal(bind(fd, (struct sockaddr *)&own,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + (size_t)length)),
                     0);
    setenv("NOTIFY_SOCKET", name, 1);
    return fd;
}

/* Calls srv_watch_look once. Requires that it sends `expected` to systemd or, if `expected` is
 * NULL, that it sends nothing. */
static void look_and_expect(srv_watch *watch, srv_parts *parts, int fd, const char *expected)
{
    char text[512];
    srv_watch_look(watch, parts);
    const ssize_t length = recv(fd, text, sizeof text - 1, 0);
    text[length < 0 ? 0 : length] = '\0';
    assert_string_equal(text, expected == NULL ? "" : expected);
}

/* Tries to create a mesh, so that the store writes to the disk. */
static void create(st_store *store, const char *id)
{
    st_mesh *mesh = NULL;
    he_mesh *content = fixture_mesh("012");
    if (st_create(store, id, "", content, NULL, &mesh) == ST_OK) {
        st_release(mesh);
    } else {
        he_mesh_free(content);
    }
}

static void wait_until(st_store *store, st_status status)
{
    st_health health = {.status = ST_ABSENT};
    for (; health.status != status; sched_yield()) {
        st_store_health(store, &health);
    }
}

static void systemd_is_told_how_the_disk_is(void **state)
{
    (void)state;
    char folder[FOLDER_PATH], place[FOLDER_PATH + 8];
    st_sqlite_opened out;
    folder_make(folder);
    snprintf(place, sizeof place, "sqlite:%s", folder);
    assert_true(st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = "test"}, &out));
    st_store *store = st_store_new(
        &(st_store_options){.undo_budget = 1 << 20, .max_meshes = 10, .journal = out.journal});
    const srv_config config = {.store = place};
    const int silent = open("/dev/null", O_WRONLY);
    assert_true(silent >= 0);
    srv_parts parts = {.config = &config, .store = store, .url = URL};
    parts.log = srv_log_new(silent, 16, &(srv_log_settings){.level = SRV_LEVEL_ERROR});
    srv_watch watch = {.health.status = ST_OK};
    const int fd = be_systemd();

    create(store, "a");
    look_and_expect(&watch, &parts, fd, NULL);
    disk_fill(true);
    create(store, "b");
    wait_until(store, ST_FULL);
    look_and_expect(&watch, &parts, fd,
                    "STATUS=listening on " URL "; the disk is full, and changes are refused");
    look_and_expect(&watch, &parts, fd, NULL);
    disk_fill(false);
    wait_until(store, ST_OK);
    look_and_expect(&watch, &parts, fd, "STATUS=listening on " URL);
    disk_fail_at(1);
    create(store, "c");
    wait_until(store, ST_FAILED);
    look_and_expect(&watch, &parts, fd,
                    "STATUS=listening on " URL "; the disk failed, and changes are refused");
    disk_fail_at(0);

    unsetenv("NOTIFY_SOCKET");
    close(fd);
    srv_log_free(parts.log);
    close(silent);
    st_store_free(store);
    folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(systemd_is_told_how_the_disk_is)};
    disk_install();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
