/* Tests of the log line about a slow request, which divides the request's time into parts: time
 * that passes in one part must be shown for that part. The test moves the clock, so it does not
 * take long itself. */
#include "tests/slow_journal.h"
#include "tests/unit/fixture.h"

#include "api/describe/routes.h"

#include "server/http/http.h"
#include "store/write.h"

#include <arpa/inet.h>
#include <cjson/cJSON.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <sys/socket.h>
#include <unistd.h>

/* --- a clock that the test moves --- */

/* The time by which the test moves the clock, one hour. Even on a busy machine, no part of a
 * request really takes a tenth of an hour. */
static const uint64_t passing = UINT64_C(3600) * 1000000;

typedef enum moment { NEVER, AT_LOCK, AT_WORK, AT_POOL, AT_STORE } moment;

static _Atomic uint64_t passed;
static _Atomic moment armed;
static sem_t reached;

static void pass(void)
{
    atomic_fetch_add(&passed, passing);
}

/* If the server has reached the point that the test stored in `armed`, moves the clock, but only
 * once. */
static void come_to(moment here)
{
    moment expected = here;
    if (atomic_compare_exchange_strong(&armed, &expected, NEVER)) {
        pass();
        sem_post(&reached);
    }
}

uint64_t __real_st_clock_micros(void);
uint64_t __wrap_st_clock_micros(void);
uint64_t __wrap_st_clock_micros(void)
{
    return __real_st_clock_micros() + atomic_load(&passed);
}

bool __real_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until)
{
    const uint64_t before = atomic_load(&passed);
    return __real_st_clock_wait(condition, lock, until < before ? 0 : until - before);
}

int __real_pthread_rwlock_rdlock(pthread_rwlock_t *lock);
int __wrap_pthread_rwlock_rdlock(pthread_rwlock_t *lock);
int __wrap_pthread_rwlock_rdlock(pthread_rwlock_t *lock)
{
    come_to(AT_LOCK);
    return __real_pthread_rwlock_rdlock(lock);
}

api_step __real_api_end(api_exchange *exchange);
api_step __wrap_api_end(api_exchange *exchange);
api_step __wrap_api_end(api_exchange *exchange)
{
    come_to(AT_WORK);
    return __real_api_end(exchange);
}

bool __real_st_pool_submit(st_pool *pool, const st_task *task);
bool __wrap_st_pool_submit(st_pool *pool, const st_task *task);
bool __wrap_st_pool_submit(st_pool *pool, const st_task *task)
{
    come_to(AT_POOL);
    return __real_st_pool_submit(pool, task);
}

bool __real_st_waits_add(st_waits *waits, st_wait *wait);
bool __wrap_st_waits_add(st_waits *waits, st_wait *wait);
bool __wrap_st_waits_add(st_waits *waits, st_wait *wait)
{
    come_to(AT_STORE);
    return __real_st_waits_add(waits, wait);
}

/* --- the server --- */

static slow_journal slow;
static st_store *store;
static api_service *service;
static st_pool *pool, *makers;
static srv_log *log_of_server;
static int log_ends[2];
static srv_http *http;
static const srv_policy policy;

static int start(void **state)
{
    (void)state;
    atomic_store(&armed, NEVER);
    assert_int_equal(sem_init(&reached, 0, 0), 0);
    assert_int_equal(pipe(log_ends), 0);
    log_of_server = srv_log_new(
        log_ends[1], 64,
        &(srv_log_settings){.level = SRV_LEVEL_WARNING, .json = true, .slow_us = passing / 2});
    pool = st_pool_new("test", 1, 1);
    makers = st_pool_new("test", 1, 1);
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20, .max_meshes = 9, .journal = slow_journal_open(&slow)});
    service = api_service_new(store, api_routes(), &(api_options){.version = "test", .pool = pool});
    srv_http_options options = {
        .service = service,
        .store = store,
        .pool = pool,
        .makers = makers,
        .log = log_of_server,
        .policy = &policy,
        .deadlines = {.idle = 1000000,
                      .head = 1000000,
                      .grace = 1000000,
                      .total = 1000000,
                      .max_connections = 8},
        .max_sockets = 12,
        .read_seconds = 1000000,
        .heartbeat_micros = passing * 1000,
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

/* Stops the server and checks its log: the log must have one line, the request must have spent its
 * time in the part named `part`, and all parts must add up to the whole time. */
static void stop_and_find(const char *part)
{
    static const char *const parts[] = {"receive_us", "queue_us", "lock_us",
                                        "work_us",    "store_us", "send_us"};
    char text[4096];
    assert_true(srv_http_stop(http, 20000));
    http = NULL;
    srv_log_free(log_of_server);
    log_of_server = NULL;
    close(log_ends[1]);
    ssize_t got = read(log_ends[0], text, sizeof text - 1);
    assert_true(got > 0);
    text[got] = '\0';
    cJSON *line = cJSON_ParseWithOpts(text, NULL, 1);
    if (line == NULL) {
        fail_msg("the log has not one line, but \"%s\"", text);
    }
    assert_string_equal(cJSON_GetObjectItem(line, "event")->valuestring, "slow");
    double sum = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const double micros = cJSON_GetNumberValue(cJSON_GetObjectItem(line, parts[i]));
        const bool expected = strcmp(parts[i], part) == 0;
        if (expected ? micros < (double)passing : micros > (double)passing / 10) {
            fail_msg("%s of %s is %.0f in %s", parts[i], part, micros, text);
        }
        sum += micros;
    }
    assert_true(sum == cJSON_GetNumberValue(cJSON_GetObjectItem(line, "duration_us")));
    cJSON_Delete(line);
}

static int stop(void **state)
{
    (void)state;
    bool stopped = http == NULL || srv_http_stop(http, 20000);
    http = NULL;
    if (log_of_server != NULL) {
        srv_log_free(log_of_server);
        close(log_ends[1]);
    }
    close(log_ends[0]);
    st_pool_free(pool);
    st_pool_free(makers);
    api_service_free(service);
    st_store_free(store);
    sem_destroy(&reached);
    return stopped ? 0 : -1;
}

/* --- a client --- */

/* Makes the client's receive buffer so small that the server must wait for the client to read a
 * long answer. */
static int connect_client(void)
{
    const int small = 4096;
    struct sockaddr_in to = {.sin_family = AF_INET,
                             .sin_port = htons((uint16_t)srv_http_port(http))};
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    assert_true(fd >= 0);
    assert_int_equal(setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &small, sizeof small), 0);
    assert_int_equal(connect(fd, (struct sockaddr *)&to, sizeof to), 0);
    return fd;
}

static void send_text(int fd, const char *text)
{
    assert_int_equal(send(fd, text, strlen(text), MSG_NOSIGNAL), strlen(text));
}

/* Sends a request with a header that makes the server close the connection after its answer. */
static void ask(int fd, const char *method, const char *path, const char *body)
{
    char request[1024];
    snprintf(request, sizeof request,
             "%s %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: %zu\r\n"
             "Content-Type: application/json\r\n\r\n%s",
             method, path, strlen(body), body);
    send_text(fd, request);
}

/* Reads until the server closes the connection, then closes the client's socket. Returns the number
 * of bytes that were read. */
static size_t read_all(int fd)
{
    static char bytes[1 << 16];
    size_t all = 0;
    ssize_t got;
    while ((got = recv(fd, bytes, sizeof bytes, 0)) > 0) {
        all += (size_t)got;
    }
    assert_int_equal(got, 0);
    close(fd);
    return all;
}

static void read_status(int fd, const char *status)
{
    char start_of_line[13] = "";
    assert_int_equal(recv(fd, start_of_line, 12, MSG_WAITALL), 12);
    assert_string_equal(start_of_line + 9, status);
}

static void put_mesh(const char *body)
{
    slow_journal_advance(&slow, UINT64_MAX);
    int fd = connect_client();
    ask(fd, "PUT", "/v1/meshes/m", body);
    read_status(fd, "201");
    read_all(fd);
}

/* --- one test for each part of the time --- */

/* The server sends 100 Continue when it has read the request's headers and waits for the body. */
static void time_in_which_the_body_arrives_is_to_receive(void **state)
{
    (void)state;
    slow_journal_advance(&slow, UINT64_MAX);
    int fd = connect_client();
    send_text(fd, "PUT /v1/meshes/m HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
                  "Content-Type: application/json\r\nContent-Length: 16\r\n"
                  "Expect: 100-continue\r\n\r\n");
    read_status(fd, "100");
    pass();
    send_text(fd, "{\"shape\":\"cube\"}");
    read_all(fd);
    stop_and_find("receive_us");
}

static void time_before_a_thread_is_free_is_in_the_queue(void **state)
{
    (void)state;
    atomic_store(&armed, AT_POOL);
    /* the mesh is so large that the request runs on a thread for long work */
    put_mesh("{\"shape\":\"icosphere\",\"subdivisions\":5}");
    assert_int_equal(sem_trywait(&reached), 0);
    stop_and_find("queue_us");
}

static void time_in_which_a_writer_holds_the_mesh_is_for_the_lock(void **state)
{
    (void)state;
    st_write w;
    put_mesh("{\"shape\":\"cube\"}");
    st_mesh *mesh = NULL;
    assert_int_equal(st_load(store, "m", &mesh), ST_OK);
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    atomic_store(&armed, AT_LOCK);
    int fd = connect_client();
    ask(fd, "GET", "/v1/meshes/m/vertices/0", "");
    assert_int_equal(sem_wait(&reached), 0);
    st_write_abort(&w);
    read_status(fd, "200");
    read_all(fd);
    st_release(mesh);
    stop_and_find("lock_us");
}

static void time_of_the_handler_is_work(void **state)
{
    (void)state;
    put_mesh("{\"shape\":\"cube\"}");
    atomic_store(&armed, AT_WORK);
    int fd = connect_client();
    ask(fd, "POST", "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":1}");
    read_status(fd, "200");
    read_all(fd);
    assert_int_equal(sem_trywait(&reached), 0);
    stop_and_find("work_us");
}

static void time_until_a_change_is_durable_is_for_the_store(void **state)
{
    (void)state;
    atomic_store(&armed, AT_STORE);
    int fd = connect_client();
    ask(fd, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    assert_int_equal(sem_wait(&reached), 0);
    slow_journal_wait(&slow, 1);
    slow_journal_advance(&slow, 1);
    read_status(fd, "201");
    read_all(fd);
    stop_and_find("store_us");
}

/* The answer is longer than the buffers of both sockets together. */
static void time_in_which_the_client_reads_is_to_send(void **state)
{
    (void)state;
    put_mesh("{\"shape\":\"grid\",\"columns\":99,\"rows\":99}");
    int fd = connect_client();
    ask(fd, "GET", "/v1/meshes/m/vertices?limit=10000", "");
    read_status(fd, "200");
    pass();
    const size_t length = read_all(fd);
    assert_true(length > 700000);
    stop_and_find("send_us");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, start, stop)
    const struct CMUnitTest tests[] = {
        TEST(time_in_which_the_body_arrives_is_to_receive),
        TEST(time_before_a_thread_is_free_is_in_the_queue),
        TEST(time_in_which_a_writer_holds_the_mesh_is_for_the_lock),
        TEST(time_of_the_handler_is_work),
        TEST(time_until_a_change_is_durable_is_for_the_store),
        TEST(time_in_which_the_client_reads_is_to_send),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
