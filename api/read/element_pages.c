/* element_pages.c - GET .../vertices, halfedges, edges, faces: a page of the elements of one kind,
 * or all of them as lines of JSON; faces also as binary data. */
#include "api/request/handlers.h"

#include "api/read/elements.h"
#include "api/read/face_octets.h"
#include "api/read/records.h"
#include "api/request/mesh_access.h"

#include <string.h>

/* --- one page of elements --- */

static uint64_t page_limit(const api_exchange *x)
{
    return api_param_u64(x, "limit", API_DEFAULT_PAGE);
}

/* The values of the JSON members of a page. The rows are written in order, so `next` is written
 * after `items` have counted the id on to the next page. */
typedef struct page {
    api_exchange *x;
    uint64_t revision;
    uint32_t *id; /* the next element to write; HE_NONE: there are no more */
} page;

static void write_items(api_out *out, const void *value)
{
    const page *p = value;
    const api_exchange *x = p->x;
    const uint64_t limit = page_limit(x);
    uint32_t id = *p->id;
    api_out_array_begin(out);
    for (uint64_t i = 0; i < limit && id != HE_NONE && x->text.length < API_MAX_PAGE_BYTES; i++) {
        api_write_element(out, x->content, x->kind, id);
        id = he_mesh_next_live(x->content, x->kind, (uint64_t)id + 1);
    }
    api_out_array_end(out);
    *p->id = id;
}

static void write_next(api_out *out, const void *value)
{
    const page *p = value;
    api_exchange *x = p->x;
    if (*p->id == HE_NONE) {
        api_out_null(out);
        return;
    }
    const char *collection = he_kind_plural(x->kind);
    char cursor[API_CURSOR];
    api_cursor_write(collection, &x->info, *p->id, cursor);
    api_out_string(out, cursor);
    api_answer_header_format(x, "Link", "</v1/meshes/%s/%s?limit=%llu&cursor=%s>; rel=\"next\"",
                             x->mesh_id, collection, (unsigned long long)page_limit(x), cursor);
}

/* The rows of a page of elements of one kind; `items_` is the type of its items. */
#define PAGE_FIELDS(items_)                                             \
    API_FIELD("revision", "count", page, revision, .required = true),   \
        API_FIELD_MADE("items", items_, write_items, .required = true), \
        API_FIELD_MADE("next", "text?", write_next, .required = true,   \
                       .doc = "The cursor of the next page.")

static const api_field vertex_fields[] = {PAGE_FIELDS("*#vertex")};
static const api_field halfedge_fields[] = {PAGE_FIELDS("*#halfedge")};
static const api_field edge_fields[] = {PAGE_FIELDS("*#edge")};
static const api_field face_fields[] = {PAGE_FIELDS("*#face")};
#undef PAGE_FIELDS

const api_record api_page_records[] = {
    [HE_VERTEX] = API_RECORD("vertex_page", vertex_fields),
    [HE_HALFEDGE] = API_RECORD("halfedge_page", halfedge_fields),
    [HE_EDGE] = API_RECORD("edge_page", edge_fields),
    [HE_FACE] = API_RECORD("face_page", face_fields),
};

static void write_page(api_exchange *x, uint64_t from)
{
    uint32_t id = he_mesh_next_live(x->content, x->kind, from);
    const page value = {.x = x, .revision = x->info.revision, .id = &id};
    api_record_write(&x->out, &api_page_records[x->kind], &value);
    api_answer_json(x, 200);
}

/* Reads the id at which the page begins. */
static bool read_from(api_exchange *x, uint64_t *from)
{
    const char *cursor = api_param_text(x, "cursor");
    *from = 0;
    return cursor == NULL ||
           api_cursor_read(cursor, he_kind_plural(x->kind), &x->info, from, &x->problem);
}

static void answer_page(api_exchange *x)
{
    uint64_t from;
    if (read_from(x, &from)) {
        write_page(x, from);
    }
}

/* --- all elements of a kind, one line per element --- */

/* The number of bytes after which the text is sent. The last line in it may make it longer, by much
 * if it is that of a face with many corners. */
enum { LINES_BUFFER = 64 * 1024 };

typedef struct lines {
    const he_mesh *mesh;
    he_kind kind;
    uint64_t next;  /* next id to visit */
    uint64_t count; /* number of lines written */
    bool ended;
    api_text text;
    size_t sent; /* how many bytes of `text` were sent */
} lines;

static void free_lines(void *stream)
{
    lines *l = stream;
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
    if (!api_keep_mesh(x)) {
        return;
    }
    lines *l = he_mem_zero(1, sizeof *l);
    if (l == NULL) {
        api_fail_memory(x);
        return;
    }
    *l = (lines){.mesh = x->content, .kind = x->kind};
    const api_stream stream = {-1, read_lines, l, free_lines};
    api_answer_stream(x, 200, "application/x-ndjson", &stream);
}

/* --- handlers --- */

static bool wants_page(const api_exchange *x)
{
    return strcmp(x->media_out, "application/json") == 0;
}

static bool wants_lines(const api_exchange *x)
{
    return strcmp(x->media_out, "application/x-ndjson") == 0;
}

/* Estimates the cost of reading elements. Answers with all elements are made from a copy of the
 * mesh, and writing an element of a page takes about as long as copying twenty elements. */
bool api_elements_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    const char *of_pages = api_param_text(x, "limit") != NULL ? "limit" : "cursor";
    uint64_t count = he_mesh_count(mesh, x->kind), from;
    x->reading.tag = wants_page(x) ? "page" : wants_lines(x) ? "lines" : "octets";
    if (wants_page(x)) {
        out->elements = 20 * (page_limit(x) < count ? page_limit(x) : count);
        return read_from(x, &from);
    }
    out->elements =
        (uint64_t)he_mesh_vertices(mesh) + he_mesh_count(mesh, HE_HALFEDGE) + he_mesh_faces(mesh);
    return api_param_text(x, of_pages) == NULL ||
           api_fail(x, API_BAD_PARAMETER,
                    "\"%s\" cannot be combined with %s, which has all elements", of_pages,
                    x->media_out);
}

void api_elements_list(api_exchange *x)
{
    if (wants_page(x)) {
        answer_page(x);
    } else if (wants_lines(x)) {
        answer_lines(x);
    } else {
        api_face_octets(x);
    }
}
