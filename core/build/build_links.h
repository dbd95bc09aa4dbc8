/* build_links.h - makes the links of a mesh from the swing of each corner of a soup, which is the
 * next corner around its vertex (swing.h). This is the second half of he_build. */
#ifndef HE_BUILD_BUILD_LINKS_H
#define HE_BUILD_BUILD_LINKS_H

#include "build/swing.h"
#include "mesh/layout.h"

/* Creates the edges and faces of the soup in `c`, the arrays of the mesh, which have room for them,
 * and writes their links and those of the vertices. The vertices must exist already. Edges are
 * numbered as build.h says. Afterwards swings->swing holds the half-edge of each corner instead of
 * its swing.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_build_links(const he_corners *corners, he_swings *swings, he_content *c,
                                      he_error *err);

#endif
