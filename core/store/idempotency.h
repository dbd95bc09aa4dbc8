/* idempotency.h - the first answers to requests that carried an Idempotency-Key.
 *
 * After draft-ietf-httpapi-idempotency-key-header. A table belongs to a mesh, or to the store for
 * what makes a mesh, and dies with it. An entry is begun before its request is tried, which takes
 * all the memory that remembering needs:
 *
 *     keyed ----> under way ----> kept, with the answer        after ST_KEPT_SECONDS, or when
 *                     |             |                          newer ones need the room, forgotten
 *                     +-> end       +-> the same keyed is told the answer
 *
 * The body of an answer is a copy made when it is kept. Where it is larger than ST_KEPT_BODY or
 * memory is out, status and tag are kept without it: that the request took effect is never
 * forgotten for want of memory. Keys of changes come back with their mesh, and those of the store
 * at its start, from the journal: with 201 or 204 and the tag, without a body. The table has a lock
 * of its own, taken after all others. */
#ifndef HE_STORE_IDEMPOTENCY_H
#define HE_STORE_IDEMPOTENCY_H

#include "store/store.h"

#include <pthread.h>

enum {
    ST_KEPT_BYTES = 16 << 20, /* of one table, entries and bodies */
    ST_KEPT_BODY = 4 << 20    /* of one answer */
};

typedef struct st_keys {
    pthread_mutex_t lock;
    struct st_keyed **buckets;        /* a power of two, NULL before the first */
    size_t bucket_count, count;       /* of all entries */
    struct st_keyed *oldest, *newest; /* of those kept */
    size_t kept;
    uint64_t bytes; /* of those kept */
    uint64_t secret[2];
} st_keys;

/* An entry, counted by its table and by the request that began it. */
struct st_keyed {
    st_keys *keys;
    unsigned uses;
    bool is_kept, listed; /* listed: the table holds it */
    bool is_damaged;      /* which request it was of is not known any more */
    st_record_key key;    /* as a record carries it */
    uint64_t hash;
    st_kept answer; /* `body` is owned */
    struct st_keyed *next, *older, *newer;
    char text[]; /* of the key, and behind its end the holder */
};

void st_keys_init(st_keys *keys, const uint64_t secret[2]);
void st_keys_clear(st_keys *keys); /* no request may be under way */
/* `now` in seconds since 1970. */
st_keyed_status st_keys_begin(st_keys *keys, const st_key *key, double now, st_keyed **out);
/* Forgets a kept answer that was lent with ST_KEYED_KEPT, in place of st_keyed_end. */
void st_keys_forget(st_keyed *keyed);
/* Brings a key back that the journal kept (an st_take_key): its answer is 201 or 204, without a
 * body. `keys` is an st_keys. */
bool st_keys_restore(void *keys, const st_kept_key *kept);
/* Free the bodies nobody reads. */
void st_keys_shed(st_keys *keys);

#endif
