/* summary.h - the summary of a mesh: computing and writing it.
 *
 * Counting components and loops and measuring area and volume visit the whole mesh. They are
 * computed once per revision and kept with it (st_cache_get and st_cache_put). */
#ifndef HE_API_DOCUMENT_SUMMARY_H
#define HE_API_DOCUMENT_SUMMARY_H

#include "api/json/record.h"
#include "api/request/exchange.h"
#include "geometry/geometry.h"
#include "query/topology.h"

/* The members of a summary, of an item in the list of meshes, and of their parts. */
extern const api_record api_summary_record, api_mesh_item_record, api_counts_record, api_box_record;

enum { API_SUMMARY_DEGREES = 128 };

/* The part of a summary that is computed from the content. It is plain data, so that the store can
 * keep it. */
typedef struct api_summary {
    he_topology topology; /* without its list of degrees */
    he_degree_count degrees[API_SUMMARY_DEGREES];
    size_t degree_count;
    bool has_box;
    he_box box;
    he_measures measures;
    size_t memory_bytes;
} api_summary;

/* Computes the summary. If there are more than API_SUMMARY_DEGREES different degrees, the faces
 * with the most corners are left out. Returns false with the problem filled when memory is out or
 * the mesh is corrupt. */
bool api_summary_find(api_exchange *x, const he_mesh *mesh, api_summary *out);

/* Writes the members of a summary into an object that is open: id, name, revision, counts and so
 * on. */
void api_write_summary(api_out *out, const st_mesh_info *info, const api_summary *summary);
/* Writes id, name, revision, the counts that need no computing, and the damage of a damaged
 * mesh. */
void api_write_brief(api_out *out, const st_card *card);

/* The handler of GET of a mesh, which answers 200 with its summary, from the cache if possible, and
 * the function that estimates its cost. */
void api_summary_get(api_exchange *x);
bool api_summary_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
/* Handles GET and HEAD of a mesh that is not in memory. Answers 304 if the client has the present
 * summary. Answers HEAD if the client accepts an answer without a content coding; the headers are
 * then those of such an answer, even if GET would compress a long summary. HEAD does not notice
 * damaged content. */
void api_summary_cold(api_exchange *x, st_cold *cold);
/* Called by the handler of a write to answer with the summary. */
void api_answer_summary(api_exchange *x);
/* Answers `status` with the summary of the mesh in x->info, which was computed before it was
 * stored, so that no lock is held. `extra` (may be NULL) writes more members before the object
 * ends. */
void api_answer_stored(api_exchange *x, int status, const api_summary *summary,
                       void (*extra)(api_exchange *x));
/* Answers 201 with Location and the summary of x->mesh, which was just created under this name, as
 * it was then. Calls api_publish. */
void api_answer_created(api_exchange *x, const char *name, const api_summary *summary,
                        void (*extra)(api_exchange *x));

#endif
