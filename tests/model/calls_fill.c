#include "model/rows.h"
#include "model/adopt.h"

#include "fill/fill.h"
#include "mesh/walk.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static he_smooth_fill smooth_of(const md_call *c)
{
    const he_arg *length = md_get(c, "edge_length");
    return (he_smooth_fill){.edge_length = length->given ? length->number : 0,
                            .continuity = (he_continuity)md_get(c, "continuity")->number};
}

/* Draws the options of the method smooth. */
static void draw_smooth(md_draft *d)
{
    if (md_chance(d->r, 50)) {
        md_give_number(d, "continuity", md_below(d->r, HE_CONTINUITIES));
    }
    if (md_chance(d->r, 30)) {
        md_give_number(d, "edge_length", 0.1 + md_unit(d->r));
    }
}

static bool is_smooth(const md_call *c)
{
    return md_get(c, "method")->choice == HE_FILL_ALL_SMOOTH;
}

/* Returns true if hedge refused because a length that was asked for would make too many faces: only
 * hedge knows how many. */
static bool may_be_too_many(const md_call *c, he_status status)
{
    return status == HE_LIMIT && md_get(c, "edge_length")->given;
}

static void require(bool holds, const char *what, uint32_t id)
{
    if (!holds) {
        fprintf(stderr, "filling changed %s %u\n", what, id);
        abort();
    }
}

/* Requires that the vertices, edges and faces from before are as they were. */
static void require_stays(const or_mesh *o, const he_mesh *made)
{
    for (uint32_t v = 0; v < o->vertices; v++) {
        require(he_mesh_is_live(made, HE_VERTEX, v) == o->vertex[v].alive, "vertex", v);
        require(!o->vertex[v].alive ||
                    or_same_point(o->vertex[v].at, he_position(made, (he_vertex){v})),
                "vertex", v);
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        require(he_mesh_is_live(made, HE_EDGE, e) == o->edge[e].alive, "edge", e);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        require(he_mesh_is_live(made, HE_FACE, f) == o->face[f].alive, "face", f);
        for (uint32_t i = 0; o->face[f].alive && i < o->face[f].count; i++) {
            require(or_place(&o->face[f], md_corner(made, f, i).i) != OR_NONE, "face", f);
        }
    }
}

/* --- hole_fill --- */

static bool draw_hole_fill(md_draft *d)
{
    uint32_t loop[OR_CORNERS];
    uint32_t h = md_chance(d->r, 85) ? md_boundary_halfedge(d) : md_pick(d, HE_HALFEDGE);
    md_give_id(d, "halfedge", h);
    if (md_chance(d->r, 80)) {
        static const char *const names[] = {"polygon", "fan", "triangulate", "smooth"};
        md_give_choice(d, "method", names[md_below(d->r, 4)]);
    }
    if (md_is_live_boundary(d->m, h) && md_hole(d->m, h, loop) == 0) {
        return false;
    }
    if (!is_smooth(d->c)) {
        return true;
    }
    draw_smooth(d);
    return md_is_tame(d);
}

/* Fills a hole as hedge did on a copy of its mesh. */
static uint64_t play_smooth(const md_call *c, or_mesh *o, const he_mesh *m, const or_face *hole)
{
    const he_smooth_fill options = smooth_of(c);
    he_mesh *made = NULL;
    he_filled filled;
    for (uint32_t i = 0; i < hole->count; i++) {
        if (or_place(hole, hole->v[i]) != i) {
            return OR_BIT(HE_REPEATED_CORNER);
        }
    }
    if (he_mesh_copy(m, &made, NULL) != HE_OK) {
        abort();
    }
    const he_status status = he_hole_fill_smooth(made, (he_halfedge){md_get(c, "halfedge")->id},
                                                 &options, &filled, NULL);
    if (may_be_too_many(c, status)) {
        he_mesh_free(made);
        return OR_BIT(HE_LIMIT);
    }
    if (status != HE_OK) {
        abort();
    }
    require_stays(o, made);
    const uint32_t added = he_mesh_vertices(made) - he_mesh_vertices(m);
    require(filled.faces.count == hole->count + 2 * (size_t)added - 2, "the number of faces by",
            (uint32_t)filled.faces.count);
    require(filled.edges.count == hole->count + 3 * (size_t)added - 3, "the number of edges by",
            (uint32_t)filled.edges.count);
    he_filled_clear(&filled);
    md_adopt_mesh(o, made);
    he_mesh_free(made);
    return 0;
}

static uint64_t play_hole_fill(const md_call *c, or_mesh *o, const he_mesh *m)
{
    static const or_fill methods[] = {OR_POLYGON, OR_FAN, OR_TRIANGULATE};
    uint32_t h = md_get(c, "halfedge")->id;
    uint64_t refused = or_require(o, HE_HALFEDGE, h);
    if (refused != 0) {
        return refused;
    }
    uint32_t a = h % 2 == 0 ? o->edge[h / 2].a : o->edge[h / 2].b;
    uint32_t b = h % 2 == 0 ? o->edge[h / 2].b : o->edge[h / 2].a;
    if (o->left[a][b] != OR_NONE) {
        return OR_BIT(HE_NOT_BOUNDARY);
    }
    uint32_t loop[OR_CORNERS];
    uint32_t count = md_hole(m, h, loop);
    if (is_smooth(c)) {
        or_face hole = {.alive = true, .count = count};
        memcpy(hole.v, loop, count * sizeof *loop);
        return play_smooth(c, o, m, &hole);
    }
    return or_hole_fill(o, loop, count, methods[md_get(c, "method")->choice]);
}

/* --- fill_holes --- */

static he_fill_holes_options options_of(const md_call *c)
{
    const he_arg *edges = md_get(c, "max_edges"), *size = md_get(c, "max_size");
    return (he_fill_holes_options){.method = (he_fill_method)md_get(c, "method")->choice,
                                   .smooth = smooth_of(c),
                                   .max_edges = edges->given ? (uint32_t)edges->number : 0,
                                   .max_size = size->given ? size->number : 0};
}

static bool draw_fill_holes(md_draft *d)
{
    static const char *const names[] = {"polygon", "fan", "triangulate", "smooth"};
    if (md_chance(d->r, 60)) {
        md_give_choice(d, "method", names[md_below(d->r, 4)]);
    }
    if (md_chance(d->r, 50)) {
        md_give_number(d, "max_edges", md_from(d->r, 3, 12));
    }
    if (md_chance(d->r, 20)) {
        md_give_number(d, "max_size", md_unit(d->r) * 3 + 0.01);
    }
    if (is_smooth(d->c)) {
        draw_smooth(d);
    }
    return md_is_tame(d);
}

/* Returns the number of holes of a mesh, and in *touching how many pass a vertex twice. */
static uint32_t count_holes(const he_mesh *m, uint32_t *touching)
{
    static bool seen[2 * OR_EDGES];
    uint32_t count = 0;
    memset(seen, 0, sizeof seen);
    *touching = 0;
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        bool repeats = false;
        if (!md_is_live_boundary(m, h) || seen[h]) {
            continue;
        }
        he_halfedge k = {h};
        do {
            seen[k.i] = true;
            for (he_halfedge j = he_next(m, k); j.i != k.i; j = he_next(m, j)) {
                repeats |= he_origin(m, j).i == he_origin(m, k).i;
            }
            k = he_next(m, k);
        } while (k.i != h);
        count++;
        *touching += repeats;
    }
    return count;
}

static uint64_t play_fill_holes(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_fill_holes_options options = options_of(c);
    he_mesh *made = NULL;
    he_filled_holes done;
    uint32_t touching, still;
    const uint32_t holes = count_holes(m, &touching);
    if (he_mesh_copy(m, &made, NULL) != HE_OK) {
        abort();
    }
    const he_status status = he_fill_holes(made, &options, &done, NULL);
    if (may_be_too_many(c, status)) {
        he_mesh_free(made);
        return OR_BIT(HE_LIMIT);
    }
    if (status != HE_OK) {
        abort();
    }
    require_stays(o, made);
    const uint32_t left = count_holes(made, &still);
    require(holes == done.filled + left, "the number of holes, which was", holes);
    require(left == done.left.count, "the number of holes left", left);
    require(left == done.large + done.touching + done.single + done.doubled, "what is left of",
            left);
    require(done.touching <= touching, "the number of holes that touch", done.touching);
    require(done.large == 0 || options.max_edges > 0 || options.max_size > 0, "no limit for", left);
    he_filled_holes_clear(&done);
    md_adopt_mesh(o, made);
    he_mesh_free(made);
    return 0;
}

const md_row md_fill_rows[] = {
    {"hole_fill", 1, draw_hole_fill, play_hole_fill, NULL, false},
    {"fill_holes", 1, draw_fill_holes, play_fill_holes, NULL, false},
    {.name = NULL},
};
