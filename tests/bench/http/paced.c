#define _GNU_SOURCE /* for ppoll */
/* A client that sends requests at a fixed rate, whether or not earlier ones are answered. The time
 * of an answer counts from when its request was due, so that a slow answer also shows in the
 * requests that had to wait behind it (no coordinated omission).
 *
 *     paced PORT PATH TOKEN RATE CONNECTIONS SECONDS IDLE
 *
 * It sends RATE requests a second over CONNECTIONS connections, and keeps IDLE more connections
 * open that have sent one request each. It prints the numbers of answers with status 200, 429 and
 * any other, the median and the 99th percentile of the times in milliseconds, and how many of the
 * 429 had a Retry-After. */
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { MOST_CONNECTIONS = 256, ANSWER = 16 * 1024, REQUEST = 1024 };

typedef struct line {
    int fd;
    double due; /* when the request that is not answered yet was due; 0 if there is none */
    size_t length;
    char answer[ANSWER];
} line;

static line lines[MOST_CONNECTIONS];
static struct pollfd waits[MOST_CONNECTIONS];
static char request[REQUEST];
static int request_length;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static void stop(const char *what)
{
    fprintf(stderr, "paced: %s\n", what);
    exit(1);
}

static int connect_to(int port)
{
    const int on = 1;
    struct sockaddr_in to = {.sin_family = AF_INET,
                             .sin_port = htons((uint16_t)port),
                             .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    if (fd < 0 || connect(fd, (struct sockaddr *)&to, sizeof to) != 0) {
        stop("cannot connect");
    }
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
}

static void ask(line *l, double due)
{
    l->due = due;
    l->length = 0;
    if (send(l->fd, request, (size_t)request_length, MSG_NOSIGNAL) != request_length) {
        stop("cannot ask");
    }
}

/* Returns the status of an answer that has arrived completely, 0 if more of it is to come. */
static int take(line *l)
{
    ssize_t got = recv(l->fd, l->answer + l->length, ANSWER - 1 - l->length, 0);
    if (got <= 0) {
        stop("a connection was closed");
    }
    l->length += (size_t)got;
    l->answer[l->length] = '\0';
    const char *body = strstr(l->answer, "\r\n\r\n");
    const char *size = strstr(l->answer, "Content-Length: ");
    if (body == NULL || size == NULL ||
        l->length < (size_t)(body + 4 - l->answer) + strtoul(size + 16, NULL, 10)) {
        return 0;
    }
    return (int)strtol(l->answer + 9, NULL, 10);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void hold_idle(int port, int idle)
{
    struct rlimit files;
    static line once;
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    for (int i = 0; i < idle; i++) {
        once.fd = connect_to(port); /* the connection stays open */
        ask(&once, 1);
        while (take(&once) == 0) {
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 8) {
        fprintf(stderr, "usage: %s PORT PATH TOKEN RATE CONNECTIONS SECONDS IDLE\n", argv[0]);
        return 2;
    }
    const int port = (int)strtol(argv[1], NULL, 10);
    const double rate = strtod(argv[4], NULL), seconds = strtod(argv[6], NULL);
    const int count = (int)strtol(argv[5], NULL, 10);
    const size_t all = (size_t)(rate * seconds);
    double *took = calloc(all + 1, sizeof *took);
    size_t begun = 0, ended = 0, good = 0, refused = 0, other = 0, told = 0;
    request_length = snprintf(
        request, sizeof request,
        "GET %s HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer %s\r\n\r\n", argv[2], argv[3]);
    if (took == NULL || count < 1 || count > MOST_CONNECTIONS || request_length >= REQUEST) {
        stop("arguments");
    }
    hold_idle(port, (int)strtol(argv[7], NULL, 10));
    for (int i = 0; i < count; i++) {
        lines[i].fd = connect_to(port);
        waits[i] = (struct pollfd){.fd = lines[i].fd, .events = POLLIN};
    }
    const double start = now();
    while (ended < all) {
        double at = now();
        for (int i = 0; i < count && begun < all; i++) {
            double due = start + (double)begun * 1e3 / rate;
            if (due > at) {
                break;
            }
            if (lines[i].due == 0) {
                ask(&lines[i], due);
                begun++;
            }
        }
        double next = begun < all ? start + (double)begun * 1e3 / rate - now() : 1000;
        struct timespec pause = {0, next > 0 ? (long)(next * 1e6) % 1000000000 : 0};
        if (next <= 0) {
            pause.tv_nsec = 50000; /* all connections are busy */
        }
        if (ppoll(waits, (nfds_t)count, &pause, NULL) < 0) {
            stop("poll");
        }
        at = now();
        for (int i = 0; i < count; i++) {
            int status =
                (waits[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0 ? take(&lines[i]) : 0;
            if (status == 0) {
                continue;
            }
            took[ended++] = at - lines[i].due;
            lines[i].due = 0;
            good += status == 200;
            refused += status == 429;
            other += status != 200 && status != 429;
            told += status == 429 && strstr(lines[i].answer, "\r\nRetry-After: ") != NULL;
        }
    }
    qsort(took, all, sizeof *took, compare);
    printf("%zu %zu %zu %.2f %.2f %zu\n", good, refused, other, took[all / 2], took[all * 99 / 100],
           told);
    return 0;
}
