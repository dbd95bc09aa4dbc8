/* revision_entry.h - what a revision log is made of: shared by revision_log.c and revision_walk.c,
 * for nobody else. */
#ifndef HE_STORE_REVISION_ENTRY_H
#define HE_STORE_REVISION_ENTRY_H

#include "store/revision_log.h"

#include <stdatomic.h>

typedef enum st_stack { ST_ON_NEITHER, ST_ON_UNDO, ST_ON_REDO } st_stack;

struct st_step {
    he_delta *delta;
    size_t bytes;             /* of the step with its delta as it is */
    size_t charged;           /* what it counts against the budget */
    uint64_t revision;        /* of the edit */
    uint64_t applied;         /* of the entry that applied it last */
    st_revision *kept;        /* that entry, when only the redo stack still needs it */
    uint32_t uses;            /* by entries and a stack */
    _Atomic uint32_t holders; /* the log, while it has uses, and st_log_hold */
    st_stack stack;
    st_step *below, *above; /* on its stack */
};

struct st_revision {
    st_point point; /* the mesh after it */
    uint64_t inverts;
    st_action action;
    bool forward; /* the delta was applied forwards */
    size_t delta_bytes;
    size_t size;       /* of this block, with its place in the ring */
    st_step *step;     /* NULL: its delta is not kept */
    st_revision *next; /* among those reserved */
    st_tally tally;
    char ops[];
};

static inline st_revision *st_entry_at(const st_revision_log *log, size_t i)
{
    return log->ring[(log->first + i) & (log->capacity - 1)];
}

/* The entry of a revision the log has an entry for. */
static inline st_revision *st_entry_of(const st_revision_log *log, uint64_t revision)
{
    return st_entry_at(log, (size_t)(revision - log->before.revision - 1));
}

#endif
