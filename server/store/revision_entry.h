/* revision_entry.h - what a revision log is made of: shared by revision_log.c and revision_walk.c,
 * for nobody else. */
#ifndef HE_SERVER_STORE_REVISION_ENTRY_H
#define HE_SERVER_STORE_REVISION_ENTRY_H

#include "server/store/revision_log.h"

#include <stdatomic.h>

typedef enum srv_stack { SRV_ON_NEITHER, SRV_ON_UNDO, SRV_ON_REDO } srv_stack;

struct srv_step {
    he_delta *delta;
    size_t bytes;             /* of the step with its delta as it is */
    size_t charged;           /* what it counts against the budget */
    uint64_t revision;        /* of the edit */
    uint64_t applied;         /* of the entry that applied it last */
    srv_revision *kept;       /* that entry, when only the redo stack still needs it */
    uint32_t uses;            /* by entries and a stack */
    _Atomic uint32_t holders; /* the log, while it has uses, and srv_log_hold */
    srv_stack stack;
    srv_step *below, *above; /* on its stack */
};

struct srv_revision {
    srv_point point; /* the mesh after it */
    uint64_t inverts;
    api_action action;
    bool forward; /* the delta was applied forwards */
    size_t delta_bytes;
    size_t size;        /* of this block, with its place in the ring */
    srv_step *step;     /* NULL: its delta is not kept */
    srv_revision *next; /* among those reserved */
    api_tally tally;
    char ops[];
};

static inline srv_revision *srv_entry_at(const srv_revision_log *log, size_t i)
{
    return log->ring[(log->first + i) & (log->capacity - 1)];
}

/* The entry of a revision the log has an entry for. */
static inline srv_revision *srv_entry_of(const srv_revision_log *log, uint64_t revision)
{
    return srv_entry_at(log, (size_t)(revision - log->before.revision - 1));
}

#endif
