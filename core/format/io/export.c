#include "format/io/export.h"

#include "format/text/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

he_status he_export_numbers(const he_mesh *mesh, uint32_t **out, he_error *err)
{
    uint32_t issued = mesh->c.vertices.issued, next = 0;
    if (mesh->c.vertices.live == issued) {
        *out = NULL;
        return HE_OK;
    }
    uint32_t *numbers = he_mem_array(NULL, issued, sizeof *numbers);
    if (numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to number %u vertices", issued);
    }
    for (uint32_t v = 0; v < issued; v++) {
        numbers[v] = next;
        next += he_vertex_is_live(mesh, (he_vertex){v});
    }
    *out = numbers;
    return HE_OK;
}

void he_narrowed_add(he_narrowed *narrowed, uint32_t vertex, he_vec3 position)
{
    if (he_are_floats(position)) {
        return;
    }
    if (fmax(fabs(position.x), fmax(fabs(position.y), fabs(position.z))) > (double)FLT_MAX) {
        narrowed->first = narrowed->beyond == 0 ? vertex : narrowed->first;
        narrowed->beyond++;
    } else {
        narrowed->rounded++;
    }
}

he_status he_narrowed_finish(const he_narrowed *narrowed, he_warnings *warnings, he_error *err)
{
    if (narrowed->beyond > 0) {
        char more[40] = "";
        if (narrowed->beyond > 1) {
            snprintf(more, sizeof more, " (and %llu more)",
                     (unsigned long long)narrowed->beyond - 1);
        }
        return he_fail(err, HE_BEYOND_FLOAT, HE_VERTEX, narrowed->first,
                       "vertex %u has a coordinate too large for the floats of this format%s",
                       narrowed->first, more);
    }
    he_warnings_add_count(
        warnings, "rounded",
        "a position is rounded to 32-bit floats, because the format stores positions so",
        narrowed->rounded);
    return HE_OK;
}

static double component_of(const he_column *column, size_t row, uint32_t component)
{
    const unsigned char *at =
        he_column_value(column, row) + component * he_type_bytes(column->type);
    switch (column->type) {
    case HE_BOOL:
        return *at != 0;
    case HE_INT32: {
        int32_t value;
        memcpy(&value, at, sizeof value);
        return value;
    }
    case HE_UINT32: {
        uint32_t value;
        memcpy(&value, at, sizeof value);
        return value;
    }
    case HE_FLOAT: {
        float value;
        memcpy(&value, at, sizeof value);
        return (double)value;
    }
    case HE_DOUBLE: {
        double value;
        memcpy(&value, at, sizeof value);
        return value;
    }
    case HE_TYPE_COUNT:
        break;
    }
    return 0;
}

const he_column *he_export_find(const he_mesh *mesh, he_kind domain, const char *name,
                                uint32_t least, uint32_t most, he_warnings *warnings)
{
    const he_column *column = he_mesh_find_column(mesh, domain, name);
    if (column == NULL || column->components < least || column->components > most ||
        column->labels != NULL) {
        return NULL;
    }
    if (column->type != HE_FLOAT && column->type != HE_DOUBLE) {
        return column;
    }
    for (size_t row = 0; row < column->rows; row++) {
        for (uint32_t i = 0; i < column->components; i++) {
            if (!isfinite(component_of(column, row, i))) {
                he_warnings_add(
                    warnings,
                    &(he_occurrence){
                        .code = "not_finite",
                        .text = "a value of attribute % is written as 0, because it is not finite",
                        .subject = name,
                        .length = strlen(name)});
            }
        }
    }
    return column;
}

void he_export_note_lost(const he_mesh *mesh, const he_column *const *used, size_t count,
                         he_warnings *warnings)
{
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        size_t k = 0;
        while (k < count && used[k] != column) {
            k++;
        }
        if (column != NULL && k == count) {
            char subject[HE_COLUMN_NAME + 16];
            int length = snprintf(subject, sizeof subject, "%s %s", he_kind_name(column->domain),
                                  column->name);
            he_warnings_add(
                warnings,
                &(he_occurrence){
                    .code = "attribute_lost",
                    .text = "attribute % is not written, because the format cannot hold it",
                    .subject = subject,
                    .length = (size_t)length});
        }
    }
}

void he_export_note_materials(const he_mesh *mesh, he_warnings *warnings)
{
    he_warnings_add_count(warnings, "materials_lost",
                          "the colours and other properties of a material are not written, because "
                          "the format cannot hold them",
                          he_materials_count(he_mesh_materials(mesh)));
}

char *he_export_text(const char *text, char *to)
{
    while (*text != '\0') {
        *to++ = *text++;
    }
    return to;
}

double he_export_number(const he_column *column, size_t row, uint32_t component)
{
    double value = component_of(column, row, component);
    return isfinite(value) ? value : 0;
}

char *he_export_value(const he_column *column, size_t row, uint32_t component, char *to)
{
    double value = he_export_number(column, row, component);
    return to + (column->type == HE_FLOAT ? he_float_print((float)value, to)
                                          : he_double_print(value, to));
}

char *he_export_row(const he_column *column, size_t row, char *to)
{
    for (uint32_t i = 0; i < column->components; i++) {
        *to++ = ' ';
        to = he_export_value(column, row, i, to);
    }
    return to;
}

/* Continues the hash h with more bytes. The first h, the seed, is not known to clients, so they
 * cannot choose many values whose hashes collide. */
static uint64_t hash(uint64_t h, const void *bytes, size_t length)
{
    const unsigned char *p = bytes;
    while (length > 0) {
        uint64_t word = 0;
        size_t n = length < sizeof word ? length : sizeof word;
        memcpy(&word, p, n);
        h = (h ^ word) * 0x9E3779B97F4A7C15;
        h ^= h >> 32;
        p += n;
        length -= n;
    }
    return h;
}

typedef struct table {
    const he_mesh *mesh;
    const he_column *const *columns;
    size_t count;
    bool apart;
    uint32_t *slots; /* hash table: a slot has the number of a distinct value + 1, a free slot 0 */
    size_t mask;
} table;

static bool say_the_same(const table *t, uint32_t h, uint32_t k)
{
    bool same = !t->apart || t->mesh->c.origin[h] == t->mesh->c.origin[k];
    for (size_t i = 0; i < t->count && same; i++) {
        same = memcmp(he_column_value(t->columns[i], h), he_column_value(t->columns[i], k),
                      t->columns[i]->row_bytes) == 0;
    }
    return same;
}

/* Returns the slot of the hash table that holds the values of half-edge h, or the free slot where
 * they belong. */
static size_t slot_of(const table *t, const he_ids *first, uint32_t h)
{
    uint64_t sum = (uint64_t)(uintptr_t)t->slots * 0x94D049BB133111EB;
    if (t->apart) {
        sum = hash(sum, &t->mesh->c.origin[h], sizeof(uint32_t));
    }
    for (size_t i = 0; i < t->count; i++) {
        sum = hash(sum, he_column_value(t->columns[i], h), t->columns[i]->row_bytes);
    }
    size_t slot = (size_t)(sum * 0xBF58476D1CE4E5B9 >> 16) & t->mask;
    while (t->slots[slot] != 0 && !say_the_same(t, first->ids[t->slots[slot] - 1], h)) {
        slot = (slot + 1) & t->mask;
    }
    return slot;
}

static he_status widen(table *t, const he_ids *first, he_error *err)
{
    size_t count = t->slots == NULL ? 1024 : 2 * (t->mask + 1);
    uint32_t *slots = he_mem_zero(count, sizeof *slots);
    if (slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu corner values", count);
    }
    he_mem_free(t->slots);
    t->slots = slots;
    t->mask = count - 1;
    for (size_t i = 0; i < first->count; i++) {
        slots[slot_of(t, first, first->ids[i])] = (uint32_t)i + 1;
    }
    return HE_OK;
}

he_status he_distinct_make(const he_mesh *mesh, const he_column *const *columns, size_t count,
                           bool apart, he_progress *progress, he_distinct *out, he_error *err)
{
    he_distinct made = {0};
    table t = {.mesh = mesh, .columns = columns, .count = count, .apart = apart};
    he_status status = HE_OK;
    made.number = he_mem_array(NULL, 2 * (size_t)mesh->c.edges.issued, sizeof *made.number);
    if (made.number == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to number corner values");
    }
    status = he_ids_reserve(&made.first, 1024, err);
    if (status == HE_OK) {
        status = widen(&t, &made.first, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    for (uint32_t f = 0; f < mesh->c.faces.issued; f++) {
        status = he_progress_at(progress, f, mesh->c.faces.issued, err);
        if (status != HE_OK) {
            goto out;
        }
        if (!he_face_is_live(mesh, (he_face){f})) {
            continue;
        }
        uint32_t start = mesh->c.face_halfedge[f], h = start;
        do {
            if (made.first.count * 2 >= t.mask) {
                status = widen(&t, &made.first, err);
                if (status != HE_OK) {
                    goto out;
                }
            }
            size_t slot = slot_of(&t, &made.first, h);
            if (t.slots[slot] == 0) {
                status = he_ids_add(&made.first, h, err);
                if (status != HE_OK) {
                    goto out;
                }
                t.slots[slot] = (uint32_t)made.first.count;
            }
            made.number[h] = t.slots[slot] - 1;
            h = mesh->c.next[h];
        } while (h != start);
    }
    *out = made;
    made = (he_distinct){0};
out:
    he_mem_free(t.slots);
    he_distinct_clear(&made);
    return status;
}

void he_distinct_clear(he_distinct *distinct)
{
    he_mem_free(distinct->number);
    he_ids_clear(&distinct->first);
    distinct->number = NULL;
}
