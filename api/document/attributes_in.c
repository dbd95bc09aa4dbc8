#include "api/document/attributes_in.h"

#include "api/document/attribute_path.h"
#include "api/json/attribute_value.h"
#include "api/limits.h"
#include "edit/whole/attribute.h"
#include "format/text/number.h"

#include <math.h>
#include <string.h>

/* What is expected next. */
typedef enum state {
    EXPECT_ARRAY,
    EXPECT_OBJECT_OR_END,
    EXPECT_OBJECT,
    EXPECT_KEY_OR_END,
    EXPECT_KEY,
    INSIDE_KEY,
    EXPECT_COLON,
    INSIDE_OTHER, /* a value that is gathered */
    EXPECT_VALUES,
    EXPECT_VALUE_OR_END,
    EXPECT_VALUE,
    EXPECT_NUMBER, /* within a value that is an array */
    INSIDE_TOKEN,  /* a number or word */
    AFTER_NUMBER,  /* within a value that is an array */
    AFTER_VALUE,
    AFTER_MEMBER,
    AFTER_OBJECT
} state;

/* One that was read: a column without rows, and its values, packed. */
typedef struct item {
    he_column *column;
    unsigned char *values;
    size_t count;
    bool has_values;
} item;

struct api_attributes_in {
    state state;
    api_problem *problem;
    item items[API_MAX_ATTRIBUTES];
    size_t count;

    /* --- of the open object --- */
    api_text head; /* "{" and then each member but "values" as it came */
    size_t depth;
    bool in_string, escaped;
    char key[API_MAX_KEY + 2];
    size_t key_length;
    bool has_values, is_row;
    bool has_words, has_numbers; /* among the values */
    double *numbers;
    size_t number_count, number_capacity;
    size_t rows, width, column; /* whole values; numbers of one, 0 where it is none; of this one */
    char token[API_MAX_DOCUMENT_NUMBER];
    size_t token_length;
};

api_attributes_in *api_attributes_in_new(void)
{
    api_attributes_in *in = he_mem_zero(1, sizeof *in);
    if (in != NULL) {
        in->head.maximum = API_MAX_EDITS;
    }
    return in;
}

void api_attributes_in_free(api_attributes_in *in)
{
    if (in != NULL) {
        for (size_t i = 0; i < API_MAX_ATTRIBUTES; i++) {
            he_column_free(in->items[i].column);
            he_mem_free(in->items[i].values);
        }
        api_text_clear(&in->head);
        he_mem_free(in->numbers);
        he_mem_free(in);
    }
}

/* --- refusals --- */

static bool refuse(api_attributes_in *in, int code, const char *text)
{
    api_problem_set(in->problem, code, "%s", text);
    api_problem_set_pointer(in->problem, "/attributes/%zu", in->count);
    return false;
}

static bool refuse_value(api_attributes_in *in, size_t row, int code, const char *text)
{
    api_problem_set(in->problem, code, "%s", text);
    api_problem_set_pointer(in->problem, "/attributes/%zu/values/%zu", in->count, row);
    return false;
}

static bool no_memory(api_attributes_in *in)
{
    return refuse(in, HE_NO_MEMORY, "no memory for the attributes");
}

/* --- values --- */

static bool add_number(api_attributes_in *in, double value)
{
    if (in->number_count == in->number_capacity) {
        size_t capacity = he_mem_grown(in->number_capacity, in->number_count + 1);
        double *grown = he_mem_array(in->numbers, capacity, sizeof *grown);
        if (grown == NULL) {
            return no_memory(in);
        }
        in->numbers = grown;
        in->number_capacity = capacity;
    }
    in->numbers[in->number_count++] = value;
    in->column++;
    return true;
}

static bool is_token(const api_attributes_in *in, const char *word)
{
    return in->token_length == strlen(word) && memcmp(in->token, word, in->token_length) == 0;
}

static bool end_value(api_attributes_in *in)
{
    size_t width = in->is_row ? in->column : 0;
    if (in->rows == 0) {
        in->width = width;
    }
    if (width != in->width) {
        return refuse_value(in, in->rows, HE_BAD_VALUE,
                            "the value has another number of components than those before");
    }
    in->rows++;
    in->state = AFTER_VALUE;
    return true;
}

static bool end_token(api_attributes_in *in)
{
    double value;
    size_t used;
    if (is_token(in, "true") || is_token(in, "false")) {
        in->has_words = true;
        value = is_token(in, "true");
    } else {
        const char *end = in->token + in->token_length;
        he_status status = he_double_parse(in->token, end, HE_JSON_NUMBER, &value, &used);
        if (status == HE_NOT_FINITE && used == in->token_length) {
            return refuse_value(in, in->rows, HE_NOT_FINITE, "the number does not fit a double");
        }
        if (status != HE_OK || used != in->token_length) {
            bool null = is_token(in, "null");
            return refuse_value(in, in->rows, null ? API_WRONG_TYPE : API_MALFORMED_JSON,
                                "a value is a number, true or false");
        }
        in->has_numbers = true;
    }
    if (!add_number(in, value)) {
        return false;
    }
    if (in->is_row) {
        in->state = AFTER_NUMBER;
        return true;
    }
    return end_value(in);
}

static bool is_token_byte(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '+' || c == '.' ||
           c == 'E';
}

static bool gather_token(api_attributes_in *in, const char **at, const char *end)
{
    while (*at < end && is_token_byte(**at)) {
        if (in->token_length == sizeof in->token) {
            return refuse_value(in, in->rows, HE_BAD_VALUE, "the number is too long");
        }
        in->token[in->token_length++] = *(*at)++;
    }
    return *at == end || end_token(in);
}

/* --- an object that has ended --- */

/* From doubles to the rows of a column. */
static bool pack_number(const he_column *column, double value, unsigned char *to)
{
    float single = (float)value;
    uint32_t natural;
    int32_t whole;
    bool good = true;
    switch (column->type) {
    case HE_BOOL:
        *to = value > 0;
        break;
    case HE_INT32:
        good = value >= INT32_MIN && value <= INT32_MAX && floor(value) >= value;
        whole = good ? (int32_t)value : 0;
        memcpy(to, &whole, sizeof whole);
        break;
    case HE_UINT32:
        good = value >= 0 && value <= UINT32_MAX && floor(value) >= value;
        natural = good ? (uint32_t)value : 0;
        memcpy(to, &natural, sizeof natural);
        break;
    case HE_FLOAT:
        good = isfinite(single);
        memcpy(to, &single, sizeof single);
        break;
    case HE_DOUBLE:
        memcpy(to, &value, sizeof value);
        break;
    case HE_TYPE_COUNT:
        break;
    }
    return good;
}

static bool pack(api_attributes_in *in, item *out)
{
    const he_column *column = out->column;
    size_t size = he_type_bytes(column->type), at = 0;
    bool words = column->type == HE_BOOL;
    he_error err = {0};
    if (in->rows > 0 && in->width != (column->components == 1 ? 0 : column->components)) {
        return refuse_value(in, 0, HE_BAD_VALUE, "the values do not have the components said");
    }
    if (words ? in->has_numbers : in->has_words) {
        return refuse_value(in, 0, API_WRONG_TYPE,
                            words ? "values of a bool are true and false"
                                  : "true and false are values of a bool only");
    }
    out->values = he_mem_array(NULL, in->number_count + 1, size);
    if (out->values == NULL) {
        return no_memory(in);
    }
    for (size_t i = 0; i < in->number_count; i++) {
        if (!pack_number(column, in->numbers[i], out->values + i * size)) {
            return refuse_value(in, i / column->components, HE_BAD_VALUE,
                                "the number does not fit the type");
        }
    }
    if (he_attribute_check(column, out->values, in->rows, &at, &err) != HE_OK) {
        return refuse_value(in, at / column->components, (int)err.status, err.text);
    }
    out->count = in->rows;
    out->has_values = in->has_values;
    return true;
}

static bool read_head(api_attributes_in *in, const api_in *root, item *out)
{
    static const char *const members[] = {"domain", "name",    "type",   "components",
                                          "rule",   "default", "labels", NULL};
    static const char *const domains[] = {"vertices", "halfedges", "edges", "faces", "mesh", NULL};
    api_in member;
    const char *name;
    int domain;
    if (!api_in_only(root, members) || !api_in_need(root, "domain", &member) ||
        !api_in_choice(&member, domains, &domain) || !api_in_need(root, "name", &member) ||
        !api_in_string(&member, HE_COLUMN_NAME - 1, &name)) {
        return false;
    }
    if (strcmp(name, API_POSITION) == 0) {
        return api_in_fail(&member, API_RESERVED_NAME, "\"%s\" is built in", name);
    }
    for (size_t i = 0; i < in->count; i++) {
        const he_column *other = in->items[i].column;
        if (other->domain == (he_kind)domain && strcmp(other->name, name) == 0) {
            return api_in_fail(&member, HE_BAD_VALUE, "\"%s\" of %s is given twice", name,
                               he_kind_plural(other->domain));
        }
    }
    return api_read_column(root, (he_kind)domain, name, &out->column);
}

/* The head was parsed by itself: its pointers begin where the object does. */
static void prefix_pointer(api_attributes_in *in)
{
    char inner[API_PROBLEM_POINTER];
    memcpy(inner, in->problem->pointer, sizeof inner);
    api_problem_set_pointer(in->problem, "/attributes/%zu%s", in->count, inner);
}

static bool end_object(api_attributes_in *in)
{
    api_document document = {0};
    api_in root;
    api_in_limits limits = {.values = API_MAX_EDITS_VALUES, .no_offsets = true};
    api_text_add(&in->head, in->head.length == 0 ? "{}" : "}", in->head.length == 0 ? 2 : 1);
    if (in->head.failed) {
        return no_memory(in);
    }
    item *out = &in->items[in->count];
    bool good = api_document_parse(in->head.bytes, in->head.length, &limits, &document, &root,
                                   in->problem) &&
                read_head(in, &root, out);
    if (!good) {
        prefix_pointer(in);
    }
    good = good && pack(in, out);
    api_document_clear(&document);
    api_text_empty(&in->head);
    he_mem_free(in->numbers);
    in->numbers = NULL;
    in->number_count = in->number_capacity = in->rows = 0;
    in->has_values = in->has_words = in->has_numbers = false;
    in->count += good;
    in->state = AFTER_OBJECT;
    return good;
}

/* --- members --- */

static bool add_head(api_attributes_in *in, const char *bytes, size_t length)
{
    if (length > in->head.maximum - in->head.length) {
        return refuse(in, HE_LIMIT, "the members besides the values are too long");
    }
    api_text_add(&in->head, bytes, length);
    return !in->head.failed || no_memory(in);
}

static bool open_member(api_attributes_in *in)
{
    static const char values[] = "\"values\"";
    if (in->key_length == sizeof values - 1 && memcmp(in->key, values, in->key_length) == 0) {
        if (in->has_values) {
            return refuse(in, API_DUPLICATE_MEMBER, "\"values\" is given twice");
        }
        in->has_values = true;
        in->state = EXPECT_VALUES;
        return true;
    }
    in->state = INSIDE_OTHER;
    in->depth = 0;
    in->in_string = in->escaped = false;
    return add_head(in, in->head.length == 0 ? "{" : ",", 1) &&
           add_head(in, in->key, in->key_length) && add_head(in, ":", 1);
}

static bool gather_key(api_attributes_in *in, const char **at, const char *end)
{
    while (*at < end) {
        char c = *(*at)++;
        if (in->key_length == sizeof in->key) {
            return refuse(in, API_UNKNOWN_MEMBER, "no member has so long a name");
        }
        in->key[in->key_length++] = c;
        if (c == '"' && !in->escaped) {
            in->state = EXPECT_COLON;
            return true;
        }
        in->escaped = c == '\\' && !in->escaped;
    }
    return true;
}

/* Find where the value ends; whether it is well formed is seen when the object is parsed. */
static bool gather_other(api_attributes_in *in, const char **at, const char *end)
{
    const char *begin = *at;
    for (; *at < end; (*at)++) {
        char c = **at;
        if (in->in_string) {
            in->in_string = c != '"' || in->escaped;
            in->escaped = c == '\\' && !in->escaped;
        } else if (c == '"') {
            in->in_string = true;
        } else if (c == '{' || c == '[') {
            in->depth++;
        } else if (in->depth == 0 && (c == ',' || c == '}' || c == ']')) {
            in->state = AFTER_MEMBER;
            break;
        } else if (c == '}' || c == ']') {
            in->depth--;
        }
    }
    return add_head(in, begin, (size_t)(*at - begin));
}

/* --- the states --- */

static bool expected(api_attributes_in *in, const char *text)
{
    return refuse(in, API_MALFORMED_JSON, text);
}

static bool open_value(api_attributes_in *in, char c)
{
    in->token_length = 0;
    if (!is_token_byte(c)) {
        bool other = c == '"' || c == '{' || c == '[';
        return refuse_value(in, in->rows, other ? API_WRONG_TYPE : API_MALFORMED_JSON,
                            "a number, true or false is expected");
    }
    in->state = INSIDE_TOKEN;
    return true;
}

/* One token; blanks were skipped. True with *take where the byte is used up. */
static bool step(api_attributes_in *in, char c, bool *take, bool *done)
{
    *take = true;
    switch (in->state) {
    case EXPECT_ARRAY:
        if (c != '[') {
            return refuse(in, API_WRONG_TYPE, "attributes are an array of objects");
        }
        in->state = EXPECT_OBJECT_OR_END;
        return true;
    case EXPECT_OBJECT_OR_END:
    case EXPECT_OBJECT:
        if (c == ']' && in->state == EXPECT_OBJECT_OR_END) {
            *done = true;
            return true;
        }
        if (c != '{') {
            return refuse(in, API_WRONG_TYPE, "an attribute is an object");
        }
        if (in->count == API_MAX_ATTRIBUTES) {
            return refuse(in, HE_LIMIT, "there are too many attributes");
        }
        in->state = EXPECT_KEY_OR_END;
        return true;
    case EXPECT_KEY_OR_END:
    case EXPECT_KEY:
        if (c == '}' && in->state == EXPECT_KEY_OR_END) {
            return end_object(in);
        }
        if (c != '"') {
            return expected(in, "a member's name in quotes is expected");
        }
        in->key[0] = c;
        in->key_length = 1;
        in->escaped = false;
        in->state = INSIDE_KEY;
        return true;
    case EXPECT_COLON:
        return c == ':' ? open_member(in) : expected(in, "':' is expected");
    case EXPECT_VALUES:
        in->state = EXPECT_VALUE_OR_END;
        return c == '[' || refuse(in, API_WRONG_TYPE, "values are an array");
    case EXPECT_VALUE_OR_END:
    case EXPECT_VALUE:
        if (c == ']' && in->state == EXPECT_VALUE_OR_END) {
            in->state = AFTER_MEMBER;
            return true;
        }
        in->column = 0;
        in->is_row = c == '[';
        if (in->is_row) {
            in->state = EXPECT_NUMBER;
            return true;
        }
        *take = false;
        return open_value(in, c);
    case EXPECT_NUMBER:
        *take = false;
        return open_value(in, c);
    case AFTER_NUMBER:
        if (c == ',') {
            in->state = EXPECT_NUMBER;
            return in->column < HE_COLUMN_COMPONENTS ||
                   refuse_value(in, in->rows, HE_BAD_VALUE, "a value has at most 16 components");
        }
        return c == ']' ? end_value(in) : expected(in, "',' or ']' is expected");
    case AFTER_VALUE:
        in->state = c == ',' ? EXPECT_VALUE : AFTER_MEMBER;
        return c == ',' || c == ']' || expected(in, "',' or ']' is expected");
    case AFTER_MEMBER:
        if (c == '}') {
            return end_object(in);
        }
        in->state = EXPECT_KEY;
        return c == ',' || expected(in, "',' or '}' is expected");
    case AFTER_OBJECT:
        *done = c == ']';
        in->state = EXPECT_OBJECT;
        return *done || c == ',' || expected(in, "',' or ']' is expected");
    case INSIDE_KEY:
    case INSIDE_OTHER:
    case INSIDE_TOKEN:
        break; /* gathered by api_attributes_in_feed */
    }
    return true;
}

bool api_attributes_in_feed(api_attributes_in *in, const char **at, const char *end, bool *done,
                            api_problem *problem)
{
    in->problem = problem;
    *done = false;
    while (*at < end && !*done) {
        bool good, take;
        if (in->state == INSIDE_KEY) {
            good = gather_key(in, at, end);
        } else if (in->state == INSIDE_OTHER) {
            good = gather_other(in, at, end);
        } else if (in->state == INSIDE_TOKEN) {
            good = gather_token(in, at, end);
        } else if (**at == ' ' || **at == '\n' || **at == '\r' || **at == '\t') {
            (*at)++;
            good = true;
        } else {
            good = step(in, **at, &take, done);
            *at += good && take;
        }
        if (!good) {
            return false;
        }
    }
    return true;
}

static bool goes_with_edges(const item *one)
{
    he_kind domain = one->column == NULL ? HE_VERTEX : one->column->domain;
    return one->has_values && (domain == HE_EDGE || domain == HE_HALFEDGE);
}

bool api_attributes_in_has_edges(const api_attributes_in *in)
{
    size_t i = 0;
    while (i < in->count && !goes_with_edges(&in->items[i])) {
        i++;
    }
    return i < in->count;
}

static bool check_count(const item *one, size_t i, size_t count, api_problem *problem)
{
    if (one->count == count) {
        return true;
    }
    api_problem_set(problem, HE_BAD_VALUE, "%zu values are given for %zu %s", one->count, count,
                    he_kind_plural(one->column->domain));
    problem->status = 422;
    api_problem_set_pointer(problem, "/attributes/%zu/values", i);
    return false;
}

bool api_attributes_in_to_soup(api_attributes_in *in, he_soup *soup, api_problem *problem)
{
    for (size_t i = 0; i < in->count; i++) {
        item *one = &in->items[i];
        he_error err = {0};
        bool of_faces = one->column->domain == HE_FACE;
        if (!one->has_values || (!of_faces && one->column->domain != HE_VERTEX)) {
            continue;
        }
        if (!check_count(one, i, of_faces ? soup->face_count : soup->vertex_count, problem)) {
            return false;
        }
        one->column->data = one->values;
        one->column->rows = one->column->capacity = one->count;
        one->values = NULL;
        if (he_soup_take_column(soup, one->column, &err) != HE_OK) {
            return api_problem_set_core(problem, &err);
        }
        one->column = NULL;
    }
    return true;
}

bool api_attributes_in_repaired(const api_attributes_in *in, api_problem *problem)
{
    for (size_t i = 0; i < in->count; i++) {
        const item *one = &in->items[i];
        if (goes_with_edges(one)) {
            api_problem_set(problem, HE_UNSUPPORTED,
                            "values of %s go with edges that the repairs change",
                            he_kind_plural(one->column->domain));
            api_problem_set_pointer(problem, "/attributes/%zu/values", i);
            return false;
        }
    }
    return true;
}

bool api_attributes_in_apply(api_attributes_in *in, he_mesh *mesh, api_problem *problem)
{
    for (size_t i = 0; i < in->count; i++) {
        item *one = &in->items[i];
        he_error err = {0};
        he_status status = HE_OK;
        if (one->column == NULL) {
            continue; /* the soup's */
        }
        if (one->has_values) {
            status = he_attribute_fill(mesh, one->column, one->values, one->count, &err);
        }
        if (status == HE_OK) {
            status = he_attribute_put(mesh, one->column, &err);
        }
        if (status != HE_OK) {
            api_problem_set_core(problem, &err);
            if (status == HE_BAD_VALUE) {
                problem->status = 422;
                api_problem_set_pointer(problem, "/attributes/%zu/values", i);
            }
            return false;
        }
        one->column = NULL;
        he_mem_free(one->values);
        one->values = NULL;
    }
    return true;
}
