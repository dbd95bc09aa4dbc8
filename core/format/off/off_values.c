#include "format/off/off_values.h"

#include <string.h>

void he_off_values_clear(he_off_values *values)
{
    he_colors_clear(&values->vertex_colors);
    he_colors_clear(&values->face_colors);
}

/* Sets the value of the last vertex in a column. The column is made when the first vertex with a
 * value comes. */
static he_status add_row(he_soup *soup, he_column **column, const char *name, uint32_t components,
                         const double *values, he_error *err)
{
    he_status status = HE_OK;
    if (*column == NULL) {
        status = he_soup_column(
            soup, &(he_column_schema){name, HE_VERTEX, HE_DOUBLE, components, HE_INTERPOLATE},
            column, err);
    }
    if (status == HE_OK) {
        status = he_column_extend(*column, soup->vertex_count - (*column)->rows, err);
    }
    if (status == HE_OK) {
        memcpy(he_column_row(*column, (*column)->rows - 1), values, (*column)->row_bytes);
    }
    return status;
}

he_status he_off_add_normal(he_off_values *values, const double *normal, he_error *err)
{
    return add_row(&values->into->soup, &values->normal, "normal", 3, normal, err);
}

he_status he_off_add_uv(he_off_values *values, const double *uv, he_error *err)
{
    return add_row(&values->into->soup, &values->uv, "uv", 2, uv, err);
}

he_status he_off_values_finish(const he_off_values *values, he_error *err)
{
    he_soup *soup = &values->into->soup;
    he_warnings *warnings = &values->into->warnings;
    he_status status = he_colors_finish(&values->vertex_colors, soup, warnings, HE_VERTEX,
                                        soup->vertex_count, err);
    return status == HE_OK ? he_colors_finish(&values->face_colors, soup, warnings, HE_FACE,
                                              soup->face_count, err)
                           : status;
}
