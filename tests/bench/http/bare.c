/* The minimum that a server based on libmicrohttpd can do: it answers every request with the same
 * bytes. tests/bench/http.sh compares hedged with this server.
 *
 *     bare WORKERS BODY [HEADER...]
 *
 * Each HEADER is a line such as "ETag: 1"; without any, the answers have only a Content-Type. The
 * program prints the port it listens on, and ends when its standard input ends. */
#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_HEADERS = 16 };

static const char *body;
static struct {
    char *name, *value;
} headers[MOST_HEADERS] = {{"Content-Type", "application/json"}};
static size_t header_count = 1;

/* Splits lines such as "ETag: 1" into names and values. Returns false if one is none. */
static bool read_headers(char **lines, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *colon = strstr(lines[i], ": ");
        if (colon == NULL || i == MOST_HEADERS) {
            return false;
        }
        *colon = '\0';
        headers[i].name = lines[i];
        headers[i].value = colon + 2;
    }
    header_count = count > 0 ? count : header_count;
    return true;
}

static enum MHD_Result answer(void *context, struct MHD_Connection *connection, const char *url,
                              const char *method, const char *version, const char *data,
                              size_t *size, void **state)
{
    (void)context, (void)url, (void)method, (void)version, (void)data;
    static int seen;
    if (*state == NULL) {
        *state = &seen;
        return MHD_YES;
    }
    if (*size > 0) {
        *size = 0;
        return MHD_YES;
    }
    struct MHD_Response *response = MHD_create_response_from_buffer(
        strlen(body), (void *)(uintptr_t)body, MHD_RESPMEM_PERSISTENT);
    for (size_t i = 0; i < header_count; i++) {
        MHD_add_response_header(response, headers[i].name, headers[i].value);
    }
    enum MHD_Result result = MHD_queue_response(connection, MHD_HTTP_OK, response);
    MHD_destroy_response(response);
    return result;
}

int main(int argc, char **argv)
{
    if (argc < 3 || !read_headers(argv + 3, (size_t)argc - 3)) {
        fprintf(stderr, "usage: %s WORKERS BODY [HEADER...]\n", argv[0]);
        return 2;
    }
    unsigned workers = (unsigned)strtoul(argv[1], NULL, 10);
    body = argv[2];
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_EPOLL_INTERNAL_THREAD, 0, NULL, NULL, answer, NULL, MHD_OPTION_SOCK_ADDR,
        (struct sockaddr *)&address, workers > 1 ? MHD_OPTION_THREAD_POOL_SIZE : MHD_OPTION_END,
        workers, MHD_OPTION_END);
    if (daemon == NULL) {
        return 1;
    }
    printf("%u\n", MHD_get_daemon_info(daemon, MHD_DAEMON_INFO_BIND_PORT)->port);
    fflush(stdout);
    char byte;
    while (read(STDIN_FILENO, &byte, 1) > 0) {
    }
    MHD_stop_daemon(daemon);
    return 0;
}
