#include "model/calls_select.h"

#include "mesh/column.h"
#include "model/rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const names[] = {"selected", "locked", "part", "feature"};
static const char *const numbers[] = {"number", "selected", "patch", "locked", "position"};
static const char *const measures[] = {
    "area",           "length",       "dihedral",       "degree",
    "smallest_angle", "angle_defect", "mean_curvature", "gaussian_curvature",
};
static const char *const kinds[] = {"faces", "edges", "vertices"};

#define COUNT(array) ((uint32_t)(sizeof(array) / sizeof(array)[0]))

static const char *choice_of(const md_call *c, const char *name)
{
    const size_t i = md_index(c, name);
    return c->op->params[i].choices[c->args[i].choice];
}

static bool is_by(const md_call *c, const char *by)
{
    return strcmp(choice_of(c, "by"), by) == 0;
}

/* --- drawing --- */

static void draw_seeds(md_draft *d)
{
    static const struct {
        const char *one, *many;
        he_kind kind;
    } lists[] = {
        {"face", "faces", HE_FACE}, {"edge", "edges", HE_EDGE}, {"vertex", "vertices", HE_VERTEX}};
    const bool only_faces = is_by(d->c, "region") || is_by(d->c, "boundary");
    const uint32_t i = only_faces ? 0 : md_below(d->r, COUNT(lists));
    if (md_chance(d->r, 2) || he_mesh_issued(d->m, lists[i].kind) == 0) {
        static const uint32_t none[1] = {0};
        md_give_ids(d, lists[i].many, none, 0, true);
    } else {
        (void)md_pick_some(d, lists[i].one, lists[i].many, lists[i].kind, MD_LIST - 1);
    }
}

static void draw_direction(md_draft *d)
{
    md_give_points(d, "normal", 1, false);
    he_vec3 *normal = d->c->points[md_index(d->c, "normal")];
    if (md_chance(d->r, 2)) {
        *normal = (he_vec3){0, 0, 0};
    } else if (md_chance(d->r, 2)) {
        normal->y = INFINITY;
    }
}

static void draw_box(md_draft *d)
{
    md_give_points(d, "min", 1, false);
    md_give_points(d, "max", 1, false);
    he_vec3 *min = d->c->points[md_index(d->c, "min")];
    he_vec3 *max = d->c->points[md_index(d->c, "max")];
    const he_vec3 a = *min, b = *max;
    if (!md_chance(d->r, 5)) {
        *min = (he_vec3){fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)};
        *max = (he_vec3){fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)};
    }
    if (or_live_vertices(d->o) > 0 && md_chance(d->r, 20)) {
        *min = d->o->vertex[md_live(d, HE_VERTEX)].at;
        *max = md_chance(d->r, 50) ? *min : *max;
    }
}

static void draw_lasso(md_draft *d)
{
    const size_t matrix = md_index(d->c, "matrix"), polygon = md_index(d->c, "polygon");
    he_arg *corners = &d->c->args[polygon];
    for (int i = 0; i < 16; i++) {
        d->c->args[matrix].matrix[i] = 2 * md_unit(d->r) - 1;
    }
    if (md_chance(d->r, 50)) {
        static const double affine[4] = {0, 0, 0, 1};
        memcpy(&d->c->args[matrix].matrix[12], affine, sizeof affine);
    }
    if (md_chance(d->r, 3)) {
        memcpy(&d->c->args[matrix].matrix[4], d->c->args[matrix].matrix, 4 * sizeof(double));
    }
    d->c->args[matrix].given = true;
    md_give_points(d, "polygon", md_from(d->r, md_chance(d->r, 5) ? 1 : 3, MD_LIST), true);
    corners->list = false;
    for (size_t i = 0; i < corners->count; i++) {
        d->c->points[polygon][i].z = 0;
    }
}

static void draw_range(md_draft *d)
{
    const double a = 4 * md_unit(d->r) - 1, b = 4 * md_unit(d->r) - 1;
    if (md_chance(d->r, 70)) {
        md_give_number(d, "from", md_chance(d->r, 5) ? a : fmin(a, b));
    }
    if (md_chance(d->r, 70)) {
        md_give_number(d, "to", md_chance(d->r, 5) ? b : fmax(a, b));
    }
}

static void draw_by(md_draft *d)
{
    const md_call *c = d->c;
    if (is_by(c, "region") || is_by(c, "component") || is_by(c, "grow") || is_by(c, "shrink") ||
        (is_by(c, "boundary") && md_chance(d->r, 60))) {
        draw_seeds(d);
    }
    if (is_by(c, "region") || is_by(c, "cone")) {
        md_give_number(d, "angle", md_unit(d->r) * 3.1);
    }
    if (is_by(c, "region")) {
        md_give_flag(d, "cross_features", md_chance(d->r, 30));
    }
    if (is_by(c, "half_space")) {
        md_give_plane(d);
        if (md_chance(d->r, 30)) {
            md_give_number(d, "tolerance", md_unit(d->r) - (md_chance(d->r, 20) ? 0.5 : 0));
        }
    } else if (is_by(c, "cone")) {
        draw_direction(d);
    } else if (is_by(c, "box")) {
        draw_box(d);
    } else if (is_by(c, "lasso")) {
        draw_lasso(d);
    } else if (is_by(c, "measure")) {
        md_give_choice(d, "measure", measures[md_below(d->r, COUNT(measures))]);
        draw_range(d);
    } else if (is_by(c, "attribute")) {
        md_give_text(d, "attribute", numbers[md_below(d->r, COUNT(numbers))]);
        md_give_number(d, "component", md_chance(d->r, 30));
        draw_range(d);
    } else if (is_by(c, "grow") || is_by(c, "shrink")) {
        md_give_number(d, "steps", md_chance(d->r, 10) ? HE_MAX_ROWS : md_from(d->r, 1, 3));
    }
    if ((is_by(c, "box") || is_by(c, "half_space") || is_by(c, "lasso")) && md_chance(d->r, 50)) {
        md_give_choice(d, "corners", "any");
    }
}

/* Draws the attribute to write. An attribute that `append` could find in another mesh with another
 * type is only written, never made: the oracle does not know about it. */
static void draw_set(md_draft *d)
{
    const bool whole = md_chance(d->r, 20);
    if (whole) {
        md_give_number(d, "value", md_from(d->r, 1, 3));
    }
    if (md_chance(d->r, 5)) {
        const bool is_there = he_mesh_find_column(d->m, HE_FACE, "number") != NULL &&
                              he_mesh_find_column(d->m, HE_EDGE, "number") != NULL &&
                              he_mesh_find_column(d->m, HE_VERTEX, "number") != NULL;
        md_give_text(d, "into", is_there ? "number" : whole ? "patch" : "part");
    } else if (whole || md_chance(d->r, 60)) {
        md_give_text(d, "into", whole ? "patch" : names[md_below(d->r, COUNT(names))]);
    }
}

bool md_select_draw(md_draft *d)
{
    const he_param *by = he_op_selector(d->c->op);
    uint32_t choices = 0;
    while (by->choices[choices] != NULL) {
        choices++;
    }
    md_give_choice(d, "by", by->choices[md_below(d->r, choices)]);
    const bool sized = is_by(d->c, "grow") || is_by(d->c, "shrink");
    if (md_chance(d->r, sized ? 20 : 70)) {
        md_give_choice(d, "elements", kinds[md_below(d->r, COUNT(kinds))]);
    }
    draw_set(d);
    if (md_chance(d->r, 40)) {
        md_give_choice(d, "mode", md_chance(d->r, 50) ? "add" : "remove");
    }
    draw_by(d);
    return true;
}

/* --- playing --- */

static void take_seeds(const md_call *c, or_rule *rule)
{
    static const struct {
        const char *name;
        he_kind kind;
    } lists[] = {{"face", HE_FACE}, {"edge", HE_EDGE}, {"vertex", HE_VERTEX}};
    rule->seed_kind = HE_FACE;
    for (uint32_t i = 0; i < COUNT(lists); i++) {
        const he_arg *arg = md_get(c, lists[i].name);
        if (arg->given) {
            rule->seeded = true;
            rule->seed_kind = lists[i].kind;
            rule->seeds = arg->ids;
            rule->seed_count = (uint32_t)arg->count;
        }
    }
}

static he_vec3 point_of(const md_call *c, const char *name)
{
    const he_arg *arg = md_get(c, name);
    return arg->given ? arg->points[0] : (he_vec3){0, 0, 0};
}

static or_rule rule_of(const md_call *c)
{
    static const he_kind of[] = {HE_FACE, HE_EDGE, HE_VERTEX};
    or_rule rule = {.by = choice_of(c, "by"), .measure = choice_of(c, "measure")};
    take_seeds(c, &rule);
    const bool sized = is_by(c, "grow") || is_by(c, "shrink");
    rule.of = md_get(c, "elements")->given ? of[md_get(c, "elements")->choice]
              : sized                      ? rule.seed_kind
                                           : HE_FACE;
    rule.angle = md_get(c, "angle")->number;
    rule.cross_features = md_get(c, "cross_features")->flag;
    rule.any_corner = md_get(c, "corners")->choice == 1;
    rule.low = point_of(c, "min");
    rule.high = point_of(c, "max");
    rule.normal = point_of(c, "normal");
    if (is_by(c, "half_space")) {
        rule.plane = md_plane(c);
    }
    rule.matrix = md_get(c, "matrix")->matrix;
    rule.polygon = md_get(c, "polygon")->points;
    rule.polygon_count = (uint32_t)md_get(c, "polygon")->count;
    rule.steps = (uint32_t)md_get(c, "steps")->number;
    rule.from = md_get(c, "from")->given ? md_get(c, "from")->number : -INFINITY;
    rule.to = md_get(c, "to")->given ? md_get(c, "to")->number : INFINITY;
    return rule;
}

static uint64_t check_measure(const or_rule *rule)
{
    static const struct {
        const char *measure;
        bool has[3]; /* vertices, edges, faces */
    } rows[] = {{"area", {true, false, true}},
                {"length", {false, true, false}},
                {"dihedral", {false, true, false}},
                {"degree", {true, false, true}},
                {"smallest_angle", {false, false, true}},
                {"angle_defect", {true, false, false}},
                {"mean_curvature", {true, false, false}},
                {"gaussian_curvature", {true, false, false}}};
    const int kind = rule->of == HE_VERTEX ? 0 : rule->of == HE_EDGE ? 1 : 2;
    for (uint32_t i = 0; i < COUNT(rows); i++) {
        if (strcmp(rows[i].measure, rule->measure) == 0 && rows[i].has[kind]) {
            return 0;
        }
    }
    return OR_BIT(HE_BAD_VALUE);
}

/* Finds the attribute in which a call looks for values; `own` holds that of positions. */
static const he_column *values_of(const md_call *c, const or_rule *rule, const he_mesh *m,
                                  he_column *own)
{
    const char *name = md_get(c, "attribute")->text;
    if (rule->of == HE_VERTEX && strcmp(name, "position") == 0) {
        he_mesh_position_column(m, own);
        return own;
    }
    return he_mesh_find_column(m, rule->of, name);
}

static uint64_t check_attribute(const md_call *c, const or_rule *rule, const he_mesh *m)
{
    he_column own;
    const he_column *column = values_of(c, rule, m, &own);
    if (column == NULL) {
        return OR_BIT(HE_NO_SUCH_ATTRIBUTE);
    }
    return md_get(c, "component")->number >= column->components ? OR_BIT(HE_BAD_VALUE) : 0;
}

/* Returns whether two of the three rows of a matrix that matter are equal, as draw_lasso makes
 * them. */
static bool is_singular(const double *matrix)
{
    for (int i = 0; i < 4; i++) {
        if (matrix[i] != matrix[4 + i]) {
            return false;
        }
    }
    return true;
}

static uint64_t check_rule(const md_call *c, const or_rule *rule, or_mesh *o, const he_mesh *m)
{
    uint64_t refused = 0;
    const he_vec3 n = rule->normal, low = rule->low, high = rule->high;
    if (rule->seeded) {
        he_arg seeds = {.ids = rule->seeds, .count = rule->seed_count};
        refused |= md_require_all(o, rule->seed_kind, &seeds);
    }
    bool bad = false;
    if (is_by(c, "region") || is_by(c, "component")) {
        bad = rule->seed_count == 0;
    } else if (is_by(c, "grow") || is_by(c, "shrink")) {
        bad = rule->seed_kind != rule->of;
    } else if (is_by(c, "box")) {
        bad = low.x > high.x || low.y > high.y || low.z > high.z;
    } else if (is_by(c, "lasso")) {
        bad = rule->polygon_count < 3 || is_singular(rule->matrix);
    } else if (is_by(c, "half_space") || is_by(c, "cone")) {
        refused |= isfinite(n.y) ? 0 : OR_BIT(HE_NOT_FINITE);
        bad =
            (n.x == 0 && n.y == 0 && n.z == 0) ||
            (is_by(c, "half_space") && rule->plane.tolerance != NULL && *rule->plane.tolerance < 0);
    } else if (is_by(c, "measure")) {
        refused |= check_measure(rule);
    } else if (is_by(c, "attribute")) {
        refused |= check_attribute(c, rule, m);
    }
    bad = bad || rule->from > rule->to;
    return refused | (bad ? OR_BIT(HE_BAD_VALUE) : 0);
}

static const he_column *set_of(const md_call *c, const or_rule *rule, const he_mesh *m)
{
    const he_arg *into = md_get(c, "into");
    return he_mesh_find_column(m, rule->of, into->given ? into->text : "selected");
}

static uint64_t check_set(const md_call *c, const he_column *column)
{
    const bool whole = md_get(c, "value")->given;
    if (column == NULL) {
        return strcmp(choice_of(c, "mode"), "remove") == 0 ? OR_BIT(HE_NO_SUCH_ATTRIBUTE) : 0;
    }
    const bool fits =
        column->components == 1 && column->labels == NULL &&
        (whole ? column->type == HE_INT32 || column->type == HE_UINT32 : column->type == HE_BOOL);
    return fits ? 0 : OR_BIT(HE_ATTRIBUTE_CLASH);
}

static double number_in(const he_column *column, uint32_t id, size_t component)
{
    const unsigned char *at = he_column_value(column, id) + component * he_type_bytes(column->type);
    uint32_t word = 0;
    float single;
    double number;
    memcpy(&word, at, column->type == HE_BOOL ? 1 : 4);
    switch (column->type) {
    case HE_INT32:
        return (int32_t)word;
    case HE_FLOAT:
        memcpy(&single, at, sizeof single);
        return single;
    case HE_DOUBLE:
        memcpy(&number, at, sizeof number);
        return number;
    case HE_BOOL:
    case HE_UINT32:
    case HE_TYPE_COUNT:
        break;
    }
    return word;
}

/* Says whether an element belongs to the set afterwards. */
static or_verdict becomes(const md_call *c, bool was, or_verdict found)
{
    const char *mode = choice_of(c, "mode");
    if (strcmp(mode, "only") == 0) {
        return found;
    }
    if (strcmp(mode, "add") == 0) {
        return was ? OR_YES : found;
    }
    return was ? (or_verdict)(OR_YES - found) : OR_NO;
}

static bool has(const md_call *c, const he_column *set, uint32_t id)
{
    const double value = md_get(c, "value")->given ? md_get(c, "value")->number : 1;
    return set != NULL && number_in(set, id, 0) == value;
}

bool md_select_has(const md_call *c, const he_mesh *m, uint32_t id)
{
    const or_rule rule = rule_of(c);
    return has(c, set_of(c, &rule, m), id);
}

he_kind md_select_kind(const md_call *c)
{
    return rule_of(c).of;
}

uint64_t md_select_foresee(const md_call *c, or_mesh *o, const he_mesh *m,
                           or_verdict verdict[OR_ROWS])
{
    static double values[OR_ROWS];
    or_rule rule = rule_of(c);
    const he_column *set = set_of(c, &rule, m);
    const uint64_t refused = check_rule(c, &rule, o, m) | check_set(c, set);
    if (refused != 0) {
        return refused;
    }
    const uint32_t rows = he_mesh_issued(m, rule.of);
    if (is_by(c, "attribute")) {
        he_column own;
        const he_column *column = values_of(c, &rule, m, &own);
        for (uint32_t id = 0; id < rows; id++) {
            values[id] = number_in(column, id, (size_t)md_get(c, "component")->number);
        }
        rule.values = values;
    }
    or_select(o, &rule, verdict);
    for (uint32_t id = 0; id < rows; id++) {
        verdict[id] =
            he_mesh_is_live(m, rule.of, id) ? becomes(c, has(c, set, id), verdict[id]) : OR_NO;
    }
    return 0;
}

/* What the last play_select expects: the least and the most elements of the set, and the number
 * that it had. */
static struct {
    uint32_t least, most, before;
} expected;

static uint64_t play_select(const md_call *c, or_mesh *o, const he_mesh *m)
{
    static or_verdict verdict[OR_ROWS];
    const uint64_t refused = md_select_foresee(c, o, m, verdict);
    memset(&expected, 0, sizeof expected);
    for (uint32_t id = 0; refused == 0 && id < he_mesh_issued(m, md_select_kind(c)); id++) {
        expected.least += verdict[id] == OR_YES;
        expected.most += verdict[id] != OR_NO;
        expected.before += he_mesh_is_live(m, md_select_kind(c), id) && md_select_has(c, m, id);
    }
    return refused;
}

static bool follow_select(const md_call *c, or_mesh *o, const he_results *results,
                          char text[OR_TEXT])
{
    (void)c, (void)o;
    const double selected = results->number[0];
    if (selected < expected.least || selected > expected.most) {
        (void)snprintf(text, OR_TEXT, "%g are selected, not %u to %u", selected, expected.least,
                       expected.most);
        return false;
    }
    if (expected.before + results->number[1] - results->number[2] != selected) {
        (void)snprintf(text, OR_TEXT, "%u were selected, %g more, %g less, and now %g",
                       expected.before, results->number[1], results->number[2], selected);
        return false;
    }
    return true;
}

const md_row md_select_rows[] = {
    {"select", 0, md_select_draw, play_select, follow_select, false},
    {.name = NULL},
};
