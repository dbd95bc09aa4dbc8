#include "edit/whole/attribute.h"

#include "edit/piece/list.h"
#include "mesh/write.h"

#include <math.h>

he_status he_attribute_put(he_mesh *m, he_column *takes, he_error *err)
{
    const he_column *old = he_mesh_find_column(m, takes->domain, takes->name);
    size_t issued = he_mesh_issued(m, takes->domain);
    he_bracket bracket;
    he_status status = HE_OK;
    if (takes->rows < issued) {
        status = he_column_extend(takes, issued - takes->rows, err);
    }
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (old != NULL) {
        status = he_mesh_drop_column(m, he_mesh_column_slot(m, old), err);
    }
    if (status == HE_OK) {
        status = he_mesh_add_column(m, takes, err);
    }
    return he_edit_end(m, &bracket, status);
}

he_status he_attribute_drop(he_mesh *m, const he_column *column, he_error *err)
{
    return he_mesh_drop_column(m, he_mesh_column_slot(m, column), err);
}

he_status he_attribute_write(he_mesh *m, const he_column *column, const uint32_t *ids, size_t count,
                             const void *values, bool same, he_error *err)
{
    he_kind domain = column->domain;
    size_t slot = he_mesh_column_slot(m, column), row_bytes = column->row_bytes;
    he_status status = HE_OK;
    if (ids != NULL) {
        status = he_list_require(m, domain, ids, count, HE_REPEATED_ELEMENT, err);
    }
    if (status == HE_OK) {
        status = he_reserve_values(m, slot, count, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    const unsigned char *value = values;
    size_t places = ids != NULL ? count : he_mesh_issued(m, domain);
    for (size_t i = 0; i < places; i++) {
        uint32_t id = ids != NULL ? ids[i] : (uint32_t)i;
        if (he_mesh_is_live(m, domain, id)) {
            he_set_attribute(m, slot, id, value);
            value += same ? 0 : row_bytes;
        }
    }
    return HE_OK;
}

he_status he_attribute_fill(const he_mesh *m, he_column *column, const void *values, size_t count,
                            he_error *err)
{
    uint32_t issued = he_mesh_issued(m, column->domain), live = he_mesh_count(m, column->domain);
    if (count != live) {
        return he_fail_plain(err, HE_BAD_VALUE, "%zu values are given for %u %s", count, live,
                             he_kind_plural(column->domain));
    }
    he_status status = he_column_extend(column, issued - column->rows, err);
    const unsigned char *value = values;
    for (uint32_t id = 0; status == HE_OK && id < issued; id++) {
        if (he_mesh_is_live(m, column->domain, id)) {
            memcpy(he_column_row(column, id), value, column->row_bytes);
            value += column->row_bytes;
        }
    }
    return status;
}

void he_attribute_settle(const he_mesh *m, he_column *column)
{
    for (size_t row = 0; row < column->rows; row++) {
        if (!he_mesh_is_live(m, column->domain, (uint32_t)row)) {
            memcpy(he_column_row(column, row), column->fallback, column->row_bytes);
        }
    }
}

static he_status check_number(const he_column *column, const unsigned char *at, he_error *err)
{
    uint32_t whole;
    float single;
    double number;
    switch (column->type) {
    case HE_BOOL:
        if (*at > 1) {
            return he_fail_plain(err, HE_BAD_VALUE, "a bool is 0 or 1, not %u", *at);
        }
        break;
    case HE_UINT32:
        memcpy(&whole, at, sizeof whole);
        if (column->labels != NULL && whole >= he_labels_count(column->labels)) {
            return he_fail_plain(err, HE_BAD_VALUE, "%u is not the index of one of the %zu labels",
                                 whole, he_labels_count(column->labels));
        }
        break;
    case HE_FLOAT:
        memcpy(&single, at, sizeof single);
        if (!isfinite(single)) {
            return he_fail_plain(err, HE_NOT_FINITE, "a value is not finite");
        }
        break;
    case HE_DOUBLE:
        memcpy(&number, at, sizeof number);
        if (!isfinite(number)) {
            return he_fail_plain(err, HE_NOT_FINITE, "a value is not finite");
        }
        break;
    case HE_INT32:
    case HE_TYPE_COUNT:
        break;
    }
    return HE_OK;
}

he_status he_attribute_check(const he_column *column, const void *values, size_t count, size_t *at,
                             he_error *err)
{
    size_t size = he_type_bytes(column->type), numbers = count * column->components;
    const unsigned char *bytes = values;
    for (size_t i = 0; i < numbers; i++) {
        he_status status = check_number(column, bytes + i * size, err);
        if (status != HE_OK) {
            *at = i;
            return status;
        }
    }
    return HE_OK;
}
