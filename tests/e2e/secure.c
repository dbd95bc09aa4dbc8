/* The thread behind transport_secure(): it encrypts what the test writes into a socket and sends it
 * to the daemon over TLS, and decrypts the answer. */
#include "tests/e2e/transport.h"

#include "server/tls/tls_record.h"

#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>
#include <gnutls/gnutls.h>

enum { RECORD = 16 * 1024, LITTLE = 4096, LONGEST_MILLIS = 600 * 1000 };

/* Bytes on their way between the test and the daemon, in one direction; at most one TLS record. */
typedef struct parcel {
    unsigned char bytes[RECORD];
    size_t at, end;
    bool ended; /* the sender has closed this direction */
    bool told;  /* the receiver knows that the sender has closed this direction */
} parcel;

typedef struct relay {
    /* `inside` is the socket to the test, `outside` the socket to the daemon */
    int inside, outside;
    gnutls_session_t session;
    parcel out, in;
    bool is_left; /* the test has closed its socket */
    bool is_cut;  /* the daemon accepts no more bytes, so what the test still writes is dropped */
} relay;

static bool comes_later(ssize_t code)
{
    return code == GNUTLS_E_AGAIN || code == GNUTLS_E_INTERRUPTED;
}

/* Reads what the test has written. Returns false if the connection to the test is broken. */
static bool take_from_inside(relay *r)
{
    parcel *p = &r->out;
    if (p->at < p->end || p->ended) {
        return true;
    }
    ssize_t got = recv(r->inside, p->bytes, sizeof p->bytes, MSG_DONTWAIT);
    if (got < 0) {
        return errno == EAGAIN || errno == EINTR;
    }
    p->at = 0;
    p->end = (size_t)got;
    p->ended = got == 0;
    return true;
}

static void give_outside(relay *r)
{
    parcel *p = &r->out;
    if (r->is_cut) {
        p->at = p->end;
        p->told = p->ended;
    } else if (p->at < p->end) {
        ssize_t sent = gnutls_record_send(r->session, p->bytes + p->at, p->end - p->at);
        if (sent < 0) {
            /* The daemon may have answered before it reset the connection, so the relay goes on
             * until it has passed on that answer. */
            r->is_cut = !comes_later(sent);
            return;
        }
        p->at += (size_t)sent;
    } else if (p->ended && !p->told) {
        int code = gnutls_bye(r->session, GNUTLS_SHUT_WR);
        p->told = code == GNUTLS_E_SUCCESS;
        r->is_cut = !p->told && !comes_later(code);
    }
}

static bool take_from_outside(relay *r)
{
    parcel *p = &r->in;
    if (p->at < p->end || p->ended) {
        return true;
    }
    ssize_t got = srv_tls_receive(r->session, p->bytes, sizeof p->bytes);
    if (got < 0 && comes_later(got)) {
        return true;
    }
    /* The daemon has closed the connection or reset it. In both cases the bytes that have arrived
     * are passed on first. */
    p->at = 0;
    p->end = got > 0 ? (size_t)got : 0;
    p->ended = got <= 0;
    return true;
}

static bool give_inside(relay *r)
{
    parcel *p = &r->in;
    if (p->at < p->end && !r->is_left) {
        ssize_t sent =
            send(r->inside, p->bytes + p->at, p->end - p->at, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent < 0) {
            return errno == EAGAIN || errno == EINTR;
        }
        p->at += (size_t)sent;
    }
    return p->at < p->end || !p->ended;
}

/* Waits until one of the two sockets is ready for the next step. Returns false if nothing comes for
 * ten minutes, if the daemon has reset the connection while the test does not read, or if the test
 * has closed its socket and all that it wrote is sent. */
static bool wait_for_more(relay *r)
{
    const bool is_out = r->out.at < r->out.end || (r->out.ended && !r->out.told);
    const bool is_in = r->in.at < r->in.end;
    if (r->is_left && !is_out) {
        return !r->out.ended;
    }
    if (!is_in && gnutls_record_check_pending(r->session) > 0) {
        return true;
    }
    struct pollfd both[] = {
        {.fd = r->is_left ? -1 : r->inside},
        {.fd = r->outside},
    };
    both[0].events = (short)((is_in ? POLLOUT : 0) | (is_out || r->out.ended ? 0 : POLLIN));
    both[1].events = (short)((is_out ? POLLOUT : 0) | (is_in ? 0 : POLLIN));
    if (poll(both, 2, LONGEST_MILLIS) <= 0) {
        return errno == EINTR;
    }
    r->is_left |= (both[0].revents & POLLHUP) != 0;
    return !is_in || (both[1].revents & POLLERR) == 0;
}

static bool shake_hands(relay *r)
{
    int code;
    while ((code = gnutls_handshake(r->session)) != GNUTLS_E_SUCCESS) {
        if (gnutls_error_is_fatal(code) != 0) {
            return false;
        }
        struct pollfd wait = {.fd = r->outside, .events = POLLIN};
        if (gnutls_record_get_direction(r->session) != 0) {
            wait.events = POLLOUT;
        }
        if (poll(&wait, 1, LONGEST_MILLIS) == 0) {
            return false;
        }
    }
    return true;
}

static void *pass_on(void *context)
{
    relay *r = context;
    bool goes_on = shake_hands(r);
    while (goes_on && wait_for_more(r)) {
        goes_on = take_from_inside(r);
        if (goes_on) {
            give_outside(r);
            goes_on = take_from_outside(r) && give_inside(r);
        }
    }
    close(r->inside);
    close(r->outside);
    gnutls_deinit(r->session);
    free(r);
    return NULL;
}

/* Returns the credentials that all connections share until the program ends. */
static gnutls_certificate_credentials_t trust(void)
{
    static gnutls_certificate_credentials_t all;
    if (all == NULL) {
        assert_int_equal(gnutls_certificate_allocate_credentials(&all), 0);
        assert_int_equal(gnutls_certificate_set_x509_trust_file(all, transport_certificate(),
                                                                GNUTLS_X509_FMT_PEM),
                         1);
    }
    return all;
}

int transport_secure(int connected, int buffer)
{
    const int on = 1;
    int pair[2];
    pthread_t thread;
    relay *r = calloc(1, sizeof *r);
    assert_non_null(r);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair), 0);
    if (buffer > 0) {
        const int little = LITTLE;
        assert_int_equal(setsockopt(pair[1], SOL_SOCKET, SO_SNDBUF, &little, sizeof little), 0);
    }
    assert_int_equal(fcntl(connected, F_SETFL, O_NONBLOCK), 0);
    r->inside = pair[1];
    r->outside = connected;
    assert_int_equal(setsockopt(connected, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on), 0);
    assert_int_equal(gnutls_init(&r->session, GNUTLS_CLIENT | GNUTLS_NO_SIGNAL | GNUTLS_NONBLOCK),
                     0);
    assert_int_equal(gnutls_set_default_priority(r->session), 0);
    assert_int_equal(gnutls_credentials_set(r->session, GNUTLS_CRD_CERTIFICATE, trust()), 0);
    gnutls_session_set_verify_cert(r->session, NULL, 0);
    gnutls_transport_set_int(r->session, connected);
    assert_int_equal(pthread_create(&thread, NULL, pass_on, r), 0);
    assert_int_equal(pthread_detach(thread), 0);
    return pair[0];
}
