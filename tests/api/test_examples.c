/* The examples in the OpenAPI document must equal the answers of the service. If this program is
 * called as `test_examples record FILE`, as by `make examples`, it writes the examples anew. */
#include "tests/api/examples_record.h"
#include "tests/json_member.h"

#include "api/describe/routes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* Prints one line of a text, which ends in a line feed or NUL. */
static void print_line(const char *mark, const char *line)
{
    print_error("%s%.*s\n", mark, (int)strcspn(line, "\n"), line);
}

static const char *line_after(const char *line)
{
    line += strcspn(line, "\n");
    return *line == '\0' ? line : line + 1;
}

static bool is_same_line(const char *a, const char *b)
{
    size_t length = strcspn(a, "\n");
    return length == strcspn(b, "\n") && memcmp(a, b, length) == 0;
}

/* Moves `*a` and `*b`, positions in two texts, to the nearest lines that are equal. */
static void find_equal(const char **a, const char **b)
{
    for (size_t distance = 0;; distance++) {
        const char *x = *a;
        for (size_t i = 0; i <= distance; i++, x = line_after(x)) {
            const char *y = *b;
            for (size_t k = i; k < distance; k++) {
                y = line_after(y);
            }
            if (is_same_line(x, y) && (*x == '\0') == (*y == '\0')) {
                *a = x;
                *b = y;
                return;
            }
        }
    }
}

/* Prints the lines in which two examples files differ. Above each group of such lines it prints the
 * route of the example to which they belong. */
static void print_difference(const char *recorded, const char *answered)
{
    const char *route = recorded;
    while (*recorded != '\0' || *answered != '\0') {
        if (is_same_line(recorded, answered) && *recorded != '\0' && *answered != '\0') {
            route = strncmp(recorded, "      \"route\"", 13) == 0 ? recorded : route;
            recorded = line_after(recorded);
            answered = line_after(answered);
            continue;
        }
        const char *a = recorded, *b = answered;
        find_equal(&a, &b);
        print_line("", route);
        for (; recorded < a; recorded = line_after(recorded)) {
            print_line("-", recorded);
        }
        for (; answered < b; answered = line_after(answered)) {
            print_line("+", answered);
        }
    }
}

static void each_example_is_a_real_answer(void **state)
{
    (void)state;
    api_examples file;
    api_text text = {0};
    assert_true(api_examples_read(&file));
    examples_record(&file, &text);
    api_text_add_char(&text, '\0');
    assert_false(text.failed);
    if (strcmp(api_examples_text, text.bytes) != 0) {
        print_error("api/describe/examples.json (-) and the answers of the service (+) differ:\n");
        print_difference(api_examples_text, text.bytes);
        fail_msg("if the new answers are right, `make examples` records them");
    }
    api_text_clear(&text);
    api_examples_clear(&file);
}

/* Requires that `content`, a part of the OpenAPI document, shows the body of the recorded example
 * `example` for the media type `media`. */
static void find_in(const cJSON *content, const char *media, const api_examples *file,
                    uint32_t example, api_example_part part)
{
    const cJSON *shown = json_member(json_member(content, media), "example");
    api_text body = {0};
    assert_true(api_example_body(file, example, part, &body));
    api_text_add_char(&body, '\0');
    if (cJSON_IsString(shown)) {
        assert_string_equal(shown->valuestring, body.bytes);
    } else {
        cJSON *parsed = cJSON_Parse(body.bytes);
        assert_true(cJSON_Compare(shown, parsed, true));
        cJSON_Delete(parsed);
    }
    api_text_clear(&body);
}

static void find_example(const cJSON *document, const api_examples *file, const cJSON *row)
{
    const char *name = json_member(row, "route")->valuestring;
    const char *produces = json_member(row, "produces")->valuestring;
    const cJSON *consumes = cJSON_GetObjectItemCaseSensitive(row, "consumes");
    const api_route *route = examples_route(name);
    char method[8] = "", status[8];
    for (size_t c = 0; c + 1 < sizeof method && route->method[c] != '\0'; c++) {
        method[c] = (char)(route->method[c] | 32);
    }
    const cJSON *operation =
        json_member(json_member(json_member(document, "paths"), route->path), method);
    snprintf(status, sizeof status, "%d", json_member(row, "status")->valueint);
    /* The file has no bytes of a binary answer. */
    if (strcmp(produces, "application/octet-stream") != 0) {
        find_in(json_member(json_member(json_member(operation, "responses"), status), "content"),
                produces, file, api_example_find(file, API_EXAMPLE_RESPONSE, name, produces),
                API_EXAMPLE_RESPONSE);
    }
    if (consumes != NULL) {
        find_in(json_member(json_member(operation, "requestBody"), "content"),
                consumes->valuestring, file,
                api_example_find(file, API_EXAMPLE_REQUEST, name, consumes->valuestring),
                API_EXAMPLE_REQUEST);
    }
}

static void the_description_shows_them(void **state)
{
    (void)state;
    api_examples file;
    assert_true(api_examples_read(&file));
    cJSON *rows = cJSON_Parse(api_examples_text);
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "GET", "/v1/openapi.json", NULL, NULL);
    assert_non_null(r.json);
    for (const cJSON *row = json_member(rows, "examples")->child; row != NULL; row = row->next) {
        if (json_member(row, "status")->valueint < 400) {
            find_example(r.json, &file, row);
        }
    }
    find_in(json_member(
                json_member(json_member(json_member(r.json, "components"), "responses"), "problem"),
                "content"),
            "application/problem+json", &file, api_example_problem(&file), API_EXAMPLE_RESPONSE);
    bench_reply_free(&r);
    bench_free(b);
    cJSON_Delete(rows);
    api_examples_clear(&file);
}

/* Returns whether the answers of the route are too long for an example: they print whole tables of
 * the API. */
static bool is_too_long(const char *route)
{
    return strcmp(route, "list_operations") == 0 || strcmp(route, "list_problems") == 0 ||
           strcmp(route, "get_openapi") == 0;
}

static void no_route_is_without_one(void **state)
{
    (void)state;
    api_examples file;
    assert_true(api_examples_read(&file));
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *route = &api_routes().rows[i];
        if ((route->flags & API_FIXED) || is_too_long(route->name)) {
            continue;
        }
        if (route->response != NULL && api_example_find(&file, API_EXAMPLE_RESPONSE, route->name,
                                                        route->produces[0]) == HE_NONE) {
            fail_msg("%s has no example of an answer", route->name);
        }
        if (route->request != NULL && api_example_find(&file, API_EXAMPLE_REQUEST, route->name,
                                                       route->consumes[0]) == HE_NONE) {
            fail_msg("%s has no example of a body", route->name);
        }
    }
    api_examples_clear(&file);
}

static void long_values_are_laid_out_on_lines(void **state)
{
    (void)state;
    static const char json[] =
        "{\"short\":[1,\"a, \\\"b\\\": "
        "c\"],\"long\":{\"first\":\"0123456789012345678901234567890123"
        "4567890123456789\",\"second\":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15]},\"none\":[]}";
    static const char lines[] =
        "{\n"
        "  \"short\": [1, \"a, \\\"b\\\": c\"],\n"
        "  \"long\": {\n"
        "    \"first\": \"01234567890123456789012345678901234567890123456789\",\n"
        "    \"second\": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]\n"
        "  },\n"
        "  \"none\": []\n"
        "}\n";
    api_text text = {0};
    examples_lay_out(json, strlen(json), &text);
    api_text_add_char(&text, '\0');
    assert_string_equal(text.bytes, lines);
    api_text_clear(&text);
}

/* Writes the examples file at `path` with the present answers of the service; a person then reviews
 * the difference. */
static int record_file(const char *path)
{
    api_examples file;
    api_text text = {0};
    assert_true(api_examples_read(&file));
    examples_record(&file, &text);
    FILE *to = fopen(path, "w");
    bool written = to != NULL && fwrite(text.bytes, 1, text.length, to) == text.length;
    written = to != NULL && fclose(to) == 0 && written;
    if (!written) {
        perror(path);
    }
    api_text_clear(&text);
    api_examples_clear(&file);
    return written ? 0 : 1;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_example_is_a_real_answer),
        cmocka_unit_test(the_description_shows_them),
        cmocka_unit_test(no_route_is_without_one),
        cmocka_unit_test(long_values_are_laid_out_on_lines),
    };
    return argc == 3 && strcmp(argv[1], "record") == 0 ? record_file(argv[2])
                                                       : cmocka_run_group_tests(tests, NULL, NULL);
}
