/* holders.h - limits how many meshes and bytes each holder, a name of an access token, may have.
 *
 * The holder of a mesh is the name of the token that created it (st_cause). A mesh keeps its
 * holder, whichever client changes it, and counts for that holder whether it is in memory or not.
 * The bytes that count are those that the mesh's content took in memory after its last change; its
 * card (short description, st_card) states them. A mesh created without a token counts for no
 * holder.
 *
 * Every change first reserves the bytes that the mesh will count for after the change. If they are
 * more than before and exceed what the holder may have, the change is refused and nothing is
 * changed. Two changes at the same time cannot together exceed the limit. If a limit is lowered,
 * meshes beyond it stay.
 *
 * At the start, and after changes were lost, the counts are read from the journal. The lock of the
 * holders is taken after those of a mesh and of the table of meshes. A thread that holds this lock
 * reads nothing from the disk but the cards in the journal. */
#ifndef HE_STORE_HOLDERS_H
#define HE_STORE_HOLDERS_H

#include "journal/journal.h"

#include <pthread.h>

enum { ST_HOLDER_HEADS = 256 };

/* A holder (owner) of meshes. The struct is made when the holder's name first occurs, and freed
 * with the store. */
typedef struct st_holder {
    struct st_holder *next;
    uint64_t meshes, bytes;
    uint64_t most_meshes, most_bytes; /* limits; 0: no limit */
    char name[ST_HOLDER + 1];
} st_holder;

typedef struct st_holders {
    pthread_mutex_t lock;
    const uint64_t *secret;
    st_holder *heads[ST_HOLDER_HEADS];
    size_t count;
} st_holders;

void st_holders_init(st_holders *holders, const uint64_t secret[2]);
void st_holders_clear(st_holders *holders);

/* Finds or makes the holder of this name; *out is NULL for "", which stands for no holder.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_holders_find(st_holders *holders, const char *name, st_holder **out);

/* How much one mesh counts for a holder; `holder` is NULL if the mesh counts for no holder. */
typedef struct st_holding {
    st_holder *holder;
    uint64_t bytes;
} st_holding;

/* Replaces what a mesh counted for its holder before, *gone, by what the mesh counts now, *come.
 * Returns ST_QUOTA if the holder may not have so much; then nothing is changed. */
st_status st_holders_move(st_holders *holders, const st_holding *gone, const st_holding *come);
/* Replaces what a mesh counts like st_holders_move, but ignores the limits, because the change of
 * the mesh has already been made. */
void st_holders_note(st_holders *holders, const st_holding *gone, const st_holding *come);

typedef struct st_holder_limit {
    const char *name;
    uint64_t meshes, bytes; /* 0: no limit */
} st_holder_limit;

typedef struct st_usage {
    uint64_t meshes, bytes;
    uint64_t most_meshes, most_bytes; /* 0: no limit */
} st_usage;

/* The next two functions do the work of st_limit_holders and st_holder_usage, which store.h
 * documents. */
st_status st_holders_limit(st_holders *holders, const st_holder_limit *limits, size_t count);
void st_holders_usage(st_holders *holders, const char *name, st_usage *out);

/* Counts the meshes and bytes of all holders again from the journal.
 * Returns ST_NO_MEMORY or ST_FAILED if the journal cannot be read. */
st_status st_holders_count(st_holders *holders, const st_journal *journal);

#endif
