/* attribute_transfer.c - the functions of write.h that compute the attributes of an element from
 * the attributes of other elements. */
#include "mesh/marks.h"
#include "mesh/write.h"

bool he_has_columns(const he_mesh *m, he_kind kind)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        if (m->c.columns[i] != NULL && m->c.columns[i]->domain == kind) {
            return true;
        }
    }
    return false;
}

void he_column_blend(const he_column *column, const uint32_t *rows, const double *weights, size_t n,
                     unsigned char *out)
{
    for (uint32_t k = 0; k < column->components; k++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) {
            const double weight = weights == NULL ? 1.0 / (double)n : weights[i];
            sum += weight * he_column_number(column, rows[i], k);
        }
        he_column_put_number(column, k, sum, out);
    }
}

/* The elements from whose attribute values the value of another element is computed, and the
 * weights of these elements. */
typedef struct mixture {
    const uint32_t *rows;
    const double *weights; /* the weight of each element; NULL if all weights are equal */
    size_t n;
    uint32_t nearest; /* the element whose value is copied if the column's rule is copy */
} mixture;

/* Sets the attributes of element `to`. In each attribute column for this kind of element, the
 * column's rule (copy, interpolate or default) computes the new value from the elements in `of`. */
static void carry(he_mesh *m, he_kind kind, uint32_t to, const mixture *of)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column == NULL || column->domain != kind) {
            continue;
        }
        unsigned char value[HE_COLUMN_ROW_BYTES];
        bool spreads = kind != HE_VERTEX || !he_is_mark(column, "locked");
        switch (spreads ? column->rule : HE_DEFAULT) {
        case HE_COPY:
            memcpy(value, he_column_value(column, of->nearest), column->row_bytes);
            break;
        case HE_INTERPOLATE:
            he_column_blend(column, of->rows, of->weights, of->n, value);
            break;
        case HE_DEFAULT:
        case HE_RULE_COUNT:
            memcpy(value, column->fallback, column->row_bytes);
            break;
        }
        he_set_attribute(m, i, to, value);
    }
}

void he_values_between(he_mesh *m, he_kind kind, uint32_t to, uint32_t a, uint32_t b, double t)
{
    const uint32_t rows[2] = {a, b};
    const double weights[2] = {1 - t, t};
    carry(m, kind, to, &(mixture){rows, weights, 2, t < 1 ? a : b});
}

void he_values_copy(he_mesh *m, he_kind kind, uint32_t to, uint32_t from)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column != NULL && column->domain == kind) {
            unsigned char value[HE_COLUMN_ROW_BYTES];
            const unsigned char *row =
                column->rule == HE_DEFAULT ? column->fallback : he_column_value(column, from);
            memcpy(value, row, column->row_bytes);
            he_set_attribute(m, i, to, value);
        }
    }
}

void he_attributes_mean(he_mesh *m, he_kind kind, uint32_t to, const uint32_t *from, size_t n)
{
    if (n > 0) {
        carry(m, kind, to, &(mixture){from, NULL, n, from[0]});
    }
}

void he_values_mix(he_mesh *m, he_kind kind, uint32_t row, uint32_t other, double t)
{
    const uint32_t rows[2] = {other, row};
    const double weights[2] = {1 - t, t};
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column != NULL && column->domain == kind && column->rule == HE_INTERPOLATE) {
            unsigned char value[HE_COLUMN_ROW_BYTES];
            he_column_blend(column, rows, weights, 2, value);
            he_set_attribute(m, i, row, value);
        }
    }
}

void he_values_merge(he_mesh *m, he_kind kind, uint32_t into, uint32_t gone, double t)
{
    if (!he_is_marked(he_mark_find(m, kind, "locked"), into)) {
        he_values_mix(m, kind, into, gone, t);
    }
}

void he_values_move(he_mesh *m, he_kind kind, uint32_t to, uint32_t from)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column != NULL && column->domain == kind) {
            unsigned char value[HE_COLUMN_ROW_BYTES];
            memcpy(value, he_column_value(column, from), column->row_bytes);
            he_set_attribute(m, i, to, value);
        }
    }
}
