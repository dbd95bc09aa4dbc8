/* elements.h - writes one element as a JSON object, with all its links.
 *
 * The element must be live; nothing is checked. Each function returns how many half-edges and
 * attribute values it wrote, which is its cost: a single vertex or face may have all half-edges of
 * the mesh. */
#ifndef HE_API_READ_ELEMENTS_H
#define HE_API_READ_ELEMENTS_H

#include "api/json/json_out.h"
#include "query/adjacency.h"

uint32_t api_write_vertex(api_out *out, const he_mesh *mesh, he_vertex v);
uint32_t api_write_halfedge(api_out *out, const he_mesh *mesh, he_halfedge h);
uint32_t api_write_edge(api_out *out, const he_mesh *mesh, he_edge e);
/* Writes a face. The normal of a degenerate face is written as zero. */
uint32_t api_write_face(api_out *out, const he_mesh *mesh, he_face f);
/* Writes an element with the function for its kind. */
uint32_t api_write_element(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id);

/* Writes a reference to an element, such as {"vertex":5}. */
void api_write_reference(api_out *out, he_kind kind, uint32_t id);
/* Writes the answer to a question about neighbours:
 * {"revision":1,"of":{"vertex":5},"relation":"faces","ids":[4,9,2]}. */
void api_write_adjacency(api_out *out, uint64_t revision, const he_relation *relation, uint32_t id,
                         const he_ids *ids);

#endif
