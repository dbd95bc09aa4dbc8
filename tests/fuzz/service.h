/* service.h - a service in the process, over a store with three small meshes: "m" is a square of
 * quads, "cube" closed, "bowtie" two triangles that meet at a vertex. */
#ifndef TESTS_FUZZ_SERVICE_H
#define TESTS_FUZZ_SERVICE_H

#include "tests/api/request.h"

api_bench *fuzz_service_new(void);

/* A copy of what the mesh of an id is now; NULL when there is none. It passes he_check. */
he_mesh *fuzz_service_mesh(api_bench *b, const char *id);

/* Could these bytes ask for much finer meshes? What is large by intent is no find. */
bool fuzz_service_refines(const void *bytes, size_t size);

/* Send a request; the status of the answer, which is well formed and no 500. Jobs are run to their
 * end. */
int fuzz_service_send(api_bench *b, const char *method, const char *target,
                      const char *const *headers, const char *body, size_t length);

#endif
