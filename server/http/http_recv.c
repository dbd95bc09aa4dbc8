#include "server/http/http_recv.h"

#include <errno.h>
#include <stdatomic.h>
#include <sys/socket.h>

/* Zero pages until a descriptor of their range is used. */
static _Atomic(srv_syntax *) watched[SRV_MAX_DESCRIPTORS];

bool srv_recv_watch(int socket, srv_syntax *syntax)
{
    bool fits = socket >= 0 && socket < SRV_MAX_DESCRIPTORS;
    if (fits) {
        atomic_store_explicit(&watched[socket], syntax, memory_order_release);
    }
    return fits;
}

void srv_recv_forget(int socket)
{
    (void)srv_recv_watch(socket, NULL);
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

static ssize_t receive_plain(void *context, char *buffer, size_t size)
{
    return recvfrom(*(const int *)context, buffer, size, 0, NULL, NULL);
}

ssize_t recv(int socket, void *buffer, size_t size, int flags)
{
    srv_syntax *syntax = NULL;
    if (flags == 0 && socket >= 0 && socket < SRV_MAX_DESCRIPTORS) {
        syntax = atomic_load_explicit(&watched[socket], memory_order_acquire);
    }
    return syntax == NULL ? recvfrom(socket, buffer, size, flags, NULL, NULL)
                          : srv_recv_checked(syntax, buffer, size, receive_plain, &socket);
}
