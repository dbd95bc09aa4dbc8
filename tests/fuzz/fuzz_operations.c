/* Operations run one after another on a small mesh: the bytes choose the mesh, the operations and
 * their arguments, as a decoded request would. After each operation the mesh must pass he_check. A
 * refusal must be one that the operation declares, and must change nothing. Undo must lead back
 * through all states, and redo must lead forward again. */
#include "fuzz/fuzz.h"

#include "algo/shape.h"
#include "op/op.h"
#include "unit/fixture.h"

#include <math.h>
#include <stdio.h>

enum { STEPS = 16, LIST = 8, MOST_FACES = 600 };

typedef struct call {
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    uint32_t ids[HE_OP_PARAMS][LIST];
    he_vec3 points[HE_OP_PARAMS][LIST];
    char texts[HE_OP_PARAMS][8];
} call;

static he_mesh *make_shape(const char *name, const char *param, double value)
{
    double args[HE_SHAPE_PARAMS];
    he_soup soup;
    he_mesh *mesh = NULL;
    const he_shape *shape = he_shape_find(name, strlen(name));
    assert_non_null(shape);
    he_shape_defaults(shape, args);
    for (size_t i = 0; i < he_shape_params(shape); i++) {
        args[i] = strcmp(shape->params[i].name, param) == 0 ? value : args[i];
    }
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return mesh;
}

/* Returns the mesh to start from: closed, open, with faces of many corners, of two components, with
 * a bow-tie, or empty. */
static he_mesh *start(uint32_t which)
{
    switch (which % 7) {
    case 0:
        return make_shape("cube", "", 0);
    case 1:
        return make_shape("grid", "columns", 2);
    case 2:
        return make_shape("cylinder", "", 0);
    case 3:
        return fixture_mesh("012,034");
    case 4:
        return fixture_mesh("012,021,345");
    case 5:
        return fixture_mesh("0123,1054,2165,3276,0347");
    default:
        return fixture_mesh("");
    }
}

/* Returns an id: in most cases that of a live element. */
static uint32_t pick(fuzz_tape *t, const he_mesh *mesh, he_kind kind)
{
    uint32_t issued = he_mesh_issued(mesh, kind), byte = fuzz_byte(t);
    if (issued == 0 || byte >= 250) {
        return issued + byte % 3;
    }
    uint32_t live = he_mesh_next_live(mesh, kind, byte % issued);
    return live == HE_NONE ? byte % issued : live;
}

static double number_in(fuzz_tape *t, const he_param *p)
{
    double value = fuzz_double(t);
    value = p->flags & HE_WHOLE ? floor(value) : value;
    if ((p->flags & HE_RANGE) == 0 || (value > p->min && value < p->max)) {
        return value;
    }
    bool inside = (p->flags & HE_EXCLUSIVE) != 0;
    double low = p->min, span = p->max - p->min < 4 ? p->max - p->min : 4;
    uint32_t share = fuzz_byte(t) % 9;
    value = inside ? low + span * (share + 1) / 10 : low + span * share / 8;
    return p->flags & HE_WHOLE ? floor(value) : value;
}

static void draw_points(fuzz_tape *t, he_vec3 *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        points[i].x = fuzz_double(t);
        points[i].y = fuzz_double(t);
        points[i].z = fuzz_double(t);
    }
}

static void draw_matrix(fuzz_tape *t, double matrix[16])
{
    for (size_t i = 0; i < 12; i++) {
        matrix[i] = i % 5 == 0 ? 1 : 0;
    }
    for (uint32_t n = fuzz_byte(t) % 13; n > 0; n--) {
        matrix[fuzz_byte(t) % 12] = fuzz_double(t);
    }
    matrix[12] = matrix[13] = matrix[14] = 0;
    matrix[15] = 1;
}

/* Draws the i-th argument of a call. `elements` is the length of a list of elements for which one
 * point each is needed, or 0 if there is no such list. */
static void draw_value(fuzz_tape *t, call *c, size_t i, const he_mesh *mesh, const he_mesh *other,
                       size_t elements)
{
    const he_param *p = &c->op->params[i];
    he_arg *arg = &c->args[i];
    int choices = 0;
    arg->given = true;
    switch (p->type) {
    case HE_PARAM_ELEMENT:
        arg->id = (p->flags & HE_NULLABLE) != 0 && fuzz_byte(t) % 4 == 0 ? HE_NONE
                                                                         : pick(t, mesh, p->kind);
        break;
    case HE_PARAM_ELEMENTS:
    case HE_PARAM_CYCLE:
        arg->count = fuzz_byte(t) % (LIST + 1);
        arg->list = p->type == HE_PARAM_CYCLE || arg->count != 1 || fuzz_byte(t) % 2 == 0;
        arg->ids = c->ids[i];
        for (size_t k = 0; k < arg->count; k++) {
            c->ids[i][k] = pick(t, mesh, p->kind);
        }
        break;
    case HE_PARAM_NUMBER:
        arg->number = number_in(t, p);
        break;
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        arg->list = p->type == HE_PARAM_POINTS && elements > 0 && fuzz_byte(t) % 2 == 0;
        arg->count = arg->list ? elements : 1;
        arg->points = c->points[i];
        draw_points(t, c->points[i], arg->count);
        break;
    case HE_PARAM_FLAG:
        arg->flag = fuzz_byte(t) % 2 == 0;
        break;
    case HE_PARAM_CHOICE:
        while (p->choices[choices] != NULL) {
            choices++;
        }
        arg->choice = (int)fuzz_byte(t) % choices;
        break;
    case HE_PARAM_MATRIX:
        draw_matrix(t, arg->matrix);
        for (size_t k = 12; k < 16 && (p->flags & HE_PROJECTIVE) != 0; k++) {
            arg->matrix[k] = fuzz_double(t);
        }
        break;
    case HE_PARAM_POLYGON:
        arg->count = fuzz_byte(t) % (LIST + 1);
        arg->points = c->points[i];
        draw_points(t, c->points[i], arg->count);
        break;
    case HE_PARAM_TEXT:
        snprintf(c->texts[i], sizeof c->texts[i], "%.*s%c", (int)(fuzz_byte(t) % 4), "abc",
                 fuzz_byte(t) % 128);
        arg->text = c->texts[i];
        break;
    case HE_PARAM_COLOR:
        arg->count = (p->flags & HE_OPACITY) != 0 && fuzz_byte(t) % 2 == 0 ? 4 : 3;
        for (size_t k = 0; k < arg->count; k++) {
            arg->color[k] = fuzz_double(t);
        }
        break;
    case HE_PARAM_MESH:
        arg->mesh = other;
        break;
    }
}

/* Returns whether parameter i gets a value. In a group of alternative parameters at most one gets a
 * value, and exactly one if the group is required. */
static bool is_wanted(fuzz_tape *t, const call *c, size_t i, const char *taken)
{
    const he_op *op = c->op;
    const he_param *p = &op->params[i];
    bool required = he_op_needs(op, c->args, i), later = false;
    if (!he_op_takes(op, c->args, i)) {
        return false;
    }
    if (p->group == 0) {
        return required || fuzz_byte(t) % 2 == 0;
    }
    for (size_t k = 0; k < he_op_params(op); k++) {
        bool same = op->params[k].group == p->group && he_op_takes(op, c->args, k);
        required |= same && he_op_needs(op, c->args, k);
        later |= same && k > i;
    }
    return strchr(taken, p->group) == NULL && (fuzz_byte(t) % 2 == 0 || (required && !later));
}

static void draw(fuzz_tape *t, call *c, const he_mesh *mesh, const he_mesh *other)
{
    char taken[HE_OP_PARAMS + 1] = "";
    size_t elements = 0;
    c->op = he_op_at(fuzz_byte(t) % he_op_count());
    he_op_defaults(c->op, c->args);
    for (size_t i = 0; i < he_op_params(c->op); i++) {
        const he_param *p = &c->op->params[i];
        if (!is_wanted(t, c, i, taken)) {
            continue;
        }
        if (p->group != 0) {
            taken[strlen(taken)] = p->group;
        }
        draw_value(t, c, i, mesh, other, elements);
        elements = p->type == HE_PARAM_ELEMENTS && c->args[i].list ? c->args[i].count : elements;
    }
}

typedef struct step {
    he_mesh *before;
    he_delta *delta;
} step;

static void run(const call *c, he_mesh *mesh, step *s)
{
    he_results results = {0};
    he_changes changes = {0};
    he_error err = {0};
    assert_int_equal(he_mesh_copy(mesh, &s->before, NULL), HE_OK);
    s->delta = he_delta_new();
    assert_non_null(s->delta);
    (void)he_mesh_record(mesh, s->delta);
    he_status status = he_op_run(c->op, mesh, c->args, &results, &err);
    (void)he_mesh_record(mesh, NULL);
    if (status == HE_OK) {
        fixture_check(mesh);
        assert_int_equal(he_changes_find(mesh, s->delta, 0, s->delta->count, false, &changes, NULL),
                         HE_OK);
    } else {
        FUZZ_REQUIRE(he_op_declares(c->op, status) && status != HE_NO_MEMORY &&
                         err.status == status && err.text[0] != '\0',
                     "%s is refused with %s: %s", c->op->name, he_status_slug(status), err.text);
        FUZZ_REQUIRE(he_mesh_equal(mesh, s->before) && s->delta->count == 0,
                     "%s is refused and changes the mesh", c->op->name);
    }
    he_changes_clear(&changes);
    he_results_clear(&results);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    fuzz_tape tape = {bytes, bytes + size};
    uint32_t which = fuzz_byte(&tape);
    he_mesh *mesh = start(which), *other = start(which / 7), *end = NULL;
    step steps[STEPS];
    size_t count = 0;
    for (; count < STEPS && !fuzz_at_end(&tape) && he_mesh_faces(mesh) < MOST_FACES; count++) {
        call c;
        draw(&tape, &c, mesh, other);
        if (he_op_growth(c.op, mesh, c.args) * he_mesh_faces(mesh) > MOST_FACES) {
            break;
        }
        run(&c, mesh, &steps[count]);
    }
    assert_int_equal(he_mesh_copy(mesh, &end, NULL), HE_OK);
    for (size_t i = count; i-- > 0;) {
        he_delta_undo(steps[i].delta, mesh);
        FUZZ_REQUIRE(he_mesh_equal_live(mesh, steps[i].before), "undo %zu leads elsewhere", i);
    }
    fixture_check(mesh);
    for (size_t i = 0; i < count; i++) {
        he_delta_redo(steps[i].delta, mesh);
        he_mesh_free(steps[i].before);
    }
    FUZZ_REQUIRE(he_mesh_equal(mesh, end), "redo leads elsewhere");
    for (size_t i = 0; i < count; i++) {
        he_delta_free(steps[i].delta);
    }
    he_mesh_free(end);
    he_mesh_free(other);
    he_mesh_free(mesh);
}
