/* slots.h - keeps the triangles of drawing.h at fixed places in the array while a mesh is edited.
 *
 * Each live face has a run of degree - 2 slots, in the order of its triangles. A face keeps its run
 * while its number of triangles stays; otherwise the run is freed and another one taken: a freed
 * run if one fits, else at the end.
 *
 *     faces      0 0 1 1 2 2        face 1 becomes       0 0 - - 2 2 1 1 1
 *     slots      0 1 2 3 4 5        a pentagon           0 1 2 3 4 5 6 7 8
 *
 * A slot without a face is dead: its triangle is four zeros. So an edit changes only the triangles
 * of the faces it touched, and a client that keeps the arrays only needs those.
 *
 * A LAYOUT is one assignment of slots with one frame; it has a number. Deltas of the mesh bring it
 * forward, at a cost proportional to them and to the faces they touch. It ends, and another one
 * must be made, when the content was replaced, when a vertex leaves the unit ball of the frame,
 * when more than half of the vertices moved and another frame would fit them better, or when more
 * than half of the slots are dead.
 *
 * CHANGES are remembered by revision, as long as they are fewer than half of the rows. */
#ifndef HE_DRAW_SLOTS_H
#define HE_DRAW_SLOTS_H

#include "draw/drawing.h"
#include "mesh/delta.h"

enum {
    HE_SLOT_BINS = 64,
    HE_SLOT_CHANGES = 4096 /* ids remembered for even the smallest mesh */
};

/* A flag in the words of `owner`: the slot has no face. */
#define HE_SLOT_DEAD ((uint32_t)1 << 31)

/* The changes of one step from revision to revision: the entries before these ends in
 * `changed_vertices` and `changed_slots`. */
typedef struct he_slot_step {
    uint64_t revision; /* revision after the step */
    size_t vertices, slots;
} he_slot_step;

/* The slots of a mesh. All code may read the fields; only slots.c writes them. */
typedef struct he_slots {
    uint64_t layout, revision;
    he_frame frame;
    uint32_t vertices;    /* rows: ids issued */
    uint32_t count, dead; /* slots, and dead slots */
    uint32_t *owner;      /* for each slot its face, or HE_SLOT_DEAD and a note of slots.c */
    uint32_t *first;      /* for each face its first slot, HE_NONE if it is dead */
    size_t owner_capacity, first_capacity;
    uint32_t faces;             /* entries of `first` */
    uint32_t bin[HE_SLOT_BINS]; /* chains of freed runs by length; bin 0 has the long ones */
    uint64_t filled;            /* one bit for each chain that is not empty */

    uint64_t known; /* changes after this revision are remembered */
    he_ids changed_vertices, changed_slots;
    he_slot_step *steps;
    size_t step_count, step_capacity;
} he_slots;

/* Makes the first layout of a mesh: runs in the order of faces.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face does not fit into its 29 bits. */
HE_NODISCARD he_status he_slots_new(const he_mesh *m, uint64_t layout, uint64_t revision,
                                    he_slots **out, he_error *err);
void he_slots_free(he_slots *slots);

/* Elements whose rows may have changed by some deltas. {0} is none. */
typedef struct he_touched {
    he_ids vertices, faces; /* unordered, with repeats */
    he_ids moved;           /* vertices whose position changed */
} he_touched;

/* Adds what a delta touched, in whichever direction it was applied. `m` is the mesh after the last
 * of the deltas that are added.
 * Returns HE_UNSUPPORTED if the delta replaced the content.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_touched_add(he_touched *touched, const he_mesh *m, const he_delta *delta,
                                      he_error *err);
void he_touched_clear(he_touched *touched);

/* Brings the slots forward to `m`, which is at `revision` and differs from the present state by
 * what was touched (whose lists are sorted). On HE_LIMIT, HE_NO_MEMORY and HE_IDS_EXHAUSTED the
 * slots are as they were, but may remember fewer changes.
 * Returns HE_LIMIT if bringing them forward takes more than `most` steps.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face does not fit into its 29 bits.
 * Returns HE_UNSUPPORTED if the layout has ended. */
HE_NODISCARD he_status he_slots_advance(he_slots *slots, const he_mesh *m, he_touched *touched,
                                        uint64_t revision, uint64_t most, he_error *err);

/* Lists the rows that may differ from those at revision `since`, in rising order; if a face has a
 * changed slot, all its slots are listed. The caller clears both lists, also after a failure.
 * Returns HE_UNSUPPORTED if the changes are not remembered, or are more than half of all rows.
 * Returns HE_LIMIT if more than `most` changes, repeats included, were made since then.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_slots_changed(const he_slots *slots, uint64_t since, uint64_t most,
                                        he_ids *vertices, he_ids *triangles, he_error *err);

#endif
