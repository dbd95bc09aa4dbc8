/* rate.h - requests and bytes a second of each client: buckets, in a table of a fixed size.
 *
 * A client's bucket holds `seconds` worth of its rate and fills at the rate. A request takes one
 * from the bucket of requests; bytes are taken as bodies come and answers go. A request is let in
 * while there is one request and any byte left, so that a large body or answer is never cut, but
 * leaves a debt: nothing more is let in until it is paid.
 *
 *     taken     0 ......... capacity ........ more: a debt of bytes
 *               full        empty
 *
 * What is kept is how much was taken and not yet filled again, exactly, in millionths: so new
 * limits hold at once for a bucket that is there. Times are microseconds of a clock that the
 * caller reads. One that runs backwards fills nothing.
 *
 * The table has its memory from the start. A bucket that is full says nothing that a new one would
 * not: of the API_RATE_LOOKS buckets that were used longest ago the first that is full makes room,
 * else the oldest. All that is done for a request takes the same time, however many clients there
 * are. Clients choose neither which buckets share a chain nor whose goes. Threads share one lock.
 */
#ifndef HE_API_LIMIT_RATE_H
#define HE_API_LIMIT_RATE_H

#include "api/limit/limit.h"

enum { API_RATE_LOOKS = 8 };

typedef struct api_rates api_rates;

/* Whose bucket it is: another client's words differ. */
typedef struct api_rate_key {
    uint64_t words[2];
} api_rate_key;

/* 0 requests or bytes: as many as come. At least one second. */
typedef struct api_rate {
    uint64_t requests, bytes; /* a second */
    uint64_t seconds;         /* of either that the bucket holds */
} api_rate;

/* What is left of one of the two. */
typedef struct api_rate_left {
    uint64_t left;  /* that may be taken now */
    uint64_t reset; /* seconds until the bucket is full, rounded up */
    uint64_t wait;  /* seconds until a request is let in, rounded up; 0: it was */
} api_rate_left;

typedef struct api_rate_state {
    api_rate_left requests, bytes; /* of one without a limit nothing is said: 0 */
} api_rate_state;

/* NULL when memory is out. */
api_rates *api_rates_new(size_t capacity);
void api_rates_free(api_rates *rates);

/* Takes one request where there is one left, and a byte: false with how long to wait in the part
 * of `out` that refused it, or in both; nothing is taken then. */
bool api_rates_admit(api_rates *rates, const api_rate_key *key, const api_rate *rate, uint64_t now,
                     api_rate_state *out);
/* Takes bytes, whether there are so many or not. */
void api_rates_charge(api_rates *rates, const api_rate_key *key, const api_rate *rate,
                      uint64_t bytes, uint64_t now);
/* How many clients have a bucket. */
size_t api_rates_count(api_rates *rates);

/* The values of the fields RateLimit-Policy and RateLimit, after the draft of the IETF's HTTPAPI
 * group (draft-ietf-httpapi-ratelimit-headers-10), ended by a null: the policies "requests" and
 * "bytes", with a limit each. "" where there is none. */
enum { API_RATE_FIELD = 128 };
void api_rate_policy(const api_rate *rate, char out[API_RATE_FIELD]);
void api_rate_field(const api_rate *rate, const api_rate_state *state, char out[API_RATE_FIELD]);

#endif
