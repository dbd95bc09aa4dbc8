/* mesh_list.c - the list of meshes, in the order of ids or of another member, and those of them
 * whose names contain a text. It is made from the cards (short descriptions) of the meshes, so no
 * mesh is loaded. */
#include "api/document/summary.h"
#include "api/header/sorted_cursor.h"
#include "api/limits.h"
#include "api/read/first_cards.h"
#include "api/read/records.h"
#include "api/request/handlers.h"
#include "store/followers.h"

#include <stdio.h>
#include <string.h>

/* The number of cards (descriptions of meshes) that are read at once; there are few, because large
 * allocations fail first when memory is short. */
enum { CARDS = 32 };

/* The state of writing one page of the list of meshes. */
typedef struct list_page {
    /* The letters A to Z of this text are lower case; NULL: all meshes are listed. */
    const char *contains;
    bool is_sorted; /* false: in the order of ids */
    st_card_order order;
    st_card *cards; /* an array of CARDS */
    /* limit: how many items the page may have; given: how many items were written so far; looked:
     * how many cards were looked at. */
    size_t limit, given, looked;
    /* The search continues after this text: the id of the last mesh looked at or, at the beginning
     * of a range of ids, a text that sorts just before the range (go_to). Only for a list in the
     * order of ids. */
    char from[ST_MESH_ID + 1];
    /* The last card that was looked at, or that the cursor names; `begun` is false if there is
     * none. */
    st_card last;
    bool begun;
    bool more;   /* there is a next page */
    bool failed; /* the problem of the request is filled */
} list_page;

/* Reads the cursor of a list in the order of ids: the id of the last mesh, after a letter that
 * keeps clients from using an id as a cursor. */
static bool read_id_cursor(api_exchange *x, const char *cursor, list_page *p)
{
    if (cursor[0] != 'm' || !api_path_is_mesh_id(cursor + 1)) {
        return api_fail(x, API_BAD_CURSOR,
                        "the cursor \"%.100s\" does not belong to the list of meshes without "
                        "`sort`",
                        cursor);
    }
    st_copy_text(p->from, cursor + 1, ST_MESH_ID);
    return true;
}

static bool read_cursor(api_exchange *x, list_page *p)
{
    const char *cursor = api_param_text(x, "cursor");
    if (cursor == NULL) {
        return true;
    }
    if (!p->is_sorted) {
        return read_id_cursor(x, cursor, p);
    }
    p->begun = true;
    return api_sorted_cursor_read(cursor, p->order, &p->last, &x->problem);
}

/* --- which meshes are listed --- */

/* Copies a text with the letters A to Z in lower case; `out` has room for it. */
static void lower(const char *text, char *out)
{
    for (; *text != '\0'; text++) {
        *out++ = (char)(*text >= 'A' && *text <= 'Z' ? *text - 'A' + 'a' : *text);
    }
    *out = '\0';
}

static bool matches(const list_page *p, const st_card *card)
{
    char name[ST_MESH_NAME + 1];
    if (p->contains == NULL) {
        return true;
    }
    lower(card->name, name);
    return strstr(name, p->contains) != NULL;
}

/* Reads the next cards of the list into the array of the page. */
static st_status read_cards(api_exchange *x, const list_page *p, size_t limit, size_t *count)
{
    if (p->is_sorted) {
        const st_card_page page = {p->order, p->begun ? &p->last : NULL, limit};
        return st_cards_by(x->store, &page, p->cards, count);
    }
    return st_cards(x->store, p->from, p->cards, limit, count);
}

/* Adds a card to the page, if it has the text that is searched for. Returns false if the page ended
 * before this card. */
static bool take_card(api_exchange *x, list_page *p, const st_card *card)
{
    if (p->given == p->limit || (p->contains != NULL && p->looked == API_MAX_SEARCHED)) {
        p->more = true;
        return false;
    }
    p->looked++;
    p->last = *card;
    p->begun = true;
    memcpy(p->from, card->id, sizeof card->id);
    if (matches(p, card)) {
        api_record_write(&x->out, &api_mesh_item_record, card);
        p->given++;
    }
    return true;
}

/* Writes the meshes whose ids begin with `prefix` and come after those that the page has. */
static bool write_range(api_exchange *x, list_page *p, const char *prefix)
{
    size_t count = 0, asked;
    do {
        /* One card (description of a mesh) more than needed is read, which shows whether there is a
         * next page. */
        size_t left = p->limit - p->given + 1;
        asked = left < CARDS && p->contains == NULL ? left : CARDS;
        st_status status = read_cards(x, p, asked, &count);
        if (status != ST_OK) {
            return api_fail_store(x, status);
        }
        for (size_t i = 0; i < count; i++) {
            if (strncmp(p->cards[i].id, prefix, strlen(prefix)) != 0 ||
                !take_card(x, p, &p->cards[i])) {
                return true;
            }
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

/* Writes a page in the order of ids. It looks only at ids that the token can see, so the time does
 * not depend on the number of other meshes. */
static bool write_ranges(api_exchange *x, list_page *p, const char *const *ranges, size_t count)
{
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

/* Looks at all meshes whose ids begin with `prefix`. */
static bool choose_from_range(api_exchange *x, list_page *p, const char *prefix,
                              api_first_cards *out)
{
    size_t count = 0;
    go_to(p, prefix);
    do {
        st_status status = st_cards(x->store, p->from, p->cards, CARDS, &count);
        if (status != ST_OK) {
            return api_fail_store(x, status);
        }
        for (size_t i = 0; i < count; i++) {
            const st_card *card = &p->cards[i];
            if (strncmp(card->id, prefix, strlen(prefix)) != 0) {
                return true;
            }
            if (matches(p, card) && !api_first_cards_add(out, card)) {
                return api_fail_memory(x);
            }
            memcpy(p->from, card->id, sizeof card->id);
        }
    } while (count == CARDS);
    return true;
}

/* Writes a page of a sorted list for a token with prefixes. It looks at all meshes that the token
 * can see, and only at these: an index of the store also has the others, and the time, the cursors
 * and the lengths of the pages would tell the client about them. */
static bool write_chosen(api_exchange *x, list_page *p, const char *const *ranges, size_t count)
{
    const st_card begin = p->last;
    /* one card more shows whether there is a next page */
    api_first_cards first = {.page = {p->order, p->begun ? &begin : NULL, p->limit + 1}};
    bool good = true;
    for (size_t i = 0; i < count && good; i++) {
        good = choose_from_range(x, p, ranges[i], &first);
    }
    api_first_cards_sort(&first);
    p->more = first.count > p->limit;
    for (; good && p->given < first.count && p->given < p->limit; p->given++) {
        p->last = first.cards[p->given];
        api_record_write(&x->out, &api_mesh_item_record, &p->last);
    }
    api_first_cards_clear(&first);
    return good;
}

static bool write_page(api_exchange *x, list_page *p)
{
    const char *ranges[API_TOKEN_PREFIXES];
    const size_t count = x->token == NULL ? 0 : api_token_ranges(x->token, ranges);
    p->cards = api_arena_array(&x->arena, CARDS, sizeof *p->cards);
    if (p->cards == NULL) {
        return api_fail_memory(x);
    }
    return p->is_sorted && count > 0 ? write_chosen(x, p, ranges, count)
                                     : write_ranges(x, p, ranges, count);
}

/* --- the answer --- */

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
    shown->page->failed = !write_page(shown->x, shown->page);
    api_out_array_end(out);
}

/* The most bytes of the link to the next page; in the text that is searched for, each byte may take
 * three characters. */
enum { LINK = 128 + API_SORTED_CURSOR + 3 * ST_MESH_NAME };

/* Writes the value of a parameter as it stands in a URL. Returns the end of the text. */
static char *write_encoded(const char *value, char *out)
{
    static const char digits[] = "0123456789ABCDEF", plain[] = "-._~";
    for (; *value != '\0'; value++) {
        const unsigned char c = (unsigned char)*value;
        const bool letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        if (letter || (c >= '0' && c <= '9') || strchr(plain, c) != NULL) {
            *out++ = (char)c;
        } else {
            *out++ = '%';
            *out++ = digits[c >> 4];
            *out++ = digits[c & 15];
        }
    }
    *out = '\0';
    return out;
}

/* Sets the header Link, whose URL has all parameters of the request. */
static void link_next(api_exchange *x, const list_page *p, const char *cursor)
{
    char text[LINK];
    char *const end = text + sizeof text;
    const char *contains = api_param_text(x, "contains");
    char *at =
        text + snprintf(text, sizeof text, "</v1/meshes?limit=%zu&cursor=%s", p->limit, cursor);
    if (p->is_sorted) {
        at += snprintf(at, (size_t)(end - at), "&sort=%s", api_order_names[p->order]);
    }
    if (contains != NULL) {
        at += snprintf(at, (size_t)(end - at), "&contains=");
        at = write_encoded(contains, at);
    }
    (void)snprintf(at, (size_t)(end - at), ">; rel=\"next\"");
    api_answer_header(x, "Link", text);
}

static void write_next(api_out *out, const void *value)
{
    const shown_page *shown = value;
    const list_page *p = shown->page;
    char cursor[API_SORTED_CURSOR];
    if (!p->more) {
        api_out_null(out);
        return;
    }
    if (p->is_sorted) {
        api_sorted_cursor_write(p->order, &p->last, cursor);
    } else {
        (void)snprintf(cursor, sizeof cursor, "m%s", p->last.id);
    }
    api_out_string(out, cursor);
    link_next(shown->x, p, cursor);
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

/* Reads the parameters of the request. */
static bool read_parameters(api_exchange *x, list_page *p)
{
    const char *contains = api_param_text(x, "contains");
    const int order = api_param_choice(x, "sort");
    p->is_sorted = order >= 0;
    p->order = p->is_sorted ? (st_card_order)order : ST_BY_NAME;
    if (contains != NULL) {
        char *text = api_arena_alloc(&x->arena, strlen(contains) + 1);
        if (text == NULL) {
            return api_fail_memory(x);
        }
        lower(contains, text);
        p->contains = text;
    }
    return read_cursor(x, p);
}

static void list(api_exchange *x)
{
    list_page p = {.limit = (size_t)api_param_u64(x, "limit", API_DEFAULT_PAGE)};
    shown_page shown = {.x = x, .page = &p};
    if (!read_parameters(x, &p)) {
        return;
    }
    find_totals(&shown);
    api_record_write(&x->out, &api_mesh_page_record, &shown);
    if (!p.failed) {
        api_answer_json(x, 200);
    }
}

/* A list that waits for the disk, or that may look at many meshes, is not made on a worker. */
void api_meshes_list(api_exchange *x)
{
    const bool many = api_param_text(x, "contains") != NULL ||
                      (api_param_choice(x, "sort") >= 0 && x->token != NULL);
    if (st_store_waits_for_disk(x->store) || many) {
        api_defer(x, list);
    } else {
        list(x);
    }
}
