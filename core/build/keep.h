/* keep.h - what vertices of a soup say that are to be joined, kept by their corners.
 *
 * edit/piece/keep.h does this for meshes, and has the drawing and the rules: where a vertex with
 * corners joins one with another value of an attribute, the attribute becomes one of corners. */
#ifndef HE_BUILD_KEEP_H
#define HE_BUILD_KEEP_H

#include "build/build.h"

/* Vertex v is to be part of from[into[v]], where it is not that one itself. Done before corners get
 * the numbers of others. `moved` counts the values that differ. HE_LIMIT, HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_soup_keep_values(he_soup *soup, const uint32_t *into,
                                           const uint32_t *from, uint64_t *moved, he_error *err);
/* The vertex attribute of this name, where there is one, becomes one of corners, with the value of
 * its vertex for each. Fails likewise. */
HE_NODISCARD he_status he_soup_to_corners(he_soup *soup, const char *name, he_error *err);

#endif
