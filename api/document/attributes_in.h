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

/* Decides whether the value ahead of the lexer, which is behind the colon of "attributes", may
 * stand there. If it is an array of numbers, reads it at once and sets `*taken`. */
bool api_attributes_in_expect(api_attributes_in *in, he_lexer *x, bool *taken,
                              api_problem *problem);
/* Handles a token. `*into` is set if the next member is small and must be gathered. The array ends
 * with the token that closes it, when the lexer is in the document again. */
bool api_attributes_in_take(api_attributes_in *in, he_lexer *x, he_token token, api_members **into,
                            api_problem *problem);
/* Returns true if the document has attribute values of edges or half-edges. */
bool api_attributes_in_has_edges(const api_attributes_in *in);
/* Moves the values of vertices and faces into the soup of a document that is to be repaired before
 * it is built, so that they are repaired with it. */
bool api_attributes_in_to_soup(api_attributes_in *in, he_soup *soup, api_problem *problem);
/* Refuses the attribute values of edges and half-edges if the document was repaired, because the
 * edges they belong to no longer exist. */
bool api_attributes_in_repaired(const api_attributes_in *in, api_problem *problem);
/* Adds the attributes that were read to the mesh. It must be called only after the document ended
 * without an error. */
bool api_attributes_in_apply(api_attributes_in *in, he_mesh *mesh, api_problem *problem);

#endif
