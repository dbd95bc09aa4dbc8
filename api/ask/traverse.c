/* traverse.c - computes walks over a mesh, for POST .../traverse and for the questions of POST
 * .../query that are walks.
 *
 * An answer repeats the request with all defaults filled in, so that it can be understood without
 * the request. The whole walk is computed before anything is written. */
#include "api/request/handlers.h"

#include "api/ask/question.h"
#include "api/read/elements.h"
#include "mesh/walk.h"
#include "query/traverse.h"

#include <string.h>

/* How many half-edges are charged for each element that a breadth-first walk reaches; on average
 * the walk visits fewer. */
enum { FLOOD_COST = 8 };

/* Reads the member `name` of a walk, which must be a live element of one of the kinds in the bit
 * set `kinds`. */
static bool read_end(api_asker *a, const api_in *walk, const char *name, unsigned kinds,
                     he_element *out)
{
    api_in in;
    return api_in_need(walk, name, &in) && api_asker_element(a, &in, kinds, &out->kind, &out->id);
}

/* Writes the members with which the answer to each kind of walk begins. */
static void begin_answer(api_asker *a, const char *walk, he_element from)
{
    api_out_object_begin(a->out);
    api_out_key_u64(a->out, "revision", a->revision);
    api_out_key_string(a->out, "walk", walk);
    api_out_key(a->out, "from");
    api_write_reference(a->out, from.kind, from.id);
}

/* Returns true if a walk has more elements than an answer may have. */
static bool is_too_long(const he_ids *ids)
{
    return ids->count > API_MAX_WALK;
}

/* --- the walk "path" --- */

static const char *const step_names[] = {
    [HE_STEP_NEXT] = "next", [HE_STEP_PREV] = "prev", [HE_STEP_TWIN] = "twin", NULL};
static const char *const until_names[] = {"start", "boundary", NULL};
static const he_until untils[] = {HE_UNTIL_START, HE_UNTIL_BOUNDARY};

typedef struct path {
    he_element from;
    he_path_steps steps;
    bool has_repeat;
    /* Value of the member "until"; NULL: the path ends after a number of steps. */
    const char *until_name;
} path;

static bool read_steps(api_asker *a, const api_in *walk, path *out)
{
    api_in list, child;
    if (!api_in_need(walk, "path", &list) || !api_in_array(&list, 1, API_MAX_PATH_STEPS)) {
        return false;
    }
    he_step *steps = api_arena_array(a->arena, api_in_count(&list), sizeof *steps);
    if (steps == NULL) {
        return api_in_fail(&list, HE_NO_MEMORY, "no memory for the path of a walk");
    }
    for (bool more = api_in_first(&list, &child); more; more = api_in_next(&child)) {
        int step;
        if (!api_in_choice(&child, step_names, &step)) {
            return false;
        }
        steps[out->steps.count++] = (he_step)step;
    }
    out->steps.list = steps;
    return true;
}

static bool read_path(api_asker *a, const api_in *walk, path *out)
{
    static const char *const members[] = {"walk", "from", "path", "repeat", "until", NULL};
    api_in in;
    int choice;
    *out = (path){.steps = {.repeat = 1, .until = HE_UNTIL_COUNT}};
    if (!api_in_only(walk, members) ||
        !read_end(a, walk, "from", API_KIND_BIT(HE_HALFEDGE), &out->from) ||
        !read_steps(a, walk, out)) {
        return false;
    }
    if (api_in_find(walk, "until", &in)) {
        if (!api_in_choice(&in, until_names, &choice)) {
            return false;
        }
        out->steps.until = untils[choice];
        out->until_name = until_names[choice];
        out->steps.repeat = UINT64_MAX;
    }
    out->has_repeat = api_in_find(walk, "repeat", &in);
    return !out->has_repeat || api_in_u64(&in, 0, (uint64_t)1 << 53, &out->steps.repeat);
}

static void write_path(api_asker *a, const path *p)
{
    begin_answer(a, "path", p->from);
    api_out_key(a->out, "path");
    api_out_array_begin(a->out);
    for (size_t i = 0; i < p->steps.count; i++) {
        api_out_string(a->out, step_names[p->steps.list[i]]);
    }
    api_out_array_end(a->out);
    if (p->has_repeat || p->until_name == NULL) {
        api_out_key_u64(a->out, "repeat", p->steps.repeat);
    }
    if (p->until_name != NULL) {
        api_out_key_string(a->out, "until", p->until_name);
    }
    api_out_key_ids(a->out, "halfedges", a->first.ids, a->first.count);
    api_out_key_id(a->out, "end", a->first.ids[a->first.count - 1]);
    api_out_object_end(a->out);
}

static bool ask_path(api_asker *a, const api_in *walk)
{
    path p;
    he_error err = {0};
    if (!read_path(a, walk, &p)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    uint64_t limit = a->on_worker ? api_asker_left(a) : API_MAX_WALK;
    if (limit == 0 || (p.steps.until == HE_UNTIL_COUNT && p.steps.repeat > limit / p.steps.count)) {
        return api_asker_exceed(a, walk);
    }
    p.steps.limit = limit;
    if (he_traverse_path(a->mesh, (he_halfedge){p.from.id}, &p.steps, &a->x->progress, &a->first,
                         &err) != HE_OK) {
        return api_asker_refuse(a, walk, &err);
    }
    api_asker_pay(a, a->first.count);
    write_path(a, &p);
    return true;
}

/* --- the walk "loop" --- */

static bool ask_loop(api_asker *a, const api_in *walk)
{
    static const char *const members[] = {"walk", "from", NULL};
    he_element from;
    he_error err = {0};
    if (!api_in_only(walk, members) ||
        !read_end(a, walk, "from", API_KIND_BIT(HE_HALFEDGE), &from)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    if (he_traverse_loop(a->mesh, (he_halfedge){from.id}, &a->first, &err) != HE_OK) {
        return api_asker_refuse(a, walk, &err);
    }
    if (is_too_long(&a->first)) {
        return api_asker_exceed(a, walk);
    }
    api_asker_pay(a, 2 * a->first.count);
    begin_answer(a, "loop", from);
    api_out_key_ids(a->out, "halfedges", a->first.ids, a->first.count);
    api_out_key(a->out, "vertices");
    api_out_array_begin(a->out);
    for (size_t i = 0; i < a->first.count; i++) {
        api_out_id(a->out, he_origin(a->mesh, (he_halfedge){a->first.ids[i]}).i);
    }
    api_out_array_end(a->out);
    api_out_key_id(a->out, "face", he_face_of(a->mesh, (he_halfedge){from.id}).i);
    api_out_object_end(a->out);
    return true;
}

/* --- the walks "rings" and "breadth_first" --- */

/* Returns how many elements a breadth-first walk may reach. */
static uint64_t most_of_flood(const api_asker *a)
{
    if (a->on_worker) {
        return api_asker_left(a) / FLOOD_COST;
    }
    double most = API_FLOOD_PER_SECOND * api_patience(a->x);
    return most < API_MAX_WALK ? (uint64_t)most : API_MAX_WALK;
}

/* Walks breadth first: fills the list a->first with the ids of the elements and a->second with
 * their depths. `question` is the walk, for the JSON pointer of a refusal. */
static bool flood(api_asker *a, const api_in *question, const he_breadth_first *asked)
{
    he_error err = {0};
    size_t most = 1 + (size_t)most_of_flood(a);
    bool bounded = asked->limit != 0 && asked->limit < most;
    he_breadth_first walk = *asked;
    walk.limit = bounded ? asked->limit : most;
    if (he_traverse_breadth_first(a->mesh, &walk, &a->first, &a->second, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    if (!bounded && a->first.count == most) {
        return api_asker_waits(a, API_MAX_WALK / API_FLOOD_PER_SECOND) &&
               api_asker_exceed(a, question);
    }
    api_asker_pay(a, FLOOD_COST * (uint64_t)a->first.count);
    return true;
}

static bool ask_rings(api_asker *a, const api_in *walk)
{
    static const char *const members[] = {"walk", "from", "depth", NULL};
    api_in in;
    he_element from;
    uint64_t depth;
    if (!api_in_only(walk, members) || !read_end(a, walk, "from", API_KIND_BIT(HE_VERTEX), &from) ||
        !api_in_need(walk, "depth", &in) || !api_in_u64(&in, 0, API_MAX_WALK, &depth)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    if (!flood(a, walk, &(he_breadth_first){from.kind, from.id, (uint32_t)depth, 0})) {
        return false;
    }
    begin_answer(a, "rings", from);
    api_out_key_u64(a->out, "depth", depth);
    api_out_key(a->out, "rings");
    api_out_array_begin(a->out);
    for (size_t i = 0, next; i < a->first.count; i = next) {
        for (next = i + 1; next < a->first.count && a->second.ids[next] == a->second.ids[i];) {
            next++;
        }
        api_out_ids(a->out, a->first.ids + i, next - i);
    }
    api_out_array_end(a->out);
    api_out_object_end(a->out);
    return true;
}

static bool ask_breadth_first(api_asker *a, const api_in *walk)
{
    static const char *const members[] = {"walk", "from", "depth", "limit", NULL};
    api_in in;
    he_element from;
    uint64_t depth = HE_NONE, limit = 0;
    if (!api_in_only(walk, members) ||
        !read_end(a, walk, "from", API_KIND_BIT(HE_VERTEX) | API_KIND_BIT(HE_FACE), &from)) {
        return false;
    }
    if (api_in_find(walk, "depth", &in) && !api_in_u64(&in, 0, API_MAX_WALK, &depth)) {
        return false;
    }
    if (api_in_find(walk, "limit", &in) && !api_in_u64(&in, 1, API_MAX_WALK, &limit)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    if (!flood(a, walk, &(he_breadth_first){from.kind, from.id, (uint32_t)depth, (size_t)limit})) {
        return false;
    }
    begin_answer(a, "breadth_first", from);
    if (depth != HE_NONE) {
        api_out_key_u64(a->out, "depth", depth);
    }
    if (limit != 0) {
        api_out_key_u64(a->out, "limit", limit);
    }
    api_out_key_ids(a->out, "ids", a->first.ids, a->first.count);
    api_out_key_ids(a->out, "depths", a->second.ids, a->second.count);
    api_out_object_end(a->out);
    return true;
}

/* --- the walk "shortest_path" --- */

static const char *const measure_names[] = {
    [HE_BY_EDGES] = "edges", [HE_BY_LENGTH] = "length", NULL};

static void write_shortest_path(api_asker *a, const he_path *found)
{
    if (!found->found) {
        api_out_key_null(a->out, "vertices");
        api_out_key_null(a->out, "edges");
        api_out_key_null(a->out, "length");
        return;
    }
    api_out_key_ids(a->out, "vertices", found->vertices.ids, found->vertices.count);
    api_out_key_ids(a->out, "edges", found->edges.ids, found->edges.count);
    api_out_key_number(a->out, "length", found->length);
}

static bool ask_shortest_path(api_asker *a, const api_in *walk)
{
    static const char *const members[] = {"walk", "from", "to", "by", NULL};
    api_in in;
    he_element from, to;
    int by = HE_BY_LENGTH;
    if (!api_in_only(walk, members) || !read_end(a, walk, "from", API_KIND_BIT(HE_VERTEX), &from) ||
        !read_end(a, walk, "to", API_KIND_BIT(HE_VERTEX), &to)) {
        return false;
    }
    if (api_in_find(walk, "by", &in) && !api_in_choice(&in, measure_names, &by)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    if (a->on_worker && he_mesh_count(a->mesh, HE_HALFEDGE) > api_asker_left(a)) {
        return api_asker_exceed(a, walk);
    }
    if (!api_asker_waits(a, (double)api_elements_of(a->mesh) / API_PATH_PER_SECOND)) {
        return false;
    }
    he_path found = {0};
    he_error err = {0};
    if (he_traverse_shortest_path(a->mesh, (he_vertex){from.id}, (he_vertex){to.id}, (he_measure)by,
                                  &found, &err) != HE_OK) {
        return api_asker_refuse(a, walk, &err);
    }
    bool short_enough = !is_too_long(&found.vertices) || api_asker_exceed(a, walk);
    if (short_enough) {
        api_asker_pay(a, found.visited);
        begin_answer(a, "shortest_path", from);
        api_out_key(a->out, "to");
        api_write_reference(a->out, to.kind, to.id);
        api_out_key_string(a->out, "by", measure_names[by]);
        write_shortest_path(a, &found);
        api_out_object_end(a->out);
    }
    he_path_clear(&found);
    return short_enough;
}

/* --- the walks "edge_loop" and "edge_ring" --- */

static bool ask_edges(api_asker *a, const api_in *walk, const char *name,
                      he_status (*find)(const he_mesh *, he_edge, he_ids *, bool *, he_error *))
{
    static const char *const members[] = {"walk", "from", NULL};
    he_element from;
    bool closed;
    he_error err = {0};
    if (!api_in_only(walk, members) || !read_end(a, walk, "from", API_KIND_BIT(HE_EDGE), &from)) {
        return false;
    }
    if (a->reads_only) {
        return true;
    }
    if (find(a->mesh, (he_edge){from.id}, &a->first, &closed, &err) != HE_OK) {
        return api_asker_refuse(a, walk, &err);
    }
    if (is_too_long(&a->first)) {
        return api_asker_exceed(a, walk);
    }
    api_asker_pay(a, 4 * (uint64_t)a->first.count);
    begin_answer(a, name, from);
    api_out_key_ids(a->out, "edges", a->first.ids, a->first.count);
    api_out_key_bool(a->out, "closed", closed);
    api_out_object_end(a->out);
    return true;
}

static bool ask_edge_loop(api_asker *a, const api_in *walk)
{
    return ask_edges(a, walk, "edge_loop", he_traverse_edge_loop);
}

static bool ask_edge_ring(api_asker *a, const api_in *walk)
{
    return ask_edges(a, walk, "edge_ring", he_traverse_edge_ring);
}

/* --- walks of all kinds --- */

/* Each row: X(name of a kind of walk) */
#define WALK_MAP(X) \
    X(path) X(loop) X(rings) X(breadth_first) X(shortest_path) X(edge_loop) X(edge_ring)

#define WALK_NAME(name) #name,
#define WALK_ASK(name)  ask_##name,
static const char *const walk_names[] = {WALK_MAP(WALK_NAME) NULL};
static bool (*const walks[])(api_asker *a, const api_in *walk) = {WALK_MAP(WALK_ASK)};
#undef WALK_NAME
#undef WALK_ASK

bool api_walk_ask(api_asker *a, const api_in *walk)
{
    api_in name;
    int choice;
    a->first.count = a->second.count = 0;
    return api_in_object(walk) && api_in_need(walk, "walk", &name) &&
           api_in_choice(&name, walk_names, &choice) && walks[choice](a, walk);
}

static void answer(api_exchange *x, api_asker *a)
{
    if (api_walk_ask(a, &x->root) && !a->reads_only) {
        api_answer_json(x, 200);
    }
}

bool api_traverse_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)mesh;
    (void)out; /* the cost is not estimated: it is charged during the walk */
    return !api_wants_job(x, 0) || api_asker_read(x, answer);
}

void api_traverse_post(api_exchange *x)
{
    api_asker_run(x, answer);
}
