/* transport.h - how the daemons of a test are reached: over TCP, over TLS or on a Unix socket.
 *
 * TRANSPORT of the environment says which, so that the whole suite runs over each of them
 * (`make test TESTS=e2e TRANSPORT=tls`). daemon.c starts daemons with the options of that
 * transport, client.c connects as they want it, and most tests know nothing of it. A test that is
 * about one transport chooses it, or is skipped over the others with its reason. */
#ifndef TESTS_E2E_TRANSPORT_H
#define TESTS_E2E_TRANSPORT_H

#include <stddef.h>

typedef enum transport { TRANSPORT_TCP, TRANSPORT_TLS, TRANSPORT_UNIX } transport;

/* That of the environment, TCP where it names none; fails the test where it names another. */
transport transport_get(void);
/* All daemons that this program starts from now on are reached like this. */
void transport_choose(transport way);
/* Skips the running test over this transport, with a note that gives the reason. */
void transport_skip_over(transport way, const char *reason);
/* This program as a daemon's log names it where it connects: "127.0.0.1", "unix:uid=1000". Valid
 * until the next call. */
const char *transport_peer(void);

enum { TRANSPORT_OPTIONS = 8 };

/* The options of a daemon that is reached like this, ended by NULL. They are valid until the next
 * call. Each daemon on a Unix socket has a path of its own. */
const char *const *transport_options(void);
/* The file of the certificate that daemons over TLS have, which is made at the first call and
 * removed when the program ends. */
const char *transport_certificate(void);

/* A new key, and a certificate for localhost and 127.0.0.1 that it signed itself, with this common
 * name, as two files in PEM. Fails the test where one cannot be written. */
void transport_make_pair(const char *name, const char *certificate, const char *key);

/* Speaks TLS with the daemon at the other end of a connected socket, which is taken. Returns a
 * socket for the caller, who writes and reads what is inside of TLS. A thread passes on what comes
 * from either side, at most a record of each side at a time, so that a reader who stops stops the
 * daemon as well. Closing the socket closes the connection, shutting down its writing side ends
 * that side of TLS. With `buffer` above 0 the socket keeps little for its reader. */
int transport_secure(int connected, int buffer);

#endif
