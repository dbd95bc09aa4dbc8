#include "server/store/idempotency.h"

#include "api/header/hash.h"
#include "base/mem.h"

#include <assert.h>
#include <string.h>

enum { FIRST_BUCKETS = 16 };

void srv_keys_init(srv_keys *keys, const uint64_t secret[2])
{
    *keys = (srv_keys){.secret = {secret[0], secret[1]}};
    pthread_mutex_init(&keys->lock, NULL);
}

static uint64_t bytes_of(const api_claim *claim)
{
    return sizeof *claim + strlen(claim->key) + 1 +
           (claim->answer.body == NULL ? 0 : claim->answer.length);
}

static void release(api_claim *claim)
{
    if (--claim->uses == 0) {
        he_mem_free((char *)claim->answer.body);
        he_mem_free(claim);
    }
}

static api_claim **find(const srv_keys *keys, const char *key, uint64_t hash)
{
    api_claim **at = &keys->buckets[hash & (keys->bucket_count - 1)];
    while (*at != NULL && ((*at)->hash != hash || strcmp((*at)->key, key) != 0)) {
        at = &(*at)->next;
    }
    return at;
}

/* Take it out of the table. */
static void forget(srv_keys *keys, api_claim *claim)
{
    *find(keys, claim->key, claim->hash) = claim->next;
    keys->count--;
    if (claim->is_kept) {
        *(claim->older == NULL ? &keys->oldest : &claim->older->newer) = claim->newer;
        *(claim->newer == NULL ? &keys->newest : &claim->newer->older) = claim->older;
        keys->kept--;
        keys->bytes -= bytes_of(claim);
    }
    claim->listed = false;
    release(claim);
}

void srv_keys_clear(srv_keys *keys)
{
    while (keys->oldest != NULL) {
        forget(keys, keys->oldest);
    }
    assert(keys->count == 0);
    he_mem_free(keys->buckets);
    pthread_mutex_destroy(&keys->lock);
}

/* Without memory for more the chains grow longer. */
static bool reserve_bucket(srv_keys *keys)
{
    if (keys->count < keys->bucket_count) {
        return true;
    }
    size_t before = keys->bucket_count;
    size_t size = before == 0 ? FIRST_BUCKETS : 2 * before;
    api_claim **old = keys->buckets, **buckets = he_mem_zero(size, sizeof(api_claim *));
    if (buckets == NULL) {
        return before > 0;
    }
    keys->buckets = buckets;
    keys->bucket_count = size;
    for (size_t i = 0; i < before; i++) {
        for (api_claim *claim = old[i], *next; claim != NULL; claim = next) {
            api_claim **at = &buckets[claim->hash & (size - 1)];
            next = claim->next;
            claim->next = *at;
            *at = claim;
        }
    }
    he_mem_free(old);
    return true;
}

static void forget_old(srv_keys *keys, double now)
{
    while (keys->oldest != NULL && keys->oldest->time + SRV_KEPT_SECONDS <= now) {
        forget(keys, keys->oldest);
    }
}

static api_claim_status add(srv_keys *keys, const api_key *key, uint64_t hash, double now,
                            api_claim **out)
{
    size_t length = strlen(key->text);
    api_claim *claim = reserve_bucket(keys) ? he_mem_zero(1, sizeof *claim + length + 1) : NULL;
    if (claim == NULL) {
        return API_CLAIM_NO_MEMORY;
    }
    claim->keys = keys;
    claim->uses = 2;
    claim->listed = true;
    claim->time = now;
    claim->digest[0] = key->digest[0];
    claim->digest[1] = key->digest[1];
    claim->hash = hash;
    memcpy(claim->key, key->text, length + 1);
    api_claim **at = &keys->buckets[hash & (keys->bucket_count - 1)];
    claim->next = *at;
    *at = claim;
    keys->count++;
    *out = claim;
    return API_CLAIM_NEW;
}

api_claim_status srv_keys_claim(srv_keys *keys, const api_key *key, double now, api_claim **out)
{
    uint64_t hash = api_hash_of(keys->secret, key->text, strlen(key->text));
    pthread_mutex_lock(&keys->lock);
    forget_old(keys, now);
    api_claim *claim = keys->bucket_count == 0 ? NULL : *find(keys, key->text, hash);
    api_claim_status status;
    if (claim == NULL) {
        status = add(keys, key, hash, now, out);
    } else if (claim->digest[0] != key->digest[0] || claim->digest[1] != key->digest[1]) {
        status = API_CLAIM_OTHER;
    } else if (!claim->is_kept) {
        status = API_CLAIM_BUSY;
    } else {
        claim->uses++;
        *out = claim;
        status = API_CLAIM_KEPT;
    }
    pthread_mutex_unlock(&keys->lock);
    return status;
}

void srv_keys_keep(api_claim *claim, const api_kept *answer)
{
    srv_keys *keys = claim->keys;
    char *body = NULL;
    if (answer->length > 0 && answer->length <= SRV_KEPT_BODY) {
        body = he_mem_alloc(answer->length);
    }
    if (body != NULL) {
        memcpy(body, answer->body, answer->length);
    } else if (answer->length > 0 && !answer->changed) {
        return; /* nothing to protect, so that it may be tried again */
    }
    pthread_mutex_lock(&keys->lock);
    assert(claim->listed && !claim->is_kept);
    claim->answer = *answer;
    claim->answer.body = body;
    claim->is_kept = true;
    claim->older = keys->newest;
    *(keys->newest == NULL ? &keys->oldest : &keys->newest->newer) = claim;
    keys->newest = claim;
    keys->kept++;
    keys->bytes += bytes_of(claim);
    while (keys->kept > SRV_KEPT_KEYS || keys->bytes > SRV_KEPT_BYTES) {
        forget(keys, keys->oldest);
    }
    pthread_mutex_unlock(&keys->lock);
}

void srv_keys_end(api_claim *claim)
{
    srv_keys *keys = claim->keys;
    pthread_mutex_lock(&keys->lock);
    if (claim->listed && !claim->is_kept) {
        forget(keys, claim);
    }
    release(claim);
    pthread_mutex_unlock(&keys->lock);
}

void srv_keys_shed(srv_keys *keys)
{
    pthread_mutex_lock(&keys->lock);
    for (api_claim *claim = keys->oldest; claim != NULL; claim = claim->newer) {
        if (claim->uses == 1 && claim->answer.changed && claim->answer.body != NULL) {
            keys->bytes -= claim->answer.length;
            he_mem_free((char *)claim->answer.body);
            claim->answer.body = NULL;
        }
    }
    pthread_mutex_unlock(&keys->lock);
}
