/* draw_slots.h - keeps the triangles of draw_arrays.h at fixed places in the array while a mesh is
 * edited.
 *
 * A slot is a place for one triangle. Each live face has a run of degree - 2 consecutive slots, in
 * the order of its triangles. A face keeps its run while its number of triangles stays; otherwise
 * the run is freed, and the face gets a freed run that is long enough or a new one at the end.
 *
 *     faces      0 0 1 1 2 2        face 1 becomes       0 0 - - 2 2 1 1 1
 *     slots      0 1 2 3 4 5        a pentagon           0 1 2 3 4 5 6 7 8
 *
 * A slot without a face is dead: its row is four zeros. So an edit changes only the rows of the
 * faces it touched, and a client that keeps the arrays needs only those rows.
 *
 * A LAYOUT is an assignment of slots to faces, with one frame (draw_arrays.h); it has a number. It
 * is updated by the deltas of the mesh, at a cost proportional to them and to the faces they touch.
 * A layout ends, and another one must be made, when all data of the mesh were replaced, when a
 * vertex leaves the unit ball of the frame, when more than half of the vertices moved and the mesh
 * would get another frame, or when more than half of the slots are dead.
 *
 * CHANGED ROWS are remembered by the revision that changed them, as long as they are fewer than
 * half of all rows. */
#ifndef HE_DRAW_DRAW_SLOTS_H
#define HE_DRAW_DRAW_SLOTS_H

#include "draw/draw_arrays.h"
#include "mesh/delta.h"

enum {
    HE_DRAW_SLOT_BINS = 64,
    /* this many changed rows are remembered even if they are more than half of all rows */
    HE_DRAW_SLOT_CHANGES = 4096
};

/* A flag in a word of he_draw_slots.owner: the slot has no face. */
#define HE_DRAW_SLOT_DEAD ((uint32_t)1 << 31)

/* One update of the slots from a revision to a later one. The rows that it changed are listed in
 * `changed_vertices` and `changed_slots` of he_draw_slots: the entries of this step begin where
 * those of the step before end, and end before the indices `vertices` and `slots`. */
typedef struct he_draw_slot_step {
    uint64_t revision; /* revision after the step */
    size_t vertices, slots;
} he_draw_slot_step;

/* The slots of a mesh. All code may read the fields; only draw_slots.c writes them. */
typedef struct he_draw_slots {
    uint64_t layout, revision;
    he_frame frame;
    uint32_t vertices;    /* number of rows of vertices: one for each vertex id ever issued */
    uint32_t count, dead; /* number of all slots, and number of dead slots */
    /* face of each slot; if the slot is dead, HE_DRAW_SLOT_DEAD and a link to another freed run */
    uint32_t *owner;
    uint32_t *first; /* first slot of each face, HE_NONE if the face is dead */
    size_t owner_capacity, first_capacity;
    uint32_t faces; /* entries of `first` */
    /* first freed run of the linked list of each run length; bin 0 is the list of all longer
     * runs */
    uint32_t bin[HE_DRAW_SLOT_BINS];
    uint64_t filled; /* a bit for each list in `bin`, set if the list is not empty */

    uint64_t known; /* the revision since which all changes are remembered */
    he_ids changed_vertices, changed_slots;
    he_draw_slot_step *steps;
    size_t step_count, step_capacity;
} he_draw_slots;

/* Makes a new layout of a mesh, with the runs of slots in the order of faces.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face does not fit into 29 bits. */
HE_NODISCARD he_status he_draw_slots_new(const he_mesh *m, uint64_t layout, uint64_t revision,
                                         he_draw_slots **out, he_error *err);
void he_draw_slots_free(he_draw_slots *slots);

/* The elements whose rows may have been changed by some deltas. {0} contains none. */
typedef struct he_touched {
    he_ids vertices, faces; /* unordered, with repeats */
    he_ids moved;           /* vertices whose position changed */
} he_touched;

/* Adds to the lists the elements that a delta touched, whether it was applied forwards or
 * backwards. `m` is the mesh after the last of the deltas that are added.
 * Returns HE_UNSUPPORTED if the delta replaced all data of the mesh at once.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_touched_add(he_touched *touched, const he_mesh *m, const he_delta *delta,
                                      he_error *err);
void he_touched_clear(he_touched *touched);

/* Updates the slots to `m`, which is at `revision` and differs only in the elements of `touched`
 * from the mesh for which the slots were made or last updated. Sorts the lists of `touched`. After
 * HE_LIMIT, HE_NO_MEMORY or HE_IDS_EXHAUSTED the slots are unchanged, but may remember fewer
 * changed rows than before.
 * Returns HE_LIMIT if the update takes more than `most` steps.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face does not fit into 29 bits.
 * Returns HE_UNSUPPORTED if the layout has ended. */
HE_NODISCARD he_status he_draw_slots_advance(he_draw_slots *slots, const he_mesh *m,
                                             he_touched *touched, uint64_t revision, uint64_t most,
                                             he_error *err);

/* Lists, in rising order, the rows of vertices and triangles that may differ from those at revision
 * `since`; if a face has a changed slot, all its slots are listed. The caller clears both lists,
 * also after a failure.
 * Returns HE_UNSUPPORTED if the changes are not remembered, or if they are more than half of all
 * rows.
 * Returns HE_LIMIT if more than `most` changes, repeats included, were made since that revision.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_draw_slots_changed(const he_draw_slots *slots, uint64_t since,
                                             uint64_t most, he_ids *vertices, he_ids *triangles,
                                             he_error *err);

#endif
