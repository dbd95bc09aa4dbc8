/* rest.h - what else is wrong with a soup some of whose faces are not proper. */
#ifndef HE_BUILD_REST_H
#define HE_BUILD_REST_H

#include "build/build.h"

/* Faces of a soup were found that no mesh can hold by themselves. Appends to the report, which may
 * be NULL, what is wrong among the others: their edges and fans. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_soup_check_rest(const he_soup *soup, he_report *report, uint64_t *total,
                                          he_error *err);

#endif
