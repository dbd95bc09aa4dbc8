/* revision_entry.h - the entries and steps of a revision log. Only revision_log.c and
 * revision_walk.c use it. */
#ifndef HE_STORE_REVISION_ENTRY_H
#define HE_STORE_REVISION_ENTRY_H

#include "store/revision_log.h"

#include <stdatomic.h>

typedef enum st_stack { ST_ON_NEITHER, ST_ON_UNDO, ST_ON_REDO } st_stack;

struct st_step {
    he_delta *delta;
    size_t bytes;      /* bytes of the step with its delta */
    size_t charged;    /* bytes that it counts against the budget */
    uint64_t revision; /* revision of the edit */
    uint64_t applied;  /* revision of the entry that applied it last */
    st_revision *kept; /* that entry, if only the redo stack still needs it */
    uint32_t uses;     /* how many entries and stacks use it */
    /* The number of references: one from the log while `uses` is not 0, and one from each
     * st_log_hold. */
    _Atomic uint32_t holders;
    st_stack stack;
    st_step *below, *above; /* neighbours on its stack */
};

struct st_revision {
    st_point point; /* the mesh after the entry */
    uint64_t inverts;
    st_action action;
    bool forward; /* the delta was applied forwards */
    size_t delta_bytes;
    size_t size;       /* bytes of this block and of its slot in the ring */
    st_step *step;     /* NULL if the delta is not kept */
    st_revision *next; /* the next reserved entry */
    st_tally tally;
    char ops[];
};

static inline st_revision *st_entry_at(const st_revision_log *log, size_t i)
{
    return log->ring[(log->first + i) & (log->capacity - 1)];
}

/* Returns the log's entry of a revision, which the log must have. */
static inline st_revision *st_entry_of(const st_revision_log *log, uint64_t revision)
{
    return st_entry_at(log, (size_t)(revision - log->before.revision - 1));
}

#endif
