#include "api/document/members.h"

#include "api/limits.h"

void api_members_clear(api_members *m)
{
    api_text_clear(&m->text);
}

void api_members_empty(api_members *m)
{
    api_text_empty(&m->text);
}

/* Appends bytes to the gathered members. `place` is the offset of the first of these bytes in the
 * body. */
static bool add(api_members *m, const he_lexer *x, api_bytes bytes, uint64_t place,
                api_problem *problem)
{
    size_t room = m->most - m->text.length;
    if (bytes.length > room) {
        api_json_refuse_at(problem, place + room, HE_LIMIT, "%s exceed %zu bytes", m->what,
                           m->most);
    } else {
        api_text_add(&m->text, bytes.at, bytes.length);
        if (!m->text.failed) {
            return true;
        }
        api_json_refuse_at(problem, place, HE_NO_MEMORY, "no memory for %s", m->what);
    }
    he_lexer_pointer(x, problem->pointer, sizeof problem->pointer);
    problem->has_pointer = true;
    return false;
}

bool api_members_begin(api_members *m, he_lexer *x, api_problem *problem)
{
    const he_lexer_frame *object = &x->frames[x->depth - 1];
    bool first = m->text.length == 0;
    uint64_t place = he_lexer_place(x);
    if (first) {
        m->values = 1; /* the object itself */
    }
    m->from = x->at;
    m->depth = x->depth;
    m->name_most = x->name_most;
    x->name_most = SIZE_MAX;
    x->depth_most = m->depth + API_MAX_DEPTH - 1;
    return add(m, x, (api_bytes){first ? "{\"" : ",\"", 2}, place, problem) &&
           add(m, x, (api_bytes){object->name, object->name_length}, place, problem) &&
           add(m, x, (api_bytes){"\":", 2}, place, problem);
}

/* Appends to the gathered members the bytes that the lexer has passed since the last call. */
static bool add_passed(api_members *m, const he_lexer *x, api_problem *problem)
{
    const char *from = m->from != NULL ? m->from : x->begin;
    m->from = NULL;
    return add(m, x, (api_bytes){from, (size_t)(x->at - from)},
               x->offset + (uint64_t)(from - x->begin), problem);
}

bool api_members_feed(api_members *m, he_lexer *x, bool *done, api_problem *problem)
{
    he_token token;
    do {
        api_problem wrong = {0};
        if (!api_json_next(x, &m->values, m->values_most, &token, &wrong)) {
            /* If the members have more bytes than allowed, that is reported, and not the fault in
             * the JSON, which lies behind the limit. So the problem does not depend on where the
             * pieces of the body were cut. */
            if (add_passed(m, x, problem)) {
                *problem = wrong;
            }
            return false;
        }
        *done = x->depth == m->depth && token != HE_TOKEN_CUT && token != HE_TOKEN_PART;
    } while (!*done && token != HE_TOKEN_CUT);
    if (*done) {
        x->name_most = m->name_most;
        x->depth_most = API_MAX_DEPTH;
    }
    return add_passed(m, x, problem);
}

bool api_members_parse(api_members *m, api_document *out, api_in *root, api_problem *problem)
{
    api_text_add_string(&m->text, m->text.length == 0 ? "{}" : "}");
    return !m->text.failed
               ? api_document_parse_scanned(api_text_bytes(&m->text), out, root, problem)
               : api_problem_set(problem, HE_NO_MEMORY, "no memory for %s", m->what);
}
