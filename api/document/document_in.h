/* document_in.h - reads a mesh document piece by piece.
 *
 *     {"name":"cube","vertices":[[x,y,z],...],"faces":[[i,j,k,...],...],"attributes":[...],
 *      "materials":[{"name":"red","base_color":[1,0,0]},...]}
 *
 * The document may be cut into pieces anywhere, and members may have any order. Vertices and faces
 * are added at once to a polygon soup (build/build.h); numbers are read exactly. Attributes are
 * read by attributes_in.h. The text of the materials, at most API_MAX_MATERIALS bytes, is kept and
 * read into the soup at the end (material_value.h). All other members ("name", "shape", unknown
 * ones), at most API_MAX_CONTROL bytes, are gathered in a control document, which the caller reads
 * at the end (json_in.h). So this reader also reads {"shape":"cube","size":2}.
 *
 * The reader refuses, with pointers such as /vertices/17/2: invalid JSON; a second "vertices",
 * "faces", "attributes" or "materials"; a vertex that is not three finite numbers; a corner that is
 * not a whole number >= 0 (a number larger than any id is bad_index, 422); more of anything than
 * the limits allow (413). he_build refuses faces with too few corners and corners that name no
 * vertex.
 *
 * The reader needs memory for the soup, the gathered members, and the text of a number that two
 * pieces of the document share. */
#ifndef HE_API_DOCUMENT_DOCUMENT_IN_H
#define HE_API_DOCUMENT_DOCUMENT_IN_H

#include "api/json/json_in.h"
#include "build/build.h"

typedef struct api_document_in api_document_in;

/* Makes a reader of a mesh document. Returns NULL when memory is out. `limits` of the soup may be
 * NULL. */
api_document_in *api_document_in_new(const he_limits *limits);
void api_document_in_free(api_document_in *in);

/* Reads the next piece of the document. After it has returned false, the reader can only be
 * freed. */
bool api_document_in_feed(api_document_in *in, const char *bytes, size_t length,
                          api_problem *problem);
/* Ends the document: checks that it was complete, and that the gathered members are well formed. */
bool api_document_in_end(api_document_in *in, api_problem *problem);

/* Returns the soup (the vertices and faces as read), after api_document_in_end returned true. The
 * reader owns it, but he_build may move memory out of it. */
he_soup *api_document_in_soup(api_document_in *in);
bool api_document_in_has_vertices(const api_document_in *in);
bool api_document_in_has_faces(const api_document_in *in);
/* Moves the attributes of vertices and faces into the soup (the vertices and faces as read), so
 * that repairs also change the attributes. It must be called before the soup is repaired. */
bool api_document_in_lend(api_document_in *in, api_problem *problem);
/* Adds the attributes that are not in the soup to the mesh that was made from the soup. `repaired`
 * says whether the soup was repaired. */
bool api_document_in_attributes(api_document_in *in, he_mesh *mesh, bool repaired,
                                api_problem *problem);
/* Returns true if the document has attributes of edges or half-edges, which no repaired document
 * can keep. */
bool api_document_in_has_edges(const api_document_in *in);
/* Returns the gathered members ("name", "shape", unknown ones) as one object, valid until the
 * reader is freed. Reading a wrong value from it fills the problem that was passed to
 * api_document_in_end. */
const api_in *api_document_in_rest(const api_document_in *in);

#endif
