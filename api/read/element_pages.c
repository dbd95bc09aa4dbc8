/* GET .../vertices, halfedges, edges, faces: a page of a collection, or all of it in lines. */
#include "api/request/handlers.h"

#include "api/read/elements.h"

#include <string.h>

/* --- a page --- */

static uint64_t page_limit(const api_exchange *x)
{
    return api_param_u64(x, "limit", API_DEFAULT_PAGE);
}

static void write_next(api_exchange *x, uint32_t id)
{
    api_out_key(&x->out, "next");
    if (id == HE_NONE) {
        api_out_null(&x->out);
        return;
    }
    const char *collection = he_kind_plural(x->kind);
    char cursor[API_CURSOR];
    api_cursor_write(collection, &x->info, id, cursor);
    api_out_string(&x->out, cursor);
    api_answer_header_format(x, "Link", "</v1/meshes/%s/%s?limit=%llu&cursor=%s>; rel=\"next\"",
                             x->mesh_id, collection, (unsigned long long)page_limit(x), cursor);
}

static void write_page(api_exchange *x, const he_mesh *mesh, uint64_t from)
{
    uint64_t limit = page_limit(x);
    api_out_object_begin(&x->out);
    api_out_key_u64(&x->out, "revision", x->info.revision);
    api_out_key(&x->out, "items");
    api_out_array_begin(&x->out);
    uint32_t id = he_mesh_next_live(mesh, x->kind, from);
    for (uint64_t i = 0; i < limit && id != HE_NONE && x->text.length < API_MAX_PAGE_BYTES; i++) {
        api_write_element(&x->out, mesh, x->kind, id);
        id = he_mesh_next_live(mesh, x->kind, (uint64_t)id + 1);
    }
    api_out_array_end(&x->out);
    write_next(x, id);
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

static void answer_page(api_exchange *x)
{
    const char *cursor = api_param_text(x, "cursor");
    uint64_t from = 0;
    const he_mesh *mesh = api_read_begin(x);
    if (mesh == NULL) {
        return;
    }
    bool good = cursor == NULL ||
                api_cursor_read(cursor, he_kind_plural(x->kind), &x->info, &from, &x->problem);
    if (good && !api_not_modified(x, "page")) {
        write_page(x, mesh, from);
    }
    api_read_end(x);
}

/* --- all of it, a line each --- */

/* What is made at a time; a face of many corners may need more for its line. */
enum { LINES_BUFFER = 64 * 1024 };

typedef struct lines {
    st_store *store;
    st_snapshot *snapshot;
    const he_mesh *mesh;
    he_kind kind;
    uint64_t next;  /* id to look at */
    uint64_t count; /* lines written */
    bool ended;
    api_text text;
    size_t sent; /* of the text */
} lines;

static void free_lines(void *stream)
{
    lines *l = stream;
    st_snapshot_release(l->snapshot);
    api_text_clear(&l->text);
    he_mem_free(l);
}

static void write_end(lines *l, api_out *out)
{
    api_out_object_begin(out);
    api_out_key_bool(out, "end", true);
    api_out_key_u64(out, "count", l->count);
    api_out_object_end(out);
    l->ended = true;
}

static void fill(lines *l)
{
    l->sent = 0;
    api_text_empty(&l->text);
    while (!l->ended && !l->text.failed && l->text.length < LINES_BUFFER) {
        api_out out;
        api_out_init(&out, &l->text);
        uint32_t id = he_mesh_next_live(l->mesh, l->kind, l->next);
        if (id == HE_NONE) {
            write_end(l, &out);
        } else {
            api_write_element(&out, l->mesh, l->kind, id);
            l->next = (uint64_t)id + 1;
            l->count++;
        }
        api_text_add_char(&l->text, '\n');
    }
}

static int64_t read_lines(void *stream, char *buffer, size_t size)
{
    lines *l = stream;
    if (l->sent == l->text.length && !l->ended) {
        fill(l);
    }
    if (l->text.failed) {
        return -1;
    }
    size_t left = l->text.length - l->sent;
    size_t length = left < size ? left : size;
    if (length > 0) {
        memcpy(buffer, l->text.bytes + l->sent, length);
        l->sent += length;
    }
    return (int64_t)length;
}

static void answer_lines(api_exchange *x)
{
    const he_mesh *mesh;
    if (api_not_modified_yet(x, "lines")) {
        return;
    }
    st_snapshot *snapshot = api_snapshot_of(x, &mesh);
    if (snapshot == NULL) {
        return;
    }
    lines *l = NULL;
    if (api_not_modified(x, "lines") || (l = he_mem_zero(1, sizeof *l)) == NULL) {
        st_snapshot_release(snapshot);
        if (!x->answered) {
            api_fail_memory(x);
        }
        return;
    }
    *l = (lines){.store = x->store, .snapshot = snapshot, .mesh = mesh, .kind = x->kind};
    api_answer_stream(x, 200, "application/x-ndjson", -1, read_lines, l, free_lines);
}

void api_elements_list(api_exchange *x)
{
    bool whole = strcmp(x->media_out, "application/x-ndjson") == 0;
    const char *of_pages = api_param_text(x, "limit") != NULL ? "limit" : "cursor";
    if (whole && api_param_text(x, of_pages) != NULL) {
        api_fail(x, API_BAD_PARAMETER, "\"%s\" belongs to pages: lines are all there is", of_pages);
        return;
    }
    const he_mesh *mesh = api_read_begin(x);
    if (mesh == NULL) {
        return;
    }
    uint64_t count = he_mesh_count(mesh, x->kind);
    uint64_t all =
        (uint64_t)he_mesh_vertices(mesh) + he_mesh_count(mesh, HE_HALFEDGE) + he_mesh_faces(mesh);
    api_read_end(x);
    /* Writing an element costs about as much as copying twenty. */
    uint64_t cost = whole ? all : 20 * (page_limit(x) < count ? page_limit(x) : count);
    void (*answer)(api_exchange *) = whole ? answer_lines : answer_page;
    if (api_is_costly(x, cost, API_COSTLY_ELEMENTS)) {
        api_defer(x, answer);
    } else {
        answer(x);
    }
}
