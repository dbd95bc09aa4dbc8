#include "oracle/oracle.h"

#include <assert.h>

uint64_t or_face_collapse(or_mesh *o, uint32_t f, uint32_t start)
{
    or_face was = o->face[f];
    uint32_t shift = or_place(&was, start);
    uint64_t refused = 0;
    uint64_t doubt = 0;
    or_lists *before = or_save(o);
    for (uint32_t k = 1; k < was.count && refused == 0; k++) {
        uint32_t u = was.v[(shift + k) % was.count];
        const or_collapse c = {u, start, (double)k / (k + 1), NULL};
        refused = or_check_collapse(o, &c, &doubt);
        if (refused == 0) {
            or_draw_together(o, &c);
            uint64_t wrong = or_derive(o);
            assert(wrong == 0);
            (void)wrong;
        }
    }
    if (refused != 0) {
        or_restore(o, before);
        return refused | doubt;
    }
    if (doubt != 0) {
        or_doubt(o, before, doubt);
    } else {
        or_forget(before);
    }
    return 0;
}

uint64_t or_reverse(or_mesh *o, const uint32_t *faces, uint32_t count)
{
    bool chosen[OR_FACES] = {false};
    bool beside = false;
    bool touched = false;
    bool at[OR_VERTICES] = {false};
    for (uint32_t i = 0; i < count && faces != NULL; i++) {
        chosen[faces[i]] = true;
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        chosen[f] = o->face[f].alive && (faces == NULL || chosen[f]);
        for (uint32_t i = 0; i < o->face[f].count && chosen[f]; i++) {
            at[o->face[f].v[i]] = true;
        }
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        for (uint32_t i = 0; i < face->count && face->alive && !chosen[f]; i++) {
            uint32_t g = o->left[face->v[(i + 1) % face->count]][face->v[i]];
            touched |= at[face->v[i]];
            beside |= g != OR_NONE && chosen[g];
        }
    }
    if (beside || touched) {
        return OR_BIT(beside ? HE_ORIENTATION : HE_BOWTIE);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        or_face *face = &o->face[f];
        for (uint32_t i = 0, k = face->count; chosen[f] && i + 1 < k; i++) {
            uint32_t swap = face->v[i];
            face->v[i] = face->v[--k];
            face->v[k] = swap;
        }
    }
    return 0;
}

static uint64_t check_dual(const or_mesh *o)
{
    uint64_t refused = 0;
    bool locked = false;
    uint32_t pair[OR_EDGES][2];
    uint32_t pairs = 0;
    for (uint32_t v = 0; v < o->vertices; v++) {
        if (o->vertex[v].alive) {
            uint32_t degree = or_degree(o, v);
            refused |= degree == 0  ? OR_BIT(HE_ISOLATED_VERTEX)
                       : degree < 3 ? OR_BIT(HE_TOO_FEW_CORNERS)
                                    : 0;
            locked |= o->vertex[v].locked;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
        uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
        if (!o->edge[e].alive) {
            continue;
        }
        locked |= o->edge[e].locked;
        if (f == OR_NONE || g == OR_NONE) {
            refused |= OR_BIT(HE_BOUNDARY_EDGE);
            continue;
        }
        for (uint32_t d = 0; d < pairs; d++) {
            bool same =
                (pair[d][0] == f && pair[d][1] == g) || (pair[d][0] == g && pair[d][1] == f);
            refused |= same ? OR_BIT(HE_DOUBLED_EDGE) : 0;
        }
        pair[pairs][0] = f;
        pair[pairs++][1] = g;
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        locked |= o->face[f].alive && o->face[f].locked;
    }
    return refused | (locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0);
}

uint64_t or_dual(or_mesh *o)
{
    uint64_t refused = check_dual(o);
    uint32_t name[OR_FACES];
    uint32_t vertices = o->vertices;
    uint32_t faces = o->faces;
    if (refused != 0) {
        return refused;
    }
    for (uint32_t f = 0; f < faces; f++) {
        const or_face *face = &o->face[f];
        if (!face->alive) {
            continue;
        }
        he_vec3 sum = {0, 0, 0};
        for (uint32_t i = 0; i < face->count; i++) {
            he_vec3 p = o->vertex[face->v[i]].at;
            sum = (he_vec3){sum.x + p.x, sum.y + p.y, sum.z + p.z};
        }
        double n = face->count;
        name[f] = or_add_vertex(o, (he_vec3){sum.x / n, sum.y / n, sum.z / n});
        o->vertex[name[f]].near = true;
    }
    for (uint32_t v = 0; v < vertices; v++) {
        uint32_t cycle[OR_CORNERS];
        uint32_t n = 0;
        uint32_t first;
        if (!o->vertex[v].alive || or_neighbours(o, v, &first, 1) == 0) {
            continue;
        }
        uint32_t x = first;
        do {
            cycle[n++] = name[o->left[v][x]];
            x = or_turn(o, v, x);
        } while (x != first);
        (void)or_add_face(o, cycle, n);
    }
    for (uint32_t v = 0; v < vertices; v++) {
        o->vertex[v].alive = false;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        o->edge[e].alive = false;
    }
    for (uint32_t f = 0; f < faces; f++) {
        o->face[f].alive = false;
    }
    return 0;
}

void or_append(or_mesh *o, const or_mesh *other)
{
    uint32_t name[OR_VERTICES];
    for (uint32_t v = 0; v < other->vertices; v++) {
        if (other->vertex[v].alive) {
            name[v] = or_add_vertex(o, other->vertex[v].at);
        }
    }
    for (uint32_t e = 0; e < other->edges; e++) {
        if (other->edge[e].alive) {
            o->edge[o->edges++] =
                (or_edge){.alive = true, .a = name[other->edge[e].a], .b = name[other->edge[e].b]};
        }
    }
    for (uint32_t f = 0; f < other->faces; f++) {
        uint32_t v[OR_CORNERS];
        for (uint32_t i = 0; i < other->face[f].count && other->face[f].alive; i++) {
            v[i] = name[other->face[f].v[i]];
        }
        if (other->face[f].alive) {
            (void)or_add_face(o, v, other->face[f].count);
        }
    }
}
