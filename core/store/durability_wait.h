/* durability_wait.h - answers that wait until what they show is durable.
 *
 * D1: no answer shows a change that a crash could lose. What an answer shows is a position in the
 * order of all records (journal.h). A sender of an answer that the journal has not caught up with
 * adds a wait, which ends once, by a call from another thread:
 *     durable   every record up to the position is durable: the answer may be sent
 *     lost      a record that the answer shows will never be durable; `reason` says why
 *     stopped   the server stops before that is known
 * A lost position stays lost: a wait that is added after the loss ends as lost at once.
 *
 * Waits lie in a heap, the oldest position on top: a notice of the journal takes from the top those
 * it ends and looks at no others. */
#ifndef HE_STORE_DURABILITY_WAIT_H
#define HE_STORE_DURABILITY_WAIT_H

#include "journal/journal.h"

#include <stdbool.h>

typedef struct st_waits st_waits;

/* What an answer shows of the store. */
typedef struct st_shown {
    uint64_t position;    /* of the newest record in it; 0: it shows none */
    uint64_t since;       /* records up to here were durable when it was begun, and matter to it no
                             more */
    uint64_t incarnation; /* of the one mesh whose records it shows; 0: those of any */
} st_shown;

typedef enum st_wait_end { ST_WAIT_DURABLE, ST_WAIT_LOST, ST_WAIT_STOPPED } st_wait_end;

/* In the caller's storage, which outlives the wait. */
typedef struct st_wait {
    st_shown shown;
    void (*resume)(struct st_wait *wait);
    st_wait_end end;
    st_status status;               /* of ST_WAIT_LOST: ST_FULL or ST_FAILED */
    const char *reason;             /* likewise, a literal */
    struct st_wait *child, *beside; /* in the heap */
} st_wait;

/* NULL when memory is out. */
st_waits *st_waits_new(void);
/* Nothing may wait. */
void st_waits_free(st_waits *waits); /* takes NULL */

/* What the journal's listener is told (journal.h). */
void st_waits_moved(st_waits *waits, uint64_t position);
void st_waits_lose(st_waits *waits, const st_loss *loss);

/* Notes the position of a record that was appended, before others can see the record. */
void st_waits_appended(st_waits *waits, uint64_t position);
/* The newest position there is, for what shows the absence of records or those of many meshes. */
uint64_t st_waits_newest(const st_waits *waits);
/* Every record up to here is durable or lost. */
uint64_t st_waits_durable(const st_waits *waits);
/* May what shows this be sent at once? */
bool st_waits_is_durable(st_waits *waits, const st_shown *shown);
/* Will what shows this never be durable? */
bool st_waits_is_lost(st_waits *waits, const st_shown *shown);

/* False when the wait is over already, with `end` filled in: resume is not called then. */
bool st_waits_add(st_waits *waits, st_wait *wait);
/* Ends all waits as stopped, and from now on those that are added. */
void st_waits_stop(st_waits *waits);

#endif
