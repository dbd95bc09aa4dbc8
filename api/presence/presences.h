/* presences.h - the clients that show themselves to others, by mesh.
 *
 * A presence is never stored and is no change of the mesh: it lives in this table only, until the
 * client leaves, or until API_PRESENCE_SECONDS have passed since it was last put. Listeners of the
 * mesh learn of changed presences at most once in API_PRESENCE_MICROS: changes in between are
 * collected. When a mesh has news, its listeners are woken (st_follow_nudge), and each asks for
 * what has changed since it asked last (api_presences_news), so a slow listener gets the newest
 * state and no queue grows. Listeners that have seen the same get one text, which is written once.
 *
 *     put --+-- last news API_PRESENCE_MICROS ago ------> listeners are woken
 *           +-- else: due -- api_presences_work waits --> listeners are woken
 *
 * The meshes of the table are known by their incarnations, so a mesh can be evicted while clients
 * are present, and another mesh with its id has none of them.
 *
 * One mutex guards the table. It is held while presences are written as JSON, and no other lock
 * is taken meanwhile. */
#ifndef HE_API_PRESENCE_PRESENCES_H
#define HE_API_PRESENCE_PRESENCES_H

#include "api/presence/presence.h"
#include "store/store.h"

typedef struct api_presences api_presences;

/* Makes an empty table for the meshes of a store. Returns NULL if memory is out. */
api_presences *api_presences_new(st_store *store);
void api_presences_free(api_presences *presences); /* takes NULL */

typedef enum api_presence_put {
    API_PRESENCE_PUT,
    API_PRESENCE_TAKEN,         /* a client with another token has the id of the client */
    API_PRESENCE_FULL,          /* the mesh, or the server, has the most clients that it may have */
    API_PRESENCE_FULL_OF_TOKEN, /* the token shows the most clients that it may show at a mesh */
    API_PRESENCE_NO_MEMORY
} api_presence_put;

/* Adds a presence to a mesh, or replaces that with the same client id. `holder` is the name of the
 * client's token, "" if it has none. */
api_presence_put api_presences_put(api_presences *presences, const st_mesh_info *mesh,
                                   const char *holder, const api_presence *presence);
/* Removes a presence, if the client of this token has put it. */
void api_presences_leave(api_presences *presences, const st_mesh_info *mesh, const char *holder,
                         const char *client);
/* Writes the answer to GET .../presence: {"clients":[...]}, in the order of the clients' ids. */
void api_presences_write(api_presences *presences, uint64_t incarnation, api_out *out);

/* Appends an event `presence` to `text` if presences of the mesh have changed since the moment
 * *seen, which becomes the present moment. At first, *seen is 0: a listener that has seen nobody.
 */
void api_presences_news(api_presences *presences, uint64_t incarnation, uint64_t *seen,
                        api_text *text);
/* Returns the number of present clients of all meshes. */
size_t api_presences_count(api_presences *presences);

/* Does what is due at the time `now` (st_clock_micros): forgets presences and wakes listeners.
 * Returns the time at which something will be due, UINT64_MAX if nothing will. `now` may be earlier
 * than the last puts: such presences stay. */
uint64_t api_presences_work(api_presences *presences, uint64_t now);
/* Does the work of api_presences_work whenever it is due, until api_presences_stop is called. The
 * server calls it on a thread of its own. */
void api_presences_run(api_presences *presences);
void api_presences_stop(api_presences *presences);

/* The JSON members of the answer to GET .../presence, and of the data of an event `presence`. */
extern const api_record api_presences_record, api_presence_news_record;

#endif
