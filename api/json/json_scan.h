/* json_scan.h - what may stand in a control document, before cJSON reads it.
 *
 * The lexer (format/text/json_lexer.h) holds the text to the letter of RFC 8259, which cJSON does
 * not. Here the depth is held to API_MAX_DEPTH, numbers to API_MAX_NUMBER bytes, for cJSON reads no
 * more, and values to a number that says what cJSON's nodes may cost. */
#ifndef HE_API_JSON_JSON_SCAN_H
#define HE_API_JSON_JSON_SCAN_H

#include "api/json/json_in.h"
#include "format/text/json_lexer.h"

/* Scans a whole text. `items` NULL, or with `name` set: the array of that name in the root object
 * is looked for. */
bool api_json_scan(const char *bytes, size_t length, const api_in_limits *limits, api_items *items,
                   api_problem *problem);

/* The next token of such a document, whose values are counted in `*values`. */
bool api_json_next(he_lexer *x, size_t *values, size_t most, he_token *token, api_problem *problem);

/* Refuse the byte `place` of what the client sent. Returns false; the pointer is the caller's. */
bool api_json_refuse_at(api_problem *problem, uint64_t place, int code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Refuse what the lexer found at fault, at the byte `place`, with the pointer of x's place. */
bool api_json_refuse_fault(const he_lexer *x, uint64_t place, api_problem *problem);

#endif
