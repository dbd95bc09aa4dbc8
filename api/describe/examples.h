/* examples.h - one session with a small mesh, request by request, as the OpenAPI document shows it.
 *
 * If a client sends these requests in this order to a server without meshes, each answer is as its
 * row says, apart from times, bytes of memory and the ids of jobs; tests/api/test_examples.c checks
 * that. The server has two jobs: API_EXAMPLE_JOB made a mesh that was deleted since, and
 * API_EXAMPLE_WAITING has not begun. */
#ifndef HE_API_DESCRIBE_EXAMPLES_H
#define HE_API_DESCRIBE_EXAMPLES_H

#include <stdbool.h>
#include <stddef.h>

#define API_EXAMPLE_JOB     "b3vCwT0aQkPz81LmXyRs2d"
#define API_EXAMPLE_WAITING "Zq7HnE4uYfJc90GtKoVi5p"

typedef struct api_example {
    const char *route;              /* name of its row in the route table */
    const char *target;             /* path and query */
    const char *consumes, *request; /* media type and body; NULL: none */
    int status;
    const char *produces, *response;
} api_example;

size_t api_example_count(void);
const api_example *api_example_at(size_t i);

/* Returns the body of the first successful example of a route with this media type, as sent or as
 * received, or NULL. */
const char *api_example_request(const char *route, const char *media);
const char *api_example_response(const char *route, const char *media);
/* Returns the first example of a refused request. */
const char *api_example_problem(void);

#endif
