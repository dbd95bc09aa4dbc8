/* Tests of the real server, in the process of the test and over real sockets. The test can slow
 * down the journal: answers must wait until what they show is durable, a full job queue and too
 * many connections must give 503, and stopping the server must end everything. */
#include "tests/slow_journal.h"
#include "tests/unit/fixture.h"

#include "api/describe/routes.h"
#include "api/event/event_follow.h"

#include "server/http/http.h"
#include "server/http/http_recv.h"

#include <arpa/inet.h>
#include <errno.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

/* --- the server --- */

enum { CONNECTIONS = 20 };

static bool submit_job(void *pool, const st_task *task)
{
    return st_pool_submit(pool, task);
}

static slow_journal slow;
static st_store *store;
static api_job_table *table;
static api_service *service;
static st_pool *jobs, *makers;
static srv_http *http;
static uint64_t read_seconds = 3600;
static const srv_policy policy;

static int start(void **state)
{
    (void)state;
    jobs = st_pool_new("test", 1, 1);
    makers = st_pool_new("test", 1, 1);
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20,
        .max_meshes = 100,
        .journal = slow_journal_open(&slow),
        .listeners = 10,
        .mesh_listeners = 10,
        .render = api_event_render,
    });
    table = api_job_table_new(&(api_job_table_options){
        .store = store, .submit = submit_job, .pool = jobs, .keep = API_JOB_SECONDS});
    service = api_service_new(store, api_routes(),
                              &(api_options){.version = "test",
                                             .pool = jobs,
                                             .jobs = table,
                                             .address_limits.most[API_LIMIT_REQUESTS] = 1000000,
                                             .limit_burst = 10});
    srv_http_options options = {
        .service = service,
        .store = store,
        .pool = jobs,
        .makers = makers,
        .policy = &policy,
        .deadlines = {.idle = 20,
                      .head = 20,
                      .grace = 20,
                      .total = 20,
                      .min_rate = 1,
                      .max_connections = CONNECTIONS},
        .max_sockets = CONNECTIONS + 4,
        .read_seconds = read_seconds,
        .heartbeat_micros = UINT64_C(3600) * 1000000,
        .workers = 1,
        .listening = -1,
    };
    char message[256];
    assert_true(srv_address_parse("127.0.0.1:0", &options.address));
    http = srv_http_start(&options, message, sizeof message);
    if (http == NULL) {
        fail_msg("%s", message);
    }
    return 0;
}

static int stop(void **state)
{
    (void)state;
    bool stopped = http == NULL || srv_http_stop(http, 20000);
    http = NULL;
    api_job_table_stop(table);
    st_pool_free(jobs);
    api_job_table_free(table);
    st_pool_free(makers);
    api_service_free(service);
    st_store_free(store);
    return stopped ? 0 : -1;
}

/* --- a client --- */

static int connect_client(void)
{
    struct sockaddr_in to = {.sin_family = AF_INET,
                             .sin_port = htons((uint16_t)srv_http_port(http))};
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    assert_true(fd >= 0);
    assert_int_equal(connect(fd, (struct sockaddr *)&to, sizeof to), 0);
    return fd;
}

static void ask(int fd, const char *method, const char *path, const char *body)
{
    char request[1024];
    int length = snprintf(request, sizeof request,
                          "%s %s HTTP/1.1\r\nHost: localhost\r\nContent-Length: %zu\r\n"
                          "Content-Type: application/json\r\n\r\n%s",
                          method, path, strlen(body), body);
    assert_int_equal(send(fd, request, (size_t)length, MSG_NOSIGNAL), length);
}

/* Reads the next answer completely, and returns its HTTP status; `text` receives the answer with
 * its headers. */
static int answer(int fd, char *text, size_t size)
{
    size_t got = 0;
    text[0] = '\0';
    for (;;) {
        char *end = strstr(text, "\r\n\r\n"), *length = strstr(text, "Content-Length: ");
        if (end != NULL && strncmp(text + 9, "204", 3) == 0) {
            break;
        }
        if (end != NULL && length != NULL && length < end) {
            size_t want = (size_t)(end + 4 - text) + strtoul(length + 16, NULL, 10);
            if (got >= want) {
                break;
            }
        }
        ssize_t more = recv(fd, text + got, size - 1 - got, 0);
        if (more <= 0) {
            break;
        }
        got += (size_t)more;
        text[got] = '\0';
    }
    return got < 12 ? 0 : (int)strtol(text + 9, NULL, 10);
}

static int round_trip(const char *method, const char *path, const char *body)
{
    char text[4096];
    int fd = connect_client();
    ask(fd, method, path, body);
    int status = answer(fd, text, sizeof text);
    close(fd);
    return status;
}

/* Requires that no answer arrives on this connection. Meanwhile the server, which has only one
 * worker, answers another request: an answer that may be sent would arrive before that. */
static void assert_held(int fd)
{
    char byte;
    for (int i = 0; i < 30; i++) {
        assert_int_equal(round_trip("GET", "/livez", ""), 200);
        ssize_t got = recv(fd, &byte, 1, MSG_DONTWAIT);
        assert_true(got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK));
    }
}

static void answers_wait_until_what_they_show_is_durable(void **state)
{
    (void)state;
    char text[8192];
    int writer = connect_client(), reader = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    assert_held(writer);
    /* The answer to a read of a state that is not durable must wait, too. */
    ask(reader, "GET", "/v1/meshes/m", "");
    assert_held(reader);
    slow_journal_advance(&slow, 1);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    assert_int_equal(answer(reader, text, sizeof text), 200);

    /* The answer to the second write must wait until the second revision is durable. */
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"tetrahedron\"}");
    slow_journal_wait(&slow, 2);
    assert_held(writer);
    slow_journal_advance(&slow, 1);
    assert_held(writer);
    slow_journal_advance(&slow, 2);
    assert_int_equal(answer(writer, text, sizeof text), 200);
    ask(reader, "GET", "/v1/meshes/m", "");
    assert_int_equal(answer(reader, text, sizeof text), 200);
    assert_non_null(strstr(text, "\"revision\":2"));

    /* A new name makes no new revision, but it can be lost like a revision, so answers must wait
     * until it is durable. */
    ask(writer, "PATCH", "/v1/meshes/m", "{\"name\":\"other\"}");
    slow_journal_wait(&slow, 3);
    assert_held(writer);
    ask(reader, "GET", "/v1/meshes/m", "");
    assert_held(reader);
    slow_journal_advance(&slow, 3);
    assert_int_equal(answer(writer, text, sizeof text), 200);
    assert_int_equal(answer(reader, text, sizeof text), 200);
    ask(writer, "DELETE", "/v1/meshes/m", "");
    slow_journal_wait(&slow, 4);
    assert_held(writer);
    slow_journal_advance(&slow, 4);
    assert_int_equal(answer(writer, text, sizeof text), 204);
    close(writer);
    close(reader);
}

/* Reads from the connection until the bytes read contain `text`. */
static void read_until(int fd, const char *text)
{
    char all[8192];
    size_t length = 0;
    do {
        assert_true(length + 1 < sizeof all);
        ssize_t got = recv(fd, all + length, sizeof all - 1 - length, 0);
        assert_true(got > 0);
        length += (size_t)got;
        all[length] = '\0';
    } while (strstr(all, text) == NULL);
}

/* An answer that shows more than one mesh, such as a list, must wait until everything in it is
 * durable; so must an answer that a mesh does not exist any more. */
static void lists_and_absence_wait_until_durable(void **state)
{
    (void)state;
    static const char undo[] = "POST /v1/meshes/m/undo HTTP/1.1\r\nHost: localhost\r\n"
                               "Content-Length: 0\r\n\r\n";
    enum { LIST, ABSENT, ELEMENT, WRITE, PUT, JOBS, ASKED };
    char text[8192];
    int fds[ASKED], writer = connect_client(), early = connect_client();
    for (int i = 0; i < ASKED; i++) {
        fds[i] = connect_client();
    }
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    ask(early, "GET", "/v1/meshes", "");
    ask(fds[PUT], "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    assert_held(early);
    assert_held(fds[PUT]);
    slow_journal_advance(&slow, 1);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    assert_int_equal(answer(early, text, sizeof text), 200);
    assert_non_null(strstr(text, "\"id\":\"m\""));
    assert_int_equal(answer(fds[PUT], text, sizeof text), 409);

    ask(writer, "DELETE", "/v1/meshes/m", "");
    slow_journal_wait(&slow, 2);
    ask(fds[LIST], "GET", "/v1/meshes", "");
    ask(fds[ABSENT], "GET", "/v1/meshes/m", "");
    ask(fds[ELEMENT], "GET", "/v1/meshes/m/vertices/0", "");
    assert_int_equal(send(fds[WRITE], undo, sizeof undo - 1, MSG_NOSIGNAL), sizeof undo - 1);
    ask(fds[JOBS], "GET", "/v1/jobs", "");
    assert_held(writer);
    for (int i = 0; i < ASKED; i++) {
        if (i != PUT) {
            assert_held(fds[i]);
        }
    }
    /* Answers that show nothing from the store must be sent without waiting for the journal. */
    static const char *const free_of_it[] = {
        "/livez", "/readyz", "/version", "/v1/operations", "/v1/openapi.json", "/problems/stale"};
    for (size_t i = 0; i < sizeof free_of_it / sizeof *free_of_it; i++) {
        assert_true(round_trip("GET", free_of_it[i], "") != 0);
    }
    assert_int_equal(round_trip("GET", "/v1/nothing", ""), 404);
    slow_journal_advance(&slow, 2);
    assert_int_equal(answer(writer, text, sizeof text), 204);
    assert_int_equal(answer(fds[LIST], text, sizeof text), 200);
    assert_non_null(strstr(text, "\"items\":[]"));
    assert_int_equal(answer(fds[ABSENT], text, sizeof text), 404);
    assert_int_equal(answer(fds[ELEMENT], text, sizeof text), 404);
    assert_int_equal(answer(fds[WRITE], text, sizeof text), 404);
    assert_int_equal(answer(fds[JOBS], text, sizeof text), 200);
    for (int i = 0; i < ASKED; i++) {
        close(fds[i]);
    }
    close(writer);
    close(early);
}

/* If no change of a mesh is in progress, the mesh must be readable at once, however many changes of
 * other meshes the journal has not written yet. */
static void an_idle_mesh_never_waits(void **state)
{
    (void)state;
    char text[8192];
    int writer = connect_client(), reader = connect_client();
    ask(writer, "PUT", "/v1/meshes/idle", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    slow_journal_advance(&slow, 1);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 2);
    ask(reader, "GET", "/v1/meshes/idle", "");
    assert_int_equal(answer(reader, text, sizeof text), 200);
    assert_held(writer);
    close(writer);
    close(reader);
    slow_journal_advance(&slow, 2);
}

/* Answers of every kind depend on the state of the mesh, so each must wait until the state is
 * durable: not modified, gone, stale, refused, dry run. */
static void every_kind_of_answer_waits(void **state)
{
    (void)state;
    static const struct {
        const char *method, *path, *body;
        int status;
    } rows[] = {
        {"GET", "/v1/meshes/m/vertices/3", "", 410},
        {"GET", "/v1/meshes/m/vertices/99", "", 404},
        {"POST", "/v1/meshes/m/edits", "{\"op\":\"vertex_add\",\"position\":[0,0,0],\"at\":1}",
         400},
        {"POST", "/v1/meshes/m/edits", "{\"op\":\"edge_flip\",\"edge\":99}", 422},
        {"POST", "/v1/meshes/m/undo", "{\"expected_revision\":9}", 412},
        {"POST", "/v1/meshes/m/edits", "{\"op\":\"append\",\"mesh\":\"other\",\"dry_run\":true}",
         422},
        {"POST", "/v1/meshes/m/edits",
         "{\"op\":\"vertex_add\",\"position\":[0,0,0],\"dry_run\":true}", 200},
    };
    enum { ROWS = sizeof rows / sizeof *rows };
    char text[8192];
    int fds[ROWS], writer = connect_client();
    slow_journal_advance(&slow, 1);
    assert_int_equal(round_trip("PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}"), 201);
    ask(writer, "POST", "/v1/meshes/m/edits", "{\"op\":\"vertex_delete\",\"vertex\":3}");
    slow_journal_wait(&slow, 2);
    for (int i = 0; i < ROWS; i++) {
        fds[i] = connect_client();
        ask(fds[i], rows[i].method, rows[i].path, rows[i].body);
        assert_held(fds[i]);
    }
    slow_journal_advance(&slow, 2);
    assert_int_equal(answer(writer, text, sizeof text), 200);
    for (int i = 0; i < ROWS; i++) {
        assert_int_equal(answer(fds[i], text, sizeof text), rows[i].status);
        close(fds[i]);
    }
    close(writer);
}

/* The journal may report that a change is lost before or after the answer starts to wait: in
 * neither case may the answer say that the request succeeded. */
static void an_answer_that_shows_what_was_lost_is_503(void **state)
{
    (void)state;
    char text[8192];
    int writer = connect_client(), reader = connect_client(), listener = connect_client();
    slow_journal_advance(&slow, 1);
    assert_int_equal(round_trip("PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}"), 201);
    ask(listener, "GET", "/v1/meshes/m/events", "");
    read_until(listener, ".1\n\n");
    ask(writer, "PATCH", "/v1/meshes/m", "{\"name\":\"other\"}");
    slow_journal_wait(&slow, 2);
    ask(reader, "GET", "/v1/meshes/m", "");
    assert_held(reader);
    const st_loss loss = {
        .from = 2, .to = 2, .status = ST_FAILED, .reason = "the disk refused a write"};
    slow_journal_lose(&slow, &loss);
    assert_held(writer);
    slow_journal_advance(&slow, 2);
    assert_int_equal(answer(writer, text, sizeof text), 503);
    assert_non_null(strstr(text, "\"code\":\"store_failed\""));
    assert_non_null(strstr(text, loss.reason));
    assert_non_null(strstr(text, "Retry-After: "));
    /* The client that read the lost state gets 503, so it must repeat its request. Since the
     * journal of this test has kept no state of the mesh, the client then gets 404. */
    assert_int_equal(answer(reader, text, sizeof text), 503);
    assert_non_null(strstr(text, "\"code\":\"store_lost\""));
    assert_non_null(strstr(text, "Retry-After: 0"));
    ask(writer, "GET", "/v1/meshes/m", "");
    assert_int_equal(answer(writer, text, sizeof text), 404);
    /* No listener may receive the event of the lost change. */
    read_until(listener, "\"reason\":\"lost\"");
    assert_int_equal(answer(listener, text, sizeof text), 0);
    assert_null(strstr(text, "other"));
    /* The changes of other meshes than "m" were not lost, so requests about these meshes must
     * succeed. */
    slow_journal_advance(&slow, 3);
    assert_int_equal(round_trip("PUT", "/v1/meshes/n", "{\"shape\":\"cube\"}"), 201);
    assert_int_equal(round_trip("GET", "/v1/meshes/n", ""), 200);
    close(reader);
    close(writer);
    close(listener);
}

static void events_wait_until_what_they_show_is_durable(void **state)
{
    char text[8192];
    int writer = connect_client(), listener = connect_client(), late = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    ask(listener, "GET", "/v1/meshes/m/events", "");
    assert_held(listener); /* no answer yet: the state is not durable */
    slow_journal_advance(&slow, 1);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    read_until(listener, ".1\n\n");
    ask(writer, "PATCH", "/v1/meshes/m", "{\"name\":\"first\"}");
    slow_journal_wait(&slow, 2);
    assert_held(listener);
    /* A second change is made while the event of the first change still waits to be durable. */
    int other = connect_client();
    ask(other, "PATCH", "/v1/meshes/m", "{\"name\":\"second\"}");
    slow_journal_wait(&slow, 3);
    assert_held(listener);
    ask(late, "GET", "/v1/meshes/m/events", "");
    assert_held(late);
    slow_journal_advance(&slow, 2);
    read_until(listener, "\"first\"");
    assert_held(listener);
    slow_journal_advance(&slow, 3);
    read_until(listener, "\"second\"");
    read_until(late, ".1\n\n");
    assert_int_equal(answer(writer, text, sizeof text), 200);
    assert_int_equal(answer(other, text, sizeof text), 200);
    ask(writer, "DELETE", "/v1/meshes/m", "");
    slow_journal_wait(&slow, 4);
    assert_held(listener);
    /* When the server stops, it must not send an event that is not durable. */
    assert_int_equal(stop(state), 0);
    read_until(listener, "\"stopping\"");
    read_until(late, "\"stopping\"");
    close(writer);
    close(other);
    close(listener);
    close(late);
    start(state);
}

/* The server can refuse the request before its body arrives, but it must send the refusal only when
 * the state on which it depends is durable. */
static void early_refusals_wait_until_what_they_show_is_durable(void **state)
{
    (void)state;
    static const char put[] = "PUT /v1/meshes/m HTTP/1.1\r\nHost: localhost\r\n"
                              "Content-Type: application/json\r\nIf-None-Match: *\r\n"
                              "Expect: 100-continue\r\nContent-Length: 1000000\r\n\r\n";
    char text[4096];
    int writer = connect_client(), other = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    assert_int_equal(send(other, put, sizeof put - 1, MSG_NOSIGNAL), sizeof put - 1);
    assert_held(other);
    slow_journal_advance(&slow, 1);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    assert_int_equal(answer(other, text, sizeof text), 412);
    close(writer);
    close(other);
}

static void a_stop_answers_503_to_requests_that_wait(void **state)
{
    char text[8192];
    int writer = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    assert_held(writer);
    assert_int_equal(stop(state), 0);
    assert_int_equal(answer(writer, text, sizeof text), 503);
    assert_non_null(strstr(text, "Retry-After: "));
    assert_non_null(strstr(text, "\"code\":\"not_ready\""));
    close(writer);
    start(state);
}

static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t gate_changed = PTHREAD_COND_INITIALIZER;
static bool gate_entered, gate_open;

static void wait_at_gate(void *context)
{
    (void)context;
    pthread_mutex_lock(&gate);
    gate_entered = true;
    pthread_cond_broadcast(&gate_changed);
    while (!gate_open) {
        pthread_cond_wait(&gate_changed, &gate);
    }
    pthread_mutex_unlock(&gate);
}

/* Blocks the only thread for long work until open_gate() is called. */
static void shut_gate(void)
{
    gate_entered = gate_open = false;
    assert_true(st_pool_submit(jobs, &(st_task){.work = wait_at_gate}));
    pthread_mutex_lock(&gate);
    while (!gate_entered) {
        pthread_cond_wait(&gate_changed, &gate);
    }
    pthread_mutex_unlock(&gate);
}

static void open_gate(void)
{
    pthread_mutex_lock(&gate);
    gate_open = true;
    pthread_cond_broadcast(&gate_changed);
    pthread_mutex_unlock(&gate);
}

static void a_full_queue_is_503_and_keeps_the_connection(void **state)
{
    (void)state;
    slow_journal_advance(&slow, UINT64_MAX);
    shut_gate();
    assert_true(st_pool_submit(jobs, &(st_task){.work = wait_at_gate}));
    assert_false(st_pool_submit(jobs, &(st_task){.work = wait_at_gate}));

    static const char large[] = "{\"shape\":\"icosphere\",\"subdivisions\":6}";
    char text[4096];
    int fd = connect_client();
    ask(fd, "POST", "/v1/meshes", large);
    assert_int_equal(answer(fd, text, sizeof text), 503);
    assert_non_null(strstr(text, "Retry-After: "));
    assert_non_null(strstr(text, "\"code\":\"overloaded\""));
    assert_non_null(strstr(text, "RateLimit-Policy: \"requests\";q=10000000;w=10\r\n"));
    assert_non_null(strstr(text, "RateLimit: \"requests\";r=9999"));

    open_gate();
    /* The connection must still be open after the refusal. The queue may stay full for a moment, so
     * the request is repeated. */
    int status;
    do {
        ask(fd, "POST", "/v1/meshes", large);
        status = answer(fd, text, sizeof text);
    } while (status == 503);
    assert_int_equal(status, 201);
    close(fd);
}

/* Closes a client's socket with a TCP reset. */
static void hang_up(int fd)
{
    const struct linger at_once = {.l_onoff = 1};
    assert_int_equal(setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once), 0);
    close(fd);
}

/* A client disconnects while its answer waits for the journal: a stop of the server must not wait
 * until the journal has made the answer's records durable. */
static void a_stop_does_not_wait_for_a_held_client_that_hung_up(void **state)
{
    int writer = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    slow_journal_wait(&slow, 1);
    assert_held(writer);
    hang_up(writer);
    slow_journal_advance(&slow, 1);
    assert_int_equal(round_trip("GET", "/v1/meshes/m", ""), 200);
    assert_int_equal(stop(state), 0);
    start(state);
}

static void a_stop_does_not_wait_for_work_of_a_client_that_hung_up(void **state)
{
    slow_journal_advance(&slow, UINT64_MAX);
    shut_gate();
    int writer = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"icosphere\",\"subdivisions\":6}");
    assert_held(writer);
    hang_up(writer);
    open_gate();
    assert_int_equal(stop(state), 0);
    start(state);
}

/* If a client disconnects, the work for its request must be cancelled. */
static void work_is_cancelled_when_its_client_hangs_up(void **state)
{
    (void)state;
    static const char large[] = "{\"shape\":\"icosphere\",\"subdivisions\":6}";
    slow_journal_advance(&slow, UINT64_MAX);
    shut_gate();
    int writer = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", large);
    assert_held(writer);
    hang_up(writer);
    open_gate();
    int status;
    do { /* the cancelled work leaves the queue a little later */
        status = round_trip("PUT", "/v1/meshes/n", large);
    } while (status == 503);
    assert_int_equal(status, 201);
    assert_int_equal(round_trip("GET", "/v1/meshes/m", ""), 404);

    /* A client that has closed only its sending side can still receive its answer. The server
     * allows a second for this, so the test uses the shortest request that runs on a thread for
     * long work. */
    char text[8192];
    writer = connect_client();
    ask(writer, "PUT", "/v1/meshes/m", "{\"shape\":\"icosphere\",\"subdivisions\":4}");
    assert_int_equal(shutdown(writer, SHUT_WR), 0);
    assert_int_equal(answer(writer, text, sizeof text), 201);
    close(writer);
}

static void a_read_beyond_its_time_is_refused_and_sent_to_a_job_if_it_can_be_one(void **state)
{
    char text[4096];
    stop(state);
    read_seconds = 0;
    start(state);
    slow_journal_advance(&slow, UINT64_MAX);
    /* The mesh is so large that a read runs on a thread for long work. Such a read must be stopped
     * by the time limit, but imports and edits must not be. */
    int fd = connect_client();
    ask(fd, "PUT", "/v1/meshes/m", "{\"shape\":\"icosphere\",\"subdivisions\":6}");
    assert_int_equal(answer(fd, text, sizeof text), 201);
    ask(fd, "GET", "/v1/meshes/m/check", "");
    assert_int_equal(answer(fd, text, sizeof text), 503);
    assert_non_null(strstr(text, "\"code\":\"read_timeout\""));
    assert_non_null(strstr(text, "Prefer: respond-async"));
    ask(fd, "POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}");
    assert_int_equal(answer(fd, text, sizeof text), 200);
    ask(fd, "GET", "/v1/meshes/m/vertices/0/faces?revision=1", "");
    assert_int_equal(answer(fd, text, sizeof text), 503);
    assert_non_null(strstr(text, "\"code\":\"read_timeout\""));
    assert_null(strstr(text, "respond-async"));
    ask(fd, "GET", "/v1/meshes/m/halfedges/0", "");
    assert_int_equal(answer(fd, text, sizeof text), 200);
    close(fd);
    stop(state);
    read_seconds = 3600;
    start(state);
}

/* Sends a request and closes the sending side so that both arrive in one TCP segment, and the
 * server sees them at once. */
static void send_with_end(int fd, const char *text)
{
    assert_int_equal(send(fd, text, strlen(text), MSG_MORE | MSG_NOSIGNAL), strlen(text));
    assert_int_equal(shutdown(fd, SHUT_WR), 0);
}

static void read_to_end(int fd, char *text, size_t size)
{
    size_t got = 0;
    for (ssize_t more = 1; more > 0 && got<size - 1; got += more> 0 ? (size_t)more : 0) {
        more = recv(fd, text + got, size - 1 - got, 0);
        assert_true(more >= 0);
    }
    text[got] = '\0';
}

static size_t count_of(const char *text, const char *part)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at++) {
        count++;
    }
    return count;
}

#define LIVE "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n"

static void a_client_that_ends_with_its_request_is_answered_and_closed(void **state)
{
    (void)state;
    static const char *const sent[] = {LIVE, LIVE LIVE, LIVE "\r\n"};
    static const size_t answers[] = {1, 2, 1};
    char text[4096];
    for (size_t i = 0; i < sizeof sent / sizeof *sent; i++) {
        int fd = connect_client();
        send_with_end(fd, sent[i]);
        read_to_end(fd, text, sizeof text);
        close(fd);
        assert_int_equal(count_of(text, "HTTP/1.1 200"), answers[i]);
        /* Only the last answer may say that the connection closes. */
        assert_int_equal(count_of(text, "Connection: close"), 1);
        const char *last = text;
        for (const char *at = text; (at = strstr(at, "HTTP/1.1 200")) != NULL; at++) {
            last = at;
        }
        assert_non_null(strstr(last, "Connection: close"));
    }
}

static void too_many_connections_are_503(void **state)
{
    (void)state;
    int fds[CONNECTIONS + 1];
    char text[4096];
    for (int i = 0; i < CONNECTIONS; i++) {
        fds[i] = connect_client();
        ask(fds[i], "GET", "/livez", "");
        assert_int_equal(answer(fds[i], text, sizeof text), 200);
    }
    fds[CONNECTIONS] = connect_client();
    ask(fds[CONNECTIONS], "GET", "/livez", "");
    assert_int_equal(answer(fds[CONNECTIONS], text, sizeof text), 503);
    assert_non_null(strstr(text, "Retry-After: "));
    assert_non_null(strstr(text, "Connection: close"));
    for (int i = 0; i <= CONNECTIONS; i++) {
        close(fds[i]);
    }
    int status;
    do { /* 503 until the server notices that the clients have left */
        status = round_trip("GET", "/livez", "");
    } while (status == 503);
    assert_int_equal(status, 200);
}

/* If a refused request has a small body, the server must skip the body and keep the connection. If
 * the body is large or endless, the server must send the refusal and close the connection. */
static void a_small_refused_body_is_skipped_and_a_large_one_cut_off(void **state)
{
    (void)state;
    enum { LARGE = 8 << 20 };
    static char piece[65536];
    char text[4096];
    int fd = connect_client();
    ask(fd, "POST", "/v1/nothing", "some bytes");
    assert_int_equal(answer(fd, text, sizeof text), 404);
    assert_null(strstr(text, "Connection: close"));
    ask(fd, "GET", "/livez", "");
    assert_int_equal(answer(fd, text, sizeof text), 200);
    close(fd);

    memset(piece, ' ', sizeof piece);
    fd = connect_client();
    static const char chunked[] = "POST /v1/meshes/m/edits HTTP/1.1\r\nHost: localhost\r\n"
                                  "Content-Type: application/json\r\n"
                                  "Transfer-Encoding: chunked\r\n\r\n";
    slow_journal_advance(&slow, UINT64_MAX);
    assert_int_equal(round_trip("PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}"), 201);
    assert_true(send(fd, chunked, sizeof chunked - 1, MSG_NOSIGNAL) > 0);
    for (size_t sent = 0; sent < 4 * (size_t)LARGE; sent += sizeof piece) {
        if (send(fd, "10000\r\n", 7, MSG_NOSIGNAL) < 0 ||
            send(fd, piece, sizeof piece, MSG_NOSIGNAL) < 0 ||
            send(fd, "\r\n", 2, MSG_NOSIGNAL) < 0) {
            break; /* the server has closed the connection */
        }
    }
    assert_int_equal(answer(fd, text, sizeof text), 413);
    assert_non_null(strstr(text, "Connection: close"));
    close(fd);

    fd = connect_client();
    static const char announced[] = "POST /v1/meshes/m/edits HTTP/1.1\r\nHost: localhost\r\n"
                                    "Content-Type: application/json\r\nExpect: 100-continue\r\n"
                                    "Content-Length: 1000000000\r\n\r\n";
    assert_true(send(fd, announced, sizeof announced - 1, MSG_NOSIGNAL) > 0);
    assert_int_equal(answer(fd, text, sizeof text), 413);
    close(fd);
}

/* libmicrohttpd may have read bytes from a socket whose syntax was not checked first: the request
 * must then not be served. */
static void a_request_that_was_not_checked_is_not_served(void **state)
{
    (void)state;
    char text[4096];
    int fd = connect_client();
    ask(fd, "GET", "/livez", "");
    assert_int_equal(answer(fd, text, sizeof text), 200);
    for (int socket = 0; socket < 1024; socket++) {
        srv_recv_forget(socket);
    }
    ask(fd, "GET", "/livez", "");
    assert_int_equal(answer(fd, text, sizeof text), 0);
    close(fd);
    assert_int_equal(round_trip("GET", "/livez", ""), 200);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, start, stop)
    const struct CMUnitTest tests[] = {
        TEST(answers_wait_until_what_they_show_is_durable),
        TEST(early_refusals_wait_until_what_they_show_is_durable),
        TEST(lists_and_absence_wait_until_durable),
        TEST(an_idle_mesh_never_waits),
        TEST(every_kind_of_answer_waits),
        TEST(an_answer_that_shows_what_was_lost_is_503),
        TEST(events_wait_until_what_they_show_is_durable),
        TEST(a_stop_answers_503_to_requests_that_wait),
        TEST(a_stop_does_not_wait_for_a_held_client_that_hung_up),
        TEST(a_stop_does_not_wait_for_work_of_a_client_that_hung_up),
        TEST(work_is_cancelled_when_its_client_hangs_up),
        TEST(a_full_queue_is_503_and_keeps_the_connection),
        TEST(a_client_that_ends_with_its_request_is_answered_and_closed),
        TEST(a_read_beyond_its_time_is_refused_and_sent_to_a_job_if_it_can_be_one),
        TEST(too_many_connections_are_503),
        TEST(a_small_refused_body_is_skipped_and_a_large_one_cut_off),
        TEST(a_request_that_was_not_checked_is_not_served),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
