#include "api/ask/question.h"

#include "api/ask/bvh_cache.h"
#include "api/read/elements.h"
#include "mesh/walk.h"

#include <string.h>

/* The cost of reading the shortest question and writing its answer. The unit of costs is the visit
 * of one half-edge. */
enum { QUESTION_COST = 4 };

enum {
    ALL_KINDS = API_KIND_BIT(HE_VERTEX) | API_KIND_BIT(HE_HALFEDGE) | API_KIND_BIT(HE_EDGE) |
                API_KIND_BIT(HE_FACE)
};

/* --- budget and refusals --- */

static uint64_t allowance(const api_asker *a)
{
    uint64_t elements = api_elements_of(a->mesh);
    uint64_t most = elements > API_MAX_WALK ? elements : API_MAX_WALK;
    if (a->on_worker) {
        return (uint64_t)API_HALFEDGE_STEPS * API_COSTLY_ELEMENTS;
    }
    return API_HALFEDGE_STEPS * most * (a->x->phase == API_PHASE_JOB ? API_JOB_TIMES : 1);
}

/* Runs the function `answer` with a budget of computing steps. Returns true if the budget is used
 * up, so that the request must start again on another thread. */
static bool run(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a), bool reads_only)
{
    api_asker a = {.x = x,
                   .mesh = x->content,
                   .revision = x->info.revision,
                   .out = &x->out,
                   .arena = &x->arena,
                   .budget = {.progress = &x->progress},
                   .asked = "this",
                   .on_worker = x->phase == API_PHASE_BODY,
                   .reads_only = reads_only};
    a.budget.left = allowance(&a);
    answer(x, &a);
    he_ids_clear(&a.first);
    he_ids_clear(&a.second);
    api_bvh_release(a.tree);
    return a.spent;
}

void api_asker_run(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a))
{
    if (run(x, answer, false)) {
        api_begin_elsewhere(x);
    }
}

bool api_asker_read(api_exchange *x, void (*answer)(api_exchange *x, api_asker *a))
{
    (void)run(x, answer, true);
    return x->problem.code == HE_OK;
}

uint64_t api_asker_left(const api_asker *a)
{
    return a->budget.left / API_HALFEDGE_STEPS;
}

void api_asker_pay(api_asker *a, uint64_t halfedges)
{
    uint64_t left = api_asker_left(a);
    a->budget.left = left > halfedges ? a->budget.left - API_HALFEDGE_STEPS * halfedges : 0;
}

bool api_asker_exceed(api_asker *a, const api_in *in)
{
    /* A client that is willing to wait, but also accepts a job (it sends Prefer: respond-async,
     * wait=10), gets a job. */
    bool may_be_job = api_can_be_job(a->x);
    bool is_job = !a->on_worker && may_be_job && a->x->prefer.respond_async;
    if (a->on_worker || is_job) {
        a->spent = true;
        a->x->is_job = is_job;
        return false;
    }
    const char *limit = "\"%s\" would exceed the %llu computing steps that all questions of a %s "
                        "together may take on this mesh%s";
    const char *what = a->x->phase == API_PHASE_JOB ? "job" : "request";
    const char *hint =
        may_be_job ? "; a job may take more: send the header Prefer: respond-async" : "";
    unsigned long long most = allowance(a);
    return in == NULL ? api_fail(a->x, HE_LIMIT, limit, a->asked, most, what, hint)
                      : api_in_fail(in, HE_LIMIT, limit, a->asked, most, what, hint);
}

bool api_asker_waits(api_asker *a, double seconds)
{
    a->seconds += seconds;
    if (a->on_worker || !api_wants_job(a->x, a->seconds)) {
        return true;
    }
    a->spent = true;
    a->x->is_job = true;
    a->x->seconds = a->seconds;
    return false;
}

bool api_asker_refuse(api_asker *a, const api_in *in, const he_error *err)
{
    if (err->status == HE_LIMIT) {
        return api_asker_exceed(a, in);
    }
    if (in == NULL) {
        return api_fail_core(a->x, err);
    }
    if (in->problem->code == HE_OK) {
        api_problem_set_core(in->problem, err);
        api_in_point(in);
    }
    return false;
}

bool api_asker_element(api_asker *a, const api_in *in, unsigned kinds, he_kind *kind, uint32_t *id)
{
    api_in member;
    he_error err = {0};
    if (!api_in_element(in, kind, id) || !api_in_first(in, &member)) {
        return false;
    }
    if (!(kinds & API_KIND_BIT(*kind))) {
        char list[64] = "";
        for (he_kind k = HE_VERTEX; k <= HE_FACE; k++) {
            if (kinds & API_KIND_BIT(k)) {
                strncat(list, list[0] == '\0' ? "a " : " or a ", sizeof list - strlen(list) - 1);
                strncat(list, he_kind_name(k), sizeof list - strlen(list) - 1);
            }
        }
        return api_in_fail(&member, HE_BAD_VALUE, "the element is a %s, but must be %s",
                           he_kind_name(*kind), list);
    }
    return he_mesh_require(a->mesh, *kind, *id, &err) == HE_OK ||
           api_asker_refuse(a, &member, &err);
}

/* --- the elements that a question is about --- */

/* Finds the kind of element whose plural names a member of `of`, as in {"vertices":[1,2]}. */
static bool find_plural(const api_in *of, he_kind *kind, api_in *member)
{
    if (!api_in_is_object(of) || !api_in_first(of, member)) {
        return false;
    }
    for (he_kind k = HE_VERTEX; k <= HE_FACE; k++) {
        if (strcmp(api_in_name(member), he_kind_plural(k)) == 0) {
            *kind = k;
            return true;
        }
    }
    return false;
}

bool api_target_is_dense(const api_in *of)
{
    api_in member;
    he_kind kind;
    return find_plural(of, &kind, &member);
}

/* Reads a list of live elements. */
static bool read_ids(api_asker *a, const api_in *list, he_kind kind, uint32_t **ids, size_t *count)
{
    if (!api_in_ids(list, 0, a->arena, ids, count)) {
        return false;
    }
    he_error err = {0};
    api_in child;
    size_t i = 0;
    for (bool more = api_in_first(list, &child); more; more = api_in_next(&child)) {
        if (he_mesh_require(a->mesh, kind, (*ids)[i++], &err) != HE_OK) {
            return api_asker_refuse(a, &child, &err);
        }
    }
    return true;
}

static bool read_many(api_asker *a, const api_in *list, api_target *out)
{
    static const char *const all[] = {"all", NULL};
    int choice;
    uint32_t *ids;
    if (api_in_is_string(list)) {
        return api_in_choice(list, all, &choice);
    }
    if (!read_ids(a, list, out->kind, &ids, &out->count)) {
        return false;
    }
    out->of = ids;
    return true;
}

bool api_asker_target(api_asker *a, const api_in *of, api_target *out)
{
    api_in member;
    *out = (api_target){.dense = false};
    if (!find_plural(of, &out->kind, &member)) {
        return api_asker_element(a, of, ALL_KINDS, &out->kind, &out->id);
    }
    out->dense = true;
    api_in second = member;
    if (api_in_next(&second)) {
        return api_in_fail(
            &second, API_UNKNOWN_MEMBER,
            "give exactly one of \"vertices\", \"halfedges\", \"edges\" and \"faces\"");
    }
    return read_many(a, &member, out);
}

bool api_asker_name(api_asker *a, const api_in *question, const api_target *of, api_named *out)
{
    he_error err = {0};
    out->all = of->dense && of->of == NULL;
    if (!out->all) {
        return true;
    }
    if (he_ids_reserve(&out->ids, he_mesh_count(a->mesh, of->kind), &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    for (uint32_t id = he_mesh_next_live(a->mesh, of->kind, 0); id != HE_NONE;
         id = he_mesh_next_live(a->mesh, of->kind, (uint64_t)id + 1)) {
        out->ids.ids[out->ids.count++] = id;
    }
    return true;
}

/* --- questions about neighbours --- */

/* A decoded question about neighbours. */
typedef struct asked {
    const he_relation *relation;
    unsigned flags;
    api_target target;
} asked;

/* A number greater than that of the relations of any kind of element. */
enum { MOST_RELATIONS = 8 };

/* Lists the names of the relations of one kind of element, followed by NULL. */
static void list_relations(he_kind of, const char *names[MOST_RELATIONS + 1])
{
    size_t count = 0;
    for (size_t i = 0; i < he_relation_count(); i++) {
        const he_relation *relation = he_relation_at(i);
        if (relation->of == of && count < MOST_RELATIONS) {
            names[count++] = relation->name;
        }
    }
    names[count] = NULL;
}

bool api_question_is_dense(const api_in *question)
{
    api_in of;
    return api_in_is_object(question) && api_in_find(question, "relation", &of) &&
           api_in_find(question, "of", &of) && api_target_is_dense(&of);
}

static bool read_relation(api_asker *a, const api_in *question, asked *out)
{
    static const char *const members[] = {"relation", "of", "cw", NULL};
    api_in relation, of, cw;
    int choice;
    bool clockwise = false;
    *out = (asked){0};
    if (!api_in_only(question, members) || !api_in_need(question, "relation", &relation) ||
        !api_in_need(question, "of", &of)) {
        return false;
    }
    if (api_in_find(question, "cw", &cw) && !api_in_bool(&cw, &clockwise)) {
        return false;
    }
    out->flags = clockwise ? HE_CLOCKWISE : 0;
    if (!api_asker_target(a, &of, &out->target)) {
        return false;
    }
    const char *names[MOST_RELATIONS + 1];
    list_relations(out->target.kind, names);
    if (!api_in_choice(&relation, names, &choice)) {
        return false;
    }
    out->relation = he_relation_find(out->target.kind, names[choice], strlen(names[choice]));
    return true;
}

/* Returns the number of half-edges to charge for a question that found `ids` neighbours. To find
 * the faces next to a face, all its corners are visited; every other relation finds about as many
 * neighbours as it visits half-edges, or half as many. */
static uint64_t looked_at(const he_mesh *mesh, const asked *q, size_t ids)
{
    if (q->relation->of != HE_FACE || q->relation->gives != HE_FACE) {
        return ids;
    }
    uint64_t total = 0;
    if (!q->target.dense) {
        return he_face_degree(mesh, (he_face){q->target.id});
    }
    for (size_t i = 0; q->target.of != NULL && i < q->target.count; i++) {
        total += he_face_degree(mesh, (he_face){q->target.of[i]});
    }
    return q->target.of != NULL ? total : he_mesh_count(mesh, HE_HALFEDGE);
}

static bool find_dense(api_asker *a, const api_in *question, const asked *q, he_dense *out,
                       api_named *named)
{
    he_error err = {0};
    uint64_t count =
        q->target.of != NULL ? q->target.count : he_mesh_count(a->mesh, q->relation->of);
    uint64_t pass = q->target.of == NULL ? count + he_mesh_count(a->mesh, HE_HALFEDGE) : 0;
    if (!api_asker_waits(a, (double)pass / API_MAX_WALK)) {
        return false;
    }
    if (count >= api_asker_left(a)) {
        return api_asker_exceed(a, question);
    }
    if (he_relation_dense(a->mesh,
                          &(he_neighbours){.relation = q->relation,
                                           .of = q->target.of,
                                           .count = q->target.count,
                                           .flags = q->flags},
                          api_asker_left(a), out, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    api_asker_pay(a, count + looked_at(a->mesh, q, out->ids.count));
    return api_asker_name(a, question, &q->target, named);
}

bool api_question_dense(api_asker *a, const api_in *question, he_dense *out, api_named *named)
{
    asked q;
    return read_relation(a, question, &q) &&
           (a->reads_only || find_dense(a, question, &q, out, named));
}

static bool ask_dense(api_asker *a, const api_in *question, const asked *q)
{
    he_dense dense = {0};
    api_named named = {0};
    const bool good = find_dense(a, question, q, &dense, &named);
    if (good) {
        api_out_object_begin(a->out);
        if (named.all) {
            api_out_key_ids(a->out, "elements", named.ids.ids, named.ids.count);
        }
        api_out_key_ids(a->out, "offsets", dense.offsets.ids, dense.offsets.count);
        api_out_key_ids(a->out, "ids", dense.ids.ids, dense.ids.count);
        api_out_object_end(a->out);
    }
    he_ids_clear(&named.ids);
    he_dense_clear(&dense);
    return good;
}

static bool ask_relation(api_asker *a, const api_in *question)
{
    asked q;
    he_error err = {0};
    if (!read_relation(a, question, &q)) {
        return false;
    }
    if (q.target.dense) {
        return ask_dense(a, question, &q);
    }
    a->first.count = 0;
    if (he_relation_append(a->mesh, q.relation, q.target.id, q.flags, &a->first, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    api_asker_pay(a, looked_at(a->mesh, &q, a->first.count));
    api_write_adjacency(a->out, a->revision, q.relation, q.target.id, &a->first);
    return true;
}

/* --- the questions "find" and "get" --- */

/* Returns the number of half-edges to charge for finding the half-edge between two vertices: the
 * smaller of their degrees, at most `most`. */
static uint64_t smaller_degree(const he_mesh *mesh, he_vertex a, he_vertex b, uint64_t most)
{
    he_halfedge first_a = he_vertex_halfedge(mesh, a), first_b = he_vertex_halfedge(mesh, b);
    if (he_is_none(first_a.i) || he_is_none(first_b.i)) {
        return 0;
    }
    he_halfedge x = first_a, y = first_b;
    uint64_t steps = 0;
    do {
        x = he_swing_ccw(mesh, x);
        y = he_swing_ccw(mesh, y);
        steps++;
    } while (x.i != first_a.i && y.i != first_b.i && steps < most);
    return steps;
}

/* Returns the degree of a vertex, at most `most`. */
static uint64_t degree_of(const he_mesh *mesh, he_vertex v, uint64_t most)
{
    he_halfedge first = he_vertex_halfedge(mesh, v), h = first;
    uint64_t degree = 0;
    if (!he_is_none(first.i)) {
        do {
            h = he_swing_ccw(mesh, h);
            degree++;
        } while (h.i != first.i && degree < most);
    }
    return degree;
}

static bool find_faces(api_asker *a, const api_in *question, he_vertex v, he_vertex w)
{
    he_error err = {0};
    uint64_t cost = degree_of(a->mesh, v, api_asker_left(a));
    cost += degree_of(a->mesh, w, api_asker_left(a) - cost);
    if (cost >= api_asker_left(a)) {
        return api_asker_exceed(a, question);
    }
    a->first.count = 0;
    if (he_common_faces(a->mesh, v, w, &a->first, &err) != HE_OK) {
        return api_asker_refuse(a, question, &err);
    }
    api_asker_pay(a, cost);
    api_out_object_begin(a->out);
    api_out_key_ids(a->out, "faces", a->first.ids, a->first.count);
    api_out_object_end(a->out);
    return true;
}

static bool find_edge(api_asker *a, const api_in *question, he_vertex v, he_vertex w, bool halfedge)
{
    uint64_t cost = smaller_degree(a->mesh, v, w, api_asker_left(a));
    if (cost >= api_asker_left(a)) {
        return api_asker_exceed(a, question);
    }
    api_asker_pay(a, cost);
    he_halfedge h = he_find_halfedge(a->mesh, v, w);
    api_out_object_begin(a->out);
    if (halfedge) {
        api_out_key_id(a->out, "halfedge", h.i);
    } else {
        api_out_key_id(a->out, "edge", he_is_none(h.i) ? HE_NONE : he_edge_of(h).i);
    }
    api_out_object_end(a->out);
    return true;
}

static bool ask_find(api_asker *a, const api_in *question)
{
    enum { HALFEDGE, EDGE, FACES };
    static const char *const members[] = {"find", "vertices", NULL};
    static const char *const finds[] = {"halfedge", "edge", "faces", NULL};
    api_in find, vertices;
    int choice;
    uint32_t *ends;
    size_t count;
    if (!api_in_only(question, members) || !api_in_need(question, "find", &find) ||
        !api_in_choice(&find, finds, &choice) || !api_in_need(question, "vertices", &vertices) ||
        !api_in_array(&vertices, 2, 2) || !read_ids(a, &vertices, HE_VERTEX, &ends, &count)) {
        return false;
    }
    he_vertex from = {ends[0]}, to = {ends[1]};
    return choice == FACES ? find_faces(a, question, from, to)
                           : find_edge(a, question, from, to, choice == HALFEDGE);
}

static bool ask_get(api_asker *a, const api_in *question)
{
    static const char *const members[] = {"get", NULL};
    api_in get;
    he_kind kind;
    uint32_t id;
    if (!api_in_only(question, members) || !api_in_need(question, "get", &get) ||
        !api_asker_element(a, &get, ALL_KINDS, &kind, &id)) {
        return false;
    }
    api_asker_pay(a, api_write_element(a->out, a->mesh, kind, id));
    return true;
}

/* --- questions of all kinds --- */

bool api_question_ask(api_asker *a, const api_in *question)
{
    static const struct {
        const char *member;
        bool (*ask)(api_asker *a, const api_in *question);
    } kinds[] = {{"relation", ask_relation},   {"walk", api_walk_ask},
                 {"find", ask_find},           {"get", ask_get},
                 {"measure", api_measure_ask}, {"ray", api_ray_ask},
                 {"closest", api_closest_ask}, {"self_intersections", api_self_intersections_ask}};
    api_in member;
    if (!api_in_object(question)) {
        return false;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (!api_in_find(question, kinds[i].member, &member)) {
            continue;
        }
        a->asked = kinds[i].member;
        if (api_asker_left(a) == 0) {
            return api_asker_exceed(a, question);
        }
        he_error err = {0};
        if (he_progress_step(&a->x->progress, 0, 1, &err) != HE_OK) {
            return api_asker_refuse(a, question, &err);
        }
        api_asker_pay(a, QUESTION_COST);
        return kinds[i].ask(a, question);
    }
    return api_in_fail(question, API_MISSING_MEMBER,
                       "\"relation\", \"walk\", \"find\", \"get\", \"measure\", \"ray\", "
                       "\"closest\" or \"self_intersections\" is missing");
}
