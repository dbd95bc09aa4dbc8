#include "tests/sse.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void sse_clear(sse *s)
{
    free(s->bytes);
    free(s->block);
    *s = (sse){0};
}

void sse_add(sse *s, const char *bytes, size_t length)
{
    if (s->length + length > s->capacity) {
        s->capacity = 2 * (s->length + length);
        s->bytes = realloc(s->bytes, s->capacity);
        assert_non_null(s->bytes);
    }
    memcpy(s->bytes + s->length, bytes, length);
    s->length += length;
}

/* Moves the first block of lines, up to its blank line, from the received bytes to `block`. Returns
 * false if the block has not arrived completely. */
static bool next_block(sse *s)
{
    for (size_t i = 0; i + 1 < s->length; i++) {
        if (s->bytes[i] == '\n' && s->bytes[i + 1] == '\n') {
            free(s->block);
            s->block = strndup(s->bytes, i + 1);
            assert_non_null(s->block);
            s->length -= i + 2;
            memmove(s->bytes, s->bytes + i + 2, s->length);
            s->blocks++;
            return true;
        }
    }
    return false;
}

static char *value_after(char *line, const char *field)
{
    size_t length = strlen(field);
    return strncmp(line, field, length) == 0 ? line + length : NULL;
}

static void read_block(sse *s, sse_event *out)
{
    *out = (sse_event){.name = "message"};
    char *rest = NULL;
    for (char *line = strtok_r(s->block, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        char *id = value_after(line, "id: "), *name = value_after(line, "event: ");
        char *data = value_after(line, "data: ");
        if (id != NULL) {
            (void)snprintf(s->id, sizeof s->id, "%s", id);
        } else if (name != NULL) {
            out->name = name;
        } else if (data != NULL) {
            assert_null(out->data);
            out->data = data;
        } else if (line[0] == ':') {
            s->idle++;
        } else {
            assert_non_null(value_after(line, "retry: "));
        }
    }
}

bool sse_next(sse *s, sse_event *out)
{
    while (next_block(s)) {
        read_block(s, out);
        if (out->data != NULL) {
            return true;
        }
    }
    return false;
}
