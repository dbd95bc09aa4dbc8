/* Vertices in the same place, by a hash table of cells.
 *
 * Cells are CELL times as wide as what is merged: few vertices need to look into all of the cells
 * around, and few fit into one. Of vertices that are near to each other one stays in the table, the
 * others are listed: so a cell never holds more than what fits into it that far apart. */
#include "query/defects.h"

#include "mesh/walk.h"
#include "query/scale.h"

#include <string.h>

enum { CELL = 4 };

/* Of an open table: probed one after another, up to the first that is free. */
typedef struct slot {
    uint32_t tag;    /* of the cell: another part of its hash than the place is from */
    uint32_t vertex; /* HE_NONE: free */
} slot;

typedef struct grid {
    const he_mesh *m;
    double merge, cell;
    uint64_t seed, mask;
    slot *slots; /* at least twice as many as vertices */
} grid;

/* The cell of a coordinate. Where doubles lie farther apart than cells are wide, each is a cell of
 * its own: no other one is near. */
typedef struct place {
    double cell;
    int toward; /* the neighbour that is within reach, 0: none */
} place;

static place place_of(const grid *g, double x)
{
    if (!(g->cell > 0 && fabs(x) < g->cell * 0x1p50)) {
        return (place){x + 0.0, 0}; /* one zero */
    }
    double at = x / g->cell, low = (double)(int64_t)at;
    low -= low > at;
    double rest = at - low;
    double near = (fabs(at) < 0x1p40 ? 1.001 : 1.5) / CELL; /* what rounding adds to `at` */
    return (place){low + 0.0, rest < near ? -1 : rest > 1 - near ? 1 : 0};
}

/* One to one, of 64 bits (Steele, Lea and Flood 2014, as mixed by Stafford). */
static uint64_t mix(uint64_t x)
{
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static uint64_t hash(const grid *g, const double cell[3])
{
    uint64_t sum = g->seed;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        memcpy(&bits, &cell[k], sizeof bits);
        sum = mix(sum ^ bits);
    }
    return sum;
}

/* HUGE_VAL when they are farther apart than what is merged. */
static double distance(const grid *g, he_vec3 p, he_vec3 q)
{
    he_vec3 d = he_vec3_sub(p, q);
    double extent = he_vec3_extent(d);
    if (!(extent <= g->merge)) {
        return HUGE_VAL;
    }
    if (extent == 0) {
        return 0;
    }
    double length = he_vec3_length(he_vec3_scale(d, 1 / extent)) * extent;
    return length <= g->merge ? length : HUGE_VAL;
}

/* The first vertex of a cell that is near enough; the free slot behind goes to `*end`. */
static uint32_t search(const grid *g, he_vec3 p, uint64_t cell, double *length, uint64_t *end)
{
    uint32_t least = HE_NONE, tag = (uint32_t)(cell >> 32);
    uint64_t at = cell & g->mask;
    for (; g->slots[at].vertex != HE_NONE; at = (at + 1) & g->mask) {
        uint32_t v = g->slots[at].vertex;
        if (g->slots[at].tag == tag && v < least) {
            double d = distance(g, p, g->m->c.position[v]);
            if (d < HUGE_VAL) {
                least = v;
                *length = d;
            }
        }
    }
    *end = at;
    return least;
}

static void add(grid *g, uint32_t v, he_defects *out)
{
    he_vec3 p = g->m->c.position[v];
    const place at[3] = {place_of(g, p.x), place_of(g, p.y), place_of(g, p.z)};
    const double own[3] = {at[0].cell, at[1].cell, at[2].cell};
    uint64_t home = hash(g, own), end, unused;
    double length = 0;
    uint32_t near = search(g, p, home, &length, &end);
    for (unsigned side = 1; side < 8; side++) {
        double cell[3] = {own[0], own[1], own[2]};
        bool there = true;
        for (unsigned k = 0; k < 3; k++) {
            if (side >> k & 1) {
                there &= at[k].toward != 0;
                cell[k] = cell[k] + at[k].toward + 0.0;
            }
        }
        if (there) {
            double d;
            uint32_t other = search(g, p, hash(g, cell), &d, &unused);
            length = other < near ? d : length;
            near = other < near ? other : near;
        }
    }
    if (near != HE_NONE) {
        he_defects_add(out, HE_DEFECT_DUPLICATE, v, near, length);
    } else {
        g->slots[end] = (slot){(uint32_t)(home >> 32), v};
    }
}

he_status he_defects_of_positions(const he_mesh *m, double merge, uint64_t seed, he_watch *watch,
                                  he_defects *out, he_error *err)
{
    grid g = {.m = m, .merge = merge, .cell = merge * CELL, .seed = seed};
    uint64_t size = 2;
    while (size < 2 * (uint64_t)m->c.vertices.issued) {
        size *= 2;
    }
    g.mask = size - 1;
    he_status status = he_watch_phase(watch, "comparing positions", 0.5, err);
    if (status != HE_OK) {
        return status;
    }
    g.slots = he_mem_array(NULL, (size_t)size, sizeof *g.slots);
    if (g.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare positions");
    }
    memset(g.slots, 0xff, (size_t)size * sizeof *g.slots);
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        status = he_watch_at(watch, v, m->c.vertices.issued, err);
        if (m->c.vertex_halfedge[v] != HE_DEAD) {
            add(&g, v, out);
        }
    }
    he_mem_free(g.slots);
    return status;
}
