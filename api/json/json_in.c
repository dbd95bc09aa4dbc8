#include "api/json/json_in.h"

#include "api/json/json_scan.h"
#include "api/json/known_names.h"
#include "api/json/seen_text.h"
#include "api/limits.h"
#include "format/text/number.h"

#include <cjson/cJSON.h>

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void api_in_setup(void)
{
    cJSON_Hooks hooks = {.malloc_fn = he_mem_alloc, .free_fn = he_mem_free};
    cJSON_InitHooks(&hooks);
}

/* Hashes a member's name by FNV-1a, so that most names that differ are told apart by comparing
 * integers. */
static uint32_t hash(const char *text)
{
    uint32_t h = 2166136261u;
    for (; *text != '\0'; text++) {
        h = (h ^ (unsigned char)*text) * 16777619u;
    }
    return h;
}

static bool check_members(const api_in *object)
{
    const cJSON *seen[API_MAX_MEMBERS];
    uint32_t hashes[API_MAX_MEMBERS];
    size_t count = 0;
    for (const cJSON *member = object->value->child; member != NULL; member = member->next) {
        if (count == API_MAX_MEMBERS) {
            return api_in_fail(object, HE_LIMIT, "the object has more than %d members",
                               API_MAX_MEMBERS);
        }
        uint32_t h = hash(member->string);
        for (size_t i = 0; i < count; i++) {
            if (hashes[i] == h && strcmp(seen[i]->string, member->string) == 0) {
                api_in at = {.value = member, .parent = object, .problem = object->problem};
                return api_in_fail(&at, API_DUPLICATE_MEMBER, "\"%.100s\" is given twice",
                                   member->string);
            }
        }
        seen[count] = member;
        hashes[count++] = h;
    }
    return true;
}

/* Checks that no object has a repeated member. The recursion is bounded, because the scan
 * (json_scan.h) has refused more than API_MAX_DEPTH levels. */
static bool check_objects(const api_in *in)
{
    if (cJSON_IsObject(in->value) && !check_members(in)) {
        return false;
    }
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (child.value->child != NULL && !check_objects(&child)) {
            return false;
        }
    }
    return true;
}

/* Returns true if a value is an object like {"array":0}. */
static bool is_reference(const cJSON *value)
{
    const cJSON *member = value->child;
    return cJSON_IsObject(value) && member != NULL && member->next == NULL &&
           strcmp(member->string, "array") == 0;
}

/* Makes the node of an object like {"array":0} point to the array. cJSON never makes raw nodes of a
 * text, and does not free what a node with cJSON_IsReference points to. */
static bool place_array(const api_in *in, cJSON *node, const api_arrays *arrays)
{
    uint64_t number = 0;
    api_in member;
    if (!api_in_first(in, &member) || !api_in_u64(&member, 0, UINT32_MAX, &number)) {
        return false;
    }
    if (number >= arrays->count) {
        return api_in_fail(&member, HE_BAD_VALUE, "there is no array %llu: the body has %zu",
                           (unsigned long long)number, arrays->count);
    }
    cJSON_Delete(node->child);
    node->child = NULL;
    node->type = cJSON_Raw | cJSON_IsReference | (node->type & cJSON_StringIsConst);
    node->valuestring = (char *)&arrays->arrays[number];
    return true;
}

/* Lets all objects like {"array":0} point to their arrays. `node` is the node of the value at `in`.
 * The recursion is bounded as that of check_objects. */
static bool place_arrays(const api_in *in, cJSON *node, const api_arrays *arrays)
{
    if (is_reference(node)) {
        return place_array(in, node, arrays);
    }
    size_t i = 0;
    for (cJSON *child = node->child; child != NULL; child = child->next, i++) {
        const api_in at = {.value = child, .parent = in, .index = i, .problem = in->problem};
        if (child->child != NULL && !place_arrays(&at, child, arrays)) {
            return false;
        }
    }
    return true;
}

/* Parses one value of a text that json_scan.h has accepted; `*end` is set to where the value ends.
 * The caller sets all members of the cursor `root` but `value`. */
static bool parse(api_bytes text, const api_arrays *arrays, api_document *out, api_in *root,
                  const char **end)
{
    api_in in = *root;
    in.value = out->root = cJSON_ParseWithLengthOpts(text.at, text.length, end, false);
    if (out->root == NULL) {
        /* The scan has accepted the text, so parsing fails only when memory is out. */
        return api_problem_set(in.problem, HE_NO_MEMORY, "no memory to read the body");
    }
    if (!check_objects(&in) || (arrays != NULL && !place_arrays(&in, out->root, arrays))) {
        api_document_clear(out);
        return false;
    }
    *root = in;
    return true;
}

bool api_document_parse_scanned(api_bytes text, api_document *out, api_in *root,
                                api_problem *problem)
{
    const char *end;
    *root = (api_in){.problem = problem};
    return parse(text, NULL, out, root, &end);
}

static bool parse_beside(api_bytes text, const api_items *items, api_document *out, api_in *root,
                         api_problem *problem)
{
    const char *end;
    *root = (api_in){.problem = problem};
    return parse(text, items == NULL ? NULL : items->arrays, out, root, &end);
}

bool api_document_parse(api_bytes text, const api_in_options *options, api_document *out,
                        api_in *root, api_problem *problem)
{
    const api_items *items = options->items;
    if (!api_json_scan(text, options, problem)) {
        return false;
    }
    if (items == NULL || items->at == NULL) {
        return parse_beside(text, items, out, root, problem);
    }
    size_t before = (size_t)(items->at - text.at);
    size_t after = (size_t)(text.at + text.length - items->end);
    char *rest = he_mem_alloc(before + after);
    if (rest == NULL) {
        return api_problem_set(problem, HE_NO_MEMORY, "no memory to read the body");
    }
    memcpy(rest, text.at, before);
    memcpy(rest + before, items->end, after);
    bool good = parse_beside((api_bytes){rest, before + after}, items, out, root, problem);
    he_mem_free(rest);
    return good;
}

bool api_item_read(const api_items *items, size_t i, const api_in *list, api_item *item)
{
    const char *from = i == 0 ? items->at : item->next + strspn(item->next, " \t\r\n,");
    api_item_clear(item);
    item->in = (api_in){.parent = list, .index = i, .problem = list->problem};
    return parse((api_bytes){from, (size_t)(items->end - from)}, items->arrays, &item->document,
                 &item->in, &item->next);
}

void api_item_clear(api_item *item)
{
    api_document_clear(&item->document);
}

void api_document_clear(api_document *document)
{
    cJSON_Delete(document->root);
    document->root = NULL;
}

/* --- JSON pointers --- */

static char *add_step(char *at, char *end, const char *step)
{
    char *start = at;
    if (at == end) {
        return start;
    }
    *at++ = '/';
    for (; *step != '\0'; step++) {
        if (end - at < 2) {
            return start;
        }
        if (*step == '~' || *step == '/') {
            *at++ = '~';
            *at++ = *step == '~' ? '0' : '1';
        } else {
            *at++ = *step;
        }
    }
    return at;
}

void api_in_pointer(const api_in *in, char *out, size_t size)
{
    const api_in *way[API_MAX_DEPTH + 1];
    size_t steps = 0;
    for (; in->parent != NULL && steps < API_MAX_DEPTH + 1; in = in->parent) {
        way[steps++] = in;
    }
    char *at = out, *end = out + size - 1;
    while (steps > 0) {
        const api_in *step = way[--steps];
        char index[24];
        const char *name = step->value == NULL ? NULL : step->value->string;
        if (name == NULL) {
            snprintf(index, sizeof index, "%zu", step->index);
            name = index;
        }
        char *next = add_step(at, end, name);
        if (next == at) {
            /* There is no space for this step of the path: the result is the pointer of an
             * enclosing value. */
            break;
        }
        at = next;
    }
    *at = '\0';
}

void api_in_point(const api_in *in)
{
    api_in_pointer(in, in->problem->pointer, sizeof in->problem->pointer);
    in->problem->has_pointer = true;
}

bool api_in_fail(const api_in *in, int code, const char *format, ...)
{
    char text[API_PROBLEM_DETAIL];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (in->problem->code == HE_OK) {
        api_problem_set(in->problem, code, "%s", text);
        api_in_point(in);
    }
    return false;
}

/* --- objects, arrays and types --- */

bool api_in_is_null(const api_in *in)
{
    return cJSON_IsNull(in->value);
}
bool api_in_is_string(const api_in *in)
{
    return cJSON_IsString(in->value);
}
bool api_in_is_array(const api_in *in)
{
    return cJSON_IsArray(in->value) || cJSON_IsRaw(in->value);
}

const api_numbers *api_in_numbers(const api_in *in)
{
    return cJSON_IsRaw(in->value) ? (const api_numbers *)(const void *)in->value->valuestring
                                  : NULL;
}

bool api_in_is_object(const api_in *in)
{
    return cJSON_IsObject(in->value);
}
bool api_in_is_number(const api_in *in)
{
    return cJSON_IsNumber(in->value);
}

static const char *type_name(const api_in *in)
{
    return cJSON_IsNull(in->value)     ? "null"
           : cJSON_IsBool(in->value)   ? "a boolean"
           : cJSON_IsNumber(in->value) ? "a number"
           : cJSON_IsString(in->value) ? "a string"
           : api_in_is_array(in)       ? "an array"
                                       : "an object";
}

static bool wrong_type(const api_in *in, const char *wanted)
{
    return api_in_fail(in, API_WRONG_TYPE, "the value is %s, but must be %s", type_name(in),
                       wanted);
}

bool api_in_object(const api_in *in)
{
    return api_in_is_object(in) || wrong_type(in, "an object");
}

static bool refuse_member(const api_in *member, const char *const *names)
{
    api_known_names known = {.wanted = api_in_name(member)};
    for (; *names != NULL; names++) {
        api_known_names_add(&known, *names);
    }
    return api_in_fail(member, API_UNKNOWN_MEMBER, "this object cannot have a member \"%.60s\"%s",
                       api_in_name(member), api_known_names_text(&known));
}

bool api_in_only(const api_in *in, const char *const *names)
{
    if (!api_in_object(in)) {
        return false;
    }
    api_in member;
    for (bool more = api_in_first(in, &member); more; more = api_in_next(&member)) {
        const char *const *name = names;
        while (*name != NULL && strcmp(*name, api_in_name(&member)) != 0) {
            name++;
        }
        if (*name == NULL) {
            return refuse_member(&member, names);
        }
    }
    return true;
}

bool api_in_find(const api_in *object, const char *name, api_in *out)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object->value, name);
    if (value == NULL) {
        return false;
    }
    *out = (api_in){.value = value, .parent = object, .problem = object->problem};
    return true;
}

bool api_in_need(const api_in *object, const char *name, api_in *out)
{
    return api_in_find(object, name, out) ||
           api_in_fail(object, API_MISSING_MEMBER, "\"%s\" is missing", name);
}

bool api_in_array(const api_in *in, size_t min, size_t max)
{
    if (!api_in_is_array(in)) {
        return wrong_type(in, "an array");
    }
    if (api_in_numbers(in) != NULL) {
        return api_in_fail(in, API_WRONG_TYPE,
                           "an array beside the JSON cannot be given here; its items must be of "
                           "the type that the member takes");
    }
    size_t count = api_in_count(in);
    if (count < min || (count > max && min == max)) {
        return api_in_fail(in, HE_BAD_VALUE, "the array has %zu values, but needs %s%zu", count,
                           min == max ? "" : "at least ", min);
    }
    if (count > max) {
        return api_in_fail(in, HE_LIMIT, "the array has %zu values; at most %zu are allowed", count,
                           max);
    }
    return true;
}

size_t api_in_count(const api_in *in)
{
    size_t count = 0;
    if (api_in_numbers(in) != NULL) {
        return api_in_numbers(in)->count;
    }
    for (const cJSON *value = in->value->child; value != NULL; value = value->next) {
        count++;
    }
    return count;
}

bool api_in_first(const api_in *in, api_in *child)
{
    *child = (api_in){.value = in->value->child, .parent = in, .problem = in->problem};
    return child->value != NULL;
}

bool api_in_next(api_in *child)
{
    child->value = child->value->next;
    child->index++;
    return child->value != NULL;
}

api_in api_in_item(const api_in *array, size_t i)
{
    return (api_in){.parent = array, .index = i, .problem = array->problem};
}

const char *api_in_name(const api_in *member)
{
    return member->value->string;
}

/* --- reading values --- */

bool api_in_bool(const api_in *in, bool *out)
{
    if (!cJSON_IsBool(in->value)) {
        return wrong_type(in, "true or false");
    }
    *out = cJSON_IsTrue(in->value);
    return true;
}

bool api_in_number(const api_in *in, double *out)
{
    if (!api_in_is_number(in)) {
        return wrong_type(in, "a number");
    }
    if (!isfinite(in->value->valuedouble)) {
        return api_in_fail(in, HE_NOT_FINITE, "the number is too large for a double");
    }
    *out = in->value->valuedouble;
    return true;
}

/* A number formatted for a message. */
typedef struct number_text {
    char text[HE_NUMBER_TEXT + 1];
} number_text;

static number_text show(double value)
{
    number_text shown;
    if (isfinite(value)) {
        shown.text[he_double_print(value, shown.text)] = '\0';
    } else {
        snprintf(shown.text, sizeof shown.text, "%sinfinity", value < 0 ? "-" : "");
    }
    return shown;
}

bool api_in_check_within(const api_in *in, double value, const double range[2], bool exclusive)
{
    const double min = range[0], max = range[1];
    if (max >= DBL_MAX && (exclusive ? !(value > min) : !(value >= min))) {
        return api_in_fail(in, HE_BAD_VALUE, "the number must be %s %s, not %s",
                           exclusive ? "above" : "at least", show(min).text, show(value).text);
    }
    if (exclusive ? !(value > min && value < max) : !(value >= min && value <= max)) {
        return api_in_fail(in, HE_BAD_VALUE, "%s is not %s %s and %s", show(value).text,
                           exclusive ? "strictly between" : "between", show(min).text,
                           show(max).text);
    }
    return true;
}

bool api_in_number_within(const api_in *in, double min, double max, bool exclusive, double *out)
{
    double value = 0;
    if (!api_in_number(in, &value) ||
        !api_in_check_within(in, value, (const double[]){min, max}, exclusive)) {
        return false;
    }
    *out = value;
    return true;
}

bool api_in_check_whole(const api_in *in, double value, uint64_t min, uint64_t max)
{
    if (value != floor(value)) {
        return api_in_fail(in, HE_BAD_VALUE, "%s is not a whole number", show(value).text);
    }
    if (value < (double)min || value > (double)max) {
        return api_in_fail(in, HE_BAD_VALUE, "%s is not between %llu and %llu", show(value).text,
                           (unsigned long long)min, (unsigned long long)max);
    }
    return true;
}

bool api_in_u64(const api_in *in, uint64_t min, uint64_t max, uint64_t *out)
{
    double value = 0;
    if (!api_in_is_number(in)) {
        return wrong_type(in, "a whole number");
    }
    if (!api_in_number(in, &value) || !api_in_check_whole(in, value, min, max)) {
        return false;
    }
    *out = (uint64_t)value;
    return true;
}

bool api_in_id(const api_in *in, uint32_t *out)
{
    uint64_t value = 0;
    if (!api_in_u64(in, 0, HE_DEAD - 1, &value)) {
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

bool api_in_ids(const api_in *in, size_t min, api_arena *arena, uint32_t **ids, size_t *count)
{
    if (!api_in_array(in, min, SIZE_MAX)) {
        return false;
    }
    size_t total = api_in_count(in), i = 0;
    uint32_t *list = api_arena_array(arena, total, sizeof *list);
    if (list == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for %zu ids", total);
    }
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_id(&child, &list[i++])) {
            return false;
        }
    }
    *ids = list;
    *count = total;
    return true;
}

bool api_in_vec3(const api_in *in, he_vec3 *out)
{
    double values[3];
    size_t i = 0;
    if (!api_in_array(in, 3, 3)) {
        return false;
    }
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_number(&child, &values[i++])) {
            return false;
        }
    }
    *out = (he_vec3){values[0], values[1], values[2]};
    return true;
}

bool api_in_string(const api_in *in, size_t max, const char **out)
{
    if (!api_in_is_string(in)) {
        return wrong_type(in, "a string");
    }
    size_t length = strlen(in->value->valuestring);
    if (length > max) {
        return api_in_fail(in, HE_BAD_VALUE, "the string has %zu bytes; at most %zu are allowed",
                           length, max);
    }
    *out = in->value->valuestring;
    return true;
}

bool api_in_seen_name(const api_in *in, size_t max, const char **out)
{
    const char *text = "";
    if (!api_in_string(in, max, &text)) {
        return false;
    }
    const unsigned code = api_unseen_character(text);
    if (code != 0) {
        return api_in_fail(in, HE_BAD_VALUE,
                           "a name cannot have the character U+%04X, which controls how text is "
                           "shown",
                           code);
    }
    *out = text;
    return true;
}

bool api_in_choice(const api_in *in, const char *const *choices, int *out)
{
    const char *text = "";
    if (!api_in_string(in, SIZE_MAX, &text)) {
        return false;
    }
    char list[160] = "";
    for (int i = 0; choices[i] != NULL; i++) {
        if (strcmp(choices[i], text) == 0) {
            *out = i;
            return true;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ", choices[i]);
    }
    return api_in_fail(in, HE_BAD_VALUE, "\"%.60s\" is not one of %s", text, list);
}

bool api_in_element(const api_in *in, he_kind *kind, uint32_t *id)
{
    if (!api_in_object(in)) {
        return false;
    }
    api_in member, second;
    if (!api_in_first(in, &member)) {
        return api_in_fail(in, API_MISSING_MEMBER,
                           "\"vertex\", \"halfedge\", \"edge\" or \"face\" is missing");
    }
    second = member;
    if (api_in_next(&second)) {
        return api_in_fail(&second, API_UNKNOWN_MEMBER,
                           "give exactly one of \"vertex\", \"halfedge\", \"edge\" and \"face\"");
    }
    for (he_kind k = HE_VERTEX; k <= HE_FACE; k++) {
        if (strcmp(api_in_name(&member), he_kind_name(k)) == 0) {
            *kind = k;
            return api_in_id(&member, id);
        }
    }
    return api_in_fail(
        &member, API_UNKNOWN_MEMBER,
        "there is no kind of element \"%.100s\"; the kinds are vertex, halfedge, edge and face",
        api_in_name(&member));
}
