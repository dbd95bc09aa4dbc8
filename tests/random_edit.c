#include "tests/random_edit.h"

#include "op/op.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef struct draft {
    md_random *random;
    const mirror *mesh;
    uint32_t halfedge; /* the arguments of the edit are chosen near this half-edge */
    char *text;
    size_t length;
} draft;

static void put(draft *d, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(draft *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(d->text + d->length, RANDOM_EDIT_TEXT - d->length, format, arguments);
    va_end(arguments);
    assert_true(n >= 0 && d->length + (size_t)n < RANDOM_EDIT_TEXT);
    d->length += (size_t)n;
}

enum link { NEXT, PREV, ORIGIN, FACE };

static uint32_t link_of(const draft *d, uint32_t halfedge, enum link which)
{
    return d->mesh->tables[HE_HALFEDGE].rows[halfedge].link[which];
}

/* Returns a half-edge a few random steps, across faces and edges, from the half-edge of the
 * draft. */
static uint32_t near_halfedge(draft *d)
{
    uint32_t h = d->halfedge;
    for (uint32_t steps = md_below(d->random, 4); steps > 0; steps--) {
        uint32_t way = md_below(d->random, 3);
        h = way == 0 ? h ^ 1 : link_of(d, h, way == 1 ? NEXT : PREV);
    }
    return h;
}

static uint32_t any(draft *d, he_kind kind)
{
    return mirror_live(d->mesh, kind, (uint32_t)(md_bits(d->random) >> 33));
}

static uint32_t element(draft *d, he_kind kind)
{
    uint32_t h = near_halfedge(d);
    if (md_chance(d->random, 5)) {
        h = any(d, HE_HALFEDGE);
    }
    switch (kind) {
    case HE_VERTEX:
        return md_chance(d->random, 5) ? any(d, kind) : link_of(d, h, ORIGIN);
    case HE_HALFEDGE:
        return h;
    case HE_EDGE:
        return h / 2;
    case HE_FACE:
        return link_of(d, h, FACE) == HE_NONE ? link_of(d, h ^ 1, FACE) : link_of(d, h, FACE);
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    fail();
    return HE_NONE;
}

/* Writes `count` consecutive vertices of a hole; a face with these corners would fill a part of the
 * hole. */
static void put_cycle(draft *d, uint32_t count)
{
    uint32_t h = d->halfedge;
    for (uint32_t i = 0; i < count; i++, h = link_of(d, h, NEXT)) {
        put(d, "%s%u", i > 0 ? "," : "", link_of(d, h, ORIGIN));
    }
}

static void put_point(draft *d)
{
    put(d, "[%.17g,%.17g,%.17g]", 2 * md_unit(d->random) - 1, 2 * md_unit(d->random) - 1,
        2 * md_unit(d->random) - 1);
}

/* Writes a whole number that is small, because many steps of an operation would make the mesh
 * large. */
static void put_whole(draft *d, const he_param *p)
{
    enum { MANY = 400 };
    uint32_t low = (uint32_t)p->min, high = (uint32_t)p->max;
    put(d, "%u", high < MANY ? low : md_from(d->random, low, MANY));
}

static void put_number(draft *d, const he_param *p)
{
    if (strcmp(p->name, "steps") == 0) {
        /* Hundreds of steps would be a job, and two of subdivide make too many faces. */
        put(d, "%u", 1U);
        return;
    }
    if (p->flags & HE_WHOLE) {
        put_whole(d, p);
        return;
    }
    bool ranged = (p->flags & HE_RANGE) != 0 && p->max - p->min < 1e6;
    double low = ranged ? p->min : 0, high = ranged ? p->max : 1;
    /* the tolerance is small, because a large one would merge the whole mesh */
    high = strcmp(p->name, "tolerance") == 0 ? 0.05 : high;
    /* remesh would make too many triangles of a smaller size */
    low = strcmp(p->name, "edge_length") == 0 || strcmp(p->name, "error") == 0 ? 0.3 : low;
    put(d, "%.17g", low + (high - low) * (0.01 + 0.98 * md_unit(d->random)));
}

/* Writes the member for a parameter. `arg` gets the value of a choice, on which other parameters
 * may depend. */
static void put_value(draft *d, const he_param *p, he_arg *arg)
{
    size_t choices = 0;
    switch (p->type) {
    case HE_PARAM_ELEMENTS:
        if (md_chance(d->random, 30)) {
            put(d, "\"%s\":[%u,%u]", p->plural, element(d, p->kind), element(d, p->kind));
            return;
        }
        put(d, "\"%s\":%u", p->name, element(d, p->kind));
        return;
    case HE_PARAM_ELEMENT:
        if (p->each != NULL && md_chance(d->random, 20)) {
            const uint32_t one = element(d, p->kind), other = element(d, p->kind);
            put(d, one == other ? "\"%s\":[%u]" : "\"%s\":[%u,%u]", p->each, one, other);
            return;
        }
        put(d, "\"%s\":%u", p->name, element(d, p->kind));
        return;
    case HE_PARAM_CYCLE:
        put(d, "\"%s\":[", p->name);
        put_cycle(d, md_from(d->random, 3, 5));
        put(d, "]");
        return;
    case HE_PARAM_NUMBER:
        put(d, "\"%s\":", p->name);
        put_number(d, p);
        return;
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        put(d, "\"%s\":", p->name);
        put_point(d);
        return;
    case HE_PARAM_FLAG:
        put(d, "\"%s\":%s", p->name, md_chance(d->random, 50) ? "true" : "false");
        return;
    case HE_PARAM_CHOICE:
        while (p->choices[choices] != NULL) {
            choices++;
        }
        arg->choice = (int)md_below(d->random, (uint32_t)choices);
        put(d, "\"%s\":\"%s\"", p->name, p->choices[arg->choice]);
        return;
    case HE_PARAM_POLYGON:
        put(d, "\"%s\":[[-1,-1],[%.17g,-1],[0,1]]", p->name, md_unit(d->random));
        return;
    case HE_PARAM_MATRIX:
        put(d, "\"%s\":[1,0,0,%.17g,0,1,0,%.17g,0,0,1,0,0,0,0,1]", p->name,
            md_unit(d->random) - 0.5, md_unit(d->random) - 0.5);
        return;
    case HE_PARAM_TEXT:
        put(d, "\"%s\":\"%c\"", p->name, (char)('a' + md_below(d->random, 5)));
        return;
    case HE_PARAM_COLOR:
        put(d, "\"%s\":[%.17g,%.17g,0]", p->name, md_unit(d->random), md_unit(d->random));
        return;
    case HE_PARAM_MESH:
        put(d, "\"%s\":\"m\"", p->name);
        return;
    }
}

/* Returns whether parameter i is in the request: of several alternatives, one is chosen at
 * random. */
static bool is_chosen(draft *d, const he_op *op, const he_arg *args, size_t i, const char *taken)
{
    const he_param *p = &op->params[i];
    if (!he_op_takes(op, args, i)) {
        return false;
    }
    if (p->group == 0) {
        return he_op_needs(op, args, i) || md_chance(d->random, 30);
    }
    size_t later = 0;
    bool required = false;
    for (size_t k = 0; k < he_op_params(op); k++) {
        const bool same = op->params[k].group == p->group && he_op_takes(op, args, k);
        later += k > i && same;
        required |= same && he_op_needs(op, args, k);
    }
    return strchr(taken, p->group) == NULL &&
           (md_chance(d->random, 40) || (required && later == 0));
}

/* Returns the half-edge from the target of h to the vertex v; HE_NONE if there is none. */
static uint32_t find_link(const draft *d, uint32_t h, uint32_t v)
{
    uint32_t first = link_of(d, h, NEXT), k = first;
    do {
        if (link_of(d, k ^ 1, ORIGIN) == v) {
            return k;
        }
        k = link_of(d, k ^ 1, NEXT);
    } while (k != first);
    return HE_NONE;
}

/* Writes three edges that form a cycle but no face, so that the mesh can be split there. Returns
 * false if it finds none. */
static bool put_neck(draft *d)
{
    uint32_t count = (uint32_t)d->mesh->tables[HE_HALFEDGE].count;
    uint32_t start = any(d, HE_HALFEDGE);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t h = (start + i) % count;
        if (!d->mesh->tables[HE_HALFEDGE].rows[h].live) {
            continue;
        }
        uint32_t first = link_of(d, h, NEXT), k = first;
        do {
            uint32_t l = find_link(d, k, link_of(d, h, ORIGIN));
            uint32_t sides[6] = {h, h ^ 1, k, k ^ 1, l, l ^ 1};
            bool six = l != HE_NONE;
            for (unsigned x = 0; six && x < 6; x++) {
                six = link_of(d, sides[x], FACE) != HE_NONE;
                for (unsigned y = 0; six && y < x; y++) {
                    six = link_of(d, sides[x], FACE) != link_of(d, sides[y], FACE);
                }
            }
            if (six) {
                put(d, ",\"a\":%u,\"b\":%u,\"c\":%u", h / 2, k / 2, l / 2);
                return true;
            }
            k = link_of(d, k ^ 1, NEXT);
        } while (k != first);
    }
    return false;
}

static bool on_loop(const draft *d, uint32_t loop, uint32_t h)
{
    uint32_t k = loop;
    do {
        if (k == h) {
            return true;
        }
        k = link_of(d, k, NEXT);
    } while (k != loop);
    return false;
}

/* Writes one half-edge of each of two holes. Returns false if the mesh has fewer than two holes. */
static bool put_holes(draft *d)
{
    uint32_t count = (uint32_t)d->mesh->tables[HE_HALFEDGE].count, hole = HE_NONE;
    uint32_t start = any(d, HE_HALFEDGE);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t h = (start + i) % count;
        if (!d->mesh->tables[HE_HALFEDGE].rows[h].live || link_of(d, h, FACE) != HE_NONE) {
            continue;
        }
        if (hole == HE_NONE) {
            hole = h;
        } else if (!on_loop(d, hole, h)) {
            put(d, ",\"a\":%u,\"b\":%u", hole, h);
            return true;
        }
    }
    return false;
}

void random_edit(md_random *r, const mirror *m, size_t row, char text[RANDOM_EDIT_TEXT])
{
    const he_op *op = he_op_at(row);
    draft d = {.random = r, .mesh = m, .text = text};
    char taken[HE_OP_PARAMS + 1] = "";
    he_arg args[HE_OP_PARAMS];
    he_op_defaults(op, args);
    d.halfedge = any(&d, HE_HALFEDGE);
    /* Some operations need a hole, and holes are rare, so this searches for a half-edge next to
     * one. */
    for (uint32_t tries = 0;
         md_chance(r, 97) && tries < 60 && link_of(&d, d.halfedge, FACE) != HE_NONE; tries++) {
        if (tries == 0 && md_chance(r, 60)) {
            break;
        }
        d.halfedge = any(&d, HE_HALFEDGE);
    }
    put(&d, "{\"op\":\"%s\"", op->name);
    if ((strcmp(op->name, "loop_split") == 0 && put_neck(&d)) ||
        (strcmp(op->name, "loop_bridge") == 0 && put_holes(&d))) {
        put(&d, "}");
        return;
    }
    for (size_t i = 0; i < he_op_params(op); i++) {
        if (is_chosen(&d, op, args, i, taken)) {
            if (op->params[i].group != 0) {
                taken[strlen(taken)] = op->params[i].group;
            }
            put(&d, ",");
            put_value(&d, &op->params[i], &args[i]);
        }
    }
    put(&d, "}");
}
