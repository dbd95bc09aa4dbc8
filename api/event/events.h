/* events.h - the messages of an event stream, in the format text/event-stream.
 *
 *     event    data                                                    id
 *     (none)   opening message: `retry`, and the present revision      present revision
 *     edit     a change and the values it wrote: event_values.h        the new revision
 *     metadata {"name":"..."}                                          (none)
 *     moment   {"revision":n,"name":"..."}: the name of a revision     (none)
 *     presence {"clients":["id",...],"changed":[...]}: who is there    (none)
 *     resync   {"revision":n,"reason":"..."}: fetch the mesh anew      present revision
 *     job      the body of GET /v1/jobs/{job}; on the stream of a mesh only
 *              {"id":"...","state":"...","progress":n}, when a job starts or ends  (none)
 *     bye      {"reason":"..."}: the stream ends                       (none)
 *
 * An id is INCARNATION.REVISION, with the incarnation written as in an ETag. If the data of an edit
 * would be longer than API_MAX_EVENT bytes, it is {"base":n,"revision":n,"stale":true}. A client
 * that keeps a copy of the mesh applies an edit whose `base` is the copy's revision, ignores edits
 * up to that revision, and fetches the mesh again on any other edit, on `stale` and on `resync`.
 *
 * Each function appends one whole message to `text`. If an append fails, `text` stays marked as
 * failed (text.h). */
#ifndef HE_API_EVENT_EVENTS_H
#define HE_API_EVENT_EVENTS_H

#include "api/json/record.h"
#include "store/followers.h"

/* The JSON members of the data of the events resync, metadata, moment and bye. */
extern const api_record api_resync_record, api_metadata_record, api_moment_record, api_bye_record;

/* A comment in the format text/event-stream, sent to keep an idle connection open. */
#define API_EVENT_IDLE ":\n\n"

/* Appends the opening message. `place` is false if the stream begins with revisions before the
 * present one: then the opening message has no id, and the first id that the client gets is that of
 * the first event. */
void api_event_begin(api_text *text, const st_mesh_info *info, bool place);

/* Appends an event that describes the change that led to info->revision. Of `change` it reads the
 * action, the delta, the sets of changed elements if they were found already, and the mesh after
 * the change. A change that replaces the whole mesh data becomes a `resync`. */
void api_event_edit(api_text *text, const st_mesh_info *info, const st_change *change);
/* Appends an `edit` with "stale":true, which announces a revision whose change cannot be sent. */
void api_event_stale(api_text *text, const st_mesh_info *info);
void api_event_metadata(api_text *text, const st_mesh_info *info);
/* Appends a `moment`, which says that a revision has a new name, or no name any more if `name` is
 * "". */
void api_event_moment(api_text *text, uint64_t revision, const char *name);
/* Appends a `resync`, which tells the listener to fetch the mesh again. Reasons: "replaced" (the
 * mesh data was replaced as a whole, or compacted), "gap" (the listener was too slow, and the
 * history no longer has the revisions that it missed), "busy" (too many backfills), "incarnation"
 * (the position that the client sent belongs to another mesh that had this id), "future" (that
 * position is later than the present one), "lost" (the newest changes could not be made durable;
 * the stream ends). */
void api_event_resync(api_text *text, uint64_t incarnation, uint64_t revision, const char *reason);
/* Appends a message with the given event name, whose data is the struct at `value` written as an
 * object. */
void api_event_record(api_text *text, const char *name, const api_record *record,
                      const void *value);
/* Appends a `bye`, after which the stream ends. Reasons: "deleted", "stopping", "token" (the
 * client's token is no longer valid), and on the stream of a job "ended". */
void api_event_bye(api_text *text, const char *reason);

/* Reads the position after which a client wants events: an event id, or only a revision. Returns
 * false if the text is neither. */
bool api_since_read(const char *text, st_since *out);

#endif
