/* geometry.c - GET .../geometry: the arrays from which a renderer draws a mesh, or the changes in
 * them. geometry_rows.h describes the arrays.
 *
 * A slot is the row of a triangle in the array of triangles. The slots of a mesh are computed when
 * they are first needed and are then kept with the mesh; a later request brings them up to date. A
 * few changed rows are written while the mesh is locked for reading; many or all rows are written
 * from a snapshot. The slots of an earlier revision are made for one answer. */
#include "api/request/handlers.h"

#include "api/read/geometry_rows.h"
#include "api/request/mesh_access.h"
#include "geometry/long_faces_keep.h"
#include "system/random.h"

#include <inttypes.h>
#include <stdio.h>

typedef struct geometry {
    api_exchange *x;
    api_rows rows;
} geometry;

/* The result of the attempt to answer with the slots that are kept with the mesh. */
typedef enum geometry_step {
    TAKEN,   /* the rows to send were chosen (`rows` of geometry) */
    MISSING, /* no slots are kept */
    LATER,   /* the attempt takes too long for a worker thread */
    ANSWERED /* the request was answered or refused */
} geometry_step;

static void free_geometry(void *stream)
{
    geometry *g = stream;
    api_rows_clear(&g->rows);
    he_mem_free(g);
}

static void free_slots(void *value)
{
    he_draw_slots_free(value);
}

static bool is_working(const api_exchange *x)
{
    return x->phase != API_PHASE_BODY;
}

/* --- using and making slots --- */

/* Brings the slots up to date with the revision in x->info. Returns HE_LIMIT if that takes too long
 * for a worker thread. Returns HE_UNSUPPORTED if the slots must be made anew, because the history
 * does not reach back or because an update would take about as long. */
static he_status bring_forward(const api_exchange *x, he_draw_slots *slots, const he_mesh *mesh,
                               he_error *err)
{
    uint64_t most = API_COSTLY_ELEMENTS;
    most += is_working(x) ? ((uint64_t)slots->vertices + slots->count) / 4 : 0;
    he_touched touched = {0};
    uint64_t records = 0;
    he_status status = HE_OK;
    for (uint64_t r = slots->revision + 1; r <= x->info.revision && status == HE_OK; r++) {
        const he_delta *delta = st_revision_delta(x->mesh, r);
        records += delta == NULL ? 0 : delta->count + 1;
        if (delta == NULL) {
            status = he_fail_plain(err, HE_UNSUPPORTED,
                                   "the history does not reach back to the revision for which the "
                                   "server keeps the arrays");
        } else if (records > most) {
            status = he_fail_plain(err, HE_LIMIT,
                                   "too many changes were made since the revision for which the "
                                   "server keeps the arrays");
        } else {
            status = he_touched_add(&touched, mesh, delta, err);
        }
    }
    if (status == HE_OK && slots->revision != x->info.revision) {
        status = he_draw_slots_advance(slots, mesh, &touched, x->info.revision, most, err);
    }
    he_touched_clear(&touched);
    return status == HE_LIMIT && is_working(x) ? HE_UNSUPPORTED : status;
}

enum { REPRESENTATION = 64 };

/* The layout in answers with an earlier revision. Those of meshes are odd, so a request for the
 * changes since then is answered with all rows. */
enum { EARLIER = 2 };

static void name_representation(const he_draw_slots *slots, uint64_t base, char out[REPRESENTATION])
{
    int used = snprintf(out, REPRESENTATION, "geometry-%" PRIx64, slots->layout);
    if (base != 0) {
        snprintf(out + used, REPRESENTATION - (size_t)used, "-%" PRIu64, base);
    }
}

static bool is_not_modified(api_exchange *x, const he_draw_slots *slots, uint64_t base)
{
    char representation[REPRESENTATION];
    name_representation(slots, base, representation);
    return api_not_modified(x, representation);
}

static geometry_step fail(api_exchange *x, const he_error *err)
{
    api_fail_core(x, err);
    return ANSWERED;
}

static geometry_step take_all(geometry *g, const he_mesh *mesh, const he_draw_slots *slots)
{
    he_error err = {0};
    if (is_not_modified(g->x, slots, 0)) {
        return ANSWERED;
    }
    if (api_is_large(g->x, mesh)) {
        return LATER;
    }
    return api_rows_take_all(&g->rows, slots, &err) == HE_OK ? TAKEN : fail(g->x, &err);
}

/* Chooses the rows to send (`rows` of geometry) from slots that are up to date with the present
 * revision. */
static geometry_step take(geometry *g, const he_mesh *mesh, const he_draw_slots *slots)
{
    api_exchange *x = g->x;
    uint64_t since = api_param_u64(x, "since", 0), layout = api_param_u64(x, "layout", 0);
    he_error err = {0};
    if (since == 0 || layout != slots->layout) {
        return take_all(g, mesh, slots);
    }
    if (since > slots->revision) {
        api_fail(x, API_BAD_PARAMETER, "`since` is %" PRIu64 ", the mesh is at revision %" PRIu64,
                 since, slots->revision);
        return ANSWERED;
    }
    uint64_t most = is_working(x) ? UINT64_MAX : API_COSTLY_ELEMENTS;
    he_status status = api_rows_take_changes(&g->rows, slots, since, most, &err);
    if (status == HE_UNSUPPORTED) {
        return take_all(g, mesh, slots);
    }
    if (status == HE_LIMIT) {
        return LATER;
    }
    if (status != HE_OK) {
        return fail(x, &err);
    }
    return is_not_modified(x, slots, since) ? ANSWERED : TAKEN;
}

/* Chooses the rows to send (`rows` of geometry) from the slots that are kept with the mesh, if
 * possible. The caller has locked the mesh for reading. Slots that cannot be brought up to date are
 * dropped. */
static geometry_step take_kept(geometry *g, const he_mesh *mesh)
{
    api_exchange *x = g->x;
    he_error err = {0};
    geometry_step outcome = MISSING;
    st_derived *kept = st_derived_begin(x->mesh, ST_DERIVED_SLOTS);
    if (kept->value != NULL) {
        he_status status = bring_forward(x, kept->value, mesh, &err);
        if (status == HE_OK) {
            outcome = take(g, mesh, kept->value);
        } else if (status == HE_LIMIT) {
            outcome = LATER;
        } else if (status == HE_UNSUPPORTED) {
            he_draw_slots_free(kept->value);
            kept->value = NULL;
        } else {
            outcome = fail(x, &err);
        }
    }
    st_derived_end(x->mesh, ST_DERIVED_SLOTS);
    return outcome;
}

/* Keeps new slots with the mesh, and chooses the rows to send: all of them. If another request has
 * made slots meanwhile, its slots are used instead; if its slots are of another revision, the new
 * slots are used but not kept. */
static geometry_step keep_or_take(geometry *g, he_draw_slots *slots)
{
    api_exchange *x = g->x;
    st_derived *kept = st_derived_begin(x->mesh, ST_DERIVED_SLOTS);
    const he_draw_slots *first = kept->value;
    bool fits = first != NULL && first->revision == x->info.revision;
    geometry_step outcome = take_all(g, x->content, fits ? first : slots);
    bool keeps = first == NULL;
    if (keeps) {
        *kept = (st_derived){slots, free_slots};
    }
    st_derived_end(x->mesh, ST_DERIVED_SLOTS);
    if (!keeps) {
        he_draw_slots_free(slots);
    }
    return outcome;
}

/* --- answering the request --- */

static int64_t read_rows(void *stream, char *buffer, size_t size)
{
    geometry *g = stream;
    return (int64_t)api_rows_read(&g->rows, buffer, size);
}

static void answer_stream(api_exchange *x, geometry *g)
{
    he_error err = {0};
    const he_mesh *mesh = x->content;
    if ((g->rows.base == 0 && he_long_faces_keep(mesh, &x->progress, &err) != HE_OK) ||
        api_rows_draw(&g->rows, mesh, UINT64_MAX, &err) != HE_OK) {
        free_geometry(g);
        api_fail_core(x, &err);
        return;
    }
    const api_stream stream = {api_rows_bytes(&g->rows), read_rows, g, free_geometry};
    api_answer_stream(x, 200, "application/octet-stream", &stream);
}

/* Answers with the changed rows, while the mesh is locked for reading. Returns LATER if there are
 * too many rows for that. */
static geometry_step answer_changes(geometry *g, const he_mesh *mesh)
{
    api_exchange *x = g->x;
    he_error err = {0};
    if (api_rows_count(&g->rows) > API_COSTLY_ELEMENTS) {
        return LATER;
    }
    he_status status = api_rows_draw(&g->rows, mesh, API_COSTLY_ELEMENTS, &err);
    if (status != HE_OK) {
        return status == HE_LIMIT ? LATER : fail(x, &err);
    }
    size_t length = (size_t)api_rows_bytes(&g->rows);
    char *bytes = api_text_room(&x->text, length);
    if (bytes == NULL) {
        api_fail_memory(x);
        return ANSWERED;
    }
    for (size_t n; (n = api_rows_read(&g->rows, bytes, length)) > 0; length -= n) {
        bytes += n;
        x->text.length += n;
    }
    api_answer_text(x, 200, "application/octet-stream");
    return ANSWERED;
}

static geometry_step make_slots(geometry *g)
{
    api_exchange *x = g->x;
    he_error err = {0};
    he_draw_slots *slots = NULL;
    /* The number that identifies the layout has 53 bits, so that JSON readers represent it
     * exactly. */
    uint64_t layout = st_random() >> 11 | 1;
    if (he_draw_slots_new(x->content, layout, x->info.revision, &slots, &err) != HE_OK) {
        return fail(x, &err);
    }
    return keep_or_take(g, slots);
}

/* Answers with a few changed rows while the mesh is locked for reading. For more rows it takes a
 * snapshot and chooses the rows to send (`rows` of geometry). */
static geometry_step answer_or_take(geometry *g)
{
    api_exchange *x = g->x;
    geometry_step outcome = take_kept(g, x->content);
    if (outcome == MISSING && api_is_large(x, x->content)) {
        outcome = LATER;
    } else if (outcome == TAKEN && g->rows.base != 0) {
        outcome = answer_changes(g, x->content);
        outcome = outcome == LATER && is_working(x) ? TAKEN : outcome;
    }
    if (outcome == LATER || outcome == ANSWERED) {
        return outcome;
    }
    if (!api_keep_mesh(x)) {
        return ANSWERED;
    }
    return outcome == MISSING ? make_slots(g) : outcome;
}

/* Sets the ETag of the answer if the slots that are kept with the mesh show it, so that a matching
 * If-None-Match is answered 304 before a job is made. */
static bool name_kept(api_exchange *x)
{
    uint64_t since = api_param_u64(x, "since", 0), layout = api_param_u64(x, "layout", 0);
    char *representation = api_arena_array(&x->arena, REPRESENTATION, 1);
    if (representation == NULL) {
        return api_fail_memory(x);
    }
    const he_draw_slots *slots = st_derived_begin(x->mesh, ST_DERIVED_SLOTS)->value;
    if (slots != NULL && slots->revision == x->info.revision && since <= slots->revision) {
        name_representation(slots, layout == slots->layout ? since : 0, representation);
        x->reading.tag = representation;
    }
    st_derived_end(x->mesh, ST_DERIVED_SLOTS);
    return true;
}

bool api_geometry_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)mesh;
    (void)out; /* the cost is not estimated: it is not known before the kept slots are examined */
    if (api_param_text(x, "since") != NULL && api_param_text(x, "revision") != NULL) {
        return api_fail(x, API_BAD_PARAMETER,
                        "\"since\" cannot be given with \"revision\": the arrays of an earlier "
                        "revision are sent as a whole");
    }
    if ((api_param_text(x, "since") == NULL) != (api_param_text(x, "layout") == NULL)) {
        return api_fail(x, API_BAD_PARAMETER, "\"since\" and \"layout\" must be given together");
    }
    return x->snapshot != NULL || !api_wants_job(x, 0) || name_kept(x);
}

/* Answers with all rows of an earlier revision, whose copy the exchange has. */
static void answer_earlier(api_exchange *x, geometry *g)
{
    he_error err = {0};
    he_draw_slots *slots = NULL;
    if (api_not_modified(x, "geometry-earlier")) {
        free_geometry(g);
        return;
    }
    x->keeps = true;
    he_status status = he_draw_slots_new(x->content, EARLIER, x->info.revision, &slots, &err);
    if (status == HE_OK) {
        status = api_rows_take_all(&g->rows, slots, &err);
        he_draw_slots_free(slots);
    }
    if (status == HE_OK) {
        answer_stream(x, g);
    } else {
        free_geometry(g);
        api_fail_core(x, &err);
    }
}

void api_geometry_get(api_exchange *x)
{
    geometry *g = he_mem_zero(1, sizeof *g);
    if (g == NULL) {
        api_fail_memory(x);
        return;
    }
    g->x = x;
    if (x->snapshot != NULL) {
        answer_earlier(x, g);
        return;
    }
    geometry_step outcome = answer_or_take(g);
    if (outcome == TAKEN) {
        answer_stream(x, g);
        return;
    }
    free_geometry(g);
    if (outcome == LATER) {
        api_begin_elsewhere(x);
    }
}
