/* change_marks.h - for changes.c only: collects the ids of elements that edits created, deleted or
 * modified, and remembers which words of the mesh's arrays were met.
 *
 * The ids become sorted lists without repeats. A few ids are added to these lists and sorted at the
 * end. If there are many, each element has a bit for each list, and the lists are made from the
 * bits, in order. The bits take memory and time for the whole mesh, so they are used only if there
 * are many records for its size. */
#ifndef HE_MESH_CHANGE_MARKS_H
#define HE_MESH_CHANGE_MARKS_H

#include "mesh/delta.h"

/* The lists that an element can be in. */
typedef enum he_change_set { HE_CREATED, HE_DELETED, HE_MODIFIED, HE_CHANGE_SETS } he_change_set;

/* The arrays of the mesh whose words have bits. */
enum { HE_MARKED_ARRAYS = HE_COL_POSITION + 1, HE_POSITION_WORDS = 6 };

/* Returns the number of entries of the mesh's array that a record of a link or position names. */
static inline uint32_t he_change_rows(const he_mesh *mesh, uint32_t column)
{
    return he_mesh_issued(mesh, column <= HE_COL_FACE            ? HE_HALFEDGE
                                : column == HE_COL_FACE_HALFEDGE ? HE_FACE
                                                                 : HE_VERTEX);
}

typedef struct he_change_marks {
    he_changes *lists; /* where the ids go; borrowed */
    bool has_bits;
    uint64_t *memory;            /* of all bits */
    size_t count[HE_KIND_COUNT]; /* number of ids that have bits */
    uint64_t *sets[HE_CHANGE_SETS][HE_KIND_COUNT];
    uint64_t *met[HE_MARKED_ARRAYS]; /* the words that were met; positions: six bits a vertex */
} he_change_marks;

/* Begins to collect ids into `lists`, which is empty, for `records` records of a delta.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_change_marks_init(he_change_marks *marks, const he_mesh *mesh,
                                            size_t records, he_changes *lists, he_error *err);
void he_change_marks_clear(he_change_marks *marks);

/* Adds an id to a set. Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_change_marks_list(he_change_marks *marks, he_change_set set, he_kind kind,
                                            uint32_t id, he_error *err);
HE_NODISCARD static inline he_status he_change_marks_add(he_change_marks *marks, he_change_set set,
                                                         he_kind kind, uint32_t id, he_error *err)
{
    if (marks->has_bits && id < marks->count[kind]) {
        marks->sets[set][kind][id / 64] |= UINT64_C(1) << id % 64;
        return HE_OK;
    }
    return he_change_marks_list(marks, set, kind, id, err);
}

/* Returns true if a word of a vertex's position was met. The marks must have bits, and the mesh
 * must have the vertex. */
static inline bool he_change_marks_met_position(const he_change_marks *marks, uint32_t vertex,
                                                uint32_t word)
{
    const size_t bit = (size_t)vertex * HE_POSITION_WORDS + word;
    return (marks->met[HE_COL_POSITION][bit / 64] >> bit % 64 & 1) != 0;
}

/* Returns true if the word of a record is met for the first time. The marks must have bits, and the
 * mesh must have the word. */
static inline bool he_change_marks_meet(he_change_marks *marks, const he_record *r)
{
    const size_t bit =
        r->column == HE_COL_POSITION ? (size_t)r->row * HE_POSITION_WORDS + r->word : r->row;
    uint64_t *word = &marks->met[r->column][bit / 64];
    const uint64_t mask = UINT64_C(1) << bit % 64;
    const bool is_first = (*word & mask) == 0;
    *word |= mask;
    return is_first;
}

/* Completes the lists: sorts them, and removes from the modified elements those that did not exist
 * before the changes or do not exist after them.
 * Returns HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status he_change_marks_finish(he_change_marks *marks, const he_mesh *mesh,
                                              he_error *err);
/* Returns true if the list of created or deleted elements, which is complete, has an element. */
bool he_change_marks_has(const he_change_marks *marks, he_change_set set, he_kind kind,
                         uint32_t id);

#endif
