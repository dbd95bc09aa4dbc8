/* meshes.c - the list of meshes, and requests to one mesh that do not change its content: rename,
 * delete, copy. */
#include "api/request/handlers.h"

#include "api/document/summary.h"
#include "api/read/records.h"
#include "api/request/gate.h"
#include "api/request/new_mesh.h"
#include "store/followers.h"

#include <stdio.h>
#include <string.h>

/* Reads the cursor of a page: the id of the last mesh, after a letter that keeps clients from using
 * an id as a cursor. */
static bool read_list_cursor(api_exchange *x, const char **after)
{
    const char *cursor = api_param_text(x, "cursor");
    *after = "";
    if (cursor == NULL) {
        return true;
    }
    if (cursor[0] != 'm' || !api_path_is_mesh_id(cursor + 1)) {
        return api_fail(x, API_BAD_CURSOR,
                        "the cursor \"%s\" does not belong to the list of meshes", cursor);
    }
    *after = cursor + 1;
    return true;
}

/* The number of cards (descriptions of meshes) that are read at once; there are few, because large
 * allocations fail first when memory is short. */
enum { CARDS = 32 };

/* The state of writing one page of the list of meshes. */
typedef struct list_page {
    st_card *cards; /* an array of CARDS */
    /* limit: how many items the page may have; given: how many items were written so far. */
    size_t limit, given;
    /* The search continues after this text: the id of the last mesh found or, at the beginning of a
     * range of ids, a text that sorts just before the range (go_to). */
    char from[ST_MESH_ID + 1];
    char last[ST_MESH_ID + 1]; /* id of the last item */
    bool more;                 /* there is a next page */
    bool failed;               /* the problem of the request is filled */
} list_page;

/* Writes the meshes whose ids begin with `prefix` and come after `from` of the page. */
static bool write_range(api_exchange *x, list_page *p, const char *prefix)
{
    size_t count = 0, asked;
    do {
        /* One card (description of a mesh) more than needed is read, which shows whether there is a
         * next page. */
        size_t left = p->limit - p->given + 1;
        asked = left < CARDS ? left : CARDS;
        st_status status = st_cards(x->store, p->from, p->cards, asked, &count);
        if (status != ST_OK) {
            return api_fail_store(x, status);
        }
        for (size_t i = 0; i < count; i++, p->given++) {
            const st_card *card = &p->cards[i];
            if (strncmp(card->id, prefix, strlen(prefix)) != 0) {
                return true;
            }
            if (p->given == p->limit) {
                p->more = true;
                return true;
            }
            api_record_write(&x->out, &api_mesh_item_record, card);
            memcpy(p->from, card->id, sizeof card->id);
            memcpy(p->last, card->id, sizeof card->id);
        }
    } while (count == asked);
    return true;
}

/* Sets `from` of the page to a text that sorts just before the first id that begins with `prefix`,
 * unless `from` sorts after that text already. That text is the prefix with its last character
 * lowered by one, followed by \x7f, which sorts after all characters of ids. */
static void go_to(list_page *p, const char *prefix)
{
    char before[API_TOKEN_PREFIX + 2];
    size_t length = strlen(prefix);
    memcpy(before, prefix, length + 1);
    before[length - 1]--;
    before[length] = '\x7f';
    before[length + 1] = '\0';
    if (strcmp(p->from, before) < 0) {
        memcpy(p->from, before, length + 2);
    }
}

/* Writes the page. It looks only at ids that the token can see, so the time does not depend on the
 * number of other meshes. */
static bool write_ranges(api_exchange *x, list_page *p)
{
    const char *ranges[API_TOKEN_PREFIXES];
    size_t count = x->token == NULL ? 0 : api_token_ranges(x->token, ranges);
    p->cards = api_arena_array(&x->arena, CARDS, sizeof *p->cards);
    if (p->cards == NULL) {
        return api_fail_memory(x);
    }
    if (count == 0) {
        return write_range(x, p, "");
    }
    for (size_t i = 0; i < count && !p->more; i++) {
        go_to(p, ranges[i]);
        if (!write_range(x, p, ranges[i])) {
            return false;
        }
    }
    return true;
}

/* The values of the JSON members of an answer. The rows are written in order, so `next` is written
 * after `items` have filled in what the page ends with. */
typedef struct shown_page {
    api_exchange *x;
    list_page *page;
    /* Totals of the whole server, which help a client decide what to delete. */
    bool shows_listeners, shows_memory;
    uint64_t listeners, used, budget;
} shown_page;

static void write_items(api_out *out, const void *value)
{
    const shown_page *shown = value;
    api_out_array_begin(out);
    shown->page->failed = !write_ranges(shown->x, shown->page);
    api_out_array_end(out);
}

static void write_next(api_out *out, const void *value)
{
    const shown_page *shown = value;
    const list_page *p = shown->page;
    if (!p->more) {
        api_out_null(out);
        return;
    }
    char cursor[ST_MESH_ID + 2] = "m";
    memcpy(cursor + 1, p->last, sizeof p->last);
    api_out_string(out, cursor);
    api_answer_header_format(shown->x, "Link", "</v1/meshes?limit=%zu&cursor=%s>; rel=\"next\"",
                             p->limit, cursor);
}

static const api_field page_fields[] = {
    API_FIELD_MADE("items", "*#mesh_item", write_items, .required = true),
    API_FIELD_MADE("next", "text?", write_next, .required = true,
                   .doc = "The cursor of the next page."),
    API_FIELD("listeners", "count", shown_page, listeners,
              .known = API_KNOWN(shown_page, shows_listeners),
              .doc = "How many clients of the whole server listen to events of meshes. The members "
                     "`listeners`, `memory_bytes` and `memory_budget` are missing for tokens with "
                     "prefixes."),
    API_FIELD("memory_bytes", "count", shown_page, used,
              .known = API_KNOWN(shown_page, shows_memory),
              .doc = "Memory that the whole server uses."),
    API_FIELD("memory_budget", "count", shown_page, budget,
              .known = API_KNOWN(shown_page, shows_memory),
              .doc = "Memory that the server may use; 0: no limit."),
};
const api_record api_mesh_page_record = API_RECORD("mesh_page", page_fields);

/* Finds the totals of the whole server. They are not shown to a token with prefixes, because they
 * include meshes that it cannot see. */
static void find_totals(shown_page *shown)
{
    const api_exchange *x = shown->x;
    const api_options *options = &x->service->options;
    if (x->token != NULL && x->token->prefix_count > 0) {
        return;
    }
    shown->shows_listeners = true;
    shown->listeners = st_listeners(x->store);
    if (options->memory != NULL) {
        shown->shows_memory = true;
        options->memory(&shown->used, &shown->budget);
    }
}

static void list(api_exchange *x)
{
    const char *after;
    list_page p = {.limit = (size_t)api_param_u64(x, "limit", API_DEFAULT_PAGE)};
    shown_page shown = {.x = x, .page = &p};
    if (!read_list_cursor(x, &after)) {
        return;
    }
    snprintf(p.from, sizeof p.from, "%s", after);
    find_totals(&shown);
    api_record_write(&x->out, &api_mesh_page_record, &shown);
    if (!p.failed) {
        api_answer_json(x, 200);
    }
}

void api_meshes_list(api_exchange *x)
{
    if (st_store_waits_for_disk(x->store)) {
        api_defer(x, list);
    } else {
        list(x);
    }
}

static const char *const patch_members[] = {"name", NULL};

/* Changes the name of a mesh. By RFC 7396, null removes a member, which makes the name empty. */
void api_mesh_patch(api_exchange *x)
{
    const char *name = NULL;
    api_in member;
    if (!api_in_only(&x->root, patch_members)) {
        return;
    }
    if (api_in_find(&x->root, "name", &member)) {
        name = "";
        if (!api_in_is_null(&member) && !api_in_string(&member, ST_MESH_NAME, &name)) {
            return;
        }
    }
    if (!api_write_begin(x, NULL)) {
        return;
    }
    if (name != NULL && strcmp(name, x->info.name) != 0) {
        st_write_rename(&x->write, name);
        if (!api_write_commit(x, NULL)) {
            return;
        }
    } else {
        st_write_abort(&x->write);
        api_publish(x, 204);
    }
    api_answer_etag(x, "summary");
    if (!api_answer_minimal(x)) {
        api_answer_summary(x);
    }
}

void api_mesh_delete(api_exchange *x)
{
    /* Beginning a write checks the preconditions of the request, as for any write. */
    if (!api_write_begin(x, NULL)) {
        return;
    }
    st_write_remove(&x->write);
    if (api_write_commit(x, NULL)) {
        api_answer_empty(x, 204);
    }
}

void api_mesh_delete_cold(api_exchange *x, st_cold *cold)
{
    if (!api_preconditions_hold(x, NULL) || !api_gate_may_change(x)) {
        return;
    }
    const st_status status = st_cold_remove(cold);
    if (status != ST_OK) {
        (void)api_fail_store(x, status);
        return;
    }
    x->info = cold->info;
    api_publish(x, 204);
    api_answer_empty(x, 204);
}

static const char *const copy_members[] = {"id", "name", NULL};

/* The id and the name that the client wants for the copy. A NULL id is chosen by the server; with a
 * NULL name the copy gets the name of the original. */
typedef struct copy_request {
    const char *id, *name;
} copy_request;

static bool read_copy(api_exchange *x, copy_request *r)
{
    api_in member;
    if (!x->has_root) {
        return true;
    }
    if (!api_in_only(&x->root, copy_members)) {
        return false;
    }
    if (api_in_find(&x->root, "id", &member)) {
        if (!api_in_string(&member, ST_MESH_ID, &r->id)) {
            return false;
        }
        if (!api_path_is_mesh_id(r->id)) {
            return api_in_fail(&member, API_BAD_ID, "\"%s\" cannot be the id of a mesh", r->id);
        }
        if (!api_gate_may_create(x, r->id)) {
            api_in_point(&member);
            return false;
        }
    }
    return !api_in_find(&x->root, "name", &member) ||
           api_in_string(&member, ST_MESH_NAME, &r->name);
}

/* The progress (0 to 1) that is reached after copying the mesh; then the summary is computed. */
static const double COPY_SHARE = 0.4;

bool api_mesh_copy_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    copy_request *r = api_arena_array(&x->arena, 1, sizeof *r);
    if (r == NULL) {
        return api_fail_memory(x);
    }
    *r = (copy_request){NULL, NULL};
    x->state = r;
    uint64_t elements = api_elements_of(mesh);
    out->elements = st_store_waits_for_disk(x->store) ? UINT64_MAX : elements;
    out->seconds = (double)elements / API_COPY_PER_SECOND;
    return read_copy(x, r) && api_preconditions_hold(x, NULL);
}

/* Copies the content of a mesh and computes the summary of the copy, which is not stored yet, so
 * that no other request can change it. */
static bool make_copy(api_exchange *x, he_mesh **out, api_summary *summary)
{
    he_mesh *fresh = NULL;
    he_error err = {0};
    he_progress_span(&x->progress, COPY_SHARE);
    if (he_mesh_copy_with_progress(x->content, &x->progress, &fresh, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    he_progress_span(&x->progress, 1);
    if (!api_summary_find(x, fresh, summary)) {
        he_mesh_free(fresh);
        return false;
    }
    he_mesh_set_progress(fresh, NULL);
    *out = fresh;
    return true;
}

void api_mesh_copy(api_exchange *x)
{
    const copy_request *r = x->state;
    he_mesh *fresh = NULL;
    st_mesh *made = NULL;
    api_summary summary;
    if (!api_preconditions_hold(x, NULL) || !make_copy(x, &fresh, &summary)) {
        return;
    }
    char name[ST_MESH_NAME + 1];
    snprintf(name, sizeof name, "%s", r->name != NULL ? r->name : x->info.name);
    const st_shown from = st_shown_of(&x->info);
    st_status stored = api_mesh_new(x, r->id, name, fresh, &from, &made);
    if (stored != ST_OK) {
        he_mesh_free(fresh);
        api_fail_store(x, stored);
        return;
    }
    st_release(x->mesh);
    x->mesh = made;
    api_answer_created(x, name, &summary, NULL);
}
