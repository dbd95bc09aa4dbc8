#include "mesh/column.h"

#include "base/text_hash.h"

#include <stdatomic.h>
#include <string.h>

/* The strings of the labels are stored one after another in `text`, each ended by NUL; starts[i] is
 * the offset of string i. `slots` is a hash table with open addressing: an entry is the index of a
 * string plus 1, or 0 if it is free. The table exists because a file may name a million groups, so
 * adding a string must take constant time. */
struct he_labels {
    atomic_uint references;
    char *text;
    size_t text_length, text_capacity;
    size_t *starts;
    size_t count, capacity;
    uint32_t *slots;
    size_t slot_count; /* size of the hash table: a power of two, or 0 */
};

he_labels *he_labels_new(void)
{
    he_labels *labels = he_mem_zero(1, sizeof *labels);
    if (labels != NULL) {
        atomic_init(&labels->references, 1);
    }
    return labels;
}

he_labels *he_labels_retain(he_labels *labels)
{
    if (labels != NULL) {
        atomic_fetch_add_explicit(&labels->references, 1, memory_order_relaxed);
    }
    return labels;
}

void he_labels_release(he_labels *labels)
{
    if (labels != NULL &&
        atomic_fetch_sub_explicit(&labels->references, 1, memory_order_acq_rel) == 1) {
        he_mem_free(labels->text);
        he_mem_free(labels->starts);
        he_mem_free(labels->slots);
        he_mem_free(labels);
    }
}

size_t he_labels_own_bytes(const he_labels *labels)
{
    if (labels == NULL || atomic_load_explicit(&labels->references, memory_order_relaxed) > 1) {
        return 0;
    }
    return sizeof *labels + labels->text_capacity + labels->capacity * sizeof *labels->starts +
           labels->slot_count * sizeof *labels->slots;
}

size_t he_labels_count(const he_labels *labels)
{
    return labels->count;
}

const char *he_labels_get(const he_labels *labels, size_t i)
{
    return labels->text + labels->starts[i];
}

static size_t length_of(const he_labels *labels, size_t i)
{
    size_t end = i + 1 < labels->count ? labels->starts[i + 1] : labels->text_length;
    return end - labels->starts[i] - 1;
}

bool he_labels_equal(const he_labels *a, const he_labels *b)
{
    return a == b ||
           (a != NULL && b != NULL && a->count == b->count && a->text_length == b->text_length &&
            (a->text_length == 0 || memcmp(a->text, b->text, a->text_length) == 0));
}

/* Returns the index of the entry of the hash table that holds the string, or of the free entry in
 * which the string belongs. */
static size_t slot_of(const he_labels *labels, const char *text, size_t length)
{
    size_t mask = labels->slot_count - 1;
    size_t slot = he_text_hash((uintptr_t)labels, text, length) & mask;
    while (labels->slots[slot] != 0) {
        size_t i = labels->slots[slot] - 1;
        if (length_of(labels, i) == length && memcmp(he_labels_get(labels, i), text, length) == 0) {
            break;
        }
        slot = (slot + 1) & mask;
    }
    return slot;
}

static bool grow_slots(he_labels *labels)
{
    size_t count = labels->slot_count == 0 ? 16 : labels->slot_count * 2;
    uint32_t *slots = he_mem_zero(count, sizeof *slots);
    if (slots == NULL) {
        return false;
    }
    he_mem_free(labels->slots);
    labels->slots = slots;
    labels->slot_count = count;
    for (size_t i = 0; i < labels->count; i++) {
        slots[slot_of(labels, he_labels_get(labels, i), length_of(labels, i))] = (uint32_t)i + 1;
    }
    return true;
}

static bool grow_text(he_labels *labels, size_t extra)
{
    if (labels->count == labels->capacity) {
        size_t capacity = he_mem_grown(labels->capacity, labels->count + 1);
        size_t *starts = he_mem_array(labels->starts, capacity, sizeof *starts);
        if (starts == NULL) {
            return false;
        }
        labels->starts = starts;
        labels->capacity = capacity;
    }
    if (extra > labels->text_capacity - labels->text_length) {
        size_t capacity = he_mem_grown(labels->text_capacity, labels->text_length + extra);
        char *text = he_mem_resize(labels->text, capacity);
        if (text == NULL) {
            return false;
        }
        labels->text = text;
        labels->text_capacity = capacity;
    }
    return true;
}

bool he_labels_find(const he_labels *labels, const char *text, size_t length, uint32_t *out)
{
    size_t slot = labels->slot_count == 0 ? 0 : slot_of(labels, text, length);
    if (labels->slot_count == 0 || labels->slots[slot] == 0) {
        return false;
    }
    *out = labels->slots[slot] - 1;
    return true;
}

he_status he_labels_add(he_labels *labels, const char *text, size_t length, uint32_t *out,
                        he_error *err)
{
    if (labels->count * 2 >= labels->slot_count && !grow_slots(labels)) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for another label");
    }
    size_t slot = slot_of(labels, text, length);
    if (labels->slots[slot] == 0) {
        if (labels->count >= HE_MAX_ROWS || !grow_text(labels, length + 1)) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for another label");
        }
        labels->starts[labels->count] = labels->text_length;
        memcpy(labels->text + labels->text_length, text, length);
        labels->text[labels->text_length + length] = '\0';
        labels->text_length += length + 1;
        labels->slots[slot] = (uint32_t)++labels->count;
    }
    *out = labels->slots[slot] - 1;
    return HE_OK;
}
