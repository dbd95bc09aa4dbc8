/* strip.h - a mesh of two polygons, called the strip, to which test_attributes.c and
 * test_attribute_writes.c write attributes. */
#ifndef TESTS_API_STRIP_H
#define TESTS_API_STRIP_H

#include "tests/api/request.h"

#include <stdio.h>

static const char OCTETS[] = "application/octet-stream";

/* Sends a request and requires that the answer has the status `status`. */
void strip_send(api_bench *b, int status, const char *method, const char *target, const char *body);

/* Creates the strip as the mesh `id`. If `edited` is set, one face and one vertex are then
 * deleted. */
void strip_make(api_bench *b, const char *id, bool edited);

#endif
