/* The mesh as a whole: GET .../boundaries, .../components, .../check. */
#include "api/handlers.h"

#include "api/view.h"
#include "mesh/check.h"
#include "mesh/walk.h"
#include "query/geometry.h"
#include "query/topology.h"
#include "query/traverse.h"

#include <stdio.h>

/* Answer 200 with what `write` puts into an object that begins with the revision. */
static void answer_view(api_exchange *x, const char *representation,
                        bool (*write)(api_exchange *x, const he_mesh *mesh))
{
    api_view view;
    if (api_not_modified_yet(x, representation) || !api_view_begin(x, &view)) {
        return;
    }
    if (!api_not_modified(x, representation)) {
        api_out_object_begin(&x->out);
        api_out_key_u64(&x->out, "revision", x->info.revision);
        if (write(x, view.mesh)) {
            api_out_object_end(&x->out);
            api_answer_json(x, 200);
        }
    }
    api_view_end(x, &view);
}

/* --- boundaries --- */

static void write_loop(api_out *out, const he_mesh *mesh, const he_boundary *loop,
                       const he_ids *halfedges)
{
    api_out_object_begin(out);
    api_out_key_id(out, "halfedge", loop->halfedge);
    api_out_key_u64(out, "length", loop->length);
    api_out_key_ids(out, "halfedges", halfedges->ids, halfedges->count);
    api_out_key(out, "vertices");
    api_out_array_begin(out);
    for (size_t i = 0; i < halfedges->count; i++) {
        api_out_id(out, he_origin(mesh, (he_halfedge){halfedges->ids[i]}).i);
    }
    api_out_array_end(out);
    api_out_object_end(out);
}

static bool write_boundaries(api_exchange *x, const he_mesh *mesh)
{
    he_boundaries boundaries = {0};
    he_ids halfedges = {0};
    he_error err = {0};
    he_status status = he_boundaries_find(mesh, &boundaries, &err);
    api_out_key(&x->out, "loops");
    api_out_array_begin(&x->out);
    for (size_t i = 0; i < boundaries.count && status == HE_OK; i++) {
        const he_boundary *loop = &boundaries.loops[i];
        halfedges.count = 0;
        status = he_traverse_loop(mesh, (he_halfedge){loop->halfedge}, &halfedges, &err);
        if (status == HE_OK) {
            write_loop(&x->out, mesh, loop, &halfedges);
        }
    }
    api_out_array_end(&x->out);
    he_ids_clear(&halfedges);
    he_boundaries_clear(&boundaries);
    return status == HE_OK || api_fail_core(x, &err);
}

void api_boundaries_get(api_exchange *x)
{
    answer_view(x, "boundaries", write_boundaries);
}

/* --- components --- */

static bool write_components(api_exchange *x, const he_mesh *mesh)
{
    bool by_vertex = api_param_has_choice(x, "by", "vertex");
    he_components found = {0};
    he_error err = {0};
    if (he_components_find(mesh, by_vertex ? HE_JOINED_BY_VERTEX : HE_JOINED_BY_EDGE, &found,
                           &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    api_out_key_string(&x->out, "by", by_vertex ? "vertex" : "edge");
    api_out_key(&x->out, "components");
    api_out_array_begin(&x->out);
    for (size_t i = 0; i < found.count; i++) {
        const he_component *component = &found.components[i];
        api_out_object_begin(&x->out);
        api_out_key_u64(&x->out, "faces", component->faces);
        api_out_key_u64(&x->out, "vertices", component->vertices);
        api_out_key_id(&x->out, "face", component->face);
        api_out_object_end(&x->out);
    }
    api_out_array_end(&x->out);
    he_components_clear(&found);
    return true;
}

void api_components_get(api_exchange *x)
{
    answer_view(x, "components", write_components);
}

/* --- check --- */

/* Named one by one, of broken invariants and of each code of defect; the rest is counted. */
enum { NAMED = API_PROBLEM_ELEMENTS };

static void write_problems(api_out *out, const he_problem *problems, size_t total)
{
    api_out_key(out, "problems");
    api_out_array_begin(out);
    for (size_t i = 0; i < total && i < NAMED; i++) {
        char rule[16];
        snprintf(rule, sizeof rule, "I%d", problems[i].rule);
        api_out_object_begin(out);
        api_out_key_string(out, "rule", rule);
        api_out_key_string(out, "kind", he_kind_name(problems[i].kind));
        api_out_key_id(out, "id", problems[i].id);
        api_out_key_string(out, "detail", problems[i].text);
        api_out_object_end(out);
    }
    api_out_array_end(out);
}

/* Does element `id` have this defect? Then one sentence about it. */
typedef bool (*defect_test)(const he_mesh *mesh, uint32_t id, char *text, size_t size);

static bool is_bowtie(const he_mesh *mesh, uint32_t id, char *text, size_t size)
{
    uint32_t fans = he_vertex_fans(mesh, (he_vertex){id});
    if (fans > 1) {
        snprintf(text, size, "vertex %u has %u fans", id, fans);
    }
    return fans > 1;
}

static bool is_isolated(const he_mesh *mesh, uint32_t id, char *text, size_t size)
{
    bool isolated = he_is_isolated(mesh, (he_vertex){id});
    if (isolated) {
        snprintf(text, size, "vertex %u has no edge", id);
    }
    return isolated;
}

static bool has_no_length(const he_mesh *mesh, uint32_t id, char *text, size_t size)
{
    he_halfedge h = he_edge_halfedge((he_edge){id}, 0);
    he_vertex a = he_origin(mesh, h), b = he_target(mesh, h);
    he_vec3 p = he_position(mesh, a), q = he_position(mesh, b);
    bool equal = p.x == q.x && p.y == q.y && p.z == q.z;
    if (equal) {
        snprintf(text, size, "edge %u joins vertices %u and %u at the same position", id, a.i, b.i);
    }
    return equal;
}

static bool has_no_area(const he_mesh *mesh, uint32_t id, char *text, size_t size)
{
    bool degenerate = he_face_measure(mesh, (he_face){id}).degenerate;
    if (degenerate) {
        snprintf(text, size, "face %u has no area to take a normal from", id);
    }
    return degenerate;
}

/* What a valid mesh may have and its owner may not want. */
static const struct {
    const char *code;
    he_kind kind;
    defect_test test;
} defects[] = {
    {"bowtie", HE_VERTEX, is_bowtie},
    {"isolated_vertex", HE_VERTEX, is_isolated},
    {"zero_length_edge", HE_EDGE, has_no_length},
    {"degenerate_face", HE_FACE, has_no_area},
};
enum { DEFECTS = sizeof defects / sizeof defects[0] };

static uint64_t write_defects_of(api_out *out, const he_mesh *mesh, size_t which)
{
    he_kind kind = defects[which].kind;
    uint32_t issued = he_mesh_issued(mesh, kind);
    uint64_t total = 0;
    for (uint32_t id = 0; id < issued; id++) {
        char text[HE_PROBLEM_TEXT];
        if (!he_mesh_is_live(mesh, kind, id) || !defects[which].test(mesh, id, text, sizeof text) ||
            total++ >= NAMED) {
            continue;
        }
        api_out_object_begin(out);
        api_out_key_string(out, "code", defects[which].code);
        api_out_key_string(out, "kind", he_kind_name(kind));
        api_out_key_id(out, "id", id);
        api_out_key_string(out, "detail", text);
        api_out_object_end(out);
    }
    return total;
}

static bool write_check(api_exchange *x, const he_mesh *mesh)
{
    he_problem *problems = api_arena_array(&x->arena, NAMED, sizeof *problems);
    size_t total;
    he_error err = {0};
    if (problems == NULL) {
        return api_fail_memory(x);
    }
    if (he_check(mesh, problems, NAMED, &total, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    api_out *out = &x->out;
    uint64_t counts[DEFECTS] = {0};
    api_out_key_bool(out, "valid", total == 0);
    write_problems(out, problems, total);
    api_out_key(out, "defects");
    api_out_array_begin(out);
    /* On broken links the tests could not be trusted. */
    for (size_t i = 0; i < DEFECTS && total == 0; i++) {
        counts[i] = write_defects_of(out, mesh, i);
    }
    api_out_array_end(out);
    api_out_key(out, "totals");
    api_out_object_begin(out);
    api_out_key_u64(out, "problems", total);
    for (size_t i = 0; i < DEFECTS; i++) {
        api_out_key_u64(out, defects[i].code, counts[i]);
    }
    api_out_object_end(out);
    return true;
}

void api_check_get(api_exchange *x)
{
    answer_view(x, "check", write_check);
}
