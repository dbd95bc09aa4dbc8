#include "format/io/colors.h"

#include <math.h>
#include <string.h>

#define FULL_BYTE 255.0

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
    for (size_t i = colors->count; i < element; i++) {
        memcpy(colors->rows[i], (double[]){0, 0, 0, (double)INFINITY}, sizeof *colors->rows);
    }
    double *row = colors->rows[element];
    memcpy(row, values, count * sizeof *row);
    if (count == 3) {
        /* NaN stands for a missing alpha; infinity marks an element without a colour */
        row[3] = (double)NAN;
    }
    for (size_t i = 0; i < 3; i++) {
        colors->broken = colors->broken || values[i] != floor(values[i]);
        colors->highest = fmax(colors->highest, values[i]);
    }
    colors->count = element + 1;
    colors->given++;
    return HE_OK;
}

static bool is_opaque(const he_colors *colors, double full)
{
    size_t i = 0;
    while (i < colors->count && (!isfinite(colors->rows[i][3]) || colors->rows[i][3] == full)) {
        i++;
    }
    return i == colors->count;
}

he_status he_colors_finish(const he_colors *colors, he_soup *soup, he_warnings *warnings,
                           he_kind domain, size_t elements, he_error *err)
{
    if (colors->given == 0) {
        return HE_OK;
    }
    bool above = colors->fractions && !colors->broken && colors->highest > 1;
    double full = above || !colors->fractions ? FULL_BYTE : 1;
    uint32_t components = is_opaque(colors, full) ? 3 : 4;
    he_column *column;
    he_status status = he_soup_column(
        soup, &(he_column_schema){"color", domain, HE_DOUBLE, components, HE_INTERPOLATE}, &column,
        err);
    if (status == HE_OK) {
        status = he_column_extend(column, elements, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < colors->count; i++) {
        double row[4];
        for (size_t k = 0; k < 4; k++) {
            double value = colors->rows[i][k];
            row[k] = isnan(value)        ? 1
                     : isinf(value)      ? 0
                     : full == FULL_BYTE ? fmin(fmax(value / full, 0), 1)
                                         : value;
        }
        memcpy(he_column_row(column, i), row, column->row_bytes);
    }
    if (above) {
        he_warnings_add_count(warnings, "byte_colors",
                              "a colour is read as numbers from 0 to 255, because all colours are "
                              "whole numbers and some are above 1",
                              colors->given);
    }
    return HE_OK;
}

/* --- writing --- */

const he_column *he_colors_find(const he_mesh *mesh, he_kind domain, he_warnings *warnings)
{
    const he_column *column = he_mesh_find_column(mesh, domain, "color");
    bool fraction = column != NULL && (column->type == HE_FLOAT || column->type == HE_DOUBLE);
    return fraction ? he_export_find(mesh, domain, "color", 3, 4, warnings) : NULL;
}

uint32_t he_color_byte(double component)
{
    return (uint32_t)floor(fmin(fmax(component, 0), 1) * FULL_BYTE + 0.5);
}

bool he_color_is_byte(double component)
{
    return he_narrow(he_color_byte(component) / FULL_BYTE) == he_narrow(component);
}

bool he_colors_are_bytes(const he_mesh *mesh, const he_column *column, uint64_t *lost)
{
    *lost = 0;
    for (uint32_t row = 0; row < he_mesh_issued(mesh, column->domain); row++) {
        bool bytes = true;
        for (uint32_t i = 0; i < column->components; i++) {
            bytes = bytes && he_color_is_byte(he_export_number(column, row, i));
        }
        *lost += !bytes && he_mesh_is_live(mesh, column->domain, row);
    }
    return *lost == 0;
}
