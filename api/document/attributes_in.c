#include "api/document/attributes_in.h"

#include "api/document/attribute_path.h"
#include "api/json/attribute_value.h"
#include "api/limits.h"
#include "edit/whole/attribute.h"

#include <math.h>
#include <string.h>

/* How deep in the document the lexer is: the number of arrays and objects around the value that is
 * read. */
enum {
    IN_DOCUMENT = 1, /* in the object of the document itself, which has the member "attributes" */
    IN_LIST,
    IN_OBJECT,
    IN_VALUES,
    IN_ROW
};

/* One attribute that was read: a column (the array of an attribute's values) that is not filled
 * yet, and the values for it. */
typedef struct item {
    he_column *column;
    unsigned char *values;
    size_t count;
    bool has_values;
} item;

struct api_attributes_in {
    api_problem *problem;
    item items[API_MAX_ATTRIBUTES];
    size_t count;

    /* --- members about the attribute that is being read --- */
    api_members head; /* the text of all members but "values" */
    bool has_values;
    /* has_words: true if the values include true or false. has_numbers: true if the values include
     * a number. */
    bool has_words, has_numbers;
    double *numbers;
    size_t number_count, number_capacity;
    /* rows: number of complete values. width: how many numbers each value has, 0 if values are not
     * arrays. column: how many numbers of the present value were read. */
    size_t rows, width, column;
};

api_attributes_in *api_attributes_in_new(void)
{
    api_attributes_in *in = he_mem_zero(1, sizeof *in);
    if (in != NULL) {
        in->head.what = "all members of the attribute except \"values\"";
        in->head.most = API_MAX_EDITS;
        in->head.values_most = API_MAX_EDITS_VALUES;
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
        api_members_clear(&in->head);
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

/* --- values of an attribute --- */

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

static bool end_value(api_attributes_in *in, bool row)
{
    size_t width = row ? in->column : 0;
    if (in->rows == 0) {
        in->width = width;
    }
    if (width != in->width) {
        return refuse_value(in, in->rows, HE_BAD_VALUE,
                            "the value does not have as many components as the values before it");
    }
    in->rows++;
    in->column = 0;
    return true;
}

/* Handles the token of a number, true or false: a value of the attribute, or one component of a
 * value. */
static bool take_value(api_attributes_in *in, const he_lexer *x, he_token token)
{
    double value = token == HE_TOKEN_NUMBER ? x->number : token == HE_TOKEN_TRUE;
    if (token == HE_TOKEN_NULL) {
        return refuse_value(in, in->rows, API_WRONG_TYPE,
                            "a value must be a number, true or false");
    }
    in->has_numbers |= token == HE_TOKEN_NUMBER;
    in->has_words |= token != HE_TOKEN_NUMBER;
    return add_number(in, value) && (x->depth == IN_ROW || end_value(in, false));
}

static bool take_row(api_attributes_in *in, const double *row, size_t count)
{
    in->has_numbers = true;
    for (size_t i = 0; i < count; i++) {
        if (!add_number(in, row[i])) {
            return false;
        }
    }
    return end_value(in, true);
}

/* --- the end of an attribute's object --- */

/* Converts a double to the type of a column's values and writes it to `row`, the memory of one
 * value. */
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
        return refuse_value(in, 0, HE_BAD_VALUE,
                            "the values do not have as many components as \"components\" says");
    }
    if (words ? in->has_numbers : in->has_words) {
        return refuse_value(
            in, 0, API_WRONG_TYPE,
            words ? "values of a bool must be true or false"
                  : "only an attribute of type bool may have the values true and false");
    }
    out->values = he_mem_array(NULL, in->number_count + 1, size);
    if (out->values == NULL) {
        return no_memory(in);
    }
    for (size_t i = 0; i < in->number_count; i++) {
        if (!pack_number(column, in->numbers[i], out->values + i * size)) {
            return refuse_value(in, i / column->components, HE_BAD_VALUE,
                                "the number is out of range for the type of the attribute");
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
            return api_in_fail(&member, HE_BAD_VALUE, "attribute \"%s\" of %s is given twice", name,
                               he_kind_plural(other->domain));
        }
    }
    return api_read_column(root, (he_kind)domain, name, &out->column);
}

/* Puts the JSON pointer of the attribute before the JSON pointer of a refusal. The members other
 * than "values" are parsed as a separate document, so pointers into them begin at the attribute's
 * object. */
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
    item *out = &in->items[in->count];
    bool good =
        api_members_parse(&in->head, &document, &root, in->problem) && read_head(in, &root, out);
    if (!good) {
        prefix_pointer(in);
    }
    good = good && pack(in, out);
    api_document_clear(&document);
    api_members_empty(&in->head);
    he_mem_free(in->numbers);
    in->numbers = NULL;
    in->number_count = in->number_capacity = in->rows = 0;
    in->has_values = in->has_words = in->has_numbers = false;
    in->count += good;
    return good;
}

/* --- handling tokens --- */

static bool is_value_byte(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '+' || c == '.' ||
           c == 'E';
}

static bool expect_value(api_attributes_in *in, char c)
{
    bool other = c == '"' || c == '{' || c == '[';
    return is_value_byte(c) ||
           refuse_value(in, in->rows, other ? API_WRONG_TYPE : API_MALFORMED_JSON,
                        "the value must be a number, true or false");
}

bool api_attributes_in_expect(api_attributes_in *in, he_lexer *x, bool *taken, api_problem *problem)
{
    char c = *x->at;
    double row[HE_COLUMN_COMPONENTS];
    in->problem = problem;
    switch (x->depth) {
    case IN_DOCUMENT:
        return c == '[' || refuse(in, API_WRONG_TYPE, "\"attributes\" must be an array of objects");
    case IN_LIST:
        return c == '{' ? in->count < API_MAX_ATTRIBUTES ||
                              refuse(in, HE_LIMIT, "there are too many attributes")
                        : refuse(in, API_WRONG_TYPE, "an attribute must be an object");
    case IN_OBJECT:
        return c == '[' || refuse(in, API_WRONG_TYPE, "\"values\" must be an array");
    case IN_VALUES: {
        if (c != '[') {
            return expect_value(in, c);
        }
        size_t count = he_lexer_take_numbers(x, row, HE_COLUMN_COMPONENTS);
        *taken = count > 0;
        return count == 0 || take_row(in, row, count);
    }
    default:
        return in->column < HE_COLUMN_COMPONENTS
                   ? expect_value(in, c)
                   : refuse_value(in, in->rows, HE_BAD_VALUE,
                                  "a value may have at most 16 components");
    }
}

static bool take_key(api_attributes_in *in, const he_lexer *x, api_members **into)
{
    static const char values[] = "values";
    const he_lexer_frame *object = &x->frames[x->depth - 1];
    if (object->name_length != sizeof values - 1 ||
        memcmp(object->name, values, sizeof values - 1) != 0) {
        *into = &in->head;
        return true;
    }
    if (in->has_values) {
        return refuse(in, API_DUPLICATE_MEMBER, "\"values\" is given twice");
    }
    in->has_values = true;
    return true;
}

static bool take_close(api_attributes_in *in, const he_lexer *x)
{
    switch (x->depth) {
    case IN_VALUES:
        return in->column > 0 ? end_value(in, true) : expect_value(in, ']');
    case IN_LIST:
        return end_object(in);
    default:
        return true;
    }
}

bool api_attributes_in_take(api_attributes_in *in, he_lexer *x, he_token token, api_members **into,
                            api_problem *problem)
{
    in->problem = problem;
    if (token == HE_TOKEN_KEY) {
        return take_key(in, x, into);
    }
    if (token == HE_TOKEN_CLOSE) {
        return take_close(in, x);
    }
    return token == HE_TOKEN_ARRAY || token == HE_TOKEN_OBJECT || take_value(in, x, token);
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
                            "the repairs change edges, so the attribute's values of %s would be "
                            "lost: leave out the repairs or the attribute",
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
            /* api_attributes_in_to_soup has moved the column into the soup of the document. */
            continue;
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
