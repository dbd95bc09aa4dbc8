#include "server/http/http_recv.h"

#include "system/clock.h"

#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/socket.h>

/* Zero pages until a descriptor of their range is used. */
static _Atomic(srv_connection *) watched[SRV_MAX_DESCRIPTORS];

static bool fits(int socket)
{
    return socket >= 0 && socket < SRV_MAX_DESCRIPTORS;
}

bool srv_recv_watch(srv_connection *c)
{
    const int on = 1;
    if (!fits(c->socket)) {
        return false;
    }
    c->tells_end = setsockopt(c->socket, IPPROTO_TCP, TCP_INQ, &on, sizeof on) == 0;
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

/* The number that the kernel sends along; 0 without one. */
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
        /* Where the kernel tells nothing, any read may have been the last. */
        c->may_have_ended = (size_t)got < size && (!c->tells_end || left_to_read(&message) > 0);
    }
    return got;
}

static ssize_t receive_watched(srv_connection *c, char *buffer, size_t size)
{
    ssize_t got = srv_recv_checked(&c->syntax, buffer, size, receive, c);
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

ssize_t recv(int socket, void *buffer, size_t size, int flags)
{
    srv_connection *c = NULL;
    if (flags == 0 && fits(socket)) {
        c = atomic_load_explicit(&watched[socket], memory_order_acquire);
    }
    return c == NULL ? recvfrom(socket, buffer, size, flags, NULL, NULL)
                     : receive_watched(c, buffer, size);
}
