#include "api/write/decode_op.h"

#include "api/write/decode_ids.h"

#include "api/json/known_names.h"
#include "api/json/material_value.h"
#include "api/limits.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Takes points from an array beside the JSON. */
static bool take_points(const api_numbers *numbers, const api_in *in, he_arg *arg)
{
    static_assert(sizeof(he_vec3) == 3 * sizeof(double), "a point is three doubles");
    if (numbers->type != API_PACKED_F64 || numbers->width != 3 || numbers->count == 0) {
        return api_in_fail(in, API_WRONG_TYPE,
                           "a list of points is an array of type 2 with three numbers in an item, "
                           "and not empty");
    }
    for (size_t i = 0; i < 3 * numbers->count; i++) {
        if (!isfinite(numbers->at.f64[i])) {
            const api_in item = api_in_item(in, i / 3), at = api_in_item(&item, i % 3);
            return api_in_fail(&at, HE_NOT_FINITE, "the number is not finite");
        }
    }
    arg->points = numbers->at.bytes;
    arg->count = numbers->count;
    arg->list = true;
    return true;
}

/* Reads a point or, if `may_be_list` is true, also a list of points. */
static bool decode_points(const api_decoder *d, bool may_be_list, const api_in *in, he_arg *arg)
{
    const api_numbers *numbers = api_in_numbers(in);
    if (numbers != NULL && may_be_list) {
        return take_points(numbers, in, arg);
    }
    if (!api_in_array(in, 1, SIZE_MAX)) {
        return false;
    }
    api_in first;
    api_in_first(in, &first);
    bool list = may_be_list && api_in_is_array(&first);
    size_t count = list ? api_in_count(in) : 1, i = 0;
    he_vec3 *points = api_arena_array(d->arena, count, sizeof *points);
    if (points == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for %zu points", count);
    }
    if (!list) {
        if (!api_in_vec3(in, points)) {
            return false;
        }
    } else {
        api_in child;
        for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
            if (!api_in_vec3(&child, &points[i++])) {
                return false;
            }
        }
    }
    arg->points = points;
    arg->count = count;
    arg->list = list;
    return true;
}

/* Reads a list of points [x, y]. Its length is not checked, because the operation itself refuses a
 * polygon with too few corners. */
static bool decode_polygon(const api_decoder *d, const api_in *in, he_arg *arg)
{
    if (!api_in_array(in, 0, SIZE_MAX)) {
        return false;
    }
    size_t i = 0;
    he_vec3 *points = api_arena_array(d->arena, api_in_count(in), sizeof *points);
    if (points == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for a polygon of %zu corners",
                           api_in_count(in));
    }
    api_in child, number;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        points[i].z = 0;
        if (!api_in_array(&child, 2, 2) || !api_in_first(&child, &number) ||
            !api_in_number(&number, &points[i].x) || !api_in_next(&number) ||
            !api_in_number(&number, &points[i].y)) {
            return false;
        }
        i++;
    }
    arg->points = points;
    arg->count = i;
    return true;
}

static bool decode_matrix(const he_param *param, const api_in *in, he_arg *arg)
{
    static const double last[4] = {0, 0, 0, 1};
    if (!api_in_array(in, 16, 16)) {
        return false;
    }
    size_t i = 0;
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_number(&child, &arg->matrix[i])) {
            return false;
        }
        if (i >= 12 && !(param->flags & HE_PROJECTIVE) &&
            (arg->matrix[i] < last[i - 12] || arg->matrix[i] > last[i - 12])) {
            return api_in_fail(&child, HE_BAD_VALUE, "the last row of the matrix must be 0 0 0 1");
        }
        i++;
    }
    return true;
}

static bool decode_mesh(const api_decoder *d, const api_in *in, he_arg *arg)
{
    const api_meshes *meshes = d->scope->meshes;
    const char *id = NULL;
    uint64_t revision = 0;
    if (api_in_is_number(in) ? !api_in_u64(in, 1, (uint64_t)1 << 53, &revision)
                             : !api_in_string(in, ST_MESH_ID, &id)) {
        return false;
    }
    return meshes == NULL || meshes->find(meshes->context, in, id, revision, &arg->mesh);
}

static bool decode_number(const he_param *param, const api_in *in, double *out)
{
    uint64_t whole = 0;
    if (param->flags & HE_WHOLE) {
        bool read = api_in_u64(in, (uint64_t)param->min, (uint64_t)param->max, &whole);
        *out = (double)whole;
        return read;
    }
    if (param->flags & HE_RANGE) {
        return api_in_number_within(in, param->min, param->max, (param->flags & HE_EXCLUSIVE) != 0,
                                    out);
    }
    return api_in_number(in, out);
}

/* --- columns --- */

static bool decode_flag_or_choice(const he_param *param, const api_in *in, double *out)
{
    bool flag = false;
    int choice = 0;
    const bool read = param->type == HE_PARAM_FLAG ? api_in_bool(in, &flag)
                                                   : api_in_choice(in, param->choices, &choice);
    *out = param->type == HE_PARAM_FLAG ? (double)flag : (double)choice;
    return read;
}

/* Checks that a number is what the parameter takes. */
static bool check_number(const he_param *param, const api_in *in, double value)
{
    if (param->flags & HE_WHOLE) {
        return api_in_check_whole(in, value, (uint64_t)param->min, (uint64_t)param->max);
    }
    const double range[2] = {param->min, param->max};
    return (param->flags & HE_RANGE) == 0 ||
           api_in_check_within(in, value, range, (param->flags & HE_EXCLUSIVE) != 0);
}

/* Takes a column of numbers from an array beside the JSON. */
static bool take_numbers(const api_numbers *numbers, const he_param *param, const api_in *in,
                         he_arg *arg)
{
    if (param->type != HE_PARAM_NUMBER || numbers->type != API_PACKED_F64 || numbers->width != 1 ||
        numbers->count == 0) {
        return api_in_fail(in, API_WRONG_TYPE, "%s",
                           param->type == HE_PARAM_NUMBER
                               ? "a list of numbers is an array of type 2 with one number in an "
                                 "item, and not empty"
                               : "flags and choices are given in the JSON");
    }
    for (size_t i = 0; i < numbers->count; i++) {
        const api_in at = api_in_item(in, i);
        if (!isfinite(numbers->at.f64[i])) {
            return api_in_fail(&at, HE_NOT_FINITE, "the number is not finite");
        }
        if (!check_number(param, &at, numbers->at.f64[i])) {
            return false;
        }
    }
    arg->numbers = numbers->at.f64;
    arg->count = numbers->count;
    arg->list = true;
    return true;
}

/* Reads a column of numbers, flags or choices. */
static bool decode_numbers(const api_decoder *d, const he_param *param, const api_in *in,
                           he_arg *arg)
{
    if (api_in_numbers(in) != NULL) {
        return take_numbers(api_in_numbers(in), param, in, arg);
    }
    if (!api_in_array(in, 1, SIZE_MAX)) {
        return false;
    }
    const size_t count = api_in_count(in);
    double *numbers = api_arena_array(d->arena, count, sizeof *numbers);
    if (numbers == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for %zu values", count);
    }
    api_in child;
    size_t i = 0;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child), i++) {
        if (param->type == HE_PARAM_NUMBER ? !decode_number(param, &child, &numbers[i])
                                           : !decode_flag_or_choice(param, &child, &numbers[i])) {
            return false;
        }
    }
    arg->numbers = numbers;
    arg->count = count;
    arg->list = true;
    return true;
}

/* Reads a list of points: a column, or the list for each of whose points an operation runs. */
static bool decode_point_list(const api_decoder *d, const api_in *in, he_arg *arg)
{
    api_in first;
    if (api_in_numbers(in) != NULL) {
        return take_points(api_in_numbers(in), in, arg);
    }
    if (!api_in_array(in, 1, SIZE_MAX)) {
        return false;
    }
    api_in_first(in, &first);
    return api_in_array(&first, 3, 3) && decode_points(d, true, in, arg);
}

/* Returns true if a value is a column: an array that is not one point. */
static bool is_column(const api_decoder *d, const he_param *param, const api_in *in)
{
    api_in first;
    if (!d->runs_each || !he_op_is_column(param) || !api_in_is_array(in)) {
        return false;
    }
    return param->type != HE_PARAM_POINT || api_in_numbers(in) != NULL ||
           (api_in_first(in, &first) && api_in_is_array(&first));
}

/* Reads a column, for a parameter that he_op_is_column allows to be one. */
static bool decode_column(const api_decoder *d, const he_param *param, const api_in *in,
                          he_arg *arg)
{
    return param->type == HE_PARAM_ELEMENT ? api_decode_ids(d, param, 1, in, arg)
           : param->type == HE_PARAM_POINT ? decode_point_list(d, in, arg)
                                           : decode_numbers(d, param, in, arg);
}

/* Reads the list for each of whose items an operation runs. */
static bool decode_each(const api_decoder *d, const he_param *param, const api_in *in, he_arg *arg)
{
    if (param->type == HE_PARAM_POINT) {
        return decode_point_list(d, in, arg);
    }
    if (param->type == HE_PARAM_CYCLE) {
        return api_decode_cycles(d, param, in, arg);
    }
    if (api_in_is_object(in)) {
        return api_decode_set(d, param->kind, in, arg);
    }
    return api_decode_ids(d, param, 1, in, arg) && api_check_repeated(d, in, arg);
}

/* How a member gives its parameter. */
typedef enum given_as {
    AS_ONE,      /* under `name` */
    AS_TOGETHER, /* under `plural` */
    AS_EACH      /* under `each` */
} given_as;

static bool decode_value(const api_decoder *d, const he_param *param, const api_in *in, given_as as,
                         he_arg *arg)
{
    if (as == AS_EACH) {
        return decode_each(d, param, in, arg);
    }
    if (is_column(d, param, in)) {
        return decode_column(d, param, in, arg);
    }
    switch (param->type) {
    case HE_PARAM_ELEMENT:
        return api_decode_id(d, param, in, &arg->id);
    case HE_PARAM_ELEMENTS: {
        if (as == AS_TOGETHER && api_in_is_object(in)) {
            return api_decode_set(d, param->kind, in, arg);
        }
        if (as == AS_TOGETHER) {
            return api_decode_ids(d, param, 1, in, arg);
        }
        uint32_t *one = api_arena_array(d->arena, 1, sizeof *one);
        if (one == NULL) {
            return api_in_fail(in, HE_NO_MEMORY, "no memory for an id");
        }
        arg->ids = one;
        arg->count = 1;
        return api_decode_id(d, param, in, one);
    }
    case HE_PARAM_NUMBER:
        return decode_number(param, in, &arg->number);
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        return decode_points(d, param->type == HE_PARAM_POINTS, in, arg);
    case HE_PARAM_FLAG:
        return api_in_bool(in, &arg->flag);
    case HE_PARAM_CHOICE:
        return api_in_choice(in, param->choices, &arg->choice);
    case HE_PARAM_MATRIX:
        return decode_matrix(param, in, arg);
    case HE_PARAM_POLYGON:
        return decode_polygon(d, in, arg);
    case HE_PARAM_CYCLE:
        /* No minimum length is given, because the operation itself refuses a list with too few
         * corners. */
        return api_decode_ids(d, param, 0, in, arg);
    case HE_PARAM_TEXT:
        return api_in_string(in, SIZE_MAX, &arg->text);
    case HE_PARAM_COLOR:
        return api_read_color(in, param->flags & HE_OPACITY ? 4 : 3, arg->color, &arg->count);
    case HE_PARAM_MESH:
        return decode_mesh(d, in, arg);
    }
    return api_in_fail(in, API_INTERNAL, "the table of operations has a parameter without a type");
}

/* Returns true if the member `in` gives a list for each of whose items the operation runs. */
static bool is_each(const he_param *param, const api_in *in)
{
    return param->each != NULL && strcmp(param->each, api_in_name(in)) == 0 &&
           (strcmp(param->each, param->name) != 0 || api_in_is_array(in) || api_in_is_object(in));
}

/* Returns the index of the parameter that a member gives, or -1. */
static int find_param(const he_op *op, const api_in *in, given_as *as)
{
    const char *name = api_in_name(in);
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        const bool together = param->plural != NULL && strcmp(param->plural, name) == 0;
        *as = together ? AS_TOGETHER : is_each(param, in) ? AS_EACH : AS_ONE;
        if (*as != AS_ONE || strcmp(param->name, name) == 0) {
            return (int)i;
        }
    }
    return -1;
}

static bool decode_as(const api_decoder *d, const api_in *in)
{
    const char *as;
    if (!api_in_string(in, API_MAX_AS, &as)) {
        return false;
    }
    for (const char *c = as; *c != '\0'; c++) {
        bool letter = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || *c == '_';
        if (!letter && (c == as || *c < '0' || *c > '9')) {
            as = "";
            break;
        }
    }
    if (as[0] == '\0') {
        return api_in_fail(in, HE_BAD_VALUE,
                           "the name in \"as\" must consist of letters, digits and '_', and not "
                           "begin with a digit");
    }
    d->call->as = as;
    return true;
}

static bool is_listed(const char *const *names, const char *name)
{
    for (; names != NULL && *names != NULL; names++) {
        if (strcmp(*names, name) == 0) {
            return true;
        }
    }
    return false;
}

static bool refuse_parameter(const api_decoder *d, const api_in *in)
{
    api_known_names known = {.wanted = api_in_name(in)};
    for (size_t i = 0; i < he_op_params(d->op); i++) {
        const he_param *param = &d->op->params[i];
        api_known_names_add(&known, param->name);
        if (param->plural != NULL || param->each != NULL) {
            api_known_names_add(&known, param->plural != NULL ? param->plural : param->each);
        }
    }
    return api_in_fail(in, API_UNKNOWN_MEMBER, "there is no parameter \"%.60s\" of %s%s",
                       api_in_name(in), d->op->name, api_known_names_text(&known));
}

static bool decode_member(const api_decoder *d, const api_in *in)
{
    const char *name = api_in_name(in);
    if (strcmp(name, "op") == 0 || is_listed(d->scope->also, name)) {
        return true;
    }
    if (d->scope->references != NULL && strcmp(name, "as") == 0) {
        return decode_as(d, in);
    }
    given_as as;
    int i = find_param(d->op, in, &as);
    if (i < 0) {
        return refuse_parameter(d, in);
    }
    he_arg *arg = &d->call->args[i];
    if (arg->given) {
        return api_in_fail(in, API_CONFLICTING_MEMBERS, "give either \"%s\" or \"%s\", not both",
                           d->op->params[i].name,
                           d->op->params[i].plural != NULL ? d->op->params[i].plural
                                                           : d->op->params[i].each);
    }
    arg->given = true;
    return decode_value(d, &d->op->params[i], in, as, arg);
}

/* Finds the member that gives a parameter. Returns the whole object if there is none. */
static api_in member_of(const api_decoder *d, const he_param *param)
{
    api_in at;
    if (api_in_find(d->object, param->name, &at) ||
        (param->plural != NULL && api_in_find(d->object, param->plural, &at)) ||
        (param->each != NULL && api_in_find(d->object, param->each, &at))) {
        return at;
    }
    return *d->object;
}

/* Checks that no parameter is given that the value of the operation's selector does not allow. */
static bool check_selected(const api_decoder *d)
{
    const he_param *selector = he_op_selector(d->op);
    const he_arg *args = d->call->args;
    if (selector == NULL || !args[selector - d->op->params].given) {
        return true;
    }
    for (size_t i = 0; i < he_op_params(d->op); i++) {
        const he_param *param = &d->op->params[i];
        if (!args[i].given || he_op_takes(d->op, args, i)) {
            continue;
        }
        api_in at = member_of(d, param);
        char names[120] = "";
        for (size_t k = 0; selector->choices[k] != NULL; k++) {
            if (param->with & HE_WITH(k)) {
                strncat(names, names[0] == '\0' ? "" : ", ", sizeof names - strlen(names) - 1);
                strncat(names, selector->choices[k], sizeof names - strlen(names) - 1);
            }
        }
        return api_in_fail(&at, API_CONFLICTING_MEMBERS,
                           "\"%s\" may be given only if \"%s\" is one of: %s; it is %s",
                           api_in_name(&at), selector->name, names,
                           selector->choices[args[selector - d->op->params].choice]);
    }
    return true;
}

/* Refuses an operation without a required parameter. The message also names the alternatives of
 * its group. */
static bool fail_missing(const api_decoder *d, size_t i)
{
    const he_param *param = &d->op->params[i];
    char names[160] = "";
    strncat(names, param->name, sizeof names - strlen(names) - 1);
    for (size_t j = 0; param->group != 0 && j < he_op_params(d->op); j++) {
        const he_param *other = &d->op->params[j];
        if (j != i && other->group == param->group && he_op_takes(d->op, d->call->args, j)) {
            strncat(names, "\" or \"", sizeof names - strlen(names) - 1);
            strncat(names, other->name, sizeof names - strlen(names) - 1);
        }
    }
    return api_in_fail(d->object, API_MISSING_MEMBER, "\"%s\" is missing", names);
}

/* Checks that all required parameters are given, and that at most one parameter of each group of
 * alternatives is given. */
static bool check_given(const api_decoder *d)
{
    const he_arg *args = d->call->args;
    for (size_t i = 0; i < he_op_params(d->op); i++) {
        const he_param *param = &d->op->params[i];
        bool given = args[i].given, needed = he_op_needs(d->op, args, i);
        if (!he_op_takes(d->op, args, i)) {
            continue;
        }
        for (size_t j = 0; param->group != 0 && j < he_op_params(d->op); j++) {
            const he_param *other = &d->op->params[j];
            if (j == i || other->group != param->group || !he_op_takes(d->op, args, j)) {
                continue;
            }
            if (args[i].given && args[j].given) {
                const api_in first = member_of(d, j > i ? param : other);
                const api_in second = member_of(d, j > i ? other : param);
                return api_in_fail(&second, API_CONFLICTING_MEMBERS,
                                   "give either \"%s\" or \"%s\", not both", api_in_name(&first),
                                   api_in_name(&second));
            }
            given = given || args[j].given;
            needed = needed || he_op_needs(d->op, args, j);
        }
        if (needed && !given) {
            return fail_missing(d, i);
        }
    }
    return true;
}

/* Checks that a list of points is as long as the operation's first list of elements. */
static bool check_points(const api_decoder *d)
{
    size_t elements = 0;
    bool has_elements = false;
    for (size_t i = 0; i < he_op_params(d->op) && !has_elements; i++) {
        if (d->op->params[i].type == HE_PARAM_ELEMENTS && d->call->args[i].given) {
            elements = d->call->args[i].count;
            has_elements = true;
        }
    }
    for (size_t i = 0; has_elements && i < he_op_params(d->op); i++) {
        const he_arg *arg = &d->call->args[i];
        api_in at;
        if (d->op->params[i].type == HE_PARAM_POINTS && arg->given && arg->list &&
            arg->count != elements && api_in_find(d->object, d->op->params[i].name, &at)) {
            return api_in_fail(&at, HE_BAD_VALUE, "%zu points are given for %zu elements",
                               arg->count, elements);
        }
    }
    return true;
}

/* Checks that each column is as long as the list for each of whose items the operation runs. */
static bool check_columns(const api_decoder *d)
{
    const he_param *each = he_op_each(d->op, d->call->args);
    const size_t runs = he_op_runs(d->op, d->call->args);
    for (size_t i = 0; each != NULL && i < he_op_params(d->op); i++) {
        const he_param *param = &d->op->params[i];
        const he_arg *arg = &d->call->args[i];
        if (param != each && arg->given && arg->list && arg->count != runs) {
            const api_in at = member_of(d, param);
            return api_in_fail(&at, HE_BAD_VALUE,
                               "\"%s\" has %zu values, but \"%s\" has %zu: give one value, or one "
                               "for each",
                               param->name, arg->count, each->each, runs);
        }
    }
    return true;
}

/* Checks the lengths of lists, if they are known already. */
static bool check_lengths(const api_decoder *d)
{
    const bool known = d->scope->mesh != NULL || (!d->call->has_set && !d->call->has_unknown);
    return !known || (check_points(d) && check_columns(d));
}

static bool refuse_operation(const api_in *at, const char *name)
{
    api_known_names known = {.wanted = name};
    for (size_t i = 0; i < he_op_count(); i++) {
        api_known_names_add(&known, he_op_at(i)->name);
    }
    return api_in_fail(at, API_UNKNOWN_OPERATION, "there is no operation \"%.60s\"%s", name,
                       known.nearest != NULL ? api_known_names_text(&known)
                                             : "; GET /v1/operations lists them");
}

bool api_decode_op(const api_in *object, const api_op_scope *scope, api_arena *arena, api_call *out)
{
    api_in name, member;
    const char *text;
    if (!api_in_object(object) || !api_in_need(object, "op", &name) ||
        !api_in_string(&name, SIZE_MAX, &text)) {
        return false;
    }
    out->op = he_op_find(text, strlen(text));
    out->as = NULL;
    out->has_set = out->has_unknown = false;
    if (out->op == NULL) {
        return refuse_operation(&name, text);
    }
    he_op_defaults(out->op, out->args);
    api_decoder d = {object, scope, arena, out->op, out, false};
    for (bool more = api_in_first(object, &member); more; more = api_in_next(&member)) {
        for (size_t i = 0; i < he_op_params(out->op); i++) {
            d.runs_each = d.runs_each || is_each(&out->op->params[i], &member);
        }
    }
    for (bool more = api_in_first(object, &member); more; more = api_in_next(&member)) {
        if (!decode_member(&d, &member)) {
            return false;
        }
    }
    return check_selected(&d) && check_given(&d) && check_lengths(&d);
}
