#include "op/op.h"

#include "op/rows.h"

#include <assert.h>
#include <math.h>
#include <string.h>

size_t he_op_count(void)
{
    size_t count = 0;
    while (he_table_row(count) != NULL) {
        count++;
    }
    return count;
}

const he_op *he_op_at(size_t i)
{
    const he_op *op = he_table_row(i);
    assert(op != NULL);
    return op;
}

size_t he_op_number(const he_op *op)
{
    return he_table_number(op);
}

const he_op *he_op_find(const char *name, size_t length)
{
    const he_op *op;
    for (size_t i = 0; (op = he_table_row(i)) != NULL; i++) {
        if (strlen(op->name) == length && memcmp(op->name, name, length) == 0) {
            return op;
        }
    }
    return NULL;
}

size_t he_op_params(const he_op *op)
{
    size_t count = 0;
    while (count < HE_OP_PARAMS && op->params[count].name != NULL) {
        count++;
    }
    return count;
}

size_t he_op_results(const he_op *op)
{
    size_t count = 0;
    while (count < HE_OP_RESULTS && op->results[count].name != NULL) {
        count++;
    }
    return count;
}

const he_param *he_op_selector(const he_op *op)
{
    for (size_t i = 0; i < he_op_params(op); i++) {
        if (op->params[i].flags & HE_SELECTS) {
            return &op->params[i];
        }
    }
    return NULL;
}

/* Returns whether the value of the operation's selector is one of `choices`, which are bits. */
static bool is_selected(const he_op *op, const he_arg *args, unsigned choices)
{
    const he_param *selector = he_op_selector(op);
    return selector != NULL && (choices & HE_WITH(args[selector - op->params].choice)) != 0;
}

bool he_op_takes(const he_op *op, const he_arg *args, size_t i)
{
    return op->params[i].with == 0 || is_selected(op, args, op->params[i].with);
}

bool he_op_needs(const he_op *op, const he_arg *args, size_t i)
{
    return (op->params[i].flags & HE_REQUIRED) != 0 || is_selected(op, args, op->params[i].needed);
}

const he_param *he_op_each(const he_op *op, const he_arg args[HE_OP_PARAMS])
{
    for (size_t i = 0; i < HE_OP_PARAMS && op->params[i].name != NULL; i++) {
        const he_param *param = &op->params[i];
        if (param->each != NULL && args[i].list &&
            (param->type != HE_PARAM_CYCLE || args[i].ends != NULL)) {
            return param;
        }
    }
    return NULL;
}

size_t he_op_runs(const he_op *op, const he_arg args[HE_OP_PARAMS])
{
    const he_param *each = he_op_each(op, args);
    const he_arg *arg = each == NULL ? NULL : &args[each - op->params];
    return arg == NULL ? 1 : arg->ends != NULL ? arg->rows : arg->count;
}

bool he_op_is_column(const he_param *param)
{
    switch (param->type) {
    case HE_PARAM_ELEMENT:
    case HE_PARAM_POINT:
    case HE_PARAM_NUMBER:
    case HE_PARAM_FLAG:
        return true;
    case HE_PARAM_CHOICE:
        return (param->flags & HE_SELECTS) == 0;
    case HE_PARAM_ELEMENTS:
    case HE_PARAM_POINTS:
    case HE_PARAM_MATRIX:
    case HE_PARAM_POLYGON:
    case HE_PARAM_CYCLE:
    case HE_PARAM_TEXT:
    case HE_PARAM_COLOR:
    case HE_PARAM_MESH:
        break;
    }
    return false;
}

bool he_op_is_whole(const he_op *op, const he_arg args[HE_OP_PARAMS])
{
    bool whole = op->size == HE_OP_WHOLE;
    for (size_t i = 0; i < he_op_params(op) && !whole; i++) {
        whole = args[i].given && (op->params[i].flags & HE_COSTS_MESH) != 0;
    }
    return whole;
}

double he_op_growth(const he_op *op, const he_mesh *mesh, const he_arg args[HE_OP_PARAMS])
{
    return op->growth == NULL ? 1 : op->growth(mesh, args);
}

unsigned he_op_pace(const he_op *op, const he_arg args[HE_OP_PARAMS])
{
    return (op->pace > 0 ? op->pace : 1) * (op->times == NULL ? 1 : op->times(args));
}

he_status he_op_foresee(const he_op *op, const he_mesh *mesh, const he_arg args[HE_OP_PARAMS],
                        he_error *err)
{
    return op->foresee == NULL ? HE_OK : op->foresee(mesh, args, err);
}

bool he_op_declares(const he_op *op, he_status status)
{
    if (status == HE_OK || status == HE_NO_MEMORY || status == HE_IDS_EXHAUSTED ||
        status == HE_CANCELLED) {
        return true;
    }
    for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
        if (op->refusals[i] == status) {
            return true;
        }
    }
    return false;
}

void he_op_defaults(const he_op *op, he_arg args[HE_OP_PARAMS])
{
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        args[i] = (he_arg){.id = HE_NONE};
        switch (param->type) {
        case HE_PARAM_NUMBER:
            args[i].number = param->fallback;
            break;
        case HE_PARAM_FLAG:
            args[i].flag = param->fallback != 0;
            break;
        case HE_PARAM_CHOICE:
            args[i].choice = (int)param->fallback;
            break;
        case HE_PARAM_ELEMENT:
        case HE_PARAM_ELEMENTS:
        case HE_PARAM_POINT:
        case HE_PARAM_POINTS:
        case HE_PARAM_MATRIX:
        case HE_PARAM_POLYGON:
        case HE_PARAM_CYCLE:
        case HE_PARAM_TEXT:
        case HE_PARAM_COLOR:
        case HE_PARAM_MESH:
            break;
        }
    }
}

/* Returns true if an argument that was given has passed the checks that are the duty of the decoder
 * of requests. */
static bool is_sound(const he_param *param, const he_arg *arg)
{
    if (arg->list && he_op_is_column(param)) {
        return arg->ids != NULL || arg->points != NULL || arg->numbers != NULL;
    }
    switch (param->type) {
    case HE_PARAM_ELEMENT:
        return arg->id != HE_NONE || (param->flags & HE_NULLABLE);
    case HE_PARAM_ELEMENTS:
        return arg->ids != NULL;
    case HE_PARAM_CYCLE:
        return arg->ids != NULL || arg->count == 0;
    case HE_PARAM_POLYGON:
        return arg->points != NULL || arg->count == 0;
    case HE_PARAM_MESH:
        return arg->mesh != NULL;
    case HE_PARAM_NUMBER:
        if ((param->flags & HE_WHOLE) && arg->number != floor(arg->number)) {
            return false;
        }
        if (param->flags & HE_RANGE) {
            return (param->flags & HE_EXCLUSIVE)
                       ? arg->number > param->min && arg->number < param->max
                       : arg->number >= param->min && arg->number <= param->max;
        }
        return isfinite(arg->number);
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        return arg->points != NULL && arg->count > 0;
    case HE_PARAM_TEXT:
        return arg->text != NULL;
    case HE_PARAM_COLOR:
        return arg->count == 3 || (arg->count == 4 && (param->flags & HE_OPACITY));
    case HE_PARAM_FLAG:
    case HE_PARAM_CHOICE:
    case HE_PARAM_MATRIX:
        return true;
    }
    return false;
}

/* Checks the parameters that have the letter of parameter i as their group, and so are
 * alternatives: exactly one must be given if any of them is required, else at most one. */
static bool is_group_sound(const he_op *op, const he_arg *args, size_t i)
{
    size_t given = 0;
    bool required = false;
    for (size_t k = 0; k < he_op_params(op); k++) {
        if (op->params[k].group == op->params[i].group) {
            given += args[k].given;
            required |= he_op_needs(op, args, k);
        }
    }
    return required ? given == 1 : given <= 1;
}

static bool are_sound(const he_op *op, const he_arg *args)
{
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        if (args[i].given ? !is_sound(param, &args[i]) || !he_op_takes(op, args, i)
                          : param->group == 0 && he_op_needs(op, args, i)) {
            return false;
        }
        if (param->group != 0 && !is_group_sound(op, args, i)) {
            return false;
        }
    }
    return true;
}

static bool has_empty_list(const he_op *op, const he_arg *args)
{
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        if (param->type == HE_PARAM_ELEMENTS && args[i].given && args[i].count == 0 &&
            !(param->flags & HE_MAY_BE_EMPTY)) {
            return true;
        }
    }
    return false;
}

void he_results_clear(he_results *results)
{
    for (size_t i = 0; i < HE_OP_RESULTS; i++) {
        he_ids_clear(&results->list[i]);
        he_ids_clear(&results->ends[i]);
        he_mem_free(results->numbers[i]);
    }
    memset(results, 0, sizeof *results);
}

he_status he_op_run(const he_op *op, he_mesh *mesh, const he_arg args[HE_OP_PARAMS],
                    he_results *out, he_error *err)
{
    bool sound = are_sound(op, args);
    assert(sound);
    (void)sound;
    he_results_clear(out);
    for (size_t i = 0; i < he_op_results(op); i++) {
        out->present[i] = true;
        out->id[i] = HE_NONE;
    }
    if (has_empty_list(op, args)) {
        return HE_OK;
    }
    he_status status = he_op_each(op, args) != NULL ? he_run_each(op, mesh, args, out, err)
                                                    : op->run(mesh, args, out, err);
    assert(he_op_declares(op, status));
    if (status != HE_OK) {
        size_t runs = out->runs;
        he_results_clear(out);
        out->runs = runs;
    }
    return status;
}

void he_results_set(he_results *out, size_t slot, uint32_t id)
{
    out->id[slot] = id;
}

void he_results_set_number(he_results *out, size_t slot, double number)
{
    out->number[slot] = number;
}

void he_results_omit(he_results *out, size_t slot)
{
    out->present[slot] = false;
}

he_status he_results_reserve(he_results *out, size_t slot, size_t count, he_error *err)
{
    return he_ids_reserve(&out->list[slot], count, err);
}

void he_results_add(he_results *out, size_t slot, uint32_t id)
{
    he_ids *list = &out->list[slot];
    assert(list->count < list->capacity);
    list->ids[list->count++] = id;
}

void he_results_set_list(he_results *out, size_t slot, he_ids *takes)
{
    he_ids_clear(&out->list[slot]);
    out->list[slot] = *takes;
    *takes = (he_ids){0};
}
