/* history.h - a mesh with a history of four revisions, for test_history.c and
 * test_at_revision.c. */
#ifndef TESTS_API_HISTORY_H
#define TESTS_API_HISTORY_H

#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { TARGET = 200 };

/* Sends a POST to a resource of the mesh, such as "edits". */
bench_reply history_post(api_bench *b, const char *what, const char *body);

/* Returns the number in the member `name` of the JSON object. */
double history_number(const cJSON *object, const char *name);

/* Returns the error code of an answer that is a problem document. */
const char *history_code(const bench_reply *r);

/* Creates a cube (revision 1), pokes one of its faces (revision 2), deletes another face (3), and
 * undoes the deletion (4). */
api_bench *history_begin(void);

#endif
