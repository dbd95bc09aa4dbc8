/* rate.h - limits requests and bytes a second of each client: token buckets in a table of a fixed
 * size.
 *
 * A client's bucket holds `seconds` worth of its rate and fills at that rate. Each request takes
 * one unit from the bucket of requests; bodies and answers take their bytes as they are
 * transferred. A request is admitted if at least one request and one byte are left. So a large body
 * or answer is not cut off, but may take more bytes than the bucket has. No request is then
 * admitted until this debt is refilled and one byte is left.
 *
 *     taken     0 ......... capacity ........ more: a debt of bytes
 *               full        empty
 *
 * A bucket stores the amount taken and not refilled yet, exactly, in millionths, so that new limits
 * apply at once to existing buckets. Times are microseconds of a clock that the caller reads; if it
 * runs backwards nothing is filled.
 *
 * The table is allocated at the start. A full bucket can be evicted without loss, since a new one
 * is full, too: of the API_RATE_LOOKS buckets used longest ago, the first full one is evicted, else
 * the oldest. A request takes constant time, however many clients there are. Clients cannot
 * influence which buckets share a chain of the hash table, nor which bucket is evicted. Threads
 * share one lock. */
#ifndef HE_API_LIMIT_RATE_H
#define HE_API_LIMIT_RATE_H

#include "api/limit/limit.h"

enum { API_RATE_LOOKS = 8 };

typedef struct api_rates api_rates;

/* Identifies a client in the table of buckets; no two clients have the same key. */
typedef struct api_rate_key {
    uint64_t words[2];
} api_rate_key;

/* The limits of a client's rate; 0 requests or 0 bytes is no limit. `seconds` is at least 1. */
typedef struct api_rate {
    uint64_t requests, bytes; /* how many requests, and how many bytes, are allowed a second */
    uint64_t seconds; /* capacity of the bucket: how many seconds of requests and bytes it holds */
} api_rate;

/* What is left of one of the two amounts of a bucket: of its requests or of its bytes. */
typedef struct api_rate_left {
    uint64_t left;  /* number that is available now */
    uint64_t reset; /* seconds until the bucket is full, rounded up */
    /* Seconds until a request would be admitted, rounded up; 0 if the present request was
     * admitted. */
    uint64_t wait;
} api_rate_left;

typedef struct api_rate_state {
    /* What is left of the client's requests and of its bytes; if one of them has no limit, all its
     * members are zero. */
    api_rate_left requests, bytes;
} api_rate_state;

/* Makes a table for `capacity` clients. Returns NULL when memory is out. */
api_rates *api_rates_new(size_t capacity);
void api_rates_free(api_rates *rates);

/* Takes one request if a request and a byte are left. Otherwise returns false, takes nothing, and
 * sets out->requests.wait or out->bytes.wait or both, depending on which was short. */
bool api_rates_admit(api_rates *rates, const api_rate_key *key, const api_rate *rate, uint64_t now,
                     api_rate_state *out);
/* Takes bytes from the client's bucket, even if fewer are left. */
void api_rates_charge(api_rates *rates, const api_rate_key *key, const api_rate *rate,
                      uint64_t bytes, uint64_t now);
/* Returns the number of clients with a bucket. */
size_t api_rates_count(api_rates *rates);

/* Writes the values of the fields RateLimit-Policy and RateLimit, after the draft of the IETF's
 * HTTPAPI group (draft-ietf-httpapi-ratelimit-headers-10), terminated by NUL: each has an entry
 * "requests" and an entry "bytes" if these have limits, and is "" if neither has. */
enum { API_RATE_FIELD = 128 };
void api_rate_policy(const api_rate *rate, char out[API_RATE_FIELD]);
void api_rate_field(const api_rate *rate, const api_rate_state *state, char out[API_RATE_FIELD]);

#endif
