/* gate.h - tries every route of the API with every kind of token, and reports wrong answers. The
 * gate (api/request/gate.h) is the code that decides whether the token of a request may do what it
 * asks. */
#ifndef TESTS_API_GATE_H
#define TESTS_API_GATE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the number of answers that break the rules of api/request/gate.h; if `tell` is set,
 * prints each of them. */
size_t gate_findings(bool tell);

#endif
