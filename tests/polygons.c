#include "polygons.h"

#include "build/build.h"

#include <math.h>
#include <stdlib.h>

static const double TURN = 6.283185307179586;

static he_vec3 polar(double radius, double angle)
{
    return (he_vec3){radius * cos(angle), radius * sin(angle), 0};
}

static void turn_all(uint32_t n, he_vec3 *p, double angle)
{
    for (uint32_t i = 0; i < n; i++) {
        double x = p[i].x, y = p[i].y;
        p[i].x = x * cos(angle) - y * sin(angle);
        p[i].y = x * sin(angle) + y * cos(angle);
    }
}

/* Returns a pseudo-random number from 0 to 1: xorshift64 (Marsaglia 2003). */
static double random_number(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return ldexp((double)(*state >> 11), -53);
}

/* --- simple polygons --- */

static void disc(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = polar(1, TURN * i / n);
    }
}

static void star(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = polar(i % 2 == 0 ? 1 : 0.5, TURN * i / n);
    }
}

/* Makes a comb: all points but two at the bottom are tips of its teeth or bottoms of its gaps. */
static void comb(uint32_t n, he_vec3 *out)
{
    out[0] = (he_vec3){0, 0, 0};
    out[1] = (he_vec3){n, 0, 0};
    for (uint32_t i = 2; i < n; i++) {
        out[i] = (he_vec3){n - i, i % 2 == 0 ? 1 : 100, 0};
    }
}

static void tilted_comb(uint32_t n, he_vec3 *out)
{
    comb(n, out);
    for (uint32_t i = 2; i < n; i++) {
        out[i].y = i % 2 == 0 ? 1 : n / 2.0;
    }
    turn_all(n, out, TURN / 8);
}

/* Makes a polygon with two rows of teeth, above and below, that reach into each other's gaps. */
static void interlocked(uint32_t n, he_vec3 *out)
{
    uint32_t half = n / 2;
    for (uint32_t i = 0; i < half; i++) {
        out[i] = (he_vec3){2.0 * i, i % 2 == 0 ? 0 : 100, 0};
        out[n - 1 - i] = (he_vec3){2.0 * i, i % 2 == 0 ? 1 : 101, 0};
    }
}

/* Makes a zigzag: the polygon of interlocked() with longer teeth, rotated. */
static void zigzag(uint32_t n, he_vec3 *out)
{
    interlocked(n, out);
    for (uint32_t i = 0; i < n; i++) {
        out[i].y *= n / 100.0;
        out[i].y += i < n / 2 ? 0 : 1;
    }
    turn_all(n, out, TURN / 8);
}

static void spiral(uint32_t n, he_vec3 *out)
{
    uint32_t half = n / 2;
    /* The spiral gets the largest number of turns for which the sides of one turn do not cross the
     * next turn. */
    double turns = fmin(40, cbrt(0.03 * half * half));
    for (uint32_t i = 0; i < half; i++) {
        double angle = TURN * turns * i / half, radius = 1 + angle / TURN;
        out[i] = polar(radius + 0.5, angle);
        out[n - 1 - i] = polar(radius, angle);
    }
}

/* Makes a spiral in which each turn has a third of the size of the turn around it, so that all
 * scales occur in one polygon. */
static void deep_spiral(uint32_t n, he_vec3 *out)
{
    uint32_t half = n / 2;
    double turns = fmin(12, half / 10.0);
    for (uint32_t i = 0; i < half; i++) {
        double angle = TURN * turns * i / half, radius = pow(3, angle / TURN);
        out[i] = polar(1.5 * radius, angle);
        out[n - 1 - i] = polar(radius, angle);
    }
}

/* Makes an hourglass of two arcs that nearly touch, turned by 45 degrees: all corners but four are
 * reflex. */
static void hourglass(uint32_t n, he_vec3 *out)
{
    uint32_t half = n / 2;
    for (uint32_t i = 0; i < half; i++) {
        double x = -1 + 2.0 * i / (half - 1), y = 0.0001 + 0.05 * x * x;
        out[i] = (he_vec3){x, -y, 0};
        out[n - 1 - i] = (he_vec3){x, y, 0};
    }
    turn_all(n, out, TURN / 8);
}

/* Makes a square with a notch that has many corners. */
static void bite(uint32_t n, he_vec3 *out)
{
    static const he_vec3 corners[] = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
    for (uint32_t i = 0; i < 4; i++) {
        out[i] = corners[i];
    }
    for (uint32_t i = 4; i < n; i++) {
        out[i] = polar(0.99, -1.5 + 3.0 * (i - 4) / (n - 5));
        out[i].x = 1 - out[i].x + 0.05;
    }
}

/* Makes a square with many corners on each side, all with exact coordinates. */
static void straight_sides(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t side = (uint32_t)((uint64_t)4 * i / n),
                 first = (uint32_t)(((uint64_t)side * n + 3) / 4);
        uint32_t most = n / 4 + 1;
        double t = i - first, m = most;
        const he_vec3 places[] = {{t, 0, 0}, {m, t, 0}, {m - t, m, 0}, {0, m - t, 0}};
        out[i] = places[side];
    }
}

/* Makes a disc with coordinates as a text file stores them: because of the rounding, a corner may
 * be convex or reflex. */
static void rounded_disc(uint32_t n, he_vec3 *out)
{
    disc(n, out);
    for (uint32_t i = 0; i < n; i++) {
        out[i].x = rint(out[i].x * 4e6) / 4e6;
        out[i].y = rint(out[i].y * 4e6) / 4e6;
    }
}

static void random_star(uint32_t n, he_vec3 *out)
{
    uint64_t state = 88172645463325252u;
    for (uint32_t i = 0; i < n; i++) {
        out[i] = polar(0.01 + random_number(&state), TURN * (i + 0.9 * random_number(&state)) / n);
    }
}

/* The cells of a square grid that are connected as a tree. The bits of a cell tell which sides are
 * open to a neighbour; the bit 16 tells that the cell was reached. */
typedef struct cells {
    uint32_t side, *open;
} cells;

static const int step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

static uint32_t beside(const cells *c, uint32_t at, uint32_t d)
{
    int64_t x = (int64_t)(at % c->side) + step[d][0], y = (int64_t)(at / c->side) + step[d][1];
    bool inside = x >= 0 && y >= 0 && x < c->side && y < c->side;
    return inside ? (uint32_t)(y * c->side + x) : HE_NONE;
}

static void grow_tree(cells *c, uint32_t count, uint32_t *stack)
{
    uint64_t state = 88172645463325252u;
    uint32_t depth = 0;
    c->open[0] = 16;
    stack[depth++] = 0;
    for (uint32_t reached = 1; reached < count;) {
        uint32_t at = stack[depth - 1], first = (uint32_t)(4 * random_number(&state)), k = 0;
        for (; k < 4; k++) {
            uint32_t d = (first + k) % 4, to = beside(c, at, d);
            if (to != HE_NONE && c->open[to] == 0) {
                c->open[at] |= 1u << d;
                c->open[to] |= 16u | 1u << (d + 2) % 4;
                stack[depth++] = to;
                reached++;
                break;
            }
        }
        depth -= k == 4;
    }
}

static he_vec3 corner_of_cell(const cells *c, uint32_t at, uint32_t which)
{
    static const double corner[4][2] = {{0.2, 0.2}, {0.8, 0.2}, {0.8, 0.8}, {0.2, 0.8}};
    uint32_t column = at % c->side, row = at / c->side;
    return (he_vec3){column + corner[which][0], row + corner[which][1], 0};
}

/* Walks along the walls of the maze, with the wall on its right, until it is back at the start.
 * Returns the number of corners. */
static uint32_t walk_outline(const cells *c, he_vec3 *out)
{
    uint32_t at = 0, d = 0, made = 0;
    do {
        uint32_t right = (d + 3) % 4;
        if (c->open[at] >> right & 1) {
            out[made++] = corner_of_cell(c, at, d);
            d = right;
            at = beside(c, at, d);
        } else if (c->open[at] >> d & 1) {
            at = beside(c, at, d);
        } else {
            out[made++] = corner_of_cell(c, at, (d + 1) % 4);
            d = (d + 1) % 4;
        }
    } while (at != 0 || d != 0);
    return made;
}

/* Makes the outline of a maze, a tree of cells. The outline has at most four corners per cell;
 * further corners are put on straight sides. */
static void maze(uint32_t n, he_vec3 *out)
{
    cells c = {.side = (uint32_t)sqrt(n / 4.0) + 1};
    c.open = calloc((size_t)c.side * c.side, sizeof *c.open);
    uint32_t *stack = calloc((size_t)c.side * c.side, sizeof *stack);
    if (c.open == NULL || stack == NULL) {
        abort();
    }
    grow_tree(&c, n / 4, stack);
    uint32_t made = walk_outline(&c, out), left = n - made;
    /* The corners that are still missing are spread over the sides. The loop goes from the last
     * side to the first, so that it can move the positions in place. */
    he_vec3 end = out[0];
    for (uint32_t i = made, to = n; i-- > 0;) {
        uint32_t extra = (uint32_t)((uint64_t)left * (i + 1) / made - (uint64_t)left * i / made);
        he_vec3 a = out[i];
        for (uint32_t k = extra; k > 0; k--) {
            double t = (double)k / (extra + 1);
            out[--to] = (he_vec3){a.x + t * (end.x - a.x), a.y + t * (end.y - a.y), 0};
        }
        out[--to] = a;
        end = a;
    }
    free(c.open);
    free(stack);
}

/* --- polygons that are not simple --- */

static void one_point(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = (he_vec3){1, 2, 0};
    }
}

static void line(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = (he_vec3){i, 0, 0};
    }
}

static void scribble(uint32_t n, he_vec3 *out)
{
    uint64_t state = 88172645463325252u;
    for (uint32_t i = 0; i < n; i++) {
        out[i].x = random_number(&state);
        out[i].y = random_number(&state);
        out[i].z = 0;
    }
}

/* Makes a star polygon that winds around its centre nearly as often as it has points. */
static void dense_star(uint32_t n, he_vec3 *out)
{
    const uint32_t half = n / 2;
    for (uint32_t i = 0; i < n; i++) {
        double angle = TURN / 2 * (double)i * (half - 1) / half;
        out[i] = polar(i % 2 == 0 ? 1 : 0.999, angle);
    }
}

/* Makes a polygon that winds around a disc a few hundred times. */
static void wound(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = polar(i % 2 == 0 ? 1 : 0.9, TURN * i * 301 / n);
    }
}

/* Makes a polygon that visits four points again and again. */
static void repeated(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        out[i] = (he_vec3){i / 2 % 2, (i + 1) / 2 % 2, 0};
    }
}

/* Makes a disc with a hole. A bridge, which the outline walks in both directions, connects the hole
 * with the outside. */
static void keyhole(uint32_t n, he_vec3 *out)
{
    uint32_t half = n / 2;
    for (uint32_t i = 0; i < half; i++) {
        out[i] = polar(1, TURN * i / (half - 1));
        out[half + i] = polar(0.9, -TURN * i / (half - 1));
    }
    out[half - 1] = out[0];
    out[n - 1] = out[half];
}

/* Makes a figure eight, whose outline crosses itself. */
static void crossed(uint32_t n, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        double t = TURN * i / n;
        out[i] = (he_vec3){sin(t), sin(2 * t) + 0.1 * cos(t), 0};
    }
}

const polygon_shape polygon_shapes[] = {
    {"disc", true, disc},
    {"rounded disc", false, rounded_disc},
    {"star", true, star},
    {"comb", true, comb},
    {"tilted comb", true, tilted_comb},
    {"interlocked", true, interlocked},
    {"zigzag", true, zigzag},
    {"spiral", true, spiral},
    {"deep spiral", true, deep_spiral},
    {"hourglass", true, hourglass},
    {"bite", true, bite},
    {"straight sides", true, straight_sides},
    {"random star", true, random_star},
    {"maze", true, maze},
    {"one point", false, one_point},
    {"line", false, line},
    {"scribble", false, scribble},
    {"dense star", false, dense_star},
    {"wound", false, wound},
    {"repeated", false, repeated},
    {"keyhole", false, keyhole},
    {"crossed", false, crossed},
};
const unsigned polygon_shape_count = sizeof polygon_shapes / sizeof *polygon_shapes;

he_mesh *polygon_mesh(const he_vec3 *points, uint32_t n)
{
    he_soup soup;
    he_mesh *m = NULL;
    he_soup_init(&soup, NULL);
    he_status status = he_soup_begin_face(&soup, NULL);
    for (uint32_t i = 0; i < n && status == HE_OK; i++) {
        status = he_soup_add_vertex(&soup, points[i], NULL);
        if (status == HE_OK) {
            status = he_soup_add_corner(&soup, i, NULL);
        }
    }
    if (status == HE_OK) {
        status = he_build(&soup, 0, &m, NULL, NULL);
    }
    he_soup_clear(&soup);
    return status == HE_OK ? m : NULL;
}
