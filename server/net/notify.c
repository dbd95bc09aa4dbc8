#include "server/net/notify.h"

#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

bool srv_notify(const char *message)
{
    const char *name = getenv("NOTIFY_SOCKET");
    struct sockaddr_un to = {.sun_family = AF_UNIX};
    size_t length = name == NULL ? 0 : strlen(name);
    if (length < 2 || length >= sizeof to.sun_path || (name[0] != '/' && name[0] != '@')) {
        return true;
    }
    memcpy(to.sun_path, name, length);
    if (name[0] == '@') {
        /* An abstract name, which exists only in the kernel: there is no file. */
        to.sun_path[0] = '\0';
    }
    int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0) {
        return false;
    }
    ssize_t sent = sendto(fd, message, strlen(message), MSG_NOSIGNAL, (const struct sockaddr *)&to,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length));
    const bool full = sent < 0 && (errno == EAGAIN || errno == ENOBUFS);
    close(fd);
    return !full;
}

/* Parses a positive number; returns 0 for any other text. */
static uint64_t number_of(const char *text)
{
    char *end;
    if (text == NULL || text[0] < '0' || text[0] > '9') {
        return 0;
    }
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    return errno == 0 && *end == '\0' ? value : 0;
}

uint64_t srv_notify_watchdog(void)
{
    const char *pid = getenv("WATCHDOG_PID");
    if (pid != NULL && number_of(pid) != (uint64_t)getpid()) {
        return 0;
    }
    return number_of(getenv("WATCHDOG_USEC"));
}
