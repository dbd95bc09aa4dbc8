/* gate.h - tries every route of the table with every kind of token, and each limit of a client, and
 * counts the answers that are wrong. */
#ifndef TESTS_API_GATE_H
#define TESTS_API_GATE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the number of answers that break the rules of api/request/gate.h; if `tell`, prints
 * each. */
size_t gate_findings(bool tell);

/* Seconds by which the wall clock of the service under test is ahead; its program adds them. */
extern double gate_seconds_passed;
/* Returns the number of limits of tokens and addresses, and of ends of tickets, that do not hold;
 * if `tell`, prints each. */
size_t gate_limit_findings(bool tell);

#endif
