/* client.h - requests to a daemon: through libcurl, or byte for byte through a socket. */
#ifndef TESTS_E2E_CLIENT_H
#define TESTS_E2E_CLIENT_H

#include "tests/e2e/daemon.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct reply {
    long status; /* 0: no answer at all */
    char *body;  /* ends in NUL */
    size_t length;
    char *headers; /* as they came, lines end in CR LF */
    cJSON *json;   /* NULL when the body is none */
} reply;

void reply_free(reply *r);
void reply_done(reply r);
/* The answer as it came; with another status the test fails and says what came instead. */
reply reply_expect(long status, reply r);
/* A header of the answer into `value`, "" when absent. */
const char *reply_header(const reply *r, const char *name, char *value, size_t size);
/* A member of the JSON body by path, such as "counts.vertices" or "items.0.id". Fails the test when
 * it is absent. */
const cJSON *reply_find(const reply *r, const char *path);
double reply_number(const reply *r, const char *path);
const char *reply_string(const reply *r, const char *path);
bool reply_is_null(const reply *r, const char *path);

typedef struct client client; /* a libcurl handle, which keeps its connection */

client *client_new(const daemon_process *d);
void client_free(client *c);
/* With a daemon that speaks TLS: trust the certificate in this file, which is borrowed, and no
 * other.
 */
void client_trust(client *c, const char *certificate);
/* `body` NULL sends none. `headers` are "Name: value" lines that end in NULL, or NULL; a body
 * without a Content-Type among them is application/json. */
reply client_send(client *c, const char *method, const char *path, const void *body, size_t length,
                  const char *const *headers);
/* The usual cases. */
reply client_get(client *c, const char *path);
reply client_post(client *c, const char *path, const char *json);

/* A connection of one's own, which the caller closes; over TLS the end of one that a thread
 * encrypts (transport.h). `buffer` is the size of its receive buffer, 0 for the usual one: a small
 * one makes a client slow that does not read. */
int client_connect(const daemon_process *d, int buffer);

/* Send bytes as they are on a connection of their own and read until the server closes it, or until
 * `answers` whole answers came. What came is the caller's to free. `half_close` ends our side after
 * sending. */
char *client_raw(const daemon_process *d, const char *bytes, size_t length, int answers,
                 bool half_close);
/* The status of the first answer in such bytes, 0 where there is none. */
int client_raw_status(const char *bytes);

#endif
