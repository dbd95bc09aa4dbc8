/* json_scan.h - checks a control document (a JSON body other than a mesh) before cJSON parses it.
 *
 * The lexer (format/text/json_lexer.h) enforces the grammar of RFC 8259 exactly, which cJSON does
 * not. The scan also limits the depth to API_MAX_DEPTH, the length of a number to API_MAX_NUMBER
 * bytes, because cJSON reads no more, and the number of values, because each costs a node of
 * cJSON. */
#ifndef HE_API_JSON_JSON_SCAN_H
#define HE_API_JSON_JSON_SCAN_H

#include "api/json/json_in.h"
#include "format/text/json_lexer.h"

/* Scans a whole text. If options->items is not NULL, the scan also finds the array whose items the
 * parsed document leaves out (api_items), and counts the items. */
bool api_json_scan(api_bytes text, const api_in_options *options, api_problem *problem);

/* Reads the next token of a JSON document, and adds to *values the number of JSON values that begin
 * with it (0 or 1). Refuses the document if it has more than `most` values. */
bool api_json_next(he_lexer *x, size_t *values, size_t most, he_token *token, api_problem *problem);

/* Refuses the text because of the byte at offset `place`. Returns false. The caller sets the JSON
 * pointer of the problem. */
bool api_json_refuse_at(api_problem *problem, uint64_t place, int code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Refuses the text because of a fault that the lexer found at offset `place`; the problem gets the
 * JSON pointer of the value at which the lexer stopped. */
bool api_json_refuse_fault(const he_lexer *x, uint64_t place, api_problem *problem);

#endif
