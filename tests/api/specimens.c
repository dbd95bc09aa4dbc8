#include "tests/api/specimens.h"

const specimen_kind specimen_kinds[KINDS] = {
    {"vertex", "vertices", {"vertices", "outgoing", "incoming", "edges", "faces"}},
    {"halfedge", "halfedges", {"loop", "ring"}},
    {"edge", "edges", {"vertices", "halfedges", "faces"}},
    {"face", "faces", {"vertices", "halfedges", "edges", "faces"}},
};

const char *const specimens[SPECIMENS] = {
    "",
    "012",
    "021,032,013,123",
    "0123,7654,1045,2156,3267,0374",
    "301,320,431,523,653,634",
    "012,034,056",
    "021,032,013,123,456",
    "0123,3245",
    "01234567",
    "0123,2104",
    "012,346,895",
    "0135,579",
    "012,234,450",
    "0143,1254,2035,3476,4587,5368,6710,7821,8602",
};

void page_say(page *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(p->text + p->used, sizeof p->text - p->used, format, arguments);
    va_end(arguments);
    p->used += (size_t)length;
    assert_true(p->used < sizeof p->text);
}

void page_say_id(page *p, unsigned id)
{
    if (id == PG_NONE) {
        page_say(p, "null");
    } else {
        page_say(p, "%u", id);
    }
}

void page_say_ids(page *p, const unsigned *ids, unsigned count)
{
    page_say(p, "[");
    for (unsigned i = 0; i < count; i++) {
        page_say(p, i == 0 ? "" : ",");
        page_say_id(p, ids[i]);
    }
    page_say(p, "]");
}

void page_say_list(page *p, const pg_list *list)
{
    page_say_ids(p, list->ids, list->count);
}

static bool is_number(const char *p, const char *start)
{
    return (isdigit((unsigned char)*p) || *p == '-') && (p == start || strchr("[:,", p[-1]));
}

bool page_same(const char *a, const char *e)
{
    const char *a_start = a, *e_start = e;
    while (*a != '\0' || *e != '\0') {
        if (is_number(a, a_start) && is_number(e, e_start)) {
            char *a_end, *e_end;
            double x = strtod(a, &a_end), y = strtod(e, &e_end);
            if (!(fabs(x - y) <= 1e-12 * fmax(1, fabs(y)))) {
                return false;
            }
            a = a_end;
            e = e_end;
        } else if (*a++ != *e++) {
            return false;
        }
    }
    return true;
}

void page_expect(const bench_reply *r, const page *wanted)
{
    if (r->status != 200 || !page_same(r->body, wanted->text)) {
        fail_msg("\n  answered %d %s\n  expected %s", r->status, r->body, wanted->text);
    }
}

bench_reply specimen_get(api_bench *b, const char *format, ...)
{
    char target[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(target, sizeof target, format, arguments);
    va_end(arguments);
    return bench_send(b, "GET", target, NULL, NULL);
}

void page_expect_get(api_bench *b, const page *wanted, const char *format, ...)
{
    char target[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(target, sizeof target, format, arguments);
    va_end(arguments);
    bench_reply r = specimen_get(b, "%s", target);
    page_expect(&r, wanted);
    bench_reply_free(&r);
}

void page_expect_post(api_bench *b, const page *wanted, const char *target, const char *body)
{
    bench_reply r = bench_send(b, "POST", target, NULL, body);
    page_expect(&r, wanted);
    bench_reply_free(&r);
}

static unsigned member(const bench_reply *r, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(r->json, name);
    assert_non_null(value);
    return cJSON_IsNull(value) ? PG_NONE : (unsigned)value->valuedouble;
}

void specimen_put(api_bench *b, const pg_mesh *pg)
{
    page document = {.used = 0};
    page_say(&document, "{\"vertices\":[");
    for (unsigned v = 0; v < pg->vertices; v++) {
        const double *p = pg->position[v];
        page_say(&document, "%s[%g,%g,%g]", v == 0 ? "" : ",", p[0], p[1], p[2]);
    }
    page_say(&document, "],\"faces\":[");
    for (unsigned f = 0; f < pg->faces; f++) {
        page_say(&document, f == 0 ? "" : ",");
        page_say_ids(&document, pg->corners[f], pg->degree[f]);
    }
    page_say(&document, "]}");
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, document.text);
    if (r.status != 201) {
        fail_msg("%d %s: %s", r.status, document.text, r.body);
    }
    bench_reply_free(&r);
}

/* Asks the API for the choices that it is free to make, such as the half-edge that it stores with a
 * vertex, so that the test can predict all later answers exactly. */
static void learn(api_bench *b, pg_mesh *pg)
{
    for (unsigned h = 0; h < pg->halfedges; h++) {
        bench_reply r = specimen_get(b, "/v1/meshes/m/halfedges/%u", h);
        pg_learn_next(pg, h, member(&r, "next"));
        bench_reply_free(&r);
    }
    for (unsigned v = 0; v < pg->vertices; v++) {
        bench_reply r = specimen_get(b, "/v1/meshes/m/vertices/%u", v);
        pg_learn_vertex(pg, v, member(&r, "halfedge"));
        bench_reply_free(&r);
    }
    for (unsigned f = 0; f < pg->faces; f++) {
        bench_reply r = specimen_get(b, "/v1/meshes/m/faces/%u", f);
        pg_learn_face(pg, f, member(&r, "halfedge"));
        bench_reply_free(&r);
    }
}

api_bench *specimen_begin(const char *faces, pg_mesh *pg)
{
    api_bench *b = bench_new();
    pg_make(pg, faces, 0);
    pg_make(pg, faces, pg->vertices + 1);
    specimen_put(b, pg);
    learn(b, pg);
    return b;
}

void for_each_specimen(void (*try)(api_bench *b, const pg_mesh *pg))
{
    for (int i = 0; i < SPECIMENS; i++) {
        pg_mesh pg;
        api_bench *b = specimen_begin(specimens[i], &pg);
        try(b, &pg);
        bench_free(b);
    }
}

unsigned specimen_count(const pg_mesh *pg, int kind)
{
    return kind == VERTEX     ? pg->vertices
           : kind == HALFEDGE ? pg->halfedges
           : kind == EDGE     ? pg->halfedges / 2
                              : pg->faces;
}
