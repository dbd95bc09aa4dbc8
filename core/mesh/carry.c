/* How attributes follow an edit: the carry functions of write.h. */
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

/* The weighted sum of n rows in the column's own type. Integers and booleans round to nearest. */
static void blend(const he_column *column, const uint32_t *rows, const double *weights, size_t n,
                  unsigned char *out)
{
    size_t size = he_type_bytes(column->type);
    for (uint32_t k = 0; k < column->components; k++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) {
            const unsigned char *from = he_column_value(column, rows[i]) + k * size;
            double value = 0;
            switch (column->type) {
            case HE_BOOL:
                value = *from;
                break;
            case HE_INT32: {
                int32_t number;
                memcpy(&number, from, sizeof number);
                value = number;
                break;
            }
            case HE_UINT32: {
                uint32_t number;
                memcpy(&number, from, sizeof number);
                value = number;
                break;
            }
            case HE_FLOAT: {
                float number;
                memcpy(&number, from, sizeof number);
                value = (double)number;
                break;
            }
            case HE_DOUBLE:
                memcpy(&value, from, sizeof value);
                break;
            case HE_TYPE_COUNT:
                break;
            }
            sum += weights[i] * value;
        }
        unsigned char *to = out + k * size;
        switch (column->type) {
        case HE_BOOL:
            *to = sum >= 0.5;
            break;
        case HE_INT32: {
            int32_t number = (int32_t)(sum < 0 ? sum - 0.5 : sum + 0.5);
            memcpy(to, &number, sizeof number);
            break;
        }
        case HE_UINT32: {
            uint32_t number = (uint32_t)(sum + 0.5);
            memcpy(to, &number, sizeof number);
            break;
        }
        case HE_FLOAT: {
            float number = (float)sum;
            memcpy(to, &number, sizeof number);
            break;
        }
        case HE_DOUBLE:
            memcpy(to, &sum, sizeof sum);
            break;
        case HE_TYPE_COUNT:
            break;
        }
    }
}

/* Give row `to` of every column in a domain what its rule makes of n rows. */
static void carry(he_mesh *m, he_kind kind, uint32_t to, const uint32_t *rows,
                  const double *weights, size_t n, uint32_t nearest)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column == NULL || column->domain != kind) {
            continue;
        }
        unsigned char value[HE_COLUMN_ROW_BYTES];
        switch (column->rule) {
        case HE_COPY:
            memcpy(value, he_column_value(column, nearest), column->row_bytes);
            break;
        case HE_INTERPOLATE:
            blend(column, rows, weights, n, value);
            break;
        case HE_DEFAULT:
        case HE_RULE_COUNT:
            memcpy(value, column->fallback, column->row_bytes);
            break;
        }
        he_set_attribute(m, i, to, value);
    }
}

void he_carry_between(he_mesh *m, he_kind kind, uint32_t to, uint32_t a, uint32_t b, double t)
{
    const uint32_t rows[2] = {a, b};
    const double weights[2] = {1 - t, t};
    carry(m, kind, to, rows, weights, 2, t < 1 ? a : b);
}

void he_carry_copy(he_mesh *m, he_kind kind, uint32_t to, uint32_t from)
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

enum { MEAN_BLOCK = 64 };

void he_carry_mean(he_mesh *m, he_kind kind, uint32_t to, const uint32_t *from, size_t n)
{
    if (n == 0 || !he_has_columns(m, kind)) {
        return;
    }
    /* The running mean of blocks: exact enough, and no memory however many rows there are. The
     * target row itself holds the mean so far. */
    size_t done = 0;
    while (done < n) {
        uint32_t rows[MEAN_BLOCK + 1];
        double weights[MEAN_BLOCK + 1];
        size_t take = n - done < MEAN_BLOCK ? n - done : MEAN_BLOCK;
        double total = (double)(done + take);
        rows[0] = to;
        weights[0] = (double)done / total;
        for (size_t i = 0; i < take; i++) {
            rows[i + 1] = from[done + i];
            weights[i + 1] = 1 / total;
        }
        carry(m, kind, to, rows, weights, take + 1, from[0]);
        done += take;
    }
}
