#include "api/event/events.h"

#include "api/event/change_json.h"
#include "api/event/event_values.h"
#include "api/limits.h"
#include "format/text/number.h"

#include <inttypes.h>
#include <string.h>

enum { RETRY_MILLIS = 3000 };

static void add_id(api_text *text, uint64_t incarnation, uint64_t revision)
{
    api_text_add_format(text, "id: %016" PRIx64 ".%" PRIu64 "\n", incarnation, revision);
}

static void add_event(api_text *text, const char *name, const api_text *data)
{
    api_text_add_format(text, "event: %s\ndata: ", name);
    api_text_add(text, data->bytes, data->length);
    api_text_add_string(text, "\n\n");
    text->failed |= data->failed;
}

void api_event_begin(api_text *text, const st_mesh_info *info, bool place)
{
    api_text_add_format(text, "retry: %d\n", RETRY_MILLIS);
    if (place) {
        add_id(text, info->incarnation, info->revision);
    }
    api_text_add_string(text, "\n");
}

void api_event_record(api_text *text, const char *name, const api_record *record, const void *value)
{
    api_text data = {0};
    api_out out;
    api_out_init(&out, &data);
    api_record_write(&out, record, value);
    add_event(text, name, &data);
    api_text_clear(&data);
}

typedef struct resync {
    uint64_t revision;
    const char *reason;
} resync;

static const api_field resync_fields[] = {
    API_FIELD("revision", "count", resync, revision, .required = true,
              .doc = "The present revision; the client must fetch the mesh again."),
    API_FIELD("reason", "#resync_reason", resync, reason, .required = true),
};
const api_record api_resync_record = API_RECORD("resync", resync_fields);

void api_event_resync(api_text *text, uint64_t incarnation, uint64_t revision, const char *reason)
{
    add_id(text, incarnation, revision);
    api_event_record(text, "resync", &api_resync_record, &(resync){revision, reason});
}

static const api_field metadata_fields[] = {
    API_FIELD("name", "text", st_mesh_info, name, .required = true, .doc = "The new name."),
};
const api_record api_metadata_record = API_RECORD("metadata", metadata_fields);

void api_event_metadata(api_text *text, const st_mesh_info *info)
{
    api_event_record(text, "metadata", &api_metadata_record, info);
}

typedef struct moment {
    uint64_t revision;
    const char *name; /* NULL: none */
} moment;

static const api_field moment_fields[] = {
    API_FIELD("revision", "count", moment, revision, .required = true),
    API_FIELD("name", "text?", moment, name, .required = true,
              .doc = "The new name of the revision; null if it has none any more."),
};
const api_record api_moment_record = API_RECORD("moment", moment_fields);

void api_event_moment(api_text *text, uint64_t revision, const char *name)
{
    const moment value = {revision, name[0] == '\0' ? NULL : name};
    api_event_record(text, "moment", &api_moment_record, &value);
}

typedef struct bye {
    const char *reason;
} bye;

static const api_field bye_fields[] = {
    API_FIELD("reason", "#bye_reason", bye, reason, .required = true),
};
const api_record api_bye_record = API_RECORD("bye", bye_fields);

void api_event_bye(api_text *text, const char *reason)
{
    api_event_record(text, "bye", &api_bye_record, &(bye){reason});
}

static void begin_edit(api_out *out, const st_mesh_info *info)
{
    api_out_object_begin(out);
    api_out_key_u64(out, "base", info->revision - 1);
    api_out_key_u64(out, "revision", info->revision);
}

/* Writes the data of an event `edit`. Returns false if the data are too long or memory is out. */
static bool write_edit(api_text *data, const st_mesh_info *info, const st_change *change,
                       const he_changes *changes)
{
    api_out out;
    api_out_init(&out, data);
    begin_edit(&out, info);
    api_out_key_string(&out, "action", api_action_name(change->action));
    api_write_changes(&out, changes);
    if (api_write_values(&out, change->content, change->delta, change->undone, NULL) != HE_OK) {
        return false;
    }
    api_out_object_end(&out);
    return !data->failed;
}

static void write_stale(api_text *data, const st_mesh_info *info)
{
    api_out out;
    api_text_empty(data);
    api_out_init(&out, data);
    begin_edit(&out, info);
    api_out_key_bool(&out, "stale", true);
    api_out_object_end(&out);
}

static void add_edit(api_text *text, const st_mesh_info *info, const api_text *data)
{
    add_id(text, info->incarnation, info->revision);
    add_event(text, "edit", data);
}

void api_event_stale(api_text *text, const st_mesh_info *info)
{
    api_text data = {0};
    write_stale(&data, info);
    add_edit(text, info, &data);
    api_text_clear(&data);
}

/* Returns true if the event about a delta would be too long: the delta has many records, or a
 * record of all positions, which is only made if many vertices move. If the whole content was
 * replaced, the event is short. */
static bool is_long(const he_delta *delta)
{
    bool all = false, replaced = false;
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        all |= delta->records[i].column == HE_COL_POSITIONS;
        replaced |= delta->records[i].column == HE_COL_REPLACED;
    }
    return delta->count > API_MAX_EVENT_ROWS || (all && !replaced);
}

/* Returns the elements that a delta changed: the sets in `change` if they were computed already;
 * otherwise computes them into `found`. Returns NULL if the delta is too large or memory is out. */
static const he_changes *changes_of(const st_change *change, he_changes *found)
{
    if (is_long(change->delta)) {
        return NULL;
    }
    if (change->changes != NULL) {
        return change->changes;
    }
    he_status status = he_changes_find(change->content, change->delta, 0, change->delta->count,
                                       change->undone, found, NULL);
    return status == HE_OK ? found : NULL;
}

void api_event_edit(api_text *text, const st_mesh_info *info, const st_change *change)
{
    api_text data = {.maximum = API_MAX_EVENT};
    he_changes found = {0};
    const he_changes *changes = changes_of(change, &found);
    if (changes != NULL && changes->replaced) {
        api_event_resync(text, info->incarnation, info->revision, "replaced");
    } else {
        if (changes == NULL || !write_edit(&data, info, change, changes)) {
            write_stale(&data, info);
        }
        add_edit(text, info, &data);
    }
    he_changes_clear(&found);
    api_text_clear(&data);
}

/* --- event ids --- */

static bool read_hexadecimal(const char *text, size_t length, uint64_t *out)
{
    uint64_t value = 0;
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        bool digit = c >= '0' && c <= '9';
        if (!digit && (c < 'a' || c > 'f')) {
            return false;
        }
        value = value << 4 | (uint64_t)(digit ? c - '0' : c - 'a' + 10);
    }
    *out = value;
    return true;
}

bool api_since_read(const char *text, st_since *out)
{
    enum { INCARNATION = 16 };
    st_since since = {.given = true};
    const char *dot = strchr(text, '.');
    const char *number = dot == NULL ? text : dot + 1, *end = number + strlen(number);
    size_t used = 0;
    if (dot != NULL) {
        since.has_incarnation =
            dot - text == INCARNATION && read_hexadecimal(text, INCARNATION, &since.incarnation);
        if (!since.has_incarnation) {
            return false;
        }
    }
    if (he_u64_parse(number, end, &since.revision, &used) != HE_OK || number + used != end) {
        return false;
    }
    *out = since;
    return true;
}
