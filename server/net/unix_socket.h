/* unix_socket.h - a listening socket that is a file.
 *
 * Who may connect is a matter of the file's permissions: its owner and its group (mode 0660),
 * within those of the folder it lies in. A daemon that was killed leaves the file behind. The next
 * one connects to it: where nobody listens it is removed, where somebody does the start is refused.
 * The folder is locked meanwhile, so that of two daemons started together one finds the other. */
#ifndef HE_SERVER_NET_UNIX_SOCKET_H
#define HE_SERVER_NET_UNIX_SOCKET_H

#include "server/net/address.h"

#include <sys/types.h>

/* A file that this process has made. */
typedef struct srv_unix_socket {
    char path[SRV_MAX_PATH + 1]; /* "": none */
    dev_t device;
    ino_t number;
} srv_unix_socket;

/* Listens at the path of `address`, which does not block and is closed when another program is
 * executed. Returns the descriptor, which is the caller's, and fills `made`; -1 with a sentence in
 * `message`, and a `made` that is none. */
int srv_unix_listen(const srv_address *address, int backlog, srv_unix_socket *made, char *message,
                    size_t size);
/* Removes the file, unless another one is in its place by now. */
void srv_unix_remove(const srv_unix_socket *made);

#endif
