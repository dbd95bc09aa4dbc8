#include "op/rows.h"

#include "geometry/scale.h"
#include "select/segment.h"
#include "select/select.h"

#include <math.h>

enum {
    SELECT_BY,
    SELECT_FACES,
    SELECT_EDGES,
    SELECT_VERTICES,
    SELECT_ANGLE,
    SELECT_CROSS_FEATURES,
    SELECT_MIN,
    SELECT_MAX,
    SELECT_POINT,
    SELECT_NORMAL,
    SELECT_TOLERANCE,
    SELECT_POLYGON,
    SELECT_MATRIX,
    SELECT_CORNERS,
    SELECT_MEASURE,
    SELECT_ATTRIBUTE,
    SELECT_COMPONENT,
    SELECT_FROM,
    SELECT_TO,
    SELECT_STEPS,
    SELECT_ELEMENTS,
    SELECT_MODE,
    SELECT_INTO,
    SELECT_VALUE
};
enum { SELECT_OUT_SELECTED, SELECT_OUT_ADDED, SELECT_OUT_REMOVED };

/* The names that requests use for the values of he_select_by, he_set_mode, he_corner_rule and
 * he_select_measure, in the order of the enums. */
static const char *const rules[] = {"region", "component", "box",      "half_space",
                                    "lasso",  "cone",      "measure",  "attribute",
                                    "grow",   "shrink",    "boundary", NULL};
static const char *const modes[] = {"only", "add", "remove", NULL};
static const char *const corners[] = {"all", "any", NULL};
static const char *const measures[] = {
    "area",         "length",         "dihedral",           "degree", "smallest_angle",
    "angle_defect", "mean_curvature", "gaussian_curvature", NULL};
static const char *const kinds[] = {"faces", "edges", "vertices", NULL};

/* Takes the seeds from that of the parameters `faces`, `edges` and `vertices` which is given. */
static void take_seeds(const he_arg *args, he_select_rule *rule)
{
    static const struct {
        size_t slot;
        he_kind kind;
    } lists[] = {{SELECT_FACES, HE_FACE}, {SELECT_EDGES, HE_EDGE}, {SELECT_VERTICES, HE_VERTEX}};
    rule->seed_kind = HE_FACE;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (args[lists[i].slot].given) {
            rule->seeds = args[lists[i].slot].ids;
            rule->seed_count = args[lists[i].slot].count;
            rule->seed_kind = lists[i].kind;
        }
    }
}

static he_kind kind_of(const he_arg *args, const he_select_rule *rule)
{
    static const he_kind all[] = {HE_FACE, HE_EDGE, HE_VERTEX};
    if (!args[SELECT_ELEMENTS].given) {
        return rule->by == HE_BY_GROW || rule->by == HE_BY_SHRINK ? rule->seed_kind : HE_FACE;
    }
    return all[args[SELECT_ELEMENTS].choice];
}

static he_vec3 point_of(const he_arg *arg)
{
    return arg->given ? arg->points[0] : (he_vec3){0, 0, 0};
}

static he_status run_select(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_select_rule rule = {
        .by = (he_select_by)args[SELECT_BY].choice,
        .angle = args[SELECT_ANGLE].number,
        .cross_features = args[SELECT_CROSS_FEATURES].flag,
        .low = point_of(&args[SELECT_MIN]),
        .high = point_of(&args[SELECT_MAX]),
        .plane = {point_of(&args[SELECT_POINT]), point_of(&args[SELECT_NORMAL]),
                  args[SELECT_TOLERANCE].given ? &args[SELECT_TOLERANCE].number : NULL},
        .lasso = {args[SELECT_MATRIX].matrix, args[SELECT_POLYGON].points,
                  args[SELECT_POLYGON].count},
        .corners = (he_corner_rule)args[SELECT_CORNERS].choice,
        .direction = point_of(&args[SELECT_NORMAL]),
        .measure = (he_select_measure)args[SELECT_MEASURE].choice,
        .attribute = args[SELECT_ATTRIBUTE].text,
        .component = (uint32_t)args[SELECT_COMPONENT].number,
        .from = args[SELECT_FROM].given ? args[SELECT_FROM].number : -INFINITY,
        .to = args[SELECT_TO].given ? args[SELECT_TO].number : INFINITY,
        .steps = (uint32_t)args[SELECT_STEPS].number};
    take_seeds(args, &rule);
    rule.of = kind_of(args, &rule);
    const he_set_into into = {.name = args[SELECT_INTO].given ? args[SELECT_INTO].text : "selected",
                              .value =
                                  args[SELECT_VALUE].given ? (int32_t)args[SELECT_VALUE].number : 0,
                              .mode = (he_set_mode)args[SELECT_MODE].choice};
    he_set_counts done;
    he_status status = he_select(m, &rule, &into, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, SELECT_OUT_SELECTED, done.selected);
        he_results_set_number(out, SELECT_OUT_ADDED, done.added);
        he_results_set_number(out, SELECT_OUT_REMOVED, done.removed);
    }
    return status;
}

enum { SEGMENT_ANGLE, SEGMENT_PLANES, SEGMENT_FEATURES, SEGMENT_INTO };
enum { SEGMENT_OUT_PATCHES, SEGMENT_OUT_FEATURES, SEGMENT_OUT_DEVIATION };

/* The names that requests use for the values of he_segment_features, in the order of the enum. */
static const char *const features[] = {"add", "replace", "ignore", NULL};

static he_status run_segment(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const he_segment_options options = {
        .into = args[SEGMENT_INTO].given ? args[SEGMENT_INTO].text : "patch",
        .planes = args[SEGMENT_PLANES].given ? (uint32_t)args[SEGMENT_PLANES].number : 0,
        .angle = args[SEGMENT_ANGLE].number,
        .features = (he_segment_features)args[SEGMENT_FEATURES].choice};
    he_segmented done;
    he_status status = he_segment(m, &options, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, SEGMENT_OUT_PATCHES, done.patches);
        he_results_set_number(out, SEGMENT_OUT_FEATURES, done.features);
        he_results_set_number(out, SEGMENT_OUT_DEVIATION, done.deviation);
        if (options.planes == 0) {
            he_results_omit(out, SEGMENT_OUT_DEVIATION);
        }
    }
    return status;
}

/* The rules that need a list of elements. */
#define SEEDED (HE_WITH(HE_BY_COMPONENT) | HE_WITH(HE_BY_GROW) | HE_WITH(HE_BY_SHRINK))
#define PLACED (HE_WITH(HE_BY_BOX) | HE_WITH(HE_BY_HALF_SPACE) | HE_WITH(HE_BY_LASSO))
#define RANGED (HE_WITH(HE_BY_MEASURE) | HE_WITH(HE_BY_ATTRIBUTE))

const he_op he_select_rows[] = {
    {
        .name = "select",
        .doc = "Find elements by a rule and write the set of them into an attribute. Other "
               "operations take the set in place of a list of ids, as {\"selected\":true} or "
               "{\"patch\":3}.",
        .size = HE_OP_WHOLE,
        .params =
            {[SELECT_BY] =
                 {.name = "by",
                  .type = HE_PARAM_CHOICE,
                  .flags = HE_REQUIRED | HE_SELECTS,
                  .choices = rules,
                  .doc =
                      "The rule. region: faces around `faces`, up to edges with a larger dihedral "
                      "angle. component: components of the listed elements. box, half_space, "
                      "lasso: by place. cone: by the direction of normals. measure, attribute: "
                      "by a value. grow, shrink: a set with its neighbours, or without its "
                      "border. boundary: edges of the mesh, or of the set `faces`, with a face "
                      "on one side only."},
             [SELECT_FACES] =
                 {.name = "face",
                  .plural = "faces",
                  .type = HE_PARAM_ELEMENTS,
                  .kind = HE_FACE,
                  .flags = HE_MAY_BE_EMPTY,
                  .group = 's',
                  .with = SEEDED | HE_WITH(HE_BY_REGION) | HE_WITH(HE_BY_BOUNDARY),
                  .needed = SEEDED | HE_WITH(HE_BY_REGION),
                  .doc = "The faces from which the rule begins, or the set that grows or shrinks. "
                         "Default for boundary: all."},
             [SELECT_EDGES] = {.name = "edge",
                               .plural = "edges",
                               .type = HE_PARAM_ELEMENTS,
                               .kind = HE_EDGE,
                               .flags = HE_MAY_BE_EMPTY,
                               .group = 's',
                               .with = SEEDED,
                               .needed = SEEDED,
                               .doc = "Edges in place of faces."},
             [SELECT_VERTICES] = {.name = "vertex",
                                  .plural = "vertices",
                                  .type = HE_PARAM_ELEMENTS,
                                  .kind = HE_VERTEX,
                                  .flags = HE_MAY_BE_EMPTY,
                                  .group = 's',
                                  .with = SEEDED,
                                  .needed = SEEDED,
                                  .doc = "Vertices in place of faces."},
             [SELECT_ANGLE] = {.name = "angle",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_RANGE,
                               .max = HE_PI,
                               .unit = HE_RADIANS,
                               .with = HE_WITH(HE_BY_REGION) | HE_WITH(HE_BY_CONE),
                               .needed = HE_WITH(HE_BY_REGION) | HE_WITH(HE_BY_CONE),
                               .doc = "region: the largest angle between the "
                                      "normals of neighbours. cone: the largest angle between a "
                                      "normal and the direction `normal`."},
             [SELECT_CROSS_FEATURES] =
                 {.name = "cross_features",
                  .type = HE_PARAM_FLAG,
                  .with = HE_WITH(HE_BY_REGION),
                  .doc = "Also cross edges whose bool attribute `feature` is true."},
             [SELECT_MIN] = {.name = "min",
                             .type = HE_PARAM_POINT,
                             .with = HE_WITH(HE_BY_BOX),
                             .needed = HE_WITH(HE_BY_BOX),
                             .doc = "The corner of the box with the smallest coordinates."},
             [SELECT_MAX] = {.name = "max",
                             .type = HE_PARAM_POINT,
                             .with = HE_WITH(HE_BY_BOX),
                             .needed = HE_WITH(HE_BY_BOX),
                             .doc = "The corner of the box with the largest coordinates."},
             [SELECT_POINT] = {.name = "point",
                               .type = HE_PARAM_POINT,
                               .with = HE_WITH(HE_BY_HALF_SPACE),
                               .needed = HE_WITH(HE_BY_HALF_SPACE),
                               .doc = "Any point of the plane that bounds the half-space."},
             [SELECT_NORMAL] =
                 {.name = "normal",
                  .type = HE_PARAM_POINT,
                  .with = HE_WITH(HE_BY_HALF_SPACE) | HE_WITH(HE_BY_CONE),
                  .needed = HE_WITH(HE_BY_HALF_SPACE) | HE_WITH(HE_BY_CONE),
                  .doc =
                      "half_space: the normal of the plane; the elements on the side to which it "
                      "points are found. cone: the axis of the cone. Its length does not "
                      "matter, but must not be zero."},
             [SELECT_TOLERANCE] =
                 {.name = "tolerance",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_DERIVED,
                  .with = HE_WITH(HE_BY_HALF_SPACE),
                  .doc = "Vertices within this distance of the plane count as in the half-space. "
                         "Default: as for plane_split."},
             [SELECT_POLYGON] =
                 {.name = "polygon",
                  .type = HE_PARAM_POLYGON,
                  .with = HE_WITH(HE_BY_LASSO),
                  .needed = HE_WITH(HE_BY_LASSO),
                  .doc = "The corners [x, y] of the lasso in the plane to which the matrix maps, 3 "
                         "to 4096. It may intersect itself: everything it winds around is inside."},
             [SELECT_MATRIX] =
                 {.name = "matrix",
                  .type = HE_PARAM_MATRIX,
                  .flags = HE_PROJECTIVE,
                  .with = HE_WITH(HE_BY_LASSO),
                  .needed = HE_WITH(HE_BY_LASSO),
                  .doc =
                      "16 numbers, row by row, that map a point (x, y, z, 1) to (X, Y, Z, W): it "
                      "is found if W is above 0 and (X / W, Y / W) is inside the polygon. A "
                      "camera's projection times view is such a matrix."},
             [SELECT_CORNERS] = {.name = "corners",
                                 .type = HE_PARAM_CHOICE,
                                 .choices = corners,
                                 .with = PLACED,
                                 .doc =
                                     "Whether all corners of an edge or face must lie inside, or "
                                     "any one of them is enough."},
             [SELECT_MEASURE] =
                 {.name = "measure",
                  .type = HE_PARAM_CHOICE,
                  .choices = measures,
                  .with = HE_WITH(HE_BY_MEASURE),
                  .needed = HE_WITH(HE_BY_MEASURE),
                  .doc =
                      "Faces have an area, a degree (number of corners) and a smallest_angle; "
                      "edges a length and a dihedral angle, below 0 in valleys; vertices an area "
                      "(their share of the surface), a degree (number of edges), an "
                      "angle_defect, a mean_curvature and a gaussian_curvature. Angles are in "
                      "radians."},
             [SELECT_ATTRIBUTE] =
                 {.name = "attribute",
                  .type = HE_PARAM_TEXT,
                  .with = HE_WITH(HE_BY_ATTRIBUTE),
                  .needed = HE_WITH(HE_BY_ATTRIBUTE),
                  .doc = "The name of an attribute of the elements, or `position` for "
                         "vertices. A bool counts "
                         "as 0 or 1, a label as its index."},
             [SELECT_COMPONENT] = {.name = "component",
                                   .type = HE_PARAM_NUMBER,
                                   .flags = HE_RANGE | HE_WHOLE,
                                   .max = HE_COLUMN_COMPONENTS - 1,
                                   .with = HE_WITH(HE_BY_ATTRIBUTE),
                                   .doc = "Which component of the attribute, counted from 0."},
             [SELECT_FROM] = {.name = "from",
                              .type = HE_PARAM_NUMBER,
                              .flags = HE_DERIVED,
                              .with = RANGED,
                              .doc = "The least value. Default: no limit."},
             [SELECT_TO] = {.name = "to",
                            .type = HE_PARAM_NUMBER,
                            .flags = HE_DERIVED,
                            .with = RANGED,
                            .doc = "The largest value. Default: no limit."},
             [SELECT_STEPS] = {.name = "steps",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_RANGE | HE_WHOLE,
                               .min = 1,
                               .max = HE_MAX_ROWS,
                               .fallback = 1,
                               .with = HE_WITH(HE_BY_GROW) | HE_WITH(HE_BY_SHRINK),
                               .doc =
                                   "How often to grow or shrink. A step leads from a vertex along "
                                   "an edge, from an edge or face to those that share a vertex "
                                   "with it."},
             [SELECT_ELEMENTS] = {.name = "elements",
                                  .type = HE_PARAM_CHOICE,
                                  .flags = HE_DERIVED,
                                  .choices = kinds,
                                  .doc = "The kind of the elements to find. Default: for grow and "
                                         "shrink the kind of the list, else faces."},
             [SELECT_MODE] = {.name = "mode",
                              .type = HE_PARAM_CHOICE,
                              .choices = modes,
                              .doc = "only: the elements that the rule finds become the set. add: "
                                     "they are added to it. remove: they are removed from it."},
             [SELECT_INTO] = {.name = "into",
                              .type = HE_PARAM_TEXT,
                              .doc =
                                  "The attribute that gets the set; it is created if it does not "
                                  "exist. Default: `selected`."},
             [SELECT_VALUE] =
                 {.name = "value",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_RANGE | HE_WHOLE | HE_DERIVED,
                  .min = 1,
                  .max = INT32_MAX,
                  .doc = "The attribute is an int, and the set are the elements with this value; "
                         "elements that leave the set get 0. Default: the attribute is a bool."}},
        .results = {[SELECT_OUT_SELECTED] = {"selected", HE_RESULT_NUMBER, HE_FACE,
                                             "How many elements the set now has."},
                    [SELECT_OUT_ADDED] = {"added", HE_RESULT_NUMBER, HE_FACE,
                                          "How many elements joined the set."},
                    [SELECT_OUT_REMOVED] = {"removed", HE_RESULT_NUMBER, HE_FACE,
                                            "How many elements left the set."}},
        .refusals = {HE_BAD_VALUE, HE_NOT_FINITE, HE_LIMIT, HE_NO_SUCH_ATTRIBUTE,
                     HE_ATTRIBUTE_CLASH, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
                     HE_REPEATED_ELEMENT},
        .change = {0, 0, 0},
        .pace = 5,
        .run = run_select,
    },
    {
        .name = "segment",
        .doc =
            "Divide the faces into connected patches, write the number of the patch of each face "
            "into an int attribute, and mark the edges between patches as feature edges. A patch "
            "is a set that other operations take, as {\"patch\":3}.",
        .size = HE_OP_WHOLE,
        .params =
            {[SEGMENT_ANGLE] =
                 {.name = "angle",
                  .type = HE_PARAM_NUMBER,
                  .flags =
                      HE_REQUIRED |
                      HE_RANGE,
                  .group =
                      'a',
                  .max =
                      HE_PI,
                  .unit = HE_RADIANS,
                  .doc =
                      "Patches end at edges at which the normals of the faces differ by more than "
                      "this angle. Edges of this sort inside a patch are marked, "
                      "too."},
             [SEGMENT_PLANES] =
                 {.name = "planes",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_REQUIRED |
                           HE_RANGE | HE_WHOLE,
                  .group = 'a',
                  .min = 1,
                  .max = HE_MAX_ROWS,
                  .doc = "The number of patches, which planes approximate as well as possible "
                         "(variational shape approximation). Every component gets at least one; if "
                         "all patches are flat, there are fewer."},
             [SEGMENT_FEATURES] =
                 {.name = "features",
                  .type = HE_PARAM_CHOICE,
                  .choices = features,
                  .doc =
                      "add: patches also end at edges whose bool attribute `feature` is true, and "
                      "these stay marked. replace: such marks are ignored and replaced. ignore: "
                      "they are neither read nor written."},
             [SEGMENT_INTO] = {.name = "into",
                               .type = HE_PARAM_TEXT,
                               .doc =
                                   "The attribute of faces that gets the numbers of patches, from "
                                   "1; it is created if it does not exist. Default: `patch`."}},
        .results = {[SEGMENT_OUT_PATCHES] = {"patches", HE_RESULT_NUMBER, HE_FACE,
                                             "How many patches there are."},
                    [SEGMENT_OUT_FEATURES] = {"features", HE_RESULT_NUMBER, HE_EDGE,
                                              "How many edges are marked as feature edges "
                                              "afterwards; 0 if features is ignore."},
                    [SEGMENT_OUT_DEVIATION] =
                        {
                            "deviation", HE_RESULT_NUMBER, HE_FACE,
                            "Only for planes: how far the patches are from flat, as the root mean "
                            "square, weighted by "
                            "area, of the distance between the unit normals of a face and of its "
                            "patch."}},
        .refusals = {HE_BAD_VALUE, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_segment,
    },
    {.name = NULL},
};
