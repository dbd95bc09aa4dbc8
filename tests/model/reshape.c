#include "model/reshape.h"

#include "algo/shape.h"
#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "tests/unit/random_meshes.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const md_reshapes[MD_RESHAPES] = {"remesh", "smooth", "hole_fill", "fill_holes",
                                              "deform", "select", "segment",   "deviation"};

/* What is drawn for. */
typedef struct drawing {
    md_reshape *c;
    md_draft d;
    const he_mesh *m;
    md_random *r;
    he_box box;
    double extent; /* the largest extent of the box, at most DBL_MAX; 1 if it is 0 */
} drawing;

/* --- numbers and places --- */

/* Returns a length: the extent of the mesh times 10 to a power from `low` to `high`, or seldom one
 * that has nothing to do with the mesh. */
static double length(drawing *w, double low, double high)
{
    static const double odd[] = {1e308, DBL_MIN, 5e-324, 1e160, 1e-160, 1};
    if (md_chance(w->r, 4)) {
        return odd[md_below(w->r, sizeof odd / sizeof *odd)];
    }
    low = md_chance(w->r, 3) ? -9 : low;
    const double x = w->extent * pow(10, low + (high - low) * md_unit(w->r));
    return x > 0 && isfinite(x) ? x : 1;
}

static double between(drawing *w, double low, double high)
{
    const double t = md_unit(w->r) * 1.5 - 0.25;
    const double x = low * (1 - t) + high * t;
    return isfinite(x) ? x : low;
}

static he_vec3 place(drawing *w)
{
    if (md_chance(w->r, 3)) {
        return (he_vec3){DBL_MAX, -DBL_MAX, -0.0};
    }
    return (he_vec3){between(w, w->box.min.x, w->box.max.x), between(w, w->box.min.y, w->box.max.y),
                     between(w, w->box.min.z, w->box.max.z)};
}

static he_vec3 direction(drawing *w)
{
    return md_chance(w->r, 3)
               ? (he_vec3){0, 0, 0}
               : (he_vec3){md_unit(w->r) * 2 - 1, md_unit(w->r) * 2 - 1, md_unit(w->r) * 2 - 1};
}

static void give_points(drawing *w, const char *name, const he_vec3 *points, uint32_t count)
{
    const size_t i = md_index(&w->c->call, name);
    he_arg *arg = &w->c->call.args[i];
    assert(count <= MD_LIST);
    memcpy(w->c->call.points[i], points, count * sizeof *points);
    arg->given = true;
    arg->points = w->c->call.points[i];
    arg->count = count;
    arg->list = count > 1;
}

static void give_place(drawing *w, const char *name, he_vec3 p)
{
    give_points(w, name, &p, 1);
}

/* Gives a choice that is not the default in seven of ten cases. Returns its index. */
static int give_choice(drawing *w, const char *name)
{
    const size_t i = md_index(&w->c->call, name);
    const he_param *param = &w->c->call.op->params[i];
    uint32_t count = 0;
    while (param->choices[count] != NULL) {
        count++;
    }
    if ((param->flags & HE_REQUIRED) != 0 || md_chance(w->r, 70)) {
        md_give_choice(&w->d, name, param->choices[md_below(w->r, count)]);
    }
    return w->c->call.args[i].choice;
}

/* --- lists --- */

/* Returns about `percent` percent of the live elements of a kind, with seldom one too many. */
static uint32_t *draw_ids(drawing *w, he_kind kind, double percent, size_t *count)
{
    const uint32_t issued = he_mesh_issued(w->m, kind);
    uint32_t *ids = malloc(((size_t)issued + 2) * sizeof *ids);
    assert(ids != NULL);
    *count = 0;
    for (uint32_t i = 0; i < issued; i++) {
        if (he_mesh_is_live(w->m, kind, i) && md_unit(w->r) * 100 < percent) {
            ids[(*count)++] = i;
        }
    }
    if (md_chance(w->r, 3)) {
        ids[*count] = md_chance(w->r, 50) && *count > 0 ? ids[0] : md_below(w->r, issued + 2);
        (*count)++;
    }
    return ids;
}

static void give_ids(drawing *w, const char *name, uint32_t *takes, size_t count)
{
    he_arg *arg = &w->c->call.args[md_index(&w->c->call, name)];
    const size_t slot = w->c->list[0] == NULL ? 0 : 1;
    assert(w->c->list[slot] == NULL);
    w->c->list[slot] = takes;
    arg->given = true;
    arg->list = true;
    arg->ids = takes;
    arg->count = count;
    arg->id = count > 0 ? takes[0] : 0;
}

static void give_some(drawing *w, const char *name, he_kind kind, double percent)
{
    size_t count = 0;
    uint32_t *ids = draw_ids(w, kind, percent, &count);
    give_ids(w, name, ids, count);
}

/* --- the operations --- */

/* Returns about how many triangles with sides of this length cover the surface: so many as have its
 * area, and as many as fit along each edge of a face that is lower than the length. */
static double covering(drawing *w, double side)
{
    double sum = 0;
    for (uint32_t e = 0; e < he_mesh_issued(w->m, HE_EDGE); e++) {
        sum += he_mesh_is_live(w->m, HE_EDGE, e) ? he_edge_length(w->m, (he_edge){e}) / side : 0;
    }
    for (uint32_t f = 0; f < he_mesh_issued(w->m, HE_FACE); f++) {
        sum += he_mesh_is_live(w->m, HE_FACE, f)
                   ? he_face_area(w->m, (he_face){f}) / side / side / 0.433
                   : 0;
    }
    return sum;
}

/* Returns a length with which the surface does not get too many faces for a test, or seldom one
 * that must be refused. */
static double even_length(drawing *w)
{
    const double most = md_from(w->r, 20, 4000);
    double side = w->extent;
    if (md_chance(w->r, 3)) {
        return w->extent * 1e-9;
    }
    while (side > DBL_MIN && covering(w, side / 1.5) < most) {
        side /= 1.5;
    }
    return side;
}

static void draw_remesh(drawing *w)
{
    switch (md_below(w->r, 3)) {
    case 0:
        md_give_number(&w->d, "edge_length", md_chance(w->r, 3) ? -1 : even_length(w));
        break;
    case 1:
        md_give_number(&w->d, "target_faces", md_from(w->r, 1, 3000));
        break;
    default:
        md_give_number(&w->d, "error", length(w, -3, -1.5));
        md_give_number(&w->d, "min_length", even_length(w));
        if (md_chance(w->r, 50)) {
            md_give_number(&w->d, "max_length", length(w, -1.5, 0));
        }
        break;
    }
    md_give_number(&w->d, "steps", md_from(w->r, 1, 4));
    if (md_chance(w->r, 30)) {
        md_give_number(&w->d, "crease", md_unit(w->r) * 3.14);
    }
    md_give_flag(&w->d, "keep_boundary", md_chance(w->r, 20));
    md_give_flag(&w->d, "keep_seams", md_chance(w->r, 50));
    md_give_flag(&w->d, "project", md_chance(w->r, 80));
    if (md_chance(w->r, 30)) {
        give_some(w, "faces", HE_FACE, 100 * md_unit(w->r));
    }
}

static void draw_smooth(drawing *w)
{
    const bool laplacian = give_choice(w, "method") == 0;
    md_give_number(&w->d, "steps", md_from(w->r, 1, 4));
    if (laplacian && md_chance(w->r, 60)) {
        const double x = length(w, -3, 0);
        md_give_number(&w->d, "time", isfinite(x * x) ? x * x : x);
    }
    md_give_flag(&w->d, "keep_volume", md_chance(w->r, 20));
    if (md_chance(w->r, 30)) {
        give_some(w, "vertices", HE_VERTEX, 100 * md_unit(w->r));
    }
}

static void draw_filling(drawing *w)
{
    static const char *const names[] = {"polygon", "fan", "triangulate"};
    if (md_chance(w->r, 20)) {
        md_give_choice(&w->d, "method", names[md_below(w->r, 3)]);
        return;
    }
    md_give_choice(&w->d, "method", "smooth");
    md_give_number(&w->d, "continuity", md_below(w->r, 3));
    if (md_chance(w->r, 40)) {
        md_give_number(&w->d, "edge_length", length(w, -1.5, 0));
    }
}

static void draw_hole_fill(drawing *w)
{
    const uint32_t issued = 2 * he_mesh_issued(w->m, HE_EDGE);
    const uint32_t first = issued > 0 ? md_below(w->r, issued) : 0;
    uint32_t h = first;
    for (uint32_t i = 0; i < issued && !md_is_live_boundary(w->m, h); i++) {
        h = (first + i) % issued;
    }
    md_give_id(&w->d, "halfedge", md_chance(w->r, 97) ? h : first);
    draw_filling(w);
}

static void draw_fill_holes(drawing *w)
{
    draw_filling(w);
    if (md_chance(w->r, 30)) {
        md_give_number(&w->d, "max_edges", md_from(w->r, 3, 40));
    }
    if (md_chance(w->r, 20)) {
        md_give_number(&w->d, "max_size", length(w, -1, 0));
    }
}

static void draw_goal(drawing *w, size_t handles)
{
    he_vec3 points[MD_LIST];
    if (md_chance(w->r, 30)) {
        const double a = 6.283185307179586 * md_unit(w->r);
        const he_vec3 by = he_vec3_scale(direction(w), w->extent / 2);
        const double matrix[16] = {cos(a), -sin(a), 0, by.x, sin(a), cos(a), 0, by.y,
                                   0,      0,       1, by.z, 0,      0,      0, 1};
        he_arg *arg = &w->c->call.args[md_index(&w->c->call, "matrix")];
        arg->given = true;
        memcpy(arg->matrix, matrix, sizeof matrix);
        return;
    }
    const bool to = md_chance(w->r, 40);
    const uint32_t count = handles > 0 && handles <= MD_LIST ? (uint32_t)handles : 1;
    for (uint32_t i = 0; i < count; i++) {
        points[i] =
            to || md_chance(w->r, 3) ? place(w) : he_vec3_scale(direction(w), w->extent / 2);
    }
    give_points(w, to ? "to" : "by", points, count);
}

static void draw_deform(drawing *w)
{
    const uint32_t count = he_mesh_vertices(w->m) > 0 ? he_mesh_vertices(w->m) : 1;
    size_t handles = 0, fixed = 0;
    if (give_choice(w, "method") == 0) {
        md_give_number(&w->d, "steps", md_from(w->r, 1, 4));
    }
    uint32_t *moved =
        draw_ids(w, HE_VERTEX, md_chance(w->r, 50) ? 400.0 / count : 15 * md_unit(w->r), &handles);
    give_ids(w, "vertices", moved, handles);
    draw_goal(w, handles);
    if (md_chance(w->r, 60)) {
        uint32_t *still = draw_ids(w, HE_VERTEX, 30 * md_unit(w->r), &fixed);
        size_t kept = 0;
        for (size_t i = 0, k = 0; i < fixed; i++) {
            while (k < handles && moved[k] < still[i]) {
                k++;
            }
            if (k == handles || moved[k] != still[i] || md_chance(w->r, 1)) {
                still[kept++] = still[i];
            }
        }
        give_ids(w, "fixed", still, kept);
    }
}

static void draw_by_place(drawing *w, const char *rule)
{
    if (strcmp(rule, "box") == 0) {
        const he_vec3 a = place(w), b = place(w);
        give_place(w, "min", (he_vec3){fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)});
        give_place(w, "max", (he_vec3){fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)});
    } else if (strcmp(rule, "half_space") == 0) {
        give_place(w, "point", place(w));
        give_place(w, "normal", direction(w));
        if (md_chance(w->r, 30)) {
            md_give_number(&w->d, "tolerance", length(w, -3, -1));
        }
    } else {
        he_vec3 polygon[MD_LIST];
        const uint32_t corners = md_from(w->r, 3, MD_LIST);
        const double size = 1 / w->extent;
        const double matrix[16] = {size, 0, 0, md_unit(w->r) - 0.5, 0, size, 0, 0, 0, 0, 1, 0, 0,
                                   0,    0, 1};
        he_arg *arg = &w->c->call.args[md_index(&w->c->call, "matrix")];
        arg->given = true;
        memcpy(arg->matrix, matrix, sizeof matrix);
        for (uint32_t i = 0; i < corners; i++) {
            polygon[i] = (he_vec3){2 * md_unit(w->r) - 1, 2 * md_unit(w->r) - 1, 0};
        }
        give_points(w, "polygon", polygon, corners);
    }
    (void)give_choice(w, "corners");
}

static void draw_by_value(drawing *w, const char *rule)
{
    if (strcmp(rule, "measure") == 0) {
        const size_t i = md_index(&w->c->call, "measure");
        const char *const *names = w->c->call.op->params[i].choices;
        md_give_choice(&w->d, "measure", names[md_below(w->r, 8)]);
    } else {
        static const char *const names[] = {"position", "number", "locked", "feature", "selected"};
        md_give_text(&w->d, "attribute", names[md_below(w->r, 5)]);
        md_give_number(&w->d, "component", md_below(w->r, 3));
    }
    const double x = length(w, -4, 0), y = length(w, -3, 1);
    if (md_chance(w->r, 70)) {
        md_give_number(&w->d, "from", fmin(x, y) - md_below(w->r, 2));
    }
    if (md_chance(w->r, 70)) {
        md_give_number(&w->d, "to", fmax(x, y));
    }
}

/* Gives seeds as the rules grow, shrink and component take them. */
static void give_seeds(drawing *w)
{
    static const struct {
        const char *name;
        he_kind kind;
    } lists[] = {{"faces", HE_FACE}, {"edges", HE_EDGE}, {"vertices", HE_VERTEX}};
    const size_t i = md_below(w->r, 3);
    give_some(w, lists[i].name, lists[i].kind, 60 * md_unit(w->r));
}

static void draw_select(drawing *w)
{
    const size_t by = md_index(&w->c->call, "by");
    const char *rule = w->c->call.op->params[by].choices[give_choice(w, "by")];
    if (strcmp(rule, "region") == 0) {
        give_some(w, "faces", HE_FACE, 3);
        md_give_number(&w->d, "angle", md_unit(w->r) * 2);
        md_give_flag(&w->d, "cross_features", md_chance(w->r, 30));
    } else if (strcmp(rule, "component") == 0) {
        give_seeds(w);
    } else if (strcmp(rule, "grow") == 0 || strcmp(rule, "shrink") == 0) {
        give_seeds(w);
        md_give_number(&w->d, "steps", md_from(w->r, 1, 5));
    } else if (strcmp(rule, "boundary") == 0) {
        if (md_chance(w->r, 60)) {
            give_some(w, "faces", HE_FACE, 50);
        }
    } else if (strcmp(rule, "cone") == 0) {
        give_place(w, "normal", direction(w));
        md_give_number(&w->d, "angle", md_unit(w->r) * 3);
    } else if (strcmp(rule, "measure") == 0 || strcmp(rule, "attribute") == 0) {
        draw_by_value(w, rule);
    } else {
        draw_by_place(w, rule);
    }
    (void)give_choice(w, "elements");
    (void)give_choice(w, "mode");
    if (md_chance(w->r, 30)) {
        md_give_number(&w->d, "value", md_from(w->r, 1, 9));
        md_give_text(&w->d, "into", "number of set");
    }
}

static void draw_segment(drawing *w)
{
    if (md_chance(w->r, 60)) {
        md_give_number(&w->d, "angle", md_unit(w->r) * 3);
    } else {
        md_give_number(&w->d, "planes", md_from(w->r, 1, 12));
    }
    (void)give_choice(w, "features");
    if (md_chance(w->r, 20)) {
        md_give_text(&w->d, "into", "number");
    }
}

/* The other mesh is one like it, or one that has nothing to do with it. */
static void draw_deviation(drawing *w)
{
    if (md_chance(w->r, 5)) {
        w->c->other = he_mesh_new();
    } else if (md_chance(w->r, 60)) {
        if (he_mesh_copy(w->m, &w->c->other, NULL) != HE_OK) {
            abort();
        }
        random_shake(w->c->other, w->r, w->extent * pow(10, -1 - 3 * md_unit(w->r)));
    } else {
        w->c->other = random_families[md_below(w->r, RANDOM_FAMILIES)].make(w->r);
    }
    he_arg *with = &w->c->call.args[md_index(&w->c->call, "with")];
    with->given = true;
    with->mesh = w->c->other;
    if (md_chance(w->r, 20)) {
        md_give_text(&w->d, "attribute", md_chance(w->r, 50) ? "number" : "how far");
    }
}

void md_reshape_draw(md_reshape *c, size_t which, const he_mesh *m, md_random *r)
{
    static void (*const draw[MD_RESHAPES])(drawing *) = {
        draw_remesh, draw_smooth, draw_hole_fill, draw_fill_holes,
        draw_deform, draw_select, draw_segment,   draw_deviation};
    *c = (md_reshape){.other = NULL};
    c->call.op = he_op_find(md_reshapes[which], strlen(md_reshapes[which]));
    assert(c->call.op != NULL);
    he_op_defaults(c->call.op, c->call.args);
    drawing w = {.c = c, .d = {.c = &c->call, .m = m, .r = r}, .m = m, .r = r};
    if (!he_surface_box(m, &w.box)) {
        w.box = (he_box){{0, 0, 0}, {0, 0, 0}};
    }
    const he_vec3 half = he_vec3_sub(he_vec3_scale(w.box.max, 0.5), he_vec3_scale(w.box.min, 0.5));
    w.extent = fmin(2 * he_vec3_extent(half), DBL_MAX);
    w.extent = w.extent > 0 ? w.extent : 1;
    draw[which](&w);
}

void md_reshape_clear(md_reshape *c)
{
    free(c->list[0]);
    free(c->list[1]);
    he_mesh_free(c->other);
}
