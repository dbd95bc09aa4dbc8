#include "server/net/unix_socket.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MODE = 0660 };

static int fail(char *message, size_t size, const char *path, const char *why)
{
    snprintf(message, size, "cannot listen on %s: %s", path, why);
    return -1;
}

/* Opens and locks the folder that contains a path. Returns the folder's descriptor, -1 on
 * failure. */
static int lock_folder(const char *path)
{
    char folder[SRV_MAX_PATH + 1];
    snprintf(folder, sizeof folder, "%s", path);
    char *slash = strrchr(folder, '/');
    if (slash != NULL) {
        slash[slash == folder ? 1 : 0] = '\0';
    }
    int fd = open(slash == NULL ? "." : folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0 && flock(fd, LOCK_EX) != 0) {
        close(fd);
        return -1;
    }
    return fd;
}

/* If no program listens on the socket at the path, removes the socket's file. Returns NULL, or a
 * sentence that says why the path cannot be used. If connecting gives EAGAIN, a program listens
 * there but is not accepting connections at the moment. */
static const char *make_room(const srv_address *address, const char *path)
{
    struct stat found;
    if (lstat(path, &found) != 0) {
        return errno == ENOENT ? NULL : strerror(errno);
    }
    if (!S_ISSOCK(found.st_mode)) {
        return "a file with this name exists and is not a socket";
    }
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0) {
        return strerror(errno);
    }
    int code = connect(fd, &address->socket.any, address->length) == 0 ? 0 : errno;
    close(fd);
    if (code == 0 || code == EAGAIN || code == EINPROGRESS) {
        return "another program listens on this socket";
    }
    if (code != ECONNREFUSED) {
        return strerror(code);
    }
    return unlink(path) == 0 ? NULL : strerror(errno);
}

/* Binds the socket to its file and listens. The file never has wider permissions than MODE, because
 * bind() creates it with the mode of the socket, reduced by the umask of this process. Returns
 * NULL, or a sentence that says what failed. */
static const char *bind_to(int fd, const srv_address *address, const char *path, int backlog,
                           srv_unix_socket *made)
{
    struct stat found;
    if (fchmod(fd, MODE) != 0 || bind(fd, &address->socket.any, address->length) != 0) {
        return strerror(errno);
    }
    if (chmod(path, MODE) != 0 || lstat(path, &found) != 0 || listen(fd, backlog) != 0) {
        const char *why = strerror(errno);
        unlink(path);
        return why;
    }
    snprintf(made->path, sizeof made->path, "%s", path);
    made->device = found.st_dev;
    made->number = found.st_ino;
    return NULL;
}

int srv_unix_listen(const srv_address *address, int backlog, srv_unix_socket *made, char *message,
                    size_t size)
{
    const char *path = srv_address_path(address);
    *made = (srv_unix_socket){.path = ""};
    int folder = lock_folder(path);
    if (folder < 0) {
        return fail(message, size, path, strerror(errno));
    }
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const char *why = fd < 0 ? strerror(errno) : make_room(address, path);
    if (why == NULL) {
        why = bind_to(fd, address, path, backlog, made);
    }
    close(folder);
    if (why == NULL) {
        return fd;
    }
    if (fd >= 0) {
        close(fd);
    }
    return fail(message, size, path, why);
}

void srv_unix_remove(const srv_unix_socket *made)
{
    struct stat found;
    if (made->path[0] != '\0' && lstat(made->path, &found) == 0 && found.st_dev == made->device &&
        found.st_ino == made->number) {
        unlink(made->path);
    }
}
