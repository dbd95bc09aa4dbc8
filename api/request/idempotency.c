#include "api/request/idempotency.h"

#include "api/request/gate.h"

#include <string.h>

/* Adds a text to the hash with its terminating 0, so that two texts never hash like their
 * concatenation. */
static void add_text(he_siphash *hash, const char *text)
{
    he_siphash_add(hash, text == NULL ? "" : text, (text == NULL ? 0 : strlen(text)) + 1);
}

bool api_idempotency_begin(api_exchange *x)
{
    const char *key = x->request.headers[API_HEADER_IDEMPOTENCY_KEY];
    if (key == NULL || !(x->route->flags & (API_IDEMPOTENCY_KEY | API_IDEMPOTENCY_KEY_NEW))) {
        return true;
    }
    size_t length = strlen(key);
    for (size_t i = 0; i < length; i++) {
        if (key[i] < '!' || key[i] > '~') {
            return api_fail(x, API_BAD_HEADER, "byte %zu of Idempotency-Key is not visible ASCII",
                            i);
        }
    }
    if (length == 0 || length > API_MAX_KEY_LENGTH) {
        return api_fail(x, API_BAD_HEADER,
                        "Idempotency-Key has %zu characters; 1 to %d are allowed", length,
                        API_MAX_KEY_LENGTH);
    }
    /* The key is copied, because a job may outlive the buffer of the connection. */
    x->key = api_arena_copy(&x->arena, key, length);
    if (x->key == NULL) {
        return api_fail_memory(x);
    }
    he_siphash_begin(&x->hash, st_secret(x->store));
    add_text(&x->hash, x->request.method);
    add_text(&x->hash, x->request.path);
    add_text(&x->hash, x->request.query);
    add_text(&x->hash, x->media_in);
    return true;
}

void api_idempotency_add(api_exchange *x, const char *bytes, size_t length)
{
    if (x->key != NULL) {
        he_siphash_add(&x->hash, bytes, length);
    }
}

void api_idempotency_body(api_exchange *x, const char *bytes, size_t length)
{
    if (strcmp(x->media_in, API_MULTIPART) != 0) {
        api_idempotency_add(x, bytes, length);
    }
}

/* Returns the word that stands for the representation (etag.h) in the ETag of the route's
 * answers. */
static const char *representation_of(const api_route *route)
{
    if (route->flags & API_IDEMPOTENCY_KEY_NEW || strcmp(route->path, "/v1/meshes/{mesh}") == 0) {
        return "summary";
    }
    return strstr(route->path, "/attributes/") != NULL ? "attribute" : "edits";
}

/* Sends the answer kept under the key. If that answer is about a mesh, the token must still be
 * allowed to make a mesh with this id, because the token's prefixes may have changed since. */
static void replay(api_exchange *x)
{
    const st_kept *kept = st_keyed_answer(x->keyed);
    if (kept->id[0] != '\0' && !api_gate_may_create(x, kept->id)) {
        return;
    }
    x->info.position = kept->position;
    x->info.incarnation = kept->incarnation;
    x->has_info = true;
    api_answer_header(x, "Idempotency-Replayed", "true");
    if (kept->etag[0] != '\0') {
        api_answer_header(x, "ETag", kept->etag);
    } else if (kept->revision != 0) {
        x->info.revision = kept->revision;
        x->info.metadata = kept->metadata;
        api_answer_etag(x, representation_of(x->route));
    }
    if (kept->status == 201) {
        api_answer_header_format(x, "Location", "/v1/meshes/%s", kept->id);
    }
    if (kept->body != NULL) {
        api_answer_bytes(x, kept->status, kept->media, kept->body, kept->length);
    } else {
        api_answer_empty(x, kept->status == 200 ? 204 : kept->status);
    }
}

bool api_idempotency_find(api_exchange *x)
{
    if (x->key == NULL) {
        return true;
    }
    st_key key = {.text = x->key, .holder = x->token == NULL ? "" : x->token->name};
    he_siphash_end(&x->hash, key.digest);
    st_mesh *mesh = x->route->flags & API_IDEMPOTENCY_KEY_NEW ? NULL : x->mesh;
    switch (st_keyed_begin(x->store, mesh, &key, &x->keyed)) {
    case ST_KEYED_NEW:
        return true;
    case ST_KEYED_KEPT:
        replay(x);
        return false;
    case ST_KEYED_BUSY:
        return api_fail(x, API_IDEMPOTENCY_BUSY,
                        "a request with the key \"%.100s\" is still in progress", x->key);
    case ST_KEYED_OTHER:
        return api_fail(x, API_IDEMPOTENCY_MISMATCH,
                        "the key \"%.100s\" was used for another request", x->key);
    case ST_KEYED_DAMAGED:
        return api_fail(x, API_IDEMPOTENCY_MISMATCH,
                        "the record of the request with the key \"%.100s\" is damaged on the disk: "
                        "check whether the request was done, and use another key to send it again",
                        x->key);
    case ST_KEYED_NO_MEMORY:
        break;
    }
    return api_fail_memory(x);
}

static const char *header_of_answer(const api_exchange *x, const char *name)
{
    for (size_t i = 0; i < x->answer.header_count; i++) {
        if (strcmp(x->answer.headers[i].name, name) == 0) {
            return x->answer.headers[i].value;
        }
    }
    return "";
}

/* Returns the media type of the answer if its body is stored; NULL if it has another type. */
static const char *media_to_keep(const api_exchange *x)
{
    static const char *const types[] = {"application/json", API_PACKED_EDITS};
    const char *type = header_of_answer(x, "Content-Type");
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (strcmp(type, types[i]) == 0) {
            return types[i];
        }
    }
    return NULL;
}

/* Stores the key of a request that changed nothing. The key of a request that changed a mesh is a
 * part of the record of the change in the journal; the key of this request gets a record of its
 * own, and the answer waits until that record is durable. */
static void note_unchanged(api_exchange *x, st_kept *kept)
{
    st_keyed_note(x->store, x->keyed, &x->info, &x->noted);
    if (x->noted != 0) {
        kept->position = x->noted;
    }
}

void api_idempotency_settle(api_exchange *x)
{
    const api_answer *answer = &x->answer;
    if (x->keyed == NULL || st_keyed_answer(x->keyed)->status != 0) {
        /* Nothing is to be done: the request has no key, or its answer is the one that was stored
         * under the key, which is borrowed until the exchange ends. */
        return;
    }
    if (answer->status < 300) {
        const char *media = media_to_keep(x);
        st_kept kept = {.status = answer->status,
                        .changed = x->published != 0,
                        .incarnation = x->info.incarnation,
                        .position = x->info.position,
                        .body = media != NULL ? answer->bytes : NULL,
                        .length = media != NULL ? (size_t)answer->length : 0,
                        .media = media};
        const char *etag = header_of_answer(x, "ETag");
        if (strlen(etag) < sizeof kept.etag) {
            memcpy(kept.etag, etag, strlen(etag) + 1);
        }
        memcpy(kept.id, x->info.id, sizeof kept.id);
        if (!kept.changed && x->has_info) {
            note_unchanged(x, &kept);
        }
        st_keyed_keep(x->keyed, &kept);
    }
    st_keyed_end(x->keyed);
    x->keyed = NULL;
}
