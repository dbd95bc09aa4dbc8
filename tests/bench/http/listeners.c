/* Benchmark of event streams: the memory per listener while nothing happens, and the time from the
 * first byte of an edit until the last listener has its event.
 *
 *     listeners PORT PID LISTENERS ROUNDS */
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum { BATCH = 256, BUFFER = 64 * 1024 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static void stop(const char *what)
{
    fprintf(stderr, "listeners: %s\n", what);
    exit(1);
}

static int connect_to(int port)
{
    struct sockaddr_in to = {.sin_family = AF_INET,
                             .sin_port = htons((uint16_t)port),
                             .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    if (fd < 0 || connect(fd, (struct sockaddr *)&to, sizeof to) != 0) {
        stop("cannot connect");
    }
    int one = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    return fd;
}

static void say(int fd, const char *method, const char *path, const char *body)
{
    char text[1024];
    int length = snprintf(text, sizeof text,
                          "%s %s HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                          "Content-Length: %zu\r\n\r\n%s",
                          method, path, strlen(body), body);
    if (write(fd, text, (size_t)length) != length) {
        stop("cannot ask");
    }
}

static char buffer[BUFFER];

/* Reads from the socket of a listener until the bytes `end` have arrived. */
static void hear(int fd, const char *end)
{
    size_t length = 0;
    do {
        ssize_t got = read(fd, buffer + length, sizeof buffer - 1 - length);
        if (got <= 0) {
            stop("the connection was closed");
        }
        length += (size_t)got;
        buffer[length] = '\0';
    } while (strstr(buffer, end) == NULL);
}

static double resident(long pid)
{
    char path[64];
    long pages = 0, all = 0;
    snprintf(path, sizeof path, "/proc/%ld/statm", pid);
    FILE *file = fopen(path, "r");
    if (file == NULL || fscanf(file, "%ld %ld", &all, &pages) != 2) {
        stop("no such process");
    }
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / 1024;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Waits until each listener has received one event: it arrives as one chunk and ends in a blank
 * line. */
static void hear_all(int epoll, size_t listeners)
{
    struct epoll_event ready[BATCH];
    for (size_t heard = 0; heard < listeners;) {
        int count = epoll_wait(epoll, ready, BATCH, 10000);
        if (count <= 0) {
            stop("a listener heard nothing");
        }
        for (int i = 0; i < count; i++) {
            ssize_t got = read(ready[i].data.fd, buffer, sizeof buffer);
            heard += got > 4 && memcmp(buffer + got - 4, "\n\n\r\n", 4) == 0;
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        stop("usage: listeners PORT PID LISTENERS ROUNDS");
    }
    int port = (int)strtol(argv[1], NULL, 10);
    long pid = strtol(argv[2], NULL, 10);
    size_t listeners = strtoul(argv[3], NULL, 10), rounds = strtoul(argv[4], NULL, 10);
    struct rlimit files;
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    int editor = connect_to(port), epoll = epoll_create1(0);
    double *times = calloc(rounds, sizeof *times);
    if (times == NULL || rounds == 0) {
        stop("no rounds");
    }
    say(editor, "PUT", "/v1/meshes/bench", "{\"shape\":\"icosphere\",\"subdivisions\":4}");
    hear(editor, "\"import\"");
    double before = resident(pid);
    for (size_t i = 0; i < listeners; i++) {
        int fd = connect_to(port);
        say(fd, "GET", "/v1/meshes/bench/events", "");
        hear(fd, ".1\n\n\r\n");
        struct epoll_event event = {.events = EPOLLIN, .data.fd = fd};
        epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event);
    }
    double idle = resident(pid);
    for (size_t i = 0; i < rounds; i++) {
        double start = now();
        say(editor, "POST", "/v1/meshes/bench/edits",
            "{\"op\":\"vertex_move\",\"vertex\":5,\"by\":[0,0,0.01]}");
        hear_all(epoll, listeners);
        times[i] = now() - start;
        hear(editor, "\"merged\"");
    }
    qsort(times, rounds, sizeof *times, compare);
    printf(
        "%zu listeners: %.1f KiB resident each while idle (%.0f in all), %.1f after %zu events\n",
        listeners, (idle - before) / (double)listeners, idle - before,
        (resident(pid) - before) / (double)listeners, rounds);
    printf("an edit reaches them all in %.1f ms (median), %.1f ms (worst of %zu)\n",
           times[rounds / 2], times[rounds - 1], rounds);
    free(times);
    return 0;
}
