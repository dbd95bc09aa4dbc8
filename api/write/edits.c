/* edits.c - POST .../edits: one operation, or a list of operations that is applied as a whole or
 * not at all. */
#include "api/request/handlers.h"

#include "api/request/gate.h"
#include "api/request/mesh_access.h"

#include "api/event/change_json.h"
#include "api/write/attribute_limits.h"
#include "api/write/decode_op.h"
#include "api/write/edit_cost.h"
#include "api/write/named_meshes.h"
#include "api/write/result_names.h"

#include <stddef.h>
#include <string.h>

/* The state of a request between the decoding of its body and its answer. */
typedef struct edits {
    st_spares *home; /* where the block of this struct is kept afterwards */
    api_in list;     /* cursor at the array of operations; unused for a single operation */
    api_item op;     /* the current operation of the list */
    bool is_list;
    size_t count;
    api_in expected;
    bool has_expected;
    bool dry_run;
    size_t runs;              /* how often operations run: once, or once for each item of a list */
    size_t whole;             /* number of operations on the whole mesh */
    uint64_t passes;          /* how many passes over the mesh the `whole` operations take */
    double growth;            /* the factor by which all operations together enlarge the mesh */
    uint64_t elements_beside; /* number of elements of the other meshes that operations name */
    /* costly: true if the list must run on another thread than a worker thread. claims: true if the
     * list must claim the mesh (store/write.h) and work on a copy. */
    bool costly, claims;
    double seconds;
    api_edit_cost cost;
    uint64_t looked_at; /* elements charged so far (API_MAX_EDITS_ELEMENTS) */
    uint64_t steps;     /* steps charged so far (API_MAX_EDITS_STEPS) */
    uint64_t work;      /* work charged so far, in the unit of API_POOL_EDITS */
    uint64_t most_work; /* a list with more work must continue on another thread */
    bool exceeded;      /* `most_work` would be exceeded */
    /* A list whose delta has more rows than this must claim the mesh (store/write.h). */
    size_t most_rows;
    bool crowded; /* `most_rows` was exceeded */
    /* How many more reports of progress are free, because the charge for the current operation
     * includes them. */
    uint64_t paid;
    uint64_t look;    /* work charged for each report of progress that is not free */
    bool unlimited;   /* true if this thread may do any amount of work */
    he_progress told; /* the original x->progress, to which tell_and_charge forwards */
    /* The delta that records the changes, while an operation runs once for each item of a list;
     * else NULL. */
    const he_delta *growing;
    size_t seen;   /* number of rows of `growing` at the last free report of progress */
    bool overfull; /* `growing` has more rows than API_MAX_EDITS_ROWS */
    api_hubs hubs;
    api_result_names names;
    api_arena scratch; /* arguments of the current operation */
    api_text results;  /* the JSON array "results" of the answer */
    api_out out;       /* writes to `results` */
    bool packed;       /* the answer has the type API_PACKED_EDITS */
    api_arrays arrays; /* of a packed answer */
    char ops[ST_ENTRY_OPS];
    /* How often each operation ran, indexed by the number of the operation. */
    uint32_t ran[API_MOST_OPERATIONS];
    size_t at;   /* number (he_op_number) of the operation that is running; API_OPERATIONS: none */
    bool effect; /* the operations changed something */
    /* Position of the revision in the answer, where it is filled in after the commit. */
    size_t revision_at;
    /* The last member, because it is large and api_named_meshes_init sets what must be set. */
    api_named_meshes named;
} edits;

/* The progress (0 to 1) that a long edit has reached after copying the mesh, after running the
 * operations, and after finding the changes; then the answer is written. */
static const double COPY_SHARE = 0.2, OPS_SHARE = 0.7, CHANGES_SHARE = 0.95;

static const char *const list_members[] = {"expected_revision", "dry_run", "ops", NULL};
static const char *const beside_op[] = {"expected_revision", "dry_run", NULL};

static void free_edits(void *state)
{
    edits *e = state;
    api_result_names_clear(&e->names);
    api_named_meshes_clear(&e->named);
    api_edit_cost_clear(&e->cost);
    api_arena_clear(&e->scratch);
    api_item_clear(&e->op);
    api_text_clear(&e->results);
    api_arrays_clear(&e->arrays);
    st_spares_put(e->home, e);
}

/* Appends the name of an operation to `ops`, the list in the history entry; appends ",..." if the
 * name does not fit. */
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
    const api_op_scope scope = {
        .also = e->is_list ? NULL : beside_op,
        .references = e->is_list ? &e->names.references : NULL,
        .mesh = mesh,
        .meshes = &e->named.meshes,
    };
    api_arena_empty(&e->scratch);
    return api_decode_op(in, &scope, &e->scratch, call);
}

static bool note(edits *e, const api_in *in, const api_call *call)
{
    he_error err = {0};
    if (he_op_is_whole(call->op, call->args)) {
        e->whole++;
        e->passes += he_op_pace(call->op, call->args);
    } else if (call->has_set) {
        e->whole++;
        e->passes++;
    }
    e->runs += he_op_runs(call->op, call->args);
    e->growth *= he_op_growth(call->op, NULL, call->args);
    note_name(e, call->op->name);
    return api_edit_cost_add(&e->cost, call, &err) == HE_OK ||
           api_problem_set_core(in->problem, &err);
}

/* Refuses the operation `in` if the operations before it visit too many elements. */
static bool within_elements(uint64_t looked_at, const api_in *in)
{
    return looked_at <= API_MAX_EDITS_ELEMENTS ||
           api_in_fail(in, HE_LIMIT,
                       "the list of operations is too long: the operations before this one "
                       "visit %llu elements, and at most %d are allowed",
                       (unsigned long long)looked_at, (int)API_MAX_EDITS_ELEMENTS);
}

/* Returns the number of values in all lists and columns of an operation. */
static uint64_t count_listed(const api_call *call)
{
    uint64_t listed = 0;
    for (size_t i = 0; i < he_op_params(call->op); i++) {
        listed += call->args[i].list ? call->args[i].count : 0;
    }
    return listed;
}

/* While operations are checked, progress is reported once for this many of their values. */
enum { CHECKED_PER_LOOK = 16 * HE_PROGRESS_STRIDE };

/* Checks all operations, so that every mistake in the document is found before the first operation
 * runs. The values are counted, because one array of a packed body (api/json/packed.h) may be the
 * list of any number of operations. */
static bool check_ops(api_exchange *x, edits *e)
{
    api_call call;
    if (!e->is_list) {
        return decode(e, &x->root, NULL, &call) && note(e, &x->root, &call);
    }
    const api_in *op = &e->op.in;
    uint64_t listed = 0, next = CHECKED_PER_LOOK;
    for (size_t i = 0; i < e->count; i++) {
        he_error err = {0};
        if (listed >= next) {
            next = listed + CHECKED_PER_LOOK;
            if (he_progress_phase(&x->progress, "reading", 0, &err) != HE_OK) {
                return api_fail_core(x, &err);
            }
        }
        if (!api_item_read(&x->ops, i, &e->list, &e->op) || !within_elements(listed, op) ||
            !decode(e, op, NULL, &call) || !api_result_names_add(&e->names, op, &call) ||
            !note(e, op, &call)) {
            return false;
        }
        listed += count_listed(&call);
    }
    return true;
}

static bool check_count(const api_in *list, size_t count)
{
    if (count == 0) {
        return api_in_fail(list, HE_BAD_VALUE, "the list of operations is empty");
    }
    return count <= API_MAX_OPS ||
           api_in_fail(list, HE_LIMIT, "the list has %zu operations; at most %d are allowed", count,
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
    /* The array "ops" in the parsed document is empty: its items are parsed one by one (x->ops). */
    e->count = e->is_list ? x->ops.count : 1;
    if (e->is_list && (!api_in_only(root, list_members) || !api_in_array(&e->list, 0, 0) ||
                       !check_count(&e->list, e->count))) {
        return false;
    }
    e->has_expected = api_in_find(root, "expected_revision", &e->expected);
    if (api_in_find(root, "dry_run", &dry) && !api_in_bool(&dry, &e->dry_run)) {
        return false;
    }
    return (e->dry_run || api_gate_may_change(x)) && check_ops(x, e);
}

/* The largest number of elements that is computed exactly; larger numbers are all treated as this
 * one. */
static const double MANY = 1e12;

static uint64_t issued(const he_mesh *mesh)
{
    return (uint64_t)he_mesh_issued(mesh, HE_VERTEX) + he_mesh_issued(mesh, HE_EDGE) +
           he_mesh_issued(mesh, HE_FACE);
}

static bool fail_rows(const api_in *in)
{
    return api_in_fail(in, HE_LIMIT,
                       "the list of operations is too long: before this place it makes more than "
                       "%d changes to elements and attribute values",
                       (int)API_MAX_EDITS_ROWS);
}

/* Refuses a list that exceeds a limit of work. Even a short list can, because each of its
 * operations may name the whole mesh or a vertex of high degree. */
static bool within_limits(const edits *e, const he_delta *delta, const api_in *in)
{
    if (!within_elements(e->looked_at, in)) {
        return false;
    }
    if (e->steps > API_MAX_EDITS_STEPS) {
        return api_in_fail(in, HE_LIMIT,
                           "the list of operations is too long: the operations before this one "
                           "take %llu computing steps, and at most %llu are allowed",
                           (unsigned long long)e->steps, (unsigned long long)API_MAX_EDITS_STEPS);
    }
    return delta->count <= API_MAX_EDITS_ROWS || fail_rows(in);
}

/* The number of reports of progress that the charge for any operation includes, and for how many
 * passes over new elements: they are made step by step. */
enum { PHASES = 24, REPORTS_OF_NEW = 8 };

/* Returns false if the list exceeds what it may do on this thread, or without claiming the mesh
 * (store/write.h). */
static bool is_affordable(edits *e, const he_delta *delta)
{
    e->exceeded = e->exceeded || e->work + delta->count / API_ROWS_OF_WORK > e->most_work;
    e->crowded = e->crowded || delta->count > e->most_rows;
    return !e->exceeded && !e->crowded;
}

/* Returns after how many steps of an operation it is known that the list exceeds a limit. */
static uint64_t most_steps(const edits *e)
{
    const uint64_t left = e->most_work > e->work ? e->most_work - e->work : 0;
    return left < API_MAX_EDITS_STEPS / API_STEPS_OF_WORK ? (left + 1) * API_STEPS_OF_WORK
                                                          : API_MAX_EDITS_STEPS;
}

/* Charges the cost of one operation. Returns false if the list exceeds what it may do on this
 * thread, or without claiming the mesh (store/write.h). */
static bool charge(edits *e, const he_mesh *mesh, const he_delta *delta, const api_call *call)
{
    bool whole = he_op_is_whole(call->op, call->args);
    uint64_t elements = whole || call->has_set ? issued(mesh) : 0;
    const uint64_t listed = count_listed(call);
    for (size_t i = 0; i < he_op_params(call->op); i++) {
        elements += call->args[i].mesh != NULL ? issued(call->args[i].mesh) : 0;
    }
    const double growth = he_op_growth(call->op, mesh, call->args);
    double many = growth * (double)elements;
    uint64_t grown = many < MANY ? (uint64_t)many : (uint64_t)MANY;
    /* the elements that an operation makes which does not take the time of the whole mesh */
    double some = whole ? 0 : (growth - 1) * (double)issued(mesh);
    uint64_t made = some < MANY ? (uint64_t)some : (uint64_t)MANY;
    /* An operation that runs once takes no more steps than one visit to the whole mesh. */
    const bool walks = e->is_list || (he_op_each(call->op, call->args) != NULL && !e->unlimited);
    const uint64_t steps = walks ? api_edit_cost_steps(call, mesh, most_steps(e), &e->hubs) : 0;
    e->looked_at += elements + listed;
    e->steps += steps;
    uint64_t work = (whole ? grown * he_op_pace(call->op, call->args) : elements) +
                    (listed + made) * (whole ? 1 : he_op_pace(call->op, call->args)) +
                    steps / API_STEPS_OF_WORK;
    e->work += work;
    e->paid = PHASES + (2 * (grown + listed) + REPORTS_OF_NEW * made) / HE_PROGRESS_STRIDE;
    e->look = (uint64_t)HE_PROGRESS_STRIDE * he_op_pace(call->op, call->args);
    return is_affordable(e, delta);
}

/* Returns the parameter whose list names the element of a refusal at index `i`: `each`, or a column
 * of other elements beside it. */
static const he_param *list_with_element(const api_call *call, const he_param *each, size_t i,
                                         const api_problem *problem)
{
    const size_t params = problem->has_element ? he_op_params(call->op) : 0;
    for (size_t k = 0; k < params; k++) {
        const he_param *param = &call->op->params[k];
        const he_arg *arg = &call->args[k];
        if (param->type == HE_PARAM_ELEMENT && param->kind == problem->kind && arg->list &&
            i < arg->count && arg->ids[i] == problem->id) {
            return param;
        }
    }
    return each;
}

/* Gives a refusal the JSON pointer of the operation, or of the item of the list for which it was
 * refused. */
static void point_at(const edits *e, const api_in *in, const api_call *call, size_t i)
{
    const he_param *each = he_op_each(call->op, call->args);
    api_in list;
    if (each != NULL) {
        const he_param *param = list_with_element(call, each, i, in->problem);
        if (api_in_find(in, param->each != NULL ? param->each : param->name, &list)) {
            /* A reference may have put several ids into the list; then its items are others. */
            const bool is_item =
                api_in_is_array(&list) && api_in_count(&list) == he_op_runs(call->op, call->args);
            const api_in item = api_in_item(&list, i);
            api_in_point(is_item ? &item : &list);
            return;
        }
    }
    if (e->is_list) {
        api_in_point(in);
    }
}

/* Runs one operation and writes its results. A refusal gets the JSON pointer of the operation. */
static bool run_op(api_exchange *x, edits *e, he_mesh *mesh, const he_delta *delta,
                   const api_in *in)
{
    api_call call;
    he_results results = {0};
    he_error err = {0};
    if (!decode(e, in, mesh, &call) || !within_limits(e, delta, in) ||
        !charge(e, mesh, delta, &call)) {
        return false;
    }
    const api_attribute_count before = api_count_attributes(mesh);
    e->at = he_op_number(call.op);
    e->growing = he_op_each(call.op, call.args) != NULL ? delta : NULL;
    e->seen = delta->count;
    const he_status status = he_op_run(call.op, mesh, call.args, &results, &err);
    e->growing = NULL;
    if (status != HE_OK) {
        if (e->overfull) {
            fail_rows(in);
        } else {
            api_fail_core(x, &err);
        }
        point_at(e, in, &call, results.runs);
        return false;
    }
    bool good = api_within_attributes(before, mesh, in);
    if (good) {
        if (!x->prefer.minimal) {
            api_write_results(&e->out, call.op, &results);
        }
        api_result_names_bind(&e->names, &call, &results);
    }
    he_results_clear(&results);
    if (good) {
        e->ran[e->at]++;
        e->at = API_OPERATIONS;
    }
    return good;
}

/* Progress is reported once for this many operations, or earlier after a certain amount of work. It
 * is not reported for each operation, because a report takes a system call. */
enum { OPS_PER_LOOK = 256 };

static bool run_ops(api_exchange *x, edits *e, he_mesh *mesh, const he_delta *delta)
{
    if (!e->is_list) {
        he_progress_span(&x->progress, OPS_SHARE);
        return run_op(x, e, mesh, delta, &x->root);
    }
    uint64_t next = 0;
    for (size_t i = 0; i < e->count; i++) {
        he_error err = {0};
        he_progress_span(&x->progress, COPY_SHARE + (OPS_SHARE - COPY_SHARE) * (double)(i + 1) /
                                                        (double)e->count);
        uint64_t work = e->work + delta->count / API_ROWS_OF_WORK;
        if (i % OPS_PER_LOOK == 0 || work >= next) {
            next = work + HE_PROGRESS_STRIDE;
            e->paid = PHASES;
            if (he_progress_phase(&x->progress, "editing", 0, &err) != HE_OK) {
                return api_fail_core(x, &err);
            }
        }
        if (!api_item_read(&x->ops, i, &e->list, &e->op) || !run_op(x, e, mesh, delta, &e->op.in)) {
            return false;
        }
    }
    return true;
}

static void begin_results(edits *e)
{
    api_text_empty(&e->results);
    api_arrays_clear(&e->arrays);
    api_out_init(&e->out, &e->results);
    e->out.arrays = e->packed ? &e->arrays : NULL;
}

/* Puts the JSON of the answer and its arrays into one body. */
static bool pack_answer(api_exchange *x, const edits *e)
{
    api_text body = {0};
    api_packed_write(&e->arrays, &x->text, &body);
    api_text_clear(&x->text);
    x->text = body;
    return !body.failed || api_fail_memory(x);
}

/* Writes the whole answer before the commit, so that no failure can follow the commit. Only the
 * revision is filled in after it. */
static bool write_answer(api_exchange *x, edits *e)
{
    api_out *out = &x->out;
    if (x->prefer.minimal) {
        return true;
    }
    api_out_object_begin(out);
    if (e->packed) {
        out->arrays = &e->arrays;
    } else {
        api_out_key(out, "revision");
        e->revision_at = api_out_later(out);
    }
    if (e->dry_run) {
        api_out_key_bool(out, "dry_run", true);
    }
    api_out_key(out, "results");
    api_out_raw(out, e->results.bytes, e->results.length);
    api_write_changes(out, &x->write.changes);
    if (e->effect && !st_write_undoable(&x->write)) {
        api_out_key_bool(out, "undoable", false);
    }
    api_out_object_end(out);
    return (!x->text.failed || api_fail_memory(x)) && (!e->packed || pack_answer(x, e));
}

/* Answers the request. A dry run is answered with the revision that the edit would have made. */
static void answer(api_exchange *x, const edits *e)
{
    if (!x->prefer.minimal) {
        const uint64_t revision = x->info.revision + (e->dry_run && e->effect ? 1 : 0);
        if (e->packed) {
            api_packed_fill(&x->text, revision);
        } else {
            api_out_fill(&x->text, e->revision_at, revision);
        }
    }
    if (!e->dry_run) {
        api_answer_etag(x, e->packed ? "edits-octets" : "edits");
    }
    if (api_answer_minimal(x)) {
        return;
    }
    if (e->packed) {
        api_answer_text(x, 200, API_PACKED_EDITS);
    } else {
        api_answer_json(x, 200);
    }
}

/* Returns true if nobody reads the net changes of an edit: the answer does not have them, the edit
 * is too large for an event, and no column, material or content was exchanged. */
static bool has_no_reader(const api_exchange *x, const he_delta *delta)
{
    return x->prefer.minimal && delta->count > API_MAX_EVENT_ROWS && delta->object_count == 0;
}

/* Runs the operations on x->write.content. Returns true if the result is to be committed. */
static bool edit(api_exchange *x, edits *e)
{
    he_mesh *mesh = x->write.content;
    const he_delta *delta = x->write.delta;
    he_error err = {0};
    uint64_t ids = issued(mesh);
    api_out_array_begin(&e->out);
    if (!run_ops(x, e, mesh, delta)) {
        return false;
    }
    api_out_array_end(&e->out);
    if (e->results.failed) {
        return api_fail_memory(x);
    }
    /* Finding the changes takes time proportional to the rows of the delta, which were charged
     * already. */
    e->paid = UINT64_MAX;
    he_progress_span(&x->progress, CHANGES_SHARE);
    e->effect = issued(mesh) != ids;
    if (e->effect && has_no_reader(x, delta)) {
        st_write_unread(&x->write);
    } else if (st_write_changes(&x->write, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    /* An edit that changes nothing makes no revision, unless it has used up ids, which its answer
     * may name. */
    e->effect = e->effect || !he_changes_none(&x->write.changes);
    return write_answer(x, e) && e->effect && !e->dry_run;
}

/* --- limiting the work of a list --- */

/* Charges work that was not known when the operation was charged, for example because edge flips
 * cause further flips. An operation calls this function once every HE_PROGRESS_STRIDE elements;
 * the calls that its charge includes are free, and each later call is charged here. */
static bool tell_and_charge(void *context, const char *phase, double done)
{
    edits *e = context;
    if (e->growing != NULL && e->growing->count - e->seen >= HE_PROGRESS_STRIDE) {
        /* Many rows caused this report, and is_affordable charges them. */
        e->seen = e->growing->count;
    } else if (e->paid > 0) {
        e->paid--;
    } else {
        e->work += e->look;
        e->exceeded = e->exceeded || e->work > e->most_work;
    }
    if (e->growing != NULL) {
        e->overfull = e->growing->count > API_MAX_EDITS_ROWS;
        if (!is_affordable(e, e->growing) || e->overfull) {
            return false;
        }
    }
    return !e->exceeded && (e->told.tell == NULL || e->told.tell(e->told.context, phase, done));
}

/* Limits the work to what may be done on this thread, until unlimit_work is called. */
static void limit_work(api_exchange *x, edits *e)
{
    e->most_work = e->unlimited                 ? UINT64_MAX
                   : x->phase == API_PHASE_BODY ? API_WORKER_EDITS
                                                : API_POOL_EDITS;
    e->most_rows = x->write.claimed ? SIZE_MAX : API_LOCKED_ROWS;
    e->paid = PHASES;
    e->told = x->progress;
    x->progress.tell = tell_and_charge;
    x->progress.context = e;
}

static void unlimit_work(api_exchange *x, const edits *e)
{
    x->progress.tell = e->told.tell;
    x->progress.context = e->told.context;
    x->progress.cancelled = x->progress.cancelled && !e->exceeded && !e->crowded && !e->overfull;
}

/* Resets the state of a list that was rolled back, so that it can start again. */
static void start_over(edits *e)
{
    e->looked_at = e->steps = e->work = 0;
    e->exceeded = e->crowded = e->overfull = false;
    e->hubs = (api_hubs){.slots = {{0}}};
    memset(e->ran, 0, sizeof e->ran);
    e->at = API_OPERATIONS;
    api_result_names_unbind(&e->names);
    begin_results(e);
}

static void run(api_exchange *x);
static void run_claimed(api_exchange *x);
static void go_on_elsewhere(api_exchange *x, edits *e);

/* --- running lists of operations --- */

/* Counts the operations for the metrics. If an operation was refused, only that operation is
 * counted, because the others were rolled back. */
static void count_operations(const api_exchange *x, const edits *e)
{
    api_metrics *metrics = x->service->metrics;
    const bool refused = x->problem.code != HE_OK;
    const api_edit_result result = refused      ? API_EDIT_REFUSED
                                   : e->dry_run ? API_EDIT_REHEARSED
                                                : API_EDIT_APPLIED;
    if (refused && e->at < API_OPERATIONS) {
        api_count_edits(metrics, e->at, result, 1);
        return;
    }
    for (size_t number = 0; number < API_MOST_OPERATIONS; number++) {
        if (e->ran[number] > 0) {
            api_count_edits(metrics, number, result, e->ran[number]);
        }
    }
}

/* Refuses the request early if its first operation is sure to fail. This can be known, because
 * nothing changes the mesh before the first operation. */
static bool foresee(api_exchange *x, edits *e)
{
    const api_in *in = e->is_list ? &e->op.in : &x->root;
    he_error err = {0};
    api_call call;
    if ((e->is_list && !api_item_read(&x->ops, 0, &e->list, &e->op)) ||
        !decode(e, in, NULL, &call)) {
        return false;
    }
    if (he_op_foresee(call.op, st_write_claimed(&x->write), call.args, &err) == HE_OK) {
        return true;
    }
    api_fail_core(x, &err);
    if (e->is_list) {
        api_in_point(in);
    }
    e->at = he_op_number(call.op);
    count_operations(x, e);
    return false;
}

/* Claims the mesh (reserves it for an edit that works on a copy). This is done before the client
 * gets 202, so that a conflict is reported at once. */
static bool claim(api_exchange *x, edits *e)
{
    return api_write_claim(x, e->has_expected ? &e->expected : NULL) && foresee(x, e);
}

/* If `good` is true, commits the write and answers. Otherwise rolls it back, and starts the list
 * again elsewhere if it exceeded the limits of limit_work. */
static void end_edit(api_exchange *x, edits *e, bool good)
{
    if (good) {
        (void)api_write_commit(x, e->ops);
    } else if (!x->write.claimed) {
        st_write_abort(&x->write);
    } else {
        st_write_discard_copy(&x->write);
    }
    api_named_meshes_release(&e->named);
    if ((e->exceeded || e->crowded) && !good) {
        go_on_elsewhere(x, e);
        return;
    }
    count_operations(x, e);
    if (x->problem.code == HE_OK) {
        answer(x, e);
    }
}

static void run_claimed(api_exchange *x)
{
    edits *e = x->state;
    he_error err = {0};
    /* The work of a job, or of a client that prefers to wait, cannot move to another thread, so it
     * is not limited. */
    e->unlimited = e->unlimited || x->phase == API_PHASE_JOB || x->prefer.wait >= 0;
    he_progress_span(&x->progress, COPY_SHARE);
    if (!api_named_meshes_take(x, &e->named)) {
        return;
    }
    if (st_write_copy(&x->write, &x->progress, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    st_write_from(&x->write, e->named.shown, e->named.count);
    limit_work(x, e);
    bool good = edit(x, e);
    unlimit_work(x, e);
    he_mesh_set_progress(x->write.content, NULL);
    end_edit(x, e, good);
}

/* Starts a list again that was rolled back. If it changes too many rows, it claims the mesh and
 * works on a copy; else it moves from a worker thread to the job pool, or from there to a job. */
static void go_on_elsewhere(api_exchange *x, edits *e)
{
    bool on_worker = x->phase == API_PHASE_BODY;
    bool crowded = e->crowded;
    /* Drops the problem of the attempt that was rolled back. */
    x->problem = (api_problem){.code = HE_OK};
    start_over(e);
    if (crowded) {
        if (claim(x, e)) {
            api_run_long(x, run_claimed, true, 0);
        }
    } else if (on_worker) {
        api_run_long(x, run, true, 0);
    } else if (x->write.claimed || claim(x, e)) {
        e->unlimited = true;
        api_run_long(x, run_claimed, true, 2 * API_PATIENCE);
    }
}

static void run(api_exchange *x)
{
    edits *e = x->state;
    if (!api_named_meshes_take(x, &e->named) ||
        !api_write_begin(x, e->has_expected ? &e->expected : NULL)) {
        return;
    }
    st_write_from(&x->write, e->named.shown, e->named.count);
    limit_work(x, e);
    he_mesh_set_progress(x->write.content, &x->progress);
    bool good = edit(x, e);
    he_mesh_set_progress(x->write.content, NULL);
    unlimit_work(x, e);
    end_edit(x, e, good);
}

/* Estimates the cost of a list of operations. A list of many operations, or one that visits the
 * whole mesh or a huge element, belongs on a thread that may block. A long list, or work on a very
 * large mesh, claims the mesh (store/write.h) and works on a copy, so that the mesh is not locked
 * meanwhile. The handler chooses the thread, because the mesh must be claimed before the client is
 * answered. */
bool api_edits_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    edits *e = x->state;
    (void)out;
    double grown = e->growth * (double)(e->elements_beside + api_elements_of(mesh));
    uint64_t elements = grown < MANY ? (uint64_t)grown : (uint64_t)MANY;
    e->costly = e->runs > API_COSTLY_EDITS || e->passes * elements > API_WORKER_EDITS ||
                api_named_meshes_reach_back(&e->named) ||
                (elements > API_COSTLY_ELEMENTS &&
                 (e->whole > 0 || api_edit_cost_exceeds(&e->cost, mesh, API_COSTLY_ELEMENTS)));
    e->seconds = (double)e->passes * (double)elements / API_EDIT_PER_SECOND;
    e->claims = e->count > API_CLAIM_EDITS || e->runs > API_CLAIM_RUNS ||
                (e->whole > 0 && (elements > API_CLAIM_ELEMENTS || e->seconds > API_PATIENCE));
    return true;
}

void api_edits_post(api_exchange *x)
{
    edits *e = x->state;
    if (!e->claims) {
        api_run_long(x, run, e->costly, 0);
    } else if (claim(x, e)) {
        api_run_long(x, run_claimed, true, e->seconds);
    }
}

static void load_others(api_exchange *x)
{
    edits *e = x->state;
    if (api_named_meshes_load(x, &e->named)) {
        e->elements_beside = api_named_meshes_elements(&e->named);
        api_read(x);
    }
}

bool api_edits_decode(api_exchange *x)
{
    edits *e = st_spares_take(&x->service->edits, sizeof *e);
    if (e == NULL) {
        return api_fail_memory(x);
    }
    memset(e, 0, offsetof(edits, named));
    e->home = &x->service->edits;
    x->state = e;
    x->free_state = free_edits;
    e->growth = 1;
    e->at = API_OPERATIONS;
    api_result_names_init(&e->names, st_secret(x->store));
    api_named_meshes_init(&e->named, x);
    e->packed = strcmp(x->media_out, API_PACKED_EDITS) == 0;
    begin_results(e);
    if (!read_request(x, e)) {
        return false;
    }
    if (e->named.cold > 0) {
        x->deferred = load_others;
        return false;
    }
    e->elements_beside = api_named_meshes_elements(&e->named);
    return true;
}
