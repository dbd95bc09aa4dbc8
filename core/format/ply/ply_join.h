/* ply_join.h - applies the marks of ply_groups.h to a file that was read: moves attributes to
 * corners, and merges copies of vertices. */
#ifndef HE_FORMAT_PLY_PLY_JOIN_H
#define HE_FORMAT_PLY_PLY_JOIN_H

#include "format/io/format.h"
#include "format/ply/ply_header.h"

/* Returns true if the header marks this attribute as one of corners. */
bool he_ply_is_of_corners(const he_ply_header *header, const char *attribute);
/* Moves the attributes that are marked as those of corners to corners, and merges copies of
 * vertices. Checks the marks first, because a program that changed the file may have kept them. A
 * copy at another position than its vertex stays a vertex, with a warning.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_join(he_import *into, const he_ply_header *header, he_error *err);

#endif
