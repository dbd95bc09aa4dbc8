/* undo.c - undo and redo: POST .../undo and .../redo. */
#include "api/request/handlers.h"

#include "api/event/change_json.h"

/* The state of a request between the decoding of its body and its answer. */
typedef struct steps {
    st_action which;
    api_in expected, to;
    bool has_expected;
    uint64_t revision; /* the value of "to_revision"; 0 if it is not given: then `count` is used */
    uint32_t count;
    /* Positions in the answer of numbers that are filled in after the commit. */
    size_t revision_at, undo_at, redo_at;
} steps;

static const char *const members[] = {"expected_revision", "steps", "to_revision", NULL};

static bool read_request(api_exchange *x, steps *s)
{
    api_in count;
    uint64_t number = 1;
    s->count = 1;
    if (!x->has_root) {
        return true;
    }
    if (!api_in_only(&x->root, members)) {
        return false;
    }
    s->has_expected = api_in_find(&x->root, "expected_revision", &s->expected);
    bool has_count = api_in_find(&x->root, "steps", &count);
    if (has_count && !api_in_u64(&count, 1, UINT32_MAX, &number)) {
        return false;
    }
    s->count = (uint32_t)number;
    if (!api_in_find(&x->root, "to_revision", &s->to)) {
        return true;
    }
    return api_in_u64(&s->to, 1, (uint64_t)1 << 53, &s->revision) &&
           (!has_count || api_in_fail(&s->to, API_CONFLICTING_MEMBERS,
                                      "give either \"steps\" or \"to_revision\", not both"));
}

static const char *name_of(const steps *s)
{
    return s->which == ST_UNDO ? "undo" : "redo";
}

static void refuse(api_exchange *x, const steps *s, st_status status)
{
    unsigned long long to = s->revision, present = x->info.revision;
    uint32_t left = s->which == ST_UNDO ? x->info.undo : x->info.redo;
    if (status == ST_NOTHING) {
        api_fail(
            x, s->which == ST_UNDO ? API_NOTHING_TO_UNDO : API_NOTHING_TO_REDO,
            left == 0
                ? "no edit is left to %s at revision %llu of the mesh"
                : "the request asks to %s more edits than are left at revision %llu of the mesh",
            name_of(s), present);
    } else if (status == ST_AHEAD) {
        api_in_fail(&s->to, API_NO_SUCH_REVISION,
                    "the mesh is at revision %llu and has no revision %llu yet", present, to);
        x->problem.status = 422;
    } else if (status == ST_GONE) {
        api_in_fail(&s->to, API_REVISION_GONE, "the history does not reach back to revision %llu",
                    to);
    } else if (status == ST_ELSEWHERE) {
        api_in_fail(&s->to, API_UNREACHABLE_REVISION,
                    "%s does not lead to revision %llu, however many steps are taken", name_of(s),
                    to);
    } else {
        api_fail_store(x, status);
    }
}

/* Writes the whole answer, with the changes of all steps together, before the commit, so that no
 * failure can follow the commit. Only the numbers that the commit determines are filled in after
 * it. */
static bool write_answer(api_exchange *x, steps *s)
{
    api_out *out = &x->out;
    api_out_object_begin(out);
    api_out_key(out, "revision");
    s->revision_at = api_out_later(out);
    api_out_key(out, "results");
    api_out_array_begin(out);
    api_out_array_end(out);
    api_write_changes(out, &x->write.changes);
    api_out_key(out, "undo");
    s->undo_at = api_out_later(out);
    api_out_key(out, "redo");
    s->redo_at = api_out_later(out);
    api_out_object_end(out);
    return !x->text.failed || api_fail_memory(x);
}

/* Undoes or redoes `count` edits and writes the answer. Returns false with the problem filled. */
static bool take(api_exchange *x, steps *s, uint32_t count)
{
    st_status status = count == 0 ? ST_OK : st_write_step(&x->write, s->which, count);
    if (status != ST_OK) {
        refuse(x, s, status);
        return false;
    }
    return write_answer(x, s);
}

void api_undo_post(api_exchange *x)
{
    steps *s = x->state;
    if (!api_write_begin(x, s->has_expected ? &s->expected : NULL)) {
        return;
    }
    uint32_t count = s->count;
    uint64_t bytes;
    st_status status = st_steps_to(x->mesh, s->which, s->revision, &count, &bytes);
    if (status != ST_OK) {
        refuse(x, s, status);
    }
    bool good = status == ST_OK && take(x, s, count);
    const size_t number = s->which == ST_UNDO ? API_UNDO : API_REDO;
    bool commits = good && count > 0;
    if (!commits) {
        st_write_abort(&x->write);
    }
    if (!good || (commits && !api_write_commit(x, NULL))) {
        api_count_edits(x->service->metrics, number, API_EDIT_REFUSED, 1);
        return;
    }
    api_count_edits(x->service->metrics, number, API_EDIT_APPLIED, count);
    api_out_fill(&x->text, s->redo_at, x->info.redo);
    api_out_fill(&x->text, s->undo_at, x->info.undo);
    api_out_fill(&x->text, s->revision_at, x->info.revision);
    api_answer_etag(x, "edits");
    if (!api_answer_minimal(x)) {
        api_answer_json(x, 200);
    }
}

/* Estimates the cost of undoing or redoing. Deltas of many rows belong on a thread that may
 * block. */
bool api_undo_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    const steps *s = x->state;
    uint32_t count = s->count;
    uint64_t bytes = 0;
    (void)mesh;
    if (st_steps_to(x->mesh, s->which, s->revision, &count, &bytes) == ST_OK &&
        bytes > API_COSTLY_STEPS) {
        out->elements = UINT64_MAX;
    }
    return true;
}

static bool decode(api_exchange *x, st_action which)
{
    steps *s = api_arena_array(&x->arena, 1, sizeof *s);
    if (s == NULL) {
        return api_fail_memory(x);
    }
    *s = (steps){.which = which};
    x->state = s;
    return read_request(x, s);
}

bool api_undo_decode(api_exchange *x)
{
    return decode(x, ST_UNDO);
}

bool api_redo_decode(api_exchange *x)
{
    return decode(x, ST_REDO);
}
