/* Walks, and questions about the mesh as a whole: the answers are compared with those that a search
 * through lists of polygons finds. */
#include "tests/api/specimens.h"

#include "format/text/number.h"

/* --- walks --- */

static void traverse(api_bench *b, const page *wanted, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void traverse(api_bench *b, const page *wanted, const char *format, ...)
{
    char body[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(body, sizeof body, format, arguments);
    va_end(arguments);
    page_expect_post(b, wanted, "/v1/meshes/m/traverse", body);
}

/* A walk that starts at the half-edge `from` and follows links. `letters` has the first letters of
 * the links next, prev and twin; they are followed `repeat` times, or until the condition `until`
 * holds unless that is NULL. */
typedef struct step_walk {
    unsigned from;
    const char *letters;
    unsigned repeat;
    const char *until;
} step_walk;

/* Requests a walk and requires that the answer equals the walk along the links of the polygon mesh
 * `pg`. */
static void try_path(api_bench *b, const pg_mesh *pg, const step_walk *walk)
{
    const unsigned from = walk->from, repeat = walk->repeat;
    const char *letters = walk->letters, *until = walk->until;
    page body = {.used = 0}, wanted = {.used = 0};
    pg_list on = {.ids = {from}, .count = 1};
    bool ended = false;
    unsigned h = from;
    for (unsigned i = 0; i < repeat && !ended; i++) {
        for (const char *p = letters; *p != '\0' && !ended; p++) {
            h = *p == 'n' ? pg->next[h] : *p == 'p' ? pg->prev[h] : h ^ 1u;
            on.ids[on.count++] = h;
            ended = until != NULL && (until[0] == 's' ? h == from : pg->face[h] == PG_NONE);
        }
        ended = ended || (until != NULL && h == from);
    }
    page_say(&body, "\"walk\":\"path\",\"from\":{\"halfedge\":%u},\"path\":[", from);
    for (const char *p = letters; *p != '\0'; p++) {
        page_say(&body, "%s\"%s\"", p == letters ? "" : ",",
                 *p == 'n'   ? "next"
                 : *p == 'p' ? "prev"
                             : "twin");
    }
    page_say(&body, "]");
    if (repeat != PG_HALFEDGES) {
        page_say(&body, ",\"repeat\":%u", repeat);
    }
    if (until != NULL) {
        page_say(&body, ",\"until\":\"%s\"", until);
    }
    page_say(&wanted, "{\"revision\":1,%s,\"halfedges\":", body.text);
    page_say_list(&wanted, &on);
    page_say(&wanted, ",\"end\":%u}", h);
    traverse(b, &wanted, "{%s}", body.text);
}

static void try_paths(api_bench *b, const pg_mesh *pg)
{
    static const char *const words[] = {"n", "p", "t", "ntn", "pt", "nntp"};
    for (unsigned h = 0; h < pg->halfedges; h += 3) {
        for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
            try_path(b, pg, &(step_walk){h, words[i], 1, NULL});
            try_path(b, pg, &(step_walk){h, words[i], 0, NULL});
            try_path(b, pg, &(step_walk){h, words[i], 5, NULL});
            try_path(b, pg, &(step_walk){h, words[i], 2, "start"});
            try_path(b, pg, &(step_walk){h, words[i], PG_HALFEDGES, "start"});
            try_path(b, pg, &(step_walk){h, words[i], PG_HALFEDGES, "boundary"});
        }
    }
}

static void paths_take_their_steps(void **state)
{
    (void)state;
    for_each_specimen(try_paths);
}

static void try_loops(api_bench *b, const pg_mesh *pg)
{
    for (unsigned h = 0; h < pg->halfedges; h++) {
        pg_list loop;
        page wanted = {.used = 0};
        pg_relation(pg, (pg_element){"halfedge", h}, "loop", false, &loop);
        page_say(&wanted,
                 "{\"revision\":1,\"walk\":\"loop\",\"from\":{\"halfedge\":%u},\"halfedges\":", h);
        page_say_list(&wanted, &loop);
        page_say(&wanted, ",\"vertices\":[");
        for (unsigned i = 0; i < loop.count; i++) {
            page_say(&wanted, "%s%u", i == 0 ? "" : ",", pg->origin[loop.ids[i]]);
        }
        page_say(&wanted, "],\"face\":");
        page_say_id(&wanted, pg->face[h]);
        page_say(&wanted, "}");
        traverse(b, &wanted, "{\"walk\":\"loop\",\"from\":{\"halfedge\":%u}}", h);
    }
}

static void try_rings(api_bench *b, const pg_mesh *pg, unsigned v, unsigned depth)
{
    pg_list ids, depths;
    page wanted = {.used = 0};
    pg_breadth_first(pg, &(pg_flood){{"vertex", v}, depth, 0}, &ids, &depths);
    page_say(&wanted,
             "{\"revision\":1,\"walk\":\"rings\",\"from\":{\"vertex\":%u},\"depth\":%u,"
             "\"rings\":[",
             v, depth);
    for (unsigned i = 0, end; i < ids.count; i = end) {
        for (end = i; end < ids.count && depths.ids[end] == depths.ids[i];) {
            end++;
        }
        page_say(&wanted, i == 0 ? "" : ",");
        page_say_ids(&wanted, ids.ids + i, end - i);
    }
    page_say(&wanted, "]}");
    traverse(b, &wanted, "{\"walk\":\"rings\",\"from\":{\"vertex\":%u},\"depth\":%u}", v, depth);
}

/* Compares the answer about a breadth-first walk with the same walk in the polygon mesh `pg`. If
 * the depth is PG_NONE, the request has no depth; if the limit is 0, it has no limit. */
static void try_flood(api_bench *b, const pg_mesh *pg, const pg_flood *flood)
{
    pg_list ids, depths;
    page body = {.used = 0}, wanted = {.used = 0};
    pg_breadth_first(pg, flood, &ids, &depths);
    page_say(&body, "\"walk\":\"breadth_first\",\"from\":{\"%s\":%u}", flood->from.kind,
             flood->from.id);
    if (flood->depth != PG_NONE) {
        page_say(&body, ",\"depth\":%u", flood->depth);
    }
    if (flood->limit != 0) {
        page_say(&body, ",\"limit\":%u", flood->limit);
    }
    page_say(&wanted, "{\"revision\":1,%s,\"ids\":", body.text);
    page_say_list(&wanted, &ids);
    page_say(&wanted, ",\"depths\":");
    page_say_list(&wanted, &depths);
    page_say(&wanted, "}");
    traverse(b, &wanted, "{%s}", body.text);
}

static void try_floods(api_bench *b, const pg_mesh *pg)
{
    for (unsigned v = 0; v < pg->vertices; v++) {
        for (unsigned depth = 0; depth < 4; depth++) {
            try_rings(b, pg, v, depth);
            try_flood(b, pg, &(pg_flood){{specimen_kinds[VERTEX].name, v}, depth, 0});
        }
        try_flood(b, pg, &(pg_flood){{specimen_kinds[VERTEX].name, v}, PG_NONE, 0});
        try_flood(b, pg, &(pg_flood){{specimen_kinds[VERTEX].name, v}, PG_NONE, 3});
    }
    for (unsigned f = 0; f < pg->faces; f++) {
        try_flood(b, pg, &(pg_flood){{specimen_kinds[FACE].name, f}, 1, 2});
        try_flood(b, pg, &(pg_flood){{specimen_kinds[FACE].name, f}, PG_NONE, 0});
    }
    try_loops(b, pg);
}

static void loops_rings_and_floods_meet_what_is_near(void **state)
{
    (void)state;
    for_each_specimen(try_floods);
}

static unsigned at(const cJSON *list, int i)
{
    return (unsigned)cJSON_GetArrayItem(list, i)->valuedouble;
}

/* The length of the shortest paths between two vertices, in edges or as the sum of the lengths of
 * the edges; HUGE_VAL if there is no path. */
typedef struct distance {
    unsigned from, to;
    bool by_length;
    double value;
} distance;

/* Several shortest paths may exist, and each of them is correct. So the test checks that the answer
 * is a path, and that its length is the shortest one. */
static void try_shortest(api_bench *b, const pg_mesh *pg, const distance *d)
{
    const double wanted = d->value;
    char body[256];
    snprintf(body, sizeof body,
             "{\"walk\":\"shortest_path\",\"from\":{\"vertex\":%u},\"to\":{\"vertex\":%u},"
             "\"by\":\"%s\"}",
             d->from, d->to, d->by_length ? "length" : "edges");
    bench_reply r = bench_send(b, "POST", "/v1/meshes/m/traverse", NULL, body);
    assert_int_equal(r.status, 200);
    const cJSON *vertices = cJSON_GetObjectItemCaseSensitive(r.json, "vertices");
    const cJSON *edges = cJSON_GetObjectItemCaseSensitive(r.json, "edges");
    const cJSON *sum = cJSON_GetObjectItemCaseSensitive(r.json, "length");
    if (isinf(wanted)) {
        assert_true(cJSON_IsNull(vertices) && cJSON_IsNull(edges) && cJSON_IsNull(sum));
        bench_reply_free(&r);
        return;
    }
    int steps = cJSON_GetArraySize(edges);
    double total = 0;
    assert_int_equal(cJSON_GetArraySize(vertices), steps + 1);
    assert_int_equal(at(vertices, 0), d->from);
    assert_int_equal(at(vertices, steps), d->to);
    for (int i = 0; i < steps; i++) {
        unsigned e = at(edges, i), p = at(vertices, i), q = at(vertices, i + 1);
        assert_true((pg->origin[2 * e] == p && pg->origin[2 * e + 1] == q) ||
                    (pg->origin[2 * e] == q && pg->origin[2 * e + 1] == p));
        total += d->by_length ? pg_length(pg, e) : 1;
    }
    assert_true(fabs(total - wanted) < 1e-9 && fabs(sum->valuedouble - wanted) < 1e-9);
    bench_reply_free(&r);
}

static void try_all_shortest(api_bench *b, const pg_mesh *pg)
{
    for (int length = 0; length < 2; length++) {
        double distances[PG_VERTICES][PG_VERTICES];
        pg_distances(pg, length == 1, distances);
        for (unsigned i = 0; i < pg->vertices; i++) {
            for (unsigned j = 0; j < pg->vertices; j++) {
                try_shortest(b, pg, &(distance){i, j, length == 1, distances[i][j]});
            }
        }
    }
}

static void shortest_paths_are_shortest(void **state)
{
    (void)state;
    for_each_specimen(try_all_shortest);
}

static void try_edges(api_bench *b, const pg_mesh *pg)
{
    for (unsigned e = 0; e < pg->halfedges / 2; e++) {
        for (int ring = 0; ring < 2; ring++) {
            pg_list edges;
            bool closed;
            page wanted = {.used = 0};
            const char *name = ring == 1 ? "edge_ring" : "edge_loop";
            pg_edges(pg, ring == 1, e, &edges, &closed);
            page_say(&wanted,
                     "{\"revision\":1,\"walk\":\"%s\",\"from\":{\"edge\":%u},\"edges\":", name, e);
            page_say_list(&wanted, &edges);
            page_say(&wanted, ",\"closed\":%s}", closed ? "true" : "false");
            traverse(b, &wanted, "{\"walk\":\"%s\",\"from\":{\"edge\":%u}}", name, e);
        }
    }
}

static void edge_loops_and_rings_go_straight_on(void **state)
{
    (void)state;
    for_each_specimen(try_edges);
}

/* --- the mesh as a whole --- */

static void try_boundaries(api_bench *b, const pg_mesh *pg)
{
    static pg_list loops[PG_FACES];
    page wanted = {.used = 0};
    unsigned count = pg_boundaries(pg, loops);
    page_say(&wanted, "{\"revision\":1,\"loops\":[");
    for (unsigned i = 0; i < count; i++) {
        page_say(&wanted, "%s{\"halfedge\":%u,\"length\":%u,\"halfedges\":", i == 0 ? "" : ",",
                 loops[i].ids[0], loops[i].count);
        page_say_list(&wanted, &loops[i]);
        page_say(&wanted, ",\"vertices\":[");
        for (unsigned j = 0; j < loops[i].count; j++) {
            page_say(&wanted, "%s%u", j == 0 ? "" : ",", pg->origin[loops[i].ids[j]]);
        }
        page_say(&wanted, "]}");
    }
    page_say(&wanted, "]}");
    page_expect_get(b, &wanted, "/v1/meshes/m/boundaries");
}

static void say_component(page *p, const pg_mesh *pg, const unsigned *lowest, unsigned face)
{
    unsigned faces = 0, vertices = 0;
    bool seen[PG_VERTICES] = {false};
    for (unsigned f = 0; f < pg->faces; f++) {
        faces += lowest[f] == face;
        for (unsigned i = 0; i < pg->degree[f] && lowest[f] == face; i++) {
            vertices += !seen[pg->corners[f][i]];
            seen[pg->corners[f][i]] = true;
        }
    }
    page_say(p, "%s{\"faces\":%u,\"vertices\":%u,\"face\":%u}", face == 0 ? "" : ",", faces,
             vertices, face);
}

static void try_components(api_bench *b, const pg_mesh *pg)
{
    static const char *const queries[] = {"", "?by=edge", "?by=vertex"};
    for (int i = 0; i < 3; i++) {
        unsigned lowest[PG_FACES];
        page wanted = {.used = 0};
        pg_components(pg, i == 2, lowest);
        page_say(&wanted, "{\"revision\":1,\"by\":\"%s\",\"components\":[",
                 i == 2 ? "vertex" : "edge");
        for (unsigned f = 0; f < pg->faces; f++) {
            if (lowest[f] == f) {
                say_component(&wanted, pg, lowest, f);
            }
        }
        page_say(&wanted, "]}");
        page_expect_get(b, &wanted, "/v1/meshes/m/components%s", queries[i]);
    }
}

/* Returns six times the volume of the component whose lowest face is `face`, or 0 if the component
 * is open. The coordinates are whole numbers, so the result is one, too. */
static double six_volumes(const pg_mesh *pg, const unsigned *lowest, unsigned face)
{
    double sum = 0;
    for (unsigned h = 0; h < pg->halfedges; h++) {
        unsigned f = pg->face[h];
        if (f == PG_NONE || lowest[f] != face) {
            continue;
        }
        if (pg->face[h ^ 1u] == PG_NONE) {
            return 0;
        }
        const double *o = pg->position[pg->origin[pg->face_first[f]]];
        const double *p = pg->position[pg->origin[h]];
        const double *q = pg->position[pg->origin[h ^ 1u]];
        sum += o[0] * (p[1] * q[2] - p[2] * q[1]) + o[1] * (p[2] * q[0] - p[0] * q[2]) +
               o[2] * (p[0] * q[1] - p[1] * q[0]);
    }
    return sum;
}

static unsigned say_inside_out(page *wanted, const pg_mesh *pg, const char *comma)
{
    unsigned lowest[PG_FACES], count = 0;
    pg_components(pg, false, lowest);
    for (unsigned f = 0; f < pg->faces; f++) {
        double volumes = lowest[f] == f ? six_volumes(pg, lowest, f) : 0;
        if (volumes < 0) {
            char value[HE_NUMBER_TEXT + 1];
            value[he_double_print(volumes / 6, value)] = '\0';
            page_say(wanted,
                     "%s{\"code\":\"inside_out_component\",\"kind\":\"face\",\"id\":%u,"
                     "\"detail\":\"the component of face %u is closed, and its faces look inward\","
                     "\"value\":%s}",
                     comma, f, f, value);
            comma = ",";
            count++;
        }
    }
    return count;
}

static void try_check(api_bench *b, const pg_mesh *pg)
{
    page wanted = {.used = 0};
    unsigned bowties = 0, isolated = 0, flat = 0;
    const char *comma = "";
    page_say(&wanted, "{\"revision\":1,\"valid\":true,\"problems\":[],\"defects\":[");
    for (unsigned v = 0; v < pg->vertices; v++) {
        if (pg_fans(pg, v) > 1) {
            page_say(&wanted,
                     "%s{\"code\":\"bowtie\",\"kind\":\"vertex\",\"id\":%u,"
                     "\"detail\":\"vertex %u has %u fans\"}",
                     comma, v, v, pg_fans(pg, v));
            bowties++;
            comma = ",";
        }
    }
    for (unsigned v = 0; v < pg->vertices; v++) {
        if (pg_is_isolated(pg, v)) {
            page_say(&wanted,
                     "%s{\"code\":\"isolated_vertex\",\"kind\":\"vertex\",\"id\":%u,"
                     "\"detail\":\"vertex %u has no edge\"}",
                     comma, v, v);
            isolated++;
            comma = ",";
        }
    }
    for (unsigned f = 0; f < pg->faces; f++) {
        double area[3];
        if (pg_area(pg, f, area) == 0) {
            page_say(&wanted,
                     "%s{\"code\":\"degenerate_face\",\"kind\":\"face\",\"id\":%u,"
                     "\"detail\":\"face %u has no area\",\"value\":0}",
                     comma, f, f);
            flat++;
            comma = ",";
        }
    }
    unsigned inside_out = say_inside_out(&wanted, pg, comma);
    page_say(&wanted,
             "],\"totals\":{\"problems\":0,\"bowtie\":%u,\"isolated_vertex\":%u,"
             "\"duplicate_position\":0,\"zero_length_edge\":0,\"degenerate_face\":%u,"
             "\"nonplanar_face\":0,\"small_component\":0,\"inside_out_component\":%u},"
             "\"thresholds\":{\"merge\":0,\"flat\":1000,\"small\":0},\"complete\":true}",
             bowties, isolated, flat, inside_out);
    page_expect_get(b, &wanted, "/v1/meshes/m/check?merge=0&flat=1000&small=0");
}

static void try_topology(api_bench *b, const pg_mesh *pg)
{
    try_boundaries(b, pg);
    try_components(b, pg);
    try_check(b, pg);
}

static void boundaries_components_and_defects_are_found(void **state)
{
    (void)state;
    for_each_specimen(try_topology);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_take_their_steps),
        cmocka_unit_test(loops_rings_and_floods_meet_what_is_near),
        cmocka_unit_test(shortest_paths_are_shortest),
        cmocka_unit_test(edge_loops_and_rings_go_straight_on),
        cmocka_unit_test(boundaries_components_and_defects_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
