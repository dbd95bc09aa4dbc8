/* examples_record.h - sends the session of api/describe/examples.json and writes the file anew,
 * with the answers that the service gives now. */
#ifndef TESTS_API_EXAMPLES_RECORD_H
#define TESTS_API_EXAMPLES_RECORD_H

#include "api/describe/examples.h"
#include "tests/api/request.h"

/* Sends all requests of `file` to a new service, and appends the whole file with these answers.
 * Text that the file lists under "differs" is as it is shown there. Fails the test if a request
 * reaches another route than the one it names. */
void examples_record(const api_examples *file, api_text *out);

/* Appends a JSON text with its values on lines of at most 100 characters if they fit, else with one
 * item or member on a line. */
void examples_lay_out(const char *json, size_t length, api_text *out);

/* Returns the row of the table of routes with this name; the test fails if there is none. */
const api_route *examples_route(const char *name);

#endif
