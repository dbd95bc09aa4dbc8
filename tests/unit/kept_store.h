/* kept_store.h - a store on the journal of tests/kept_journal.h, from which meshes can be loaded
 * again. */
#ifndef TESTS_UNIT_KEPT_STORE_H
#define TESTS_UNIT_KEPT_STORE_H

#include "store/store.h"
#include "tests/kept_journal.h"

/* Opens the store. `pool` may be NULL: then no new bases (records with a whole content) are
 * made. */
st_store *kept_store_open(kept_journal *journal, uint64_t budget, st_pool *pool);
/* Makes a mesh of five faces with columns of attributes. */
st_mesh *kept_store_make(st_store *store, const char *id);
/* Loads a mesh, which must not be in memory yet and not be damaged. */
st_mesh *kept_store_load(st_store *store, const char *id);
/* Requires that two meshes have equal content, revisions, times and history. */
void kept_store_expect_same(st_mesh *was, st_mesh *is);

#endif
