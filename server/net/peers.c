#include "server/net/peers.h"

#include "base/mem.h"
#include "base/siphash.h"
#include "system/random.h"

#include <pthread.h>
#include <string.h>

typedef struct peer {
    api_rate_key address;
    uint32_t count; /* number of open connections; 0 if the entry is free */
    uint32_t next;  /* next entry in the chain of a hash value, or in the list of free entries */
} peer;

struct srv_peers {
    pthread_mutex_t lock;
    uint64_t secret[2];
    size_t heads_mask;
    uint32_t *heads;
    uint32_t free;
    peer *peers;
};

srv_peers *srv_peers_new(size_t connections)
{
    size_t heads = 2;
    while (heads < 2 * connections) {
        heads *= 2;
    }
    srv_peers *peers = he_mem_zero(1, sizeof *peers);
    if (peers == NULL) {
        return NULL;
    }
    pthread_mutex_init(&peers->lock, NULL);
    peers->secret[0] = st_random();
    peers->secret[1] = st_random();
    peers->heads_mask = heads - 1;
    peers->heads = he_mem_array(NULL, heads, sizeof *peers->heads);
    peers->peers = he_mem_array(NULL, connections, sizeof *peers->peers);
    if (peers->heads == NULL || peers->peers == NULL) {
        srv_peers_free(peers);
        return NULL;
    }
    memset(peers->heads, 0xFF, heads * sizeof *peers->heads);
    peers->free = SRV_NO_PEER;
    for (size_t i = connections; i > 0; i--) {
        peers->peers[i - 1] = (peer){.next = peers->free};
        peers->free = (uint32_t)(i - 1);
    }
    return peers;
}

void srv_peers_free(srv_peers *peers)
{
    if (peers != NULL) {
        he_mem_free(peers->heads);
        he_mem_free(peers->peers);
        pthread_mutex_destroy(&peers->lock);
        he_mem_free(peers);
    }
}

static uint32_t *head_of(const srv_peers *peers, const api_rate_key *address)
{
    return &peers
                ->heads[he_siphash_of(peers->secret, address, sizeof *address) & peers->heads_mask];
}

uint32_t srv_peers_enter(srv_peers *peers, const api_rate_key *address, size_t *count)
{
    pthread_mutex_lock(&peers->lock);
    uint32_t *head = head_of(peers, address), at = *head;
    while (at != SRV_NO_PEER && memcmp(&peers->peers[at].address, address, sizeof *address) != 0) {
        at = peers->peers[at].next;
    }
    if (at == SRV_NO_PEER && peers->free != SRV_NO_PEER) {
        at = peers->free;
        peers->free = peers->peers[at].next;
        peers->peers[at] = (peer){.address = *address, .next = *head};
        *head = at;
    }
    *count = at == SRV_NO_PEER ? 0 : ++peers->peers[at].count;
    pthread_mutex_unlock(&peers->lock);
    return at;
}

void srv_peers_leave(srv_peers *peers, uint32_t left)
{
    if (left == SRV_NO_PEER) {
        return;
    }
    pthread_mutex_lock(&peers->lock);
    peer *p = &peers->peers[left];
    if (--p->count == 0) {
        uint32_t *at = head_of(peers, &p->address);
        while (*at != left) {
            at = &peers->peers[*at].next;
        }
        *at = p->next;
        p->next = peers->free;
        peers->free = left;
    }
    pthread_mutex_unlock(&peers->lock);
}
