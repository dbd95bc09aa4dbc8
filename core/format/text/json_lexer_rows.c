/* json_lexer_rows.c - reads a whole array of numbers at once: he_lexer_take_numbers and
 * he_lexer_take_indices. */
#include "format/text/json_lexer.h"

#include "format/text/json_bytes.h"
#include "format/text/number.h"
#include "mesh/mesh.h"

/* Returns the ',' or ']' that follows a number in an array; NULL if neither follows. */
static const char *pass_number(const char *at, const char *end)
{
    if (at < end && *at != ',' && *at != ']') {
        at = he_json_is_number_byte(*at) ? end : he_json_skip_blanks(at, end);
    }
    return at < end && (*at == ',' || *at == ']') ? at : NULL;
}

static size_t take_row(he_lexer *x, const char *bracket, size_t count)
{
    x->at = bracket + 1;
    x->state = HE_JSON_AFTER;
    return count;
}

size_t he_lexer_take_numbers(he_lexer *x, double *out, size_t most)
{
    const char *at = x->at, *end = x->end;
    if (*at != '[' || x->depth >= x->depth_most) {
        return 0;
    }
    for (size_t i = 0; i < most; i++) {
        size_t used;
        at = he_json_skip_blanks(at + 1, end);
        if (at == end || he_double_parse(at, end, HE_JSON_NUMBER, &out[i], &used) != HE_OK ||
            used > x->number_most) {
            return 0;
        }
        at = pass_number(at + used, end);
        if (at == NULL) {
            return 0;
        }
        if (*at == ']') {
            return take_row(x, at, i + 1);
        }
    }
    return 0;
}

/* Reads the decimal digits of an index. Returns NULL if there are none, or more digits than an id
 * can have. */
static const char *read_index(const char *at, const char *end, uint32_t *value)
{
    uint64_t sum = 0;
    const char *begin = at;
    while (at < end && *at >= '0' && *at <= '9') {
        sum = sum * 10 + (uint64_t)(*at - '0');
        at++;
        if (at - begin > 10) {
            return NULL;
        }
    }
    if (at == begin || (*begin == '0' && at - begin > 1) || sum >= HE_DEAD) {
        return NULL;
    }
    *value = (uint32_t)sum;
    return at;
}

size_t he_lexer_take_indices(he_lexer *x, uint32_t *out, size_t most)
{
    const char *at = x->at, *end = x->end;
    if (*at != '[' || x->depth >= x->depth_most) {
        return 0;
    }
    for (size_t i = 0; i < most; i++) {
        at = he_json_skip_blanks(at + 1, end);
        at = read_index(at, end, &out[i]);
        at = at != NULL ? pass_number(at, end) : NULL;
        if (at == NULL) {
            return 0;
        }
        if (*at == ']') {
            return take_row(x, at, i + 1);
        }
    }
    return 0;
}
