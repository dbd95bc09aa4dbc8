/* Complete requests as text, each line ended by a line feed: method and target, headers, and after
 * an empty line the body, which reaches to the end or to a line of one dot, after which the next
 * request follows. Each request must get a well-formed answer, and all meshes that exist afterwards
 * must pass he_check. */
#include "fuzz/fuzz.h"
#include "fuzz/service.h"
#include "unit/fixture.h"

enum { REQUESTS = 4, HEADERS = 8 };

/* Returns the text up to `stop` or the end, and ends it there with a NUL; *next is the text after
 * it. */
static char *cut(char *text, char stop, char **next)
{
    char *end = strchr(text, stop);
    *next = end == NULL ? text + strlen(text) : end + 1;
    if (end != NULL) {
        *end = '\0';
    }
    return text;
}

/* Returns the length of the body at `body`, which ends before a line of one dot or after `length`
 * bytes. */
static size_t body_length(const char *body, size_t length)
{
    for (size_t i = 0; i + 3 <= length; i++) {
        if (memcmp(body + i, "\n.\n", 3) == 0) {
            return i;
        }
    }
    return length;
}

/* Sends the request that begins at `text`, which ends in NUL and whose body may contain NULs.
 * Returns where the next request begins. */
static char *send(api_bench *b, char *text, const char *end)
{
    const char *headers[2 * HEADERS + 1] = {NULL};
    char *line, *rest, *body = NULL, *next = text + (end - text);
    size_t length = 0;
    line = cut(text, '\n', &rest);
    char *target, *method = cut(line, ' ', &target);
    for (size_t count = 0; rest < end && *rest != '\n' && *rest != '\0';) {
        char *value, *name = cut(rest, '\n', &rest);
        (void)cut(name, ':', &value);
        if (count < (size_t)2 * HEADERS && *value != '\0') {
            headers[count++] = name;
            headers[count++] = *value == ' ' ? value + 1 : value;
        }
    }
    if (rest < end && *rest == '\n') {
        body = rest + 1;
        length = body_length(body, (size_t)(end - body));
        next = length < (size_t)(end - body) ? body + length + 3 : next;
    }
    char *path = malloc(strlen(target) + 2);
    assert_non_null(path);
    (void)snprintf(path, strlen(target) + 2, "%s%s", *target == '/' ? "" : "/", target);
    (void)fuzz_service_send(b, &(bench_request){method, path, headers, body, length});
    free(path);
    return next;
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static const char *const ids[] = {"m", "cube", "bowtie", "n"};
    if (fuzz_service_refines(bytes, size)) {
        return;
    }
    api_bench *b = fuzz_service_new();
    char *text = malloc(size + 1), *at = text;
    assert_non_null(text);
    memcpy(text, bytes, size);
    text[size] = '\0';
    for (size_t i = 0; i < REQUESTS && at < text + size; i++) {
        at = send(b, at, text + size);
    }
    free(text);
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) {
        he_mesh_free(fuzz_service_mesh(b, ids[i]));
    }
    bench_free(b);
}
