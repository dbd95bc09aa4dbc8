/* peers.h - how many connections each address has open.
 *
 * The table has its memory from the start, as much as there can be connections. Entering and
 * leaving take the same time however many addresses there are, and nobody outside can choose which
 * of them share a chain. Workers share one lock. */
#ifndef HE_SERVER_NET_PEERS_H
#define HE_SERVER_NET_PEERS_H

#include "api/limit/rate.h"

#include <stdint.h>

typedef struct srv_peers srv_peers;

enum { SRV_NO_PEER = UINT32_MAX };

/* Counts so many connections at one time. NULL when memory is out. */
srv_peers *srv_peers_new(size_t connections);
void srv_peers_free(srv_peers *peers); /* takes NULL */

/* A connection of this address was opened. *count is how many it has, with this one. Returns what
 * srv_peers_leave takes, SRV_NO_PEER where there are more connections than were announced. */
uint32_t srv_peers_enter(srv_peers *peers, const api_rate_key *address, size_t *count);
/* It was closed. Takes SRV_NO_PEER. */
void srv_peers_leave(srv_peers *peers, uint32_t peer);

#endif
