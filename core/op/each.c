/* each.c - runs an operation once for each item of a list, and collects the results of the runs in
 * columns (he_results). */
#include "op/rows.h"

#include "mesh/write.h"

#include <math.h>
#include <string.h>

/* Sets the argument of one run: the value of a column at index `i`. */
static void take(he_arg *one, const he_param *param, const he_arg *column, size_t i)
{
    switch (param->type) {
    case HE_PARAM_ELEMENT:
        one->id = column->ids[i];
        break;
    case HE_PARAM_POINT:
        one->points = &column->points[i];
        break;
    case HE_PARAM_NUMBER:
        one->number = column->numbers[i];
        break;
    case HE_PARAM_FLAG:
        one->flag = column->numbers[i] > 0;
        break;
    case HE_PARAM_CHOICE:
        one->choice = (int)column->numbers[i];
        break;
    case HE_PARAM_CYCLE: {
        const uint32_t from = i == 0 ? 0 : column->ends[i - 1];
        one->ids = column->ids + from;
        one->count = column->ends[i] - from;
        break;
    }
    case HE_PARAM_ELEMENTS:
    case HE_PARAM_POINTS:
    case HE_PARAM_MATRIX:
    case HE_PARAM_POLYGON:
    case HE_PARAM_TEXT:
    case HE_PARAM_COLOR:
    case HE_PARAM_MESH:
        break;
    }
}

static he_status reserve(const he_op *op, he_results *out, size_t runs, he_error *err)
{
    he_status status = HE_OK;
    for (size_t k = 0; k < he_op_results(op) && status == HE_OK; k++) {
        switch (op->results[k].type) {
        case HE_RESULT_ELEMENTS:
            status = he_ids_reserve(&out->ends[k], runs, err);
            break;
        case HE_RESULT_NUMBER:
            out->numbers[k] = he_mem_array(NULL, runs, sizeof *out->numbers[k]);
            if (out->numbers[k] == NULL) {
                status = he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu results", runs);
            }
            break;
        case HE_RESULT_ELEMENT:
        case HE_RESULT_CHOICE:
        case HE_RESULT_MAP:
        case HE_RESULT_COUNTS:
            status = he_ids_reserve(&out->list[k], runs, err);
            break;
        }
    }
    return status;
}

/* Appends the results of one run to the columns, for which `reserve` has reserved memory, except
 * for the ids of a list. */
static he_status keep(const he_op *op, he_results *out, const he_results *run, he_error *err)
{
    for (size_t k = 0; k < HE_OP_RESULTS && op->results[k].name != NULL; k++) {
        he_ids *list = &out->list[k];
        const he_ids *more = &run->list[k];
        switch (op->results[k].type) {
        case HE_RESULT_ELEMENTS:
            if (more->count > list->capacity - list->count) {
                he_status status = he_ids_reserve(list, more->count, err);
                if (status != HE_OK) {
                    return status;
                }
            }
            for (size_t i = 0; i < more->count; i++) {
                list->ids[list->count++] = more->ids[i];
            }
            out->ends[k].ids[out->ends[k].count++] = (uint32_t)list->count;
            break;
        case HE_RESULT_NUMBER:
            out->numbers[k][out->runs] = run->present[k] ? run->number[k] : (double)NAN;
            break;
        case HE_RESULT_ELEMENT:
        case HE_RESULT_CHOICE:
        case HE_RESULT_MAP:
        case HE_RESULT_COUNTS:
            list->ids[list->count++] = run->id[k];
            break;
        }
    }
    return HE_OK;
}

/* Reports that run `i` is reached: once for HE_PROGRESS_STRIDE runs, and also when the delta has
 * grown by as many records since `*told`, because the runs at a large face may record much more
 * than others. So the watch can stop them in time. */
static he_status report(const he_mesh *mesh, size_t i, size_t runs, size_t *told, he_error *err)
{
    const size_t records = mesh->delta != NULL ? mesh->delta->count : 0;
    if (records - *told < HE_PROGRESS_STRIDE) {
        return he_progress_at(mesh->progress, i, runs, err);
    }
    *told = records;
    return he_progress_step(mesh->progress, i, runs, err);
}

/* Prepares the results for the next run; the memory of their lists is used again. */
static void renew(const he_op *op, he_results *run)
{
    for (size_t k = 0; k < HE_OP_RESULTS && op->results[k].name != NULL; k++) {
        run->present[k] = true;
        run->id[k] = HE_NONE;
        run->list[k].count = 0;
        run->number[k] = 0;
    }
}

static he_status run_all(const he_op *op, he_mesh *mesh, const he_arg *args, he_results *out,
                         he_error *err)
{
    const size_t runs = he_op_runs(op, args), params = he_op_params(op);
    he_arg one[HE_OP_PARAMS];
    size_t columns[HE_OP_PARAMS], column_count = 0;
    he_results run = {.each = false};
    memcpy(one, args, sizeof one);
    for (size_t i = 0; i < params; i++) {
        if (args[i].list && (he_op_is_column(&op->params[i]) || args[i].ends != NULL)) {
            columns[column_count++] = i;
            one[i].list = false;
            one[i].count = 1;
            one[i].ends = NULL;
        }
    }
    size_t told = mesh->delta != NULL ? mesh->delta->count : 0;
    he_status status = reserve(op, out, runs, err);
    while (status == HE_OK && out->runs < runs) {
        for (size_t c = 0; c < column_count; c++) {
            take(&one[columns[c]], &op->params[columns[c]], &args[columns[c]], out->runs);
        }
        renew(op, &run);
        status = report(mesh, out->runs, runs, &told, err);
        if (status == HE_OK) {
            status = op->run(mesh, one, &run, err);
        }
        if (status == HE_OK) {
            status = keep(op, out, &run, err);
        }
        out->runs += status == HE_OK;
    }
    he_results_clear(&run);
    return status;
}

he_status he_run_each(const he_op *op, he_mesh *mesh, const he_arg args[HE_OP_PARAMS],
                      he_results *out, he_error *err)
{
    he_bracket bracket;
    out->each = true;
    if (he_op_runs(op, args) == 0) {
        return HE_OK;
    }
    he_status status = he_edit_begin(mesh, &bracket, err);
    if (status == HE_OK) {
        status = he_edit_end(mesh, &bracket, run_all(op, mesh, args, out, err));
    }
    return status;
}
