/* chords.h - the diagonals along which a plane cuts a face.
 *
 * The face is one whose sides nowhere pass from one side of the plane to the other except at a
 * corner in the plane. Those corners lie, in a planar face, on a line; walking along it, the inside
 * of the face just above the line begins or ends at every corner with a neighbour above, and the
 * same holds below. A chord joins two successive corners on the line where both are inside:
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
 * In a face that is not planar, or crosses itself, the corners need not be on a line, and are taken
 * in their order along the direction in which they spread furthest. Where chords found so would
 * cross, or leave a part with corners on both sides, every run of corners on one side is cut off
 * from the others instead. So always: chords join corners in the plane that are not neighbours and
 * do not cross, all corners of a part are on one side or in the plane, and the two parts beside a
 * chord are on different sides. */
#ifndef HE_EDIT_PLANE_CHORDS_H
#define HE_EDIT_PLANE_CHORDS_H

#include "edit/plane/plane.h"

/* Reused from face to face; {0} at first. */
typedef struct he_chords {
    uint32_t n;
    he_ids corner; /* n half-edges of the face: the stored one last */
    he_ids pairs; /* two places in `corner` for each chord, the lower one first. A chord comes after
                     all those between its places. */
    /* what planning needs */
    he_ids partners; /* two for each corner */
    he_ids open;     /* chords begun and not ended, and what is in the part beside each */
    struct he_line_crossing *line;
    size_t line_capacity;
} he_chords;

/* No pairs where the face has not corners on both sides. Linear but for sorting the corners in the
 * plane. HE_NO_MEMORY. he_chords_clear frees. */
HE_NODISCARD he_status he_chords_plan(const he_mesh *m, he_face f, const he_sides *sides,
                                      he_chords *chords, he_error *err);
void he_chords_clear(he_chords *chords);

#endif
