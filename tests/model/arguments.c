#include "model/arguments.h"

#include "mesh/walk.h"
#include "model/shapes.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* --- arguments by name --- */

size_t md_index(const md_call *c, const char *name)
{
    for (size_t i = 0; i < HE_OP_PARAMS && c->op->params[i].name != NULL; i++) {
        const he_param *p = &c->op->params[i];
        if (strcmp(p->name, name) == 0 || (p->plural != NULL && strcmp(p->plural, name) == 0)) {
            return i;
        }
    }
    fprintf(stderr, "%s has no parameter %s\n", c->op->name, name);
    assert(!"a parameter of operations.md");
    return 0;
}

const he_arg *md_get(const md_call *c, const char *name)
{
    return &c->args[md_index(c, name)];
}

void md_give_id(md_draft *d, const char *name, uint32_t id)
{
    he_arg *arg = &d->c->args[md_index(d->c, name)];
    arg->given = true;
    arg->id = id;
}

void md_give_number(md_draft *d, const char *name, double number)
{
    he_arg *arg = &d->c->args[md_index(d->c, name)];
    arg->given = true;
    arg->number = number;
}

void md_give_flag(md_draft *d, const char *name, bool flag)
{
    he_arg *arg = &d->c->args[md_index(d->c, name)];
    arg->given = true;
    arg->flag = flag;
}

void md_give_choice(md_draft *d, const char *name, const char *choice)
{
    const size_t i = md_index(d->c, name);
    he_arg *arg = &d->c->args[i];
    arg->given = true;
    for (arg->choice = 0; strcmp(d->c->op->params[i].choices[arg->choice], choice) != 0;
         arg->choice++) {
        assert(d->c->op->params[i].choices[arg->choice + 1] != NULL);
    }
}

void md_give_text(md_draft *d, const char *name, const char *text)
{
    he_arg *arg = &d->c->args[md_index(d->c, name)];
    arg->given = true;
    arg->text = text;
}

void md_give_ids(md_draft *d, const char *name, const uint32_t *ids, uint32_t count, bool list)
{
    size_t i = md_index(d->c, name);
    he_arg *arg = &d->c->args[i];
    assert(count <= MD_LIST);
    memcpy(d->c->ids[i], ids, count * sizeof *ids);
    arg->given = true;
    arg->ids = d->c->ids[i];
    arg->count = count;
    arg->list = list;
    arg->id = ids[0];
}

static he_vec3 point(md_draft *d)
{
    double reach = d->far ? MD_FAR : 2;
    double at[3];
    for (int i = 0; i < 3; i++) {
        at[i] = (md_unit(d->r) * 2 - 1) * reach;
    }
    return (he_vec3){at[0], at[1], at[2]};
}

void md_give_points(md_draft *d, const char *name, uint32_t count, bool list)
{
    size_t i = md_index(d->c, name);
    he_arg *arg = &d->c->args[i];
    for (uint32_t k = 0; k < count; k++) {
        d->c->points[i][k] = point(d);
    }
    arg->given = true;
    arg->points = d->c->points[i];
    arg->count = count;
    arg->list = list;
}

/* --- elements --- */

uint32_t md_live(md_draft *d, he_kind kind)
{
    uint32_t issued = he_mesh_issued(d->m, kind);
    uint32_t start = issued > 0 ? md_below(d->r, issued) : 0;
    for (uint32_t i = 0; i < issued; i++) {
        uint32_t id = (start + i) % issued;
        if (he_mesh_is_live(d->m, kind, id)) {
            return id;
        }
    }
    return issued;
}

static uint32_t busiest(const or_mesh *o)
{
    uint32_t most = 0;
    for (uint32_t v = 0; v < o->vertices; v++) {
        bool more = o->vertex[v].alive && or_degree(o, v) > or_degree(o, most);
        most = more ? v : most;
    }
    return most;
}

uint32_t md_pick(md_draft *d, he_kind kind)
{
    uint32_t issued = he_mesh_issued(d->m, kind);
    if (kind == HE_VERTEX && md_chance(d->r, 8)) {
        return busiest(d->o);
    }
    if (md_chance(d->r, 94)) {
        return md_live(d, kind);
    }
    if (issued > 0 && md_chance(d->r, 60)) {
        return md_below(d->r, issued);
    }
    return md_chance(d->r, 30) ? HE_DEAD - md_below(d->r, 3) : issued + md_below(d->r, 4);
}

uint32_t md_pick_some(md_draft *d, const char *one, const char *many, he_kind kind, uint32_t most)
{
    uint32_t ids[MD_LIST];
    uint32_t count = md_from(d->r, 1, most);
    bool repeats = he_op_declares(d->c->op, HE_REPEATED_ELEMENT) && md_chance(d->r, 10);
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t id = md_pick(d, kind);
        bool twice = false;
        for (uint32_t k = 0; k < n; k++) {
            twice = twice || ids[k] == id;
        }
        if (!twice || repeats) {
            ids[n++] = id;
        }
    }
    if (repeats && n < MD_LIST) {
        ids[n] = ids[0];
        n++;
    }
    bool list = n > 1 || md_chance(d->r, 30);
    md_give_ids(d, list ? many : one, ids, n, list);
    return n;
}

void md_give_plane(md_draft *d)
{
    md_give_points(d, "point", 1, false);
    md_give_points(d, "normal", 1, false);
    he_vec3 *point = d->c->points[md_index(d->c, "point")];
    he_vec3 *normal = d->c->points[md_index(d->c, "normal")];
    if (md_chance(d->r, 40) && or_live_vertices(d->o) > 0) {
        he_vec3 p[3];
        for (int i = 0; i < 3; i++) {
            p[i] = d->o->vertex[md_live(d, HE_VERTEX)].at;
        }
        he_vec3 a = {p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z};
        he_vec3 b = {p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
        he_vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        *point = p[0];
        *normal = n.x * n.x + n.y * n.y + n.z * n.z > 1e-3 ? n : *normal;
    }
    if (md_chance(d->r, 2)) {
        *normal = (he_vec3){0, 0, 0};
    }
}

or_plane md_plane(const md_call *c)
{
    const he_arg *tolerance = md_get(c, "tolerance");
    return (or_plane){.point = md_get(c, "point")->points[0],
                      .normal = md_get(c, "normal")->points[0],
                      .tolerance = tolerance->given ? &tolerance->number : NULL};
}

bool md_is_listed(const he_arg *list, uint32_t id)
{
    bool found = false;
    for (size_t i = 0; i < list->count && !found; i++) {
        found = list->ids[i] == id;
    }
    return found;
}

bool md_covers(const he_arg *list, uint32_t id)
{
    return !list->given || md_is_listed(list, id);
}

uint64_t md_require_all(const or_mesh *o, he_kind kind, const he_arg *arg)
{
    uint64_t refused = 0;
    for (size_t i = 0; i < arg->count; i++) {
        refused |= or_require(o, kind, arg->ids[i]);
        for (size_t k = 0; k < i; k++) {
            refused |= arg->ids[i] == arg->ids[k] ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
        }
    }
    return refused;
}

uint32_t md_boundary_halfedge(md_draft *d)
{
    uint32_t issued = he_mesh_issued(d->m, HE_HALFEDGE);
    uint32_t start = issued > 0 ? md_below(d->r, issued) : 0;
    for (uint32_t i = 0; i < issued; i++) {
        uint32_t h = (start + i) % issued;
        if (he_edge_is_live(d->m, (he_edge){h / 2}) &&
            he_is_boundary_halfedge(d->m, (he_halfedge){h})) {
            return h;
        }
    }
    return md_pick(d, HE_HALFEDGE);
}

uint32_t md_hole(const he_mesh *m, uint32_t h, uint32_t loop[OR_CORNERS])
{
    uint32_t count = 0;
    he_halfedge at = {h};
    do {
        if (count == OR_CORNERS) {
            return 0;
        }
        loop[count++] = he_origin(m, at).i;
        at = he_next(m, at);
    } while (at.i != h);
    return count;
}

bool md_is_live_boundary(const he_mesh *m, uint32_t h)
{
    return h < he_mesh_issued(m, HE_HALFEDGE) && he_mesh_is_live(m, HE_HALFEDGE, h) &&
           he_is_boundary_halfedge(m, (he_halfedge){h});
}

/* --- printing --- */

void md_describe(const md_call *c, char text[MD_CALL_TEXT])
{
    size_t used = (size_t)snprintf(text, MD_CALL_TEXT, "%s", c->op->name);
    for (size_t i = 0; i < HE_OP_PARAMS && c->op->params[i].name != NULL; i++) {
        const he_arg *arg = &c->args[i];
        const he_param *p = &c->op->params[i];
        if (!arg->given || used >= MD_CALL_TEXT) {
            continue;
        }
        char *to = text + used;
        size_t room = MD_CALL_TEXT - used;
        int n = 0;
        switch (p->type) {
        case HE_PARAM_ELEMENT:
            n = snprintf(to, room, " %s=%d", p->name, (int)arg->id);
            break;
        case HE_PARAM_ELEMENTS:
        case HE_PARAM_CYCLE:
            n = snprintf(to, room, " %s=", arg->list && p->plural != NULL ? p->plural : p->name);
            for (size_t k = 0; k < arg->count && used + (size_t)n < MD_CALL_TEXT; k++) {
                n += snprintf(to + n, room - (size_t)n, "%s%u", k > 0 ? "," : "", arg->ids[k]);
            }
            break;
        case HE_PARAM_NUMBER:
            n = snprintf(to, room, " %s=%.17g", p->name, arg->number);
            break;
        case HE_PARAM_POINT:
        case HE_PARAM_POINTS:
            n = snprintf(to, room, " %s=(%zu points)", p->name, arg->count);
            break;
        case HE_PARAM_FLAG:
            n = snprintf(to, room, " %s=%s", p->name, arg->flag ? "true" : "false");
            break;
        case HE_PARAM_CHOICE:
            n = snprintf(to, room, " %s=%s", p->name, p->choices[arg->choice]);
            break;
        case HE_PARAM_POLYGON:
            n = snprintf(to, room, " %s=(%zu corners)", p->name, arg->count);
            break;
        case HE_PARAM_MATRIX:
            n = snprintf(to, room, " %s=(16 numbers)", p->name);
            break;
        case HE_PARAM_TEXT:
            n = snprintf(to, room, " %s=%s", p->name, arg->text);
            break;
        case HE_PARAM_COLOR:
            n = snprintf(to, room, " %s=(%zu numbers)", p->name, arg->count);
            break;
        case HE_PARAM_MESH:
            n = snprintf(to, room, " %s=(%u faces)", p->name, he_mesh_faces(arg->mesh));
            break;
        }
        used += (size_t)n;
    }
}
