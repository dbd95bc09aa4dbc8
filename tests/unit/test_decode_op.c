/* Operations are decoded from JSON, and references to the results of earlier operations are
 * resolved. */
#include "api/write/decode_op.h"
#include "api/write/result_names.h"

#include "fixture.h"
#include "tests/failing.h"

static const struct {
    const char *body;
    int code;
    const char *pointer;
} bodies[] = {
    {"{\"op\":\"edge_split\",\"edge\":5,\"t\":0.25}", HE_OK, ""},
    {"{\"op\":\"edge_split\",\"edge\":5}", HE_OK, ""},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[0,0,1]}", HE_OK, ""},
    {"{\"op\":\"vertex_move\",\"vertices\":[1,2],\"by\":[0,0,1]}", HE_OK, ""},
    {"{\"op\":\"vertex_move\",\"vertices\":[1,2],\"to\":[[0,0,1],[1,1,1]]}", HE_OK, ""},
    {"{\"op\":\"face_add\",\"vertices\":[2,1,0]}", HE_OK, ""},
    /* The decoder accepts the vertex lists of the next two operations, although face_add refuses
     * them when it runs. */
    {"{\"op\":\"face_add\",\"vertices\":[0,0]}", HE_OK, ""},
    {"{\"op\":\"face_add\",\"vertices\":[]}", HE_OK, ""},
    {"{\"op\":\"vertex_split\",\"vertex\":0,\"left\":1,\"right\":null,\"to\":[0,0,0]}", HE_OK, ""},
    {"{\"op\":\"hole_fill\",\"halfedge\":1,\"method\":\"fan\"}", HE_OK, ""},
    {"{\"op\":\"transform\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}", HE_OK, ""},
    {"{\"op\":\"face_delete\",\"face\":1,\"keep_isolated\":true}", HE_OK, ""},
    {"{\"op\":\"edge_collapse\",\"halfedge\":1,\"t\":1}", HE_OK, ""},
    /* operations on all elements with a certain mark ("selected"); these elements are looked up
     * only after decoding */
    {"{\"op\":\"face_delete\",\"faces\":{\"selected\":true}}", HE_OK, ""},
    {"{\"op\":\"delaunay\",\"edges\":{\"a b\":true}}", HE_OK, ""},
    {"{\"op\":\"vertex_move\",\"vertices\":{\"s\":true},\"to\":[[0,0,1],[1,1,1]]}", HE_OK, ""},
    {"{\"op\":\"face_delete\",\"faces\":{}}", API_MISSING_MEMBER, "/faces"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":true,\"b\":true}}", API_UNKNOWN_MEMBER, "/faces/b"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":false}}", HE_BAD_VALUE, "/faces/a"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":1}}", HE_OK, ""},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":-2147483648}}", HE_OK, ""},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":4294967295}}", HE_OK, ""},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":-2147483649}}", HE_BAD_VALUE, "/faces/a"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":4294967296}}", HE_BAD_VALUE, "/faces/a"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":1.5}}", HE_BAD_VALUE, "/faces/a"},
    {"{\"op\":\"face_delete\",\"faces\":{\"a\":\"x\"}}", API_WRONG_TYPE, "/faces/a"},
    {"{\"op\":\"face_delete\",\"face\":{\"a\":true}}", API_WRONG_TYPE, "/face"},
    {"{\"op\":\"face_add\",\"vertices\":{\"a\":true}}", API_WRONG_TYPE, "/vertices"},
    /* mistakes in the operation as a whole: no object, or no valid name */
    {"[]", API_WRONG_TYPE, ""},
    {"{}", API_MISSING_MEMBER, ""},
    {"{\"op\":7}", API_WRONG_TYPE, "/op"},
    {"{\"op\":\"edge_spilt\",\"edge\":5}", API_UNKNOWN_OPERATION, "/op"},
    {"{\"op\":\"Edge_split\",\"edge\":5}", API_UNKNOWN_OPERATION, "/op"},
    /* members that are missing, unknown, or exclude each other */
    {"{\"op\":\"edge_split\"}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"edge_split\",\"edge\":5,\"tt\":0.5}", API_UNKNOWN_MEMBER, "/tt"},
    {"{\"op\":\"edge_split\",\"edge\":5,\"T\":0.5}", API_UNKNOWN_MEMBER, "/T"},
    {"{\"op\":\"edge_split\",\"edge\":5,\"as\":\"a\"}", API_UNKNOWN_MEMBER, "/as"},
    {"{\"op\":\"face_delete\",\"face\":1,\"faces\":[2]}", API_CONFLICTING_MEMBERS, "/faces"},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[0,0,1],\"by\":[0,0,1]}", API_CONFLICTING_MEMBERS,
     "/by"},
    {"{\"op\":\"vertex_move\",\"vertex\":1}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"edge_collapse\",\"edge\":1,\"halfedge\":2}", API_CONFLICTING_MEMBERS, "-"},
    {"{\"op\":\"edge_collapse\"}", API_MISSING_MEMBER, ""},
    /* members that depend on the rule of a selection, in any order */
    {"{\"op\":\"select\",\"by\":\"box\",\"min\":[0,0,0],\"max\":[1,1,1]}", HE_OK, ""},
    {"{\"op\":\"select\",\"max\":[1,1,1],\"min\":[0,0,0],\"by\":\"box\"}", HE_OK, ""},
    {"{\"op\":\"select\",\"by\":\"region\",\"faces\":[1],\"angle\":0.5}", HE_OK, ""},
    {"{\"op\":\"select\",\"by\":\"boundary\"}", HE_OK, ""},
    {"{\"op\":\"select\",\"by\":\"grow\",\"vertices\":{\"part\":2}}", HE_OK, ""},
    {"{\"op\":\"select\",\"by\":\"lasso\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,-1,2],"
     "\"polygon\":[[0,0],[1,0],[0,1]]}",
     HE_OK, ""},
    /* Like the corners of a face, those of a polygon are only counted when the operation runs. */
    {"{\"op\":\"select\",\"by\":\"lasso\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"
     "\"polygon\":[]}",
     HE_OK, ""},
    {"{\"op\":\"select\"}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"select\",\"by\":\"sphere\"}", HE_BAD_VALUE, "/by"},
    {"{\"op\":\"select\",\"by\":\"box\",\"min\":[0,0,0]}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"select\",\"by\":\"region\",\"angle\":1}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"select\",\"by\":\"component\"}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"select\",\"by\":\"measure\"}", API_MISSING_MEMBER, ""},
    {"{\"op\":\"select\",\"by\":\"component\",\"faces\":[1],\"edges\":[2]}",
     API_CONFLICTING_MEMBERS, "/edges"},
    {"{\"op\":\"select\",\"by\":\"region\",\"vertices\":[1],\"angle\":1}", API_CONFLICTING_MEMBERS,
     "/vertices"},
    {"{\"op\":\"select\",\"angle\":1,\"by\":\"box\",\"min\":[0,0,0],\"max\":[1,1,1]}",
     API_CONFLICTING_MEMBERS, "/angle"},
    {"{\"op\":\"select\",\"by\":\"boundary\",\"steps\":2}", API_CONFLICTING_MEMBERS, "/steps"},
    {"{\"op\":\"select\",\"by\":\"region\",\"faces\":[1],\"angle\":4}", HE_BAD_VALUE, "/angle"},
    {"{\"op\":\"select\",\"by\":\"boundary\",\"value\":0}", HE_BAD_VALUE, "/value"},
    {"{\"op\":\"select\",\"by\":\"lasso\",\"polygon\":[[0,0],[1],[0,1]]}", HE_BAD_VALUE,
     "/polygon/1"},
    {"{\"op\":\"select\",\"by\":\"lasso\",\"polygon\":[[0,0],[1,\"1\"],[0,1]]}", API_WRONG_TYPE,
     "/polygon/1/1"},
    {"{\"op\":\"select\",\"by\":\"lasso\",\"polygon\":7}", API_WRONG_TYPE, "/polygon"},
    /* ids that are no numbers, out of range, or not in a list where one is needed */
    {"{\"op\":\"edge_split\",\"edge\":-1}", HE_BAD_VALUE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":1.5}", HE_BAD_VALUE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":4294967294}", HE_BAD_VALUE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":1e20}", HE_BAD_VALUE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":null}", API_WRONG_TYPE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":\"5\"}", API_WRONG_TYPE, "/edge"},
    {"{\"op\":\"edge_split\",\"edge\":[5]}", API_WRONG_TYPE, "/edge"},
    {"{\"op\":\"face_delete\",\"faces\":[]}", HE_BAD_VALUE, "/faces"},
    {"{\"op\":\"face_delete\",\"faces\":3}", API_WRONG_TYPE, "/faces"},
    {"{\"op\":\"face_delete\",\"faces\":[1,2,-3]}", HE_BAD_VALUE, "/faces/2"},
    {"{\"op\":\"face_delete\",\"faces\":[1,null]}", API_WRONG_TYPE, "/faces/1"},
    {"{\"op\":\"face_delete\",\"face\":\"$a.face\"}", API_WRONG_TYPE, "/face"},
    /* wrong numbers, points, choices, flags and matrices */
    {"{\"op\":\"edge_split\",\"edge\":5,\"t\":0}", HE_BAD_VALUE, "/t"},
    {"{\"op\":\"edge_split\",\"edge\":5,\"t\":1}", HE_BAD_VALUE, "/t"},
    {"{\"op\":\"edge_split\",\"edge\":5,\"t\":\"0.5\"}", API_WRONG_TYPE, "/t"},
    {"{\"op\":\"edge_collapse\",\"halfedge\":1,\"t\":1.01}", HE_BAD_VALUE, "/t"},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[0,0]}", HE_BAD_VALUE, "/to"},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[0,0,0,0]}", HE_BAD_VALUE, "/to"},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[0,null,0]}", API_WRONG_TYPE, "/to/1"},
    {"{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[]}", HE_BAD_VALUE, "/to"},
    {"{\"op\":\"vertex_move\",\"vertices\":[1,2],\"to\":[[0,0,1]]}", HE_BAD_VALUE, "/to"},
    {"{\"op\":\"vertex_move\",\"vertices\":[1,2],\"to\":[[0,0,1],[0,0]]}", HE_BAD_VALUE, "/to/1"},
    {"{\"op\":\"vertex_move\",\"vertices\":[1,2],\"to\":[[0,0,1],3]}", API_WRONG_TYPE, "/to/1"},
    {"{\"op\":\"hole_fill\",\"halfedge\":1,\"method\":\"Fan\"}", HE_BAD_VALUE, "/method"},
    {"{\"op\":\"hole_fill\",\"halfedge\":1,\"method\":1}", API_WRONG_TYPE, "/method"},
    {"{\"op\":\"face_delete\",\"face\":1,\"keep_isolated\":1}", API_WRONG_TYPE, "/keep_isolated"},
    {"{\"op\":\"transform\",\"matrix\":[1,0,0]}", HE_BAD_VALUE, "/matrix"},
    {"{\"op\":\"transform\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}", HE_BAD_VALUE,
     "/matrix/15"},
};

typedef struct parsed {
    api_document document;
    api_arena arena;
    api_problem problem;
    api_in root;
} parsed;

static void parse(parsed *p, const char *body)
{
    *p = (parsed){0};
    const api_in_options options = {.values = 10000};
    const api_bytes text = {body, strlen(body)};
    if (!api_document_parse(text, &options, &p->document, &p->root, &p->problem)) {
        fail_msg("%s: %s", body, p->problem.detail);
    }
}

static void clear(parsed *p)
{
    api_document_clear(&p->document);
    api_arena_clear(&p->arena);
}

static void bodies_are_refused_with_their_pointer(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; i++) {
        parsed p;
        api_call call;
        parse(&p, bodies[i].body);
        bool good = api_decode_op(&p.root, &(api_op_scope){0}, &p.arena, &call);
        if (good != (bodies[i].code == HE_OK) || p.problem.code != bodies[i].code ||
            (strcmp(bodies[i].pointer, "-") != 0 &&
             strcmp(bodies[i].pointer, p.problem.pointer) != 0)) {
            fail_msg("%s: %s at \"%s\" (%s)", bodies[i].body, api_code_slug(p.problem.code),
                     p.problem.pointer, p.problem.detail);
        }
        clear(&p);
    }
}

static void names_that_do_not_exist_are_answered_with_those_that_do(void **state)
{
    (void)state;
    static const struct {
        const char *body, *detail;
    } cases[] = {
        {"{\"op\":\"split_edge\"}",
         "there is no operation \"split_edge\"; did you mean \"edge_split\"?"},
        {"{\"op\":\"frobnicate\"}",
         "there is no operation \"frobnicate\"; GET /v1/operations lists them"},
        {"{\"op\":\"edge_split\",\"edg\":0}",
         "there is no parameter \"edg\" of edge_split; did you mean \"edge\"?"},
        {"{\"op\":\"edge_flip\",\"what\":0}",
         "there is no parameter \"what\" of edge_flip; there are edge, edges"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parsed p;
        api_call call;
        parse(&p, cases[i].body);
        assert_false(api_decode_op(&p.root, &(api_op_scope){0}, &p.arena, &call));
        assert_string_equal(p.problem.detail, cases[i].detail);
        clear(&p);
    }
}

/* Returns the index of the operation's parameter with this name. */
static size_t param(const he_op *op, const char *name)
{
    size_t i = 0;
    while (strcmp(op->params[i].name, name) != 0) {
        i++;
    }
    return i;
}

static void arguments_hold_what_was_given(void **state)
{
    (void)state;
    parsed p;
    api_call call;
    parse(&p, "{\"op\":\"vertex_move\",\"vertices\":[7,3],\"to\":[[1,2,3],[4,5,6]]}");
    assert_true(api_decode_op(&p.root, &(api_op_scope){0}, &p.arena, &call));
    const he_arg *vertices = &call.args[param(call.op, "vertex")];
    const he_arg *to = &call.args[param(call.op, "to")];
    assert_true(vertices->given && vertices->list && vertices->count == 2);
    assert_int_equal(vertices->ids[0], 7);
    assert_int_equal(vertices->ids[1], 3);
    assert_true(to->given && to->list && to->count == 2);
    assert_true(to->points[1].z > 5.5 && to->points[1].z < 6.5);
    assert_false(call.args[param(call.op, "by")].given);
    clear(&p);

    parse(&p, "{\"op\":\"edge_split\",\"edge\":5,\"expected_revision\":4}");
    static const char *const also[] = {"expected_revision", NULL};
    assert_true(api_decode_op(&p.root, &(api_op_scope){.also = also}, &p.arena, &call));
    assert_int_equal(call.args[param(call.op, "edge")].id, 5);
    const he_arg *t = &call.args[param(call.op, "t")];
    assert_false(t->given);
    assert_true(t->number > 0.49 && t->number < 0.51);
    clear(&p);

    parse(&p, "{\"op\":\"vertex_split\",\"vertex\":0,\"left\":null,\"right\":2,\"to\":[0,0,0]}");
    assert_true(api_decode_op(&p.root, &(api_op_scope){0}, &p.arena, &call));
    assert_int_equal(call.args[param(call.op, "left")].id, HE_NONE);
    assert_true(call.args[param(call.op, "left")].given);
    clear(&p);
}

/* Decodes a list of operations without running them. An operation may give a name to its results,
 * and later operations may refer to the results by this name. */
static bool check_list(const api_in *list, api_result_names *names, api_arena *arena)
{
    api_in op;
    for (bool more = api_in_first(list, &op); more; more = api_in_next(&op)) {
        api_call call;
        if (!api_decode_op(&op, &(api_op_scope){.references = &names->references}, arena, &call) ||
            !api_result_names_add(names, &op, &call)) {
            return false;
        }
    }
    return true;
}

#define SPLIT "{\"op\":\"edge_split\",\"edge\":5,\"as\":\"a\"}"

static const struct {
    const char *body;
    int code;
    const char *pointer;
} lists[] = {
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$a.vertex\"}]", HE_OK, ""},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges.1\"}]", HE_OK, ""},
    {"[" SPLIT ",{\"op\":\"face_delete\",\"faces\":[1,\"$a.faces\",2]}]", HE_OK, ""},
    {"[" SPLIT ",{\"op\":\"face_add\",\"vertices\":[1,\"$a.vertex\",2]}]", HE_OK, ""},
    {"[" SPLIT "," SPLIT "]", API_REPEATED_NAME, "/1/as"},
    {"[{\"op\":\"vertex_delete\",\"vertex\":\"$a.vertex\"}," SPLIT "]", API_BAD_REFERENCE,
     "/0/vertex"},
    {"[{\"op\":\"edge_split\",\"edge\":\"$a.edges.0\",\"as\":\"a\"}]", API_BAD_REFERENCE,
     "/0/edge"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$b.vertex\"}]", API_BAD_REFERENCE,
     "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$a.vertices\"}]", API_BAD_REFERENCE,
     "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$a\"}]", API_BAD_REFERENCE, "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$a.\"}]", API_BAD_REFERENCE, "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$.vertex\"}]", API_BAD_REFERENCE,
     "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"$a.vertex.0\"}]", API_BAD_REFERENCE,
     "/1/vertex"},
    {"[" SPLIT ",{\"op\":\"vertex_delete\",\"vertex\":\"a.vertex\"}]", API_WRONG_TYPE, "/1/vertex"},
    /* references to results of the wrong kind, or to a list of ids where one id is needed */
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.vertex\"}]", API_BAD_REFERENCE, "/1/edge"},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges\"}]", API_BAD_REFERENCE, "/1/edge"},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges.01\"}]", API_BAD_REFERENCE, "/1/edge"},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges.-1\"}]", API_BAD_REFERENCE, "/1/edge"},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges.1.2\"}]", API_BAD_REFERENCE, "/1/edge"},
    {"[" SPLIT ",{\"op\":\"edge_split\",\"edge\":\"$a.edges.99999999999999999999\"}]",
     API_BAD_REFERENCE, "/1/edge"},
    /* operations that give an invalid name ("as") to their results */
    {"[{\"op\":\"edge_split\",\"edge\":5,\"as\":\"\"}]", HE_BAD_VALUE, "/0/as"},
    {"[{\"op\":\"edge_split\",\"edge\":5,\"as\":\"1a\"}]", HE_BAD_VALUE, "/0/as"},
    {"[{\"op\":\"edge_split\",\"edge\":5,\"as\":\"a.b\"}]", HE_BAD_VALUE, "/0/as"},
    {"[{\"op\":\"edge_split\",\"edge\":5,\"as\":7}]", API_WRONG_TYPE, "/0/as"},
};

static void references_are_checked_before_anything_runs(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        parsed p;
        api_result_names names;
        api_result_names_init(&names, (const uint64_t[2]){1, 2});
        parse(&p, lists[i].body);
        bool good = check_list(&p.root, &names, &p.arena);
        if (good != (lists[i].code == HE_OK) || p.problem.code != lists[i].code ||
            strcmp(lists[i].pointer, p.problem.pointer) != 0) {
            fail_msg("%s: %s at \"%s\" (%s)", lists[i].body, api_code_slug(p.problem.code),
                     p.problem.pointer, p.problem.detail);
        }
        api_result_names_clear(&names);
        clear(&p);
    }
}

static void set_list(he_results *results, size_t row, const uint32_t *ids, size_t count)
{
    results->present[row] = true;
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(he_ids_add(&results->list[row], ids[i], NULL), HE_OK);
    }
}

static size_t result(const he_op *op, const char *name)
{
    size_t i = 0;
    while (strcmp(op->results[i].name, name) != 0) {
        i++;
    }
    return i;
}

/* Operations refer to results of an earlier operation, which the test sets: the vertex 17, the
 * edges 30, 31 and 32, and no faces. */
static void references_take_the_values_of_results(void **state)
{
    (void)state;
    static const struct {
        /* an operation that refers to results of an earlier one, and the name of the parameter that
         * the test checks */
        const char *op, *name;
        int code;
        size_t count;
        uint32_t first, last;
    } uses[] = {
        {"{\"op\":\"vertex_delete\",\"vertex\":\"$a.vertex\"}", "vertex", HE_OK, 0, 17, 17},
        {"{\"op\":\"edge_split\",\"edge\":\"$a.edges.2\"}", "edge", HE_OK, 0, 32, 32},
        {"{\"op\":\"edge_split\",\"edge\":\"$a.edges.3\"}", "edge", HE_NO_SUCH_ELEMENT, 0, 0, 0},
        {"{\"op\":\"face_add\",\"vertices\":[1,\"$a.vertex\"]}", "vertices", HE_OK, 2, 1, 17},
        {"{\"op\":\"face_delete\",\"faces\":[\"$a.faces\",8,9]}", "face", HE_OK, 2, 8, 9},
        {"{\"op\":\"face_delete\",\"faces\":[\"$a.faces\"]}", "face", HE_NO_SUCH_ELEMENT, 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        char body[256];
        snprintf(body, sizeof body, "[" SPLIT ",%s]", uses[i].op);
        parsed p;
        api_result_names names;
        api_call call;
        api_in op;
        api_result_names_init(&names, (const uint64_t[2]){1, 2});
        parse(&p, body);
        assert_true(check_list(&p.root, &names, &p.arena));
        assert_true(api_in_first(&p.root, &op));
        assert_true(
            api_decode_op(&op, &(api_op_scope){.references = &names.references}, &p.arena, &call));
        he_results results = {0};
        size_t vertex = result(call.op, "vertex");
        results.present[vertex] = true;
        results.id[vertex] = 17;
        set_list(&results, result(call.op, "edges"), (const uint32_t[]){30, 31, 32}, 3);
        set_list(&results, result(call.op, "faces"), NULL, 0);
        api_result_names_bind(&names, &call, &results);
        he_results_clear(&results);
        assert_true(api_in_next(&op));
        assert_int_equal(
            api_decode_op(&op, &(api_op_scope){.references = &names.references}, &p.arena, &call),
            uses[i].code == HE_OK);
        assert_int_equal(p.problem.code, uses[i].code);
        if (uses[i].code == HE_OK) {
            const he_arg *arg = &call.args[param(call.op, uses[i].name)];
            assert_int_equal(arg->count, uses[i].count);
            assert_int_equal(arg->count == 0 ? arg->id : arg->ids[0], uses[i].first);
            assert_int_equal(arg->count == 0 ? arg->id : arg->ids[arg->count - 1], uses[i].last);
        }
        api_result_names_clear(&names);
        clear(&p);
    }
}

static void many_names_are_found(void **state)
{
    (void)state;
    enum { MANY = 2000 };
    api_text text = {0};
    for (int i = 0; i < MANY; i++) {
        api_text_add_format(&text, "%s{\"op\":\"edge_split\",\"edge\":", i == 0 ? "[" : ",");
        if (i == 0) {
            api_text_add_string(&text, "0");
        } else {
            api_text_add_format(&text, "\"$n%d.edges.0\"", i / 2);
        }
        api_text_add_format(&text, ",\"as\":\"n%d\"}", i);
    }
    api_text_add_string(&text, "]");
    api_text_add_char(&text, '\0');
    parsed p;
    api_result_names names;
    api_result_names_init(&names, (const uint64_t[2]){1, 2});
    parse(&p, text.bytes);
    assert_true(check_list(&p.root, &names, &p.arena));
    assert_int_equal(names.count, MANY);
    api_result_names_clear(&names);
    clear(&p);
    api_text_clear(&text);
}

static void every_failed_allocation_is_a_problem(void **state)
{
    (void)state;
    static const char body[] = "[" SPLIT ",{\"op\":\"face_delete\",\"faces\":[1,\"$a.faces\",2]},"
                               "{\"op\":\"vertex_move\",\"vertices\":[1],\"to\":[[0,0,1]]}]";
    failing f = {0};
    while (failing_next(&f)) {
        parsed p = {0};
        api_result_names names;
        const api_in_options options = {.values = 1000};
        const api_bytes text = {body, strlen(body)};
        api_result_names_init(&names, (const uint64_t[2]){1, 2});
        bool good = api_document_parse(text, &options, &p.document, &p.root, &p.problem) &&
                    check_list(&p.root, &names, &p.arena);
        failing_end(&f, good);
        assert_int_equal(p.problem.code, good ? HE_OK : HE_NO_MEMORY);
        api_result_names_clear(&names);
        clear(&p);
    }
    assert_true(f.n > 20);
}

int main(void)
{
    api_in_setup();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_refused_with_their_pointer),
        cmocka_unit_test(names_that_do_not_exist_are_answered_with_those_that_do),
        cmocka_unit_test(arguments_hold_what_was_given),
        cmocka_unit_test(references_are_checked_before_anything_runs),
        cmocka_unit_test(references_take_the_values_of_results),
        cmocka_unit_test(many_names_are_found),
        cmocka_unit_test(every_failed_allocation_is_a_problem),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
