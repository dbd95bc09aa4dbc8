/* deform.c - POST .../deform: computes what the operation deform would do, and changes nothing. The
 * answer is binary, because a page asks for it many times a second while a handle is dragged. */
#include "api/request/handlers.h"

#include "api/request/mesh_access.h"

#include "api/write/decode_op.h"
#include "api/write/deformer_cache.h"
#include "op/deform_arguments.h"

#include <string.h>

/* The operation of a request. */
typedef struct drag {
    api_arena scratch; /* the lists of `call` */
    api_call call;
    he_deform_sets sets;
    he_deform_goal goal;
    he_deform_motion motion;
    he_vec3 *goals, *positions; /* those of `motion` */
    api_deformer *deformer;
} drag;

static void free_drag(void *state)
{
    drag *d = state;
    api_arena_clear(&d->scratch);
    api_deformer_release(d->deformer);
    he_mem_free(d->goals);
    he_mem_free(d->positions);
    he_mem_free(d);
}

/* Decodes the operation; `mesh` is as in api_op_scope. */
static bool decode(api_exchange *x, drag *d, const he_mesh *mesh)
{
    const api_op_scope scope = {.mesh = mesh};
    api_in name;
    api_arena_empty(&d->scratch);
    return api_decode_op(&x->root, &scope, &d->scratch, &d->call) &&
           (strcmp(d->call.op->name, "deform") == 0 ||
            (api_in_need(&x->root, "op", &name) &&
             api_in_fail(&name, HE_BAD_VALUE, "the operation must be \"deform\" here, not \"%s\"",
                         d->call.op->name)));
}

bool api_deform_decode(api_exchange *x)
{
    drag *d = he_mem_zero(1, sizeof *d);
    if (d == NULL) {
        return api_fail_memory(x);
    }
    x->state = d;
    x->free_state = free_drag;
    return decode(x, d, NULL);
}

bool api_deform_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    drag *d = x->state;
    he_deform_arguments(d->call.args, &d->sets, &d->goal, &d->motion.steps);
    out->elements = api_elements_of(mesh);
    out->seconds = d->sets.method == HE_DEFORM_BIHARMONIC
                       ? (double)out->elements / API_BIHARMONIC_PER_SECOND
                       : (double)out->elements / API_ARAP_PER_SECOND +
                             d->motion.steps * (double)out->elements / API_BEND_PER_SECOND;
    return true;
}

/* Computes the positions. */
static he_status solve(api_exchange *x, drag *d, uint32_t *count, he_error *err)
{
    he_status status = he_deform_check(x->content, &d->sets, err);
    if (status != HE_OK) {
        return status;
    }
    d->goals = he_mem_array(NULL, d->sets.handle_count, sizeof *d->goals);
    if (d->goals == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu points", d->sets.handle_count);
    }
    d->motion.goals = d->goals;
    status = he_deform_goals(x->content, &d->sets, &d->goal, d->goals, err);
    if (status == HE_OK) {
        status = api_deformer_take(x, &d->sets, &d->deformer, err);
    }
    if (status != HE_OK) {
        return status;
    }
    (void)he_deformer_vertices(api_deformer_get(d->deformer), count);
    d->positions = he_mem_array(NULL, (size_t)*count + 1, sizeof *d->positions);
    d->motion.positions = d->positions;
    return d->positions == NULL
               ? he_fail_plain(err, HE_NO_MEMORY, "no memory for %u points", *count)
               : he_deformer_solve(api_deformer_get(d->deformer), &d->motion, &x->progress, err);
}

/* --- the answer --- */

/* Writes a number in little-endian; on a little-endian machine compilers reduce this to a copy. */
static char *write_double(char *to, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (unsigned k = 0; k < 8; k++) {
        to[k] = (char)(unsigned char)(bits >> 8 * k);
    }
    return to + 8;
}

static char *write_points(char *to, const he_vec3 *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to = write_double(to, points[i].x);
        to = write_double(to, points[i].y);
        to = write_double(to, points[i].z);
    }
    return to;
}

static char *write_ids(char *to, const uint32_t *ids, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        for (unsigned k = 0; k < 4; k++) {
            *to++ = (char)(unsigned char)(ids[i] >> 8 * k);
        }
    }
    return to;
}

/* Answers with the positions of the handles and of the free vertices, and then their ids. */
static void answer(api_exchange *x, const drag *d, uint32_t count)
{
    enum { BYTES = 3 * 8 + 4 };
    const size_t handles = d->sets.handle_count, all = handles + count;
    const uint32_t *free = he_deformer_vertices(api_deformer_get(d->deformer), &count);
    char *to = api_text_room(&x->text, all * BYTES);
    if (to == NULL) {
        api_fail_memory(x);
        return;
    }
    to = write_points(to, d->goals, handles);
    to = write_points(to, d->positions, count);
    to = write_ids(to, d->sets.handles, handles);
    (void)write_ids(to, free, count);
    x->text.length += all * BYTES;
    x->answer.is_dense = true;
    api_answer_text(x, 200, "application/octet-stream");
}

void api_deform_post(api_exchange *x)
{
    drag *d = x->state;
    he_error err = {0};
    uint32_t count = 0;
    if (!decode(x, d, x->content)) {
        return;
    }
    he_deform_arguments(d->call.args, &d->sets, &d->goal, &d->motion.steps);
    if (solve(x, d, &count, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    answer(x, d, count);
}
