/* kept_store.h - opens a mesh store that writes to the journal of tests/kept_journal.h; stored
 * meshes can be loaded again from this journal. */
#ifndef TESTS_UNIT_KEPT_STORE_H
#define TESTS_UNIT_KEPT_STORE_H

#include "store/store.h"
#include "tests/kept_journal.h"

/* Opens the store. If `pool` is NULL, the store never replaces many small records of a mesh by a
 * new record of the whole mesh. */
st_store *kept_store_open(kept_journal *journal, uint64_t budget, st_pool *pool);
/* Makes a stored mesh of five faces with columns of attributes. */
st_mesh *kept_store_make(st_store *store, const char *id);
/* Loads a stored mesh into memory; it must not be loaded already, and its records must be
 * intact. */
st_mesh *kept_store_load(st_store *store, const char *id);
/* Requires that two stored meshes have equal elements and attributes, revisions, times and
 * history. */
void kept_store_expect_same(st_mesh *was, st_mesh *is);

#endif
