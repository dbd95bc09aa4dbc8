/* kept_store.h - a store on a journal of tests/kept_journal.h, from which meshes are loaded. */
#ifndef TESTS_UNIT_KEPT_STORE_H
#define TESTS_UNIT_KEPT_STORE_H

#include "store/store.h"
#include "tests/kept_journal.h"

/* `pool` may be NULL: then no newer bases are made. */
st_store *kept_store_open(kept_journal *journal, uint64_t budget, st_pool *pool);
/* A mesh of five faces with columns. */
st_mesh *kept_store_make(st_store *store, const char *id);
/* Loads a mesh that is not in memory yet and not damaged. */
st_mesh *kept_store_load(st_store *store, const char *id);
/* Requires that two meshes have equal content, facts and history. */
void kept_store_expect_same(st_mesh *was, st_mesh *is);

#endif
