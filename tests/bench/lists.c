/* How fast lists of edge splits are over HTTP, beside the kernel's own rate for equal lists:
 *
 *     lists PORT PROCESS [ROUNDS]
 *
 * It prints lines such as "octets 830000 870000": the splits a second, and the splits in a second
 * of processor time, of this program for the kernel and of the daemon PROCESS for the others.
 *
 * Every list splits 65,536 edges, drawn by lot, of a torus of 696,200 triangles. The kernel runs
 * them as the operation edge_split does, recorded in a delta, and keeps the deltas of four lists,
 * about as many as fit into the daemon's undo budget. The daemon at 127.0.0.1:PORT gets equal lists
 * as octets and as JSON, each for a mesh of its own, and is asked for return=minimal. The three
 * take turns; each figure is the median of ROUNDS (7). */
#include "algo/shape.h"
#include "api/json/packed.h"
#include "model/random.h"
#include "op/op.h"
#include "mesh/delta.h"
#include "system/clock.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { SEGMENTS = 590, EDGES = SEGMENTS * SEGMENTS * 3, LIST = 65536, MOST_ROUNDS = 64, KEPT = 4 };

static uint32_t ids[LIST];
static double t[LIST];

static void fail(const char *what)
{
    fprintf(stderr, "lists: %s\n", what);
    exit(1);
}

/* Draws different edges by lot. */
static void draw(md_random *random)
{
    static unsigned char taken[EDGES];
    memset(taken, 0, sizeof taken);
    for (size_t i = 0; i < LIST;) {
        const uint32_t id = md_below(random, EDGES);
        if (!taken[id]) {
            taken[id] = 1;
            t[i] = 0.25 + 0.5 * md_unit(random);
            ids[i++] = id;
        }
    }
}

/* The splits a second of each list, and in a second of processor time. */
typedef struct figures {
    double rate[MOST_ROUNDS], by_time[MOST_ROUNDS];
    size_t count;
} figures;

static const char *process; /* the process number of the daemon */

/* Returns the processor time that all threads of a process have used, in microseconds. */
static double time_of(const char *number)
{
    char path[300];
    double total = 0;
    snprintf(path, sizeof path, "/proc/%s/task", number);
    DIR *tasks = opendir(path);
    for (struct dirent *task; tasks != NULL && (task = readdir(tasks)) != NULL;) {
        char line[100] = "";
        snprintf(path, sizeof path, "/proc/%s/task/%.20s/schedstat", number, task->d_name);
        FILE *file = fopen(path, "r");
        if (file != NULL) {
            total += fgets(line, sizeof line, file) != NULL ? strtod(line, NULL) / 1000 : 0;
            (void)fclose(file);
        }
    }
    if (tasks == NULL || total <= 0) {
        fail("the processor time is not known");
    }
    (void)closedir(tasks);
    return total;
}

static void add(figures *to, uint64_t begin, double time)
{
    to->rate[to->count] = LIST * 1e6 / (double)(st_clock_micros() - begin);
    to->by_time[to->count++] = LIST * 1e6 / time;
}

/* --- the kernel --- */

static const he_op *find(const char *name)
{
    return he_op_find(name, strlen(name));
}

static void run(const he_op *op, he_mesh *mesh, const he_arg *args)
{
    he_results results = {.each = false};
    he_error err = {0};
    if (he_op_run(op, mesh, args, &results, &err) != HE_OK) {
        fail(err.text);
    }
    he_results_clear(&results);
}

static he_mesh *make_torus(void)
{
    const he_shape *torus = he_shape_find("torus", 5);
    double numbers[HE_SHAPE_PARAMS];
    he_arg args[HE_OP_PARAMS];
    he_soup soup = {0};
    he_mesh *mesh = NULL;
    he_shape_defaults(torus, numbers);
    numbers[0] = numbers[1] = SEGMENTS;
    if (he_shape_make(torus, numbers, NULL, &soup, NULL) != HE_OK ||
        he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL) != HE_OK) {
        fail("no memory for the torus");
    }
    he_soup_clear(&soup);
    he_op_defaults(find("triangulate"), args);
    run(find("triangulate"), mesh, args);
    if (he_mesh_issued(mesh, HE_EDGE) != EDGES) {
        fail("the torus has another number of edges");
    }
    return mesh;
}

static void run_kernel(he_mesh *mesh, figures *to)
{
    static he_delta *kept[KEPT];
    static size_t next;
    const he_op *op = find("edge_split");
    he_arg args[HE_OP_PARAMS];
    he_op_defaults(op, args);
    args[0] = (he_arg){.given = true, .list = true, .ids = ids, .count = LIST};
    args[1] = (he_arg){.given = true, .list = true, .numbers = t, .count = LIST};
    const double used = time_of("self");
    const uint64_t begin = st_clock_micros();
    he_delta_free(kept[next]);
    kept[next] = he_delta_new();
    (void)he_mesh_record(mesh, kept[next]);
    run(op, mesh, args);
    (void)he_mesh_record(mesh, NULL);
    next = (next + 1) % KEPT;
    add(to, begin, time_of("self") - used);
}

/* --- the daemon --- */

static int connection;

static void send_all(const char *bytes, size_t length)
{
    while (length > 0) {
        const ssize_t sent = send(connection, bytes, length, 0);
        if (sent <= 0) {
            fail("the connection was closed");
        }
        bytes += sent;
        length -= (size_t)sent;
    }
}

/* Reads one answer, and fails if its status does not begin with a 2. */
static void receive(void)
{
    static char head[1 << 16];
    size_t used = 0, rest = 0;
    const char *end = NULL;
    while (end == NULL) {
        const ssize_t got = recv(connection, head + used, sizeof head - 1 - used, 0);
        if (got <= 0) {
            fail("the connection was closed");
        }
        used += (size_t)got;
        head[used] = '\0';
        end = strstr(head, "\r\n\r\n");
    }
    const char *length = strstr(head, "Content-Length: ");
    if (strncmp(head, "HTTP/1.1 2", 10) != 0) {
        fail(head);
    }
    if (length != NULL && length < end) {
        rest = (size_t)strtoul(length + strlen("Content-Length: "), NULL, 10);
    }
    for (size_t have = used - (size_t)(end + 4 - head); have < rest;) {
        const ssize_t got = recv(connection, head, sizeof head, 0);
        if (got <= 0) {
            fail("the connection was closed");
        }
        have += (size_t)got;
    }
}

static void post(const char *path, const char *type, const char *body, size_t length)
{
    char head[400];
    const int bytes = snprintf(head, sizeof head,
                               "POST %s HTTP/1.1\r\nHost: localhost\r\nContent-Type: %s\r\n"
                               "Content-Length: %zu\r\nPrefer: return=minimal, wait=60\r\n\r\n",
                               path, type, length);
    send_all(head, (size_t)bytes);
    send_all(body, length);
    receive();
}

static void post_json(const char *path, const char *body)
{
    post(path, "application/json", body, strlen(body));
}

static void open_connection(int port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connection = socket(AF_INET, SOCK_STREAM, 0);
    if (connection < 0 ||
        connect(connection, (const struct sockaddr *)&address, sizeof address) != 0) {
        fail("the daemon does not answer");
    }
}

static void make_mesh(const char *id)
{
    char path[100], shape[100];
    snprintf(path, sizeof path, "/v1/meshes?id=%s", id);
    snprintf(shape, sizeof shape,
             "{\"shape\":\"torus\",\"major_segments\":%d,\"minor_segments\":%d}", SEGMENTS,
             SEGMENTS);
    post_json(path, shape);
    snprintf(path, sizeof path, "/v1/meshes/%s/edits", id);
    post_json(path, "{\"op\":\"triangulate\"}");
}

static void write_octets(api_text *body)
{
    api_arrays arrays = {0};
    api_text json = {0};
    (void)api_packed_add(&arrays, API_PACKED_U32, 1, ids, LIST);
    (void)api_packed_add(&arrays, API_PACKED_F64, 1, t, LIST);
    api_text_add_string(&json,
                        "{\"op\":\"edge_split\",\"edges\":{\"array\":0},\"t\":{\"array\":1}}");
    api_packed_write(&arrays, &json, body);
    api_text_clear(&json);
    api_arrays_clear(&arrays);
}

static void write_json(api_text *body)
{
    api_text_add_string(body, "{\"op\":\"edge_split\",\"edges\":[");
    for (size_t i = 0; i < LIST; i++) {
        api_text_add_format(body, "%s%u", i > 0 ? "," : "", ids[i]);
    }
    api_text_add_string(body, "],\"t\":[");
    for (size_t i = 0; i < LIST; i++) {
        api_text_add_format(body, "%s%.17g", i > 0 ? "," : "", t[i]);
    }
    api_text_add_string(body, "]}");
}

/* Sends the list. The body is written before the clock is read. */
static void run_daemon(const char *id, const char *type, void (*write)(api_text *body), figures *to)
{
    char path[100];
    api_text body = {0};
    write(&body);
    if (body.failed) {
        fail("no memory for a request");
    }
    snprintf(path, sizeof path, "/v1/meshes/%s/edits", id);
    const double used = time_of(process);
    const uint64_t begin = st_clock_micros();
    post(path, type, body.bytes, body.length);
    add(to, begin, time_of(process) - used);
    api_text_clear(&body);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *rates, size_t count)
{
    qsort(rates, count, sizeof *rates, compare);
    return rates[count / 2];
}

static void print(const char *name, figures *f)
{
    printf("%s %.0f %.0f\n", name, median(f->rate, f->count), median(f->by_time, f->count));
}

int main(int argc, char **argv)
{
    static figures kernel, octets, json;
    const size_t rounds = argc > 3 ? strtoul(argv[3], NULL, 10) : 7;
    md_random random = {.state = 1};
    if (argc < 3 || rounds < 1 || rounds > MOST_ROUNDS) {
        fail("usage: lists PORT PROCESS [ROUNDS]");
    }
    process = argv[2];
    he_mesh *mesh = make_torus();
    open_connection((int)strtol(argv[1], NULL, 10));
    make_mesh("octets");
    make_mesh("json");
    for (size_t i = 0; i < rounds; i++) {
        draw(&random);
        run_kernel(mesh, &kernel);
        run_daemon("octets", API_PACKED_EDITS, write_octets, &octets);
        run_daemon("json", "application/json", write_json, &json);
    }
    print("kernel", &kernel);
    print("octets", &octets);
    print("json", &json);
    he_mesh_free(mesh);
    (void)close(connection);
    return 0;
}
