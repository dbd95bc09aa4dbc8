#include "api/json/json_scan.h"

#include "api/limits.h"
#include "format/text/json_string.h"

#include <stdarg.h>
#include <stdio.h>

bool api_json_refuse_at(api_problem *problem, uint64_t place, int code, const char *format, ...)
{
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return api_problem_set(problem, code, "byte %llu: %s", (unsigned long long)place, text);
}

static bool point(const he_lexer *x, api_problem *problem)
{
    he_lexer_pointer(x, problem->pointer, sizeof problem->pointer);
    problem->has_pointer = true;
    return false;
}

bool api_json_refuse_fault(const he_lexer *x, uint64_t place, api_problem *problem)
{
    if (x->fault == HE_FAULT_DEPTH) {
        api_json_refuse_at(problem, place, API_MALFORMED_JSON,
                           "the JSON is nested deeper than %d levels", API_MAX_DEPTH);
    } else if (x->fault == HE_FAULT_LONG_NUMBER) {
        api_json_refuse_at(problem, place, HE_BAD_VALUE, "the number has more than %zu characters",
                           x->number_most);
    } else if (x->fault == HE_FAULT_LONG_NAME) {
        api_json_refuse_at(problem, place, API_UNKNOWN_MEMBER,
                           "the name of a member is longer than %zu bytes", x->name_most);
    } else {
        api_json_refuse_at(problem, place,
                           x->fault == HE_FAULT_NOT_FINITE ? HE_NOT_FINITE : API_MALFORMED_JSON,
                           "%s", he_lexer_fault_text(x));
    }
    return point(x, problem);
}

bool api_json_next(he_lexer *x, size_t *values, size_t most, he_token *token, api_problem *problem)
{
    if (he_lexer_value_ahead(x) && ++*values > most) {
        api_json_refuse_at(problem, he_lexer_place(x), HE_LIMIT,
                           "the JSON has more than %zu values", most);
        return point(x, problem);
    }
    *token = he_lexer_next(x);
    if (*token == HE_TOKEN_FAULT) {
        return api_json_refuse_fault(x, x->fault_place, problem);
    }
    if (*token == HE_TOKEN_NUMBER && x->length > API_MAX_NUMBER) {
        api_json_refuse_at(problem, x->start, HE_BAD_VALUE,
                           "the number has %zu characters; at most %d are allowed", x->length,
                           API_MAX_NUMBER);
        return point(x, problem);
    }
    return true;
}

/* Returns true if the array that the lexer has just entered is the array whose items the caller
 * parses one by one (api_items). */
static bool opens_items(const he_lexer *x, const api_items *items)
{
    const he_lexer_frame *root = &x->frames[0];
    return items->at == NULL && x->depth == 2 && root->object &&
           he_json_text_is(root->name, root->name_length, items->name);
}

bool api_json_scan(api_bytes text, const api_in_options *options, api_problem *problem)
{
    api_items *items = options->items;
    he_lexer x;
    he_token token = HE_TOKEN_PART;
    size_t values = 0;
    bool inside = false; /* true if the scan is inside the array whose items the caller parses */
    he_lexer_init(&x, NULL);
    x.depth_most = API_MAX_DEPTH;
    x.offset = options->before;
    he_lexer_feed(&x, text.at, text.length);
    while (token != HE_TOKEN_END) {
        if (inside && x.depth == 2 && he_lexer_value_ahead(&x)) {
            items->count++;
        }
        if (!api_json_next(&x, &values, options->values, &token, problem)) {
            return false;
        }
        if (token == HE_TOKEN_ARRAY && items != NULL && opens_items(&x, items)) {
            inside = true;
            items->at = x.at;
            items->count = 0;
        } else if (token == HE_TOKEN_CLOSE && inside && x.depth == 1) {
            inside = false;
            items->end = x.at - 1;
        }
    }
    return true;
}
