#include "store/holder/holders.h"

#include "base/mem.h"
#include "base/siphash.h"

#include <string.h>

void st_holders_init(st_holders *holders, const uint64_t secret[2])
{
    *holders = (st_holders){.secret = secret};
    pthread_mutex_init(&holders->lock, NULL);
}

void st_holders_clear(st_holders *holders)
{
    for (size_t i = 0; i < ST_HOLDER_HEADS; i++) {
        for (st_holder *h = holders->heads[i], *next; h != NULL; h = next) {
            next = h->next;
            he_mem_free(h);
        }
    }
    pthread_mutex_destroy(&holders->lock);
}

/* --- functions whose caller holds the lock of the holders --- */

static st_holder **place_of(st_holders *holders, const char *name)
{
    const uint64_t hash = he_siphash_of(holders->secret, name, strlen(name));
    st_holder **at = &holders->heads[hash % ST_HOLDER_HEADS];
    while (*at != NULL && strcmp((*at)->name, name) != 0) {
        at = &(*at)->next;
    }
    return at;
}

/* Returns the holder with this name; adds it if there is none. Returns NULL if memory is out. */
static st_holder *find_or_add(st_holders *holders, const char *name)
{
    st_holder **at = place_of(holders, name);
    if (*at == NULL) {
        *at = he_mem_zero(1, sizeof **at);
        if (*at != NULL) {
            st_copy_text((*at)->name, name, ST_HOLDER);
            holders->count++;
        }
    }
    return *at;
}

static void take(const st_holding *come)
{
    if (come->holder != NULL) {
        come->holder->meshes++;
        come->holder->bytes += come->bytes;
    }
}

static void give_back(const st_holding *gone)
{
    if (gone->holder != NULL) {
        gone->holder->meshes--;
        gone->holder->bytes -= gone->bytes;
    }
}

static bool is_beyond(uint64_t before, uint64_t after, uint64_t most)
{
    return most != 0 && after > before && after > most;
}

/* --- functions that take the lock of the holders --- */

st_status st_holders_find(st_holders *holders, const char *name, st_holder **out)
{
    *out = NULL;
    if (name == NULL || name[0] == '\0') {
        return ST_OK;
    }
    pthread_mutex_lock(&holders->lock);
    *out = find_or_add(holders, name);
    pthread_mutex_unlock(&holders->lock);
    return *out == NULL ? ST_NO_MEMORY : ST_OK;
}

st_status st_holders_move(st_holders *holders, const st_holding *gone, const st_holding *come)
{
    st_holder *holder = come->holder;
    bool beyond = false;
    pthread_mutex_lock(&holders->lock);
    const uint64_t meshes = holder == NULL ? 0 : holder->meshes;
    const uint64_t bytes = holder == NULL ? 0 : holder->bytes;
    give_back(gone);
    take(come);
    if (holder != NULL) {
        beyond = is_beyond(meshes, holder->meshes, holder->most_meshes) ||
                 is_beyond(bytes, holder->bytes, holder->most_bytes);
    }
    if (beyond) {
        give_back(come);
        take(gone);
    }
    pthread_mutex_unlock(&holders->lock);
    return beyond ? ST_QUOTA : ST_OK;
}

void st_holders_note(st_holders *holders, const st_holding *gone, const st_holding *come)
{
    pthread_mutex_lock(&holders->lock);
    give_back(gone);
    take(come);
    pthread_mutex_unlock(&holders->lock);
}

static bool take_holding(void *context, const char *name, uint64_t bytes)
{
    st_holder *holder = find_or_add(context, name);
    if (holder != NULL) {
        take(&(st_holding){holder, bytes});
    }
    return holder != NULL;
}

st_status st_holders_count(st_holders *holders, const st_journal *journal)
{
    st_status status = ST_OK;
    if (journal->holdings == NULL) {
        return ST_OK;
    }
    pthread_mutex_lock(&holders->lock);
    for (size_t i = 0; i < ST_HOLDER_HEADS; i++) {
        for (st_holder *h = holders->heads[i]; h != NULL; h = h->next) {
            h->meshes = h->bytes = 0;
        }
    }
    status = journal->holdings(journal->self, take_holding, holders);
    pthread_mutex_unlock(&holders->lock);
    return status;
}

/* --- limits --- */

st_status st_holders_limit(st_holders *holders, const st_holder_limit *limits, size_t count)
{
    bool found = true;
    pthread_mutex_lock(&holders->lock);
    for (size_t i = 0; i < count && found; i++) {
        found = find_or_add(holders, limits[i].name) != NULL;
    }
    for (size_t i = 0; i < ST_HOLDER_HEADS && found; i++) {
        for (st_holder *h = holders->heads[i]; h != NULL; h = h->next) {
            h->most_meshes = h->most_bytes = 0;
        }
    }
    for (size_t i = 0; i < count && found; i++) {
        st_holder *holder = *place_of(holders, limits[i].name);
        holder->most_meshes = limits[i].meshes;
        holder->most_bytes = limits[i].bytes;
    }
    pthread_mutex_unlock(&holders->lock);
    return found ? ST_OK : ST_NO_MEMORY;
}

void st_holders_usage(st_holders *holders, const char *name, st_usage *out)
{
    *out = (st_usage){.meshes = 0};
    pthread_mutex_lock(&holders->lock);
    const st_holder *h = *place_of(holders, name);
    if (h != NULL) {
        *out = (st_usage){.meshes = h->meshes,
                          .bytes = h->bytes,
                          .most_meshes = h->most_meshes,
                          .most_bytes = h->most_bytes};
    }
    pthread_mutex_unlock(&holders->lock);
}
