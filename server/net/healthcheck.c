#include "server/net/healthcheck.h"

#include "server/net/address.h"
#include "server/tls/tls_client.h"

#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

enum { WAIT_SECONDS = 3, STATUS_LINE = 12 /* "HTTP/1.1 200" */ };

typedef struct target {
    srv_address address;
    bool tls;
    char path[256];
} target;

static bool split(const char *url, target *out)
{
    char authority[SRV_ADDRESS_TEXT];
    *out = (target){.tls = strncmp(url, "https://", 8) == 0, .path = "/livez"};
    if (strncmp(url, "unix:", 5) == 0) {
        return srv_address_parse(url, &out->address);
    }
    if (!out->tls && strncmp(url, "http://", 7) != 0) {
        return false;
    }
    url += out->tls ? 8 : 7;
    const char *port = out->tls ? ":443" : ":80";
    size_t length = strcspn(url, "/");
    if (length + sizeof ":443" > sizeof authority) {
        return false;
    }
    memcpy(authority, url, length);
    authority[length] = '\0';
    const char *colon = strrchr(authority, ':');
    if (colon == NULL || strchr(colon, ']') != NULL) {
        memcpy(authority + length, port, strlen(port) + 1);
    }
    int written =
        snprintf(out->path, sizeof out->path, "%s", url[length] == '\0' ? "/livez" : url + length);
    return written < (int)sizeof out->path && strpbrk(out->path, " \r\n") == NULL &&
           srv_address_parse(authority, &out->address);
}

/* Sends a request on a socket without TLS, and reads the first `size` bytes of the answer. Returns
 * how many bytes arrived. */
static size_t ask_plain(int fd, const char *request, size_t length, char *answer, size_t size)
{
    size_t got = 0;
    ssize_t more = send(fd, request, length, MSG_NOSIGNAL) == (ssize_t)length ? 1 : 0;
    while (more > 0 && got < size) {
        more = recv(fd, answer + got, size - got, 0);
        got += more > 0 ? (size_t)more : 0;
    }
    return got;
}

/* Sends the request of the health check. Returns the status of the answer, 0 if there was no
 * answer. */
static int ask(const target *to)
{
    char request[512], answer[STATUS_LINE];
    int status = 0;
    size_t got = 0;
    struct timeval wait = {.tv_sec = WAIT_SECONDS};
    int fd = socket(to->address.socket.any.sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) {
        return 0;
    }
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
    size_t length = (size_t)snprintf(
        request, sizeof request, "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
        to->path);
    if (connect(fd, &to->address.socket.any, to->address.length) == 0) {
        got = to->tls ? srv_tls_ask(fd, request, length, answer, sizeof answer)
                      : ask_plain(fd, request, length, answer, sizeof answer);
    }
    if (got == sizeof answer && memcmp(answer, "HTTP/1.", 7) == 0) {
        for (size_t i = 9; i < sizeof answer; i++) {
            status = status * 10 + (answer[i] - '0');
        }
    }
    close(fd);
    return status;
}

bool srv_healthcheck(const char *url, char *message, size_t size)
{
    target to;
    if (!split(url, &to)) {
        snprintf(message, size,
                 "\"%s\" is not http://ADDRESS:PORT/PATH, https://ADDRESS:PORT/PATH or unix:PATH",
                 url);
        return false;
    }
    int status = ask(&to);
    if (status == 0) {
        snprintf(message, size, "no answer arrived");
    } else {
        snprintf(message, size, "the daemon answered with the status %d instead of 200", status);
    }
    return status == 200;
}
