/* summary.h - the summary of a mesh: what it costs to know, and how it is written.
 *
 * Counting components and loops and measuring area and volume cost the mesh. They are computed once
 * a revision and kept with it (st_cache_get and st_cache_put). */
#ifndef HE_API_DOCUMENT_SUMMARY_H
#define HE_API_DOCUMENT_SUMMARY_H

#include "api/request/exchange.h"
#include "geometry/geometry.h"
#include "query/topology.h"

enum { API_SUMMARY_DEGREES = 128 };

/* Everything derived from the content; plain data, so that the store can keep it. */
typedef struct api_summary {
    he_topology topology; /* without its list of degrees */
    he_degree_count degrees[API_SUMMARY_DEGREES];
    size_t degree_count;
    bool has_box;
    he_box box;
    he_measures measures;
    size_t memory_bytes;
} api_summary;

/* Compute. More than API_SUMMARY_DEGREES different degrees leave out those of the fewest corners
 * last; false with the problem filled when memory is out or the mesh is corrupt. */
bool api_summary_find(api_exchange *x, const he_mesh *mesh, api_summary *out);

/* The members of an object that is open: id, name, revision, counts, ... */
void api_write_summary(api_out *out, const st_mesh_info *info, const api_summary *summary);
/* id, name, revision, the counts that cost nothing, and what is wrong with a damaged mesh. */
void api_write_brief(api_out *out, const st_card *card);

/* GET of a mesh: 200 with the summary of the mesh at hand, from the cache where it has it, and what
 * that costs. */
void api_summary_get(api_exchange *x);
bool api_summary_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
/* Of a mesh that is not in memory: answers 304, and HEAD where the client takes no content coding:
 * whether the tag of the answer to GET would name one depends on its length. HEAD does not find out
 * that the content is damaged. */
void api_summary_cold(api_exchange *x, st_cold *cold);
/* The handler of a write goes on to that. */
void api_answer_summary(api_exchange *x);
/* Answer `status` with the summary of what x->info names, found before it was stored: no lock is
 * held for it. `extra` (may be NULL) writes more members before the object ends. */
void api_answer_stored(api_exchange *x, int status, const api_summary *summary,
                       void (*extra)(api_exchange *x));
/* Answers 201 with Location and the summary of x->mesh, which was just created under this name, as
 * it was then; publishes. */
void api_answer_created(api_exchange *x, const char *name, const api_summary *summary,
                        void (*extra)(api_exchange *x));

#endif
