#include "build/keep.h"

#include "mesh/marks.h"

#include <string.h>

static bool is_value(const he_column *column)
{
    return column->domain == HE_VERTEX && !he_is_mark(column, "locked") &&
           !he_is_mark(column, "selected") && !he_is_mark(column, "feature");
}

static bool holds_default(const he_column *column, size_t row)
{
    return memcmp(he_column_value(column, row), column->fallback, column->row_bytes) == 0;
}

typedef struct joining {
    he_soup *soup;
    const uint32_t *into, *from;
    bool *has_corners; /* true for each vertex at which a face has a corner */
} joining;

/* Returns true if merging vertex v into another vertex would change the value of an attribute at
 * the corners of v. If the attribute's rule is HE_DEFAULT, the default value counts as no value. */
static bool differs(const joining *j, const he_column *column, uint32_t v)
{
    const unsigned char *value = he_column_value(column, v);
    return j->has_corners[v] &&
           memcmp(value, he_column_value(column, j->from[j->into[v]]), column->row_bytes) != 0 &&
           (column->rule != HE_DEFAULT || !holds_default(column, v));
}

static uint64_t count_differing(const joining *j, const he_column *column)
{
    uint64_t count = 0;
    for (uint32_t v = 0; v < j->soup->vertex_count; v++) {
        count += differs(j, column, v);
    }
    return count;
}

static he_column *find_column(const he_soup *soup, he_kind domain, const char *name)
{
    for (size_t i = 0; i < soup->column_count; i++) {
        if (soup->columns[i]->domain == domain && strcmp(soup->columns[i]->name, name) == 0) {
            return soup->columns[i];
        }
    }
    return NULL;
}

/* Returns true if the corner attribute `corners` already has the values that merging vertices would
 * remove from the vertex attribute `column`. */
static bool is_kept(const joining *j, const he_column *corners, const he_column *column)
{
    const he_soup *soup = j->soup;
    bool kept = he_column_same_values(corners, column);
    for (size_t c = 0; c < soup->corner_count && kept; c++) {
        uint32_t v = soup->corners[c];
        kept = !differs(j, column, v) || memcmp(he_column_value(corners, c),
                                                he_column_value(column, v), column->row_bytes) == 0;
    }
    return kept;
}

/* Adds the corner attribute `takes` to the soup. Removes the vertex attribute `column`, from which
 * it was made, unless `stays` is true. */
static he_status put_column(he_soup *soup, he_column *column, he_column *takes, bool stays,
                            he_error *err)
{
    size_t i = 0;
    while (soup->columns[i] != column) {
        i++;
    }
    if (!stays) {
        soup->columns[i] = takes;
        he_column_free(column);
        return HE_OK;
    }
    return he_soup_take_column(soup, takes, err);
}

static he_status add_corners(he_soup *soup, he_column *column, const char *name, bool stays,
                             he_error *err)
{
    he_column *made = NULL;
    uint64_t limit = soup->limits.bytes;
    if (limit != 0 && soup->corner_count * (uint64_t)column->row_bytes > limit) {
        return he_fail_plain(
            err, HE_LIMIT, "the corner values of attribute %s need more than %llu bytes of memory",
            column->name, (unsigned long long)limit);
    }
    he_status status = he_column_for_corners(column, name, soup->corner_count, &made, err);
    for (size_t c = 0; c < soup->corner_count && status == HE_OK; c++) {
        memcpy(he_column_row(made, c), he_column_value(column, soup->corners[c]),
               column->row_bytes);
        status = he_progress_at(soup->limits.progress, c, soup->corner_count, err);
    }
    if (status == HE_OK) {
        status = put_column(soup, column, made, stays, err);
    }
    if (status != HE_OK) {
        he_column_free(made);
    }
    return status;
}

/* Returns true if a vertex at which no face has a corner has a value other than the default. Then
 * the vertex attribute must stay although its values were copied to a corner attribute. */
static bool is_needed(const joining *j, const he_column *column)
{
    size_t v = 0;
    while (v < j->soup->vertex_count && (j->has_corners[v] || holds_default(column, v))) {
        v++;
    }
    return v < j->soup->vertex_count;
}

static he_status keep_column(const joining *j, he_column *column, he_error *err)
{
    char name[HE_COLUMN_NAME];
    const he_column *corners;
    unsigned number = 1;
    do {
        he_column_number_name(column->name, number++, name);
        corners = find_column(j->soup, HE_HALFEDGE, name);
        if (corners != NULL && is_kept(j, corners, column)) {
            return HE_OK;
        }
    } while (corners != NULL);
    return add_corners(j->soup, column, name, is_needed(j, column), err);
}

he_status he_soup_keep_values(he_soup *soup, const uint32_t *into, const uint32_t *from,
                              uint64_t *moved, he_error *err)
{
    joining j = {soup, into, from, NULL};
    size_t columns = soup->column_count, values = 0;
    *moved = 0;
    for (size_t i = 0; i < columns; i++) {
        values += is_value(soup->columns[i]);
    }
    if (values == 0) {
        return HE_OK;
    }
    j.has_corners = he_mem_zero(soup->vertex_count + 1, sizeof *j.has_corners);
    if (j.has_corners == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to join %zu vertices",
                             soup->vertex_count);
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        j.has_corners[soup->corners[c]] = true;
    }
    he_status status = HE_OK;
    for (size_t i = 0; i < columns && status == HE_OK; i++) {
        he_column *column = soup->columns[i];
        uint64_t count = is_value(column) ? count_differing(&j, column) : 0;
        if (count > 0) {
            status = keep_column(&j, column, err);
            *moved += count;
        }
    }
    he_mem_free(j.has_corners);
    return status;
}

he_status he_soup_to_corners(he_soup *soup, const char *name, he_error *err)
{
    he_column *column = find_column(soup, HE_VERTEX, name);
    return column == NULL || find_column(soup, HE_HALFEDGE, name) != NULL
               ? HE_OK
               : add_corners(soup, column, name, false, err);
}
