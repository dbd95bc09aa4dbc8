/* document_in.h - reading a mesh document piece by piece.
 *
 *     {"name":"cube","vertices":[[x,y,z],...],"faces":[[i,j,k,...],...],"attributes":[...],
 *      "materials":[{"name":"red","base_color":[1,0,0]},...]}
 *
 * Pieces may be cut anywhere, members come in any order. Vertices and faces go straight into a soup
 * (build/build.h); numbers are read exactly. Attributes are attributes_in.h's. Materials are
 * gathered, at most API_MAX_MATERIALS bytes, and read at the end into the soup (material_value.h).
 * All other members
 * ("name", "shape", what is not known) are gathered, at most API_MAX_CONTROL bytes, into a control
 * document that the caller reads through json_in.h at the end, so that {"shape":"cube","size":2}
 * comes through the same door.
 *
 * Refused here, with pointers such as /vertices/17/2: whatever is not JSON; a second "vertices",
 * "faces", "attributes" or "materials"; a vertex that is not three finite numbers; a corner that is
 * not a whole number >= 0 (one beyond any id is bad_index, 422); more than the limits (413). Faces
 * of too few corners and corners beyond the vertices are he_build's to refuse.
 *
 * Memory: the soup, the gathered members, and a number's text across a cut. */
#ifndef HE_API_DOCUMENT_DOCUMENT_IN_H
#define HE_API_DOCUMENT_DOCUMENT_IN_H

#include "api/json/json_in.h"
#include "build/build.h"

typedef struct api_document_in api_document_in;

/* Makes a reader. Returns NULL when memory is out. `limits` may be NULL. */
api_document_in *api_document_in_new(const he_limits *limits);
void api_document_in_free(api_document_in *in);

/* Reads the next piece of the document. After it has returned false, the reader can only be
 * freed. */
bool api_document_in_feed(api_document_in *in, const char *bytes, size_t length,
                          api_problem *problem);
/* Ends the document: checks that it was complete, and that the gathered members are well formed. */
bool api_document_in_end(api_document_in *in, api_problem *problem);

/* Returns the soup of vertices and faces, after api_document_in_end returned true. The reader owns
 * it; he_build may take from it. */
he_soup *api_document_in_soup(api_document_in *in);
bool api_document_in_has_vertices(const api_document_in *in);
bool api_document_in_has_faces(const api_document_in *in);
/* Moves the attributes of vertices and faces into the soup. It must be called before the soup is
 * repaired. */
bool api_document_in_lend(api_document_in *in, api_problem *problem);
/* Adds the other attributes to the mesh that was made of the document. `repaired` says whether its
 * soup was repaired. */
bool api_document_in_attributes(api_document_in *in, he_mesh *mesh, bool repaired,
                                api_problem *problem);
/* Returns true if the document has attributes of edges or half-edges, which no repaired document
 * can keep. */
bool api_document_in_has_edges(const api_document_in *in);
/* Returns the other members of the document as one object, valid until the reader is freed.
 * Refusals of their values go to the problem that was given to api_document_in_end. */
const api_in *api_document_in_rest(const api_document_in *in);

#endif
