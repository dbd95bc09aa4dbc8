/* idempotency.h - remembers the answers to requests that had an Idempotency-Key, for repetitions of
 * these requests.
 *
 * After draft-ietf-httpapi-idempotency-key-header. A table of keys belongs to a mesh or, for
 * requests that create a mesh, to the store; it is freed with its owner. The entry of a key is made
 * before its request is executed, and has all the memory that remembering the answer needs, except
 * for the answer's body:
 *
 *     keyed ----> under way ----> kept, with the answer        forgotten after ST_KEPT_SECONDS, or
 *                     |             |                          when newer ones need the room
 *                     +-> end       +-> a repeated request gets the answer
 *
 * The body of an answer is copied when it is kept. If it is larger than ST_KEPT_BODY or memory is
 * out, the answer's status and ETag are kept without the body, so a lack of memory never forgets
 * that the request took effect. Keys of changes are read back from the journal when their mesh is
 * loaded, and the keys of the store when it starts. Their answer is then 201 or 204 with the ETag,
 * without a body. Each table has a lock of its own, taken after all others. */
#ifndef HE_STORE_IDEMPOTENCY_H
#define HE_STORE_IDEMPOTENCY_H

#include "store/store.h"

#include <pthread.h>

enum {
    /* the most bytes of all entries and bodies of one table of keys */
    ST_KEPT_BYTES = 16 << 20,
    ST_KEPT_BODY = 4 << 20 /* most bytes of the body of one kept answer */
};

typedef struct st_keys {
    pthread_mutex_t lock;
    /* The hash table, whose size is a power of two; NULL before the first entry. */
    struct st_keyed **buckets;
    /* `bucket_count` is the number of buckets of the hash table, `count` the number of all its
     * entries */
    size_t bucket_count, count;
    struct st_keyed *oldest, *newest; /* list of the entries with a kept answer */
    size_t kept;
    uint64_t bytes; /* bytes of the entries with a kept answer */
    uint64_t secret[2];
} st_keys;

/* An entry of the table of keys. It has two references: one from its table and one from the request
 * that began it. */
struct st_keyed {
    st_keys *keys;
    unsigned uses;
    /* `is_kept` is true if the answer is kept, `listed` if the entry is in the table */
    bool is_kept, listed;
    /* True if the stored row of the key is damaged, so that it is not known to which request the
     * key belongs. */
    bool is_damaged;
    st_record_key key; /* the key in the form in which a record in the journal stores it */
    uint64_t hash;
    st_kept answer; /* owns `body` */
    struct st_keyed *next, *older, *newer;
    char text[]; /* the key, and after its NUL the name of the client that sent it */
};

void st_keys_init(st_keys *keys, const uint64_t secret[2]);
/* Frees the memory of the table of keys; no request of the table may be under way. */
void st_keys_clear(st_keys *keys);
/* Begins a request that has an Idempotency-Key. `now` is in seconds since 1970. */
st_keyed_status st_keys_begin(st_keys *keys, const st_key *key, double now, st_keyed **out);
/* Removes a kept answer that a request got with ST_KEYED_KEPT. The caller must call this function
 * instead of st_keyed_end. */
void st_keys_forget(st_keyed *keyed);
/* Restores a key from the journal; the answer kept for it is 201 or 204, without a body. The
 * function is passed to the journal as an st_take_key; `keys` points to an st_keys. */
bool st_keys_restore(void *keys, const st_kept_key *kept);
/* Frees the bodies of those kept answers that no request is reading. */
void st_keys_shed(st_keys *keys);

#endif
