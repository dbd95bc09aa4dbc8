/* Tests of the daemon's log: lines in both formats (text and JSON), levels, and what happens if no
 * process reads the pipe to which the log is written. */
#include "tests/unit/fixture.h"

#include "server/log/log.h"
#include "system/memory.h"
#include "tests/failing.h"

#include <cjson/cJSON.h>
#include <pthread.h>
#include <unistd.h>

enum { RING = 64, SAID = 1 << 20 };

static const srv_access sample = {
    .time = 1714564800.25,
    .request_id = "r-1",
    .method = "GET",
    .path = "/a\"b\\c\x01\xe9",
    .route = "/v1/meshes/{mesh}",
    .status = 200,
    .bytes_in = 1,
    .bytes_out = 22,
    .duration_us = 5333,
    .parts = {1, 20, 300, 4000, 12, 1000},
    .peer = "::1",
};

static void a_request_is_one_line_of_json(void **state)
{
    (void)state;
    char line[SRV_ACCESS_LINE];
    size_t length = srv_access_format(&sample, true, line);
    assert_string_equal(line, "{\"time\":\"2024-05-01T12:00:00.250Z\",\"level\":\"info\","
                              "\"event\":\"request\",\"request_id\":\"r-1\",\"method\":\"GET\","
                              "\"path\":\"/a\\u0022b\\u005cc\\u0001\\u00e9\","
                              "\"route\":\"/v1/meshes/{mesh}\",\"status\":200,\"bytes_in\":1,"
                              "\"bytes_out\":22,\"duration_us\":5333,\"peer\":\"::1\"}\n");
    assert_int_equal(length, strlen(line));
}

static void a_request_is_one_readable_line(void **state)
{
    (void)state;
    char line[SRV_ACCESS_LINE];
    size_t length = srv_access_format(&sample, false, line);
    assert_string_equal(line, "2024-05-01T12:00:00.250Z info ::1 GET "
                              "/a\\u0022b\\u005cc\\u0001\\u00e9 200 in=1 out=22 5.333ms id=r-1\n");
    assert_int_equal(length, strlen(line));
}

static void a_slow_request_says_where_the_time_went(void **state)
{
    (void)state;
    char line[SRV_ACCESS_LINE];
    srv_access_format_slow(&sample, true, line);
    assert_non_null(strstr(line, "\"level\":\"warning\",\"event\":\"slow\""));
    assert_non_null(strstr(line, "\"duration_us\":5333,\"receive_us\":1,\"queue_us\":20,"
                                 "\"lock_us\":300,\"work_us\":4000,\"store_us\":12,"
                                 "\"send_us\":1000}\n"));
    srv_access_format_slow(&sample, false, line);
    assert_non_null(strstr(line, " warning slow: ::1 GET "));
    assert_non_null(strstr(line, " 5.333ms: receive 0.001 queue 0.020 lock 0.300 work 4.000 store "
                                 "0.012 send 1.000 id=r-1\n"));
}

static void a_trace_is_in_each_line(void **state)
{
    (void)state;
    char line[SRV_ACCESS_LINE];
    srv_access traced = sample;
    snprintf(traced.trace_id, sizeof traced.trace_id, "%s", "4bf92f3577b34da6a3ce929d0e0e4736");
    snprintf(traced.span_id, sizeof traced.span_id, "%s", "0123456789abcdef");
    srv_access_format(&traced, true, line);
    assert_non_null(strstr(line, ",\"trace_id\":\"4bf92f3577b34da6a3ce929d0e0e4736\","
                                 "\"span_id\":\"0123456789abcdef\"}\n"));
    snprintf(traced.parent_id, sizeof traced.parent_id, "%s", "00f067aa0ba902b7");
    srv_access_format(&traced, true, line);
    assert_non_null(strstr(line, ",\"parent_id\":\"00f067aa0ba902b7\","));
    srv_access_format(&traced, false, line);
    assert_non_null(strstr(line, " trace=4bf92f3577b34da6a3ce929d0e0e4736/00f067aa0ba902b7/"
                                 "0123456789abcdef\n"));
}

/* Every field has its maximum length, and every character of the path must be escaped. */
static void the_longest_line_fits(void **state)
{
    (void)state;
    char line[SRV_ACCESS_LINE];
    srv_access longest = sample;
    memset(longest.path, 1, sizeof longest.path - 1);
    memset(longest.request_id, 'x', SRV_REQUEST_ID);
    memset(longest.method, 'M', SRV_METHOD);
    memset(longest.peer, 'p', SRV_PEER - 1);
    memset(longest.trace_id, 'a', SRV_TRACE_ID);
    memset(longest.parent_id, 'b', SRV_SPAN_ID);
    memset(longest.span_id, 'c', SRV_SPAN_ID);
    longest.bytes_in = longest.bytes_out = longest.duration_us = INT64_MAX;
    for (size_t i = 0; i < SRV_PARTS; i++) {
        longest.parts[i] = INT64_MAX;
    }
    longest.route = "/v1/meshes/{mesh}/attributes/{domain}/{attribute}/values/{something}";
    for (int json = 0; json < 2; json++) {
        size_t length = srv_access_format(&longest, json == 1, line);
        assert_true(length < SRV_ACCESS_LINE && length == strlen(line));
        assert_int_equal(line[length - 1], '\n');
        length = srv_access_format_slow(&longest, json == 1, line);
        assert_true(length < SRV_ACCESS_LINE && length == strlen(line));
        assert_int_equal(line[length - 1], '\n');
    }
    longest.route = NULL;
    srv_access_format(&longest, true, line);
    assert_non_null(strstr(line, "\"route\":\"-\""));
}

/* --- a log that the test reads --- */

typedef struct reader {
    int ends[2];
    srv_log *log;
    char *said;
} reader;

static void open_log(reader *r, const srv_log_settings *settings, size_t ring)
{
    assert_int_equal(pipe(r->ends), 0);
    r->log = srv_log_new(r->ends[1], ring, settings);
    assert_non_null(r->log);
}

/* Frees the log, and returns all text that was written to it. */
static const char *close_log(reader *r)
{
    size_t got = 0;
    r->said = malloc(SAID);
    assert_non_null(r->said);
    srv_log_free(r->log);
    close(r->ends[1]);
    for (ssize_t more; (more = read(r->ends[0], r->said + got, SAID - 1 - got)) > 0;) {
        got += (size_t)more;
    }
    r->said[got] = '\0';
    close(r->ends[0]);
    return r->said;
}

static void say_much(srv_log *log)
{
    srv_line line;
    srv_log_tell(log, SRV_LEVEL_ERROR, "an error: %s", "a\"b\n\xff\xc3\xa9");
    srv_log_tell(log, SRV_LEVEL_WARNING, "a warning");
    srv_log_tell(log, SRV_LEVEL_INFO, "an info");
    srv_log_tell(log, SRV_LEVEL_DEBUG, "a detail");
    srv_log_begin(log, &line, SRV_LEVEL_INFO, "fields");
    srv_line_text(&line, "name", "two words");
    srv_line_number(&line, "count", 7);
    srv_line_open(&line, "inner");
    srv_line_text(&line, "empty", "");
    srv_line_close(&line);
    srv_log_end(log, &line);
    srv_log_plain(log, "listening on %s", "URL");
    srv_log_request(log, &sample, false);
}

static void every_line_of_json_is_an_object_but_the_plain_one(void **state)
{
    (void)state;
    reader r;
    open_log(&r, &(srv_log_settings){.level = SRV_LEVEL_DEBUG, .json = true, .requests = true},
             RING);
    say_much(r.log);
    (void)close_log(&r);
    int objects = 0, plain = 0;
    for (char *line = r.said, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        cJSON *json = cJSON_ParseWithOpts(line, NULL, 1);
        objects += cJSON_IsObject(json) != 0;
        plain += json == NULL;
        if (json != NULL) {
            assert_non_null(cJSON_GetObjectItem(json, "time"));
            assert_non_null(cJSON_GetObjectItem(json, "level"));
            assert_true(cJSON_HasObjectItem(json, "message") || cJSON_HasObjectItem(json, "event"));
        } else {
            assert_string_equal(line, "listening on URL");
        }
        if (json != NULL && cJSON_HasObjectItem(json, "count")) {
            const cJSON *inner = cJSON_GetObjectItem(json, "inner");
            assert_string_equal(cJSON_GetObjectItem(json, "name")->valuestring, "two words");
            assert_int_equal(cJSON_GetObjectItem(json, "count")->valueint, 7);
            assert_string_equal(cJSON_GetObjectItem(inner, "empty")->valuestring, "");
        }
        cJSON_Delete(json);
    }
    assert_int_equal(objects, 6);
    assert_int_equal(plain, 1);
    free(r.said);
}

static void text_has_one_readable_line_each(void **state)
{
    (void)state;
    reader r;
    open_log(&r, &(srv_log_settings){.level = SRV_LEVEL_INFO}, RING);
    say_much(r.log);
    const char *said = close_log(&r);
    assert_non_null(strstr(said, "Z error an error: a\"b\\x0a\\xff\xc3\xa9\n"));
    assert_non_null(strstr(said, "Z warning a warning\n"));
    assert_non_null(strstr(said, "Z info fields name=\"two words\" count=7 empty=\"\"\n"));
    assert_non_null(strstr(said, "\nlistening on URL\n"));
    assert_null(strstr(said, "a detail"));
    assert_null(strstr(said, "/a"));
    free(r.said);
}

static void a_level_leaves_out_what_is_below_it(void **state)
{
    (void)state;
    static const char *const words[] = {"an error", "a warning", "an info", "a detail"};
    for (int level = 0; level < 4; level++) {
        reader r;
        open_log(&r, &(srv_log_settings){.level = (srv_level)level, .json = true}, RING);
        say_much(r.log);
        const char *said = close_log(&r);
        for (int i = 0; i < 4; i++) {
            assert_int_equal(strstr(said, words[i]) != NULL, i <= level);
        }
        free(r.said);
    }
}

static void what_is_set_later_holds_for_later_lines(void **state)
{
    (void)state;
    reader r;
    open_log(&r, &(srv_log_settings){.level = SRV_LEVEL_ERROR}, RING);
    srv_log_tell(r.log, SRV_LEVEL_DEBUG, "before");
    srv_log_set(r.log, &(srv_log_settings){.level = SRV_LEVEL_DEBUG, .json = true, .slow_us = 9});
    assert_int_equal(srv_log_get(r.log).slow_us, 9);
    srv_log_tell(r.log, SRV_LEVEL_DEBUG, "after");
    srv_log_request(r.log, &sample, false);
    srv_log_request(r.log, &sample, true);
    const char *said = close_log(&r);
    assert_null(strstr(said, "before"));
    assert_non_null(strstr(said, "\"message\":\"after\""));
    assert_non_null(strstr(said, "\"event\":\"slow\""));
    assert_null(strstr(said, "\"event\":\"request\""));
    free(r.said);
}

static void lines_come_in_the_order_in_which_they_were_said(void **state)
{
    (void)state;
    reader r;
    srv_access numbered = sample;
    open_log(&r, &(srv_log_settings){.level = SRV_LEVEL_INFO, .requests = true}, RING);
    for (int i = 0; i < 20; i++) {
        snprintf(numbered.path, sizeof numbered.path, "/number-%d.", 2 * i);
        srv_log_request(r.log, &numbered, false);
        srv_log_tell(r.log, SRV_LEVEL_INFO, "/number-%d.", 2 * i + 1);
    }
    const char *at = close_log(&r);
    for (int i = 0; i < 40; i++) {
        char word[32];
        snprintf(word, sizeof word, "/number-%d", i);
        at = strstr(at, word);
        assert_non_null(at);
    }
    free(r.said);
}

/* --- a log that is read late or never --- */

static void *free_log(void *log)
{
    srv_log_free(log);
    return NULL;
}

/* The log is not read until its ring buffer has overflowed. After that, the number of lines that
 * are read and the number of dropped lines that the log reports must add up to the number of lines
 * written. */
static void lines_that_find_no_place_are_counted(void **state)
{
    (void)state;
    enum { RECORDS = 5000, SMALL = 4 };
    static char text[4 << 20];
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    srv_log *log =
        srv_log_new(ends[1], SMALL,
                    &(srv_log_settings){.level = SRV_LEVEL_INFO, .json = true, .requests = true});
    for (int i = 0; i < RECORDS; i++) {
        if (i % 10 == 0) {
            srv_log_tell(log, SRV_LEVEL_INFO, "number %d", i);
        } else {
            srv_log_request(log, &sample, false);
        }
    }
    /* Before the log is freed, its writing thread must end, and this thread waits for space in the
     * pipe. Therefore another thread frees the log while the test reads the pipe. */
    pthread_t thread;
    const uint64_t counted = srv_log_dropped(log);
    assert_int_equal(pthread_create(&thread, NULL, free_log, log), 0);
    size_t got = 0;
    unsigned long lines = 0, dropped = 0;
    while (lines + dropped < RECORDS) {
        ssize_t more = read(ends[0], text + got, sizeof text - 1 - got);
        assert_true(more > 0);
        got += (size_t)more;
        text[got] = '\0';
        lines = dropped = 0;
        for (char *line = text, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
            char *drop = strstr(line, "\"dropped\":");
            if (drop != NULL && drop < end) {
                dropped += strtoul(drop + 10, NULL, 10);
            } else {
                lines++;
            }
        }
    }
    pthread_join(thread, NULL);
    assert_int_equal(lines + dropped, RECORDS);
    assert_int_equal(counted, dropped);
    assert_true(lines >= 1);
    assert_non_null(strstr(text, "\"level\":\"warning\",\"event\":\"dropped\""));
    close(ends[0]);
    close(ends[1]);
}

/* The pipe of the log is never read: the daemon must be able to end nevertheless. */
static void a_log_ends_without_a_reader(void **state)
{
    (void)state;
    enum { RECORDS = 4000 };
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    srv_log *log = srv_log_new(ends[1], RECORDS,
                               &(srv_log_settings){.level = SRV_LEVEL_INFO, .requests = true});
    for (int i = 0; i < RECORDS; i++) {
        srv_log_request(log, &sample, false);
    }
    srv_log_free(log);
    close(ends[0]);
    close(ends[1]);
}

/* Returns the bytes of the log's ring buffer in a daemon with this memory budget. */
static uint64_t ring_bytes(uint64_t budget)
{
    const uint64_t before = st_memory_used();
    srv_log *log = srv_log_new(STDERR_FILENO, srv_log_capacity(budget), &(srv_log_settings){0});
    assert_non_null(log);
    const uint64_t bytes = st_memory_used() - before;
    srv_log_free(log);
    return bytes;
}

static void the_ring_takes_little_of_a_small_budget(void **state)
{
    (void)state;
    enum { MIB = 1 << 20 };
    st_memory_install(0);
    assert_in_range(ring_bytes(1), 1, 256 * 1024);
    assert_in_range(ring_bytes(16 * MIB), 200 * 1024, 260 * 1024);
    assert_in_range(ring_bytes(64 * MIB), MIB - MIB / 16, MIB + 4096);
    assert_int_equal(ring_bytes(0), ring_bytes((uint64_t)MIB * MIB));
    assert_in_range(ring_bytes(0), 4 * MIB, 6 * MIB);
    he_mem_set_hook(NULL);
}

static void a_log_without_memory_is_none(void **state)
{
    (void)state;
    failing f = {0};
    while (f.n < 2 && failing_next(&f)) {
        srv_log *log = srv_log_new(STDERR_FILENO, 4, &(srv_log_settings){.json = true});
        assert_false(failing_end(&f, log != NULL));
    }
}

static void a_program_without_a_log_says_one_line(void **state)
{
    (void)state;
    char text[512];
    for (int json = 0; json < 2; json++) {
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        srv_line_write(ends[1], json == 1, SRV_LEVEL_ERROR, "no \"such\" option");
        ssize_t got = read(ends[0], text, sizeof text - 1);
        assert_true(got > 0);
        text[got] = '\0';
        assert_non_null(strstr(text, json == 1 ? "\"message\":\"no \\\"such\\\" option\"}\n"
                                               : "Z error no \"such\" option\n"));
        close(ends[0]);
        close(ends[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_request_is_one_line_of_json),
        cmocka_unit_test(a_request_is_one_readable_line),
        cmocka_unit_test(a_slow_request_says_where_the_time_went),
        cmocka_unit_test(a_trace_is_in_each_line),
        cmocka_unit_test(the_longest_line_fits),
        cmocka_unit_test(every_line_of_json_is_an_object_but_the_plain_one),
        cmocka_unit_test(text_has_one_readable_line_each),
        cmocka_unit_test(a_level_leaves_out_what_is_below_it),
        cmocka_unit_test(what_is_set_later_holds_for_later_lines),
        cmocka_unit_test(lines_come_in_the_order_in_which_they_were_said),
        cmocka_unit_test(lines_that_find_no_place_are_counted),
        cmocka_unit_test(a_log_ends_without_a_reader),
        cmocka_unit_test(the_ring_takes_little_of_a_small_budget),
        cmocka_unit_test(a_log_without_memory_is_none),
        cmocka_unit_test(a_program_without_a_log_says_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
