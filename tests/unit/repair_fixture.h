/* repair_fixture.h - repairs soups (lists of unconnected faces), and checks what must hold for
 * every repaired soup. */
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

/* Returns a plan of the repairs in the bit set `which`; holes are filled if they have up to 8
 * edges. */
he_repair_plan repair_plan_of(unsigned which);

/* Makes a soup with the faces of `from`. Each attribute value is the number of its own row, so that
 * a test can see where the value came from after a repair. */
void repair_copy_soup(const he_soup *from, he_soup *to);

/* Returns the report of what one kind of repair did, such as how many faces it changed. */
const he_repair_account *repair_account_of(const he_repaired *done, he_repair repair);

/* Requires that after a repair each attribute value still belongs to the element that had it
 * before, and that each corner is at its old vertex or at the vertex into which the old one was
 * welded. */
void repair_expect_carried(const he_soup *before, const he_soup *after, const he_repaired *done,
                           bool welded);

/* Repairs the soup again and again, while the first, second, ... allocation fails, until none
 * fails. No repair may succeed if one of its first `least` allocations fails. */
void repair_expect_failures_survived(const he_soup *soup, unsigned which, long least);

/* Repairs a soup, builds a mesh of the result and checks the mesh, which the caller must free. */
he_mesh *repair_mend(const he_soup *soup, const he_repair_plan *plan, he_repaired *done);

/* Makes a soup of `faces`, written as in fixture.h, and repairs it like repair_mend(). */
he_mesh *repair_mend_faces(const char *faces, unsigned which, he_repaired *done);

#endif
