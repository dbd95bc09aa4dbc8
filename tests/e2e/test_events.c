/* Event streams of a real daemon. A copy of a mesh must stay equal to the mesh through ten thousand
 * edits and broken connections; and there are slow and dead clients, a thousand listeners, and a
 * stop of the daemon.
 *
 * The environment gives EDITS (default 2000, fewer under a sanitizer; make proof takes 10000) and
 * SEED (default: from the clock). */
#include "tests/e2e/client.h"
#include "tests/e2e/listener.h"
#include "tests/mirror.h"
#include "tests/random_edit.h"
#include "tests/sanitized.h"

#include "op/op.h"
#include "system/clock.h"
#include "tests/seed.h"

#include <dirent.h>
#include <inttypes.h>
#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#define EVENTS "/v1/meshes/m/events"

static void put_mesh(client *c, const char *body)
{
    reply r = client_send(c, "PUT", "/v1/meshes/m", NULL, body);
    assert_true(r.status == 200 || r.status == 201);
    reply_free(&r);
}

/* Sends an edit; returns the revision that the edit made, 0 if it was refused. */
static uint64_t post(client *c, const char *path, const char *json)
{
    /* Some random edits take so long that they become a job, for whose end the daemon then waits.
     */
    static const char *const lines[] = {"Content-Type: application/json", "Prefer: wait=60", NULL};
    reply r = client_send(c, "POST", path, lines, json);
    uint64_t revision = r.status == 200 ? (uint64_t)reply_number(&r, "revision") : 0;
    /* Some operations are often refused, and that is expected: random names of materials are drawn
     * from five names, so an edit names one that is missing or that exists already; the random
     * corners of a box of select are in the wrong order; remesh and smooth get numbers that do not
     * fit together. */
    static const char *const often[] = {"\"material_", "\"select\"", "\"segment\"",
                                        "\"remesh\"",  "\"smooth\"", "\"deform\""};
    bool refused = r.status == 422 || r.status == 409;
    for (size_t i = 0; i < sizeof often / sizeof *often; i++) {
        refused |= r.status == 400 && strstr(r.body, "\"bad_value\"") != NULL &&
                   strstr(json, often[i]) != NULL;
    }
    if (r.status != 200 && !refused) {
        fail_msg("%s: %ld %s", json, r.status, r.body);
    }
    reply_free(&r);
    return revision;
}

/* --- reading a whole mesh --- */

static void dump_kind(client *c, mirror *m, he_kind kind)
{
    static const char *const lines[] = {"Accept: application/x-ndjson", NULL};
    char target[64];
    (void)snprintf(target, sizeof target, "/v1/meshes/m/%s", he_kind_plural(kind));
    reply r = client_send(c, "GET", target, lines, NULL);
    assert_int_equal(r.status, 200);
    bool ended = false;
    char *rest = NULL;
    for (char *line = strtok_r(r.body, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        cJSON *element = cJSON_Parse(line);
        assert_non_null(element);
        ended = cJSON_GetObjectItem(element, "end") != NULL;
        if (!ended) {
            mirror_add_line(m, kind, element);
        }
        cJSON_Delete(element);
    }
    assert_true(ended);
    reply_free(&r);
}

static cJSON *parsed(client *c, const char *target)
{
    reply r = client_get(c, target);
    assert_int_equal(r.status, 200);
    cJSON *json = cJSON_Parse(r.body);
    assert_non_null(json);
    reply_free(&r);
    return json;
}

/* Reads all attributes with their values, page by page, and all materials. */
static void dump_values(client *c, mirror *m)
{
    cJSON *list = parsed(c, "/v1/meshes/m/attributes"), *attribute;
    cJSON_ArrayForEach(attribute, cJSON_GetObjectItem(list, "attributes"))
    {
        const char *domain = cJSON_GetObjectItem(attribute, "domain")->valuestring;
        const char *name = cJSON_GetObjectItem(attribute, "name")->valuestring;
        char target[400], cursor[200] = "";
        he_kind kind = HE_VERTEX;
        while (strcmp(he_kind_plural(kind), domain) != 0) {
            kind++;
        }
        mirror_add_attribute(m, attribute);
        for (bool more = true; more;) {
            (void)snprintf(target, sizeof target, "/v1/meshes/m/attributes/%s/%s?limit=500%s",
                           domain, name, cursor);
            cJSON *page = parsed(c, target), *next = cJSON_GetObjectItem(page, "next");
            mirror_add_values(m, kind, name, page);
            more = cJSON_IsString(next);
            if (more) {
                (void)snprintf(cursor, sizeof cursor, "&cursor=%s", next->valuestring);
            }
            cJSON_Delete(page);
        }
    }
    cJSON_Delete(list);
    list = parsed(c, "/v1/meshes/m/materials");
    mirror_set_materials(m, cJSON_GetObjectItem(list, "materials"));
    cJSON_Delete(list);
}

/* Reads the whole mesh into a new copy, while no client edits the mesh. */
static void dump(client *c, mirror *m)
{
    mirror_clear(m);
    reply r = client_get(c, "/v1/meshes/m");
    assert_int_equal(r.status, 200);
    m->revision = (uint64_t)reply_number(&r, "revision");
    reply_free(&r);
    dump_kind(c, m, HE_VERTEX);
    dump_kind(c, m, HE_HALFEDGE);
    dump_kind(c, m, HE_FACE);
    dump_values(c, m);
}

static void require_equal(client *c, const mirror *copy)
{
    char text[MIRROR_TEXT] = "";
    mirror fresh = {0};
    dump(c, &fresh);
    assert_int_equal(copy->revision, fresh.revision);
    if (!mirror_equal(copy, &fresh, text)) {
        fail_msg("at revision %" PRIu64 " the copy differs at %s", copy->revision, text);
    }
    mirror_clear(&fresh);
}

/* --- a copy that follows the events --- */

typedef struct copy {
    const daemon_process *daemon;
    client *client;
    listener *listener;
    mirror mesh;
    unsigned applied, anew, cuts;
} copy;

static void take(copy *c, const char *name)
{
    bool lost = strcmp(name, "resync") == 0;
    if (strcmp(name, "edit") == 0) {
        mirror_step step = mirror_apply(&c->mesh, c->listener->data);
        lost = step == MIRROR_LOST;
        c->applied += step == MIRROR_APPLIED;
    }
    if (lost) {
        dump(c->client, &c->mesh);
        c->anew++;
    }
}

static void follow_to(copy *c, uint64_t revision)
{
    while (c->mesh.revision < revision) {
        take(c, listener_next(c->listener, true));
    }
}

static void cut(copy *c)
{
    char id[64];
    (void)snprintf(id, sizeof id, "%s", c->listener->events.id);
    listener_close(c->listener);
    c->listener = listener_open(c->daemon, EVENTS, id, 0);
    assert_int_equal(c->listener->status, 200);
    c->cuts++;
}

#define GRID "{\"shape\":\"grid\",\"columns\":8,\"rows\":8}"

static uint64_t random_request(copy *c, md_random *r)
{
    char text[8 * RANDOM_EDIT_TEXT];
    size_t rows = he_op_count(), faces = mirror_count(&c->mesh, HE_FACE);
    if (faces == 0 || faces > 400) {
        put_mesh(c->client, GRID);
        return c->mesh.revision + 1;
    }
    if (md_chance(r, 10)) {
        return post(c->client, "/v1/meshes/m/undo", "{}");
    }
    if (md_chance(r, 10)) {
        return post(c->client, "/v1/meshes/m/redo", "{}");
    }
    size_t length = 0, count = md_chance(r, 20) ? md_from(r, 2, 6) : 1;
    if (count > 1) {
        length = (size_t)snprintf(text, sizeof text, "{\"ops\":[");
    }
    for (size_t i = 0; i < count; i++) {
        random_edit(r, &c->mesh, md_below(r, (uint32_t)rows), text + length);
        length = strlen(text);
        text[length++] = i + 1 < count ? ',' : ']';
    }
    text[count > 1 ? length++ : length - 1] = count > 1 ? '}' : '\0';
    text[length] = '\0';
    return post(c->client, "/v1/meshes/m/edits", text);
}

static void a_copy_stays_equal_through_random_edits(void **state)
{
    (void)state;
    uint64_t edits = seed_setting("EDITS", SANITIZED ? 600 : 2000), done = 0, asked = 0, last = 1;
    md_random random = {seed_setting("SEED", (uint64_t)time(NULL))};
    printf("note: SEED=%" PRIu64 " EDITS=%" PRIu64 "\n", random.state, edits);
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    copy c = {.daemon = d, .client = client_new(d)};
    put_mesh(c.client, GRID);
    c.listener = listener_open(d, EVENTS, NULL, 0);
    dump(c.client, &c.mesh);
    for (; done < edits; asked++) {
        /* Random arguments of edits are drawn from the copy, so the copy must be up to date here;
         * at other times it may be behind the server. */
        follow_to(&c, last);
        if (md_chance(&random, 1)) {
            cut(&c);
        }
        for (uint32_t burst = md_chance(&random, 5) ? 5 : 1; burst > 0; burst--) {
            uint64_t revision = random_request(&c, &random);
            done += revision > 0;
            last = revision > 0 ? revision : last;
        }
        if (done % 500 == 0) {
            follow_to(&c, last);
            require_equal(c.client, &c.mesh);
        }
    }
    follow_to(&c, last);
    require_equal(c.client, &c.mesh);
    printf("note: %" PRIu64 " of %" PRIu64 " requests made a revision, %u events applied, %u cuts, "
           "taken anew %u times\n",
           done, asked, c.applied, c.cuts, c.anew);
    listener_close(c.listener);
    mirror_clear(&c.mesh);
    client_free(c.client);
    assert_int_equal(daemon_stop(d), 0);
}

#define POKE "{\"op\":\"face_poke\",\"face\":0}"

static void an_id_of_another_incarnation_is_a_resync(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--undo-budget", "0", NULL});
    client *c = client_new(d);
    char id[64];
    put_mesh(c, GRID);
    listener *l = listener_open(d, EVENTS, NULL, 0);
    assert_int_equal(post(c, "/v1/meshes/m/edits", POKE), 2);
    assert_string_equal(listener_next(l, true), "edit");
    (void)snprintf(id, sizeof id, "%s", l->events.id);
    reply r = client_send(c, "DELETE", "/v1/meshes/m", NULL, NULL);
    assert_int_equal(r.status, 204);
    reply_free(&r);
    assert_string_equal(listener_next(l, true), "bye");
    assert_string_equal(listener_string(l, "reason"), "deleted");
    assert_string_equal(listener_next(l, true), "");
    assert_true(l->ended);
    listener_close(l);
    put_mesh(c, GRID);
    l = listener_open(d, EVENTS, id, 0);
    assert_string_equal(listener_next(l, true), "resync");
    assert_string_equal(listener_string(l, "reason"), "incarnation");
    assert_string_not_equal(l->events.id, id);
    listener_close(l);
    l = listener_open(d, EVENTS "?since=7", NULL, 0);
    assert_string_equal(listener_next(l, true), "resync");
    assert_string_equal(listener_string(l, "reason"), "future");
    /* After the `resync`, the stream continues with the next edit. */
    assert_int_equal(post(c, "/v1/meshes/m/edits", POKE), 2);
    assert_string_equal(listener_next(l, true), "edit");
    listener_close(l);
    l = listener_open(d, "/v1/meshes/none/events", NULL, 0);
    assert_int_equal(l->status, 404);
    listener_close(l);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Presences that are put faster than listeners may be told of them are collected; the newest one is
 * told although nothing follows it. */
static void the_newest_presence_is_told_and_not_each_one(void **state)
{
    (void)state;
    enum { PUTS = 60 };
    char body[100];
    unsigned told = 0;
    double face = -1;
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    put_mesh(c, GRID);
    listener *l = listener_open(d, EVENTS, NULL, 0);
    for (unsigned i = 0; i < PUTS; i++) {
        (void)snprintf(body, sizeof body,
                       "{\"client\":\"a\",\"selection\":{\"kind\":\"face\",\"ids\":[%u]}}", i);
        reply r = client_send(c, "PUT", "/v1/meshes/m/presence", NULL, body);
        assert_int_equal(r.status, 200);
        reply_free(&r);
    }
    for (; face < PUTS - 1; told++) {
        assert_string_equal(listener_next(l, true), "presence");
        const cJSON *changed = cJSON_GetArrayItem(cJSON_GetObjectItem(l->data, "changed"), 0);
        const cJSON *ids = cJSON_GetObjectItem(cJSON_GetObjectItem(changed, "selection"), "ids");
        assert_true(cJSON_GetArrayItem(ids, 0)->valuedouble > face);
        face = cJSON_GetArrayItem(ids, 0)->valuedouble;
    }
    assert_true(told <= PUTS);
    printf("note: %d presences were told in %u events\n", PUTS, told);
    reply r =
        client_send(c, "PUT", "/v1/meshes/m/presence", NULL, "{\"client\":\"a\",\"leaves\":true}");
    reply_free(&r);
    assert_string_equal(listener_next(l, true), "presence");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(l->data, "clients")), 0);
    listener_close(l);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* The history has a budget of 0 and keeps nothing, so edits that a
 * listener missed cannot be told to it later. */
static void a_gap_in_the_history_is_a_resync(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--undo-budget", "0", NULL});
    client *c = client_new(d);
    put_mesh(c, GRID);
    for (uint64_t revision = 2; revision < 5; revision++) {
        assert_int_equal(post(c, "/v1/meshes/m/edits", POKE), revision);
    }
    listener *l = listener_open(d, EVENTS "?since=2", NULL, 0);
    const char *name = listener_next(l, true);
    name = strcmp(name, "metadata") == 0 ? listener_next(l, true) : name;
    assert_string_equal(name, "resync");
    assert_string_equal(listener_string(l, "reason"), "gap");
    assert_int_equal((int)listener_number(l, "revision"), 4);
    listener_close(l);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static long resident_kilobytes(const daemon_process *d)
{
    char path[64], line[256];
    long kilobytes = -1;
    (void)snprintf(path, sizeof path, "/proc/%d/status", daemon_pid(d));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, "VmRSS:", 6) == 0) {
            kilobytes = strtol(line + 6, NULL, 10);
        }
    }
    (void)fclose(file);
    assert_true(kilobytes > 0);
    return kilobytes;
}

/* Edits make events of some 50 kB while the client reads nothing, far more than the buffers between
 * daemon and client hold. The daemon must drop events and tell the client to fetch the mesh
 * anew. */
static void who_reads_nothing_is_sent_to_fetch_anew(void **state)
{
    (void)state;
    enum { EDITS = 400, MOST_KILOBYTES = 24 * 1024 };
    daemon_process *d = daemon_start((const char *const[]){"--undo-budget", "0", NULL});
    copy c = {.daemon = d, .client = client_new(d)};
    put_mesh(c.client, "{\"shape\":\"uv_sphere\",\"segments\":24,\"rings\":24}");
    c.listener = listener_open(d, EVENTS, NULL, 16 * 1024);
    dump(c.client, &c.mesh);
    long before = resident_kilobytes(d);
    uint64_t last = 1;
    for (int i = 0; i < EDITS; i++) {
        char text[256];
        (void)snprintf(
            text, sizeof text,
            "{\"op\":\"transform\",\"matrix\":[1,0,0,0.%d1,0,1,0,0.3,0,0,1,0.7,0,0,0,1]}", i);
        last = post(c.client, "/v1/meshes/m/edits", text);
        assert_true(last > 0);
    }
    long grown = resident_kilobytes(d) - before;
    follow_to(&c, last);
    require_equal(c.client, &c.mesh);
    assert_true(c.applied > 0);
    /* the client fetched the mesh anew, and once more each time it fell behind again */
    assert_true(c.anew > 0);
    last = post(c.client, "/v1/meshes/m/edits", POKE);
    follow_to(&c, last);
    require_equal(c.client, &c.mesh);
    printf("note: of %d large events %u were applied, taken anew %u times; %ld KiB more resident\n",
           EDITS, c.applied, c.anew, grown);
/* A sanitizer keeps freed memory. */
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    assert_true(grown < MOST_KILOBYTES);
#endif
    listener_close(c.listener);
    mirror_clear(&c.mesh);
    client_free(c.client);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_dead_client_makes_room(void **state)
{
    (void)state;
    daemon_process *d =
        daemon_start((const char *const[]){"--max-mesh-listeners", "1", "--heartbeat", "1", NULL});
    client *c = client_new(d);
    put_mesh(c, GRID);
    listener *first = listener_open(d, EVENTS, NULL, 0);
    assert_int_equal(first->status, 200);
    listener *second = listener_open(d, EVENTS, NULL, 0);
    assert_int_equal(second->status, 503);
    listener_close(second);
    free(daemon_wait_log(d, "\"status\":503", 1));
    listener_close(first);
    /* The access log has a line about the stream only after the daemon has closed the stream. Then
     * a second listener must be admitted. */
    free(daemon_wait_log(d, "/events\",\"status\":200", 1));
    second = listener_open(d, EVENTS, NULL, 0);
    assert_int_equal(second->status, 200);
    listener_close(second);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Sends a request until it succeeds. On a busy machine an attempt may miss the daemon's deadline of
 * one second. */
static void send_until_done(const daemon_process *d, const char *method, const char *path,
                            const char *body)
{
    long status = 0;
    for (int tries = 0; tries < 20 && status != 200 && status != 201; tries++) {
        client *c = client_new(d);
        reply r = client_send(c, method, path, NULL, body);
        status = r.status;
        reply_free(&r);
        client_free(c);
    }
    assert_true(status == 200 || status == 201);
}

/* An event stream without events must not be closed by the deadlines of ordinary requests; comments
 * keep it alive. */
static void silence_is_filled_with_comments(void **state)
{
    (void)state;
    daemon_process *d =
        daemon_start((const char *const[]){"--heartbeat", "2", "--idle-timeout", "1",
                                           "--body-grace", "1", "--request-timeout", "1", NULL});
    send_until_done(d, "PUT", "/v1/meshes/m", GRID);
    listener *l = listener_open(d, EVENTS, NULL, 0);
    listener_wait_idle(l, 2);
    send_until_done(d, "POST", "/v1/meshes/m/edits", POKE);
    assert_string_equal(listener_next(l, true), "edit");
    listener_close(l);
    assert_int_equal(daemon_stop(d), 0);
}

enum { LISTENERS = 1000, BROADCASTS = 5 };

static void a_thousand_listeners_hear_every_edit_and_the_end(void **state)
{
    (void)state;
    static listener *all[LISTENERS];
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    client *c = client_new(d);
    put_mesh(c, GRID);
    for (size_t i = 0; i < LISTENERS; i++) {
        all[i] = listener_open(d, EVENTS, NULL, 0);
        assert_int_equal(all[i]->status, 200);
    }
    for (uint64_t revision = 2; revision < 2 + BROADCASTS; revision++) {
        assert_int_equal(post(c, "/v1/meshes/m/edits", POKE), revision);
    }
    for (size_t i = 0; i < LISTENERS; i++) {
        for (unsigned k = 0; k < BROADCASTS; k++) {
            assert_string_equal(listener_next(all[i], true), "edit");
            assert_int_equal((int)listener_number(all[i], "base"), k + 1);
        }
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    for (size_t i = 0; i < LISTENERS; i++) {
        assert_string_equal(listener_next(all[i], true), "bye");
        assert_string_equal(listener_string(all[i], "reason"), "stopping");
        assert_string_equal(listener_next(all[i], true), "");
        assert_true(all[i]->ended);
        listener_close(all[i]);
    }
}

enum { GONE = 1000, MOST_LOOKS = 20000 };

static size_t open_descriptors(const daemon_process *d)
{
    char path[64];
    size_t count = 0;
    snprintf(path, sizeof path, "/proc/%d/fd", daemon_pid(d));
    DIR *folder = opendir(path);
    assert_non_null(folder);
    while (readdir(folder) != NULL) {
        count++;
    }
    closedir(folder);
    return count;
}

/* Heartbeats are an hour apart, so only the closed connection tells the daemon that a listener is
 * gone. */
static void closed_listeners_free_their_descriptors(void **state)
{
    (void)state;
    static listener *gone[GONE];
    daemon_process *d =
        daemon_start((const char *const[]){"--log", "off", "--heartbeat", "3600", NULL});
    client *c = client_new(d);
    reply_done(
        reply_expect(201, client_send(c, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    size_t before = open_descriptors(d);
    for (int i = 0; i < GONE; i++) {
        gone[i] = listener_open(d, "/v1/meshes/m/events", NULL, 0);
    }
    assert_true(open_descriptors(d) >= before + GONE);
    for (int i = 0; i < GONE; i++) {
        listener_close(gone[i]);
    }
    int looks = 0;
    uint64_t closed = st_clock_micros();
    while (open_descriptors(d) > before && looks < MOST_LOOKS) {
        looks++;
        reply_done(reply_expect(200, client_get(c, "/livez")));
    }
    print_message("note: %d closed listeners were gone after %.1f s\n", GONE,
                  (double)(st_clock_micros() - closed) / 1e6);
    assert_true(looks < MOST_LOOKS);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_stays_equal_through_random_edits),
        cmocka_unit_test(an_id_of_another_incarnation_is_a_resync),
        cmocka_unit_test(the_newest_presence_is_told_and_not_each_one),
        cmocka_unit_test(a_gap_in_the_history_is_a_resync),
        cmocka_unit_test(who_reads_nothing_is_sent_to_fetch_anew),
        cmocka_unit_test(a_dead_client_makes_room),
        cmocka_unit_test(closed_listeners_free_their_descriptors),
        cmocka_unit_test(silence_is_filled_with_comments),
        cmocka_unit_test(a_thousand_listeners_hear_every_edit_and_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
