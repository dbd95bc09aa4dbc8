#include "store/idempotency.h"

#include "base/mem.h"
#include "base/siphash.h"
#include "system/clock.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

enum { FIRST_BUCKETS = 16 };

void st_keys_init(st_keys *keys, const uint64_t secret[2])
{
    *keys = (st_keys){.secret = {secret[0], secret[1]}};
    pthread_mutex_init(&keys->lock, NULL);
}

static uint64_t bytes_of(const st_keyed *keyed)
{
    return sizeof *keyed + strlen(keyed->text) + 1 + strlen(keyed->key.holder) + 1 +
           (keyed->answer.body == NULL ? 0 : keyed->answer.length);
}

static void release(st_keyed *keyed)
{
    if (--keyed->uses == 0) {
        he_mem_free((char *)keyed->answer.body);
        he_mem_free(keyed);
    }
}

static st_keyed **find(const st_keys *keys, const char *key, const char *holder, uint64_t hash)
{
    st_keyed **at = &keys->buckets[hash & (keys->bucket_count - 1)];
    while (*at != NULL && ((*at)->hash != hash || strcmp((*at)->text, key) != 0 ||
                           strcmp((*at)->key.holder, holder) != 0)) {
        at = &(*at)->next;
    }
    return at;
}

/* Removes an entry from the table of Idempotency-Keys. */
static void forget(st_keys *keys, st_keyed *keyed)
{
    *find(keys, keyed->text, keyed->key.holder, keyed->hash) = keyed->next;
    keys->count--;
    if (keyed->is_kept) {
        *(keyed->older == NULL ? &keys->oldest : &keyed->older->newer) = keyed->newer;
        *(keyed->newer == NULL ? &keys->newest : &keyed->newer->older) = keyed->older;
        keys->kept--;
        keys->bytes -= bytes_of(keyed);
    }
    keyed->listed = false;
    release(keyed);
}

void st_keys_clear(st_keys *keys)
{
    while (keys->oldest != NULL) {
        forget(keys, keys->oldest);
    }
    assert(keys->count == 0);
    he_mem_free(keys->buckets);
    pthread_mutex_destroy(&keys->lock);
}

/* Enlarges the hash table if it is too full. If memory is out, the table is not enlarged, and the
 * lists of entries with equal hash become longer. */
static bool reserve_bucket(st_keys *keys)
{
    if (keys->count < keys->bucket_count) {
        return true;
    }
    size_t before = keys->bucket_count;
    size_t size = before == 0 ? FIRST_BUCKETS : 2 * before;
    st_keyed **old = keys->buckets, **buckets = he_mem_zero(size, sizeof(st_keyed *));
    if (buckets == NULL) {
        return before > 0;
    }
    keys->buckets = buckets;
    keys->bucket_count = size;
    for (size_t i = 0; i < before; i++) {
        for (st_keyed *keyed = old[i], *next; keyed != NULL; keyed = next) {
            st_keyed **at = &buckets[keyed->hash & (size - 1)];
            next = keyed->next;
            keyed->next = *at;
            *at = keyed;
        }
    }
    he_mem_free(old);
    return true;
}

static void forget_old(st_keys *keys, double now)
{
    while (keys->oldest != NULL && keys->oldest->key.time + ST_KEPT_SECONDS <= now) {
        forget(keys, keys->oldest);
    }
}

/* Adds an entry for a request with an Idempotency-Key that begins now. Returns NULL if memory is
 * out. */
static st_keyed *add(st_keys *keys, const st_key *key, const char *whose, uint64_t hash, double now)
{
    size_t length = strlen(key->text), holder = strlen(whose);
    st_keyed *keyed =
        reserve_bucket(keys) ? he_mem_zero(1, sizeof *keyed + length + holder + 2) : NULL;
    if (keyed == NULL) {
        return NULL;
    }
    keyed->keys = keys;
    keyed->uses = 2;
    keyed->listed = true;
    keyed->key = (st_record_key){.text = keyed->text,
                                 .holder = keyed->text + length + 1,
                                 .digest = {key->digest[0], key->digest[1]},
                                 .time = now};
    keyed->hash = hash;
    memcpy(keyed->text, key->text, length + 1);
    memcpy(keyed->text + length + 1, whose, holder + 1);
    st_keyed **at = &keys->buckets[hash & (keys->bucket_count - 1)];
    keyed->next = *at;
    *at = keyed;
    keys->count++;
    return keyed;
}

st_keyed_status st_keys_begin(st_keys *keys, const st_key *key, double now, st_keyed **out)
{
    const char *holder = key->holder == NULL ? "" : key->holder;
    uint64_t hash = he_siphash_of(keys->secret, key->text, strlen(key->text)) ^
                    he_siphash_of(keys->secret, holder, strlen(holder));
    pthread_mutex_lock(&keys->lock);
    forget_old(keys, now);
    st_keyed *keyed = keys->bucket_count == 0 ? NULL : *find(keys, key->text, holder, hash);
    st_keyed_status status;
    if (keyed == NULL) {
        keyed = add(keys, key, holder, hash, now);
        status = ST_KEYED_NO_MEMORY;
        if (keyed != NULL) {
            *out = keyed;
            status = ST_KEYED_NEW;
        }
    } else if (keyed->is_damaged) {
        status = ST_KEYED_DAMAGED;
    } else if (keyed->key.digest[0] != key->digest[0] || keyed->key.digest[1] != key->digest[1]) {
        status = ST_KEYED_OTHER;
    } else if (!keyed->is_kept) {
        status = ST_KEYED_BUSY;
    } else {
        keyed->uses++;
        *out = keyed;
        status = ST_KEYED_KEPT;
    }
    pthread_mutex_unlock(&keys->lock);
    return status;
}

void st_keyed_keep(st_keyed *keyed, const st_kept *answer)
{
    st_keys *keys = keyed->keys;
    char *body = NULL;
    if (answer->length > 0 && answer->length <= ST_KEPT_BODY) {
        body = he_mem_alloc(answer->length);
    }
    if (body != NULL) {
        memcpy(body, answer->body, answer->length);
    } else if (answer->length > 0 && !answer->changed) {
        /* The request changed nothing, so it can be executed again if the client repeats it. Its
         * answer is not kept. */
        return;
    }
    pthread_mutex_lock(&keys->lock);
    assert(keyed->listed && !keyed->is_kept);
    keyed->answer = *answer;
    keyed->answer.body = body;
    keyed->is_kept = true;
    keyed->older = keys->newest;
    *(keys->newest == NULL ? &keys->oldest : &keys->newest->newer) = keyed;
    keys->newest = keyed;
    keys->kept++;
    keys->bytes += bytes_of(keyed);
    while (keys->kept > ST_KEPT_KEYS || keys->bytes > ST_KEPT_BYTES) {
        forget(keys, keys->oldest);
    }
    pthread_mutex_unlock(&keys->lock);
}

bool st_keys_restore(void *context, const st_kept_key *kept)
{
    st_keys *keys = context;
    const st_record_key *was = &kept->key;
    const st_key key = {
        .text = was->text, .holder = was->holder, .digest = {was->digest[0], was->digest[1]}};
    st_kept answer = {.status = was->of_store ? 201 : 204,
                      .changed = true,
                      .incarnation = kept->incarnation,
                      .revision = kept->revision,
                      .metadata = kept->metadata};
    snprintf(answer.id, sizeof answer.id, "%s", kept->id);
    st_keyed *keyed;
    /* The time in a damaged row may be wrong, so the present time is used instead. */
    const double time = kept->is_damaged ? st_clock_utc() : was->time;
    switch (st_keys_begin(keys, &key, time, &keyed)) {
    case ST_KEYED_NEW:
        keyed->is_damaged = kept->is_damaged;
        st_keyed_keep(keyed, &answer);
        st_keyed_end(keyed);
        break;
    /* the key was used again in the meantime, so memory has a newer answer than the disk */
    case ST_KEYED_KEPT:
        st_keyed_end(keyed);
        break;
    case ST_KEYED_BUSY:
    case ST_KEYED_OTHER:
    case ST_KEYED_DAMAGED:
        break;
    case ST_KEYED_NO_MEMORY:
        return false;
    }
    return true;
}

void st_keyed_end(st_keyed *keyed)
{
    st_keys *keys = keyed->keys;
    pthread_mutex_lock(&keys->lock);
    if (keyed->listed && !keyed->is_kept) {
        forget(keys, keyed);
    }
    release(keyed);
    pthread_mutex_unlock(&keys->lock);
}

void st_keys_forget(st_keyed *keyed)
{
    st_keys *keys = keyed->keys;
    pthread_mutex_lock(&keys->lock);
    if (keyed->listed) {
        forget(keys, keyed);
    }
    release(keyed);
    pthread_mutex_unlock(&keys->lock);
}

void st_keys_shed(st_keys *keys)
{
    pthread_mutex_lock(&keys->lock);
    for (st_keyed *keyed = keys->oldest; keyed != NULL; keyed = keyed->newer) {
        if (keyed->uses == 1 && keyed->answer.changed && keyed->answer.body != NULL) {
            keys->bytes -= keyed->answer.length;
            he_mem_free((char *)keyed->answer.body);
            keyed->answer.body = NULL;
        }
    }
    pthread_mutex_unlock(&keys->lock);
}

const st_kept *st_keyed_answer(const st_keyed *keyed)
{
    return &keyed->answer;
}
