/* rest.h - checks the edges and fans of a soup that also has faces no mesh can represent. */
#ifndef HE_BUILD_REST_H
#define HE_BUILD_REST_H

#include "build/build.h"

/* Checks the edges and fans of the valid faces, after he_soup_check_faces found faces that are not
 * valid. Appends to the report, which may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_soup_check_rest(const he_soup *soup, he_report *report, uint64_t *total,
                                          he_error *err);

#endif
