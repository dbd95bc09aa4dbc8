#include "tests/api/polygons.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static unsigned target(const pg_mesh *pg, unsigned h)
{
    return pg->origin[h ^ 1u];
}

static unsigned find_halfedge(const pg_mesh *pg, unsigned a, unsigned b)
{
    for (unsigned h = 0; h < pg->halfedges; h++) {
        if (pg->origin[h] == a && target(pg, h) == b) {
            return h;
        }
    }
    return PG_NONE;
}

static unsigned halfedge_of_corner(pg_mesh *pg, unsigned a, unsigned b)
{
    unsigned h = find_halfedge(pg, a, b);
    if (h == PG_NONE) {
        h = pg->halfedges;
        assert_true(h + 2 <= PG_HALFEDGES);
        pg->halfedges += 2;
        pg->origin[h] = a;
        pg->origin[h + 1] = b;
        pg->face[h] = pg->face[h + 1] = PG_NONE;
    }
    return h;
}

static void link_halfedges(pg_mesh *pg)
{
    for (unsigned f = 0; f < pg->faces; f++) {
        unsigned n = pg->degree[f];
        for (unsigned i = 0; i < n; i++) {
            unsigned h = find_halfedge(pg, pg->corners[f][i], pg->corners[f][(i + 1) % n]);
            unsigned after =
                find_halfedge(pg, pg->corners[f][(i + 1) % n], pg->corners[f][(i + 2) % n]);
            pg->next[h] = after;
            pg->prev[after] = h;
        }
        pg->face_first[f] = find_halfedge(pg, pg->corners[f][0], pg->corners[f][1]);
    }
    /* The half-edge after a boundary half-edge h is a boundary half-edge that starts where h ends.
     * If that vertex is a bow-tie (it has several fans of faces), several half-edges qualify:
     * pg_learn_next records which one the API has chosen. */
    for (unsigned h = 0; h < pg->halfedges; h++) {
        for (unsigned k = 0; k < pg->halfedges && pg->face[h] == PG_NONE; k++) {
            if (pg->face[k] == PG_NONE && pg->origin[k] == target(pg, h)) {
                pg->next[h] = k;
                pg->prev[k] = h;
            }
        }
    }
    for (unsigned v = 0; v < pg->vertices; v++) {
        pg->vertex_first[v] = PG_NONE;
        for (unsigned h = 0; h < pg->halfedges; h++) {
            if (pg->origin[h] == v && (pg->vertex_first[v] == PG_NONE || pg->face[h] == PG_NONE)) {
                pg->vertex_first[v] = h;
            }
        }
    }
}

void pg_make_corners(pg_mesh *pg, const unsigned *corners, size_t count, unsigned vertices)
{
    memset(pg, 0, sizeof *pg);
    pg->vertices = vertices;
    for (size_t i = 0; i < count; i++) {
        if (corners[i] == PG_NONE) {
            pg->faces++;
            continue;
        }
        assert_true(pg->faces < PG_FACES && pg->degree[pg->faces] < PG_CORNERS);
        pg->corners[pg->faces][pg->degree[pg->faces]++] = corners[i];
        pg->vertices = corners[i] >= pg->vertices ? corners[i] + 1 : pg->vertices;
    }
    assert_true(pg->vertices <= PG_VERTICES);
    for (unsigned v = 0; v < pg->vertices; v++) {
        pg->position[v][0] = v * v % 7;
        pg->position[v][1] = v * 3 % 5;
        pg->position[v][2] = v;
    }
    for (unsigned f = 0; f < pg->faces; f++) {
        for (unsigned i = 0; i < pg->degree[f]; i++) {
            unsigned h =
                halfedge_of_corner(pg, pg->corners[f][i], pg->corners[f][(i + 1) % pg->degree[f]]);
            pg->face[h] = f;
        }
    }
    link_halfedges(pg);
}

void pg_make(pg_mesh *pg, const char *faces, unsigned vertices)
{
    unsigned corners[PG_FACES * PG_CORNERS];
    size_t count = 0;
    for (const char *p = faces; *p != '\0'; p++) {
        assert_true(count + 2 < sizeof corners / sizeof corners[0]);
        corners[count++] = *p == ',' ? PG_NONE : (unsigned)(*p - '0');
    }
    if (count > 0) {
        corners[count++] = PG_NONE;
    }
    pg_make_corners(pg, corners, count, vertices);
}

/* --- half-edges that the API may choose --- */

bool pg_is_isolated(const pg_mesh *pg, unsigned v)
{
    return pg->vertex_first[v] == PG_NONE;
}

unsigned pg_fans(const pg_mesh *pg, unsigned v)
{
    unsigned open = 0;
    for (unsigned h = 0; h < pg->halfedges; h++) {
        open += pg->origin[h] == v && pg->face[h] == PG_NONE;
    }
    return open > 0 ? open : !pg_is_isolated(pg, v);
}

bool pg_is_boundary(const pg_mesh *pg, unsigned v)
{
    if (pg_is_isolated(pg, v)) {
        return true;
    }
    for (unsigned h = 0; h < pg->halfedges; h++) {
        if (pg->origin[h] == v && pg->face[h] == PG_NONE) {
            return true;
        }
    }
    return false;
}

void pg_learn_vertex(pg_mesh *pg, unsigned v, unsigned halfedge)
{
    if (pg_is_isolated(pg, v)) {
        assert_int_equal(halfedge, PG_NONE);
        return;
    }
    assert_in_range(halfedge, 0, pg->halfedges - 1);
    assert_int_equal(pg->origin[halfedge], v);
    assert_true(pg->face[halfedge] == PG_NONE || !pg_is_boundary(pg, v));
    pg->vertex_first[v] = halfedge;
}

void pg_learn_face(pg_mesh *pg, unsigned f, unsigned halfedge)
{
    assert_in_range(halfedge, 0, pg->halfedges - 1);
    assert_int_equal(pg->face[halfedge], f);
    pg->face_first[f] = halfedge;
}

void pg_learn_next(pg_mesh *pg, unsigned h, unsigned next)
{
    assert_in_range(next, 0, pg->halfedges - 1);
    if (pg->face[h] != PG_NONE) {
        assert_int_equal(next, pg->next[h]);
        return;
    }
    assert_int_equal(pg->face[next], PG_NONE);
    assert_int_equal(pg->origin[next], target(pg, h));
    pg->next[h] = next;
    pg->prev[next] = h;
}

/* --- relations --- */

static void add(pg_list *list, unsigned id)
{
    assert_true(list->count < PG_HALFEDGES);
    list->ids[list->count++] = id;
}

static void add_once(pg_list *list, unsigned id)
{
    for (unsigned i = 0; i < list->count; i++) {
        if (list->ids[i] == id) {
            return;
        }
    }
    if (id != PG_NONE) {
        add(list, id);
    }
}

static void ring(const pg_mesh *pg, unsigned first, pg_list *out)
{
    for (unsigned h = first; h != PG_NONE;) {
        add(out, h);
        h = pg->prev[h] ^ 1u;
        h = h == first ? PG_NONE : h;
    }
}

static void loop(const pg_mesh *pg, unsigned first, pg_list *out)
{
    for (unsigned h = first; h != PG_NONE;) {
        add(out, h);
        h = pg->next[h] == first ? PG_NONE : pg->next[h];
    }
}

static unsigned read_off(const pg_mesh *pg, const char *kind, const char *what, unsigned h)
{
    bool about_vertex = strcmp(kind, "vertex") == 0;
    if (strcmp(what, "vertices") == 0) {
        return about_vertex ? target(pg, h) : pg->origin[h];
    }
    if (strcmp(what, "edges") == 0) {
        return h / 2;
    }
    if (strcmp(what, "incoming") == 0) {
        return h ^ 1u;
    }
    if (strcmp(what, "faces") == 0) {
        return pg->face[strcmp(kind, "face") == 0 ? h ^ 1u : h];
    }
    return h; /* the relations outgoing, halfedges, loop and ring list half-edges */
}

void pg_relation(const pg_mesh *pg, pg_element of, const char *what, bool clockwise, pg_list *out)
{
    const char *kind = of.kind;
    const unsigned id = of.id;
    pg_list halfedges = {.count = 0};
    if (strcmp(kind, "vertex") == 0) {
        ring(pg, pg->vertex_first[id], &halfedges);
    } else if (strcmp(kind, "face") == 0) {
        loop(pg, pg->face_first[id], &halfedges);
    } else if (strcmp(kind, "edge") == 0) {
        add(&halfedges, 2 * id);
        add(&halfedges, 2 * id + 1);
    } else if (strcmp(what, "loop") == 0) {
        loop(pg, id, &halfedges);
    } else {
        ring(pg, id, &halfedges);
    }
    out->count = 0;
    for (unsigned i = 0; i < halfedges.count; i++) {
        add_once(out, read_off(pg, kind, what, halfedges.ids[i]));
    }
    for (unsigned i = 1, j = out->count; clockwise && i + 1 < j; i++) {
        unsigned id_i = out->ids[i];
        out->ids[i] = out->ids[--j];
        out->ids[j] = id_i;
    }
}

/* --- measures --- */

double pg_length(const pg_mesh *pg, unsigned e)
{
    const double *a = pg->position[pg->origin[2 * e]], *b = pg->position[pg->origin[2 * e + 1]];
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

double pg_area(const pg_mesh *pg, unsigned f, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (unsigned i = 0; i < pg->degree[f]; i++) {
        const double *a = pg->position[pg->corners[f][i]];
        const double *b = pg->position[pg->corners[f][(i + 1) % pg->degree[f]]];
        for (unsigned k = 0; k < 3; k++) {
            unsigned l = (k + 1) % 3, m = (k + 2) % 3;
            out[k] += (a[l] * b[m] - a[m] * b[l]) / 2;
        }
    }
    return sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
}

/* --- walks --- */

void pg_breadth_first(const pg_mesh *pg, const pg_flood *flood, pg_list *ids, pg_list *depths)
{
    const char *kind = flood->from.kind;
    bool about_vertex = strcmp(kind, "vertex") == 0;
    ids->count = depths->count = 0;
    add(ids, flood->from.id);
    add(depths, 0);
    for (unsigned i = 0; i < ids->count && depths->ids[i] < flood->depth; i++) {
        pg_list beside;
        pg_relation(pg, (pg_element){kind, ids->ids[i]}, about_vertex ? "vertices" : "faces", false,
                    &beside);
        for (unsigned j = 0; j < beside.count; j++) {
            add_once(ids, beside.ids[j]);
            while (depths->count < ids->count) {
                add(depths, depths->ids[i] + 1);
            }
        }
    }
    if (flood->limit != 0 && ids->count > flood->limit) {
        ids->count = depths->count = flood->limit;
    }
}

void pg_distances(const pg_mesh *pg, bool by_length, double out[PG_VERTICES][PG_VERTICES])
{
    for (unsigned i = 0; i < pg->vertices; i++) {
        for (unsigned j = 0; j < pg->vertices; j++) {
            out[i][j] = i == j ? 0 : HUGE_VAL;
        }
    }
    for (unsigned h = 0; h < pg->halfedges; h++) {
        out[pg->origin[h]][target(pg, h)] = by_length ? pg_length(pg, h / 2) : 1;
    }
    for (unsigned k = 0; k < pg->vertices; k++) {
        for (unsigned i = 0; i < pg->vertices; i++) {
            for (unsigned j = 0; j < pg->vertices; j++) {
                out[i][j] = fmin(out[i][j], out[i][k] + out[k][j]);
            }
        }
    }
}

/* Returns the half-edge that follows `h` in a walk, or PG_NONE at the end of the walk. The walk
 * goes straight on from edge to edge, or, if `across` is set, from each edge to the opposite edge
 * of a quadrilateral. */
static unsigned onward(const pg_mesh *pg, bool across, unsigned h)
{
    pg_list about = {.count = 0};
    if (across) {
        loop(pg, h, &about);
        return pg->face[h] == PG_NONE || about.count != 4 ? PG_NONE : about.ids[2] ^ 1u;
    }
    ring(pg, h ^ 1u, &about);
    return pg_is_boundary(pg, target(pg, h)) || about.count != 4 ? PG_NONE : about.ids[2];
}

void pg_edges(const pg_mesh *pg, bool across, unsigned edge, pg_list *out, bool *closed)
{
    pg_list behind = {.count = 0};
    out->count = 0;
    unsigned h = onward(pg, across, 2 * edge + 1);
    for (; h != PG_NONE && h != 2 * edge + 1; h = onward(pg, across, h)) {
        add(&behind, h / 2);
    }
    *closed = h != PG_NONE;
    for (unsigned i = behind.count; i > 0 && !*closed; i--) {
        add(out, behind.ids[i - 1]);
    }
    add(out, edge);
    h = onward(pg, across, 2 * edge);
    for (; h != PG_NONE && h != 2 * edge; h = onward(pg, across, h)) {
        add(out, h / 2);
    }
}

unsigned pg_boundaries(const pg_mesh *pg, pg_list loops[PG_FACES])
{
    bool seen[PG_HALFEDGES] = {false};
    unsigned count = 0;
    for (unsigned h = 0; h < pg->halfedges; h++) {
        if (pg->face[h] == PG_NONE && !seen[h]) {
            assert_true(count < PG_FACES);
            loops[count].count = 0;
            loop(pg, h, &loops[count]);
            for (unsigned i = 0; i < loops[count].count; i++) {
                seen[loops[count].ids[i]] = true;
            }
            count++;
        }
    }
    return count;
}

static bool touch(const pg_mesh *pg, unsigned f, unsigned g, bool by_vertex)
{
    for (unsigned h = 0; h < pg->halfedges && !by_vertex; h++) {
        if (pg->face[h] == f && pg->face[h ^ 1u] == g) {
            return true;
        }
    }
    for (unsigned i = 0; i < pg->degree[f] && by_vertex; i++) {
        for (unsigned j = 0; j < pg->degree[g]; j++) {
            if (pg->corners[f][i] == pg->corners[g][j]) {
                return true;
            }
        }
    }
    return false;
}

void pg_components(const pg_mesh *pg, bool by_vertex, unsigned lowest[PG_FACES])
{
    for (unsigned f = 0; f < pg->faces; f++) {
        lowest[f] = f;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (unsigned f = 0; f < pg->faces; f++) {
            for (unsigned g = 0; g < pg->faces; g++) {
                if (lowest[f] < lowest[g] && touch(pg, f, g, by_vertex)) {
                    lowest[g] = lowest[f];
                    changed = true;
                }
            }
        }
    }
}
