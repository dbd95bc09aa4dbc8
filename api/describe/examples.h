/* examples.h - one session with a small mesh, request by request, as the OpenAPI document shows it.
 *
 * The session is data: api/describe/examples.json, which is compiled into the program. If a client
 * sends its requests in their order to a server without meshes, each answer is the recorded one,
 * apart from what the file lists under "differs". tests/api/test_examples.c checks that, and
 * `make examples` records the answers anew:
 *
 *     "differs"   text that is different in every session. Each has two regular expressions: what
 *                 comes before it ("after") and what it looks like ("form"). "shown" stands for it
 *                 in the file.
 *     "before"    requests that are sent first and are not shown. One with "job" is answered by a
 *                 job, for whose id the file has this one; with "runs" it runs at once.
 *     "examples"  the session. "route" names a row of the table of routes. A body is "request" or
 *                 "response"; one that is not JSON, or JSON with blanks between its values, is
 *                 "request_text" or "response_text", a list of texts that are joined.
 *
 * To add an example, write its route, target, request and the media types, and run
 * `make examples`. */
#ifndef HE_API_DESCRIBE_EXAMPLES_H
#define HE_API_DESCRIBE_EXAMPLES_H

#include "api/json/json_out.h"
#include "format/text/json.h"

/* The file, ended by a NUL. */
extern const char api_examples_text[];

/* The file as a tree; {0} is none. */
typedef struct api_examples {
    he_json json;
    uint32_t list; /* the session */
} api_examples;

/* Reads the file. Returns false if memory is out. */
bool api_examples_read(api_examples *examples);
void api_examples_clear(api_examples *examples);

/* The two bodies of an example. */
typedef enum api_example_part { API_EXAMPLE_REQUEST, API_EXAMPLE_RESPONSE } api_example_part;

/* Returns the first successful example of a route that has a body of this media type, or
 * HE_NONE. */
uint32_t api_example_find(const api_examples *examples, api_example_part part, const char *route,
                          const char *media);
/* Returns the first example of a refused request. */
uint32_t api_example_problem(const api_examples *examples);
/* Appends a body of an example as it is sent. Returns false if the example has none. */
bool api_example_body(const api_examples *examples, uint32_t example, api_example_part part,
                      api_text *text);
/* Appends a value of the tree without blanks. */
void api_example_value(const api_examples *examples, uint32_t value, api_text *text);

#endif
