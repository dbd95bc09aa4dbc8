/* events.h - the messages of an event stream, as text/event-stream spells them.
 *
 *     event    data                                                    id
 *     (none)   opening message: `retry`, and the present revision      present
 *     edit     a revision as a delta, exact: see event_values.h        the revision's
 *     metadata {"name":"..."}                                          (none)
 *     resync   {"revision":n,"reason":"..."}: fetch the mesh anew      present
 *     job      the body of GET /v1/jobs/{job}; on the stream of a mesh only
 *              {"id":"...","state":"...","progress":n}, when a job starts or ends  (none)
 *     bye      {"reason":"..."}: the stream ends                       (none)
 *
 * An id is INCARNATION.REVISION, the incarnation as an ETag spells it. Instead of an edit of more
 * than API_MAX_EVENT bytes the server sends {"base":n,"revision":n,"stale":true}. A mirror applies
 * an edit whose `base` is its own revision, ignores edits up to its revision, and fetches the mesh
 * again on any other edit, on `stale` and on `resync`.
 *
 * Each function appends one whole message to `text`, where failure is sticky. */
#ifndef HE_API_EVENT_EVENTS_H
#define HE_API_EVENT_EVENTS_H

#include "api/json/text.h"
#include "store/followers.h"

/* A comment of the stream's format, sent to keep an idle connection open. */
#define API_EVENT_IDLE ":\n\n"

/* Appends the opening message. If `place` is false the stream does not begin at the present
 * revision, and the first event carries the first id instead. */
void api_event_begin(api_text *text, const st_mesh_info *info, bool place);

/* Appends an event that describes the change that led to info->revision. Of `change` it uses the
 * action, the delta, the change sets if they were found, and the mesh after it. A change that
 * replaces the content becomes a resync. */
void api_event_edit(api_text *text, const st_mesh_info *info, const st_change *change);
/* Announces a revision whose change cannot be sent. */
void api_event_stale(api_text *text, const st_mesh_info *info);
void api_event_metadata(api_text *text, const st_mesh_info *info);
/* Appends a `resync`, which tells the listener to fetch the mesh again. Reasons: "replaced" (the
 * whole content, or a compact), "gap" (the listener was too slow and the history does not reach
 * back), "busy" (too many backfills), "incarnation" and "future" (the position that the client sent
 * is of another mesh, or later than the present), "lost" (the newest changes could not be made
 * durable; the stream ends). */
void api_event_resync(api_text *text, uint64_t incarnation, uint64_t revision, const char *reason);
/* Appends a message with this event name and this data. */
void api_event_add(api_text *text, const char *name, const api_text *data);
/* Appends a `bye`, after which the stream ends. Reasons: "deleted", "stopping", and on the stream
 * of a job "ended". */
void api_event_bye(api_text *text, const char *reason);

/* Reads the position from which a client wants events: an event id or a bare revision. Returns
 * false if the text is neither. */
bool api_since_read(const char *text, st_since *out);

#endif
