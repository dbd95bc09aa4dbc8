/* revision_entry.h - the entries and steps of a revision log. Only revision_log.c, revision_name.c
 * and revision_walk.c use it. */
#ifndef HE_STORE_REVISION_ENTRY_H
#define HE_STORE_REVISION_ENTRY_H

#include "store/revision_log.h"

#include <stdatomic.h>

typedef enum st_stack { ST_ON_NEITHER, ST_ON_UNDO, ST_ON_REDO } st_stack;

struct st_step {
    he_delta *delta;
    size_t bytes;      /* bytes of the step with its delta */
    size_t charged;    /* how many bytes the step counts against the undo budget */
    uint64_t revision; /* revision of the edit */
    uint64_t applied;  /* revision of the entry (edit, undo or redo) that applied the step last */
    /* The entry of the revision `applied`, if that entry has left the log's ring and only the redo
     * stack still needs it. */
    st_revision *kept;
    uint32_t uses; /* number of entries and stacks that use the step */
    /* The number of references: one from the log while `uses` is not 0, and one from each
     * st_log_hold. */
    _Atomic uint32_t holders;
    st_stack stack;
    st_step *below, *above; /* neighbours on its stack */
};

struct st_revision {
    /* What the log keeps of the mesh at this revision (st_point). */
    st_point point;
    uint64_t inverts;
    st_action action;
    /* True if the delta was applied forwards: the entry is an edit or a redo, not an undo. */
    bool forward;
    size_t delta_bytes;
    size_t size; /* bytes that the entry, its name and its slot in the ring take */
    char *name;  /* `name` is the name of the revision; NULL: it has none */
    /* the step with the delta that led to the revision; NULL if the delta is not kept */
    st_step *step;
    st_revision *next; /* the next entry in the list of reserved entries */
    st_tally tally;
    char ops[];
};

static inline st_revision *st_entry_at(const st_revision_log *log, size_t i)
{
    return log->ring[(log->first + i) & (log->capacity - 1)];
}

/* Returns the log's entry of a revision; the log must have this entry. */
static inline st_revision *st_entry_of(const st_revision_log *log, uint64_t revision)
{
    return st_entry_at(log, (size_t)(revision - log->before.revision - 1));
}

#endif
