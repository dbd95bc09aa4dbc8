/* client.h - requests to a daemon, sent through libcurl, or as raw bytes through a socket. */
#ifndef TESTS_E2E_CLIENT_H
#define TESTS_E2E_CLIENT_H

#include "tests/e2e/daemon.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct reply {
    long status; /* 0: there was no answer */
    char *body;  /* NUL-terminated */
    size_t length;
    char *headers; /* header lines as received, each ended by CR LF */
    cJSON *json;   /* the body, parsed; NULL if it is not JSON */
} reply;

void reply_free(reply *r);
void reply_done(reply r);
/* Returns `r` if its status is `status`; else prints the answer and fails the test. */
reply reply_expect(long status, reply r);
/* Copies a header of the answer into `value`; without that header `value` becomes "". */
const char *reply_header(const reply *r, const char *name, char *value, size_t size);
/* Returns a member of the JSON body by its path, such as "counts.vertices" or "items.0.id". Fails
 * the test if it is absent. */
const cJSON *reply_find(const reply *r, const char *path);
double reply_number(const reply *r, const char *path);
const char *reply_string(const reply *r, const char *path);
bool reply_is_null(const reply *r, const char *path);

typedef struct client client; /* a libcurl handle, which keeps its connection */

client *client_new(const daemon_process *d);
void client_free(client *c);
/* Makes the client trust the certificate in the file `certificate`, and no other one, if the daemon
 * speaks TLS. The file name must stay valid. */
void client_trust(client *c, const char *certificate);
/* Sends a request with a body of text. `headers` are lines "Name: value", ended by NULL; `headers`
 * may be NULL. If `body` is NULL, the request has no body. A body without a Content-Type is sent as
 * application/json. */
reply client_send(client *c, const char *method, const char *path, const char *const *headers,
                  const char *body);
/* A request whose body may hold any bytes; the members are as in client_send(). */
typedef struct client_request {
    const char *method, *path;
    const char *const *headers;
    const void *body;
    size_t length; /* number of bytes in the body; 0 if there is no body */
} client_request;
reply client_send_bytes(client *c, const client_request *request);
/* client_get sends a GET, client_post a POST with a JSON body. */
reply client_get(client *c, const char *path);
/* Waits until the job at the path `job` runs; fails the test if the job has already ended. The
 * daemon may run a waiting job before a longer one that was submitted earlier. */
void client_await_running(client *c, const char *job);
reply client_post(client *c, const char *path, const char *json);

/* Opens a connection without libcurl, which the caller must close. Over TLS the result is one end
 * of a socket pair; a thread encrypts what passes between the other end and the daemon
 * (transport.h). `buffer` is the size of the receive buffer, 0 for the default. With a small
 * buffer, the daemon must soon wait if the client does not read. */
int client_connect(const daemon_process *d, int buffer);

/* Sends bytes unchanged on a new connection and reads until the server closes it, or until
 * `answers` complete answers have come. Returns what was read; the caller must free it. If
 * `half_close` is set, the sending direction of the connection is closed after the bytes are
 * sent. */
char *client_raw(const daemon_process *d, const char *bytes, size_t length, int answers,
                 bool half_close);
/* Returns the status of the first answer in the bytes that client_raw has returned, 0 if there is
 * none. */
int client_raw_status(const char *bytes);

#endif
