#include "api/token/token_set.h"

#include "base/mem.h"
#include "base/siphash.h"
#include "system/random.h"

#include <pthread.h>
#include <string.h>

/* The number of buckets of the hash table is a power of two, large enough that few tokens share a
 * bucket. */
enum { BUCKETS = 2 * API_TOKENS, NONE = UINT16_MAX };

struct api_tokens {
    pthread_mutex_t lock;
    api_token_list list;
    /* Chains of the hash table, as indices into `list`; NONE: end of a chain. */
    uint16_t heads[BUCKETS];
    uint16_t nexts[API_TOKENS];
    uint64_t secret[2]; /* hash key: clients cannot predict the buckets */
    api_limits defaults;
    api_token_watch *watches;
};

api_tokens *api_tokens_new(void)
{
    api_tokens *tokens = he_mem_zero(1, sizeof *tokens);
    if (tokens != NULL) {
        pthread_mutex_init(&tokens->lock, NULL);
        memset(tokens->heads, 0xFF, sizeof tokens->heads);
        tokens->secret[0] = st_random();
        tokens->secret[1] = st_random();
    }
    return tokens;
}

void api_tokens_free(api_tokens *tokens)
{
    if (tokens != NULL) {
        api_token_list_clear(&tokens->list);
        pthread_mutex_destroy(&tokens->lock);
        he_mem_free(tokens);
    }
}

static uint16_t *bucket_of(api_tokens *tokens, const unsigned char hash[API_TOKEN_HASH])
{
    uint64_t word = he_siphash_of(tokens->secret, (const char *)hash, API_TOKEN_HASH);
    return &tokens->heads[word % BUCKETS];
}

/* Finds the token with this hash. It compares all tokens of the bucket, so that the time does not
 * show which one matched. Returns NULL if none does. */
static api_token *find(api_tokens *tokens, const unsigned char hash[API_TOKEN_HASH])
{
    api_token *found = NULL;
    for (uint16_t i = *bucket_of(tokens, hash); i != NONE; i = tokens->nexts[i]) {
        found = api_token_matches(tokens->list.items[i], hash) ? tokens->list.items[i] : found;
    }
    return found;
}

void api_tokens_limit(api_tokens *tokens, const api_limits *defaults)
{
    pthread_mutex_lock(&tokens->lock);
    tokens->defaults = *defaults;
    pthread_mutex_unlock(&tokens->lock);
}

/* Returns true if two tokens are equal apart from their limits. */
static bool says_the_same(const api_token *a, const api_token *b)
{
    return strcmp(a->name, b->name) == 0 && a->role == b->role && a->expires == b->expires &&
           a->prefix_count == b->prefix_count &&
           memcmp(a->prefixes, b->prefixes, sizeof a->prefixes) == 0;
}

static void set_limits(api_token *to, const api_token *line, const api_limits *defaults)
{
    for (size_t i = 0; i < API_LIMIT_COUNT; i++) {
        const bool own = (line->own_limits >> i & 1) != 0;
        const uint64_t most = own ? api_token_limit(line, (api_limit)i) : defaults->most[i];
        atomic_store_explicit(&to->limits[i], most, memory_order_relaxed);
    }
}

/* Replaces each new token that equals a token in force, apart from limits, by that token in force,
 * because requests hold references to it. Sets the limits of all tokens in the new list. */
static void keep_known(api_tokens *tokens, api_token_list *fresh)
{
    for (size_t i = 0; i < fresh->count; i++) {
        api_token *known = find(tokens, fresh->items[i]->hash);
        const bool same = known != NULL && says_the_same(known, fresh->items[i]);
        set_limits(same ? known : fresh->items[i], fresh->items[i], &tokens->defaults);
        if (same) {
            api_token_release(fresh->items[i]);
            fresh->items[i] = api_token_hold(known);
        }
    }
}

static void index_all(api_tokens *tokens)
{
    memset(tokens->heads, 0xFF, sizeof tokens->heads);
    for (size_t i = 0; i < tokens->list.count; i++) {
        uint16_t *head = bucket_of(tokens, tokens->list.items[i]->hash);
        tokens->nexts[i] = *head;
        *head = (uint16_t)i;
    }
}

/* Revokes the tokens that are only in the old list. */
static void revoke_gone(api_tokens *tokens, const api_token_list *old)
{
    for (size_t i = 0; i < old->count; i++) {
        if (find(tokens, old->items[i]->hash) != old->items[i]) {
            atomic_store(&old->items[i]->revoked, true);
        }
    }
}

static void stop_watching(api_token_watch *watch)
{
    if (watch->place != NULL) {
        *watch->place = watch->next;
        if (watch->next != NULL) {
            watch->next->place = watch->place;
        }
        watch->place = NULL;
    }
}

static void tell_watches(api_tokens *tokens)
{
    for (api_token_watch *watch = tokens->watches, *next; watch != NULL; watch = next) {
        next = watch->next;
        if (atomic_load(&watch->token->revoked)) {
            stop_watching(watch);
            watch->gone(watch);
        }
    }
}

bool api_tokens_load(api_tokens *tokens, const char *bytes, size_t length,
                     char message[API_TOKENS_MESSAGE])
{
    api_token_list fresh;
    if (!api_token_file_read(bytes, length, &fresh, message)) {
        return false;
    }
    pthread_mutex_lock(&tokens->lock);
    api_token_list old = tokens->list;
    keep_known(tokens, &fresh);
    tokens->list = fresh;
    index_all(tokens);
    revoke_gone(tokens, &old);
    tell_watches(tokens);
    pthread_mutex_unlock(&tokens->lock);
    api_token_list_clear(&old);
    return true;
}

size_t api_tokens_count(api_tokens *tokens)
{
    pthread_mutex_lock(&tokens->lock);
    size_t count = tokens->list.count;
    pthread_mutex_unlock(&tokens->lock);
    return count;
}

bool api_tokens_all(api_tokens *tokens, api_token_list *out)
{
    *out = (api_token_list){he_mem_array(NULL, API_TOKENS, sizeof *out->items), 0};
    if (out->items == NULL) {
        return false;
    }
    pthread_mutex_lock(&tokens->lock);
    for (; out->count < tokens->list.count; out->count++) {
        out->items[out->count] = api_token_hold(tokens->list.items[out->count]);
    }
    pthread_mutex_unlock(&tokens->lock);
    return true;
}

api_token *api_tokens_find(api_tokens *tokens, const char *text, size_t length, double now)
{
    unsigned char hash[API_TOKEN_HASH];
    if (length == 0 || length > API_TOKEN_LONGEST) {
        return NULL;
    }
    api_token_hash(text, length, hash);
    pthread_mutex_lock(&tokens->lock);
    api_token *found = api_token_hold(find(tokens, hash));
    pthread_mutex_unlock(&tokens->lock);
    if (found != NULL && !api_token_is_current(found, now)) {
        api_token_release(found);
        found = NULL;
    }
    return found;
}

void api_tokens_watch(api_tokens *tokens, api_token_watch *watch)
{
    pthread_mutex_lock(&tokens->lock);
    watch->next = tokens->watches;
    watch->place = &tokens->watches;
    if (watch->next != NULL) {
        watch->next->place = &watch->next;
    }
    tokens->watches = watch;
    if (atomic_load(&watch->token->revoked)) {
        stop_watching(watch);
        watch->gone(watch);
    }
    pthread_mutex_unlock(&tokens->lock);
}

void api_tokens_unwatch(api_tokens *tokens, api_token_watch *watch)
{
    pthread_mutex_lock(&tokens->lock);
    stop_watching(watch);
    pthread_mutex_unlock(&tokens->lock);
}
