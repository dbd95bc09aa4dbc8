/* examples.h - the example requests and answers of the OpenAPI document. Together they are one
 * session with a small mesh.
 *
 * The session is in the file api/describe/examples.json, which is compiled into the program. If a
 * client sends the requests in their order to a server without meshes, each answer equals the
 * recorded one, apart from what the file lists under "differs". tests/api/test_examples.c checks
 * that, and `make examples` records the answers anew. The file has three members:
 *
 *     "differs"   texts that are different in every session. Each has two regular expressions, one
 *                 for what comes before the text ("after") and one for the text itself ("form");
 *                 "shown" is the fixed text that the file has in place of it.
 *     "before"    requests that are sent first and are not shown. A request with a member "job"
 *                 becomes a job, whose id is replaced in the file by the value of "job". After a
 *                 request with a member "runs", one of the waiting jobs is run.
 *     "examples"  the session. "route" names a row of the table of routes. The bodies are "request"
 *                 and "response". A body that is not JSON, or that has blanks between its values,
 *                 is "request_text" or "response_text", a list of texts that are joined.
 *
 * To add an example, write its route, target, request and the media types, and run
 * `make examples`. */
#ifndef HE_API_DESCRIBE_EXAMPLES_H
#define HE_API_DESCRIBE_EXAMPLES_H

#include "api/json/json_out.h"
#include "format/text/json.h"

/* The content of examples.json, followed by a NUL. */
extern const char api_examples_text[];

/* The parsed examples.json; {0} before api_examples_read. */
typedef struct api_examples {
    he_json json;
    uint32_t list; /* the array "examples" in `json` */
} api_examples;

/* Parses examples.json. Returns false if memory is out. */
bool api_examples_read(api_examples *examples);
void api_examples_clear(api_examples *examples);

/* Selects one of the two bodies of an example: that of the request or that of the answer. */
typedef enum api_example_part { API_EXAMPLE_REQUEST, API_EXAMPLE_RESPONSE } api_example_part;

/* Returns the first example of a successful request to `route` whose body `part` has this media
 * type, or HE_NONE. */
uint32_t api_example_find(const api_examples *examples, api_example_part part, const char *route,
                          const char *media);
/* Returns the first example of a refused request. */
uint32_t api_example_problem(const api_examples *examples);
/* Appends the body `part` of an example as it is sent. Returns false if the example has no such
 * body. */
bool api_example_body(const api_examples *examples, uint32_t example, api_example_part part,
                      api_text *text);
/* Appends the value that has this index in examples->json, as JSON without blanks. */
void api_example_value(const api_examples *examples, uint32_t value, api_text *text);

#endif
