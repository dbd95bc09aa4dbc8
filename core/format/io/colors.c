#include "format/io/colors.h"

#include <math.h>
#include <string.h>

void he_colors_clear(he_colors *colors)
{
    he_mem_free(colors->rows);
    *colors = (he_colors){0};
}

he_status he_colors_add(he_colors *colors, size_t element, const double *values, size_t count,
                        he_error *err)
{
    if (element >= colors->capacity) {
        size_t capacity = he_mem_grown(colors->capacity, element + 1);
        double(*rows)[4] = he_mem_array(colors->rows, capacity, sizeof *rows);
        if (rows == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu colours", capacity);
        }
        colors->rows = rows;
        colors->capacity = capacity;
    }
    memset(colors->rows + colors->count, 0, (element - colors->count) * sizeof *colors->rows);
    double *row = colors->rows[element];
    memcpy(row, values, count * sizeof *row);
    if (count == 4) {
        colors->alpha = true;
    } else {
        row[3] = (double)NAN; /* not given: what is read is finite */
    }
    colors->count = element + 1;
    colors->given++;
    return HE_OK;
}

he_status he_colors_finish(const he_colors *colors, he_soup *soup, he_kind domain, size_t elements,
                           he_error *err)
{
    if (colors->given == 0) {
        return HE_OK;
    }
    he_column *column;
    size_t components = colors->alpha ? 4 : 3;
    he_status status =
        he_soup_column(soup, "color", domain, colors->fractions ? HE_DOUBLE : HE_UINT32,
                       (uint32_t)components, HE_INTERPOLATE, &column, err);
    if (status == HE_OK) {
        status = he_column_extend(column, elements, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < colors->count; i++) {
        double row[4];
        uint32_t whole[4];
        memcpy(row, colors->rows[i], sizeof row);
        if (isnan(row[3])) {
            row[3] = colors->fractions ? 1 : 255;
        }
        for (size_t k = 0; k < 4; k++) {
            whole[k] = colors->fractions ? 0 : (uint32_t)row[k];
        }
        memcpy(he_column_row(column, i), colors->fractions ? (const void *)row : whole,
               column->row_bytes);
    }
    return HE_OK;
}
