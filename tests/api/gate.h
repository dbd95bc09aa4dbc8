/* gate.h - every route of the table with every kind of token: which answers are wrong. */
#ifndef TESTS_API_GATE_H
#define TESTS_API_GATE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the number of answers that break the rules of api/request/gate.h; `tell`: prints each. */
size_t gate_findings(bool tell);

#endif
