/* Tests of writing C structs as JSON objects by tables that list their members. */
#include "api/json/record.h"

#include "api/describe/schema_rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

typedef struct size {
    double width;
} size;

typedef struct thing {
    char id[8];
    const char *title;
    uint32_t vertex;
    uint32_t edges;
    uint64_t bytes;
    int64_t euler;
    int status;
    bool has_status, open;
    double area, ended;
    he_vec3 point;
    size size;
    int letter;
    const char *const *names;
} thing;

static void write_twice(api_out *out, const void *value)
{
    api_out_u64(out, 2 * (uint64_t)((const thing *)value)->edges);
}

static void write_letter(api_out *out, const void *letter)
{
    api_out_string(out, (const char[]){(char)('a' + *(const int *)letter), '\0'});
}

static const api_field size_fields[] = {
    API_FIELD("width", "#fraction", size, width, .required = true),
};
static const api_record size_record = {"size", size_fields, 1};

static const api_field fields[] = {
    API_FIELD("id", "text", thing, id, .required = true),
    API_FIELD("title", "text?", thing, title, .required = true, .zero_is_none = true),
    API_FIELD("vertex", "id?", thing, vertex, .required = true),
    API_FIELD("edges", "count", thing, edges, .required = true),
    API_FIELD_MADE("halfedges", "count", write_twice, .required = true),
    API_FIELD("bytes", "count", thing, bytes, .zero_is_none = true),
    API_FIELD("euler", "integer", thing, euler, .required = true),
    API_FIELD("status", "integer?", thing, status, .known = API_KNOWN(thing, has_status)),
    API_FIELD("open", "flag", thing, open, .required = true),
    API_FIELD("area", "number", thing, area, .required = true),
    API_FIELD("ended", "time?", thing, ended, .required = true, .zero_is_none = true),
    API_FIELD("point", "point", thing, point, .required = true),
    API_FIELD_RECORD("size", "#size?", thing, size, &size_record,
                     .known = API_KNOWN(thing, has_status)),
    API_FIELD_MADE_OF("letter", "#letter", thing, letter, write_letter, .required = true),
    API_FIELD("names", "*text", thing, names, .required = false),
};
static const api_record record = API_RECORD("thing", fields);

static void expect(const thing *value, const char *json)
{
    api_text text = {0};
    api_out out;
    api_out_init(&out, &text);
    api_record_write(&out, &record, value);
    api_text_add_char(&text, '\0');
    assert_false(text.failed);
    assert_string_equal(text.bytes, json);
    api_text_clear(&text);
}

static void each_type_is_written_as_json_has_it(void **state)
{
    (void)state;
    const thing value = {.id = "a",
                         .title = "A \"b\"",
                         .vertex = 7,
                         .edges = 3,
                         .bytes = (uint64_t)1 << 40,
                         .euler = -2,
                         .status = 201,
                         .has_status = true,
                         .open = true,
                         .area = 0.5,
                         .ended = 1767268800,
                         .point = {1, 2, 3},
                         .size = {0.25},
                         .letter = 2,
                         .names = (const char *const[]){"x", "y", NULL}};
    expect(&value,
           "{\"id\":\"a\",\"title\":\"A \\\"b\\\"\",\"vertex\":7,\"edges\":3,\"halfedges\":6,"
           "\"bytes\":1099511627776,\"euler\":-2,\"status\":201,\"open\":true,\"area\":0.5,"
           "\"ended\":\"2026-01-01T12:00:00.000Z\",\"point\":[1,2,3],\"size\":{\"width\":0.25},"
           "\"letter\":\"c\",\"names\":[\"x\",\"y\"]}");
}

static void a_member_without_a_value_is_null_or_left_out(void **state)
{
    (void)state;
    const thing value = {.title = "", .vertex = HE_NONE};
    expect(
        &value,
        "{\"id\":\"\",\"title\":null,\"vertex\":null,\"edges\":0,\"halfedges\":0,"
        "\"euler\":0,\"open\":false,\"area\":0,\"ended\":null,\"point\":[0,0,0],\"letter\":\"a\"}");
    const thing untitled = {.vertex = HE_NONE};
    expect(
        &untitled,
        "{\"id\":\"\",\"title\":null,\"vertex\":null,\"edges\":0,\"halfedges\":0,"
        "\"euler\":0,\"open\":false,\"area\":0,\"ended\":null,\"point\":[0,0,0],\"letter\":\"a\"}");
}

static void a_value_of_another_type_is_refused(void **state)
{
    (void)state;
    const api_field wrong[] = {
        API_FIELD("area", "count", thing, area, .required = true),
        API_FIELD("edges", "text", thing, edges, .required = true),
        API_FIELD("open", "#other", thing, open, .required = true),
        API_FIELD("bytes", "count", thing, bytes, .required = true, .zero_is_none = true),
        API_FIELD("edges", "*count", thing, edges, .required = true),
        API_FIELD_RECORD("size", "#other", thing, size, &size_record, .required = true),
        API_FIELD_RECORD("size", "size", thing, size, &size_record, .required = true),
        {.name = "size", .type = "#size", .record = &size_record, .write = write_twice},
        {.name = "size", .type = "#size"},
        API_FIELD("names", "text", thing, names, .required = false),
        API_FIELD("title", "*text", thing, title, .required = false),
    };
    for (size_t i = 0; i < record.count; i++) {
        assert_true(api_field_fits(&fields[i]));
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(api_field_fits(&wrong[i]));
    }
}

static void each_row_of_the_api_fits_its_schema(void **state)
{
    (void)state;
    for (size_t i = 0; i < api_record_count(); i++) {
        const api_record *r = api_record_at(i);
        for (size_t k = 0; k < r->count; k++) {
            if (!api_field_fits(&r->fields[k])) {
                fail_msg("%s: %s is no %s", r->schema, r->fields[k].name, r->fields[k].type);
            }
        }
    }
}

static void each_table_is_a_schema_of_the_description(void **state)
{
    (void)state;
    size_t found = 0;
    for (const api_member *row = api_answer_members; row->schema != NULL; row++) {
        if (row->name == NULL) {
            assert_non_null(api_record_find(row->schema));
            found++;
        } else {
            assert_null(api_record_find(row->schema));
        }
    }
    assert_int_equal(found, api_record_count());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_type_is_written_as_json_has_it),
        cmocka_unit_test(a_member_without_a_value_is_null_or_left_out),
        cmocka_unit_test(a_value_of_another_type_is_refused),
        cmocka_unit_test(each_row_of_the_api_fits_its_schema),
        cmocka_unit_test(each_table_is_a_schema_of_the_description),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
