/* examples_record.h - sends the requests in api/describe/examples.json to a new service and writes
 * the file anew with the answers of that service. */
#ifndef TESTS_API_EXAMPLES_RECORD_H
#define TESTS_API_EXAMPLES_RECORD_H

#include "api/describe/examples.h"
#include "tests/api/request.h"

/* Sends all requests of `file` to a new service and appends to `out` the whole file with the
 * answers. Text that differs from run to run (the member "differs" of the file lists it) is copied
 * from `file`, not from the new answers. Fails the test if a request reaches a route other than the
 * one that its row in the file names. */
void examples_record(const api_examples *file, api_text *out);

/* Appends a JSON text. A value is written on one line if that line has at most 100 characters, else
 * with one item or member on a line. */
void examples_lay_out(const char *json, size_t length, api_text *out);

/* Returns the route whose name is `name`, a row of the table of routes; the test fails if there is
 * none. */
const api_route *examples_route(const char *name);

#endif
