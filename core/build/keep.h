/* keep.h - joins vertices of a soup without losing their attributes: values that differ move to the
 * corners.
 *
 * If two vertices that are joined have different values of an attribute, and the one that
 * disappears has corners, the attribute becomes an attribute of corners, so that neither value is
 * lost. edit/piece/keep.h does this for meshes; it has a drawing and the rules. */
#ifndef HE_BUILD_KEEP_H
#define HE_BUILD_KEEP_H

#include "build/build.h"

/* Moves values of vertices to corners before vertices are joined: each vertex v will be joined to
 * vertex from[into[v]], which may be v itself. The caller must do this before it changes the
 * corners. *moved is set to the number of values that differ from those of the vertex to which v is
 * joined.
 * Returns HE_LIMIT if a limit of the soup would be exceeded.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_soup_keep_values(he_soup *soup, const uint32_t *into,
                                           const uint32_t *from, uint64_t *moved, he_error *err);
/* Turns the vertex attribute called `name`, if there is one, into an attribute of corners: each
 * corner gets the value of its vertex. Returns the errors of he_soup_keep_values. */
HE_NODISCARD he_status he_soup_to_corners(he_soup *soup, const char *name, he_error *err);

#endif
