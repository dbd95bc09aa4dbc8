/* ply_join.h - applies the marks of ply_groups.h to a file that was read: moves attributes to
 * corners, and merges copies of vertices. */
#ifndef HE_FORMAT_PLY_PLY_JOIN_H
#define HE_FORMAT_PLY_PLY_JOIN_H

#include "format/io/format.h"
#include "format/ply/ply_header.h"

/* Does the header mark this attribute as one of corners? */
bool he_ply_is_of_corners(const he_ply_header *header, const char *attribute);
/* Checks the marks before it applies them, because a program that changed the file may have kept
 * them. Copies at another position than their vertex stay vertices, with a note.
 * Returns HE_LIMIT if a limit of the import would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ply_join(he_import *into, const he_ply_header *header, he_error *err);

#endif
