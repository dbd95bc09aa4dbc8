#include "server/log/access.h"

#include "format/text/number.h"
#include "system/clock.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* The line of a request is formatted without printf, which would be too slow at high rates of
 * requests. */

static const char *const part_names[SRV_PARTS] = {"receive", "queue", "lock",
                                                  "work",    "store", "send"};

/* Appends a text and escapes every byte that is not printable ASCII, because the text comes from
 * the client and was never decoded. */
static void append_text(char line[SRV_ACCESS_LINE], size_t *at, const char *text)
{
    size_t end = *at;
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        assert(end + 8 < SRV_ACCESS_LINE);
        if (*c < 0x20 || *c >= 0x7F || *c == '"' || *c == '\\') {
            end += (size_t)snprintf(line + end, 7, "\\u%04x", (unsigned)*c);
        } else {
            line[end++] = (char)*c;
        }
    }
    *at = end;
}

/* Appends a text that has only printable ASCII characters and fits into the line. */
static void append(char line[SRV_ACCESS_LINE], size_t *at, const char *text)
{
    size_t length = strlen(text);
    assert(*at + length < SRV_ACCESS_LINE);
    memcpy(line + *at, text, length);
    *at += length;
}

static void append_member(char line[SRV_ACCESS_LINE], size_t *at, const char *key,
                          const char *value)
{
    append(line, at, key);
    append_text(line, at, value);
    line[(*at)++] = '"';
}

static void append_number(char line[SRV_ACCESS_LINE], size_t *at, const char *key, int64_t value)
{
    append(line, at, key);
    *at += he_i64_print(value, line + *at);
}

/* Appends milliseconds with microseconds as decimals: "12.345". */
static void append_millis(char line[SRV_ACCESS_LINE], size_t *at, uint64_t micros)
{
    const unsigned rest = (unsigned)(micros % 1000);
    append_number(line, at, "", (int64_t)(micros / 1000));
    line[(*at)++] = '.';
    line[(*at)++] = (char)('0' + rest / 100);
    line[(*at)++] = (char)('0' + rest / 10 % 10);
    line[(*at)++] = (char)('0' + rest % 10);
}

static const char *route_of(const srv_access *access)
{
    return access->route == NULL ? "-" : access->route;
}

static void append_head(char line[SRV_ACCESS_LINE], size_t *at, const srv_access *access,
                        const char *kind)
{
    char time[ST_TIMESTAMP];
    st_clock_format(access->time, time);
    append_member(line, at, "{\"time\":\"", time);
    append(line, at, kind);
    append_member(line, at, ",\"request_id\":\"", access->request_id);
    append_member(line, at, ",\"method\":\"", access->method);
    append_member(line, at, ",\"path\":\"", access->path);
    append_member(line, at, ",\"route\":\"", route_of(access));
    append_number(line, at, ",\"status\":", access->status);
}

static void append_trace(char line[SRV_ACCESS_LINE], size_t *at, const srv_access *access)
{
    if (access->trace_id[0] != '\0') {
        append_member(line, at, ",\"trace_id\":\"", access->trace_id);
        if (access->parent_id[0] != '\0') {
            append_member(line, at, ",\"parent_id\":\"", access->parent_id);
        }
        append_member(line, at, ",\"span_id\":\"", access->span_id);
    }
}

static size_t end_line(char line[SRV_ACCESS_LINE], size_t at)
{
    line[at++] = '\n';
    line[at] = '\0';
    return at;
}

/* Appends the part of a line that people read first, such as 2026-01-31T12:00:00.000Z info ::1 GET
 * /v1/meshes 200. */
static void append_readable(char line[SRV_ACCESS_LINE], size_t *at, const srv_access *access,
                            const char *kind)
{
    char time[ST_TIMESTAMP];
    st_clock_format(access->time, time);
    append(line, at, time);
    append(line, at, kind);
    append_text(line, at, access->peer);
    append(line, at, " ");
    append_text(line, at, access->method);
    append(line, at, " ");
    append_text(line, at, access->path);
    append_number(line, at, " ", access->status);
}

static void append_ids(char line[SRV_ACCESS_LINE], size_t *at, const srv_access *access)
{
    append(line, at, " id=");
    append_text(line, at, access->request_id);
    if (access->trace_id[0] != '\0') {
        append(line, at, " trace=");
        append(line, at, access->trace_id);
        append(line, at, "/");
        append(line, at, access->parent_id[0] == '\0' ? "-" : access->parent_id);
        append(line, at, "/");
        append(line, at, access->span_id);
    }
}

/* Writes the line of a request. The fields are bounded so that SRV_ACCESS_LINE holds even a path in
 * which every byte is escaped; a request id was checked, and a method is a token. */
size_t srv_access_format(const srv_access *access, bool json, char line[SRV_ACCESS_LINE])
{
    size_t at = 0;
    if (!json) {
        append_readable(line, &at, access, " info ");
        append_number(line, &at, " in=", (int64_t)access->bytes_in);
        append_number(line, &at, " out=", (int64_t)access->bytes_out);
        append(line, &at, " ");
        append_millis(line, &at, access->duration_us);
        append(line, &at, "ms");
        append_ids(line, &at, access);
        return end_line(line, at);
    }
    append_head(line, &at, access, ",\"level\":\"info\",\"event\":\"request\"");
    append_number(line, &at, ",\"bytes_in\":", (int64_t)access->bytes_in);
    append_number(line, &at, ",\"bytes_out\":", (int64_t)access->bytes_out);
    append_number(line, &at, ",\"duration_us\":", (int64_t)access->duration_us);
    append_member(line, &at, ",\"peer\":\"", access->peer);
    append_trace(line, &at, access);
    append(line, &at, "}");
    return end_line(line, at);
}

size_t srv_access_format_slow(const srv_access *access, bool json, char line[SRV_ACCESS_LINE])
{
    size_t at = 0;
    if (!json) {
        append_readable(line, &at, access, " warning slow: ");
        append(line, &at, " ");
        append_millis(line, &at, access->duration_us);
        append(line, &at, "ms:");
        for (size_t i = 0; i < SRV_PARTS; i++) {
            append(line, &at, " ");
            append(line, &at, part_names[i]);
            append(line, &at, " ");
            append_millis(line, &at, access->parts[i]);
        }
        append_ids(line, &at, access);
        return end_line(line, at);
    }
    append_head(line, &at, access, ",\"level\":\"warning\",\"event\":\"slow\"");
    append_number(line, &at, ",\"duration_us\":", (int64_t)access->duration_us);
    for (size_t i = 0; i < SRV_PARTS; i++) {
        append(line, &at, ",\"");
        append(line, &at, part_names[i]);
        append_number(line, &at, "_us\":", (int64_t)access->parts[i]);
    }
    append_trace(line, &at, access);
    append(line, &at, "}");
    return end_line(line, at);
}
