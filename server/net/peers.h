/* peers.h - counts the open connections of each address.
 *
 * The counts are in a hash table, which is allocated at the start for the maximum number of
 * connections. Its functions take the same time however many addresses there are. The hash has a
 * secret seed, so that clients cannot choose addresses that collide. One lock protects the table.
 */
#ifndef HE_SERVER_NET_PEERS_H
#define HE_SERVER_NET_PEERS_H

#include "api/limit/rate.h"

#include <stdint.h>

typedef struct srv_peers srv_peers;

enum { SRV_NO_PEER = UINT32_MAX };

/* Makes a table for at most this many connections. Returns NULL when memory is out. */
srv_peers *srv_peers_new(size_t connections);
void srv_peers_free(srv_peers *peers); /* takes NULL */

/* Counts a new connection of this address. Sets *count to the address's number of connections,
 * including the new one. Returns the argument for srv_peers_leave, or SRV_NO_PEER if the table is
 * full. */
uint32_t srv_peers_enter(srv_peers *peers, const api_rate_key *address, size_t *count);
/* Counts a connection that was closed; `peer` is what srv_peers_enter returned for it, also
 * SRV_NO_PEER. */
void srv_peers_leave(srv_peers *peers, uint32_t peer);

#endif
