/* Tests of the pages for browsers: their policy, the manual's page for a missing page, and where
 * the type of a problem leads. */
#include "api/describe/routes.h"
#include "journal/journal.h"

#include "fixture.h"

static api_asset page, missing;

static const api_asset *find_asset(void *context, const char *path)
{
    static const char *const pages[] = {"/", "/docs/start", "/docs/problems/boundary_edge"};
    (void)context;
    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        if (strcmp(path, pages[i]) == 0) {
            return &page;
        }
    }
    return strcmp(path, "/docs/404") == 0 ? &missing : NULL;
}

static st_store *store;
static api_service *service;

static int set_up(void **state)
{
    (void)state;
    store = st_store_new(&(st_store_options){.max_meshes = 1, .journal = st_journal_memory()});
    assert_non_null(store);
    page = (api_asset){"text/html; charset=utf-8", false, api_kept_new("<p>", 3)};
    missing = (api_asset){"text/html; charset=utf-8", false, api_kept_new("<p>missing", 10)};
    assert_true(page.body != NULL && missing.body != NULL);
    service = api_service_new(store, api_routes(),
                              &(api_options){.version = "1.2.3", .asset = find_asset});
    return service == NULL;
}

static int tear_down(void **state)
{
    (void)state;
    api_service_free(service);
    st_store_free(store);
    api_kept_free(page.body);
    api_kept_free(missing.body);
    return 0;
}

static api_exchange *get(const char *path, const char *accept)
{
    api_request request = {.method = "GET", .path = path, .query = "", .request_id = "r"};
    request.headers[API_HEADER_ACCEPT] = accept;
    return api_handle(service, &request, NULL, 0);
}

static const char *answer_header(const api_answer *answer, const char *name)
{
    for (size_t i = 0; i < answer->header_count; i++) {
        if (strcmp(answer->headers[i].name, name) == 0) {
            return answer->headers[i].value;
        }
    }
    return NULL;
}

static bool says(const api_answer *answer, const char *text)
{
    char body[1024];
    snprintf(body, sizeof body, "%.*s", (int)answer->length, answer->bytes);
    return strstr(body, text) != NULL;
}

static void pages_carry_a_strict_policy(void **state)
{
    (void)state;
    static const char *const pages[] = {"/", "/docs/start", "/docs/nowhere", "/problems/syntax"};
    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        api_exchange *x = get(pages[i], "text/html");
        const char *policy = answer_header(api_answer_of(x), "Content-Security-Policy");
        assert_non_null(policy);
        assert_ptr_equal(strstr(policy, "default-src 'none'"), policy);
        assert_null(strstr(policy, "unsafe"));
        assert_non_null(strstr(policy, "frame-ancestors 'none'"));
        api_free(x);
    }
}

static void a_problem_leads_to_its_page_in_the_manual_if_there_is_one(void **state)
{
    (void)state;
    api_exchange *x = get("/problems/boundary_edge", NULL);
    assert_int_equal(api_answer_of(x)->status, 303);
    assert_string_equal(answer_header(api_answer_of(x), "Location"),
                        "../docs/problems/boundary_edge");
    api_free(x);
    x = get("/problems/closed_fan", NULL);
    assert_int_equal(api_answer_of(x)->status, 200);
    assert_true(says(api_answer_of(x), "closed_fan"));
    api_free(x);
}

static void what_is_missing_is_a_page_for_browsers_and_a_problem_for_programs(void **state)
{
    (void)state;
    static const char browser[] = "text/html,application/xhtml+xml,*/*;q=0.8";
    static const char problem[] = "application/problem+json";
    static const struct {
        const char *path, *accept, *type, *text;
    } cases[] = {
        {"/docs/nowhere", browser, "text/html", "<p>missing"},
        {"/docs/no/where", browser, "text/html", "<p>missing"},
        {"/docs/nowhere", "*/*", problem, "no_such_route"},
        {"/docs/nowhere", NULL, problem, "no_such_route"},
        {"/assets/nowhere", browser, problem, "no_such_route"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        api_exchange *x = get(cases[i].path, cases[i].accept);
        const api_answer *answer = api_answer_of(x);
        assert_int_equal(answer->status, 404);
        const char *type = answer_header(answer, "Content-Type");
        assert_ptr_equal(strstr(type, cases[i].type), type);
        assert_true(says(answer, cases[i].text));
        api_free(x);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_carry_a_strict_policy),
        cmocka_unit_test(a_problem_leads_to_its_page_in_the_manual_if_there_is_one),
        cmocka_unit_test(what_is_missing_is_a_page_for_browsers_and_a_problem_for_programs),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
