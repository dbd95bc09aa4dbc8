#include "api/write/decode_ids.h"

#include "api/limits.h"
#include "base/word_hash.h"

#include <string.h>

/* Checks that each result of a column is an id, if the parameter may not be null. */
static bool check_found(const he_param *param, const api_in *in, const char *text,
                        const api_found *found)
{
    for (size_t i = 0; found->known && (param->flags & HE_NULLABLE) == 0 && i < found->count; i++) {
        if (found->ids[i] == HE_NONE) {
            return api_in_fail(in, HE_NO_SUCH_ELEMENT,
                               "\"%.100s\" stands for results that its operation did not all "
                               "produce: item %zu is null",
                               text, i);
        }
    }
    return true;
}

/* Reads an id into `one`, or the ids that a reference stands for into `found`. */
static bool read_ids(const api_decoder *d, const api_in *in, const he_param *param, uint32_t *one,
                     api_found *found)
{
    const api_references *references = d->scope->references;
    if (!api_in_is_string(in) || references == NULL) {
        *found = (api_found){.ids = one, .count = 1};
        if ((param->flags & HE_NULLABLE) && api_in_is_null(in)) {
            *one = HE_NONE;
            return true;
        }
        return api_in_id(in, one);
    }
    const char *text;
    if (!api_in_string(in, SIZE_MAX, &text)) {
        return false;
    }
    if (text[0] != '$') {
        return api_in_fail(
            in, API_WRONG_TYPE,
            "a string in place of an id must be a reference such as \"$name.result\"");
    }
    if (!references->find(references->context, in, text, param->kind, found) ||
        !check_found(param, in, text, found)) {
        return false;
    }
    d->call->has_unknown = d->call->has_unknown || !found->known;
    return true;
}

bool api_decode_id(const api_decoder *d, const he_param *param, const api_in *in, uint32_t *id)
{
    uint32_t one;
    api_found found;
    if (!read_ids(d, in, param, &one, &found)) {
        return false;
    }
    if (found.list) {
        return api_in_fail(in, API_BAD_REFERENCE,
                           "the reference names a list, but one id is expected: add \".0\" to name "
                           "its first element");
    }
    *id = found.ids[0];
    return true;
}

/* Appends the ids of the array `in` to `list`, whose memory is in the arena. A reference may stand
 * for several ids. */
static bool append_ids(const api_decoder *d, const he_param *param, const api_in *in, he_ids *list)
{
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        uint32_t one;
        api_found found;
        if (!read_ids(d, &child, param, &one, &found)) {
            return false;
        }
        if (found.count > API_MAX_IDS - list->count) {
            return api_in_fail(&child, HE_LIMIT, "the list refers to more than %d elements",
                               (int)API_MAX_IDS);
        }
        if (found.count > list->capacity - list->count) {
            const size_t grown = he_mem_grown(list->capacity, list->count + found.count);
            uint32_t *larger = api_arena_array(d->arena, grown, sizeof *larger);
            if (larger == NULL) {
                return api_in_fail(in, HE_NO_MEMORY, "no memory for a list of ids");
            }
            if (list->count > 0) {
                memcpy(larger, list->ids, list->count * sizeof *larger);
            }
            list->ids = larger;
            list->capacity = grown;
        }
        for (size_t i = 0; i < found.count; i++) {
            list->ids[list->count++] = found.ids[i];
        }
    }
    return true;
}

/* Reserves memory in the arena for as many ids as the array `in` has values. */
static bool begin_list(const api_decoder *d, size_t capacity, const api_in *in, he_ids *list)
{
    *list = (he_ids){.ids = api_arena_array(d->arena, capacity, sizeof *list->ids),
                     .capacity = capacity};
    return list->ids != NULL || api_in_fail(in, HE_NO_MEMORY, "no memory for a list of ids");
}

/* Takes a list of ids from an array beside the JSON. */
static bool take_ids(const api_numbers *numbers, const he_param *param, size_t min,
                     const api_in *in, he_arg *arg)
{
    if (numbers->type != API_PACKED_U32 || numbers->width != 1) {
        return api_in_fail(in, API_WRONG_TYPE,
                           "a list of ids is an array of type 1 with one number in an item");
    }
    if (numbers->count < min || numbers->count > API_MAX_IDS) {
        return api_in_fail(in, numbers->count < min ? HE_BAD_VALUE : HE_LIMIT,
                           "the array has %zu values, but needs %zu to %d", numbers->count, min,
                           (int)API_MAX_IDS);
    }
    const bool may_be_null = (param->flags & HE_NULLABLE) != 0;
    for (size_t i = 0; i < numbers->count; i++) {
        const uint32_t id = numbers->at.u32[i];
        if (id >= HE_DEAD && !(id == HE_NONE && may_be_null)) {
            const api_in at = api_in_item(in, i);
            return api_in_fail(&at, HE_BAD_VALUE, "%u is not an id", id);
        }
    }
    arg->ids = numbers->at.u32;
    arg->count = numbers->count;
    arg->list = true;
    return true;
}

bool api_decode_ids(const api_decoder *d, const he_param *param, size_t min, const api_in *in,
                    he_arg *arg)
{
    const api_numbers *numbers = api_in_numbers(in);
    if (numbers != NULL) {
        return take_ids(numbers, param, min, in, arg);
    }
    he_ids list;
    if (!api_in_array(in, min, SIZE_MAX) || !begin_list(d, api_in_count(in), in, &list) ||
        !append_ids(d, param, in, &list)) {
        return false;
    }
    if (list.count < min) {
        return api_in_fail(in, HE_NO_SUCH_ELEMENT,
                           "the list is empty, because all references in it stand for empty lists");
    }
    arg->ids = list.ids;
    arg->count = list.count;
    arg->list = true;
    return true;
}

bool api_decode_cycles(const api_decoder *d, const he_param *param, const api_in *in, he_arg *arg)
{
    he_ids ids, ends;
    api_in child;
    if (!api_in_array(in, 1, SIZE_MAX) || !begin_list(d, 4 * api_in_count(in), in, &ids) ||
        !begin_list(d, api_in_count(in), in, &ends)) {
        return false;
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_array(&child, 0, SIZE_MAX) || !append_ids(d, param, &child, &ids)) {
            return false;
        }
        ends.ids[ends.count++] = (uint32_t)ids.count;
    }
    arg->ids = ids.ids;
    arg->count = ids.count;
    arg->ends = ends.ids;
    arg->rows = ends.count;
    arg->list = true;
    return true;
}

bool api_decode_set(const api_decoder *d, he_kind kind, const api_in *in, he_arg *arg)
{
    static const uint32_t none[1] = {HE_NONE};
    api_set set;
    uint32_t *ids;
    d->call->has_set = true;
    arg->list = true;
    arg->ids = none;
    if (d->scope->mesh == NULL) {
        return api_in_set(in, &set);
    }
    if (!api_find_set(in, d->scope->mesh, kind, d->arena, &ids, &arg->count)) {
        return false;
    }
    arg->ids = ids;
    return true;
}

/* Finds the first id that occurs earlier in the list, by a hash table. Its slots have an id plus 1,
 * or 0 if they are empty. Returns SIZE_MAX if there is none. */
static size_t find_repeated(const uint32_t *ids, size_t count, uint32_t *table, unsigned bits)
{
    const size_t mask = ((size_t)1 << bits) - 1;
    for (size_t i = 0; i < count; i++) {
        const uint32_t key = ids[i] + 1;
        if (ids[i] == HE_NONE) {
            continue;
        }
        size_t slot = (size_t)(he_word_hash((uintptr_t)table, ids[i]) >> (64 - bits));
        while (table[slot] != 0 && table[slot] != key) {
            slot = (slot + 1) & mask;
        }
        if (table[slot] == key) {
            return i;
        }
        table[slot] = key;
    }
    return SIZE_MAX;
}

bool api_check_repeated(const api_decoder *d, const api_in *in, const he_arg *arg)
{
    unsigned bits = 4;
    while ((size_t)1 << bits < 2 * arg->count) {
        bits++;
    }
    uint32_t *table = api_arena_array(d->arena, (size_t)1 << bits, sizeof *table);
    if (table == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory to compare %zu ids", arg->count);
    }
    memset(table, 0, ((size_t)1 << bits) * sizeof *table);
    const size_t i = find_repeated(arg->ids, arg->count, table, bits);
    if (i == SIZE_MAX) {
        return true;
    }
    /* A reference may have put several ids into the list; then its items are others. */
    const api_in at = arg->count == api_in_count(in) ? api_in_item(in, i) : *in;
    return api_in_fail(&at, API_REPEATED, "%u is in the list already", arg->ids[i]);
}
