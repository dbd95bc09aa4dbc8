/* gate.h - every route of the table, asked by everybody who might: what is answered that should
 * not be. */
#ifndef TESTS_API_GATE_H
#define TESTS_API_GATE_H

#include <stdbool.h>
#include <stddef.h>

/* How many answers are not what the gate of gate.h promises; `tell` prints each. */
size_t gate_findings(bool tell);

#endif
