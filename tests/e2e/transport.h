/* transport.h - how the daemons of a test are reached: over TCP, over TLS or on a Unix socket.
 *
 * The environment variable TRANSPORT says which, so that the whole suite can run over each of them
 * (`make test TESTS=e2e TRANSPORT=tls`). daemon.c starts daemons with the options of that
 * transport, client.c connects accordingly, and most tests need not know it. A test that is about
 * one transport chooses it; one that is not possible over a transport is skipped with its reason.
 */
#ifndef TESTS_E2E_TRANSPORT_H
#define TESTS_E2E_TRANSPORT_H

#include <stddef.h>

typedef enum transport { TRANSPORT_TCP, TRANSPORT_TLS, TRANSPORT_UNIX } transport;

/* Returns the transport in the environment, TCP if it names none; fails the test if it names an
 * unknown one. */
transport transport_get(void);
/* Makes all daemons that this program starts from now on use this transport. */
void transport_choose(transport way);
/* Skips the running test over this transport, with a note that gives the reason. */
void transport_skip_over(transport way, const char *reason);
/* Returns how a daemon's log names this program when it connects: "127.0.0.1", "unix:uid=1000".
 * Valid until the next call. */
const char *transport_peer(void);

enum { TRANSPORT_OPTIONS = 8 };

/* Returns the daemon's options for this transport, ended by NULL. They are valid until the next
 * call. Each daemon on a Unix socket gets a path of its own. */
const char *const *transport_options(void);
/* Returns the file of the certificate of daemons that speak TLS. It is made at the first call and
 * removed when the program ends. */
const char *transport_certificate(void);

/* Writes a new key and a self-signed certificate for localhost and 127.0.0.1, with this common
 * name, as two PEM files. Fails the test if one cannot be written. */
void transport_make_pair(const char *name, const char *certificate, const char *key);

/* Begins TLS with the daemon at the other end of a connected socket, which this function takes
 * over. Returns a socket on which the caller writes and reads plain text. A thread encrypts and
 * decrypts, at most one record in each direction at a time, so that a caller who does not read
 * makes the daemon wait, too. Closing the socket closes the connection; shutting down its writing
 * side ends that direction of TLS. With `buffer` above 0 the socket has a small receive buffer. */
int transport_secure(int connected, int buffer);

#endif
