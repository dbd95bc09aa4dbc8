#include "tests/e2e/client.h"

#include "tests/e2e/transport.h"
#include "tests/traffic.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <setjmp.h>

#include <cmocka.h>
#include <curl/curl.h>

/* If no answer comes for this long, a request fails the test instead of waiting for ever. No test
 * depends on the exact time. */
enum { LONGEST_SECONDS = 600 };

struct client {
    CURL *curl;
    const daemon_process *daemon;
    const char *trusted;
};

typedef struct bytes {
    char *data;
    size_t length, capacity;
} bytes;

static void add(bytes *b, const char *data, size_t length)
{
    if (b->length + length + 1 > b->capacity) {
        b->capacity = 2 * (b->length + length + 1);
        b->data = realloc(b->data, b->capacity);
        assert_non_null(b->data);
    }
    memcpy(b->data + b->length, data, length);
    b->length += length;
    b->data[b->length] = '\0';
}

static size_t receive(char *data, size_t size, size_t count, void *context)
{
    add(context, data, size * count);
    return size * count;
}

client *client_new(const daemon_process *d)
{
    client *c = calloc(1, sizeof *c);
    assert_non_null(c);
    c->curl = curl_easy_init();
    assert_non_null(c->curl);
    c->daemon = d;
    return c;
}

void client_trust(client *c, const char *certificate)
{
    c->trusted = certificate;
}

void client_free(client *c)
{
    curl_easy_cleanup(c->curl);
    free(c);
}

void reply_free(reply *r)
{
    free(r->body);
    free(r->headers);
    cJSON_Delete(r->json);
    *r = (reply){0};
}

void reply_done(reply r)
{
    reply_free(&r);
}

reply reply_expect(long status, reply r)
{
    if (r.status != status) {
        fail_msg("status %ld instead of %ld: %.300s", r.status, status, r.body);
    }
    return r;
}

static struct curl_slist *header_list(const char *const *headers, bool has_body)
{
    struct curl_slist *list = NULL;
    bool typed = false;
    for (size_t i = 0; headers != NULL && headers[i] != NULL; i++) {
        typed |= strncasecmp(headers[i], "content-type:", 13) == 0;
        list = curl_slist_append(list, headers[i]);
    }
    if (has_body && !typed) {
        list = curl_slist_append(list, "Content-Type: application/json");
    }
    return list;
}

/* Writes a request, with the headers that were sent, and its answer to the recorded traffic, which
 * a later test compares with the OpenAPI document. */
static void record(const client_request *sent, const struct curl_slist *list, const reply *r)
{
    bytes head = {0};
    add(&head, "", 0);
    for (; list != NULL; list = list->next) {
        add(&head, list->data, strlen(list->data));
        add(&head, "\r\n", 2);
    }
    const traffic_message asked = {head.data, sent->body == NULL ? "" : sent->body, sent->length};
    traffic_record(sent->method, sent->path, &asked, r->status,
                   &(traffic_message){r->headers, r->body, r->length});
    free(head.data);
}

reply client_send_bytes(client *c, const client_request *request)
{
    const char *method = request->method, *path = request->path;
    char url[9000];
    bytes received = {0}, head = {0};
    add(&received, "", 0);
    add(&head, "", 0);
    curl_easy_reset(c->curl);
    if (strncmp(daemon_url(c->daemon), "unix:", 5) == 0) {
        snprintf(url, sizeof url, "http://localhost%s", path);
        curl_easy_setopt(c->curl, CURLOPT_UNIX_SOCKET_PATH, daemon_url(c->daemon) + 5);
    } else {
        snprintf(url, sizeof url, "%s%s", daemon_url(c->daemon), path);
    }
    if (c->trusted != NULL) {
        curl_easy_setopt(c->curl, CURLOPT_CAINFO, c->trusted);
    } else if (transport_get() == TRANSPORT_TLS) {
        curl_easy_setopt(c->curl, CURLOPT_CAINFO, transport_certificate());
    }
    struct curl_slist *list = header_list(request->headers, request->body != NULL);
    curl_easy_setopt(c->curl, CURLOPT_URL, url);
    curl_easy_setopt(c->curl, CURLOPT_PATH_AS_IS, 1L);
    curl_easy_setopt(c->curl, CURLOPT_CUSTOMREQUEST, method);
    curl_easy_setopt(c->curl, CURLOPT_HTTPHEADER, list);
    curl_easy_setopt(c->curl, CURLOPT_TIMEOUT, (long)LONGEST_SECONDS);
    curl_easy_setopt(c->curl, CURLOPT_NOPROXY, "*");
    curl_easy_setopt(c->curl, CURLOPT_WRITEFUNCTION, receive);
    curl_easy_setopt(c->curl, CURLOPT_WRITEDATA, &received);
    curl_easy_setopt(c->curl, CURLOPT_HEADERFUNCTION, receive);
    curl_easy_setopt(c->curl, CURLOPT_HEADERDATA, &head);
    if (strcmp(method, "HEAD") == 0) {
        curl_easy_setopt(c->curl, CURLOPT_NOBODY, 1L);
    }
    if (request->body != NULL) {
        curl_easy_setopt(c->curl, CURLOPT_POSTFIELDS, request->body);
        curl_easy_setopt(c->curl, CURLOPT_POSTFIELDSIZE_LARGE, (curl_off_t)request->length);
    }
    CURLcode code = curl_easy_perform(c->curl);
    reply r = {.body = received.data, .length = received.length, .headers = head.data};
    if (code != CURLE_OK) {
        print_error("%s %s: %s\n", method, path, curl_easy_strerror(code));
    }
    curl_easy_getinfo(c->curl, CURLINFO_RESPONSE_CODE, &r.status);
    if (code == CURLE_OK) {
        record(request, list, &r);
    }
    curl_slist_free_all(list);
    r.json = cJSON_ParseWithLength(r.body, r.length);
    return r;
}

reply client_send(client *c, const char *method, const char *path, const char *const *headers,
                  const char *body)
{
    const size_t length = body == NULL ? 0 : strlen(body);
    return client_send_bytes(c, &(client_request){method, path, headers, body, length});
}

reply client_get(client *c, const char *path)
{
    return client_send(c, "GET", path, NULL, NULL);
}

void client_await_running(client *c, const char *job)
{
    bool running = false;
    while (!running) {
        reply r = reply_expect(200, client_get(c, job));
        running = strcmp(reply_string(&r, "state"), "running") == 0;
        assert_true(running || strcmp(reply_string(&r, "state"), "queued") == 0);
        reply_free(&r);
    }
}

reply client_post(client *c, const char *path, const char *json)
{
    return client_send(c, "POST", path, NULL, json);
}

const char *reply_header(const reply *r, const char *name, char *value, size_t size)
{
    size_t length = strlen(name);
    value[0] = '\0';
    for (const char *line = r->headers; line != NULL && *line != '\0';) {
        const char *end = strstr(line, "\r\n");
        if (end == NULL) {
            break;
        }
        if (strncasecmp(line, name, length) == 0 && line[length] == ':') {
            const char *text = line + length + 1;
            while (*text == ' ') {
                text++;
            }
            snprintf(value, size, "%.*s", (int)(end - text), text);
            break;
        }
        line = end + 2;
    }
    return value;
}

const cJSON *reply_find(const reply *r, const char *path)
{
    const cJSON *at = r->json;
    for (const char *part = path; at != NULL && *part != '\0';) {
        char name[64];
        size_t length = strcspn(part, ".");
        snprintf(name, sizeof name, "%.*s", (int)length, part);
        at = cJSON_IsArray(at) ? cJSON_GetArrayItem(at, (int)strtol(name, NULL, 10))
                               : cJSON_GetObjectItemCaseSensitive(at, name);
        part += length + (part[length] == '.');
    }
    if (at == NULL) {
        fail_msg("no %s in %s", path, r->body);
    }
    return at;
}

double reply_number(const reply *r, const char *path)
{
    const cJSON *at = reply_find(r, path);
    if (!cJSON_IsNumber(at)) {
        fail_msg("%s is not a number in %s", path, r->body);
    }
    return at->valuedouble;
}

const char *reply_string(const reply *r, const char *path)
{
    const cJSON *at = reply_find(r, path);
    if (!cJSON_IsString(at)) {
        fail_msg("%s is not a string in %s", path, r->body);
    }
    return at->valuestring;
}

bool reply_is_null(const reply *r, const char *path)
{
    return cJSON_IsNull(reply_find(r, path));
}

int client_connect(const daemon_process *d, int buffer)
{
    const char *url = daemon_url(d);
    const bool is_path = strncmp(url, "unix:", 5) == 0;
    struct sockaddr_un local = {.sun_family = AF_UNIX};
    struct sockaddr_in address = {.sin_family = AF_INET,
                                  .sin_port = htons((uint16_t)daemon_port(d)),
                                  .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int fd = socket(is_path ? AF_UNIX : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    assert_true(fd >= 0);
    if (buffer > 0) {
        assert_int_equal(setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer), 0);
    }
    if (is_path) {
        snprintf(local.sun_path, sizeof local.sun_path, "%s", url + 5);
        assert_int_equal(connect(fd, (struct sockaddr *)&local, sizeof local), 0);
    } else {
        assert_int_equal(connect(fd, (struct sockaddr *)&address, sizeof address), 0);
    }
    return transport_get() == TRANSPORT_TLS ? transport_secure(fd, buffer) : fd;
}

/* Returns how many complete answers the data contains, judged by their Content-Length. */
static int count_answers(const char *data, size_t length)
{
    int count = 0;
    const char *at = data, *end = data + length;
    while (at < end) {
        const char *body = strstr(at, "\r\n\r\n");
        if (body == NULL) {
            break;
        }
        body += 4;
        size_t size = 0;
        for (const char *line = at; line < body; line++) {
            if (strncasecmp(line, "content-length:", 15) == 0) {
                size = (size_t)strtoull(line + 15, NULL, 10);
            }
        }
        if ((size_t)(end - body) < size) {
            break;
        }
        count++;
        at = body + size;
    }
    return count;
}

/* Records the first answer, for the comparison with the OpenAPI document, if the bytes up to the
 * end of the head are a request with a method and a target. The body is left out, because the tests
 * that send raw bytes are about where a body ends. */
static void record_raw(const char *request, size_t length, const char *answer)
{
    char method[16], target[8192];
    char *text = strndup(request, length);
    assert_non_null(text);
    const char *body = strstr(answer, "\r\n\r\n");
    if (sscanf(text, "%15[A-Z] %8191s HTTP/1.1\r\n", method, target) == 2 &&
        strstr(text, "\r\nHost:") != NULL && strstr(text, "\r\n\r\n") != NULL && body != NULL) {
        bytes head = {0};
        add(&head, answer, (size_t)(body + 2 - answer));
        strstr(text, "\r\n\r\n")[2] = '\0';
        bool chunked = strstr(head.data, "chunked") != NULL;
        traffic_record(method, target, &(traffic_message){.head = text}, client_raw_status(answer),
                       &(traffic_message){head.data, chunked ? NULL : body + 4, strlen(body + 4)});
        free(head.data);
    }
    free(text);
}

char *client_raw(const daemon_process *d, const char *data, size_t length, int answers,
                 bool half_close)
{
    int fd = client_connect(d, 0);
    size_t sent = 0;
    while (sent < length) {
        ssize_t n = send(fd, data + sent, length - sent, MSG_NOSIGNAL);
        if (n <= 0) {
            break; /* the server has closed the connection, but its answer can still be read */
        }
        sent += (size_t)n;
    }
    if (half_close) {
        shutdown(fd, SHUT_WR);
    }
    bytes received = {0};
    add(&received, "", 0);
    char buffer[4096];
    while (answers == 0 || count_answers(received.data, received.length) < answers) {
        struct pollfd wait = {.fd = fd, .events = POLLIN};
        if (poll(&wait, 1, LONGEST_SECONDS * 1000) <= 0) {
            fail_msg("no answer and no close within %d s", LONGEST_SECONDS);
        }
        ssize_t n = recv(fd, buffer, sizeof buffer, 0);
        if (n <= 0) {
            break;
        }
        add(&received, buffer, (size_t)n);
    }
    close(fd);
    if (answers == 1) {
        record_raw(data, length, received.data);
    }
    return received.data;
}

int client_raw_status(const char *data)
{
    return strncmp(data, "HTTP/1.", 7) == 0 && strlen(data) > 12 ? (int)strtol(data + 9, NULL, 10)
                                                                 : 0;
}
