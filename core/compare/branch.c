#include "compare/comparing.h"
#include "compare/piece.h"

/* A piece much larger than the nearest triangle is halved: cuts by the sides of that triangle would
 * split off long strips. The number is the square of the ratio of their diameters. */
static const double FAR_LARGER = 16;

/* The pieces that need cuts. `heap` has their numbers in `pieces`, and is a binary heap with the
 * largest upper bound first. Numbers that are free are linked by `triangle`. */
typedef struct branch {
    he_comparing *c;
    he_piece *pieces;
    uint32_t *heap;
    size_t used, capacity, open;
    uint32_t free;
} branch;

/* --- the heap --- */

static double key(const branch *b, size_t i)
{
    return b->pieces[b->heap[i]].upper;
}

static void swap(branch *b, size_t i, size_t k)
{
    const uint32_t kept = b->heap[i];
    b->heap[i] = b->heap[k];
    b->heap[k] = kept;
}

static he_status grow(branch *b, he_error *err)
{
    const size_t capacity = he_mem_grown(b->capacity, b->used + 1);
    he_piece *pieces = he_mem_array(b->pieces, capacity, sizeof *pieces);
    b->pieces = pieces != NULL ? pieces : b->pieces;
    uint32_t *heap = pieces == NULL ? NULL : he_mem_array(b->heap, capacity, sizeof *heap);
    b->heap = heap != NULL ? heap : b->heap;
    if (heap == NULL || capacity >= HE_NONE) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the pieces of triangles");
    }
    b->capacity = capacity;
    return HE_OK;
}

static he_status push(branch *b, const he_piece *piece, he_error *err)
{
    uint32_t at = b->free;
    if (at != HE_NONE) {
        b->free = b->pieces[at].triangle;
    } else {
        he_status status = b->used < b->capacity ? HE_OK : grow(b, err);
        if (status != HE_OK) {
            return status;
        }
        at = (uint32_t)b->used++;
    }
    b->pieces[at] = *piece;
    b->heap[b->open] = at;
    for (size_t i = b->open++; i > 0 && key(b, (i - 1) / 2) < key(b, i); i = (i - 1) / 2) {
        swap(b, i, (i - 1) / 2);
    }
    return HE_OK;
}

static he_piece pop(branch *b)
{
    const uint32_t at = b->heap[0];
    const he_piece piece = b->pieces[at];
    b->pieces[at].triangle = b->free;
    b->free = at;
    b->heap[0] = b->heap[--b->open];
    for (size_t i = 0, child = 1; child < b->open; child = 2 * i + 1) {
        child += child + 1 < b->open && key(b, child + 1) > key(b, child);
        if (key(b, child) <= key(b, i)) {
            break;
        }
        swap(b, i, child);
        i = child;
    }
    return piece;
}

/* --- bounds --- */

/* Lowers the upper bound of a piece to the largest distance from one triangle. Returns the corner
 * that has it. */
static uint32_t bound_by(const branch *b, he_piece *piece, uint32_t triangle)
{
    uint32_t farthest;
    piece->upper = fmin(piece->upper, he_comparing_farthest(b->c, piece->corner, piece->count,
                                                            triangle, &farthest));
    return farthest;
}

/* Finds an upper bound of the distances of the points of a piece, and which triangles are near. The
 * piece has the bound and the near triangles of the piece from which it was cut. */
static he_status find_bound(branch *b, he_piece *piece, he_error *err)
{
    he_comparing *c = b->c;
    const he_vec3 middle = he_piece_middle(piece);
    const uint32_t former[2] = {piece->nearest, piece->other};
    double distance, radius = 0;
    he_status status =
        he_comparing_ask(c, middle, piece->triangle, &piece->nearest, &distance, err);
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t i = 0; i < piece->count; i++) {
        radius = fmax(radius, he_vec3_length(he_vec3_sub(piece->corner[i], middle)));
    }
    piece->upper = fmin(piece->upper, distance + radius);
    const uint32_t farthest = bound_by(b, piece, piece->nearest);
    for (int i = 0; i < 2 && piece->upper > c->target; i++) {
        if (former[i] != piece->nearest) {
            (void)bound_by(b, piece, former[i]);
        }
    }
    if (piece->upper > c->target) {
        piece->other = piece->nearest;
        status = he_comparing_ask(c, piece->corner[farthest], piece->triangle, &piece->other,
                                  &distance, err);
        if (status == HE_OK && piece->other != piece->nearest) {
            (void)bound_by(b, piece, piece->other);
        }
    }
    return status;
}

static he_status settle(branch *b, he_piece *piece, he_error *err)
{
    he_status status = find_bound(b, piece, err);
    if (status != HE_OK) {
        return status;
    }
    b->c->pieces++;
    if (piece->upper > b->c->target) {
        return push(b, piece, err);
    }
    b->c->settled = fmax(b->c->settled, piece->upper);
    return HE_OK;
}

/* --- cuts --- */

/* The parts into which a piece was cut: at most three outside the planes through the sides of a
 * triangle, and one inside. */
typedef struct cuttings {
    he_piece part[4];
    uint32_t count;
} cuttings;

static void corners_of(const branch *b, uint32_t triangle, he_vec3 out[3])
{
    he_bvh_corners(b->c->to.tree, b->c->to.mesh, triangle, out);
}

static he_vec3 normal_of(const he_vec3 p[3])
{
    he_vec3 unit;
    he_vec3_normalise(he_vec3_cross(he_vec3_sub(p[1], p[0]), he_vec3_sub(p[2], p[0])), &unit);
    return unit;
}

/* Cuts a piece by the planes through the sides of a triangle that are perpendicular to it. */
static bool cut_by_sides(const branch *b, const he_piece *piece, uint32_t triangle, cuttings *out)
{
    he_vec3 p[3];
    corners_of(b, triangle, p);
    const he_vec3 normal = normal_of(p);
    he_piece inside = *piece;
    out->count = 0;
    for (int k = 0; k < 3; k++) {
        he_cut_plane plane;
        he_piece front, behind;
        if (!he_vec3_normalise(he_vec3_cross(normal, he_vec3_sub(p[(k + 1) % 3], p[k])),
                               &plane.normal)) {
            continue;
        }
        plane.offset = he_vec3_dot(p[k], plane.normal);
        if (he_piece_cut(&inside, &plane, &front, &behind)) {
            out->part[out->count++] = behind;
            inside = front;
        }
    }
    out->part[out->count] = inside;
    out->count += out->count > 0;
    return out->count > 0;
}

/* Cuts a piece by the plane whose points are equally far from the planes of two triangles. There
 * are two such planes; the one that separates the points above both planes is taken, where "above"
 * is the side of the piece's middle. */
static bool cut_between(const branch *b, const he_piece *piece, cuttings *out)
{
    const uint32_t triangles[2] = {piece->nearest, piece->other};
    const he_vec3 middle = he_piece_middle(piece);
    he_cut_plane plane[2];
    for (int i = 0; i < 2; i++) {
        he_vec3 p[3];
        corners_of(b, triangles[i], p);
        plane[i].normal = normal_of(p);
        plane[i].offset = he_vec3_dot(p[0], plane[i].normal);
        if (he_vec3_dot(middle, plane[i].normal) < plane[i].offset) {
            plane[i].normal = he_vec3_scale(plane[i].normal, -1);
            plane[i].offset = -plane[i].offset;
        }
    }
    plane[0].normal = he_vec3_sub(plane[0].normal, plane[1].normal);
    plane[0].offset -= plane[1].offset;
    out->count = 2;
    return he_piece_cut(piece, &plane[0], &out->part[0], &out->part[1]);
}

/* Cuts a piece. Returns false if it is too small to be cut. */
static bool cut(const branch *b, const he_piece *piece, cuttings *out)
{
    uint32_t ends[2];
    he_piece near = {.count = 3};
    corners_of(b, piece->nearest, near.corner);
    const bool larger = he_piece_longest(piece, ends) > FAR_LARGER * he_piece_longest(&near, ends);
    const bool two = piece->other != piece->nearest;
    if (!larger && (cut_by_sides(b, piece, piece->nearest, out) ||
                    (two && cut_by_sides(b, piece, piece->other, out)) ||
                    (two && cut_between(b, piece, out)))) {
        return true;
    }
    out->count = 2;
    return he_piece_halve(piece, &out->part[0], &out->part[1]);
}

/* --- the search --- */

/* Puts the triangles whose upper bound is too large into the queue. */
static he_status begin(branch *b, he_error *err)
{
    he_comparing *c = b->c;
    uint32_t near = c->found.triangle; /* that of the former triangle */
    he_status status = HE_OK;
    for (uint32_t i = 0; status == HE_OK && i < c->from.tree->count; i++) {
        if (!(c->upper[i] > c->target)) {
            c->settled = fmax(c->settled, c->upper[i]);
            continue;
        }
        he_piece piece = {.count = 3, .triangle = i, .upper = c->upper[i]};
        he_comparing_corners(c, i, piece.corner);
        piece.nearest = piece.other =
            c->samples_wanted ? c->nearest[c->from.tree->triangles[i].vertex[0]] : near;
        status = settle(b, &piece, err);
        near = piece.nearest;
    }
    return status;
}

/* Reports how much of the gap between the bounds has been closed. */
static he_status report(const branch *b, double gap, he_error *err)
{
    const he_comparing *c = b->c;
    const double left = key(b, 0) - c->target;
    const double share = gap > 0 ? 1 - fmin(left / gap, 1) : 1;
    return he_progress_step(c->budget.progress, (uint64_t)(1000 * share), 1000, err);
}

static he_status search(branch *b, he_error *err)
{
    he_comparing *c = b->c;
    he_status status = begin(b, err);
    const double gap = b->open > 0 ? key(b, 0) - c->target : 0;
    for (uint64_t round = 0; status == HE_OK && b->open > 0 && key(b, 0) > c->target; round++) {
        if (c->most_pieces != 0 && c->pieces >= c->most_pieces) {
            c->complete = false;
            break;
        }
        cuttings parts;
        const he_piece piece = pop(b);
        if (!cut(b, &piece, &parts)) {
            c->settled = fmax(c->settled, piece.upper);
            c->complete = false;
        } else {
            for (uint32_t i = 0; status == HE_OK && i < parts.count; i++) {
                status = settle(b, &parts.part[i], err);
            }
        }
        if (status == HE_OK && b->open > 0 && round % 256 == 0) {
            status = report(b, gap, err);
        }
    }
    if (status == HE_OK && b->open > 0) {
        c->settled = fmax(c->settled, key(b, 0));
    }
    return status;
}

he_status he_compare_branch(he_comparing *c, he_error *err)
{
    branch b = {.c = c, .free = HE_NONE};
    he_status status = search(&b, err);
    he_mem_free(b.pieces);
    he_mem_free(b.heap);
    return status;
}
