#include "api/limit/rate.h"

#include "base/mem.h"
#include "base/siphash.h"
#include "format/text/number.h"
#include "system/random.h"

#include <pthread.h>
#include <string.h>

#define MILLION UINT64_C(1000000)

enum { NONE = UINT32_MAX };
enum { REQUESTS, BYTES, AMOUNTS };

typedef struct bucket {
    api_rate_key key;
    uint64_t at; /* the time at which `taken` was last computed */
    /* The time at which the bucket will be full again: both amounts `taken` are then 0. */
    uint64_t full;
    /* Amounts that were taken from the bucket and are not refilled yet, in millionths of a request
     * and of a byte. */
    uint64_t taken[AMOUNTS];
    uint32_t next; /* next bucket in its chain of the hash table */
    uint32_t newer, older;
} bucket;

struct api_rates {
    pthread_mutex_t lock;
    uint64_t secret[2];
    size_t capacity, count, heads_mask;
    uint32_t newest, oldest;
    uint32_t *heads;
    bucket *buckets;
};

/* --- the table of buckets --- */

api_rates *api_rates_new(size_t capacity)
{
    size_t heads = 2;
    while (heads < 2 * capacity) {
        heads *= 2;
    }
    api_rates *rates = he_mem_zero(1, sizeof *rates);
    if (rates == NULL) {
        return NULL;
    }
    pthread_mutex_init(&rates->lock, NULL);
    rates->secret[0] = st_random();
    rates->secret[1] = st_random();
    rates->capacity = capacity;
    rates->heads_mask = heads - 1;
    rates->newest = rates->oldest = NONE;
    rates->heads = he_mem_array(NULL, heads, sizeof *rates->heads);
    rates->buckets = he_mem_array(NULL, capacity, sizeof *rates->buckets);
    if (rates->heads == NULL || rates->buckets == NULL) {
        api_rates_free(rates);
        return NULL;
    }
    memset(rates->heads, 0xFF, heads * sizeof *rates->heads);
    return rates;
}

void api_rates_free(api_rates *rates)
{
    if (rates != NULL) {
        he_mem_free(rates->heads);
        he_mem_free(rates->buckets);
        pthread_mutex_destroy(&rates->lock);
        he_mem_free(rates);
    }
}

static uint32_t *head_of(const api_rates *rates, const api_rate_key *key)
{
    return &rates->heads[he_siphash_of(rates->secret, key, sizeof *key) & rates->heads_mask];
}

static void unlink_age(api_rates *rates, const bucket *b)
{
    *(b->newer == NONE ? &rates->newest : &rates->buckets[b->newer].older) = b->older;
    *(b->older == NONE ? &rates->oldest : &rates->buckets[b->older].newer) = b->newer;
}

static void link_newest(api_rates *rates, uint32_t index)
{
    bucket *b = &rates->buckets[index];
    b->newer = NONE;
    b->older = rates->newest;
    *(b->older == NONE ? &rates->oldest : &rates->buckets[b->older].newer) = index;
    rates->newest = index;
}

/* Returns the bucket to evict: the first full one among those used longest ago or, if none of these
 * is full, the one used longest ago. The table must have a bucket. */
static uint32_t choose_old(const api_rates *rates, uint64_t now)
{
    uint32_t index = rates->oldest;
    for (int looks = 0; looks < API_RATE_LOOKS && index != NONE; looks++) {
        if (rates->buckets[index].full <= now) {
            return index;
        }
        index = rates->buckets[index].newer;
    }
    return rates->oldest;
}

static uint32_t take_place(api_rates *rates, uint64_t now)
{
    if (rates->count < rates->capacity) {
        return (uint32_t)rates->count++;
    }
    uint32_t index = choose_old(rates, now);
    uint32_t *at = head_of(rates, &rates->buckets[index].key);
    while (*at != index) {
        at = &rates->buckets[*at].next;
    }
    *at = rates->buckets[index].next;
    unlink_age(rates, &rates->buckets[index]);
    return index;
}

/* Finds the bucket of a client or adds one, and makes it the most recently used one. */
static bucket *find_or_add(api_rates *rates, const api_rate_key *key, uint64_t now)
{
    uint32_t *head = head_of(rates, key), index = *head;
    while (index != NONE && memcmp(&rates->buckets[index].key, key, sizeof *key) != 0) {
        index = rates->buckets[index].next;
    }
    if (index != NONE) {
        unlink_age(rates, &rates->buckets[index]);
    } else {
        index = take_place(rates, now);
        rates->buckets[index] = (bucket){.key = *key, .at = now, .next = *head};
        *head = index;
    }
    link_newest(rates, index);
    return &rates->buckets[index];
}

/* --- the amounts in one bucket --- */

static uint64_t product(uint64_t a, uint64_t b)
{
    uint64_t out;
    return __builtin_mul_overflow(a, b, &out) ? UINT64_MAX : out;
}

static uint64_t sum(uint64_t a, uint64_t b)
{
    return a > UINT64_MAX - b ? UINT64_MAX : a + b;
}

static uint64_t quotient_up(uint64_t a, uint64_t b)
{
    return a / b + (a % b != 0 ? 1 : 0);
}

/* Returns how many microseconds it takes to refill `millionths` of a request or byte, if `rate`
 * requests or bytes are refilled a second. */
static uint64_t time_to_fill(uint64_t millionths, uint64_t rate)
{
    return rate == 0 ? 0 : quotient_up(millionths, rate);
}

/* Refills a bucket for the time since it was last refilled. If there is no limit, the bucket
 * becomes full at once, so that it is full when the client gets a limit later. */
static void fill(bucket *b, const api_rate *rate, uint64_t now)
{
    const uint64_t rates[AMOUNTS] = {rate->requests, rate->bytes};
    const uint64_t elapsed = now > b->at ? now - b->at : 0;
    for (int i = 0; i < AMOUNTS; i++) {
        const uint64_t filled = rates[i] == 0 ? UINT64_MAX : product(rates[i], elapsed);
        b->taken[i] -= filled < b->taken[i] ? filled : b->taken[i];
    }
    b->at = now > b->at ? now : b->at;
}

static void take(bucket *b, const api_rate *rate, int which, uint64_t amount)
{
    b->taken[which] = sum(b->taken[which], product(amount, MILLION));
    const uint64_t requests = time_to_fill(b->taken[REQUESTS], rate->requests);
    const uint64_t bytes = time_to_fill(b->taken[BYTES], rate->bytes);
    b->full = sum(b->at, requests > bytes ? requests : bytes);
}

/* Returns true if at least one request (or one byte, as `which` says) is left in the bucket; fills
 * `out` in any case. */
static bool look(const bucket *b, uint64_t rate, uint64_t seconds, int which, api_rate_left *out)
{
    const uint64_t taken = b->taken[which];
    const uint64_t capacity = product(product(rate, seconds), MILLION);
    /* The difference is not negative, because `rate` and `seconds` are at least 1. */
    const uint64_t wanted = capacity - MILLION;
    *out = (api_rate_left){0};
    if (rate == 0) {
        return true;
    }
    out->left = taken < capacity ? (capacity - taken) / MILLION : 0;
    out->reset = quotient_up(time_to_fill(taken, rate), MILLION);
    out->wait = taken > wanted ? quotient_up(time_to_fill(taken - wanted, rate), MILLION) : 0;
    return taken <= wanted;
}

bool api_rates_admit(api_rates *rates, const api_rate_key *key, const api_rate *rate, uint64_t now,
                     api_rate_state *out)
{
    pthread_mutex_lock(&rates->lock);
    bucket *b = find_or_add(rates, key, now);
    fill(b, rate, now);
    bool admitted = look(b, rate->requests, rate->seconds, REQUESTS, &out->requests);
    admitted = look(b, rate->bytes, rate->seconds, BYTES, &out->bytes) && admitted;
    if (admitted) {
        take(b, rate, REQUESTS, rate->requests == 0 ? 0 : 1);
        (void)look(b, rate->requests, rate->seconds, REQUESTS, &out->requests);
        out->requests.wait = 0;
    }
    pthread_mutex_unlock(&rates->lock);
    return admitted;
}

void api_rates_charge(api_rates *rates, const api_rate_key *key, const api_rate *rate,
                      uint64_t bytes, uint64_t now)
{
    pthread_mutex_lock(&rates->lock);
    bucket *b = find_or_add(rates, key, now);
    fill(b, rate, now);
    take(b, rate, BYTES, bytes);
    pthread_mutex_unlock(&rates->lock);
}

size_t api_rates_count(api_rates *rates)
{
    pthread_mutex_lock(&rates->lock);
    size_t count = rates->count;
    pthread_mutex_unlock(&rates->lock);
    return count;
}

/* --- the values of header fields --- */

/* Appends a text to a header field. printf is avoided for speed, because every answer has these
 * fields. */
static char *add_text(char *to, const char *text)
{
    size_t length = strlen(text);
    memcpy(to, text, length);
    return to + length;
}

/* Appends a number to a header field. Structured fields allow integers of up to 15 digits. */
static char *add_number(char *to, uint64_t number)
{
    const uint64_t most = UINT64_C(999999999999999);
    return to + he_u64_print(number < most ? number : most, to);
}

static char *add_pair(char *to, const char *first, uint64_t a, const char *second, uint64_t b)
{
    return add_number(add_text(add_number(add_text(to, first), a), second), b);
}

void api_rate_policy(const api_rate *rate, char out[API_RATE_FIELD])
{
    char *to = out;
    if (rate->requests != 0) {
        to = add_pair(to, "\"requests\";q=", rate->requests * rate->seconds, ";w=", rate->seconds);
    }
    if (rate->bytes != 0) {
        to = add_text(to, rate->requests != 0 ? ", " : "");
        to = add_pair(to, "\"bytes\";q=", rate->bytes * rate->seconds, ";w=", rate->seconds);
        to = add_text(to, ";qu=\"content-bytes\"");
    }
    *to = '\0';
}

void api_rate_field(const api_rate *rate, const api_rate_state *state, char out[API_RATE_FIELD])
{
    char *to = out;
    if (rate->requests != 0) {
        to = add_pair(to, "\"requests\";r=", state->requests.left, ";t=", state->requests.reset);
    }
    if (rate->bytes != 0) {
        to = add_text(to, rate->requests != 0 ? ", " : "");
        to = add_pair(to, "\"bytes\";r=", state->bytes.left, ";t=", state->bytes.reset);
    }
    *to = '\0';
}
