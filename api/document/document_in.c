#include "api/document/document_in.h"

#include "api/document/attributes_in.h"
#include "api/json/material_value.h"
#include "api/limits.h"
#include "format/text/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* What is expected next. Within "vertices" and "faces" the same states serve both: `faces` says
 * which list is open. */
typedef enum state {
    EXPECT_OBJECT,       /* the '{' of the document */
    EXPECT_KEY_OR_END,   /* after '{' */
    EXPECT_KEY,          /* after ',' */
    INSIDE_KEY,          /* up to the closing quote */
    EXPECT_COLON,        /* then open_member decides */
    INSIDE_OTHER,        /* a value that is gathered */
    INSIDE_ATTRIBUTES,   /* read by attributes_in.c */
    EXPECT_LIST,         /* the '[' of vertices or faces */
    EXPECT_ITEM_OR_END,  /* after that '[' */
    EXPECT_ITEM,         /* after ',' between items */
    EXPECT_VALUE_OR_END, /* after the '[' of an item */
    EXPECT_VALUE,        /* after ',' within an item */
    INSIDE_NUMBER,       /* a number that a piece cut in two; its text is in `number` */
    AFTER_VALUE,         /* ',' or ']' of an item */
    AFTER_ITEM,          /* ',' or ']' of the list */
    AFTER_MEMBER,        /* ',' or '}' */
    AFTER_DOCUMENT       /* blanks */
} state;

struct api_document_in {
    state state;
    uint64_t offset; /* of the present piece in the body */
    const char *piece, *at, *end;
    api_problem *problem;

    bool faces; /* the open list is "faces", not "vertices" */
    bool has_vertices, has_faces;
    he_soup soup;
    size_t item, part; /* index of the open item, and of the value in it */
    double point[3];

    char number[API_MAX_DOCUMENT_NUMBER];
    size_t number_length;

    char key[API_MAX_KEY + 2]; /* as it stands, with its quotes */
    size_t key_length;
    bool escaped; /* the last byte of a string was a backslash */

    api_attributes_in *attributes; /* NULL without any */

    /* Other members: "{" and then each as it came. */
    api_text rest;
    api_text materials; /* {"materials": and the value; empty without */
    api_text *gathered; /* one of these */
    size_t rest_depth;
    bool rest_string;
    api_document document;
    api_in root;
};

api_document_in *api_document_in_new(const he_limits *limits)
{
    api_document_in *in = he_mem_zero(1, sizeof *in);
    if (in != NULL) {
        he_soup_init(&in->soup, limits);
        in->rest.maximum = API_MAX_CONTROL;
        in->materials.maximum = API_MAX_MATERIALS;
    }
    return in;
}

void api_document_in_free(api_document_in *in)
{
    if (in != NULL) {
        he_soup_clear(&in->soup);
        api_attributes_in_free(in->attributes);
        api_text_clear(&in->rest);
        api_text_clear(&in->materials);
        api_document_clear(&in->document);
        he_mem_free(in);
    }
}

/* --- refusals --- */

static void point(api_document_in *in)
{
    const char *list = in->faces ? "faces" : "vertices";
    switch (in->state) {
    case EXPECT_LIST:
        api_problem_set_pointer(in->problem, "/%s", list);
        break;
    case EXPECT_ITEM_OR_END:
    case EXPECT_ITEM:
    case AFTER_ITEM:
        api_problem_set_pointer(in->problem, "/%s/%zu", list, in->item);
        break;
    case EXPECT_VALUE_OR_END:
    case EXPECT_VALUE:
    case INSIDE_NUMBER:
    case AFTER_VALUE:
        api_problem_set_pointer(in->problem, "/%s/%zu/%zu", list, in->item, in->part);
        break;
    case EXPECT_OBJECT:
    case EXPECT_KEY_OR_END:
    case EXPECT_KEY:
    case INSIDE_KEY:
    case EXPECT_COLON:
    case INSIDE_OTHER:
    case INSIDE_ATTRIBUTES:
    case AFTER_MEMBER:
    case AFTER_DOCUMENT:
        api_problem_set_pointer(in->problem, "%s", "");
        break;
    }
}

static bool refuse(api_document_in *in, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool refuse(api_document_in *in, int code, const char *format, ...)
{
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    api_problem_set(in->problem, code, "byte %llu: %s",
                    (unsigned long long)(in->offset + (uint64_t)(in->at - in->piece)), text);
    point(in);
    return false;
}

static bool refuse_core(api_document_in *in, const he_error *err)
{
    api_problem_set_core(in->problem, err);
    point(in);
    return false;
}

/* --- numbers --- */

static bool is_number_byte(char c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/* A number that ends before `end`. NULL where it is not one, or may go on in the next piece. */
static const char *read_number(const char *at, const char *end, double *value)
{
    size_t used;
    if (he_double_parse(at, end, HE_JSON_NUMBER, value, &used) != HE_OK ||
        used > API_MAX_DOCUMENT_NUMBER) {
        return NULL;
    }
    at += used;
    return at < end && !is_number_byte(*at) ? at : NULL;
}

/* Decimal digits of an index, likewise. Seven digits are enough to be worth the special case, ten
 * could exceed an id. */
static const char *read_index(const char *at, const char *end, uint32_t *value)
{
    uint64_t sum = 0;
    const char *begin = at;
    while (at < end && *at >= '0' && *at <= '9') {
        sum = sum * 10 + (uint64_t)(*at - '0');
        at++;
        if (at - begin > 10) {
            return NULL;
        }
    }
    if (at == begin || at == end || is_number_byte(*at) || (*begin == '0' && at - begin > 1) ||
        sum >= HE_DEAD) {
        return NULL;
    }
    *value = (uint32_t)sum;
    return at;
}

/* --- whole items, where a piece holds them --- */

static const char *skip(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) {
        at++;
    }
    return at;
}

/* "[x,y,z]" at `at`: the byte after it, or NULL to let the states look at it one by one. */
static const char *try_vertex(const char *at, const char *end, he_vec3 *out)
{
    double values[3];
    for (int i = 0; i < 3; i++) {
        at = skip(at + 1, end);
        at = at < end ? read_number(at, end, &values[i]) : NULL;
        if (at == NULL) {
            return NULL;
        }
        at = skip(at, end);
        if (at == end || *at != (i < 2 ? ',' : ']')) {
            return NULL;
        }
    }
    *out = (he_vec3){values[0], values[1], values[2]};
    return at + 1;
}

enum { TRY_CORNERS = 16 };

static const char *try_face(const char *at, const char *end, uint32_t corners[TRY_CORNERS],
                            size_t *count)
{
    for (size_t i = 0; i < TRY_CORNERS; i++) {
        at = skip(at + 1, end);
        at = at < end ? read_index(at, end, &corners[i]) : NULL;
        if (at == NULL) {
            return NULL;
        }
        at = skip(at, end);
        if (at == end || (*at != ',' && *at != ']')) {
            return NULL;
        }
        if (*at == ']') {
            *count = i + 1;
            return at + 1;
        }
    }
    return NULL;
}

/* --- items value by value --- */

static bool begin_item(api_document_in *in)
{
    he_error err;
    if (in->faces && he_soup_begin_face(&in->soup, &err) != HE_OK) {
        return refuse_core(in, &err);
    }
    in->part = 0;
    in->state = EXPECT_VALUE_OR_END;
    return true;
}

/* At the '[' of an item: take it whole where possible, else let the states have it. */
static bool open_item(api_document_in *in)
{
    he_error err;
    const char *next;
    he_status status = HE_OK;
    if (in->faces) {
        uint32_t corners[TRY_CORNERS];
        size_t count = 0;
        next = try_face(in->at, in->end, corners, &count);
        if (next != NULL) {
            status = he_soup_add_face(&in->soup, corners, count, &err);
        }
    } else {
        he_vec3 position;
        next = try_vertex(in->at, in->end, &position);
        if (next != NULL) {
            status = he_soup_add_vertex(&in->soup, position, &err);
        }
    }
    if (next == NULL) {
        in->at++;
        return begin_item(in);
    }
    if (status != HE_OK) {
        return refuse_core(in, &err);
    }
    in->at = next;
    in->state = AFTER_ITEM;
    return true;
}

static bool end_item(api_document_in *in)
{
    if (!in->faces) {
        he_error err;
        if (in->part != 3) {
            in->state = EXPECT_ITEM;
            return refuse(in, HE_BAD_VALUE, "a vertex has three coordinates, this one has %zu",
                          in->part);
        }
        he_vec3 position = {in->point[0], in->point[1], in->point[2]};
        if (he_soup_add_vertex(&in->soup, position, &err) != HE_OK) {
            return refuse_core(in, &err);
        }
    }
    in->state = AFTER_ITEM;
    return true;
}

static bool add_corner(api_document_in *in, double value)
{
    he_error err;
    if (value < 0 || value != floor(value)) {
        return refuse(in, HE_BAD_VALUE, "a corner is the index of a vertex, a whole number from 0");
    }
    if (value >= HE_DEAD) {
        return refuse(in, HE_BAD_INDEX, "the index is beyond the vertices");
    }
    return he_soup_add_corner(&in->soup, (uint32_t)value, &err) == HE_OK || refuse_core(in, &err);
}

static bool add_value(api_document_in *in, const char *text, size_t length)
{
    double value;
    size_t used;
    he_status status = he_double_parse(text, text + length, HE_JSON_NUMBER, &value, &used);
    if (status == HE_NOT_FINITE && used == length) {
        return refuse(in, HE_NOT_FINITE, "the number does not fit a double");
    }
    if (status != HE_OK || used != length) {
        return refuse(in, API_MALFORMED_JSON, "this is not a JSON number");
    }
    if (in->faces) {
        if (!add_corner(in, value)) {
            return false;
        }
    } else if (in->part < 3) {
        in->point[in->part] = value;
    } else {
        in->state = EXPECT_ITEM;
        return refuse(in, HE_BAD_VALUE, "a vertex has three coordinates, this one has more");
    }
    in->state = AFTER_VALUE;
    return true;
}

/* Gather the text of a number over as many pieces as it takes. */
static bool gather_number(api_document_in *in)
{
    while (in->at < in->end && is_number_byte(*in->at)) {
        if (in->number_length == sizeof in->number) {
            return refuse(in, HE_BAD_VALUE, "the number has more than %zu characters",
                          sizeof in->number);
        }
        in->number[in->number_length++] = *in->at++;
    }
    return in->at == in->end || add_value(in, in->number, in->number_length);
}

static bool open_value(api_document_in *in)
{
    if (*in->at == '-' || (*in->at >= '0' && *in->at <= '9')) {
        in->number_length = 0;
        in->state = INSIDE_NUMBER;
        return gather_number(in);
    }
    bool other = strchr("\"{[tfn", *in->at) != NULL && *in->at != '\0';
    return refuse(in, other ? API_WRONG_TYPE : API_MALFORMED_JSON, "a number is expected here");
}

/* --- members --- */

static bool add_rest(api_document_in *in, const char *bytes, size_t length)
{
    api_text *text = in->gathered;
    if (length > text->maximum - text->length) {
        return refuse(in, HE_LIMIT, "%s exceed %zu bytes",
                      text == &in->rest ? "members besides vertices and faces" : "materials",
                      text->maximum);
    }
    api_text_add(text, bytes, length);
    return !text->failed || refuse(in, HE_NO_MEMORY, "no memory for the document");
}

static bool key_is(const api_document_in *in, const char *name)
{
    size_t length = strlen(name);
    return in->key_length == length + 2 && memcmp(in->key + 1, name, length) == 0;
}

/* Which list the key names, by its first letter: 'v', 'f', 'a', 'm' or 0. A key may be spelled with
 * escapes. */
static bool find_list(api_document_in *in, char *list)
{
    static const char *const lists[] = {"vertices", "faces", "attributes", "materials"};
    enum { LISTS = sizeof lists / sizeof *lists };
    *list = '\0';
    if (memchr(in->key, '\\', in->key_length) == NULL) {
        for (size_t i = 0; i < LISTS; i++) {
            *list = key_is(in, lists[i]) ? lists[i][0] : *list;
        }
        return true;
    }
    api_document document = {0};
    api_in root;
    api_in_limits limits = {.values = 1, .no_offsets = true};
    const char *name = "";
    bool good =
        api_document_parse(in->key, in->key_length, &limits, &document, &root, in->problem) &&
        api_in_string(&root, API_MAX_KEY, &name);
    for (size_t i = 0; good && i < LISTS; i++) {
        *list = strcmp(name, lists[i]) == 0 ? lists[i][0] : *list;
    }
    api_document_clear(&document);
    return good;
}

/* Reads the name of a member; the value that follows is collected. */
static bool begin_other(api_document_in *in, const char *key, size_t length)
{
    in->state = INSIDE_OTHER;
    in->rest_depth = 0;
    in->rest_string = false;
    in->escaped = false;
    return add_rest(in, key, length) && add_rest(in, ":", 1);
}

static bool open_member(api_document_in *in)
{
    char list;
    if (!find_list(in, &list)) {
        return false;
    }
    if (list == 'a') {
        if (in->attributes != NULL) {
            return refuse(in, API_DUPLICATE_MEMBER, "\"attributes\" is given twice");
        }
        in->attributes = api_attributes_in_new();
        in->state = INSIDE_ATTRIBUTES;
        return in->attributes != NULL || refuse(in, HE_NO_MEMORY, "no memory for the document");
    }
    if (list == 'm') {
        in->gathered = &in->materials;
        return in->materials.length == 0
                   ? begin_other(in, "{\"materials\"", strlen("{\"materials\""))
                   : refuse(in, API_DUPLICATE_MEMBER, "\"materials\" is given twice");
    }
    if (list != '\0') {
        bool *has = list == 'f' ? &in->has_faces : &in->has_vertices;
        in->faces = list == 'f';
        in->item = 0;
        in->state = EXPECT_LIST;
        if (*has) {
            return refuse(in, API_DUPLICATE_MEMBER, "\"%s\" is given twice",
                          list == 'f' ? "faces" : "vertices");
        }
        *has = true;
        return true;
    }
    in->gathered = &in->rest;
    return add_rest(in, in->rest.length == 0 ? "{" : ",", 1) &&
           begin_other(in, in->key, in->key_length);
}

static bool gather_key(api_document_in *in)
{
    while (in->at < in->end) {
        char c = *in->at;
        if (in->key_length == sizeof in->key) {
            return refuse(in, API_UNKNOWN_MEMBER, "no member has a name of more than %d bytes",
                          API_MAX_KEY);
        }
        in->key[in->key_length++] = c;
        in->at++;
        if (c == '"' && !in->escaped) {
            in->state = EXPECT_COLON;
            return true;
        }
        in->escaped = c == '\\' && !in->escaped;
    }
    return true;
}

/* Find where the value ends; whether it is well formed is seen when all is parsed. */
static bool gather_other(api_document_in *in)
{
    const char *begin = in->at;
    while (in->at < in->end) {
        char c = *in->at;
        if (in->rest_string) {
            in->rest_string = c != '"' || in->escaped;
            in->escaped = c == '\\' && !in->escaped;
        } else if (c == '"') {
            in->rest_string = true;
        } else if (c == '{' || c == '[') {
            in->rest_depth++;
        } else if (in->rest_depth == 0 && (c == ',' || c == '}' || c == ']')) {
            in->state = AFTER_MEMBER;
            break;
        } else if (c == '}' || c == ']') {
            in->rest_depth--;
        }
        in->at++;
    }
    return add_rest(in, begin, (size_t)(in->at - begin));
}

/* --- the states --- */

static bool expected(api_document_in *in, const char *what)
{
    return refuse(in, API_MALFORMED_JSON, "%s is expected here", what);
}

/* In a place that wants '[': a value of another type is not malformed. */
static bool expected_array(api_document_in *in, const char *what)
{
    char c = *in->at;
    bool other = (c != '\0' && strchr("\"{tfn-", c) != NULL) || (c >= '0' && c <= '9');
    return refuse(in, other ? API_WRONG_TYPE : API_MALFORMED_JSON, "%s is expected here", what);
}

/* One token; blanks were skipped and there is a byte. */
static bool step(api_document_in *in)
{
    char c = *in->at;
    switch (in->state) {
    case EXPECT_OBJECT:
        if (c != '{') {
            return expected(in, "the '{' of a mesh document");
        }
        in->state = EXPECT_KEY_OR_END;
        break;
    case EXPECT_KEY_OR_END:
    case EXPECT_KEY:
        if (c == '}' && in->state == EXPECT_KEY_OR_END) {
            in->state = AFTER_DOCUMENT;
            break;
        }
        if (c != '"') {
            return expected(in, "a member's name in quotes");
        }
        in->key[0] = c;
        in->key_length = 1;
        in->escaped = false;
        in->state = INSIDE_KEY;
        break;
    case EXPECT_COLON:
        if (c != ':') {
            return expected(in, "':'");
        }
        in->at++;
        return open_member(in);
    case EXPECT_LIST:
        if (c != '[') {
            return expected_array(in, "an array");
        }
        in->state = EXPECT_ITEM_OR_END;
        break;
    case EXPECT_ITEM_OR_END:
    case EXPECT_ITEM:
        if (c == '[') {
            return open_item(in);
        }
        if (c != ']' || in->state == EXPECT_ITEM) {
            return expected_array(in, in->faces ? "an array of indices" : "an array [x,y,z]");
        }
        in->state = AFTER_MEMBER;
        break;
    case EXPECT_VALUE_OR_END:
        if (c != ']') {
            return open_value(in);
        }
        in->at++;
        return end_item(in);
    case EXPECT_VALUE:
        return open_value(in);
    case AFTER_VALUE:
        in->part++;
        in->at++;
        if (c == ']') {
            return end_item(in);
        }
        in->state = EXPECT_VALUE;
        if (c != ',') {
            in->at--;
            return expected(in, "',' or ']'");
        }
        return true;
    case AFTER_ITEM:
        in->item++;
        in->state = EXPECT_ITEM;
        if (c == ']') {
            in->state = AFTER_MEMBER;
        } else if (c != ',') {
            return expected(in, "',' or ']'");
        }
        break;
    case AFTER_MEMBER:
        if (c == '}') {
            in->state = AFTER_DOCUMENT;
        } else if (c == ',') {
            in->state = EXPECT_KEY;
        } else {
            return expected(in, "',' or '}'");
        }
        break;
    case AFTER_DOCUMENT:
        return refuse(in, API_MALFORMED_JSON, "something follows the document");
    case INSIDE_KEY:
    case INSIDE_OTHER:
    case INSIDE_ATTRIBUTES:
    case INSIDE_NUMBER:
        break; /* gathered by run */
    }
    in->at++;
    return true;
}

static bool gather_attributes(api_document_in *in)
{
    bool done;
    if (!api_attributes_in_feed(in->attributes, &in->at, in->end, &done, in->problem)) {
        return false;
    }
    if (done) {
        in->state = AFTER_MEMBER;
    }
    return true;
}

static bool run(api_document_in *in)
{
    while (in->at < in->end) {
        bool good;
        if (in->state == INSIDE_KEY) {
            good = gather_key(in);
        } else if (in->state == INSIDE_OTHER) {
            good = gather_other(in);
        } else if (in->state == INSIDE_ATTRIBUTES) {
            good = gather_attributes(in);
        } else if (in->state == INSIDE_NUMBER) {
            good = gather_number(in);
        } else {
            in->at = skip(in->at, in->end);
            good = in->at == in->end || step(in);
        }
        if (!good) {
            return false;
        }
    }
    return true;
}

bool api_document_in_feed(api_document_in *in, const char *bytes, size_t length,
                          api_problem *problem)
{
    if (length == 0) {
        return true;
    }
    in->problem = problem;
    in->piece = in->at = bytes;
    in->end = bytes + length;
    bool good = run(in);
    in->offset += length;
    in->piece = in->at = in->end = NULL;
    return good;
}

static bool read_materials(api_document_in *in, api_problem *problem)
{
    api_document document = {0};
    api_in root, list;
    api_in_limits limits = {.values = API_MAX_CONTROL_VALUES, .no_offsets = true};
    if (in->materials.length == 0) {
        return true;
    }
    in->gathered = &in->materials;
    bool good = add_rest(in, "}", 1) &&
                api_document_parse(in->materials.bytes, in->materials.length, &limits, &document,
                                   &root, problem) &&
                api_in_need(&root, "materials", &list) &&
                api_read_materials(&list, &in->soup.materials);
    api_document_clear(&document);
    return good;
}

bool api_document_in_end(api_document_in *in, api_problem *problem)
{
    in->problem = problem;
    if (in->state != AFTER_DOCUMENT) {
        return refuse(in, API_MALFORMED_JSON, "the body ends within the document");
    }
    if (!read_materials(in, problem)) {
        return false;
    }
    in->gathered = &in->rest;
    if (!add_rest(in, in->rest.length == 0 ? "{}" : "}", in->rest.length == 0 ? 2 : 1)) {
        return false;
    }
    api_in_limits limits = {.values = API_MAX_CONTROL_VALUES, .no_offsets = true};
    return api_document_parse(in->rest.bytes, in->rest.length, &limits, &in->document, &in->root,
                              problem);
}

he_soup *api_document_in_soup(api_document_in *in)
{
    return &in->soup;
}
bool api_document_in_has_vertices(const api_document_in *in)
{
    return in->has_vertices;
}
bool api_document_in_has_faces(const api_document_in *in)
{
    return in->has_faces;
}
bool api_document_in_lend(api_document_in *in, api_problem *problem)
{
    return in->attributes == NULL ||
           api_attributes_in_to_soup(in->attributes, api_document_in_soup(in), problem);
}
bool api_document_in_attributes(api_document_in *in, he_mesh *mesh, bool repaired,
                                api_problem *problem)
{
    if (in->attributes == NULL) {
        return true;
    }
    return (!repaired || api_attributes_in_repaired(in->attributes, problem)) &&
           api_attributes_in_apply(in->attributes, mesh, problem);
}
bool api_document_in_has_edges(const api_document_in *in)
{
    return in->attributes != NULL && api_attributes_in_has_edges(in->attributes);
}
const api_in *api_document_in_rest(const api_document_in *in)
{
    return &in->root;
}
