/* unix_socket.h - a Unix socket on which the daemon listens; its address is the path of a file.
 *
 * The permissions of the file decide which users can connect: its owner and its group (mode 0660),
 * within those of its folder. A killed daemon leaves the file behind. The next daemon tries to
 * connect to the socket: if no program listens there, the daemon removes the file; otherwise it
 * refuses to start. During this check it holds a lock on the folder, so that, if two daemons start
 * at the same time, the second one finds the first. */
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
/* Removes the file of the socket, unless another file has replaced it. */
void srv_unix_remove(const srv_unix_socket *made);

#endif
