/* Tests of small parts of the server: the thread pool, the files of the web page, and deadlines. */
#include "tests/unit/fixture.h"

#include "server/assets.h"
#include "server/http/http_deadline.h"
#include "server/http/http_recv.h"
#include "server/http/limits.h"
#include "system/clock.h"
#include "system/random.h"
#include "system/thread_pool.h"

#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- the thread pool --- */

enum { JOBS = 100 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int order[JOBS], done;

static void note(void *context)
{
    pthread_mutex_lock(&lock);
    order[done++] = *(const int *)context;
    pthread_mutex_unlock(&lock);
}

static void jobs_run_in_order_and_to_the_end(void **state)
{
    (void)state;
    int numbers[JOBS];
    done = 0;
    st_pool *jobs = st_pool_new("test", 1, JOBS);
    for (int i = 0; i < JOBS; i++) {
        numbers[i] = i;
        assert_true(st_pool_submit(jobs, &(st_task){.work = note, .context = &numbers[i]}));
    }
    st_pool_free(jobs);
    assert_int_equal(done, JOBS);
    for (int i = 0; i < JOBS; i++) {
        assert_int_equal(order[i], i);
    }
}

/* --- the files of the web page --- */

static void write_file(const char *folder, const char *name, const char *content)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(content, file);
    fclose(file);
}

static void remove_files(const char *folder, const char *const *names)
{
    char path[256];
    for (; *names != NULL; names++) {
        snprintf(path, sizeof path, "%s/%s", folder, *names);
        remove(path);
    }
    remove(folder);
}

typedef struct found {
    const char *bytes, *type, *etag;
    size_t length;
    bool immutable;
} found;

static bool find(srv_assets *assets, const char *path, found *f)
{
    const api_asset *asset = srv_assets_find(assets, path);
    if (asset != NULL) {
        *f = (found){
            .type = asset->type, .etag = api_kept_etag(asset->body), .immutable = asset->immutable};
        api_kept_bytes(asset->body, &f->bytes, &f->length);
    }
    return asset != NULL;
}

static void assets_are_found_by_path_but_not_hidden_files_or_links(void **state)
{
    (void)state;
    char folder[] = "/tmp/srv-assets-XXXXXX", inner[64], docs[64], part[96], deep[128], path[128];
    char message[320];
    assert_non_null(mkdtemp(folder));
    snprintf(inner, sizeof inner, "%s/assets", folder);
    assert_int_equal(mkdir(inner, 0700), 0);
    write_file(folder, "index.html", "<p>hello");
    write_file(folder, "docs.html", "<p>docs");
    snprintf(docs, sizeof docs, "%s/docs", folder);
    snprintf(part, sizeof part, "%s/operations", docs);
    snprintf(deep, sizeof deep, "%s/deep", part);
    assert_int_equal(mkdir(docs, 0700), 0);
    assert_int_equal(mkdir(part, 0700), 0);
    assert_int_equal(mkdir(deep, 0700), 0);
    write_file(docs, "operations.html", "<p>list");
    write_file(docs, "index.html", "<p>index");
    write_file(part, "edge_split.html", "<p>split");
    write_file(deep, "page.html", "<p>deep");
    snprintf(path, sizeof path, "%s/secrets", docs);
    assert_int_equal(symlink("..", path), 0);
    write_file(folder, "secret.txt", "no");
    write_file(inner, "app-ABCD1234.js", "1");
    write_file(inner, "style.css", "");
    write_file(inner, "frame.html", "<p>frame");
    write_file(inner, "sub-component.js", "2");
    write_file(inner, ".hidden", "no");
    snprintf(path, sizeof path, "%s/link.txt", inner);
    assert_int_equal(symlink("../secret.txt", path), 0);
    snprintf(path, sizeof path, "%s/fifo", inner);
    assert_int_equal(mkfifo(path, 0600), 0);

    srv_assets *assets = srv_assets_load(folder, message, sizeof message);
    assert_string_equal(message, "");
    found f, g;
    assert_true(find(assets, "/", &f));
    assert_int_equal(f.length, 8);
    assert_memory_equal(f.bytes, "<p>hello", 8);
    assert_string_equal(f.type, "text/html; charset=utf-8");
    assert_false(f.immutable);
    assert_true(find(assets, "/docs", &f));
    assert_memory_equal(f.bytes, "<p>docs", 7);
    assert_true(find(assets, "/docs/operations", &f));
    assert_memory_equal(f.bytes, "<p>list", 7);
    assert_string_equal(f.type, "text/html; charset=utf-8");
    assert_true(find(assets, "/docs/operations/edge_split", &f));
    assert_memory_equal(f.bytes, "<p>split", 8);
    assert_false(f.immutable);
    assert_true(find(assets, "/docs/index", &f));
    assert_true(find(assets, "/assets/app-ABCD1234.js", &g));
    assert_true(g.immutable);
    assert_string_equal(g.type, "text/javascript; charset=utf-8");
    assert_string_not_equal(f.etag, g.etag);
    assert_true(find(assets, "/assets/frame.html", &g));
    assert_string_equal(g.type, "text/html; charset=utf-8");
    assert_false(find(assets, "/assets/frame", &g));
    assert_true(find(assets, "/assets/style.css", &g));
    assert_int_equal(g.length, 0);
    assert_true(find(assets, "/assets/sub-component.js", &g));
    assert_false(g.immutable);
    static const char *const absent[] = {"/index.html",
                                         "/docs.html",
                                         "/docs/operations.html",
                                         "/docs/operations/deep/page",
                                         "/docs/operations/deep",
                                         "/docs/secrets/index",
                                         "/docs/secrets/secret.txt",
                                         "/index",
                                         "/secret.txt",
                                         "/assets/link.txt",
                                         "/assets/.hidden",
                                         "/assets/fifo",
                                         "/assets/",
                                         "/assets/../index.html",
                                         "",
                                         "/assets/../secret.txt",
                                         "/assets//style.css"};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++) {
        assert_false(find(assets, absent[i], &f));
    }
    srv_assets_free(assets);
    static const char *const inside[] = {
        "app-ABCD1234.js", "style.css", "frame.html", "sub-component.js",
        ".hidden",         "link.txt",  "fifo",       NULL};
    static const char *const outside[] = {"index.html", "docs.html", "secret.txt", NULL};
    remove_files(inner, inside);
    remove_files(deep, (const char *const[]){"page.html", NULL});
    remove_files(part, (const char *const[]){"edge_split.html", NULL});
    remove_files(docs, (const char *const[]){"operations.html", "index.html", "secrets", NULL});
    remove_files(folder, outside);

    /* The folder of the web page does not exist any more. The server must show a notice instead of
     * the page, and give the reason in a sentence. */
    assets = srv_assets_load(folder, message, sizeof message);
    assert_true(strlen(message) > 0);
    assert_true(find(assets, "/", &f));
    char text[512];
    snprintf(text, sizeof text, "%.*s", (int)f.length, f.bytes);
    assert_non_null(strstr(text, "make page"));
    srv_assets_free(assets);
    assets = srv_assets_load(NULL, message, sizeof message);
    assert_string_equal(message, "");
    assert_true(find(assets, "/", &f));
    srv_assets_free(assets);
}

/* --- deadlines --- */

#define SECONDS(n) ((uint64_t)(n)*1000000)

static void a_connection_is_late_after_the_limit_of_its_stage(void **state)
{
    (void)state;
    static const srv_deadline_options o = {
        .idle = 30, .head = 10, .grace = 5, .total = 100, .min_rate = 1000};
    static const struct {
        srv_stage stage;
        uint64_t bytes, elapsed;
        bool crowded, late;
    } rows[] = {
        {SRV_STAGE_IDLE, 0, 29, false, false},     {SRV_STAGE_IDLE, 0, 31, false, true},
        {SRV_STAGE_IDLE, 0, 3, true, true},        {SRV_STAGE_IDLE, 0, 1, true, false},
        {SRV_STAGE_HEAD, 0, 9, true, false},       {SRV_STAGE_HEAD, 0, 11, false, true},
        {SRV_STAGE_BODY, 0, 5, false, false},      {SRV_STAGE_BODY, 0, 7, false, true},
        {SRV_STAGE_BODY, 3000, 7, false, false},   {SRV_STAGE_BODY, 44000, 50, false, true},
        {SRV_STAGE_BODY, 46000, 50, false, false}, {SRV_STAGE_BODY, 1 << 30, 101, false, true},
        {SRV_STAGE_WORK, 0, 100000, true, false},  {SRV_STAGE_ANSWER, 0, 100000, true, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_connection c = {0};
        srv_connection_enter(&c, rows[i].stage, SECONDS(1000));
        srv_connection_moved(&c, rows[i].bytes);
        if (srv_connection_is_late(&c, &o, rows[i].crowded,
                                   SECONDS(1000) + SECONDS(rows[i].elapsed)) != rows[i].late) {
            fail_msg("row %zu", i);
        }
    }
    /* A connection may have no record of its deadlines: calls with NULL for the record must not
     * crash. */
    srv_connection_enter(NULL, SRV_STAGE_BODY, 0);
    srv_connection_moved(NULL, 1);
}

static void a_reader_is_stuck_only_if_it_reads_too_slowly(void **state)
{
    (void)state;
    static const srv_deadline_options o = {.grace = 5, .min_rate = 1000};
    srv_connection c = {0};
    assert_false(srv_connection_is_stuck(&c, &o, 100, 0, SECONDS(1)));
    assert_false(srv_connection_is_stuck(&c, &o, 100, 10, SECONDS(5)));
    /* A client that reads 6000 bytes in 5 seconds is fast enough; after that, the measurement of
     * its speed begins again. */
    assert_false(srv_connection_is_stuck(&c, &o, 100, 6000, SECONDS(6)));
    assert_false(srv_connection_is_stuck(&c, &o, 100, 6100, SECONDS(10)));
    assert_true(srv_connection_is_stuck(&c, &o, 100, 7000, SECONDS(11)));
    /* A client that has read everything must not count as slow, however long the server sends
     * nothing. */
    c = (srv_connection){0};
    assert_false(srv_connection_is_stuck(&c, &o, 100, 0, SECONDS(1)));
    assert_false(srv_connection_is_stuck(&c, &o, 0, 0, SECONDS(100)));
    assert_false(srv_connection_is_stuck(&c, &o, 100, 0, SECONDS(200)));
}

/* Connects two sockets and returns the client's socket. `c` becomes the record of the server's
 * socket; the connection has been in its present stage since the time `since`. */
static int connect_pair(srv_connection *c, uint64_t since)
{
    struct sockaddr_in address = {.sin_family = AF_INET};
    socklen_t length = sizeof address;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int listener = socket(AF_INET, SOCK_STREAM, 0), client = socket(AF_INET, SOCK_STREAM, 0);
    assert_int_equal(bind(listener, (struct sockaddr *)&address, length), 0);
    assert_int_equal(listen(listener, 1), 0);
    assert_int_equal(getsockname(listener, (struct sockaddr *)&address, &length), 0);
    assert_int_equal(connect(client, (struct sockaddr *)&address, length), 0);
    *c = (srv_connection){.socket = accept(listener, NULL, NULL)};
    assert_true(c->socket >= 0);
    srv_connection_enter(c, SRV_STAGE_WORK, since);
    close(listener);
    return client;
}

static void a_client_that_closed_its_side_waits_for_a_second(void **state)
{
    (void)state;
    srv_connection c;
    int client = connect_pair(&c, SECONDS(100));
    assert_false(srv_connection_is_left(&c, SECONDS(200)));
    /* The client sends more bytes after its request and then closes its sending side. The server
     * must notice this although it does not read the bytes. */
    assert_int_equal(send(client, "next", 4, MSG_NOSIGNAL), 4);
    assert_int_equal(shutdown(client, SHUT_WR), 0);
    assert_false(srv_connection_is_left(&c, SECONDS(100)));
    assert_false(srv_connection_is_left(&c, SECONDS(100) + SRV_CLOSED_MICROS));
    assert_true(srv_connection_is_left(&c, SECONDS(100) + SRV_CLOSED_MICROS + 1));
    close(client);
    close(c.socket);
}

/* The buffer of a Unix socket holds fewer small messages than the size of their bytes suggests,
 * because the kernel also counts its own data for each message. */
static void a_last_answer_fits_beside_those_not_read_yet(void **state)
{
    (void)state;
    static char answer[4096];
    static const char part[] = "HTTP/1.1 200 OK";
    const int first = SRV_FIRST_SEND_BUFFER;
    int ends[2];
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    assert_int_equal(setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &first, sizeof first), 0);
    size_t parts = 0;
    while (send(ends[0], part, sizeof part, MSG_NOSIGNAL) > 0) {
        parts++;
    }
    srv_connection c = {.socket = ends[0]};
    assert_true(srv_recv_send(&c, answer, sizeof answer));
    for (ssize_t left = (ssize_t)(parts * sizeof part + sizeof answer); left > 0;) {
        char bytes[4096];
        ssize_t got = recv(ends[1], bytes, sizeof bytes, 0);
        assert_true(got > 0);
        left -= got;
    }
    close(ends[0]);
    close(ends[1]);
}

static void a_client_that_was_reset_does_not_wait(void **state)
{
    (void)state;
    srv_connection c;
    const struct linger at_once = {.l_onoff = 1};
    int client = connect_pair(&c, SECONDS(100));
    assert_int_equal(setsockopt(client, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once), 0);
    close(client);
    assert_true(srv_connection_is_left(&c, SECONDS(100)));
    close(c.socket);
    assert_false(srv_connection_is_left(NULL, SECONDS(200)));
}

static void random_ids_are_all_different(void **state)
{
    (void)state;
    enum { IDS = 200, LENGTH = 10 };
    static char ids[IDS][LENGTH + 1];
    for (int i = 0; i < IDS; i++) {
        st_random_id(ids[i], LENGTH);
        assert_int_equal(strlen(ids[i]), LENGTH);
        for (int j = 0; j < i; j++) {
            assert_string_not_equal(ids[i], ids[j]);
        }
    }
    assert_true(st_random() != st_random());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_run_in_order_and_to_the_end),
        cmocka_unit_test(assets_are_found_by_path_but_not_hidden_files_or_links),
        cmocka_unit_test(a_connection_is_late_after_the_limit_of_its_stage),
        cmocka_unit_test(a_reader_is_stuck_only_if_it_reads_too_slowly),
        cmocka_unit_test(a_client_that_closed_its_side_waits_for_a_second),
        cmocka_unit_test(a_last_answer_fits_beside_those_not_read_yet),
        cmocka_unit_test(a_client_that_was_reset_does_not_wait),
        cmocka_unit_test(random_ids_are_all_different),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
