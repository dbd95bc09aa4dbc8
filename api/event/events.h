/* events.h - the messages of an event stream, as text/event-stream spells them.
 *
 *     event    data                                                    id
 *     (none)   the beginning: `retry`, and where the stream begins     present
 *     edit     a revision as a delta, exact: see event_values.h        the revision's
 *     metadata {"name":"..."}                                          (none)
 *     resync   {"revision":n,"reason":"..."}: fetch the mesh anew      present
 *     job      what GET of a job gives; of a mesh's stream only
 *              {"id":"...","state":"...","progress":n}, when one of it begins and ends   (none)
 *     bye      {"reason":"..."}: the stream ends                       (none)
 *
 * An id is INCARNATION.REVISION, the incarnation as an ETag spells it. An edit of more than
 * API_MAX_EVENT bytes says {"base":n,"revision":n,"stale":true} only. A copy applies an edit whose
 * `base` is its revision, drops those it has, and fetches anew on any other, on `stale` and on
 * `resync`.
 *
 * Each function appends one whole message to `text`, whose failure is sticky. */
#ifndef HE_API_EVENT_EVENTS_H
#define HE_API_EVENT_EVENTS_H

#include "api/json/text.h"
#include "store/followers.h"

/* What is sent when nothing happens: a comment. */
#define API_EVENT_IDLE ":\n\n"

/* `place` is false where the stream does not begin at the present revision: then its first event
 * brings the id. */
void api_event_begin(api_text *text, const st_mesh_info *info, bool place);

/* What made info->revision out of the one before: of the change its action, its delta, what that
 * comes to if it was found, and the mesh after it. A delta that replaces the content becomes a
 * resync. */
void api_event_edit(api_text *text, const st_mesh_info *info, const st_change *change);
/* The same of a revision that cannot be said. */
void api_event_stale(api_text *text, const st_mesh_info *info);
void api_event_metadata(api_text *text, const st_mesh_info *info);
/* Reasons: "replaced" (the content as a whole, or a compact), "gap" (neither the listener's speed
 * nor the history reach), "busy" (too many listeners are being brought forward), "incarnation" and
 * "future" (of what the client said it has), "lost" (the newest changes could not be kept; the
 * stream ends). */
void api_event_resync(api_text *text, uint64_t incarnation, uint64_t revision, const char *reason);
/* A message of this name. */
void api_event_add(api_text *text, const char *name, const api_text *data);
/* Reasons: "deleted", "stopping", and of a job's stream "ended". */
void api_event_bye(api_text *text, const char *reason);

/* An id, or a bare revision. False when it is neither. */
bool api_since_read(const char *text, st_since *out);

#endif
