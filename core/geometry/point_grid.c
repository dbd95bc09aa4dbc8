/* point_grid.c - finds the points within a tolerance of a given point, by a hash table of cells.
 *
 * Points within the tolerance of a point p may lie in the cell of p or in a neighbouring cell.
 * Along each axis a neighbouring cell is searched if its border is at most NEAR cell widths away
 * from p. The tolerance is a quarter of a cell width; NEAR is slightly larger, because the division
 * that finds the cell of p is rounded. At coordinates of FAR_CELL cell widths or more, rounding
 * errors exceed this margin, so the cells before and after the cell of p are always searched. At
 * coordinates of LONE cell widths or more, even successive doubles differ by more than the
 * tolerance, so only equal coordinates are near, and each coordinate is treated as a cell of its
 * own. A tolerance of 0 is treated in this way, too. */
#include "geometry/point_grid.h"

#include "geometry/point_hash.h"

#include <math.h>
#include <string.h>

#define CELL     4.0
#define NEAR     0.2525
#define FAR_CELL 0x1p43
#define LONE     0x1p53

/* The number of entries of the hash table that are set to 0 between two reports of progress. It is
 * small because the first write to newly allocated memory is slow. */
enum { STRETCH = 16 * HE_PROGRESS_STRIDE };

he_status he_point_grid_make(he_point_grid *out, const he_point_grid_points *points, size_t most,
                             he_progress *progress, he_error *err)
{
    size_t slots = 16;
    while (slots < 2 * most) {
        slots *= 2;
    }
    he_point_grid grid = {.mask = slots - 1, .tolerance = points->tolerance, .points = points->at};
    grid.slots = he_mem_array(NULL, slots, sizeof *grid.slots);
    if (grid.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu positions", most);
    }
    for (size_t i = 0; i < slots; i += STRETCH) {
        he_status status = he_progress_at(progress, i, UINT64_MAX, err);
        if (status != HE_OK) {
            he_point_grid_clear(&grid);
            return status;
        }
        size_t rest = slots - i < STRETCH ? slots - i : STRETCH;
        memset(grid.slots + i, 0, rest * sizeof *grid.slots);
    }
    grid.seed = points->seed ^ (uint64_t)(uintptr_t)grid.slots * 0x94D049BB133111EB;
    *out = grid;
    return HE_OK;
}

void he_point_grid_clear(he_point_grid *grid)
{
    he_mem_free(grid->slots);
    grid->slots = NULL;
}

/* Finds the cells along one axis that may have points within the tolerance of coordinate x, and
 * returns their number (1 to 3). cells[0] is the cell of x. */
static size_t cells_of(const he_point_grid *t, double x, double cells[3])
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

static bool is_near(const he_point_grid *t, he_vec3 a, he_vec3 b)
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

uint32_t he_point_grid_find(const he_point_grid *t, he_vec3 p, uint32_t *home)
{
    double x[3], y[3], z[3];
    size_t nx = cells_of(t, p.x, x), ny = cells_of(t, p.y, y), nz = cells_of(t, p.z, z);
    uint32_t best = HE_NONE;
    *home = he_point_hash(t->seed, (he_vec3){x[0], y[0], z[0]});
    for (size_t i = 0; i < nx * ny * nz; i++) {
        const he_vec3 cell = {x[i % nx], y[i / nx % ny], z[i / nx / ny]};
        uint32_t h = i == 0 ? *home : he_point_hash(t->seed, cell);
        for (size_t at = h & t->mask; t->slots[at].number != 0; at = (at + 1) & t->mask) {
            uint32_t v = t->slots[at].number - 1;
            if (t->slots[at].hash == h && v < best && is_near(t, t->points[v], p)) {
                best = v;
            }
        }
    }
    return best;
}

void he_point_grid_keep(he_point_grid *t, uint32_t home, uint32_t number)
{
    size_t at = home & t->mask;
    while (t->slots[at].number != 0) {
        at = (at + 1) & t->mask;
    }
    t->slots[at] = (he_point_grid_slot){home, number + 1};
}
