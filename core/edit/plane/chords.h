/* chords.h - the diagonals along which a plane cuts a face.
 *
 * The sides of the face have been split where they cross the plane, so a side meets the plane only
 * at corners. In a planar face the corners in the plane are on a line. Just above this line, the
 * inside of the face begins or ends at every corner that has a neighbour above the plane; below the
 * line, at every corner that has a neighbour below. A chord joins two successive corners on the
 * line if the inside is both above and below the line between them:
 *
 *        o-------------o               o-------------o
 *        |    above    |               |             |
 *        |      o      |               |      o      |
 *        |     / \     |               |     / \     |
 *    ....a....b...c....d....    --->   a----b   c----d
 *        |   /     \   |               |   /     \   |
 *        o--o below o--o               o--o       o--o
 *
 * This is the sweep of even-odd filling (J. D. Foley, A. van Dam, S. K. Feiner and J. F. Hughes,
 * "Computer Graphics: Principles and Practice", 1990, 3.6) along one line.
 *
 * In a face that is not planar, or crosses itself, the corners in the plane need not be on a line.
 * They are then sorted along the direction from the first of them to the farthest. If the chords
 * found in this way would cross, or leave a part with corners on both sides of the plane, other
 * chords are used: each cuts off a sequence of successive corners that are on one side of the
 * plane. So these rules always hold: a chord joins two corners in the plane that are not
 * neighbours; chords do not cross; no part of the face has corners on both sides of the plane; the
 * two parts beside a chord are on different sides. */
#ifndef HE_EDIT_PLANE_CHORDS_H
#define HE_EDIT_PLANE_CHORDS_H

#include "edit/plane/plane.h"

/* The diagonals (chords) of one face, and the buffers for finding them, which are used again for
 * the next face; {0} at first. */
typedef struct he_chords {
    uint32_t n;
    he_ids corner; /* the n half-edges of the face, the face's stored half-edge last */
    /* Two entries for each chord: the indices of its corners in `corner`, the lower index first. A
     * chord is listed after all chords whose corners lie between its own corners. */
    he_ids pairs;
    /* the members below are used only while chords are planned */
    he_ids partners; /* two entries for each corner: the corners to which chords join it */
    /* A stack of the chords that have begun, but not ended, at the corner that is being visited.
     * Each is stored with the sides of the plane on which the part of the face inside the chord has
     * corners. */
    he_ids open;
    struct he_line_crossing *line;
    size_t line_capacity;
} he_chords;

/* Finds the chords of face f. The face has none unless it has corners on both sides of the plane.
 * Takes linear time, except for sorting the corners that lie in the plane. he_chords_clear frees
 * *chords.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_chords_plan(const he_mesh *m, he_face f, const he_sides *sides,
                                      he_chords *chords, he_error *err);
void he_chords_clear(he_chords *chords);

#endif
