/* gate.h - sends requests to every route with every kind of token, exceeds each limit of a client,
 * and counts the answers that are wrong. */
#ifndef TESTS_API_GATE_H
#define TESTS_API_GATE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the number of answers that break the rules of api/request/gate.h; prints each of them if
 * `tell` is set. */
size_t gate_findings(bool tell);

/* Number of seconds by which the service's clock is ahead of the real time. The function that gives
 * the service the time adds this number. */
extern double gate_seconds_passed;
/* Returns in how many cases the service exceeds a limit on a token or an address, or accepts a
 * ticket that has expired; prints each such case if `tell` is true. */
size_t gate_limit_findings(bool tell);

#endif
