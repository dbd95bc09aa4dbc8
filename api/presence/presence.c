#include "api/presence/presence.h"

#include "api/json/problem.h"

#include <string.h>

/* --- reading --- */

static const char *const members[] = {"client", "name", "selection", "camera", "leaves", NULL};
static const char *const selection_members[] = {"kind", "ids", "count", NULL};
static const char *const camera_members[] = {"position", "target", "up", NULL};

static bool is_plain(const char *text)
{
    static const char allowed[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    return text[0] != '\0' && strspn(text, allowed) == strlen(text);
}

static bool read_client(const api_in *root, api_presence *out)
{
    api_in member;
    const char *text;
    if (!api_in_need(root, "client", &member) ||
        !api_in_string(&member, API_PRESENCE_CLIENT, &text)) {
        return false;
    }
    if (!is_plain(text)) {
        return api_in_fail(&member, HE_BAD_VALUE,
                           "the id of a client has letters, digits, '.', '_' and '-' only");
    }
    memcpy(out->client, text, strlen(text) + 1);
    return true;
}

static bool read_name(const api_in *root, api_presence *out)
{
    api_in member;
    const char *text = "";
    if (api_in_find(root, "name", &member) && !api_in_is_null(&member) &&
        !api_in_seen_name(&member, API_PRESENCE_NAME, &text)) {
        return false;
    }
    memcpy(out->name, text, strlen(text) + 1);
    return true;
}

static bool read_ids(const api_in *in, api_presence *out)
{
    api_in child;
    uint32_t count = 0;
    if (!api_in_array(in, 0, API_PRESENCE_IDS)) {
        return false;
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_id(&child, &out->selection.ids[count++])) {
            return false;
        }
    }
    out->selection.listed = count;
    out->selection.count = count;
    return true;
}

static bool read_selection(const api_in *in, api_presence *out)
{
    static const char *const kinds[] = {"vertex", "halfedge", "edge", "face", NULL};
    static const he_kind kind_of[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE};
    api_in member;
    int kind;
    if (api_in_is_null(in)) {
        return true;
    }
    if (!api_in_only(in, selection_members) || !api_in_need(in, "kind", &member) ||
        !api_in_choice(&member, kinds, &kind) || !api_in_need(in, "ids", &member) ||
        !read_ids(&member, out)) {
        return false;
    }
    out->selection.kind = kind_of[kind];
    out->has_selection = true;
    return !api_in_find(in, "count", &member) ||
           api_in_u64(&member, out->selection.listed, UINT32_MAX, &out->selection.count);
}

static bool read_camera(const api_in *in, api_presence *out)
{
    api_in position, target, up;
    if (api_in_is_null(in)) {
        return true;
    }
    out->has_camera = true;
    return api_in_only(in, camera_members) && api_in_need(in, "position", &position) &&
           api_in_vec3(&position, &out->camera.position) && api_in_need(in, "target", &target) &&
           api_in_vec3(&target, &out->camera.target) && api_in_need(in, "up", &up) &&
           api_in_vec3(&up, &out->camera.up);
}

bool api_presence_read(const api_in *root, api_presence *out, bool *leaves)
{
    api_in selection, camera, member;
    /* All bytes are set, because presences are compared and copied as wholes. */
    memset(out, 0, sizeof *out);
    *leaves = false;
    return api_in_only(root, members) && read_client(root, out) && read_name(root, out) &&
           (!api_in_find(root, "selection", &selection) || read_selection(&selection, out)) &&
           (!api_in_find(root, "camera", &camera) || read_camera(&camera, out)) &&
           (!api_in_find(root, "leaves", &member) || api_in_bool(&member, leaves));
}

static bool is_equal_vec3(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool has_equal_selection(const api_presence *a, const api_presence *b)
{
    return a->has_selection == b->has_selection && a->selection.kind == b->selection.kind &&
           a->selection.listed == b->selection.listed && a->selection.count == b->selection.count &&
           memcmp(a->selection.ids, b->selection.ids,
                  a->selection.listed * sizeof *a->selection.ids) == 0;
}

static bool has_equal_camera(const api_presence *a, const api_presence *b)
{
    return a->has_camera == b->has_camera &&
           is_equal_vec3(a->camera.position, b->camera.position) &&
           is_equal_vec3(a->camera.target, b->camera.target) &&
           is_equal_vec3(a->camera.up, b->camera.up);
}

bool api_presence_is_equal(const api_presence *a, const api_presence *b)
{
    return strcmp(a->client, b->client) == 0 && strcmp(a->name, b->name) == 0 &&
           has_equal_selection(a, b) && has_equal_camera(a, b);
}

/* --- writing --- */

static void write_kind(api_out *out, const void *kind)
{
    api_out_string(out, he_kind_name(*(const he_kind *)kind));
}

static void write_ids(api_out *out, const void *value)
{
    const api_presence *presence = value;
    api_out_ids(out, presence->selection.ids, presence->selection.listed);
}

static const api_field selection_fields[] = {
    API_FIELD_MADE_OF("kind", "#presence_kind", api_presence, selection.kind, write_kind,
                      .required = true),
    API_FIELD_MADE("ids", "*id", write_ids, .required = true,
                   .doc = "The selected elements, or the first of them if there are too many."),
    API_FIELD("count", "count", api_presence, selection.count, .required = true,
              .doc = "How many elements are selected."),
};
const api_record api_presence_selection_record = API_RECORD("presence_selection", selection_fields);

static const api_field camera_fields[] = {
    API_FIELD("position", "point", api_presence, camera.position, .required = true),
    API_FIELD("target", "point", api_presence, camera.target, .required = true,
              .doc = "The point around which the camera turns."),
    API_FIELD("up", "point", api_presence, camera.up, .required = true,
              .doc = "The direction that is up in the picture."),
};
const api_record api_presence_camera_record = API_RECORD("presence_camera", camera_fields);

/* The tables of the selection and of the camera describe members of an api_presence, so both get
 * the whole struct. */
typedef struct whole {
    api_presence presence;
} whole;

static const api_field presence_fields[] = {
    API_FIELD("client", "text", api_presence, client, .required = true,
              .doc = "The id that the client chose for itself."),
    API_FIELD("name", "text", api_presence, name, .required = true,
              .doc = "The name of the client's token; if the server needs no tokens, the name that "
                     "the client gave."),
    API_FIELD_RECORD("selection", "#presence_selection", whole, presence,
                     &api_presence_selection_record,
                     .known = API_KNOWN(api_presence, has_selection)),
    API_FIELD_RECORD("camera", "#presence_camera", whole, presence, &api_presence_camera_record,
                     .known = API_KNOWN(api_presence, has_camera)),
};
const api_record api_presence_record = API_RECORD("presence", presence_fields);
