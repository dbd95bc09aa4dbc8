/* summary.h - computes and writes the summary of a mesh.
 *
 * To count components and boundary loops and to measure area and volume, the whole mesh must be
 * visited. So a summary is computed once for each revision and kept in the cache (st_cache_get,
 * st_cache_put). */
#ifndef HE_API_DOCUMENT_SUMMARY_H
#define HE_API_DOCUMENT_SUMMARY_H

#include "api/json/record.h"
#include "api/request/exchange.h"
#include "geometry/geometry.h"
#include "query/topology.h"

/* The JSON members of a summary, of an item in the list of meshes, and of the objects that these
 * contain. */
extern const api_record api_summary_record, api_mesh_item_record, api_counts_record, api_box_record;

enum { API_SUMMARY_DEGREES = 128 };

/* The part of a summary that is computed from the mesh data. It has no pointers, so that the store
 * can keep it as bytes. */
typedef struct api_summary {
    he_topology topology; /* topology.degrees is not set */
    he_degree_count degrees[API_SUMMARY_DEGREES];
    size_t degree_count;
    bool has_box;
    he_box box;
    he_measures measures;
    size_t memory_bytes;
} api_summary;

/* Computes the summary. If faces have more than API_SUMMARY_DEGREES different numbers of corners,
 * the highest numbers are left out. Returns false with the problem filled when memory is out or the
 * mesh is corrupt. */
bool api_summary_find(api_exchange *x, const he_mesh *mesh, api_summary *out);

/* Writes the members of a summary (id, name, revision, counts and so on) into an object that the
 * caller has begun. */
void api_write_summary(api_out *out, const st_mesh_info *info, const api_summary *summary);

/* The handler of GET /v1/meshes/{mesh}, which answers 200 with the summary, from the cache if
 * possible, and the function that estimates the cost of that handler. */
void api_summary_get(api_exchange *x);
bool api_summary_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
/* Handles GET and HEAD of a mesh that is not in memory. Answers 304 if the client has the present
 * summary. Answers HEAD if the client accepts an uncompressed answer; the headers are those of such
 * an answer, even if GET would compress it. HEAD does not notice that the stored mesh data is
 * damaged. */
void api_summary_cold(api_exchange *x, st_cold *cold);
/* Answers a request that has written to the mesh with the summary of the mesh. The handler of the
 * request calls it. */
void api_answer_summary(api_exchange *x);
/* Answers `status` with a summary of the mesh that x->info describes. The summary was computed
 * before the mesh was stored, so this needs no lock. `extra` (may be NULL) writes more members into
 * the object. */
void api_answer_stored(api_exchange *x, int status, const api_summary *summary,
                       void (*extra)(api_exchange *x));
/* Answers 201, with the header Location and the summary that x->mesh had when this request created
 * it under the name `name`. Calls api_publish. */
void api_answer_created(api_exchange *x, const char *name, const api_summary *summary,
                        void (*extra)(api_exchange *x));

#endif
