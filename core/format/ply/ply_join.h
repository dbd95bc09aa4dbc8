/* ply_join.h - what the marks of ply_groups.h say of a file that was read: attributes go to
 * corners, and copies of vertices become part of them. */
#ifndef HE_FORMAT_PLY_PLY_JOIN_H
#define HE_FORMAT_PLY_PLY_JOIN_H

#include "format/io/format.h"
#include "format/ply/ply_header.h"

/* Does the header say that this attribute is of corners? */
bool he_ply_is_of_corners(const he_ply_header *header, const char *attribute);
/* None of it is believed: a program that changed the file may have kept it. Copies that lie
 * elsewhere than their vertices stay vertices, with a note. HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_ply_join(he_import *into, const he_ply_header *header, he_error *err);

#endif
