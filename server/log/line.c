#include "server/log/line.h"

#include "base/utf8.h"
#include "system/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char *srv_level_name(srv_level level)
{
    static const char *const names[] = {"error", "warning", "info", "debug"};
    return names[level];
}

/* Appends a value in a form that is safe on a terminal: bytes that would move the cursor or end the
 * line, and bytes that are not UTF-8, are written as numbers. */
static void add_readable(api_text *text, const char *value)
{
    for (size_t left = strlen(value), size; left > 0; value += size, left -= size) {
        const unsigned char c = (unsigned char)*value;
        size = he_utf8_character(value, left);
        if (c < 0x20 || c == 0x7F || size == 0) {
            api_text_add_format(text, "\\x%02x", (unsigned)c);
            size = 1;
        } else {
            api_text_add(text, value, size);
        }
    }
}

void srv_line_begin(srv_line *line, bool json, srv_level level, const char *format, va_list values)
{
    char time[ST_TIMESTAMP], message[SRV_MESSAGE];
    vsnprintf(message, sizeof message, format, values);
    st_clock_format(st_clock_utc(), time);
    *line = (srv_line){.level = level, .json = json};
    if (!json) {
        api_text_add_format(&line->text, "%s %s ", time, srv_level_name(level));
        add_readable(&line->text, message);
        return;
    }
    api_out_init(&line->out, &line->text);
    api_out_object_begin(&line->out);
    api_out_key_string(&line->out, "time", time);
    api_out_key_string(&line->out, "level", srv_level_name(level));
    api_out_key_string(&line->out, "message", message);
}

void srv_line_text(srv_line *line, const char *name, const char *value)
{
    if (line->json) {
        api_out_key_string(&line->out, name, value);
        return;
    }
    const char *quote = value[0] == '\0' || strpbrk(value, " \t\"=") != NULL ? "\"" : "";
    api_text_add_format(&line->text, " %s=%s", name, quote);
    add_readable(&line->text, value);
    api_text_add_string(&line->text, quote);
}

void srv_line_number(srv_line *line, const char *name, uint64_t value)
{
    if (line->json) {
        api_out_key_u64(&line->out, name, value);
    } else {
        api_text_add_format(&line->text, " %s=%" PRIu64, name, value);
    }
}

void srv_line_open(srv_line *line, const char *name)
{
    if (line->json) {
        api_out_key(&line->out, name);
        api_out_object_begin(&line->out);
    }
}

void srv_line_close(srv_line *line)
{
    if (line->json) {
        api_out_object_end(&line->out);
    }
}

void srv_line_end(srv_line *line)
{
    if (line->json) {
        api_out_object_end(&line->out);
    }
    api_text_add_char(&line->text, '\n');
}

void srv_line_clear(srv_line *line)
{
    api_text_clear(&line->text);
}

__attribute__((format(printf, 4, 5))) static void begin(srv_line *line, bool json, srv_level level,
                                                        const char *format, ...)
{
    va_list values;
    va_start(values, format);
    srv_line_begin(line, json, level, format, values);
    va_end(values);
}

void srv_line_write(int fd, bool json, srv_level level, const char *message)
{
    srv_line line;
    begin(&line, json, level, "%s", message);
    srv_line_end(&line);
    for (size_t at = 0; !line.text.failed && at < line.text.length;) {
        ssize_t written = write(fd, line.text.bytes + at, line.text.length - at);
        if (written < 0) {
            break;
        }
        at += (size_t)written;
    }
    srv_line_clear(&line);
}
