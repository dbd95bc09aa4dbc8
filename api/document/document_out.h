/* document_out.h - writes a mesh as a JSON document from which POST /v1/meshes can make the mesh
 * again.
 *
 *     {"name":"cube","vertices":[[0,0,1],
 *     ...],"faces":[[0,1,2],
 *     ...]}
 *
 * Live vertices and faces are written in the order of their ids, one per line, numbered 0, 1, 2...
 * without gaps, so a mesh without deleted vertices and faces keeps their ids. A face begins at the
 * origin of its stored half-edge, so that the new mesh stores the corresponding half-edge.
 * Positions are written so that they are read back bit for bit. Edge ids follow from the order of
 * the faces, as in every created mesh.
 *
 * Attributes of all domains follow, with their values in the order that attributes_in.h describes.
 * These values, too, are read back bit for bit.
 *
 * The text is made while the server sends it; the mesh must not change meanwhile. */
#ifndef HE_API_DOCUMENT_DOCUMENT_OUT_H
#define HE_API_DOCUMENT_DOCUMENT_OUT_H

#include "mesh/mesh.h"

typedef struct api_document_out api_document_out;

/* Makes a writer, which borrows `mesh` and copies `name`. Returns NULL when memory is out. A writer
 * needs memory for a buffer, 4 bytes for each vertex id if some vertices were deleted, and 4 bytes
 * for each edge id if edges or half-edges have attributes. */
api_document_out *api_document_out_new(const he_mesh *mesh, const char *name);
void api_document_out_free(api_document_out *out);
/* Writes the next bytes of the document to `buffer`, at most `size`. Returns their number, 0 at the
 * end, or -1 on failure, like the member `read` of api_answer. */
int64_t api_document_out_read(void *out, char *buffer, size_t size);

#endif
