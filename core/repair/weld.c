/* weld: vertices that are near one another become one.
 *
 * Kept vertices lie in a hash table of cells of 4 tolerances. What is within the tolerance of a
 * point is in its own cell or, where the point is near a side, in the neighbour there: 8 cells at
 * most, 4 on the average. NEAR is a quarter and some to spare, which covers the rounding of the
 * division. Coordinates so large that it does not (2^46 cells from 0) look on both sides; those
 * where even the next double is out of reach (2^53 cells) are cells of their own, as all are when
 * the tolerance is 0. A cell holds few kept vertices, since they are further apart than the
 * tolerance. */
#include "repair/mend.h"

#include <math.h>
#include <string.h>

#define CELL     4.0
#define NEAR     0.3
#define FAR_CELL 0x1p46
#define LONE     0x1p53

typedef struct slot {
    uint32_t hash, vertex; /* kept number + 1; 0 where the slot is free */
} slot;

typedef struct table {
    slot *slots;
    size_t mask;
    uint64_t seed; /* of an address: no file can be made in which all slots collide */
    double tolerance;
    const he_vec3 *positions; /* of the kept ones */
} table;

static uint64_t mix(uint64_t h, double value)
{
    uint64_t bits;
    value = value == 0 ? 0 : value; /* -0 too */
    memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) * 0x9E3779B97F4A7C15;
    return h ^ h >> 29;
}

static uint32_t hash_of(const table *t, const double cell[3])
{
    return (uint32_t)(mix(mix(mix(t->seed, cell[0]), cell[1]), cell[2]) * 0xBF58476D1CE4E5B9 >> 32);
}

/* The cells along one axis where what is near x may be; the first is that of x. */
static size_t cells_of(const table *t, double x, double cells[3])
{
    double at = x / (CELL * t->tolerance), cell = floor(at);
    if (t->tolerance == 0 || fabs(at) >= LONE) {
        cells[0] = x;
        return 1;
    }
    size_t count = 0;
    cells[count++] = cell;
    if (at - cell <= NEAR || fabs(at) >= FAR_CELL) {
        cells[count++] = cell - 1;
    }
    if (at - cell >= 1 - NEAR || fabs(at) >= FAR_CELL) {
        cells[count++] = cell + 1;
    }
    return count;
}

static bool is_near(const table *t, he_vec3 a, he_vec3 b)
{
    double x = fabs(a.x - b.x), y = fabs(a.y - b.y), z = fabs(a.z - b.z), r = t->tolerance;
    if (x > r || y > r || z > r) {
        return false;
    }
    if (r == 0) {
        return true;
    }
    x /= r;
    y /= r;
    z /= r;
    return x * x + y * y + z * z <= 1;
}

/* The lowest kept vertex within reach, or HE_NONE; *home is the hash of the point's own cell. */
static uint32_t find(const table *t, he_vec3 p, uint32_t *home)
{
    double x[3], y[3], z[3];
    size_t nx = cells_of(t, p.x, x), ny = cells_of(t, p.y, y), nz = cells_of(t, p.z, z);
    const double own[3] = {x[0], y[0], z[0]};
    uint32_t best = HE_NONE;
    *home = hash_of(t, own);
    for (size_t i = 0; i < nx * ny * nz; i++) {
        const double cell[3] = {x[i % nx], y[i / nx % ny], z[i / nx / ny]};
        uint32_t h = hash_of(t, cell);
        for (size_t at = h & t->mask; t->slots[at].vertex != 0; at = (at + 1) & t->mask) {
            uint32_t v = t->slots[at].vertex - 1;
            if (t->slots[at].hash == h && v < best && is_near(t, t->positions[v], p)) {
                best = v;
            }
        }
    }
    return best;
}

static void keep(table *t, uint32_t hash, uint32_t v)
{
    size_t at = hash & t->mask;
    while (t->slots[at].vertex != 0) {
        at = (at + 1) & t->mask;
    }
    t->slots[at] = (slot){hash, v + 1};
}

/* Kept vertices move down in the positions; into[v] says where v is then. */
static he_status find_kept(he_mend *m, table *t, uint32_t *into, uint32_t *from, uint32_t *kept,
                           he_error *err)
{
    he_soup *soup = m->soup;
    he_repair_account *account = &m->out->accounts[HE_REPAIR_WELD];
    he_status status = HE_OK;
    *kept = 0;
    for (uint32_t v = 0; v < soup->vertex_count && status == HE_OK; v++) {
        status = he_watch_at(soup->limits.watch, v, soup->vertex_count, err);
        he_vec3 p = soup->positions[v];
        uint32_t home, found = find(t, p, &home);
        if (found != HE_NONE) {
            he_mend_name(account, v, found);
            account->count++;
            into[v] = found;
            continue;
        }
        soup->positions[*kept] = p;
        from[*kept] = v;
        keep(t, home, *kept);
        into[v] = (*kept)++;
    }
    return status;
}

he_status he_mend_weld(he_mend *m, double tolerance, he_error *err)
{
    he_soup *soup = m->soup;
    size_t slots = 16;
    while (slots < 2 * soup->vertex_count) {
        slots *= 2;
    }
    table t = {.mask = slots - 1, .tolerance = tolerance, .positions = soup->positions};
    uint32_t kept, *into = he_mem_array(NULL, soup->vertex_count, sizeof *into);
    uint32_t *from = he_mem_array(NULL, soup->vertex_count, sizeof *from);
    t.slots = he_mem_zero(slots, sizeof *t.slots);
    he_status status = HE_OK;
    if (into == NULL || from == NULL || t.slots == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory to weld %zu vertices", soup->vertex_count);
        goto out;
    }
    t.seed = (uint64_t)(uintptr_t)t.slots * 0x94D049BB133111EB;
    status = find_kept(m, &t, into, from, &kept, err);
    if (status == HE_OK && kept < soup->vertex_count) {
        for (size_t c = 0; c < soup->corner_count; c++) {
            soup->corners[c] = into[soup->corners[c]];
        }
        soup->vertex_count = kept;
        m->out->vertex_from = from;
        m->out->vertices = kept;
        from = NULL;
    }
out:
    he_mem_free(t.slots);
    he_mem_free(into);
    he_mem_free(from);
    return status;
}
