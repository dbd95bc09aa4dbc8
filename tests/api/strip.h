/* strip.h - a strip of two polygons, for test_attributes.c and test_attribute_writes.c, which write
 * its attributes. */
#ifndef TESTS_API_STRIP_H
#define TESTS_API_STRIP_H

#include "tests/api/request.h"

#include <stdio.h>

static const char OCTETS[] = "application/octet-stream";

/* Sends a request, whose answer must have this status. */
void strip_send(api_bench *b, int status, const char *method, const char *target, const char *body);

/* Creates the strip as the mesh `id`; if `edited` is set, one of its faces and one of its vertices
 * have been deleted. */
void strip_make(api_bench *b, const char *id, bool edited);

#endif
