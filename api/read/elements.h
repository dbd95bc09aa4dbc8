/* elements.h - one element as a JSON object, with all its links.
 *
 * The element lives; nothing is checked. Each writer returns how many half-edges and values it
 * wrote, which is what it cost: a vertex or a face may have as many as the mesh. */
#ifndef HE_API_READ_ELEMENTS_H
#define HE_API_READ_ELEMENTS_H

#include "api/json/json_out.h"
#include "query/adjacency.h"

uint32_t api_write_vertex(api_out *out, const he_mesh *mesh, he_vertex v);
uint32_t api_write_halfedge(api_out *out, const he_mesh *mesh, he_halfedge h);
uint32_t api_write_edge(api_out *out, const he_mesh *mesh, he_edge e);
/* The normal of a degenerate face is zero. */
uint32_t api_write_face(api_out *out, const he_mesh *mesh, he_face f);
/* The one of the four that the kind asks for. */
uint32_t api_write_element(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id);

/* {"vertex":5} */
void api_write_reference(api_out *out, he_kind kind, uint32_t id);
/* {"revision":1,"of":{"vertex":5},"relation":"faces","ids":[4,9,2]} */
void api_write_adjacency(api_out *out, uint64_t revision, const he_relation *relation, uint32_t id,
                         const he_ids *ids);

#endif
