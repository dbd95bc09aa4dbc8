#include "api/write/result_names.h"

#include "base/siphash.h"

#include <assert.h>
#include <string.h>

/* Returns the slot of the hash table that has this name, or the empty slot where the name would be
 * added. The table is never full. The key of the hash is secret, so that clients cannot choose
 * colliding names. */
static size_t find_slot(const api_result_names *names, const char *text, size_t length)
{
    size_t slot = (size_t)he_siphash_of(names->secret, text, length) & (names->table_size - 1);
    while (names->table[slot] != 0) {
        const char *name = names->names[names->table[slot] - 1].name;
        if (strncmp(name, text, length) == 0 && name[length] == '\0') {
            break;
        }
        slot = (slot + 1) & (names->table_size - 1);
    }
    return slot;
}

static api_result_name *find_name(const api_result_names *names, const char *text, size_t length)
{
    if (names->table_size == 0) {
        return NULL;
    }
    uint32_t entry = names->table[find_slot(names, text, length)];
    return entry == 0 ? NULL : &names->names[entry - 1];
}

/* Reads an index such as "0" or "17", without sign or leading zeros. Returns -1 if the text is no
 * such index. */
static int64_t read_index(const char *text)
{
    int64_t value = 0;
    if (text[0] == '\0' || (text[0] == '0' && text[1] != '\0') || strlen(text) > 10) {
        return -1;
    }
    for (; *text != '\0'; text++) {
        if (*text < '0' || *text > '9') {
            return -1;
        }
        value = value * 10 + (*text - '0');
    }
    return value;
}

static const uint32_t unbound = HE_NONE;

/* What a reference names: a result of an earlier operation, or an item of a list result. */
typedef struct value {
    const api_result_name *name;
    size_t row;    /* index of the result among the results of the operation */
    int64_t index; /* index of the item; -1: the whole result */
} value;

static bool is_list(const api_result_name *name, size_t row)
{
    return name->each || name->op->results[row].type == HE_RESULT_ELEMENTS;
}

/* Finds the ids of a result or item. `text` is the reference, for the message of a refusal. */
static bool find_value(const api_in *at, const char *text, const value *wanted, api_found *out)
{
    const api_result_name *name = wanted->name;
    const size_t row = wanted->row;
    const int64_t index = wanted->index;
    const bool list = is_list(name, row);
    *out =
        (api_found){.ids = &unbound, .count = 1, .list = list && index < 0, .known = name->bound};
    if (!name->bound) {
        return true;
    }
    const he_results *results = &name->results;
    const he_ids *ids = &results->list[row];
    if (list && index < 0) {
        out->ids = ids->ids;
        out->count = ids->count;
        return true;
    }
    if (list && (uint64_t)index >= ids->count) {
        return api_in_fail(at, HE_NO_SUCH_ELEMENT,
                           "the index in \"%.100s\" is too large: the result has %zu elements",
                           text, ids->count);
    }
    out->ids = list ? &ids->ids[index] : &results->id[row];
    if (!results->present[row] || *out->ids == HE_NONE) {
        return api_in_fail(at, HE_NO_SUCH_ELEMENT,
                           "\"%.100s\" stands for a result that its operation did not produce",
                           text);
    }
    return true;
}

static bool find_reference(void *context, const api_in *at, const char *text, he_kind kind,
                           api_found *out)
{
    const api_result_names *names = context;
    const char *dot = strchr(text, '.');
    if (dot == NULL) {
        return api_in_fail(at, API_BAD_REFERENCE,
                           "\"%.100s\" is not a reference such as \"$name.result\"", text);
    }
    const api_result_name *name = find_name(names, text + 1, (size_t)(dot - text - 1));
    if (name == NULL) {
        return api_in_fail(at, API_BAD_REFERENCE,
                           "no earlier operation of the list has the name that \"%.100s\" contains",
                           text);
    }
    const char *result = dot + 1, *second = strchr(result, '.');
    size_t length = second == NULL ? strlen(result) : (size_t)(second - result);
    int64_t index = second == NULL ? -1 : read_index(second + 1);
    for (size_t row = 0; row < he_op_results(name->op); row++) {
        const he_result_row *r = &name->op->results[row];
        if (strlen(r->name) != length || memcmp(r->name, result, length) != 0) {
            continue;
        }
        bool ids = r->type == HE_RESULT_ELEMENT || r->type == HE_RESULT_ELEMENTS;
        if (!ids || r->kind != kind) {
            return api_in_fail(at, API_BAD_REFERENCE, "\"%.100s\" is not %s %s", text,
                               kind == HE_EDGE ? "an" : "a", he_kind_name(kind));
        }
        if (second != NULL && (index < 0 || !is_list(name, row))) {
            break;
        }
        return find_value(at, text, &(value){name, row, index}, out);
    }
    return api_in_fail(at, API_BAD_REFERENCE,
                       "the operation %s has no result that \"%.100s\" could stand for",
                       name->op->name, text);
}

void api_result_names_init(api_result_names *names, const uint64_t secret[2])
{
    *names = (api_result_names){.secret = {secret[0], secret[1]}};
    names->references = (api_references){.find = find_reference, .context = names};
}

void api_result_names_clear(api_result_names *names)
{
    for (size_t i = 0; i < names->count; i++) {
        he_results_clear(&names->names[i].results);
    }
    he_mem_free(names->names);
    he_mem_free(names->table);
    api_arena_clear(&names->texts);
    api_result_names_init(names, names->secret);
}

/* Grows the hash table so that it is at most half full. */
static bool grow(api_result_names *names)
{
    if (names->count == names->capacity) {
        size_t capacity = he_mem_grown(names->capacity, names->count + 1);
        api_result_name *grown = he_mem_array(names->names, capacity, sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        names->names = grown;
        names->capacity = capacity;
    }
    if ((names->count + 1) * 2 <= names->table_size) {
        return true;
    }
    size_t size = names->table_size == 0 ? 16 : names->table_size * 2;
    uint32_t *table = he_mem_zero(size, sizeof *table);
    if (table == NULL) {
        return false;
    }
    he_mem_free(names->table);
    names->table = table;
    names->table_size = size;
    assert(names->names != NULL);
    for (size_t i = 0; i < names->count; i++) {
        const char *name = names->names[i].name;
        names->table[find_slot(names, name, strlen(name))] = (uint32_t)i + 1;
    }
    return true;
}

bool api_result_names_add(api_result_names *names, const api_in *at, const api_call *call)
{
    if (call->as == NULL) {
        return true;
    }
    api_in as = *at;
    api_in_find(at, "as", &as);
    size_t length = strlen(call->as);
    if (find_name(names, call->as, length) != NULL) {
        return api_in_fail(&as, API_REPEATED_NAME,
                           "an earlier operation already has the name \"%s\"", call->as);
    }
    const char *name = grow(names) ? api_arena_copy(&names->texts, call->as, length) : NULL;
    if (name == NULL) {
        return api_in_fail(&as, HE_NO_MEMORY, "no memory for a name");
    }
    assert(names->names != NULL && names->table != NULL);
    size_t slot = find_slot(names, call->as, length);
    names->names[names->count] = (api_result_name){
        .name = name, .op = call->op, .each = he_op_each(call->op, call->args) != NULL};
    names->table[slot] = (uint32_t)++names->count;
    return true;
}

void api_result_names_bind(api_result_names *names, const api_call *call, he_results *results)
{
    api_result_name *name = call->as == NULL ? NULL : find_name(names, call->as, strlen(call->as));
    if (name != NULL) {
        he_results_clear(&name->results);
        name->results = *results;
        name->bound = true;
        *results = (he_results){0};
    }
}

void api_result_names_unbind(api_result_names *names)
{
    for (size_t i = 0; i < names->count; i++) {
        he_results_clear(&names->names[i].results);
        names->names[i].bound = false;
    }
}
