/* transport.h - how the daemons of a test are reached: over TCP, over TLS or on a Unix socket.
 *
 * The environment variable TRANSPORT names the transport, so that the whole suite can run over each
 * of them (`make test TESTS=e2e TRANSPORT=tls`). daemon.c starts daemons with the options of the
 * transport, client.c connects over the same transport, so most tests need not know which it is. A
 * test about one transport chooses that transport itself; over a transport that makes a test
 * impossible, the test is skipped with a reason. */
#ifndef TESTS_E2E_TRANSPORT_H
#define TESTS_E2E_TRANSPORT_H

#include <stddef.h>

typedef enum transport { TRANSPORT_TCP, TRANSPORT_TLS, TRANSPORT_UNIX } transport;

/* Returns the transport that TRANSPORT names, TCP if the variable is not set; fails the test if the
 * name is unknown. */
transport transport_get(void);
/* Makes all daemons that this program starts from now on use the transport `way`. */
void transport_choose(transport way);
/* Skips the running test if the transport is `way`, and prints the reason. */
void transport_skip_over(transport way, const char *reason);
/* Returns the name by which a daemon's log calls this program when it connects: "127.0.0.1", or for
 * example "unix:uid=1000". The name is valid until the next call. */
const char *transport_peer(void);

enum { TRANSPORT_OPTIONS = 8 };

/* Returns the daemon's options for this transport, ended by NULL. They are valid until the next
 * call. Each daemon on a Unix socket gets a path of its own. */
const char *const *transport_options(void);
/* Returns the certificate file of daemons that speak TLS. The first call makes the file, which is
 * removed when the program ends. */
const char *transport_certificate(void);

/* Writes a new key and a self-signed certificate for localhost and 127.0.0.1, with the common name
 * `name`, as two PEM files. Fails the test if a file cannot be written. */
void transport_make_pair(const char *name, const char *certificate, const char *key);

/* Begins TLS with the daemon at the other end of a connected socket, which then belongs to this
 * function. Returns a socket on which the caller writes and reads plain text. A thread encrypts and
 * decrypts at most one record in each direction at a time, so the daemon must wait if the caller
 * does not read. If the caller closes the socket, the connection is closed; if the caller shuts
 * down the writing side, that direction of TLS ends. If `buffer` is above 0, the socket has a small
 * receive buffer. */
int transport_secure(int connected, int buffer);

#endif
