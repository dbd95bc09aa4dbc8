/* document_out.h - a mesh as the document that makes it again.
 *
 *     {"name":"cube","vertices":[[0,0,1],
 *     ...],"faces":[[0,1,2],
 *     ...]}
 *
 * Live vertices and faces in the order of their ids, one to a line, numbered 0, 1, 2... without
 * holes, so the answer loads through POST /v1/meshes: a mesh without dead rows keeps its vertex
 * and face ids. A face begins at the origin of its stored half-edge, which the new mesh stores too.
 * Positions read back bit for bit. Edge ids follow the faces, as in every create.
 *
 * Attributes of every domain follow, where there are any, in the order attributes_in.h reads; their
 * values read back bit for bit too.
 *
 * The text is made as it is pulled, from a mesh that must not change meanwhile. */
#ifndef HE_API_DOCUMENT_DOCUMENT_OUT_H
#define HE_API_DOCUMENT_DOCUMENT_OUT_H

#include "mesh/mesh.h"

typedef struct api_document_out api_document_out;

/* Borrows `mesh`; copies `name`. NULL when memory is out (a map of 4 bytes an issued vertex where
 * some are dead, one of 4 bytes an edge where edges or half-edges have attributes, and a buffer).
 */
api_document_out *api_document_out_new(const he_mesh *mesh, const char *name);
void api_document_out_free(api_document_out *out);
/* Up to `size` bytes, 0 at the end, -1 on failure: the shape of api_answer.read. */
int64_t api_document_out_read(void *out, char *buffer, size_t size);

#endif
