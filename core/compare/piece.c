#include "compare/piece.h"

#include "geometry/scale.h"

/* A corner is on a plane if its distance is at most this share of the piece's largest
 * coordinate. */
static const double ON_PLANE = 0x1p-47;

static void add(he_piece *piece, he_vec3 p)
{
    piece->corner[piece->count++] = p;
}

static he_vec3 between(he_vec3 a, he_vec3 b, double t)
{
    return he_vec3_add(he_vec3_scale(a, 1 - t), he_vec3_scale(b, t));
}

bool he_piece_cut(const he_piece *piece, const he_cut_plane *plane, he_piece *front,
                  he_piece *behind)
{
    double side[HE_PIECE_CORNERS], extent = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        extent = fmax(extent, he_vec3_extent(piece->corner[i]));
    }
    uint32_t before = 0, after = 0, crossings = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        side[i] = he_vec3_dot(piece->corner[i], plane->normal) - plane->offset;
        side[i] = fabs(side[i]) <= ON_PLANE * extent ? 0 : side[i];
        before += side[i] > 0;
        after += side[i] < 0;
    }
    for (uint32_t i = 0; i < piece->count; i++) {
        const double next = side[(i + 1) % piece->count];
        crossings += (side[i] > 0 && next < 0) || (side[i] < 0 && next > 0);
    }
    /* Each part gets at most two corners in place of those on the other side, unless rounding has
     * left a piece that is not convex. */
    if (before == 0 || after == 0 || crossings > 2 || piece->count - after + 2 > HE_PIECE_CORNERS ||
        piece->count - before + 2 > HE_PIECE_CORNERS) {
        return false;
    }
    he_piece parts[2] = {*piece, *piece};
    parts[0].count = parts[1].count = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        const uint32_t k = (i + 1) % piece->count;
        if (side[i] >= 0) {
            add(&parts[0], piece->corner[i]);
        }
        if (side[i] <= 0) {
            add(&parts[1], piece->corner[i]);
        }
        if ((side[i] > 0 && side[k] < 0) || (side[i] < 0 && side[k] > 0)) {
            const he_vec3 p =
                between(piece->corner[i], piece->corner[k], side[i] / (side[i] - side[k]));
            add(&parts[0], p);
            add(&parts[1], p);
        }
    }
    *front = parts[0];
    *behind = parts[1];
    return true;
}

double he_piece_longest(const he_piece *piece, uint32_t ends[2])
{
    double longest = 0;
    ends[0] = ends[1] = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        for (uint32_t k = i + 1; k < piece->count; k++) {
            const he_vec3 way = he_vec3_sub(piece->corner[k], piece->corner[i]);
            const double square = he_vec3_dot(way, way);
            if (square > longest) {
                longest = square;
                ends[0] = i;
                ends[1] = k;
            }
        }
    }
    return longest;
}

/* Cuts a piece along the diagonal between two corners that are not neighbours, which gives both
 * parts fewer corners than the piece has. */
static void cut_along(const he_piece *piece, uint32_t from, uint32_t to, he_piece *front,
                      he_piece *behind)
{
    he_piece parts[2] = {*piece, *piece};
    parts[0].count = parts[1].count = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        if (i >= from && i <= to) {
            add(&parts[0], piece->corner[i]);
        }
        if (i <= from || i >= to) {
            add(&parts[1], piece->corner[i]);
        }
    }
    *front = parts[0];
    *behind = parts[1];
}

bool he_piece_halve(const he_piece *piece, he_piece *front, he_piece *behind)
{
    uint32_t ends[2];
    if (!(he_piece_longest(piece, ends) > 0)) {
        return false;
    }
    if (piece->count > HE_PIECE_CORNERS - 2) {
        cut_along(piece, 0, piece->count / 2, front, behind);
        return true;
    }
    const he_vec3 a = piece->corner[ends[0]], b = piece->corner[ends[1]];
    he_cut_plane plane;
    he_vec3_normalise(he_vec3_sub(b, a), &plane.normal);
    plane.offset = he_vec3_dot(between(a, b, 0.5), plane.normal);
    return he_piece_cut(piece, &plane, front, behind);
}

he_vec3 he_piece_middle(const he_piece *piece)
{
    he_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < piece->count; i++) {
        sum = he_vec3_add(sum, piece->corner[i]);
    }
    return he_vec3_scale(sum, 1.0 / piece->count);
}
