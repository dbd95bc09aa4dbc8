#include "tests/api/gate.h"

#include "tests/api/request.h"

#include "api/token/tickets.h"
#include "api/token/token_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

double gate_seconds_passed;

/* The tokens of this test, with at most one limit each. */
static const struct {
    const char *name, *limit;
} tokens[] = {{"free", ""},       {"paced", "requests=1"},     {"maker", "meshes=1"},
              {"busy", "jobs=1"}, {"grower", "mesh-bytes=4K"}, {"loud", "bytes=1K"}};

enum { TOKENS = sizeof tokens / sizeof *tokens, REQUESTS = 20, TARGET = 300 };

typedef struct world {
    api_bench *bench;
    size_t findings;
    bool tells;
} world;

static void found(world *w, const char *what)
{
    w->findings++;
    if (w->tells) {
        print_error("%s\n", what);
    }
}

/* Sends a GET, or a POST if `body` is not NULL, with the token whose name is `token`. */
static bench_reply ask(world *w, const char *token, const char *target, bool as_job,
                       const char *body)
{
    char authorization[100];
    snprintf(authorization, sizeof authorization, "Bearer %s-s3cr3t", token);
    const char *headers[] = {"Authorization", authorization, as_job ? "Prefer" : NULL,
                             "respond-async", NULL};
    return bench_send(w->bench, body == NULL ? "GET" : "POST", target, headers, body);
}

static int status_of(world *w, const char *token, const char *target, bool as_job, const char *body)
{
    bench_reply r = ask(w, token, target, as_job, body);
    const int status = r.status;
    bench_done(r);
    return status;
}

/* Sends REQUESTS requests without a pause and returns how many of them are refused. */
static int refused(world *w, const char *token)
{
    int count = 0;
    for (int i = 0; i < REQUESTS; i++) {
        count += status_of(w, token, "/v1/meshes", false, NULL) == 429;
    }
    return count;
}

static void try_rates(world *w)
{
    if (refused(w, "free") > 0) {
        found(w, "a token without a limit is refused");
    }
    /* The token "paced" may send one request a second. Even a slow machine sends the REQUESTS
     * requests faster. */
    if (refused(w, "paced") == 0) {
        found(w, "a token has more requests than its rate");
    }
    char body[4096]; /* a body of blanks is not JSON, but its bytes count toward the limit */
    memset(body, ' ', sizeof body - 1);
    body[sizeof body - 1] = '\0';
    if (status_of(w, "loud", "/v1/meshes/m/query", false, body) == 429 || refused(w, "loud") == 0) {
        found(w, "a token has more bytes than its rate");
    }
    bench_use_address(w->bench, 1, true);
    if (refused(w, "free") != REQUESTS) {
        found(w, "an address has more connections than it may");
    }
    bench_use_address(w->bench, 0, false);
}

static void try_quotas(world *w)
{
    static const char cube[] = "{\"shape\":\"cube\"}";
    static const char grid[] = "{\"shape\":\"grid\",\"columns\":50,\"rows\":50}";
    const int first = status_of(w, "maker", "/v1/meshes", false, cube);
    const int second = status_of(w, "maker", "/v1/meshes", false, cube);
    if (first != 201 || second != 507) {
        found(w, "a token makes more meshes than it may");
    }
    if (status_of(w, "grower", "/v1/meshes", false, grid) != 507) {
        found(w, "a token makes a larger mesh than it may");
    }
    static const char question[] = "{\"queries\":[]}";
    const int made = status_of(w, "free", "/v1/meshes?id=m", false, cube);
    const int begun = status_of(w, "busy", "/v1/meshes/m/query", true, question);
    const int another = status_of(w, "busy", "/v1/meshes/m/query", true, question);
    if (made != 201 || begun != 202 || another != 429) {
        found(w, "a token has more jobs than it may");
    }
    bench_run_jobs(w->bench, BENCH_JOBS);
}

/* Returns the status of a GET with a ticket that is `seconds` old. */
static int status_of_ticket(world *w, double seconds)
{
    char url[TARGET];
    bench_reply r = ask(w, "free", "/v1/tickets", false, "{\"path\":\"/v1/meshes/m/content\"}");
    const cJSON *path = cJSON_GetObjectItem(r.json, "path");
    snprintf(url, sizeof url, "%s", cJSON_IsString(path) ? path->valuestring : "/");
    bench_done(r);
    gate_seconds_passed += seconds;
    r = bench_send(w->bench, "GET", url, NULL, NULL);
    const int status = r.status;
    bench_done(r);
    return status;
}

static void try_ends(world *w)
{
    if (status_of_ticket(w, API_TICKET_SECONDS - 5) != 200) {
        found(w, "a ticket ends too early");
    }
    if (status_of_ticket(w, API_TICKET_SECONDS + 1) != 401) {
        found(w, "a ticket is taken after its end");
    }
}

/* The number of tokens in force besides the tokens with limits. They are so many that an unknown
 * token often has the same bucket in the hash table as a valid one, so the whole hashes must be
 * compared. */
enum { OTHERS = 2000, GUESSES = 100 };

static void try_guesses(world *w)
{
    int taken = 0;
    for (int i = 0; i < GUESSES; i++) {
        char guess[20];
        snprintf(guess, sizeof guess, "guess-%d", i);
        taken += status_of(w, guess, "/v1/meshes", false, NULL) != 401;
    }
    if (taken > 0) {
        found(w, "a token that is not in the file is taken");
    }
}

/* Appends the line of a token to the file and returns the new length of the file. */
static size_t add_token(char *file, size_t used, const char *name, const char *limit)
{
    char secret[40], line[API_TOKEN_SHORT_LINE];
    snprintf(secret, sizeof secret, "%s-s3cr3t", name);
    api_token_file_line(name, API_ROLE_WRITE, secret, line);
    return used + (size_t)snprintf(file + used, 2 * sizeof line, "%s %s\n", line, limit);
}

size_t gate_limit_findings(bool tell)
{
    world w = {.tells = tell};
    char *file = malloc((TOKENS + OTHERS) * (size_t)(2 * API_TOKEN_SHORT_LINE));
    size_t used = 0;
    assert_non_null(file);
    for (size_t i = 0; i < TOKENS; i++) {
        used = add_token(file, used, tokens[i].name, tokens[i].limit);
    }
    for (int i = 0; i < OTHERS; i++) {
        char name[20];
        snprintf(name, sizeof name, "other-%d", i);
        used = add_token(file, used, name, "");
    }
    w.bench = bench_new_guarded(file);
    try_quotas(&w);
    try_rates(&w);
    try_ends(&w);
    try_guesses(&w);
    bench_free(w.bench);
    free(file);
    return w.findings;
}
