/* attributes_in.h - reads the member "attributes" of a mesh document piece by piece.
 *
 *     [{"domain":"vertices","name":"uv","type":"float","components":2,"rule":"interpolate",
 *       "default":[0,0],"values":[[0,0],[1,0],...]}, ...]
 *
 * "values" has one value for each element of the document; without it all elements get the default.
 * Values of vertices and faces are in the order of the document. Values of edges are in the order
 * in which the faces, corner by corner, first use the edges. Values of half-edges are in the order
 * of their edges: first the half-edge in the face that uses the edge first, then its twin. These
 * are also the orders of the ids in the mesh that is made.
 *
 * Members of an attribute's object may have any order, so the type may follow the values. Therefore
 * values are kept until the object ends, as doubles, which represent the values of every type
 * exactly. Invalid JSON, unknown and repeated members, values that do not match the attribute's
 * type or number of components, and an attribute that is given twice are refused with pointers such
 * as /attributes/0/values/17. The number of values is checked when the mesh has been made. */
#ifndef HE_API_DOCUMENT_ATTRIBUTES_IN_H
#define HE_API_DOCUMENT_ATTRIBUTES_IN_H

#include "api/document/members.h"
#include "build/build.h"

typedef struct api_attributes_in api_attributes_in;

api_attributes_in *api_attributes_in_new(void); /* returns NULL when memory is out */
void api_attributes_in_free(api_attributes_in *in);

/* Refuses the value that the lexer reads next, somewhere inside the member "attributes", if the
 * document must not have such a value there. If the value is an array of numbers that has arrived
 * completely, reads it at once and sets `*taken`. */
bool api_attributes_in_expect(api_attributes_in *in, he_lexer *x, bool *taken,
                              api_problem *problem);
/* Handles a token inside the member "attributes", up to the token that closes its array. If a
 * member other than "values" begins, sets `*into`: the caller must gather the member there
 * (members.h). */
bool api_attributes_in_take(api_attributes_in *in, he_lexer *x, he_token token, api_members **into,
                            api_problem *problem);
/* Returns true if the document has attribute values of edges or half-edges. */
bool api_attributes_in_has_edges(const api_attributes_in *in);
/* Moves the values of vertices and faces into the soup (the vertices and faces as read) of a
 * document that is to be repaired before the mesh is built, so that the repair also changes these
 * values. */
bool api_attributes_in_to_soup(api_attributes_in *in, he_soup *soup, api_problem *problem);
/* Refuses attribute values of edges and half-edges. It is called if the document was repaired,
 * because the edges to which they belong may no longer exist. */
bool api_attributes_in_repaired(const api_attributes_in *in, api_problem *problem);
/* Adds the attributes that were read to the mesh. It must be called only after the document ended
 * without an error. */
bool api_attributes_in_apply(api_attributes_in *in, he_mesh *mesh, api_problem *problem);

#endif
