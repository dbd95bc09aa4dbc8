#include "tests/traffic.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* Writes a JSON string without cJSON. cJSON allocates through the api, whose allocations a test may
 * be making fail. */
static void write_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\' || (unsigned char)*text < ' ') {
            fprintf(out, "\\u%04x", (unsigned)*text);
        } else {
            fputc(*text, out);
        }
    }
    fputc('"', out);
}

static void write_base64(FILE *out, const char *bytes, size_t length)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < length; i += 3) {
        size_t left = length - i;
        uint32_t three = 0;
        for (size_t j = 0; j < 3; j++) {
            three = three << 8 | (j < left ? (unsigned char)bytes[i + j] : 0U);
        }
        for (size_t j = 0; j < 4; j++) {
            fputc(j <= left ? digits[three >> (18 - 6 * j) & 63] : '=', out);
        }
    }
}

static void write_message(FILE *out, const char *name, const traffic_message *message)
{
    fprintf(out, ",\"%s\":{\"head\":", name);
    write_string(out, message->head);
    if (message->body != NULL) {
        size_t most = strstr(message->head, "json") != NULL ? TRAFFIC_JSON : TRAFFIC_OTHER;
        fprintf(out, ",\"length\":%zu,\"body\":\"", message->length);
        write_base64(out, message->body, message->length < most ? message->length : most);
        fputc('"', out);
    }
    fputc('}', out);
}

void traffic_record(const char *method, const char *target, const traffic_message *request,
                    long status, const traffic_message *answer)
{
    const char *folder = getenv("TRAFFIC");
    if (folder == NULL) {
        return;
    }
    char *line, path[4096];
    size_t length;
    FILE *out = open_memstream(&line, &length);
    assert_non_null(out);
    fputs("{\"method\":", out);
    write_string(out, method);
    fputs(",\"target\":", out);
    write_string(out, target);
    fprintf(out, ",\"status\":%ld", status);
    write_message(out, "request", request);
    write_message(out, "answer", answer);
    fputs("}\n", out);
    assert_int_equal(fclose(out), 0);
    /* A line is written by one call, because threads of a test share the file and their lines must
     * not mix. */
    snprintf(path, sizeof path, "%s/c-%d.ndjson", folder, (int)getpid());
    int fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, line, length), length);
    close(fd);
    free(line);
}
