/* edit_code.h - the constants of a stored edit (stored.h). Only core/stored uses it. No number may
 * change its meaning, because stored edits contain it. */
#ifndef HE_STORED_EDIT_CODE_H
#define HE_STORED_EDIT_CODE_H

#include "mesh/delta.h"

typedef enum he_code {
    HE_CODE_NEXT = 0,
    HE_CODE_PREV = 1,
    HE_CODE_ORIGIN = 2,
    HE_CODE_FACE = 3,
    HE_CODE_VERTEX_HALFEDGE = 4,
    HE_CODE_FACE_HALFEDGE = 5,
    HE_CODE_POSITION = 6,
    HE_CODE_PARENT = 7,
    HE_CODE_MERGED = 8,
    HE_CODE_ATTRIBUTE = 9,
    HE_CODE_OBJECT = 10,
    HE_CODE_COUNT = 11
} he_code;

typedef enum he_object {
    HE_OBJECT_ADDED = 1,
    HE_OBJECT_DROPPED = 2,
    HE_OBJECT_REPLACED = 3,
    HE_OBJECT_MATERIAL = 4,
    HE_OBJECT_POSITIONS = 5
} he_object;

/* The kind of element that each number stands for in a stored lineage record (delta.h). */
static const he_kind he_code_kinds[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE};
enum { HE_CODE_KINDS = sizeof he_code_kinds / sizeof *he_code_kinds };

/* Sizes in bytes: HE_CHANGE_LEAST is the smallest size of a change; the others are the largest
 * sizes of the head of an edit, a change, the head of an object and a slot number. */
enum {
    HE_EDIT_HEAD = 1 + 10,
    HE_CHANGE_ROOM = 20,
    HE_CHANGE_LEAST = 3,
    HE_OBJECT_HEAD = 1 + 1 + 8, /* code, kind, length */
    HE_SLOT_ROOM = 5
};

#endif
