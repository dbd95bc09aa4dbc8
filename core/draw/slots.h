/* slots.h - places for the triangles of drawing.h that stay while a mesh is edited.
 *
 * Each live face has a run of degree - 2 slots, in the order in which its triangles come. A face
 * keeps its run while its number of triangles stays; otherwise the run is freed and another one
 * taken: of a freed run where one fits, else at the end.
 *
 *     faces      0 0 1 1 2 2        face 1 becomes       0 0 - - 2 2 1 1 1
 *     slots      0 1 2 3 4 5        a pentagon           0 1 2 3 4 5 6 7 8
 *
 * A slot without a face is dead: its triangle is four zeros. So an edit changes only the triangles
 * of the faces it touched, and whoever keeps the arrays gets by with those.
 *
 * A LAYOUT is one assignment of slots with one frame, named by a number. It is brought forward by
 * the deltas of the mesh, at a cost that follows from them and from the faces they touch. It ends,
 * and another one must be made, when the content was replaced, when a vertex leaves the unit ball
 * of the frame, when more than half of the vertices moved and another frame would suit them better,
 * or when more than half of the slots are dead.
 *
 * CHANGES are remembered by revision, as long as they are fewer than half of the rows. */
#ifndef HE_DRAW_SLOTS_H
#define HE_DRAW_SLOTS_H

#include "draw/drawing.h"
#include "mesh/delta.h"

enum {
    HE_SLOT_BINS = 64,
    HE_SLOT_CHANGES = 4096 /* ids that are remembered of the smallest mesh */
};

/* In the words of `owner`. */
#define HE_SLOT_DEAD ((uint32_t)1 << 31)

/* What one step forward changed: ids up to these ends in `changed_vertices` and `changed_slots`. */
typedef struct he_slot_step {
    uint64_t revision; /* after it */
    size_t vertices, slots;
} he_slot_step;

/* Open for reading; only slots.c writes it. */
typedef struct he_slots {
    uint64_t layout, revision;
    he_frame frame;
    uint32_t vertices;    /* rows: ids issued */
    uint32_t count, dead; /* slots, and those without a face */
    uint32_t *owner;      /* of each slot its face, or HE_SLOT_DEAD and what slots.c notes there */
    uint32_t *first;      /* of each face its first slot, HE_NONE where it does not live */
    size_t owner_capacity, first_capacity;
    uint32_t faces;             /* how many `first` has */
    uint32_t bin[HE_SLOT_BINS]; /* chains of freed runs by length, the long ones in 0 */
    uint64_t filled;            /* a bit for each chain that is not empty */

    uint64_t known; /* changes after this revision are remembered */
    he_ids changed_vertices, changed_slots;
    he_slot_step *steps;
    size_t step_count, step_capacity;
} he_slots;

/* The layout of a mesh that has none: runs in the order of faces. HE_NO_MEMORY, HE_IDS_EXHAUSTED.
 */
HE_NODISCARD he_status he_slots_new(const he_mesh *m, uint64_t layout, uint64_t revision,
                                    he_slots **out, he_error *err);
void he_slots_free(he_slots *slots);

/* Elements whose rows some deltas may have changed. {0} is none. */
typedef struct he_touched {
    he_ids vertices, faces; /* in no order, with repeats */
    he_ids moved;           /* vertices whose position changed */
} he_touched;

/* Add what a delta touched, in whichever direction it was applied. `m` is the mesh after the last
 * of the deltas that are added. HE_UNSUPPORTED when it replaced the content; HE_NO_MEMORY. */
HE_NODISCARD he_status he_touched_add(he_touched *touched, const he_mesh *m, const he_delta *delta,
                                      he_error *err);
void he_touched_clear(he_touched *touched);

/* Bring the slots forward to `m`, which is at `revision` and differs in what was touched (whose
 * lists are put in order). On HE_LIMIT, when that takes more than `most` steps, HE_NO_MEMORY and
 * HE_IDS_EXHAUSTED they are as they were, but may remember less. On HE_UNSUPPORTED the layout has
 * ended. */
HE_NODISCARD he_status he_slots_advance(he_slots *slots, const he_mesh *m, he_touched *touched,
                                        uint64_t revision, uint64_t most, he_error *err);

/* The rows that may differ from those at revision `since`, in rising order: of each face that has
 * one of the slots all are listed. HE_UNSUPPORTED when that is not remembered or they are more than
 * half of all; HE_LIMIT when more than `most` changes, repeats among them, are noted since then;
 * HE_NO_MEMORY. The caller clears both lists, whatever comes back. */
HE_NODISCARD he_status he_slots_changed(const he_slots *slots, uint64_t since, uint64_t most,
                                        he_ids *vertices, he_ids *triangles, he_error *err);

#endif
