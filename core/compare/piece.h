/* piece.h - convex polygons, the parts into which a triangle is cut.
 *
 * A piece has at most HE_PIECE_CORNERS corners, in order around it. A cut by a plane makes two
 * pieces, which share the corners on the plane. */
#ifndef HE_COMPARE_PIECE_H
#define HE_COMPARE_PIECE_H

#include "geometry/vec3.h"

enum { HE_PIECE_CORNERS = 8 };

typedef struct he_piece {
    he_vec3 corner[HE_PIECE_CORNERS];
    uint32_t count;
    uint32_t triangle; /* the triangle of which it is a part */
    /* Two triangles of the other surface by which the piece may be cut, the nearest to its middle
     * and the nearest to the corner that is farthest from it. */
    uint32_t nearest, other;
    double upper; /* no point of the piece has a larger distance from the other surface */
} he_piece;

/* The plane of the points p with normal * p = offset. */
typedef struct he_cut_plane {
    he_vec3 normal;
    double offset;
} he_cut_plane;

/* Cuts a piece into the part in front of a plane (to which the normal points) and the part behind.
 * Returns false, and makes nothing, if one of the two would be the whole piece up to rounding, or
 * would have too many corners. */
bool he_piece_cut(const he_piece *piece, const he_cut_plane *plane, he_piece *front,
                  he_piece *behind);
/* Cuts a piece in two, across its longest diagonal or side. Returns false if all corners are at one
 * place. */
bool he_piece_halve(const he_piece *piece, he_piece *front, he_piece *behind);
he_vec3 he_piece_middle(const he_piece *piece);
/* Returns the squared length of the longest diagonal or side, and its two ends. */
double he_piece_longest(const he_piece *piece, uint32_t ends[2]);

#endif
