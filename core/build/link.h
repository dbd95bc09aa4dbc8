/* link.h - from the turns of a soup's corners to the links of a mesh: he_build's second half. */
#ifndef HE_BUILD_LINK_H
#define HE_BUILD_LINK_H

#include "build/turn.h"
#include "mesh/layout.h"

/* Issue the edges and faces of the soup, for which `c` has room, and write their links and those of
 * the vertices, which are there. Edges are numbered as build.h says. turns->turn becomes the
 * half-edge of each corner; turns->first is read. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_build_links(const he_corners *corners, he_turns *turns, he_content *c,
                                      he_error *err);

#endif
