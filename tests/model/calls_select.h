/* calls_select.h - draws calls of the operation select, and compares each element with what the
 * oracle says. */
#ifndef TESTS_MODEL_CALLS_SELECT_H
#define TESTS_MODEL_CALLS_SELECT_H

#include "model/arguments.h"

/* Draws the arguments of a call of `select`; always returns true. */
bool md_select_draw(md_draft *d);
/* Returns the set of refusals of a call. If it is empty, `verdict` says for each element whether it
 * belongs to the set afterwards; `m` is hedge's mesh before the call, from which values of
 * attributes are read. */
uint64_t md_select_foresee(const md_call *c, or_mesh *o, const he_mesh *m,
                           or_verdict verdict[OR_ROWS]);
/* Returns the kind of the elements that a call selects. */
he_kind md_select_kind(const md_call *c);
/* Returns whether an element belongs to the set that the call writes. */
bool md_select_has(const md_call *c, const he_mesh *m, uint32_t id);

#endif
