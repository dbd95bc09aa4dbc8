#include "mesh/material.h"

#include "base/mem.h"
#include "base/utf8.h"

#include <float.h>
#include <math.h>
#include <string.h>

const he_look he_plain_look = {
    .base_color = {1, 1, 1, 1}, .metallic = 0, .roughness = 1, .emission = {0, 0, 0}};

/* How many numbers say how a material looks: four for the base colour, one each for metallic and
 * roughness, three for the emission. list_numbers lists the numbers in this order. */
enum { NUMBERS = 9 };

typedef struct number {
    const char *name;
    double *value;
    double most;
} number;

static void list_numbers(he_look *look, number out[NUMBERS])
{
    static const char *const names[NUMBERS] = {"base_color", "base_color", "base_color",
                                               "base_color", "metallic",   "roughness",
                                               "emission",   "emission",   "emission"};
    double *const values[NUMBERS] = {
        &look->base_color[0], &look->base_color[1], &look->base_color[2],
        &look->base_color[3], &look->metallic,      &look->roughness,
        &look->emission[0],   &look->emission[1],   &look->emission[2]};
    for (size_t i = 0; i < NUMBERS; i++) {
        out[i] = (number){names[i], values[i], i < 6 ? 1 : DBL_MAX};
    }
}

bool he_look_clamp(he_look *look)
{
    he_look plain = he_plain_look;
    number numbers[NUMBERS], plain_numbers[NUMBERS];
    bool changed = false;
    list_numbers(look, numbers);
    list_numbers(&plain, plain_numbers);
    for (size_t i = 0; i < NUMBERS; i++) {
        double *value = numbers[i].value;
        if (!isfinite(*value)) {
            *value = *plain_numbers[i].value;
            changed = true;
        } else if (*value < 0 || *value > numbers[i].most) {
            *value = *value < 0 ? 0 : numbers[i].most;
            changed = true;
        }
    }
    return changed;
}

static he_status check_name(const char *name, size_t length, he_error *err)
{
    if (length == 0 || length > HE_MATERIAL_NAME) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "a material's name must have 1 to %d bytes, but this name has %zu",
                             HE_MATERIAL_NAME, length);
    }
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)name[i] < 0x20 && name[i] != '\t') {
            return he_fail_plain(err, HE_BAD_VALUE,
                                 "a material's name must not contain the control character %d",
                                 name[i]);
        }
    }
    return he_is_utf8(name, length)
               ? HE_OK
               : he_fail_plain(err, HE_BAD_VALUE, "a material's name is not UTF-8");
}

/* Checks that the numbers of a material's look are within their ranges, and turns -0 into 0. */
static he_status check_look(he_look *look, he_error *err)
{
    number numbers[NUMBERS];
    list_numbers(look, numbers);
    for (size_t i = 0; i < NUMBERS; i++) {
        double *value = numbers[i].value;
        if (!isfinite(*value)) {
            return he_fail_plain(err, HE_NOT_FINITE, "%s is not finite", numbers[i].name);
        }
        if (*value < 0 || *value > numbers[i].most) {
            return he_fail_plain(err, HE_BAD_VALUE, "%s is %s, not %.17g", numbers[i].name,
                                 numbers[i].most > 1 ? "0 or more" : "from 0 to 1", *value);
        }
        *value += 0.0; /* -0 becomes 0 */
    }
    return HE_OK;
}

static uint32_t mix(uint32_t mark, const void *bytes, size_t size)
{
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; i++) {
        mark = (mark ^ p[i]) * 16777619u;
    }
    return mark;
}

static uint32_t mark_of(he_material *material)
{
    number numbers[NUMBERS];
    unsigned char sides = material->look.two_sided;
    uint32_t mark = mix(2166136261u, material->name, material->length + 1);
    list_numbers(&material->look, numbers);
    for (size_t i = 0; i < NUMBERS; i++) {
        mark = mix(mark, numbers[i].value, sizeof *numbers[i].value);
    }
    mark = mix(mark, &sides, 1);
    return mark == 0 ? 1 : mark;
}

he_status he_material_new(const char *name, size_t length, const he_look *look, he_material **out,
                          he_error *err)
{
    he_look checked = *look;
    he_status status = check_name(name, length, err);
    if (status == HE_OK) {
        status = check_look(&checked, err);
    }
    if (status != HE_OK) {
        return status;
    }
    he_material *material = he_mem_zero(1, sizeof *material + length + 1);
    if (material == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a material");
    }
    atomic_init(&material->references, 1);
    material->look = checked;
    material->length = length;
    memcpy(material->name, name, length);
    material->mark = mark_of(material);
    *out = material;
    return HE_OK;
}

he_material *he_material_retain(he_material *material)
{
    if (material != NULL) {
        atomic_fetch_add_explicit(&material->references, 1, memory_order_relaxed);
    }
    return material;
}

void he_material_release(he_material *material)
{
    if (material != NULL &&
        atomic_fetch_sub_explicit(&material->references, 1, memory_order_acq_rel) == 1) {
        he_mem_free(material);
    }
}

size_t he_material_bytes(const he_material *material)
{
    return material == NULL ? 0 : sizeof *material + material->length + 1;
}

bool he_look_equal(const he_look *a, const he_look *b)
{
    he_look one = *a, other = *b;
    number numbers[NUMBERS], others[NUMBERS];
    bool same = one.two_sided == other.two_sided;
    list_numbers(&one, numbers);
    list_numbers(&other, others);
    for (size_t i = 0; i < NUMBERS && same; i++) {
        same = *numbers[i].value == *others[i].value;
    }
    return same;
}

bool he_material_equal(const he_material *a, const he_material *b)
{
    if (a == NULL || b == NULL || a == b) {
        return a == b;
    }
    return a->mark == b->mark && a->length == b->length &&
           memcmp(a->name, b->name, a->length) == 0 && he_look_equal(&a->look, &b->look);
}

void he_material_number_name(const char *name, unsigned which, char out[HE_MATERIAL_NAME + 1])
{
    he_name_number(name, which, out, HE_MATERIAL_NAME + 1);
}

/* --- tables of materials --- */

void he_materials_clear(he_materials *materials)
{
    for (size_t i = 0; i < materials->count; i++) {
        he_material_release(materials->rows[i]);
    }
    he_mem_free(materials->rows);
    *materials = (he_materials){0};
}

static he_status copy(const he_materials *materials, bool packed, he_materials *out, he_error *err)
{
    he_materials made = {0};
    he_status status = he_materials_reserve(&made, materials->count, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < materials->count; i++) {
        if (!packed || materials->rows[i] != NULL) {
            made.rows[made.count++] = he_material_retain(materials->rows[i]);
        }
    }
    *out = made;
    return HE_OK;
}

he_status he_materials_copy(const he_materials *materials, he_materials *out, he_error *err)
{
    return copy(materials, false, out, err);
}

he_status he_materials_pack(const he_materials *materials, he_materials *out, he_error *err)
{
    return copy(materials, true, out, err);
}

size_t he_materials_count(const he_materials *materials)
{
    size_t count = 0;
    for (size_t i = 0; i < materials->count; i++) {
        count += materials->rows[i] != NULL;
    }
    return count;
}

size_t he_materials_bytes(const he_materials *materials)
{
    size_t bytes = materials->capacity * sizeof *materials->rows;
    for (size_t i = 0; i < materials->count; i++) {
        bytes += he_material_bytes(materials->rows[i]);
    }
    return bytes;
}

static const he_material *row_at(const he_materials *materials, size_t slot)
{
    return slot < materials->count ? materials->rows[slot] : NULL;
}

bool he_materials_equal(const he_materials *a, const he_materials *b)
{
    size_t count = a->count > b->count ? a->count : b->count;
    size_t i = 0;
    while (i < count && he_material_equal(row_at(a, i), row_at(b, i))) {
        i++;
    }
    return i == count;
}

size_t he_materials_find(const he_materials *materials, const char *name, size_t length)
{
    for (size_t i = 0; i < materials->count; i++) {
        const he_material *row = materials->rows[i];
        if (row != NULL && row->length == length && memcmp(row->name, name, length) == 0) {
            return i;
        }
    }
    return SIZE_MAX;
}

size_t he_materials_free_slot(const he_materials *materials)
{
    size_t slot = 0;
    while (slot < materials->count && materials->rows[slot] != NULL) {
        slot++;
    }
    return slot;
}

he_status he_materials_reserve(he_materials *materials, size_t slots, he_error *err)
{
    if (slots > HE_MATERIALS) {
        return he_fail_plain(err, HE_LIMIT, "a mesh has at most %d materials", HE_MATERIALS);
    }
    if (slots <= materials->capacity) {
        return HE_OK;
    }
    size_t capacity = materials->count == 0 ? slots : he_mem_grown(materials->capacity, slots);
    he_material **rows = he_mem_array(materials->rows, capacity, sizeof *rows);
    if (rows == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu materials", slots);
    }
    materials->rows = rows;
    materials->capacity = capacity;
    return HE_OK;
}

he_status he_materials_add(he_materials *materials, he_material *takes, he_error *err)
{
    size_t slot = he_materials_free_slot(materials);
    he_status status = he_materials_reserve(materials, slot + 1, err);
    if (status == HE_OK) {
        materials->count += slot == materials->count;
        materials->rows[slot] = takes;
    }
    return status;
}
