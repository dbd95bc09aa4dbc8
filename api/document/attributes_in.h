/* attributes_in.h - the member "attributes" of a mesh document, read piece by piece.
 *
 *     [{"domain":"vertices","name":"uv","type":"float","components":2,"rule":"interpolate",
 *       "default":[0,0],"values":[[0,0],[1,0],...]}, ...]
 *
 * There is one value for each element of the document, or none at all for the default. Vertices and
 * faces come in the order of the document. Edges come as the faces run along them first, each from
 * the corner of its first face; half-edges come by edges, that of the first face before its twin.
 * That is the order of ids in the mesh the document makes.
 *
 * Members come in any order, so values are kept as doubles, which hold every type exactly, until
 * their object ends. Refused with pointers such as /attributes/0/values/17: what is not JSON,
 * unknown and repeated members, values of another shape or type than the attribute's, an attribute
 * that is given twice. The number of values is checked when the mesh is there. */
#ifndef HE_API_DOCUMENT_ATTRIBUTES_IN_H
#define HE_API_DOCUMENT_ATTRIBUTES_IN_H

#include "api/document/members.h"
#include "build/build.h"

typedef struct api_attributes_in api_attributes_in;

api_attributes_in *api_attributes_in_new(void); /* NULL when memory is out */
void api_attributes_in_free(api_attributes_in *in);

/* The lexer is behind the colon of "attributes". May the value that is ahead of it stand there?
 * Takes it where it is a row of numbers. */
bool api_attributes_in_expect(api_attributes_in *in, he_lexer *x, bool *taken,
                              api_problem *problem);
/* Takes a token. `*into` is set where the next member is small and to be gathered, and `*done` when
 * the array has ended. */
bool api_attributes_in_take(api_attributes_in *in, he_lexer *x, he_token token, api_members **into,
                            bool *done, api_problem *problem);
/* Are there values of edges or half-edges? */
bool api_attributes_in_has_edges(const api_attributes_in *in);
/* The document is to be repaired before it is built: its soup takes the values of vertices and
 * faces, so that they are repaired with it. */
bool api_attributes_in_to_soup(api_attributes_in *in, he_soup *soup, api_problem *problem);
/* It was repaired: values of edges and half-edges are refused, for they go with edges that are no
 * longer. */
bool api_attributes_in_repaired(const api_attributes_in *in, api_problem *problem);
/* Add what was read to the mesh, after a good end. */
bool api_attributes_in_apply(api_attributes_in *in, he_mesh *mesh, api_problem *problem);

#endif
