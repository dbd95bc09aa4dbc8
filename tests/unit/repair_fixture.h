/* repair_fixture.h - repairs soups, and checks what must hold for every repaired soup. */
#ifndef TESTS_UNIT_REPAIR_FIXTURE_H
#define TESTS_UNIT_REPAIR_FIXTURE_H

#include "unit/fixture.h"

#include "build/soup_check.h"
#include "repair/repair.h"
#include "tests/failing.h"

enum { ALL = (1 << HE_REPAIR_COUNT) - 1 };

#define WELD       (1u << HE_REPAIR_WELD)
#define DEGENERATE (1u << HE_REPAIR_DROP_DEGENERATE)
#define DUPLICATES (1u << HE_REPAIR_DROP_DUPLICATES)
#define ORIENT     (1u << HE_REPAIR_ORIENT)
#define SPLIT      (1u << HE_REPAIR_SPLIT)
#define FILL       (1u << HE_REPAIR_FILL)

/* Returns a plan of this set of repairs, which fills holes of up to 8 edges. */
he_repair_plan repair_plan_of(unsigned which);

/* Makes a soup with the faces of another one; the value of each attribute is the number of its row,
 * so that moved values can be recognized. */
void repair_copy_soup(const he_soup *from, he_soup *to);

/* Returns what a repair did. */
const he_repair_account *repair_account_of(const he_repaired *done, he_repair repair);

/* Requires that attributes stayed with their elements, and that every corner is at its old vertex,
 * or at the vertex into which that was welded. */
void repair_expect_carried(const he_soup *before, const he_soup *after, const he_repaired *done,
                           bool welded);

/* Repairs while the N-th allocation fails, for every N until none fails; no repair may succeed
 * without one of its first `least` allocations. */
void repair_expect_failures_survived(const he_soup *soup, unsigned which, long least);

/* Repairs a soup, builds a mesh of it and checks the mesh, which the caller must free. */
he_mesh *repair_mend(const he_soup *soup, const he_repair_plan *plan, he_repaired *done);

/* Repairs the soup of these faces (fixture.h) as repair_mend() does. */
he_mesh *repair_mend_faces(const char *faces, unsigned which, he_repaired *done);

#endif
