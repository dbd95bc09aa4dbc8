/* holders.h - how many meshes each holder has and how many bytes they take, and how many it may
 * have.
 *
 * The holder of a mesh is whom it was made for (st_cause): the name of a token. A mesh keeps its
 * holder whoever changes it, and counts for it in memory or not, with the bytes that its content
 * took in memory when it was changed last: those of its card. One that was made for nobody counts
 * for nobody.
 *
 * Whatever changes a mesh first takes what it will count for: where that is more than before and
 * more than the holder may have it is refused, and nothing is changed. Two that take at one time
 * never take more than there is. What the holder has beyond a limit that was lowered stays.
 *
 * At the start, and when changes were lost, the journal says what there is. The lock is taken after
 * those of a mesh and of the table; nothing but the journal's cards is asked for under it. */
#ifndef HE_STORE_HOLDERS_H
#define HE_STORE_HOLDERS_H

#include "journal/journal.h"

#include <pthread.h>

enum { ST_HOLDER_HEADS = 256 };

/* Made when it is first heard of, and there as long as the store. */
typedef struct st_holder {
    struct st_holder *next;
    uint64_t meshes, bytes;
    uint64_t most_meshes, most_bytes; /* 0: any number */
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

/* The holder of this name; *out is NULL for that of nobody, "". ST_NO_MEMORY. */
st_status st_holders_find(st_holders *holders, const char *name, st_holder **out);

/* What one mesh counts for: `holder` NULL for nothing. */
typedef struct st_holding {
    st_holder *holder;
    uint64_t bytes;
} st_holding;

/* A mesh counted for *gone and counts for *come from now on. ST_QUOTA, and nothing is changed. */
st_status st_holders_move(st_holders *holders, const st_holding *gone, const st_holding *come);
/* Counts what is a fact already, whatever the limits. */
void st_holders_note(st_holders *holders, const st_holding *gone, const st_holding *come);

typedef struct st_holder_limit {
    const char *name;
    uint64_t meshes, bytes; /* 0: any number */
} st_holder_limit;

typedef struct st_usage {
    uint64_t meshes, bytes;
    uint64_t most_meshes, most_bytes; /* 0: any number */
} st_usage;

/* st_limit_holders and st_holder_usage of store.h. */
st_status st_holders_limit(st_holders *holders, const st_holder_limit *limits, size_t count);
void st_holders_usage(st_holders *holders, const char *name, st_usage *out);

/* Counts all anew from what the journal keeps. ST_NO_MEMORY, ST_FAILED. */
st_status st_holders_count(st_holders *holders, const st_journal *journal);

#endif
