#include "tests/e2e/listener.h"

#include "tests/e2e/client.h"

#include <errno.h>
#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

/* If nothing comes for this long, the test fails instead of waiting for ever. No test depends on
 * the exact time. */
enum { LONGEST_SECONDS = 600 };

static void wait_readable(const listener *l)
{
    struct pollfd wait = {.fd = l->socket, .events = POLLIN};
    if (poll(&wait, 1, LONGEST_SECONDS * 1000) <= 0) {
        fail_msg("the stream was silent for %d s", LONGEST_SECONDS);
    }
}

static void read_head(listener *l)
{
    char head[4096];
    size_t length = 0;
    while (length < 4 || memcmp(head + length - 4, "\r\n\r\n", 4) != 0) {
        assert_true(length + 1 < sizeof head);
        wait_readable(l);
        ssize_t got = recv(l->socket, head + length, 1, 0);
        assert_int_equal(got, 1);
        length++;
    }
    head[length] = '\0';
    l->status = client_raw_status(head);
    assert_true(l->status != 200 || strstr(head, "\r\nTransfer-Encoding: chunked\r\n") != NULL);
    assert_true(l->status != 200 ||
                strstr(head, "\r\nContent-Type: text/event-stream\r\n") != NULL);
}

static listener *open_with(const daemon_process *d, const char *target, const char *header,
                           const char *value, int buffer)
{
    char request[512];
    listener *l = calloc(1, sizeof *l);
    assert_non_null(l);
    l->socket = client_connect(d, 0);
    if (buffer > 0) {
        setsockopt(l->socket, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
    }
    int length = snprintf(
        request, sizeof request, "GET %s HTTP/1.1\r\nHost: localhost\r\n%s%s%s\r\n", target,
        value == NULL ? "" : header, value == NULL ? "" : value, value == NULL ? "" : "\r\n");
    assert_true(length > 0 && (size_t)length < sizeof request);
    assert_int_equal(send(l->socket, request, (size_t)length, MSG_NOSIGNAL), length);
    read_head(l);
    return l;
}

listener *listener_open(const daemon_process *d, const char *target, const char *last, int buffer)
{
    return open_with(d, target, "Last-Event-ID: ", last, buffer);
}

listener *listener_open_as(const daemon_process *d, const char *target, const char *token)
{
    return open_with(d, target, "Authorization: Bearer ", token, 0);
}

void listener_close(listener *l)
{
    close(l->socket);
    sse_clear(&l->events);
    cJSON_Delete(l->data);
    free(l);
}

/* Handles the end of a line around a chunk of the answer: the line is the size of the next chunk,
 * or the blank line after the previous chunk. */
static void end_line(listener *l)
{
    l->line[l->line_length] = '\0';
    if (l->line_length > 0) {
        char *end;
        l->left = strtoul(l->line, &end, 16);
        assert_ptr_equal(end, l->line + l->line_length);
        l->ended = l->left == 0;
    }
    l->line_length = 0;
}

static void decode(listener *l, const char *bytes, size_t length)
{
    for (size_t at = 0; at < length && !l->ended;) {
        if (l->left > 0) {
            size_t part = length - at < l->left ? length - at : l->left;
            sse_add(&l->events, bytes + at, part);
            l->left -= part;
            at += part;
            continue;
        }
        char c = bytes[at++];
        if (c == '\n') {
            end_line(l);
        } else if (c != '\r') {
            assert_true(l->line_length + 1 < sizeof l->line);
            l->line[l->line_length++] = c;
        }
    }
}

/* Reads what has arrived at the socket. Returns false at the end of the stream, and if nothing has
 * arrived and `patient` is false. */
static bool receive(listener *l, bool patient)
{
    char buffer[16 * 1024];
    if (l->ended) {
        return false;
    }
    if (patient) {
        wait_readable(l);
    }
    ssize_t got = recv(l->socket, buffer, sizeof buffer, MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        return false;
    }
    if (got <= 0) {
        fail_msg("the stream was cut off");
    }
    decode(l, buffer, (size_t)got);
    return true;
}

const char *listener_next(listener *l, bool patient)
{
    sse_event event;
    cJSON_Delete(l->data);
    l->data = NULL;
    while (!sse_next(&l->events, &event)) {
        if (!receive(l, patient)) {
            return "";
        }
    }
    l->data = cJSON_Parse(event.data);
    assert_non_null(l->data);
    return event.name;
}

void listener_wait_idle(listener *l, size_t comments)
{
    sse_event event;
    while (l->events.idle < comments) {
        if (sse_next(&l->events, &event)) {
            fail_msg("an event where silence was expected: %s", event.name);
        }
        if (l->events.idle < comments) {
            assert_true(receive(l, true));
        }
    }
}

const char *listener_string(const listener *l, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(l->data, name);
    assert_true(cJSON_IsString(found));
    return found->valuestring;
}

double listener_number(const listener *l, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(l->data, name);
    assert_true(cJSON_IsNumber(found));
    return found->valuedouble;
}
