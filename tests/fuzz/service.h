/* service.h - a service in the process of the fuzz target, with a store of three small meshes: "m"
 * is a square of quads, "cube" is closed, "bowtie" has two triangles that share only a vertex. */
#ifndef TESTS_FUZZ_SERVICE_H
#define TESTS_FUZZ_SERVICE_H

#include "tests/api/request.h"

api_bench *fuzz_service_new(void);

/* Returns a copy of the present mesh with this id, NULL if there is none; requires that it passes
 * he_check. */
he_mesh *fuzz_service_mesh(api_bench *b, const char *id);

/* Returns whether these bytes, sent as a request, may make a much finer mesh. Such inputs are
 * skipped, because it is no fault that a request for a large mesh takes much memory. */
bool fuzz_service_refines(const void *bytes, size_t size);

/* Sends a request, and runs jobs to their end. Returns the status of the answer; requires that the
 * answer is well-formed and that the status is not 500. */
int fuzz_service_send(api_bench *b, const bench_request *request);

#endif
