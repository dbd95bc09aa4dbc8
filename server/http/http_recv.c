#include "server/http/http_recv.h"

#include "server/http/limits.h"
#include "server/tls/tls_record.h"
#include "system/clock.h"

#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

/* The watched connection of each descriptor, or NULL. The table is large, but the kernel allocates
 * only those pages of the table that are written. */
static _Atomic(srv_connection *) watched[SRV_MAX_DESCRIPTORS];

static bool fits(int socket)
{
    return socket >= 0 && socket < SRV_MAX_DESCRIPTORS;
}

/* Returns the watched connection of a socket; NULL if the socket is not watched. */
static srv_connection *find(int socket)
{
    return fits(socket) ? atomic_load_explicit(&watched[socket], memory_order_acquire) : NULL;
}

srv_connection *srv_recv_find(gnutls_session_t session)
{
    srv_connection *c = find(gnutls_transport_get_int(session));
    return c != NULL && c->session == session ? c : NULL;
}

bool srv_recv_watch(srv_connection *c)
{
    const int on = 1;
    if (!fits(c->socket)) {
        return false;
    }
    c->tells_end =
        c->session == NULL && setsockopt(c->socket, IPPROTO_TCP, TCP_INQ, &on, sizeof on) == 0;
    atomic_store_explicit(&watched[c->socket], c, memory_order_release);
    return true;
}

void srv_recv_forget(int socket)
{
    if (fits(socket)) {
        atomic_store_explicit(&watched[socket], NULL, memory_order_release);
    }
}

ssize_t srv_recv_checked(srv_syntax *syntax, char *buffer, size_t size,
                         ssize_t (*receive)(void *context, char *buffer, size_t size),
                         void *context)
{
    if (srv_syntax_is_faulty(syntax)) {
        size_t rest = srv_syntax_end(syntax, buffer, size);
        errno = EAGAIN;
        return rest > 0 ? (ssize_t)rest : -1;
    }
    ssize_t got = receive(context, buffer, size);
    return got > 0 ? (ssize_t)srv_syntax_check(syntax, buffer, (size_t)got, size) : got;
}

/* Returns how many bytes the kernel still has for this socket, as it reported with the message, or
 * 0 if it reported nothing. */
static int left_to_read(struct msghdr *message)
{
    int left = 0;
    const struct cmsghdr *told = CMSG_FIRSTHDR(message);
    if (told != NULL && told->cmsg_level == IPPROTO_TCP && told->cmsg_type == TCP_CM_INQ) {
        memcpy(&left, CMSG_DATA(told), sizeof left);
    }
    return left;
}

static ssize_t receive(void *context, char *buffer, size_t size)
{
    srv_connection *c = context;
    union {
        struct cmsghdr aligned;
        char bytes[CMSG_SPACE(sizeof(int))];
    } control;
    struct iovec into = {.iov_base = buffer, .iov_len = size};
    struct msghdr message = {.msg_iov = &into, .msg_iovlen = 1};
    if (c->tells_end) {
        message.msg_control = &control;
        message.msg_controllen = sizeof control;
    }
    ssize_t got = recvmsg(c->socket, &message, 0);
    if (got > 0) {
        /* If the kernel does not report whether there is more to read, the client's stream may have
         * ended after any read. */
        c->may_have_ended = (size_t)got < size && (!c->tells_end || left_to_read(&message) > 0);
    }
    return got;
}

static ssize_t receive_tls(void *context, char *buffer, size_t size)
{
    const srv_connection *c = context;
    return srv_tls_receive(c->session, buffer, size);
}

static ssize_t receive_watched(srv_connection *c, char *buffer, size_t size)
{
    ssize_t got =
        srv_recv_checked(&c->syntax, buffer, size, c->session == NULL ? receive : receive_tls, c);
    if (got > 0 && c->syntax.requests > c->requests &&
        atomic_load_explicit(&c->stage, memory_order_relaxed) == SRV_STAGE_IDLE) {
        srv_connection_enter(c, SRV_STAGE_HEAD, st_clock_micros());
    }
    return got;
}

bool srv_recv_has_ended(const srv_connection *c)
{
    char byte;
    return c != NULL && c->may_have_ended && c->syntax.requests == c->requests &&
           recvfrom(c->socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT, NULL, NULL) == 0;
}

bool srv_recv_send(srv_connection *c, const char *bytes, size_t length)
{
    /* The socket's buffer is enlarged first, because answers that the client has not read yet may
     * fill the smaller buffer that the socket began with. */
    const int most = SRV_SEND_BUFFER;
    (void)setsockopt(c->socket, SOL_SOCKET, SO_SNDBUF, &most, sizeof most);
    return c->session != NULL
               ? srv_tls_send(c->session, bytes, length)
               : send(c->socket, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT) == (ssize_t)length;
}

/* --- functions that replace those of libraries --- */

ssize_t recv(int socket, void *buffer, size_t size, int flags)
{
    srv_connection *c = flags == 0 ? find(socket) : NULL;
    return c == NULL || c->session != NULL ? recvfrom(socket, buffer, size, flags, NULL, NULL)
                                           : receive_watched(c, buffer, size);
}

ssize_t gnutls_record_recv(gnutls_session_t session, void *buffer, size_t size)
{
    srv_connection *c = srv_recv_find(session);
    if (c == NULL) {
        return srv_tls_receive(session, buffer, size);
    }
    if (atomic_load_explicit(&c->stage, memory_order_relaxed) == SRV_STAGE_HANDSHAKE) {
        api_count(c->metrics, API_COUNT_HANDSHAKES);
        srv_connection_enter(c, SRV_STAGE_IDLE, st_clock_micros());
    }
    ssize_t got = receive_watched(c, buffer, size);
    /* With TLS, libmicrohttpd expects GNUTLS_E_AGAIN where recv() returns -1. */
    return got == -1 ? GNUTLS_E_AGAIN : got;
}

static ssize_t counted(int socket, ssize_t sent)
{
    srv_connection *c = sent > 0 ? find(socket) : NULL;
    if (c != NULL && c->counts_sent) {
        atomic_fetch_add_explicit(&c->sent, (uint64_t)sent, memory_order_relaxed);
    }
    return sent;
}

ssize_t send(int socket, const void *bytes, size_t size, int flags)
{
    return counted(socket, sendto(socket, bytes, size, flags, NULL, 0));
}

ssize_t sendmsg(int socket, const struct msghdr *message, int flags)
{
    return counted(socket, syscall(SYS_sendmsg, socket, message, flags));
}
