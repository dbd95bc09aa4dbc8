#include "server/net/healthcheck.h"

#include "server/net/address.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

enum { WAIT_SECONDS = 3, PORT_HTTP = 80 };

static bool split(const char *url, srv_address *address, char *path, size_t size)
{
    char authority[SRV_ADDRESS_TEXT];
    if (strncmp(url, "http://", 7) != 0) {
        return false;
    }
    url += 7;
    size_t length = strcspn(url, "/");
    if (length + sizeof ":80" > sizeof authority) {
        return false;
    }
    memcpy(authority, url, length);
    authority[length] = '\0';
    const char *colon = strrchr(authority, ':');
    if (colon == NULL || strchr(colon, ']') != NULL) {
        memcpy(authority + length, ":80", sizeof ":80");
    }
    int written = snprintf(path, size, "%s", url[length] == '\0' ? "/livez" : url + length);
    return written < (int)size && strpbrk(path, " \r\n") == NULL &&
           srv_address_parse(authority, address);
}

/* The status, 0 when no answer came. */
static int ask(const srv_address *address, const char *path)
{
    char request[512], answer[64];
    int status = 0;
    struct timeval wait = {.tv_sec = WAIT_SECONDS};
    int fd = socket(address->socket.any.sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) {
        return 0;
    }
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
    int length = snprintf(request, sizeof request,
                          "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    size_t got = 0;
    if (connect(fd, &address->socket.any, address->length) == 0 &&
        send(fd, request, (size_t)length, MSG_NOSIGNAL) == length) {
        /* "HTTP/1.1 200" */
        while (got < 12) {
            ssize_t more = recv(fd, answer + got, sizeof answer - got, 0);
            if (more <= 0) {
                break;
            }
            got += (size_t)more;
        }
    }
    if (got >= 12 && memcmp(answer, "HTTP/1.", 7) == 0) {
        for (size_t i = 9; i < 12; i++) {
            status = status * 10 + (answer[i] - '0');
        }
    }
    close(fd);
    return status;
}

bool srv_healthcheck(const char *url, const char *listen, char *message, size_t size)
{
    srv_address address;
    char path[256] = "/livez";
    if (url == NULL ? !srv_address_parse(listen, &address)
                    : !split(url, &address, path, sizeof path)) {
        snprintf(message, size, "\"%s\" is not http://ADDRESS:PORT/PATH",
                 url == NULL ? listen : url);
        return false;
    }
    int status = ask(&address, path);
    if (status == 0) {
        snprintf(message, size, "no answer came");
    } else {
        snprintf(message, size, "the answer was %d", status);
    }
    return status == 200;
}
