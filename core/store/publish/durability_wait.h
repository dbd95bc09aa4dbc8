/* durability_wait.h - answers to clients that wait until the changes which they show are durable.
 *
 * D1: no answer shows a change that a crash could lose. What an answer shows is given by the
 * position of the newest record that it shows, in the order of all records (journal.h). If that
 * record is not durable yet, the thread that made the answer adds a wait. The wait ends once, by a
 * call from another thread, in one of these ways:
 *     durable   every record up to the position is durable: the answer may be sent
 *     lost      a record that the answer shows will never be durable; `reason` says why
 *     stopped   the server stops before it is known whether the records become durable
 * A lost record stays lost: a wait for it that is added after the loss ends as lost at once.
 *
 * Waits are in a heap, the oldest position on top: when more records become durable, only the waits
 * that end are taken from the top, and no other waits are visited. */
#ifndef HE_STORE_DURABILITY_WAIT_H
#define HE_STORE_DURABILITY_WAIT_H

#include "journal/journal.h"

#include <stdbool.h>

typedef struct st_waits st_waits;

/* The records that an answer to a client shows; if one of them is lost, the answer is wrong. */
typedef struct st_shown {
    uint64_t position; /* position of the newest record that the answer shows; 0: it shows none */
    /* The position up to which all records were durable when the answer was begun, so that a later
     * loss does not concern them. */
    uint64_t since;
    /* incarnation of the mesh whose records the answer shows; 0: records of any mesh */
    uint64_t incarnation;
} st_shown;

typedef enum st_wait_end { ST_WAIT_DURABLE, ST_WAIT_LOST, ST_WAIT_STOPPED } st_wait_end;

/* The wait of an answer until the records that it shows are durable. The struct is in the caller's
 * storage, which must outlive the wait. */
typedef struct st_wait {
    st_shown shown;
    void (*resume)(struct st_wait *wait);
    st_wait_end end;
    st_status status;   /* with ST_WAIT_LOST: ST_FULL or ST_FAILED */
    const char *reason; /* `reason`, with ST_WAIT_LOST: why the record was lost, a string literal */
    struct st_wait *child, *beside; /* links of the heap */
} st_wait;

/* Makes a set of waits. Returns NULL if memory is out. */
st_waits *st_waits_new(void);
/* Frees the set of waits, which may contain no wait any more. */
void st_waits_free(st_waits *waits); /* takes NULL */

/* The journal's listener (journal.h) calls st_waits_moved when all records up to `position` are
 * durable or lost, and st_waits_lose when records are lost. */
void st_waits_moved(st_waits *waits, uint64_t position);
void st_waits_lose(st_waits *waits, const st_loss *loss);

/* Remembers the position of a record that was appended to the journal. The caller must call this
 * function before other threads can see the record. */
void st_waits_appended(st_waits *waits, uint64_t position);
/* Returns the position of the newest record in the journal, for answers that show the records of
 * many meshes, or that something does not exist. */
uint64_t st_waits_newest(const st_waits *waits);
/* Returns the durable position: every record up to it is durable or lost. */
uint64_t st_waits_durable(const st_waits *waits);
/* Returns true if the records of `shown` are all durable, so that the answer may be sent at
 * once. */
bool st_waits_is_durable(st_waits *waits, const st_shown *shown);
/* Returns true if one of the records of `shown` will never be durable. */
bool st_waits_is_lost(st_waits *waits, const st_shown *shown);

/* Blocks until every record up to `position` is durable or lost. Returns false if st_clock_micros
 * reaches `until`, or the waits are stopped, before that. */
bool st_waits_block(st_waits *waits, uint64_t position, uint64_t until);

/* Adds a wait to the set. Returns false if the wait is over already: wait->end is then filled in,
 * and wait->resume is not called. */
bool st_waits_add(st_waits *waits, st_wait *wait);
/* Ends all present and later waits as stopped. When the call returns, no wait is being resumed by
 * another thread, so the caller may free what the waits belong to. No function `resume` of a wait
 * may call this function. */
void st_waits_stop(st_waits *waits);

#endif
