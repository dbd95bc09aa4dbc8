#include "api/describe/examples.h"

#include <assert.h>
#include <string.h>

/* The assembler copies examples.json into the object file. The path is relative to the top of the
 * source tree, where make runs the compiler. */
__asm__(".pushsection .rodata\n"
        ".global api_examples_text\n"
        "api_examples_text:\n"
        ".incbin \"api/describe/examples.json\"\n"
        ".byte 0\n"
        ".popsection\n");

bool api_examples_read(api_examples *examples)
{
    he_error err;
    *examples = (api_examples){0};
    he_status status =
        he_json_parse(&examples->json, api_examples_text, strlen(api_examples_text), 0, NULL, &err);
    if (status == HE_NO_MEMORY) {
        return false;
    }
    assert(status == HE_OK);
    examples->list = he_json_find(&examples->json, 0, "examples");
    return true;
}

void api_examples_clear(api_examples *examples)
{
    he_json_clear(&examples->json);
}

static bool is_refused(const he_json *json, uint32_t example)
{
    uint64_t status = 0;
    he_error err;
    uint32_t value = he_json_find(json, example, "status");
    return value != HE_NONE && he_json_whole(json, value, 100, 599, &status, &err) == HE_OK &&
           status >= 400;
}

/* The names of the members of an example that describe its request's body and its answer's body. */
static const struct {
    const char *media, *json, *text;
} parts[] = {
    [API_EXAMPLE_REQUEST] = {"consumes", "request", "request_text"},
    [API_EXAMPLE_RESPONSE] = {"produces", "response", "response_text"},
};

uint32_t api_example_find(const api_examples *examples, api_example_part part, const char *route,
                          const char *media)
{
    const he_json *json = &examples->json;
    uint32_t i = he_json_first(json, examples->list);
    while (i != HE_NONE &&
           (is_refused(json, i) || !he_json_is(json, he_json_find(json, i, "route"), route) ||
            !he_json_is(json, he_json_find(json, i, parts[part].media), media))) {
        i = he_json_after(json, examples->list, i);
    }
    return i;
}

uint32_t api_example_problem(const api_examples *examples)
{
    const he_json *json = &examples->json;
    uint32_t i = he_json_first(json, examples->list);
    while (!is_refused(json, i)) {
        i = he_json_after(json, examples->list, i);
    }
    return i;
}

void api_example_value(const api_examples *examples, uint32_t value, api_text *text)
{
    const char *at = examples->json.text + examples->json.values[value].at;
    size_t depth = 0;
    bool quoted = false;
    for (;; at++) {
        if (quoted && *at == '\\') {
            api_text_add_char(text, *at++);
        } else if (*at == '"') {
            quoted = !quoted;
        } else if (!quoted && strchr(" \n\r\t", *at) != NULL) {
            continue;
        } else if (!quoted && (*at == '{' || *at == '[')) {
            depth++;
        } else if (!quoted && (*at == '}' || *at == ']')) {
            depth--;
        }
        api_text_add_char(text, *at);
        if (!quoted && depth == 0 && (strchr("}]\"", *at) != NULL || strchr(",}] \n", at[1]))) {
            return;
        }
    }
}

/* Appends the strings of a JSON list, one after the other. */
static void add_texts(const he_json *json, uint32_t list, api_text *text)
{
    for (uint32_t i = he_json_first(json, list); i != HE_NONE; i = he_json_after(json, list, i)) {
        size_t length;
        (void)he_json_raw(json, i, &length);
        char *room = api_text_room(text, length + 1);
        if (room != NULL) {
            text->length += he_json_string(json, i, room, length + 1);
        }
    }
}

bool api_example_body(const api_examples *examples, uint32_t example, api_example_part part,
                      api_text *text)
{
    const he_json *json = &examples->json;
    uint32_t value = he_json_find(json, example, parts[part].json);
    uint32_t list = he_json_find(json, example, parts[part].text);
    if (value != HE_NONE) {
        api_example_value(examples, value, text);
    } else if (list != HE_NONE) {
        add_texts(json, list, text);
    }
    return value != HE_NONE || list != HE_NONE;
}
