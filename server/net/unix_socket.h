/* unix_socket.h - a listening socket that is a file.
 *
 * The permissions of the file decide which users can connect: its owner and its group (mode 0660),
 * within those of its folder. A killed daemon leaves the file behind. The next daemon connects to
 * it: if nothing listens there, it removes the file; otherwise it refuses to start. The folder is
 * locked meanwhile, so that of two daemons started together one finds the other. */
#ifndef HE_SERVER_NET_UNIX_SOCKET_H
#define HE_SERVER_NET_UNIX_SOCKET_H

#include "server/net/address.h"

#include <sys/types.h>

/* The file of a socket that this process has made. */
typedef struct srv_unix_socket {
    char path[SRV_MAX_PATH + 1]; /* "": none */
    dev_t device;
    ino_t number;
} srv_unix_socket;

/* Listens at the path of `address`. The socket does not block and is closed on exec. Returns the
 * descriptor, which the caller closes, and fills `made`; returns -1 with a sentence in `message`
 * and an empty `made` on failure. */
int srv_unix_listen(const srv_address *address, int backlog, srv_unix_socket *made, char *message,
                    size_t size);
/* Removes the file, unless another file has replaced it. */
void srv_unix_remove(const srv_unix_socket *made);

#endif
