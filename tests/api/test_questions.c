/* Elements, adjacency and queries: the answers are compared with those that a search through lists
 * of polygons finds. */
#include "tests/api/specimens.h"

/* --- elements --- */

static void say_vertex(page *p, const pg_mesh *pg, unsigned v)
{
    pg_list edges;
    pg_relation(pg, (pg_element){"vertex", v}, "edges", false, &edges);
    page_say(p, "{\"id\":%u,\"position\":[%g,%g,%g],\"halfedge\":", v, pg->position[v][0],
             pg->position[v][1], pg->position[v][2]);
    page_say_id(p, pg->vertex_first[v]);
    page_say(p, ",\"degree\":%u,\"boundary\":%s,\"isolated\":%s}", edges.count,
             pg_is_boundary(pg, v) ? "true" : "false", pg_is_isolated(pg, v) ? "true" : "false");
}

static void say_halfedge(page *p, const pg_mesh *pg, unsigned h)
{
    page_say(
        p,
        "{\"id\":%u,\"twin\":%u,\"next\":%u,\"prev\":%u,\"origin\":%u,\"target\":%u,\"edge\":%u,"
        "\"face\":",
        h, h ^ 1u, pg->next[h], pg->prev[h], pg->origin[h], pg->origin[h ^ 1u], h / 2);
    page_say_id(p, pg->face[h]);
    page_say(p, ",\"boundary\":%s}", pg->face[h] == PG_NONE ? "true" : "false");
}

static void say_edge(page *p, const pg_mesh *pg, unsigned e)
{
    page_say(p, "{\"id\":%u,\"halfedges\":[%u,%u],\"vertices\":[%u,%u],\"faces\":", e, 2 * e,
             2 * e + 1, pg->origin[2 * e], pg->origin[2 * e + 1]);
    page_say_ids(p, &pg->face[2 * e], 2);
    bool boundary = pg->face[2 * e] == PG_NONE || pg->face[2 * e + 1] == PG_NONE;
    page_say(p, ",\"length\":%.17g,\"boundary\":%s}", pg_length(pg, e),
             boundary ? "true" : "false");
}

static void say_face(page *p, const pg_mesh *pg, unsigned f)
{
    pg_list halfedges, vertices;
    double area[3], centroid[3] = {0, 0, 0};
    pg_relation(pg, (pg_element){"face", f}, "halfedges", false, &halfedges);
    pg_relation(pg, (pg_element){"face", f}, "vertices", false, &vertices);
    double length = pg_area(pg, f, area);
    for (int k = 0; k < 3 && length > 0; k++) {
        area[k] /= length;
    }
    for (unsigned i = 0; i < vertices.count; i++) {
        for (int k = 0; k < 3; k++) {
            centroid[k] += pg->position[vertices.ids[i]][k] / vertices.count;
        }
    }
    page_say(p, "{\"id\":%u,\"halfedge\":%u,\"degree\":%u,\"vertices\":", f, pg->face_first[f],
             pg->degree[f]);
    page_say_list(p, &vertices);
    page_say(p, ",\"halfedges\":");
    page_say_list(p, &halfedges);
    page_say(p, ",\"area\":%.17g,\"normal\":[%.17g,%.17g,%.17g],\"centroid\":[%.17g,%.17g,%.17g]}",
             length, area[0], area[1], area[2], centroid[0], centroid[1], centroid[2]);
}

static void say_element(page *p, const pg_mesh *pg, int kind, unsigned id)
{
    static void (*const says[])(page *, const pg_mesh *, unsigned) = {say_vertex, say_halfedge,
                                                                      say_edge, say_face};
    says[kind](p, pg, id);
}

static void try_elements(api_bench *b, const pg_mesh *pg)
{
    for (int kind = 0; kind < KINDS; kind++) {
        for (unsigned id = 0; id < specimen_count(pg, kind); id++) {
            page wanted = {.used = 0};
            say_element(&wanted, pg, kind, id);
            page_expect_get(b, &wanted, "/v1/meshes/m/%s/%u", specimen_kinds[kind].plural, id);
        }
        bench_reply r = specimen_get(b, "/v1/meshes/m/%s/%u", specimen_kinds[kind].plural,
                                     specimen_count(pg, kind));
        assert_int_equal(r.status, 404);
        bench_reply_free(&r);
    }
}

static void elements_have_all_their_links(void **state)
{
    (void)state;
    for_each_specimen(try_elements);
}

static void a_degenerate_face_has_no_normal(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL,
                               "{\"vertices\":[[0,0,0],[1,0,0],[2,0,0]],\"faces\":[[0,1,2]]}");
    assert_int_equal(r.status, 201);
    bench_reply_free(&r);
    page wanted = {.used = 0};
    page_say(&wanted,
             "{\"id\":0,\"halfedge\":0,\"degree\":3,\"vertices\":[0,1,2],\"halfedges\":[0,2,4],"
             "\"area\":0,\"normal\":[0,0,0],\"centroid\":[1,0,0]}");
    page_expect_get(b, &wanted, "/v1/meshes/m/faces/0");
    bench_free(b);
}

/* --- relations --- */

static void say_adjacency(page *p, const pg_mesh *pg, pg_element of, const char *what,
                          bool clockwise)
{
    pg_list ids;
    pg_relation(pg, of, what, clockwise, &ids);
    page_say(p, "{\"revision\":1,\"of\":{\"%s\":%u},\"relation\":\"%s\",\"ids\":", of.kind, of.id,
             what);
    page_say_list(p, &ids);
    page_say(p, "}");
}

static void try_relations(api_bench *b, const pg_mesh *pg)
{
    for (int kind = 0; kind < KINDS; kind++) {
        for (unsigned id = 0; id < specimen_count(pg, kind); id++) {
            for (int r = 0; specimen_kinds[kind].relations[r] != NULL; r++) {
                const char *what = specimen_kinds[kind].relations[r];
                for (int cw = 0; cw < 2; cw++) {
                    page wanted = {.used = 0};
                    say_adjacency(&wanted, pg, (pg_element){specimen_kinds[kind].name, id}, what,
                                  cw == 1);
                    page_expect_get(b, &wanted, "/v1/meshes/m/%s/%u/%s%s",
                                    specimen_kinds[kind].plural, id, what,
                                    cw == 1 ? "?cw=true" : "");
                }
            }
        }
    }
}

static void relations_turn_counter_clockwise(void **state)
{
    (void)state;
    for_each_specimen(try_relations);
}

/* --- pages of lists, and one JSON line per element --- */

static void try_pages(api_bench *b, const pg_mesh *pg)
{
    for (int kind = 0; kind < KINDS; kind++) {
        char cursor[256] = "", next[256];
        for (unsigned from = 0; from == 0 || cursor[0] != '\0'; from += 3) {
            page wanted = {.used = 0};
            page_say(&wanted, "{\"revision\":1,\"items\":[");
            for (unsigned id = from; id < from + 3 && id < specimen_count(pg, kind); id++) {
                page_say(&wanted, id == from ? "" : ",");
                say_element(&wanted, pg, kind, id);
            }
            bench_reply r =
                specimen_get(b, "/v1/meshes/m/%s?limit=3%s%s", specimen_kinds[kind].plural,
                             from == 0 ? "" : "&cursor=", cursor);
            const cJSON *value = cJSON_GetObjectItemCaseSensitive(r.json, "next");
            snprintf(next, sizeof next, "%s", cJSON_IsString(value) ? value->valuestring : "");
            assert_int_equal(next[0] != '\0', from + 3 < specimen_count(pg, kind));
            page_say(&wanted, next[0] == '\0' ? "],\"next\":null}" : "],\"next\":\"%s\"}", next);
            page_expect(&r, &wanted);
            char link[600] = "";
            if (next[0] != '\0') {
                snprintf(link, sizeof link, "</v1/meshes/m/%s?limit=3&cursor=%s>; rel=\"next\"",
                         specimen_kinds[kind].plural, next);
            }
            assert_string_equal(bench_header(&r, "Link"), link);
            bench_reply_free(&r);
            memcpy(cursor, next, sizeof cursor);
        }
    }
}

static void try_lines(api_bench *b, const pg_mesh *pg)
{
    static const char *const accept[] = {"Accept", "application/x-ndjson", NULL};
    for (int kind = 0; kind < KINDS; kind++) {
        char target[64];
        page wanted = {.used = 0};
        for (unsigned id = 0; id < specimen_count(pg, kind); id++) {
            say_element(&wanted, pg, kind, id);
            page_say(&wanted, "\n");
        }
        page_say(&wanted, "{\"end\":true,\"count\":%u}\n", specimen_count(pg, kind));
        snprintf(target, sizeof target, "/v1/meshes/m/%s", specimen_kinds[kind].plural);
        bench_reply r = bench_send(b, "GET", target, accept, NULL);
        page_expect(&r, &wanted);
        assert_string_equal(bench_header(&r, "Content-Type"), "application/x-ndjson");
        bench_reply_free(&r);
    }
}

static void pages_go_through_all_elements(void **state)
{
    (void)state;
    for_each_specimen(try_pages);
}

static void lines_give_all_elements_and_their_count(void **state)
{
    (void)state;
    for_each_specimen(try_lines);
}

/* --- many elements in one question --- */

static void try_query(api_bench *b, const pg_mesh *pg)
{
    page body = {.used = 0}, wanted = {.used = 0};
    page_say(&body, "{\"queries\":[{\"walk\":\"none\"}");
    page_say(&wanted,
             "{\"revision\":1,\"results\":[{\"type\":\"/problems/bad_value\",\"title\":\"A "
             "value is outside its allowed range\",\"status\":400,\"detail\":\"\\\"none\\\" is "
             "not one of path, loop, rings, breadth_first, shortest_path, edge_loop, edge_ring\","
             "\"code\":\"bad_value\",\"pointer\":\"/queries/0/walk\"}");
    for (int kind = 0; kind < KINDS; kind++) {
        for (unsigned id = 0; id < specimen_count(pg, kind); id += 2) {
            const char *what = specimen_kinds[kind].relations[id % 2];
            page_say(&body, ",{\"relation\":\"%s\",\"of\":{\"%s\":%u},\"cw\":true}", what,
                     specimen_kinds[kind].name, id);
            page_say(&wanted, ",");
            say_adjacency(&wanted, pg, (pg_element){specimen_kinds[kind].name, id}, what, true);
            page_say(&body, ",{\"get\":{\"%s\":%u}}", specimen_kinds[kind].name, id);
            page_say(&wanted, ",");
            say_element(&wanted, pg, kind, id);
        }
    }
    for (unsigned i = 0; i < pg->vertices; i++) {
        for (unsigned j = 0; j < pg->vertices; j++) {
            unsigned found = PG_NONE;
            for (unsigned h = 0; h < pg->halfedges; h++) {
                found = pg->origin[h] == i && pg->origin[h ^ 1u] == j ? h : found;
            }
            page_say(&body, ",{\"find\":\"halfedge\",\"vertices\":[%u,%u]}", i, j);
            page_say(&wanted, ",{\"halfedge\":");
            page_say_id(&wanted, found);
            page_say(&wanted, "}");
        }
    }
    page_say(&body, "]}");
    page_say(&wanted, "]}");
    page_expect_post(b, &wanted, "/v1/meshes/m/query", body.text);
}

static bool is_in(const pg_list *list, unsigned id)
{
    bool found = false;
    for (unsigned i = 0; i < list->count; i++) {
        found = found || list->ids[i] == id;
    }
    return found;
}

static void try_finds(api_bench *b, const pg_mesh *pg)
{
    page body = {.used = 0}, wanted = {.used = 0};
    page_say(&body, "{\"queries\":[{\"find\":\"loop\",\"vertices\":[0,0]}");
    page_say(&wanted,
             "{\"revision\":1,\"results\":[{\"type\":\"/problems/bad_value\",\"title\":\"A "
             "value is outside its allowed range\",\"status\":400,\"detail\":\"\\\"loop\\\" is "
             "not one of halfedge, edge, faces\","
             "\"code\":\"bad_value\",\"pointer\":\"/queries/0/find\"}");
    for (unsigned i = 0; i < pg->vertices; i++) {
        pg_list about_i, about_j;
        pg_relation(pg, (pg_element){"vertex", i}, "faces", false, &about_i);
        for (unsigned j = 0; j < pg->vertices; j++) {
            unsigned found = PG_NONE;
            for (unsigned h = 0; h < pg->halfedges; h++) {
                found = pg->origin[h] == i && pg->origin[h ^ 1u] == j ? h / 2 : found;
            }
            page_say(&body, ",{\"find\":\"edge\",\"vertices\":[%u,%u]}", i, j);
            page_say(&wanted, ",{\"edge\":");
            page_say_id(&wanted, found);
            page_say(&body, ",{\"find\":\"faces\",\"vertices\":[%u,%u]}", i, j);
            page_say(&wanted, "},{\"faces\":[");
            pg_relation(pg, (pg_element){"vertex", j}, "faces", false, &about_j);
            const char *comma = "";
            for (unsigned k = 0; k < about_i.count; k++) {
                if (is_in(&about_j, about_i.ids[k])) {
                    page_say(&wanted, "%s%u", comma, about_i.ids[k]);
                    comma = ",";
                }
            }
            page_say(&wanted, "]}");
        }
    }
    page_say(&body, "]}");
    page_say(&wanted, "]}");
    page_expect_post(b, &wanted, "/v1/meshes/m/query", body.text);
}

static void edges_and_common_faces_of_two_vertices_are_found(void **state)
{
    (void)state;
    for_each_specimen(try_finds);
}

static void queries_answer_in_order(void **state)
{
    (void)state;
    for_each_specimen(try_query);
}

/* Requests a relation of all elements of a kind. The request names the elements as "all" or, if
 * `backwards` is set, by a list of their ids in descending order. Only an answer about "all" names
 * the elements: in octets, their ids and their number follow. */
static void try_dense_relation(api_bench *b, const pg_mesh *pg, int kind, const char *what,
                               bool backwards)
{
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    page offsets = {.used = 0}, ids = {.used = 0}, body = {.used = 0}, wanted = {.used = 0},
         elements = {.used = 0};
    unsigned numbers[2000] = {0}, total = 0, n = specimen_count(pg, kind);
    page_say(&body, "{\"queries\":[{\"relation\":\"%s\",\"of\":{\"%s\":", what,
             specimen_kinds[kind].plural);
    page_say(&body, backwards ? "[" : "\"all\"");
    page_say(&offsets, "[0");
    numbers[0] = 0;
    for (unsigned i = 0; i < n; i++) {
        pg_list list;
        unsigned id = backwards ? n - 1 - i : i;
        pg_relation(pg, (pg_element){specimen_kinds[kind].name, id}, what, false, &list);
        for (unsigned j = 0; j < list.count; j++) {
            numbers[n + 1 + total + j] = list.ids[j];
            page_say(&ids, "%s%u", total + j == 0 ? "" : ",", list.ids[j]);
        }
        total += list.count;
        numbers[i + 1] = total;
        page_say(&offsets, ",%u", total);
        if (backwards) {
            page_say(&body, "%s%u", i == 0 ? "" : ",", id);
        }
    }
    page_say(&body, "%s}}]}", backwards ? "]" : "");
    size_t length = n + 1 + total;
    for (unsigned i = 0; i < n && !backwards; i++) {
        page_say(&elements, "%s%u", i == 0 ? "\"elements\":[" : ",", i);
        numbers[length++] = i;
    }
    if (!backwards) {
        page_say(&elements, n == 0 ? "\"elements\":[]," : "],");
        numbers[length++] = n;
    }
    page_say(&wanted, "{\"revision\":1,\"results\":[{%s\"offsets\":%s],\"ids\":[%s]}]}",
             backwards ? "" : elements.text, offsets.text, ids.text);
    page_expect_post(b, &wanted, "/v1/meshes/m/query", body.text);

    bench_reply r = bench_send(b, "POST", "/v1/meshes/m/query", octets, body.text);
    assert_int_equal(r.status, 200);
    assert_string_equal(bench_header(&r, "Content-Type"), "application/octet-stream");
    assert_int_equal(r.length, 4 * length);
    for (size_t i = 0; i < r.length / 4; i++) {
        const unsigned char *p = (const unsigned char *)r.body + 4 * i;
        assert_int_equal(p[0] | (unsigned)p[1] << 8 | (unsigned)p[2] << 16 | (unsigned)p[3] << 24,
                         numbers[i]);
    }
    bench_reply_free(&r);
}

static void try_dense(api_bench *b, const pg_mesh *pg)
{
    for (int kind = 0; kind < KINDS; kind++) {
        for (int r = 0; specimen_kinds[kind].relations[r] != NULL; r++) {
            try_dense_relation(b, pg, kind, specimen_kinds[kind].relations[r], false);
            try_dense_relation(b, pg, kind, specimen_kinds[kind].relations[r], true);
        }
    }
}

static void dense_answers_are_offsets_and_ids(void **state)
{
    (void)state;
    for_each_specimen(try_dense);
}

/* The corners of all faces as octets must be the answer to the relation `vertices` of all faces, at
 * every revision. */
static void expect_face_octets(api_bench *b, const char *mesh, int revision)
{
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    static const char all[] =
        "{\"queries\":[{\"relation\":\"vertices\",\"of\":{\"faces\":\"all\"}}]}";
    char target[80];
    snprintf(target, sizeof target, "/v1/meshes/%s/query?revision=%d", mesh, revision);
    bench_reply asked = bench_expect(200, bench_send(b, "POST", target, octets, all));
    snprintf(target, sizeof target, "/v1/meshes/%s/faces?revision=%d", mesh, revision);
    bench_reply r = bench_expect(200, bench_send(b, "GET", target, octets, NULL));
    assert_string_equal(bench_header(&r, "Content-Type"), "application/octet-stream");
    assert_int_equal(r.length, asked.length);
    assert_memory_equal(r.body, asked.body, r.length);
    bench_done(r);
    bench_done(asked);
}

static void try_face_octets(api_bench *b, const pg_mesh *pg)
{
    (void)pg;
    expect_face_octets(b, "m", 1);
}

static void corners_of_all_faces_are_octets(void **state)
{
    (void)state;
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    for_each_specimen(try_face_octets);
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=p",
                                            "{\"shape\":\"grid\","
                                            "\"columns\":60,\"rows\":60}")));
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/p/edits",
                                            "{\"ops\":[{\"op\":\"face_poke\",\"face\":7},"
                                            "{\"op\":\"face_delete\",\"face\":0},"
                                            "{\"op\":\"face_delete\",\"face\":3599}]}")));
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/p/edits", "{\"op\":\"triangulate\"}")));
    for (int revision = 1; revision <= 3; revision++) {
        expect_face_octets(b, "p", revision);
    }
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/p/faces", octets, NULL));
    char tag[64];
    snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
    bench_done(r);
    const char *const known[] = {"Accept", "application/octet-stream", "If-None-Match", tag, NULL};
    bench_done(bench_expect(304, bench_send(b, "GET", "/v1/meshes/p/faces", known, NULL)));
    bench_done(bench_expect(400, bench_send(b, "GET", "/v1/meshes/p/faces?limit=9", octets, NULL)));
    bench_done(bench_expect(406, bench_send(b, "GET", "/v1/meshes/p/edges", octets, NULL)));
    bench_free(b);
}

/* A question with ?revision= must be answered for that revision, as JSON and as octets. It must be
 * refused for an element that did not exist at that revision. */
static void questions_are_of_the_revision(void **state)
{
    (void)state;
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    static const char gone[] = "{\"queries\":[{\"get\":{\"face\":1}},{\"get\":{\"face\":8}}]}";
    static const char dense[] =
        "{\"queries\":[{\"relation\":\"edges\",\"of\":{\"faces\":\"all\"}}]}";
    static const char walk[] = "{\"walk\":\"breadth_first\",\"from\":{\"face\":1}}";
    static const struct {
        int revision;
        const char *first,
            *second;       /* the expected error code, or NULL if the question must be answered */
        int faces, walked; /* 0: refused */
    } rows[] = {{1, NULL, "no_such_element", 6, 6},
                {2, NULL, NULL, 9, 9},
                {3, "deleted_element", NULL, 8, 0},
                {4, NULL, NULL, 9, 9}};
    api_bench *b = bench_new();
    static const char *const past[][2] = {
        {"/v1/meshes?id=p", "{\"shape\":\"cube\"}"},
        {"/v1/meshes/p/edits", "{\"op\":\"face_poke\",\"face\":0}"},
        {"/v1/meshes/p/edits", "{\"op\":\"face_delete\",\"face\":1}"},
        {"/v1/meshes/p/undo", NULL},
    };
    for (size_t i = 0; i < sizeof past / sizeof *past; i++) {
        bench_done(
            bench_expect(i == 0 ? 201 : 200, bench_send(b, "POST", past[i][0], NULL, past[i][1])));
    }
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char target[80];
        snprintf(target, sizeof target, "/v1/meshes/p/query?revision=%d", rows[i].revision);
        bench_reply r = bench_expect(200, bench_send(b, "POST", target, NULL, gone));
        assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, rows[i].revision);
        const cJSON *result = cJSON_GetObjectItem(r.json, "results")->child;
        const char *const codes[] = {rows[i].first, rows[i].second};
        for (int q = 0; q < 2; q++, result = result->next) {
            const cJSON *code = cJSON_GetObjectItem(result, "code");
            assert_string_equal(code == NULL ? "" : code->valuestring,
                                codes[q] == NULL ? "" : codes[q]);
        }
        bench_done(r);
        snprintf(target, sizeof target, "/v1/meshes/p/query?revision=%d", rows[i].revision);
        r = bench_expect(200, bench_send(b, "POST", target, octets, dense));
        uint32_t end;
        memcpy(&end, r.body + 4 * (size_t)rows[i].faces, sizeof end);
        assert_int_equal(r.length, 4 * (2 * (size_t)rows[i].faces + 2 + end));
        bench_done(r);
        snprintf(target, sizeof target, "/v1/meshes/p/traverse?revision=%d", rows[i].revision);
        r = bench_expect(rows[i].walked == 0 ? 422 : 200,
                         bench_send(b, "POST", target, NULL, walk));
        assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "ids")), rows[i].walked);
        bench_done(r);
    }
    bench_done(
        bench_expect(404, bench_send(b, "POST", "/v1/meshes/p/query?revision=5", NULL, gone)));
    bench_done(
        bench_expect(404, bench_send(b, "POST", "/v1/meshes/p/traverse?revision=5", NULL, walk)));
    bench_done(
        bench_expect(400, bench_send(b, "POST", "/v1/meshes/p/traverse?revision=0", NULL, walk)));
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elements_have_all_their_links),
        cmocka_unit_test(a_degenerate_face_has_no_normal),
        cmocka_unit_test(relations_turn_counter_clockwise),
        cmocka_unit_test(pages_go_through_all_elements),
        cmocka_unit_test(lines_give_all_elements_and_their_count),
        cmocka_unit_test(edges_and_common_faces_of_two_vertices_are_found),
        cmocka_unit_test(queries_answer_in_order),
        cmocka_unit_test(dense_answers_are_offsets_and_ids),
        cmocka_unit_test(corners_of_all_faces_are_octets),
        cmocka_unit_test(questions_are_of_the_revision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
