#include "api/document/summary.h"

#include "api/request/at_revision.h"
#include "api/request/mesh_access.h"

#include <stdio.h>
#include <string.h>

bool api_summary_find(api_exchange *x, const he_mesh *mesh, api_summary *out)
{
    he_error err = {0};
    /* The padding of the struct is cleared, too, because the store keeps every byte of a
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

/* The counts of a mesh. Some of them must be computed from the content of the mesh, so only the
 * summary of one mesh has them, and not a list of meshes. */
typedef struct counts {
    uint64_t vertices, halfedges, edges, faces;
    bool computed;
    uint32_t boundary_loops, isolated_vertices, components, components_by_edge;
} counts;

static const api_field count_fields[] = {
    API_FIELD("vertices", "count", counts, vertices, .required = true,
              .doc = "How many vertices are in the mesh, without deleted ones."),
    API_FIELD("halfedges", "count", counts, halfedges, .required = true,
              .doc = "The number of half-edges: twice the number of edges."),
    API_FIELD("edges", "count", counts, edges, .required = true),
    API_FIELD("faces", "count", counts, faces, .required = true),
    API_FIELD("boundary_loops", "count", counts, boundary_loops,
              .known = API_KNOWN(counts, computed),
              .doc = "How many boundary loops there are; present only in the summary of a mesh."),
    API_FIELD("isolated_vertices", "count", counts, isolated_vertices,
              .known = API_KNOWN(counts, computed),
              .doc = "How many vertices have no edge; present only in the summary of a mesh."),
    API_FIELD("components", "count", counts, components, .known = API_KNOWN(counts, computed),
              .doc = "How many components there are if faces are connected by shared vertices; "
                     "isolated vertices are not counted."),
    API_FIELD("components_by_edge", "count", counts, components_by_edge,
              .known = API_KNOWN(counts, computed),
              .doc = "How many components there are if faces are connected by shared edges only."),
};
const api_record api_counts_record = API_RECORD("counts", count_fields);

static const api_field box_fields[] = {
    API_FIELD("min", "point", he_box, min, .required = true),
    API_FIELD("max", "point", he_box, max, .required = true),
};
const api_record api_box_record = API_RECORD("box", box_fields);

static void write_brief_counts(api_out *out, const void *value)
{
    const st_counts *c = &((const st_card *)value)->counts;
    const counts shown = {.vertices = c->vertices,
                          .halfedges = 2 * (uint64_t)c->edges,
                          .edges = c->edges,
                          .faces = c->faces};
    api_record_write(out, &api_counts_record, &shown);
}

static const api_field item_fields[] = {
    API_FIELD("id", "text", st_card, id, .required = true),
    API_FIELD("name", "text", st_card, name, .required = true),
    API_FIELD("revision", "count", st_card, revision, .required = true),
    API_FIELD_MADE("counts", "#counts", write_brief_counts, .required = true),
    API_FIELD("memory_bytes", "count", st_card, bytes, .required = true,
              .doc = "Memory that the mesh takes."),
    API_FIELD("modified", "time", st_card, modified, .required = true,
              .doc = "When the mesh was changed or renamed last."),
    API_FIELD("damage", "text", st_card, damage, .zero_is_none = true,
              .doc = "Present only if the mesh is damaged: says what is damaged on the disk. The "
                     "mesh can only be deleted or replaced."),
};
const api_record api_mesh_item_record = API_RECORD("mesh_item", item_fields);

/* A mesh and its summary, from which the members of an answer are written. */
typedef struct whole {
    const api_summary *summary;
    const char *id, *name;
    uint64_t revision;
    int64_t euler, genus;
    bool has_genus, closed, manifold, has_box, has_volume;
    double area, volume;
    uint64_t memory_bytes;
    double created, modified;
} whole;

static void write_counts(api_out *out, const void *value)
{
    const he_topology *t = &((const whole *)value)->summary->topology;
    const counts shown = {.vertices = t->vertices,
                          .halfedges = 2 * (uint64_t)t->edges,
                          .edges = t->edges,
                          .faces = t->faces,
                          .computed = true,
                          .boundary_loops = t->boundary_loops,
                          .isolated_vertices = t->isolated_vertices,
                          .components = t->components,
                          .components_by_edge = t->components_by_edge};
    api_record_write(out, &api_counts_record, &shown);
}

static void write_degrees(api_out *out, const void *value)
{
    const api_summary *summary = ((const whole *)value)->summary;
    api_out_object_begin(out);
    for (size_t i = 0; i < summary->degree_count; i++) {
        char key[16];
        snprintf(key, sizeof key, "%u", summary->degrees[i].degree);
        api_out_key_u64(out, key, summary->degrees[i].faces);
    }
    api_out_object_end(out);
}

static void write_box(api_out *out, const void *value)
{
    api_record_write(out, &api_box_record, &((const whole *)value)->summary->box);
}

static const api_field summary_fields[] = {
    API_FIELD("id", "text", whole, id, .required = true),
    API_FIELD("name", "text", whole, name, .required = true),
    API_FIELD("revision", "count", whole, revision, .required = true),
    API_FIELD_MADE("counts", "#counts", write_counts, .required = true),
    API_FIELD(
        "euler", "integer", whole, euler, .required = true,
        .doc =
            "The Euler characteristic V - E + F, where V counts only vertices that have an edge."),
    API_FIELD(
        "genus", "integer?", whole, genus, .required = true, .known = API_KNOWN(whole, has_genus),
        .doc = "The genus; null if the mesh has a bow-tie, because the genus is then not defined."),
    API_FIELD("closed", "flag", whole, closed, .required = true,
              .doc = "True if the mesh has no boundary and at least one face."),
    API_FIELD("manifold", "flag", whole, manifold, .required = true,
              .doc = "True if the mesh has no bow-tie and at least one face."),
    API_FIELD_MADE("degrees", "#degrees", write_degrees, .required = true,
                   .doc =
                       "For each number of corners: how many faces have this number of corners."),
    API_FIELD_MADE("bbox", "#box?", write_box, .required = true,
                   .known = API_KNOWN(whole, has_box)),
    API_FIELD("area", "number", whole, area, .required = true),
    API_FIELD(
        "volume", "number?", whole, volume, .required = true, .known = API_KNOWN(whole, has_volume),
        .doc = "The volume, negative if the mesh is inside out; null unless the mesh is closed."),
    API_FIELD("memory_bytes", "count", whole, memory_bytes, .required = true),
    API_FIELD("created", "time", whole, created, .required = true),
    API_FIELD("modified", "time", whole, modified, .required = true),
};
const api_record api_summary_record = API_RECORD("summary", summary_fields);

void api_write_summary(api_out *out, const st_mesh_info *info, const api_summary *summary)
{
    const he_topology *t = &summary->topology;
    const whole value = {.summary = summary,
                         .id = info->id,
                         .name = info->name,
                         .revision = info->revision,
                         .euler = t->euler,
                         .genus = t->genus,
                         .has_genus = t->has_genus,
                         .closed = t->closed,
                         .manifold = t->manifold,
                         .has_box = summary->has_box,
                         .has_volume = summary->measures.has_volume,
                         .area = summary->measures.area,
                         .volume = summary->measures.volume,
                         .memory_bytes = summary->memory_bytes,
                         .created = info->created,
                         .modified = info->modified};
    api_record_members(out, &api_summary_record, &value);
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

/* Sets x->info to the description that the new mesh had when it was created, because other clients
 * may have changed or deleted it by now. */
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

/* Estimates the cost of a summary. If the store has kept the summary, the summary is put into
 * x->state, and the handler need not read the mesh. */
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
        /* Without the summary the length of the answer is not known, so it is not known either
         * whether GET would compress the answer. HEAD is answered as if GET would not. That is
         * harmless, because preconditions accept the ETags of the compressed and of the
         * uncompressed answer alike. */
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
