#include "api/document/document_in.h"

#include "api/document/attributes_in.h"
#include "api/document/members.h"
#include "api/json/material_value.h"
#include "api/limits.h"
#include "format/text/json_string.h"

#include <math.h>
#include <string.h>

/* The member of the document whose value is being read. */
typedef enum member {
    NO_MEMBER, /* the lexer is between members, or before or after the document */
    VERTICES,
    FACES,
    ATTRIBUTES /* read by attributes_in.c */
} member;

/* How deep in the document the lexer is: the number of arrays and objects around the value that is
 * read. */
enum {
    IN_DOCUMENT = 1,
    IN_LIST, /* in the array "vertices" or "faces" */
    IN_ITEM
};

struct api_document_in {
    he_lexer lexer;
    he_lexer_carry carry;
    api_problem *problem;

    member member;
    bool has_vertices, has_faces;
    he_soup soup;
    size_t part; /* how many numbers of the present vertex or face were read */
    double point[3];

    /* Reads the member "attributes"; NULL if the document has had none so far. */
    api_attributes_in *attributes;
    /* Collects the text of the present member; NULL: the member is not collected. */
    api_members *gathering;
    api_members materials, rest;
    api_document document; /* the members of `rest`, parsed */
    api_in root;
};

_Static_assert(
    (int)API_MAX_DOCUMENT_NUMBER <= (int)HE_JSON_CARRY,
    "the buffer that joins a number cut by two pieces of the body must hold the longest number");
_Static_assert(
    2 * (int)API_MAX_KEY <= (int)HE_JSON_NAMES,
    "the buffer that joins a name cut by two pieces of the body must hold the longest name");

api_document_in *api_document_in_new(const he_limits *limits)
{
    api_document_in *in = he_mem_zero(1, sizeof *in);
    if (in != NULL) {
        he_soup_init(&in->soup, limits);
        he_lexer_init(&in->lexer, &in->carry);
        in->lexer.depth_most = API_MAX_DEPTH;
        in->lexer.number_most = API_MAX_DOCUMENT_NUMBER;
        in->lexer.name_most = API_MAX_KEY;
        in->rest = (api_members){.what = "the members other than \"vertices\" and \"faces\"",
                                 .most = API_MAX_CONTROL,
                                 .values_most = API_MAX_CONTROL_VALUES};
        in->materials = (api_members){
            .what = "materials", .most = API_MAX_MATERIALS, .values_most = API_MAX_CONTROL_VALUES};
    }
    return in;
}

void api_document_in_free(api_document_in *in)
{
    if (in != NULL) {
        he_soup_clear(&in->soup);
        api_attributes_in_free(in->attributes);
        api_members_clear(&in->rest);
        api_members_clear(&in->materials);
        api_document_clear(&in->document);
        he_mem_free(in);
    }
}

/* --- refusals --- */

/* Sets the JSON pointer of the problem to what is being read: to the list of vertices or faces, to
 * an item of the list or to a number of the item, as `depth` says; outside of these lists, to the
 * whole document. */
static bool point(api_document_in *in, size_t depth)
{
    const he_lexer_frame *frames = in->lexer.frames;
    const char *list = in->member == FACES ? "faces" : "vertices";
    if (in->member != VERTICES && in->member != FACES) {
        api_problem_set_pointer(in->problem, "%s", "");
    } else if (depth == IN_DOCUMENT) {
        api_problem_set_pointer(in->problem, "/%s", list);
    } else if (depth == IN_LIST) {
        api_problem_set_pointer(in->problem, "/%s/%zu", list, frames[1].index);
    } else {
        api_problem_set_pointer(in->problem, "/%s/%zu/%zu", list, frames[1].index, frames[2].index);
    }
    return false;
}

/* Refuses the bytes just before the next byte of the lexer; `depth` says whether the list of
 * vertices or faces, an item of the list or a number of the item is refused (see point). */
static bool refuse_in(api_document_in *in, size_t depth, int code, const char *text)
{
    api_json_refuse_at(in->problem, he_lexer_place(&in->lexer), code, "%s", text);
    return point(in, depth);
}

static bool refuse(api_document_in *in, int code, const char *text)
{
    return refuse_in(in, in->lexer.depth, code, text);
}

static bool refuse_core(api_document_in *in, size_t depth, const he_error *err)
{
    api_problem_set_core(in->problem, err);
    return point(in, depth);
}

static bool refuse_fault(api_document_in *in)
{
    he_lexer *x = &in->lexer;
    if (x->fault == HE_FAULT_FOLLOWS) {
        return refuse(in, API_MALFORMED_JSON, "extra text follows the mesh document");
    }
    if (x->fault == HE_FAULT_ITEM) {
        x->frames[x->depth - 1].index++; /* the fault is in the place of the next vertex or face */
    }
    /* A malformed number is refused at the byte where it ends, like a number whose value is not
     * allowed. */
    bool number = x->fault == HE_FAULT_NUMBER || x->fault == HE_FAULT_NOT_FINITE;
    api_json_refuse_fault(x, number ? he_lexer_place(x) : x->fault_place, in->problem);
    bool list = in->member == VERTICES || in->member == FACES;
    return list || x->fault == HE_FAULT_COLON ? point(in, x->depth) : false;
}

/* --- vertices and faces --- */

enum { TRY_CORNERS = 16 };

static bool add_vertex(api_document_in *in, const double *values, size_t count)
{
    he_error err;
    if (count != 3) {
        api_json_refuse_at(in->problem, he_lexer_place(&in->lexer), HE_BAD_VALUE,
                           "a vertex must have three coordinates, but this vertex has %zu", count);
        return point(in, IN_LIST);
    }
    he_vec3 position = {values[0], values[1], values[2]};
    return he_soup_add_vertex(&in->soup, position, &err) == HE_OK || refuse_core(in, IN_LIST, &err);
}

/* Reads at once all vertices or faces that the piece of the body contains completely, beginning
 * with the next one. */
static bool take_items(api_document_in *in, bool *taken)
{
    he_lexer *x = &in->lexer;
    he_error err;
    uint32_t corners[TRY_CORNERS];
    double values[3];
    size_t count;
    do {
        if (in->member == FACES) {
            count = he_lexer_take_indices(x, corners, TRY_CORNERS);
            if (count > 0 && he_soup_add_face(&in->soup, corners, count, &err) != HE_OK) {
                return refuse_core(in, IN_LIST, &err);
            }
        } else {
            count = he_lexer_take_numbers(x, values, 3);
            if (count > 0 && !add_vertex(in, values, count)) {
                return false;
            }
        }
        *taken |= count > 0;
    } while (count > 0 && he_lexer_value_ahead(x) && *x->at == '[');
    return true;
}

static bool open_item(api_document_in *in)
{
    he_error err;
    in->part = 0;
    return in->member != FACES || he_soup_begin_face(&in->soup, &err) == HE_OK ||
           refuse_core(in, IN_LIST, &err);
}

static bool add_corner(api_document_in *in, double value)
{
    he_error err;
    if (value < 0 || value != floor(value)) {
        return refuse(in, HE_BAD_VALUE,
                      "a corner must be the index of a vertex: a whole number, counted from 0");
    }
    if (value >= HE_DEAD) {
        return refuse(in, HE_BAD_INDEX, "the body has no vertex with this index");
    }
    return he_soup_add_corner(&in->soup, (uint32_t)value, &err) == HE_OK ||
           refuse_core(in, IN_ITEM, &err);
}

static bool add_value(api_document_in *in, double value)
{
    if (in->member == FACES) {
        return add_corner(in, value);
    }
    if (in->part == 3) {
        return refuse_in(in, IN_LIST, HE_BAD_VALUE,
                         "a vertex must have three coordinates, but this vertex has more");
    }
    in->point[in->part++] = value;
    return true;
}

/* Checks that the next value is an array. A value of another type is refused as wrong_type,
 * anything else as malformed_json. */
static bool expect_array(api_document_in *in, char c, const char *text)
{
    bool other = (c != '\0' && strchr("\"{tfn-", c) != NULL) || (c >= '0' && c <= '9');
    return c == '[' || refuse(in, other ? API_WRONG_TYPE : API_MALFORMED_JSON, text);
}

static bool expect_number(api_document_in *in, char c)
{
    bool other = c != '\0' && strchr("\"{[tfn", c) != NULL;
    return c == '-' || (c >= '0' && c <= '9') ||
           refuse(in, other ? API_WRONG_TYPE : API_MALFORMED_JSON, "the value must be a number");
}

static bool expect_in_list(api_document_in *in, bool *taken)
{
    char c = *in->lexer.at;
    if (in->lexer.depth == IN_DOCUMENT) {
        return expect_array(in, c, "the value must be an array");
    }
    if (in->lexer.depth == IN_ITEM) {
        return expect_number(in, c);
    }
    return expect_array(in, c,
                        in->member == FACES ? "a face must be an array of indices"
                                            : "a vertex must be an array [x,y,z]") &&
           take_items(in, taken);
}

static bool take_in_list(api_document_in *in, he_token token)
{
    size_t depth = in->lexer.depth;
    if (token == HE_TOKEN_NUMBER) {
        return add_value(in, in->lexer.number);
    }
    if (token == HE_TOKEN_ARRAY) {
        return depth == IN_LIST || open_item(in);
    }
    if (depth == IN_LIST) {
        return in->member == FACES || add_vertex(in, in->point, in->part);
    }
    in->member = NO_MEMBER;
    return true;
}

/* --- members of the document --- */

static bool open_list(api_document_in *in, member list, bool *has)
{
    in->member = list;
    if (*has) {
        return refuse(in, API_DUPLICATE_MEMBER,
                      list == FACES ? "\"faces\" is given twice" : "\"vertices\" is given twice");
    }
    *has = true;
    return true;
}

static bool open_attributes(api_document_in *in)
{
    if (in->attributes != NULL) {
        return refuse(in, API_DUPLICATE_MEMBER, "\"attributes\" is given twice");
    }
    in->member = ATTRIBUTES;
    in->attributes = api_attributes_in_new();
    return in->attributes != NULL || refuse(in, HE_NO_MEMORY, "no memory for the document");
}

static bool gather(api_document_in *in, api_members *to)
{
    in->gathering = to;
    return api_members_begin(to, &in->lexer, in->problem);
}

/* Begins a member of the document. The lexer has passed the member's name and the colon. */
static bool open_member(api_document_in *in)
{
    const he_lexer_frame *object = &in->lexer.frames[0];
    const char *name = object->name;
    size_t length = object->name_length;
    if (he_json_text_is(name, length, "vertices")) {
        return open_list(in, VERTICES, &in->has_vertices);
    }
    if (he_json_text_is(name, length, "faces")) {
        return open_list(in, FACES, &in->has_faces);
    }
    if (he_json_text_is(name, length, "attributes")) {
        return open_attributes(in);
    }
    if (!he_json_text_is(name, length, "materials")) {
        return gather(in, &in->rest);
    }
    return in->materials.text.length == 0
               ? gather(in, &in->materials)
               : refuse(in, API_DUPLICATE_MEMBER, "\"materials\" is given twice");
}

/* --- handling tokens --- */

/* Refuses the value that the lexer is about to read if the document may not have such a value in
 * this place. Sets `*taken` to true if the whole value was read here, so that the lexer must go on
 * after it. */
static bool expect(api_document_in *in, bool *taken)
{
    switch (in->member) {
    case NO_MEMBER:
        return *in->lexer.at == '{' ||
               refuse(in, API_MALFORMED_JSON, "a mesh document must begin with '{'");
    case VERTICES:
    case FACES:
        return expect_in_list(in, taken);
    case ATTRIBUTES:
        return api_attributes_in_expect(in->attributes, &in->lexer, taken, in->problem);
    }
    return true;
}

static bool take(api_document_in *in, he_token token)
{
    switch (in->member) {
    case NO_MEMBER:
        return token != HE_TOKEN_KEY || open_member(in);
    case VERTICES:
    case FACES:
        return take_in_list(in, token);
    case ATTRIBUTES:
        if (!api_attributes_in_take(in->attributes, &in->lexer, token, &in->gathering,
                                    in->problem)) {
            return false;
        }
        if (token == HE_TOKEN_CLOSE && in->lexer.depth == IN_DOCUMENT) {
            in->member = NO_MEMBER;
        }
        return in->gathering == NULL || gather(in, in->gathering);
    }
    return true;
}

/* Handles one token, or several vertices or faces at once. Sets `*cut` when all of the piece has
 * been read. */
static bool step(api_document_in *in, bool *cut)
{
    bool taken = false, done;
    if (in->gathering != NULL) {
        if (!api_members_feed(in->gathering, &in->lexer, &done, in->problem)) {
            return false;
        }
        in->gathering = done ? NULL : in->gathering;
        *cut = !done;
        return true;
    }
    if (he_lexer_value_ahead(&in->lexer) && !expect(in, &taken)) {
        return false;
    }
    if (taken) {
        return true;
    }
    he_token token = he_lexer_next(&in->lexer);
    *cut = token == HE_TOKEN_CUT;
    return token == HE_TOKEN_FAULT ? refuse_fault(in) : *cut || take(in, token);
}

bool api_document_in_feed(api_document_in *in, const char *bytes, size_t length,
                          api_problem *problem)
{
    bool good = true, cut = length == 0;
    in->problem = problem;
    he_lexer_feed(&in->lexer, bytes, length);
    while (good && !cut) {
        good = step(in, &cut);
    }
    return good;
}

static bool read_materials(api_document_in *in, api_problem *problem)
{
    api_document document = {0};
    api_in root, list;
    bool good =
        in->materials.text.length == 0 ||
        (api_members_parse(&in->materials, &document, &root, problem) &&
         api_in_need(&root, "materials", &list) && api_read_materials(&list, &in->soup.materials));
    api_document_clear(&document);
    return good;
}

bool api_document_in_end(api_document_in *in, api_problem *problem)
{
    in->problem = problem;
    if (in->lexer.state != HE_JSON_DONE) {
        return refuse(in, API_MALFORMED_JSON, "the body ends before the mesh document is complete");
    }
    return read_materials(in, problem) &&
           api_members_parse(&in->rest, &in->document, &in->root, problem);
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
