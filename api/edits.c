/* POST .../edits: one operation, or a list that is applied whole or not at all. */
#include "api/handlers.h"

#include "api/changes.h"
#include "api/decode_op.h"
#include "api/edit_cost.h"
#include "api/names.h"
#include "api/others.h"

#include <string.h>

/* A request between decoding and answer. */
typedef struct edits {
    api_in list; /* the array of operations; unused when there is one */
    api_item op; /* of it, the one at hand */
    bool is_list;
    size_t count;
    api_in expected;
    bool has_expected;
    bool dry_run;
    size_t whole;  /* operations that cost the mesh */
    double growth; /* by how many times they make it larger, all in all */
    api_edit_cost cost;
    uint64_t looked_at; /* elements, by the operations so far: see API_MAX_EDITS_ELEMENTS */
    api_names names;
    api_others others;
    api_arena scratch; /* arguments of the operation at hand */
    api_text results;  /* objects of `results`, comma-separated */
    api_out out;       /* writes them */
    char ops[API_ENTRY_OPS];
    /* of a claim */
    const he_mesh *content;
    he_delta *delta;
} edits;

/* Of a long edit: the copy, then the operations, then what they changed; and the answer. */
static const double COPY_SHARE = 0.2, OPS_SHARE = 0.7, CHANGES_SHARE = 0.95;

static const char *const list_members[] = {"expected_revision", "dry_run", "ops", NULL};
static const char *const beside_op[] = {"expected_revision", "dry_run", NULL};

static void free_edits(void *state)
{
    edits *e = state;
    api_names_clear(&e->names);
    api_others_clear(&e->others);
    api_edit_cost_clear(&e->cost);
    api_arena_clear(&e->scratch);
    api_item_clear(&e->op);
    api_text_clear(&e->results);
    he_mem_free(e);
}

/* Append an operation's name to the text of the history, or dots where no more fit. */
static void note_name(edits *e, const char *name)
{
    static const char more[] = ",...";
    size_t used = strlen(e->ops), length = strlen(name);
    if (used >= sizeof more - 1 && strcmp(e->ops + used - (sizeof more - 1), more) == 0) {
        return;
    }
    if (used + 1 + length + sizeof more > sizeof e->ops) {
        memcpy(e->ops + used, more, sizeof more);
        return;
    }
    if (used > 0) {
        e->ops[used++] = ',';
    }
    memcpy(e->ops + used, name, length + 1);
}

static bool decode(edits *e, const api_in *in, const he_mesh *mesh, api_call *call)
{
    api_arena_empty(&e->scratch);
    return api_decode_op(in, e->is_list ? NULL : beside_op,
                         e->is_list ? &e->names.references : NULL, mesh, &e->others.meshes,
                         &e->scratch, call);
}

static bool note(edits *e, const api_in *in, const api_call *call)
{
    he_error err = {0};
    e->whole += he_op_is_whole(call->op, call->args) || call->has_set;
    e->growth *= he_op_growth(call->op, call->args);
    note_name(e, call->op->name);
    return api_edit_cost_add(&e->cost, call, &err) == HE_OK ||
           api_problem_set_core(in->problem, &err);
}

/* All that is wrong with the document itself is found before the first operation runs. */
static bool check_ops(const api_exchange *x, edits *e)
{
    api_call call;
    if (!e->is_list) {
        return decode(e, &x->root, NULL, &call) && note(e, &x->root, &call);
    }
    const api_in *op = &e->op.in;
    for (size_t i = 0; i < e->count; i++) {
        if (!api_item_read(&x->ops, i, &e->list, &e->op) || !decode(e, op, NULL, &call) ||
            !api_names_add(&e->names, op, &call) || !note(e, op, &call)) {
            return false;
        }
    }
    return true;
}

static bool check_count(const api_in *list, size_t count)
{
    if (count == 0) {
        return api_in_fail(list, HE_BAD_VALUE, "the list has no operation");
    }
    return count <= API_MAX_OPS ||
           api_in_fail(list, HE_LIMIT, "the list has %zu operations, at most %d are taken", count,
                       (int)API_MAX_OPS);
}

static bool read_request(api_exchange *x, edits *e)
{
    const api_in *root = &x->root;
    api_in dry;
    if (!api_in_object(root)) {
        return false;
    }
    e->is_list = api_in_find(root, "ops", &e->list);
    /* The array is empty here: its items were left in the text. */
    e->count = e->is_list ? x->ops.count : 1;
    if (e->is_list && (!api_in_only(root, list_members) || !api_in_array(&e->list, 0, 0) ||
                       !check_count(&e->list, e->count))) {
        return false;
    }
    e->has_expected = api_in_find(root, "expected_revision", &e->expected);
    if (api_in_find(root, "dry_run", &dry) && !api_in_bool(&dry, &e->dry_run)) {
        return false;
    }
    return check_ops(x, e);
}

static uint64_t issued(const he_mesh *mesh)
{
    return (uint64_t)he_mesh_issued(mesh, HE_VERTEX) + he_mesh_issued(mesh, HE_EDGE) +
           he_mesh_issued(mesh, HE_FACE);
}

/* A list of few bytes may ask for the whole mesh as often as it has operations. */
static bool within_limits(edits *e, const he_mesh *mesh, const he_delta *delta, const api_in *in,
                          const api_call *call)
{
    if (e->looked_at > API_MAX_EDITS_ELEMENTS) {
        return api_in_fail(in, HE_LIMIT, "the operations before look at %llu elements, over %d",
                           (unsigned long long)e->looked_at, (int)API_MAX_EDITS_ELEMENTS);
    }
    if (delta->count > API_MAX_EDITS_ROWS) {
        return api_in_fail(in, HE_LIMIT, "the operations before change %zu rows, over %d",
                           delta->count, (int)API_MAX_EDITS_ROWS);
    }
    if (he_op_is_whole(call->op, call->args) || call->has_set) {
        e->looked_at += issued(mesh);
    }
    for (size_t i = 0; i < he_op_params(call->op); i++) {
        e->looked_at += call->args[i].list ? call->args[i].count : 0;
        e->looked_at += call->args[i].mesh != NULL ? issued(call->args[i].mesh) : 0;
    }
    return true;
}

static size_t count_columns(const he_mesh *mesh, const he_mesh *unless)
{
    size_t count = 0;
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        count += column != NULL && (unless == NULL || he_mesh_find_column(unless, column->domain,
                                                                          column->name) == NULL);
    }
    return count;
}

/* What another mesh brings along counts like what requests add. */
static bool within_attributes(const he_mesh *mesh, const api_in *in, const api_call *call)
{
    for (size_t i = 0; i < he_op_params(call->op); i++) {
        const he_mesh *other = call->args[i].mesh;
        size_t more = other != NULL ? count_columns(other, mesh) : 0;
        if (more > 0 && count_columns(mesh, NULL) + more > API_MAX_ATTRIBUTES) {
            return api_in_fail(in, HE_LIMIT, "the mesh would have %zu attributes, over %d",
                               count_columns(mesh, NULL) + more, (int)API_MAX_ATTRIBUTES);
        }
    }
    return true;
}

/* Run one operation and write its results. The pointer of a refusal is the operation. */
static bool run_op(api_exchange *x, edits *e, he_mesh *mesh, const he_delta *delta,
                   const api_in *in)
{
    api_call call;
    he_results results = {0};
    he_error err = {0};
    if (!decode(e, in, mesh, &call) || !within_limits(e, mesh, delta, in, &call) ||
        !within_attributes(mesh, in, &call)) {
        return false;
    }
    if (he_op_run(call.op, mesh, call.args, &results, &err) != HE_OK) {
        api_fail_core(x, &err);
        if (e->is_list) {
            api_in_point(in);
        }
        return false;
    }
    api_write_results(&e->out, call.op, &results);
    api_names_bind(&e->names, &call, &results);
    he_results_clear(&results);
    return true;
}

static bool run_ops(api_exchange *x, edits *e, he_mesh *mesh, const he_delta *delta)
{
    if (!e->is_list) {
        he_watch_span(&x->watch, OPS_SHARE);
        return run_op(x, e, mesh, delta, &x->root);
    }
    for (size_t i = 0; i < e->count; i++) {
        he_watch_span(&x->watch,
                      COPY_SHARE + (OPS_SHARE - COPY_SHARE) * (double)(i + 1) / (double)e->count);
        if (!api_item_read(&x->ops, i, &e->list, &e->op) || !run_op(x, e, mesh, delta, &e->op.in)) {
            return false;
        }
    }
    return true;
}

/* The whole answer is written before anything is published, so that no failure follows it. */
static void write_answer(api_exchange *x, const edits *e, const he_changes *changes,
                         uint64_t revision, bool undoable)
{
    api_out *out = &x->out;
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", revision);
    if (e->dry_run) {
        api_out_key_bool(out, "dry_run", true);
    }
    api_out_key(out, "results");
    api_out_raw(out, e->results.bytes, e->results.length);
    api_write_changes(out, changes);
    if (!undoable) {
        api_out_key_bool(out, "undoable", false);
    }
    api_out_object_end(out);
}

static void answer(api_exchange *x, const edits *e)
{
    if (!e->dry_run) {
        api_answer_etag(x, "edits");
    }
    if (!api_answer_minimal(x)) {
        api_answer_json(x, 200);
    }
}

/* What the operations make of the mesh. True when that is to be published, with the answer written;
 * `*barrier` says whether it ends the undo stack. */
static bool edit(api_exchange *x, edits *e, he_mesh *mesh, const he_delta *delta, bool *barrier)
{
    he_changes changes = {0};
    he_error err = {0};
    uint64_t ids = issued(mesh);
    bool publish = false;
    api_out_array_begin(&e->out);
    if (!run_ops(x, e, mesh, delta)) {
        return false;
    }
    api_out_array_end(&e->out);
    if (e->results.failed) {
        return api_fail_memory(x);
    }
    he_watch_span(&x->watch, CHANGES_SHARE);
    if (he_changes_find(mesh, delta, 0, delta->count, false, &changes, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    /* An edit without effect makes no revision, unless it used up ids that its answer names. */
    bool effect = !he_changes_none(&changes) || issued(mesh) != ids;
    bool undoable = !changes.renumbered && x->store->undoable(x->store->self, x->mesh);
    write_answer(x, e, &changes, x->info.revision + (effect ? 1 : 0), undoable || !effect);
    if (x->text.failed) {
        api_fail_memory(x);
    } else {
        publish = effect && !e->dry_run;
    }
    if (publish) {
        api_tally tally = api_changes_tally(&changes);
        x->store->tally(x->store->self, x->mesh, &tally);
    }
    *barrier = changes.renumbered;
    he_changes_clear(&changes);
    return publish;
}

static void run(api_exchange *x)
{
    edits *e = x->state;
    he_delta *delta = NULL;
    bool barrier = false;
    if (!api_others_take(x, &e->others)) {
        return;
    }
    he_mesh *mesh = api_write_begin(x, e->has_expected ? &e->expected : NULL, &delta);
    if (mesh == NULL) {
        return;
    }
    he_mesh_watch(mesh, &x->watch);
    bool publish = edit(x, e, mesh, delta, &barrier);
    he_mesh_watch(mesh, NULL);
    if (publish) {
        x->store->write_commit(x->store->self, x->mesh, e->ops, barrier, &x->info);
        api_publish(x, 204);
    } else {
        x->store->write_abort(x->store->self, x->mesh);
    }
    api_others_release(&e->others);
    if (x->problem.code == HE_OK) {
        answer(x, e);
    }
}

/* --- long edits --- */

/* What the first operation is bound to be refused for: nothing changes the mesh before it. */
static bool foresee(api_exchange *x, edits *e)
{
    const api_in *in = e->is_list ? &e->op.in : &x->root;
    he_error err = {0};
    api_call call;
    if ((e->is_list && !api_item_read(&x->ops, 0, &e->list, &e->op)) ||
        !decode(e, in, NULL, &call)) {
        return false;
    }
    if (he_op_foresee(call.op, e->content, call.args, &err) == HE_OK) {
        return true;
    }
    api_fail_core(x, &err);
    if (e->is_list) {
        api_in_point(in);
    }
    return false;
}

/* Before the client is answered, so that it knows whether the mesh is its own. */
static bool claim(api_exchange *x, edits *e)
{
    uint64_t expected = 0;
    if (e->has_expected && !api_in_u64(&e->expected, 1, (uint64_t)1 << 53, &expected)) {
        return false;
    }
    api_store_status status =
        x->store->claim(x->store->self, x->mesh, &e->content, &e->delta, &x->info);
    x->has_info = status != API_STORE_ABSENT;
    if (status != API_STORE_OK) {
        return api_fail_store(x, status);
    }
    x->claimed = true;
    /* They hold until the claim ends: nobody else can change the mesh. */
    return api_preconditions_hold(x, e->has_expected ? &expected : NULL) && foresee(x, e);
}

static bool publish_copy(api_exchange *x, const edits *e, he_mesh *copy, bool barrier)
{
    api_store_status status =
        x->store->publish(x->store->self, x->mesh, copy, e->ops, barrier, x->claim, &x->info);
    x->claimed = false;
    if (status != API_STORE_OK) {
        x->has_info = false;
        return api_fail_store(x, status);
    }
    api_publish(x, 204);
    return true;
}

static void run_claimed(api_exchange *x)
{
    edits *e = x->state;
    he_mesh *copy = NULL;
    he_error err = {0};
    bool barrier = false;
    he_watch_span(&x->watch, COPY_SHARE);
    if (!api_others_take(x, &e->others)) {
        return;
    }
    if (he_mesh_copy_watched(e->content, &x->watch, &copy, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    he_mesh_record(copy, e->delta);
    bool publish = edit(x, e, copy, e->delta, &barrier);
    he_mesh_watch(copy, NULL);
    if (!publish || !publish_copy(x, e, copy, barrier)) {
        he_mesh_free(copy);
    }
    api_others_release(&e->others);
    if (x->problem.code == HE_OK) {
        answer(x, e);
    }
}

/* Elements in number beyond which it does not matter how many more there are. */
static const double MANY = 1e12;

/* A list of many operations, or one that costs the mesh or a huge element of it, belongs on a
 * thread that may block; what costs a really large mesh must not keep it locked. */
static void choose(api_exchange *x, edits *e)
{
    uint64_t elements = api_others_elements(&e->others);
    const he_mesh *mesh = api_read_begin(x);
    if (mesh == NULL) {
        return;
    }
    elements += api_elements_of(mesh);
    elements = e->growth * (double)elements < MANY ? (uint64_t)(e->growth * (double)elements)
                                                   : (uint64_t)MANY;
    bool costly = e->count > API_COSTLY_EDITS ||
                  (elements > API_COSTLY_ELEMENTS &&
                   (e->whole > 0 || api_edit_cost_exceeds(&e->cost, mesh, API_COSTLY_ELEMENTS)));
    api_read_end(x);
    if (e->whole > 0 && elements > API_CLAIM_ELEMENTS) {
        if (claim(x, e)) {
            api_run_long(x, run_claimed, true,
                         (double)e->whole * (double)elements / API_EDIT_PER_SECOND);
        }
    } else {
        api_run_long(x, run, costly, 0);
    }
}

void api_edits_post(api_exchange *x)
{
    edits *e = he_mem_zero(1, sizeof *e);
    if (e == NULL) {
        api_fail_memory(x);
        return;
    }
    x->state = e;
    x->free_state = free_edits;
    e->growth = 1;
    api_names_init(&e->names, x->store->secret);
    api_others_init(&e->others, x->store);
    api_out_init(&e->out, &e->results);
    if (!read_request(x, e)) {
        return;
    }
    choose(x, e);
}
