#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Angles and lengths that differ by less, relatively, are decided by rounding. */
static const long double VAGUE = 1e-6L;
static const long double PI = 3.14159265358979323846264338327950288L;

typedef struct vec {
    long double x, y, z;
} vec;

static vec vec_of(he_vec3 p)
{
    return (vec){p.x, p.y, p.z};
}
static vec minus(vec a, vec b)
{
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static vec plus(vec a, vec b, long double s)
{
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
static vec cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static long double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static long double length(vec a)
{
    return sqrtl(dot(a, a));
}
static long double angle_between(vec a, vec b)
{
    return atan2l(length(cross(a, b)), dot(a, b));
}

/* --- lists --- */

static uint32_t rows_of(const or_mesh *o, he_kind kind)
{
    return kind == HE_VERTEX ? o->vertices : kind == HE_EDGE ? o->edges : o->faces;
}

static bool is_live(const or_mesh *o, he_kind kind, uint32_t id)
{
    return kind == HE_VERTEX ? o->vertex[id].alive
           : kind == HE_EDGE ? o->edge[id].alive
                             : o->face[id].alive;
}

/* Returns the vertices of an element, and their number. */
static uint32_t corners_of(const or_mesh *o, he_kind kind, uint32_t id, const uint32_t **out,
                           uint32_t own[2])
{
    if (kind == HE_FACE) {
        *out = o->face[id].v;
        return o->face[id].count;
    }
    own[0] = kind == HE_VERTEX ? id : o->edge[id].a;
    own[1] = kind == HE_VERTEX ? id : o->edge[id].b;
    *out = own;
    return kind == HE_VERTEX ? 1 : 2;
}

/* --- normals --- */

typedef struct normal {
    vec n;      /* of length 1 */
    bool vague; /* the direction is that of rounding errors */
} normal;

static normal normal_of_face(const or_mesh *o, uint32_t f)
{
    const or_face *face = &o->face[f];
    vec sum = {0, 0, 0}, origin = vec_of(o->vertex[face->v[0]].at);
    long double size = 0;
    for (uint32_t i = 1; i + 1 < face->count; i++) {
        vec a = minus(vec_of(o->vertex[face->v[i]].at), origin);
        vec b = minus(vec_of(o->vertex[face->v[i + 1]].at), origin);
        sum = plus(sum, cross(a, b), 1);
        size = fmaxl(size, fmaxl(dot(a, a), dot(b, b)));
    }
    const long double all = length(sum);
    return all <= VAGUE * size ? (normal){{0, 0, 0}, true}
                               : (normal){plus((vec){0, 0, 0}, sum, 1 / all), false};
}

/* Returns the mean of some normals; the mean is vague if they nearly cancel each other out. */
static normal mean(vec sum, bool vague)
{
    const long double all = length(sum);
    return vague || all < VAGUE ? (normal){{0, 0, 0}, true}
                                : (normal){plus((vec){0, 0, 0}, sum, 1 / all), false};
}

static long double corner_angle(const or_mesh *o, const or_face *face, uint32_t i)
{
    vec at = vec_of(o->vertex[face->v[i]].at);
    vec a = minus(vec_of(o->vertex[face->v[(i + 1) % face->count]].at), at);
    vec b = minus(vec_of(o->vertex[face->v[(i + face->count - 1) % face->count]].at), at);
    return length(a) > 0 && length(b) > 0 ? angle_between(a, b) : 0;
}

static normal normal_of(const or_mesh *o, he_kind kind, uint32_t id)
{
    vec sum = {0, 0, 0};
    bool vague = false;
    if (kind == HE_FACE) {
        return normal_of_face(o, id);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        if (!o->face[f].alive) {
            continue;
        }
        uint32_t i = or_place(&o->face[f], kind == HE_VERTEX ? id : o->edge[id].a);
        bool at =
            i != OR_NONE && (kind == HE_VERTEX || o->left[o->edge[id].a][o->edge[id].b] == f ||
                             o->left[o->edge[id].b][o->edge[id].a] == f);
        if (at) {
            normal n = normal_of_face(o, f);
            vague = vague || n.vague;
            sum = plus(sum, n.n, kind == HE_VERTEX ? corner_angle(o, &o->face[f], i) : 1);
        }
    }
    return mean(sum, vague);
}

static or_verdict within(long double value, long double most)
{
    return value <= most - VAGUE ? OR_YES : value >= most + VAGUE ? OR_NO : OR_EITHER;
}

/* --- regions and components: spread until nothing changes --- */

static or_verdict least(or_verdict a, or_verdict b)
{
    return a < b ? a : b;
}

/* Returns whether a region crosses the edge e. */
static or_verdict crosses(const or_mesh *o, const or_rule *rule, uint32_t e, const normal *normals)
{
    const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
    const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
    if (f == OR_NONE || g == OR_NONE || (o->edge[e].feature && !rule->cross_features)) {
        return OR_NO;
    }
    if (normals[f].vague || normals[g].vague) {
        return OR_EITHER;
    }
    return within(angle_between(normals[f].n, normals[g].n), rule->angle);
}

static void spread_region(const or_mesh *o, const or_rule *rule, or_verdict face[OR_ROWS])
{
    normal *normals = calloc(o->faces + 1, sizeof *normals);
    or_verdict *open = calloc(o->edges + 1, sizeof *open);
    assert(normals != NULL && open != NULL);
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive) {
            normals[f] = normal_of_face(o, f);
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        open[e] = o->edge[e].alive ? crosses(o, rule, e, normals) : OR_NO;
    }
    for (uint32_t i = 0; i < rule->seed_count; i++) {
        face[rule->seeds[i]] = OR_YES;
    }
    for (bool again = true; again;) {
        again = false;
        for (uint32_t e = 0; e < o->edges; e++) {
            if (open[e] == OR_NO) {
                continue;
            }
            const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
            const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
            const or_verdict to_g = least(face[f], open[e]), to_f = least(face[g], open[e]);
            if (to_g > face[g]) {
                face[g] = to_g;
                again = true;
            }
            if (to_f > face[f]) {
                face[f] = to_f;
                again = true;
            }
        }
    }
    free(open);
    free(normals);
}

static void spread_component(const or_mesh *o, const or_rule *rule, or_verdict vertex[OR_ROWS])
{
    for (uint32_t i = 0; i < rule->seed_count; i++) {
        const uint32_t *v;
        uint32_t own[2];
        (void)corners_of(o, rule->seed_kind, rule->seeds[i], &v, own);
        vertex[v[0]] = OR_YES;
    }
    for (bool again = true; again;) {
        again = false;
        for (uint32_t e = 0; e < o->edges; e++) {
            const uint32_t a = o->edge[e].a, b = o->edge[e].b;
            if (o->edge[e].alive && vertex[a] != vertex[b]) {
                vertex[a] = vertex[b] = OR_YES;
                again = true;
            }
        }
    }
}

/* --- from one kind to another --- */

static or_verdict most(or_verdict a, or_verdict b)
{
    return a > b ? a : b;
}

static bool is_corner(const or_mesh *o, uint32_t f, he_kind kind, uint32_t id)
{
    if (kind == HE_VERTEX) {
        return or_place(&o->face[f], id) != OR_NONE;
    }
    return kind == HE_EDGE ? o->left[o->edge[id].a][o->edge[id].b] == f ||
                                 o->left[o->edge[id].b][o->edge[id].a] == f
                           : id == f;
}

static void from_faces(const or_mesh *o, const or_rule *rule, const or_verdict face[OR_ROWS],
                       or_verdict verdict[OR_ROWS])
{
    for (uint32_t id = 0; id < rows_of(o, rule->of); id++) {
        for (uint32_t f = 0; is_live(o, rule->of, id) && f < o->faces; f++) {
            if (o->face[f].alive && is_corner(o, f, rule->of, id)) {
                verdict[id] = most(verdict[id], face[f]);
            }
        }
    }
}

static void from_vertices(const or_mesh *o, const or_rule *rule, const or_verdict vertex[OR_ROWS],
                          bool any, or_verdict verdict[OR_ROWS])
{
    for (uint32_t id = 0; id < rows_of(o, rule->of); id++) {
        if (!is_live(o, rule->of, id)) {
            continue;
        }
        const uint32_t *v;
        uint32_t own[2], count = corners_of(o, rule->of, id, &v, own);
        verdict[id] = any ? OR_NO : OR_YES;
        for (uint32_t i = 0; i < count; i++) {
            verdict[id] = any ? most(verdict[id], vertex[v[i]]) : least(verdict[id], vertex[v[i]]);
        }
    }
}

/* --- places --- */

static or_verdict in_box(const or_rule *rule, he_vec3 p)
{
    return p.x >= rule->low.x && p.x <= rule->high.x && p.y >= rule->low.y && p.y <= rule->high.y &&
                   p.z >= rule->low.z && p.z <= rule->high.z
               ? OR_YES
               : OR_NO;
}

/* Returns whether a point is on the upper side of the plane. hedge's default tolerance is between 0
 * and `slack`; rounding errors are smaller, too. */
static or_verdict in_half_space(const or_rule *rule, he_vec3 p, long double slack)
{
    vec n = vec_of(rule->plane.normal);
    const long double d = dot(minus(vec_of(p), vec_of(rule->plane.point)), n) / length(n);
    const double *tolerance = rule->plane.tolerance;
    const long double border = tolerance != NULL ? -*tolerance : 0;
    return d >= border + (tolerance != NULL ? slack : 0) ? OR_YES
           : d < border - slack                          ? OR_NO
                                                         : OR_EITHER;
}

/* Adds up the angles by which the polygon turns as seen from the point; at a distance of nearly 0
 * from a side rounding decides. */
static or_verdict in_lasso(const or_rule *rule, he_vec3 p)
{
    const double *m = rule->matrix;
    long double at[4], turn = 0, nearest = HUGE_VALL, size = 0;
    for (int i = 0; i < 4; i++) {
        at[i] = (long double)m[4 * i] * p.x + (long double)m[4 * i + 1] * p.y +
                (long double)m[4 * i + 2] * p.z + m[4 * i + 3];
    }
    if (at[3] <= 0) {
        return at[3] > -VAGUE ? OR_EITHER : OR_NO;
    }
    const vec q = {at[0] / at[3], at[1] / at[3], 0};
    for (uint32_t i = 0; i < rule->polygon_count; i++) {
        vec a = minus(vec_of(rule->polygon[i]), q);
        vec b = minus(vec_of(rule->polygon[(i + 1) % rule->polygon_count]), q);
        const vec ab = minus(b, a);
        const long double along = dot(ab, ab) > 0 ? -dot(a, ab) / dot(ab, ab) : 0;
        const long double t = fminl(1, fmaxl(0, along));
        nearest = fminl(nearest, length(plus(a, ab, t)));
        size = fmaxl(size, length(a));
        turn += atan2l(a.x * b.y - a.y * b.x, dot(a, b));
    }
    return nearest <= VAGUE * (size + 1) || at[3] < VAGUE ? OR_EITHER
           : fabsl(turn) > PI                             ? OR_YES
                                                          : OR_NO;
}

static long double size_of(const or_mesh *o, const or_rule *rule)
{
    vec at = vec_of(rule->plane.point);
    long double size = fabsl(at.x) + fabsl(at.y) + fabsl(at.z);
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive) {
            vec p = vec_of(o->vertex[v].at);
            size = fmaxl(size, fabsl(p.x) + fabsl(p.y) + fabsl(p.z));
        }
    }
    return size;
}

static void by_place(const or_mesh *o, const or_rule *rule, or_verdict vertex[OR_ROWS])
{
    const long double slack = 1e-8L * size_of(o, rule);
    for (uint32_t v = 0; v < o->vertices; v++) {
        const he_vec3 p = o->vertex[v].at;
        if (o->vertex[v].alive) {
            vertex[v] = strcmp(rule->by, "box") == 0     ? in_box(rule, p)
                        : strcmp(rule->by, "lasso") == 0 ? in_lasso(rule, p)
                                                         : in_half_space(rule, p, slack);
        }
    }
}

/* --- values --- */

/* Measures an element; `*vague` says that the value may be undefined. */
static long double measure(const or_mesh *o, const or_rule *rule, uint32_t id, bool *vague)
{
    const char *what = rule->measure;
    if (strcmp(what, "degree") == 0) {
        return rule->of == HE_FACE ? o->face[id].count : or_degree(o, id);
    }
    if (strcmp(what, "length") == 0) {
        return length(
            minus(vec_of(o->vertex[o->edge[id].b].at), vec_of(o->vertex[o->edge[id].a].at)));
    }
    if (strcmp(what, "smallest_angle") == 0) {
        long double angle = PI;
        for (uint32_t i = 0; i < o->face[id].count; i++) {
            angle = fminl(angle, corner_angle(o, &o->face[id], i));
        }
        return angle;
    }
    if (strcmp(what, "area") == 0 && rule->of == HE_FACE) {
        const or_face *face = &o->face[id];
        vec sum = {0, 0, 0}, origin = vec_of(o->vertex[face->v[0]].at);
        for (uint32_t i = 1; i + 1 < face->count; i++) {
            sum = plus(sum,
                       cross(minus(vec_of(o->vertex[face->v[i]].at), origin),
                             minus(vec_of(o->vertex[face->v[i + 1]].at), origin)),
                       0.5L);
        }
        return length(sum);
    }
    if (strcmp(what, "dihedral") == 0) {
        const uint32_t a = o->edge[id].a, b = o->edge[id].b;
        if (o->left[a][b] == OR_NONE || o->left[b][a] == OR_NONE) {
            return NAN;
        }
        const normal f = normal_of_face(o, o->left[a][b]), g = normal_of_face(o, o->left[b][a]);
        const vec d = minus(vec_of(o->vertex[b].at), vec_of(o->vertex[a].at));
        const long double along = length(d) > 0 ? dot(cross(f.n, g.n), d) / length(d) : 0;
        const long double angle = atan2l(along, dot(f.n, g.n));
        *vague = f.vague || g.vague || length(d) == 0 || fabsl(angle) > PI - VAGUE;
        return angle;
    }
    *vague = true; /* the curvatures, which depend on how polygons are cut into triangles */
    return 0;
}

static or_verdict in_range(const or_rule *rule, long double value, bool exact)
{
    if (isnan(value)) {
        return OR_NO;
    }
    const long double near = exact ? 0 : VAGUE * (1 + fabsl(value));
    if (value >= rule->from + near && value <= rule->to - near) {
        return OR_YES;
    }
    return value < rule->from - near || value > rule->to + near ? OR_NO : OR_EITHER;
}

static void by_value(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS])
{
    const bool exact = rule->values != NULL || strcmp(rule->measure, "degree") == 0;
    for (uint32_t id = 0; id < rows_of(o, rule->of); id++) {
        if (is_live(o, rule->of, id)) {
            bool vague = false;
            const long double value =
                rule->values != NULL ? rule->values[id] : measure(o, rule, id, &vague);
            verdict[id] = vague ? OR_EITHER : in_range(rule, value, exact);
        }
    }
}

static void by_cone(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS])
{
    for (uint32_t id = 0; id < rows_of(o, rule->of); id++) {
        if (is_live(o, rule->of, id)) {
            const normal n = normal_of(o, rule->of, id);
            verdict[id] =
                n.vague ? OR_EITHER : within(angle_between(n.n, vec_of(rule->normal)), rule->angle);
        }
    }
}

/* --- neighbours --- */

/* Returns whether two elements of one kind are neighbours: two vertices of one edge, or edges or
 * faces with a vertex in common. */
static bool touch(const or_mesh *o, he_kind kind, uint32_t x, uint32_t y)
{
    const uint32_t *v, *w;
    uint32_t own_v[2], own_w[2];
    if (kind == HE_VERTEX) {
        return o->joined[x][y] != OR_NONE;
    }
    const uint32_t n = corners_of(o, kind, x, &v, own_v), m = corners_of(o, kind, y, &w, own_w);
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = 0; k < m; k++) {
            if (v[i] == w[k]) {
                return true;
            }
        }
    }
    return false;
}

/* In each step every element that is not in the set (to grow), or is in it (to shrink), looks for a
 * neighbour of the other sort. The search ends when a step changes nothing. */
static void by_steps(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS])
{
    const bool grows = strcmp(rule->by, "grow") == 0;
    const uint32_t rows = rows_of(o, rule->of);
    or_verdict *before = calloc(rows + 1, sizeof *before);
    assert(before != NULL);
    for (uint32_t i = 0; i < rule->seed_count; i++) {
        verdict[rule->seeds[i]] = OR_YES;
    }
    bool again = true;
    for (uint32_t step = 0; step < rule->steps && again; step++) {
        memcpy(before, verdict, rows * sizeof *before);
        again = false;
        for (uint32_t x = 0; x < rows; x++) {
            if (!is_live(o, rule->of, x) || (before[x] == OR_YES) == grows) {
                continue;
            }
            for (uint32_t y = 0; y < rows && verdict[x] == before[x]; y++) {
                if (is_live(o, rule->of, y) && before[y] != before[x] && touch(o, rule->of, x, y)) {
                    verdict[x] = before[y];
                    again = true;
                }
            }
        }
    }
    free(before);
}

static void by_boundary(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS])
{
    bool *in = calloc(o->faces + 1, sizeof *in);
    assert(in != NULL);
    for (uint32_t f = 0; f < o->faces; f++) {
        in[f] = !rule->seeded;
        for (uint32_t i = 0; i < rule->seed_count; i++) {
            in[f] = in[f] || rule->seeds[i] == f;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const uint32_t a = o->edge[e].a, b = o->edge[e].b;
        if (!o->edge[e].alive) {
            continue;
        }
        const uint32_t f = o->left[a][b], g = o->left[b][a];
        const bool on_f = f != OR_NONE && in[f], on_g = g != OR_NONE && in[g];
        if (on_f == on_g) {
            continue;
        }
        if (rule->of == HE_VERTEX) {
            verdict[a] = verdict[b] = OR_YES;
        } else {
            verdict[rule->of == HE_EDGE ? e : on_f ? f : g] = OR_YES;
        }
    }
    free(in);
}

or_verdict or_is_smooth(const or_mesh *o, uint32_t e, double angle)
{
    const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
    const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
    if (f == OR_NONE || g == OR_NONE) {
        return OR_NO;
    }
    const normal a = normal_of_face(o, f), b = normal_of_face(o, g);
    return a.vague || b.vague ? OR_EITHER : within(angle_between(a.n, b.n), angle);
}

void or_select(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS])
{
    or_verdict *first = calloc(OR_ROWS, sizeof *first);
    assert(first != NULL);
    memset(verdict, 0, OR_ROWS * sizeof *verdict);
    const char *by = rule->by;
    if (strcmp(by, "region") == 0) {
        spread_region(o, rule, first);
        from_faces(o, rule, first, verdict);
    } else if (strcmp(by, "component") == 0) {
        spread_component(o, rule, first);
        from_vertices(o, rule, first, true, verdict);
    } else if (strcmp(by, "box") == 0 || strcmp(by, "lasso") == 0 ||
               strcmp(by, "half_space") == 0) {
        by_place(o, rule, first);
        from_vertices(o, rule, first, rule->any_corner, verdict);
    } else if (strcmp(by, "cone") == 0) {
        by_cone(o, rule, verdict);
    } else if (strcmp(by, "measure") == 0 || strcmp(by, "attribute") == 0) {
        by_value(o, rule, verdict);
    } else if (strcmp(by, "boundary") == 0) {
        by_boundary(o, rule, verdict);
    } else {
        by_steps(o, rule, verdict);
    }
    free(first);
}
