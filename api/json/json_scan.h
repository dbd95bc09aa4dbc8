/* json_scan.h - is this text one JSON value, to the letter of RFC 8259 and within our limits?
 *
 * What cJSON lets pass is refused here, before it runs: leading zeros, numbers that overflow, raw
 * control characters, invalid UTF-8, \u0000, lone surrogates, a byte order mark, anything after the
 * value, depth, and numbers of values that would cost too much memory. Linear, without recursion
 * and without memory of its own. */
#ifndef HE_API_JSON_JSON_SCAN_H
#define HE_API_JSON_JSON_SCAN_H

#include "api/json/json_in.h"

/* `items` NULL, or with `name` set: the array of that name in the root object is looked for. */
bool api_json_scan(const char *bytes, size_t length, const api_in_limits *limits, api_items *items,
                   api_problem *problem);

#endif
