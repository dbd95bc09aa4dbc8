/* idempotency.h - the first answers to requests that carried an Idempotency-Key.
 *
 * After draft-ietf-httpapi-idempotency-key-header. A table belongs to a mesh, or to the store for
 * what makes a mesh, and dies with it. An entry is claimed before its request is tried, which takes
 * all the memory that remembering needs:
 *
 *     claim ----> under way ----> kept, with the answer        after SRV_KEPT_SECONDS, or when
 *                     |             |                          newer ones need the room, forgotten
 *                     +-> end       +-> the same claim is told the answer
 *
 * The body of an answer is a copy made when it is kept. Where it is larger than SRV_KEPT_BODY or
 * memory is out, status and tag are kept without it: that the request took effect is never
 * forgotten for want of memory. The table has a lock of its own, taken after all others. */
#ifndef HE_SERVER_STORE_IDEMPOTENCY_H
#define HE_SERVER_STORE_IDEMPOTENCY_H

#include "api/store.h"

#include <pthread.h>

enum {
    SRV_KEPT_KEYS = 16384,     /* answers of one table; the oldest go first */
    SRV_KEPT_BYTES = 16 << 20, /* of one table, entries and bodies */
    SRV_KEPT_BODY = 4 << 20,   /* of one answer */
    SRV_KEPT_SECONDS = 24 * 3600
};

typedef struct srv_keys {
    pthread_mutex_t lock;
    struct api_claim **buckets;        /* a power of two, NULL before the first */
    size_t bucket_count, count;        /* of all entries */
    struct api_claim *oldest, *newest; /* of those kept */
    size_t kept;
    uint64_t bytes; /* of those kept */
    uint64_t secret[2];
} srv_keys;

/* An entry, counted by its table and by whoever claimed it. */
struct api_claim {
    srv_keys *keys;
    unsigned uses;
    bool is_kept, listed; /* listed: the table holds it */
    bool of_store;        /* the key is the store's, not the mesh's */
    double time;          /* of the claim, seconds since 1970 */
    uint64_t digest[2], hash;
    api_kept answer; /* `body` is owned */
    struct api_claim *next, *older, *newer;
    char key[];
};

void srv_keys_init(srv_keys *keys, const uint64_t secret[2]);
void srv_keys_clear(srv_keys *keys); /* nothing may be claimed */
/* `now` in seconds since 1970. */
api_claim_status srv_keys_claim(srv_keys *keys, const api_key *key, double now, api_claim **out);
void srv_keys_keep(api_claim *claim, const api_kept *answer);
void srv_keys_end(api_claim *claim);
/* Free the bodies nobody reads. */
void srv_keys_shed(srv_keys *keys);

#endif
