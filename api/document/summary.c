#include "api/document/summary.h"

#include "api/request/at_revision.h"
#include "api/request/mesh_access.h"

#include <stdio.h>
#include <string.h>

bool api_summary_find(api_exchange *x, const he_mesh *mesh, api_summary *out)
{
    he_error err = {0};
    /* This clears the padding of the struct, too, because the store keeps every byte of a
     * summary. */
    memset(out, 0, sizeof *out);
    he_topology topology;
    if (he_topology_find(mesh, &topology, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    out->degree_count =
        topology.degree_count < API_SUMMARY_DEGREES ? topology.degree_count : API_SUMMARY_DEGREES;
    if (out->degree_count > 0) {
        memcpy(out->degrees, topology.degrees, out->degree_count * sizeof *out->degrees);
    }
    out->topology = topology;
    out->topology.degrees = NULL;
    he_topology_clear(&topology);
    out->has_box = he_mesh_box(mesh, &out->box);
    out->memory_bytes = he_mesh_bytes(mesh);
    if (he_mesh_measure(mesh, &out->measures, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    return true;
}

static void write_counts(api_out *out, const he_topology *t)
{
    api_out_key(out, "counts");
    api_out_object_begin(out);
    api_out_key_u64(out, "vertices", t->vertices);
    api_out_key_u64(out, "halfedges", 2 * (uint64_t)t->edges);
    api_out_key_u64(out, "edges", t->edges);
    api_out_key_u64(out, "faces", t->faces);
    api_out_key_u64(out, "boundary_loops", t->boundary_loops);
    api_out_key_u64(out, "isolated_vertices", t->isolated_vertices);
    api_out_key_u64(out, "components", t->components);
    api_out_key_u64(out, "components_by_edge", t->components_by_edge);
    api_out_object_end(out);
}

static void write_degrees(api_out *out, const api_summary *summary)
{
    api_out_key(out, "degrees");
    api_out_object_begin(out);
    for (size_t i = 0; i < summary->degree_count; i++) {
        char key[16];
        snprintf(key, sizeof key, "%u", summary->degrees[i].degree);
        api_out_key_u64(out, key, summary->degrees[i].faces);
    }
    api_out_object_end(out);
}

static void write_box(api_out *out, const api_summary *summary)
{
    api_out_key(out, "bbox");
    if (!summary->has_box) {
        api_out_null(out);
        return;
    }
    api_out_object_begin(out);
    api_out_key_vec3(out, "min", summary->box.min);
    api_out_key_vec3(out, "max", summary->box.max);
    api_out_object_end(out);
}

static void write_identity(api_out *out, const char *id, const char *name, uint64_t revision)
{
    api_out_key_string(out, "id", id);
    api_out_key_string(out, "name", name);
    api_out_key_u64(out, "revision", revision);
}

void api_write_brief(api_out *out, const st_card *card)
{
    const st_counts *counts = &card->counts;
    write_identity(out, card->id, card->name, card->revision);
    api_out_key(out, "counts");
    api_out_object_begin(out);
    api_out_key_u64(out, "vertices", counts->vertices);
    api_out_key_u64(out, "halfedges", 2 * (uint64_t)counts->edges);
    api_out_key_u64(out, "edges", counts->edges);
    api_out_key_u64(out, "faces", counts->faces);
    api_out_object_end(out);
    if (card->damage[0] != '\0') {
        api_out_key_string(out, "damage", card->damage);
    }
}

void api_write_summary(api_out *out, const st_mesh_info *info, const api_summary *summary)
{
    const he_topology *t = &summary->topology;
    write_identity(out, info->id, info->name, info->revision);
    write_counts(out, t);
    api_out_key(out, "euler");
    api_out_i64(out, t->euler);
    api_out_key(out, "genus");
    if (t->has_genus) {
        api_out_i64(out, t->genus);
    } else {
        api_out_null(out);
    }
    api_out_key_bool(out, "closed", t->closed);
    api_out_key_bool(out, "manifold", t->manifold);
    write_degrees(out, summary);
    write_box(out, summary);
    api_out_key_number(out, "area", summary->measures.area);
    api_out_key(out, "volume");
    if (summary->measures.has_volume) {
        api_out_number(out, summary->measures.volume);
    } else {
        api_out_null(out);
    }
    api_out_key_u64(out, "memory_bytes", summary->memory_bytes);
    api_out_key_time(out, "created", info->created);
    api_out_key_time(out, "modified", info->modified);
}

static void write_answer(api_exchange *x, const api_summary *summary, int status,
                         void (*extra)(api_exchange *x))
{
    api_out_object_begin(&x->out);
    api_write_summary(&x->out, &x->info, summary);
    if (extra != NULL) {
        extra(x);
    }
    api_out_object_end(&x->out);
    api_answer_json(x, status);
}

void api_answer_stored(api_exchange *x, int status, const api_summary *summary,
                       void (*extra)(api_exchange *x))
{
    st_cache_put_of(x->mesh, &x->info, summary, sizeof *summary);
    api_answer_etag(x, "summary");
    write_answer(x, summary, status, extra);
}

/* Fills x->info with the mesh as it was created, because other clients may have changed or deleted
 * it by now. */
static void find_facts_as_made(api_exchange *x, const char *name)
{
    (void)st_read_card(x->mesh, &x->info);
    snprintf(x->info.name, sizeof x->info.name, "%s", name);
    x->info.revision = x->info.metadata = 1;
    x->info.modified = x->info.created;
    x->has_info = true;
}

void api_answer_created(api_exchange *x, const char *name, const api_summary *summary,
                        void (*extra)(api_exchange *x))
{
    find_facts_as_made(x, name);
    api_publish(x, 201);
    api_answer_header(x, "Location", x->location);
    api_answer_stored(x, 201, summary, extra);
}

/* Estimates the cost of a summary. If the summary is cached, it is put into x->state, and the mesh
 * is not read. */
bool api_summary_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    api_summary *kept = api_arena_array(&x->arena, 1, sizeof *kept);
    if (kept == NULL) {
        return api_fail_memory(x);
    }
    bool cached = x->snapshot == NULL && st_cache_get(x->mesh, kept, sizeof *kept);
    x->state = cached ? kept : NULL;
    x->reading.reads = cached ? API_READS_LOCKED : API_READS_VIEW;
    out->elements = cached ? 0 : api_elements_of(mesh);
    return true;
}

void api_summary_get(api_exchange *x)
{
    api_summary found;
    const api_summary *summary = x->state;
    if (summary == NULL) {
        if (!api_summary_find(x, x->content, &found)) {
            return;
        }
        summary = &found;
        if (x->snapshot == NULL) {
            st_cache_put(x->mesh, summary, sizeof *summary);
        } else {
            st_cache_put_of(x->mesh, &x->info, summary, sizeof *summary);
        }
    }
    api_answer_etag(x, "summary");
    write_answer(x, summary, 200, NULL);
}

static int64_t read_nothing(void *context, char *buffer, size_t size)
{
    (void)context;
    (void)buffer;
    (void)size;
    return 0;
}

void api_summary_cold(api_exchange *x, st_cold *cold)
{
    uint64_t revision;
    (void)cold;
    if (api_at_revision_wanted(x, &revision) || api_not_modified(x, "summary")) {
        return;
    }
    if (x->head && x->codings.allowed[API_IDENTITY]) {
        /* The length of the summary is unknown, so it is unknown whether GET would compress the
         * answer. The answer to HEAD is the one without a coding, whose tag is as good as that of
         * the compressed answer in every precondition. */
        x->codings.best = API_IDENTITY;
        const api_stream nothing = {.length = -1, .read = read_nothing};
        api_answer_stream(x, 200, "application/json", &nothing);
    }
}

void api_answer_summary(api_exchange *x)
{
    static const api_reading reading = {
        .reads = API_READS_VIEW, .cost = api_summary_cost, .run = api_summary_get};
    api_read_as(x, &reading);
}
