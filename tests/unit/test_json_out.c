#include "api/json/json_out.h"

#include "api/json/problem.h"
#include "fixture.h"
#include "tests/failing.h"

#include <math.h>
#include <stdint.h>

static void assert_text(api_text *text, const char *expected)
{
    assert_false(text->failed);
    api_text_add_char(text, '\0');
    assert_string_equal(text->bytes, expected);
    api_text_clear(text);
}

static void values_are_separated(void **state)
{
    (void)state;
    api_text text = {0};
    api_out out;
    api_out_init(&out, &text);
    api_out_object_begin(&out);
    api_out_key_id(&out, "twin", 6);
    api_out_key_id(&out, "face", HE_NONE);
    api_out_key_bool(&out, "boundary", true);
    api_out_key(&out, "list");
    api_out_array_begin(&out);
    api_out_array_begin(&out);
    api_out_array_end(&out);
    api_out_object_begin(&out);
    api_out_object_end(&out);
    api_out_null(&out);
    api_out_array_end(&out);
    api_out_key_ids(&out, "ids", (const uint32_t[]){4294967293u, HE_NONE, 0}, 3);
    api_out_key_ids(&out, "none", NULL, 0);
    api_out_key(&out, "pairs");
    api_out_pairs(&out, (const uint32_t[]){30, 5, 31, 5}, 4);
    api_out_key_vec3(&out, "p", (he_vec3){0.1, -2, 1e300});
    api_out_key_u64(&out, "big", UINT64_MAX);
    api_out_key(&out, "small");
    api_out_i64(&out, INT64_MIN);
    api_out_object_end(&out);
    assert_text(&text, "{\"twin\":6,\"face\":null,\"boundary\":true,\"list\":[[],{},null],"
                       "\"ids\":[4294967293,null,0],\"none\":[],\"pairs\":[[30,5],[31,5]],"
                       "\"p\":[0.1,-2,1e300],\"big\":18446744073709551615,"
                       "\"small\":-9223372036854775808}");
}

static void strings_are_escaped_and_stay_utf8(void **state)
{
    (void)state;
    static const struct {
        const char *in, *out;
    } strings[] = {
        {"", "\"\""},
        {"plain", "\"plain\""},
        {"a\"b\\c", "\"a\\\"b\\\\c\""},
        {"\b\f\n\r\t", "\"\\b\\f\\n\\r\\t\""},
        {"\x01\x1f\x7f", "\"\\u0001\\u001f\\u007f\""},
        {"\xC3\xA9 \xE2\x80\xA8 \xF0\x9F\x98\x80", "\"\xC3\xA9 \xE2\x80\xA8 \xF0\x9F\x98\x80\""},
        {"\xFF", "\"\xEF\xBF\xBD\""},
        {"a\xE2\x80", "\"a\xEF\xBF\xBD\xEF\xBF\xBD\""},
        {"</script>", "\"</script>\""},
    };
    for (size_t i = 0; i < sizeof strings / sizeof strings[0]; i++) {
        api_text text = {0};
        api_out out;
        api_out_init(&out, &text);
        api_out_string(&out, strings[i].in);
        assert_text(&text, strings[i].out);
    }
}

static void numbers_are_what_json_can_say(void **state)
{
    (void)state;
    api_text text = {0};
    api_out out;
    api_out_init(&out, &text);
    api_out_array_begin(&out);
    api_out_number(&out, 0.1);
    api_out_number(&out, (double)NAN);
    api_out_number(&out, -(double)INFINITY);
    api_out_number(&out, 5e-324);
    api_out_array_end(&out);
    assert_text(&text, "[0.1,null,null,5e-324]");
}

static void times_are_dates_of_the_gregorian_calendar(void **state)
{
    (void)state;
    static const struct {
        double seconds;
        const char *text;
    } times[] = {
        {0, "\"1970-01-01T00:00:00.000Z\""},
        {951782400, "\"2000-02-29T00:00:00.000Z\""},
        {1709251199.5, "\"2024-02-29T23:59:59.500Z\""},
        {4107542400, "\"2100-03-01T00:00:00.000Z\""},
        {-1, "\"1969-12-31T23:59:59.000Z\""},
        {1e300, "null"},
    };
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
        api_text text = {0};
        api_out out;
        api_out_init(&out, &text);
        api_out_time(&out, times[i].seconds);
        assert_text(&text, times[i].text);
    }
}

static void many_ids_grow_the_text(void **state)
{
    (void)state;
    enum { COUNT = 10000 };
    static uint32_t ids[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        ids[i] = i;
    }
    api_text text = {0};
    api_out out;
    api_out_init(&out, &text);
    api_out_ids(&out, ids, COUNT);
    /* The list has the ids 0 to 9999: 10 of one digit, 90 of two, 900 of three and 9000 of four.
     * The commas between them and two brackets are added. */
    assert_int_equal(text.length, 10 + 180 + 2700 + 36000 + COUNT - 1 + 2);
    assert_memory_equal(text.bytes + text.length - 11, ",9998,9999]", 11);
    api_text_clear(&text);
}

static void a_maximum_is_kept_and_failure_sticks(void **state)
{
    (void)state;
    api_text text = {.maximum = 4};
    api_text_add_string(&text, "abc");
    api_text_add_string(&text, "de");
    assert_true(text.failed);
    api_text_add_char(&text, 'x');
    assert_int_equal(text.length, 3);
    api_text_empty(&text);
    api_text_add_string(&text, "abcd");
    assert_false(text.failed);
    api_text_clear(&text);
}

static void write_much(api_text *text)
{
    api_out out;
    api_out_init(&out, text);
    api_out_array_begin(&out);
    for (uint32_t i = 0; i < 100; i++) {
        api_out_object_begin(&out);
        api_out_key_id(&out, "id", i);
        api_out_key_string(&out, "name", "a \"long\" name that makes the text grow");
        api_out_key_ids(&out, "ids", &i, 1);
        api_out_key_vec3(&out, "p", (he_vec3){i, 0.1, 1});
        api_out_key(&out, "time");
        api_out_time(&out, i);
        api_out_object_end(&out);
    }
    api_out_array_end(&out);
}

static void every_failed_allocation_only_sets_failed(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        api_text text = {0};
        write_much(&text);
        failing_end(&f, !text.failed);
        api_text_clear(&text);
    }
    assert_true(f.n > 3);
}

static void problems_are_what_rfc_9457_says(void **state)
{
    (void)state;
    api_problem problem = {0};
    he_error err;
    api_text text = {0};
    assert_int_equal(he_fail(&err, HE_LINK_CONDITION, HE_EDGE, 5, "edge %u is narrow", 5),
                     HE_LINK_CONDITION);
    assert_false(api_problem_set_core(&problem, &err));
    api_problem_set_pointer(&problem, "/ops/%d", 3);
    api_problem_write(&problem, "r1", &text);
    assert_text(&text, "{\"type\":\"/problems/link_condition\","
                       "\"title\":\"The link condition does not hold\",\"status\":422,"
                       "\"detail\":\"edge 5 is narrow\",\"code\":\"link_condition\","
                       "\"pointer\":\"/ops/3\",\"element\":{\"kind\":\"edge\",\"id\":5},"
                       "\"request_id\":\"r1\"}");
    /* If a problem is set twice, the first one is kept. */
    api_problem_set(&problem, API_INTERNAL, "late");
    assert_int_equal(problem.code, HE_LINK_CONDITION);
}

static void elements_that_do_not_live_depend_on_where_they_are_named(void **state)
{
    (void)state;
    he_error err;
    api_problem body = {0}, path = {0}, gone = {0};
    (void)he_fail(&err, HE_NO_SUCH_ELEMENT, HE_FACE, 9, "face 9");
    api_problem_set_core(&body, &err);
    api_problem_set_path(&path, &err);
    (void)he_fail(&err, HE_DELETED_ELEMENT, HE_FACE, 9, "face 9");
    api_problem_set_path(&gone, &err);
    assert_int_equal(api_problem_http(&body), 422);
    assert_int_equal(api_problem_http(&path), 404);
    assert_int_equal(api_problem_http(&gone), 410);
}

static void every_code_has_its_page(void **state)
{
    (void)state;
    for (int code = HE_OK + 1; code < API_CODE_COUNT; code++) {
        api_text text = {0};
        assert_int_equal(api_code_find(api_code_slug(code)), code);
        assert_in_range(api_code_http(code), 400, 507);
        assert_true(strlen(api_code_explanation(code)) > 20);
        api_problem_page(code, &text);
        assert_false(text.failed);
        api_text_clear(&text);
    }
    assert_int_equal(api_code_find("no_such_code"), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_separated),
        cmocka_unit_test(strings_are_escaped_and_stay_utf8),
        cmocka_unit_test(numbers_are_what_json_can_say),
        cmocka_unit_test(times_are_dates_of_the_gregorian_calendar),
        cmocka_unit_test(many_ids_grow_the_text),
        cmocka_unit_test(a_maximum_is_kept_and_failure_sticks),
        cmocka_unit_test(every_failed_allocation_only_sets_failed),
        cmocka_unit_test(problems_are_what_rfc_9457_says),
        cmocka_unit_test(elements_that_do_not_live_depend_on_where_they_are_named),
        cmocka_unit_test(every_code_has_its_page),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
