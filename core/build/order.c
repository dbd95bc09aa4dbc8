#include "build/order.h"

#include <string.h>

static uint32_t end_of(const he_soup *soup, size_t face)
{
    return face + 1 < soup->face_count ? soup->starts[face + 1] : (uint32_t)soup->corner_count;
}

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to sort %zu faces", soup->face_count);
}

/* Moves each row i of a column to row to[i]. */
static he_status move_rows(he_column *column, const uint32_t *to, size_t rows, he_error *err)
{
    he_column *moved = NULL;
    he_status status = he_column_like(column, rows, &moved, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < column->rows && i < rows; i++) {
        memcpy(he_column_row(moved, to[i]), he_column_row(column, i), column->row_bytes);
    }
    he_mem_free(column->data);
    column->data = moved->data;
    column->rows = moved->rows;
    column->capacity = moved->capacity;
    moved->data = NULL;
    he_column_free(moved);
    return HE_OK;
}

/* Computes where the corners of each face begin after faces are renumbered, and the new index of
 * each corner. */
static void place(const he_soup *soup, const uint32_t *number, uint32_t *starts, uint32_t *to)
{
    size_t faces = soup->face_count;
    uint32_t at = 0;
    for (size_t f = 0; f < faces; f++) {
        starts[number[f]] = end_of(soup, f) - soup->starts[f];
    }
    for (size_t f = 0; f < faces; f++) {
        uint32_t degree = starts[f];
        starts[f] = at;
        at += degree;
    }
    for (size_t f = 0; f < faces; f++) {
        for (uint32_t c = soup->starts[f]; c < end_of(soup, f); c++) {
            to[c] = starts[number[f]] + (c - soup->starts[f]);
        }
    }
}

he_status he_soup_order_faces(he_soup *soup, const uint32_t *number, he_error *err)
{
    uint32_t *starts = he_mem_array(NULL, soup->face_count + 1, sizeof *starts);
    uint32_t *corners = he_mem_array(NULL, soup->corner_count + 1, sizeof *corners);
    uint32_t *to = he_mem_array(NULL, soup->corner_count + 1, sizeof *to);
    he_status status = HE_OK;
    if (starts == NULL || corners == NULL || to == NULL) {
        status = no_memory(soup, err);
        goto out;
    }
    place(soup, number, starts, to);
    for (size_t i = 0; i < soup->column_count && status == HE_OK; i++) {
        he_column *column = soup->columns[i];
        if (column->domain == HE_FACE) {
            status = move_rows(column, number, soup->face_count, err);
        } else if (column->domain == HE_HALFEDGE) {
            status = move_rows(column, to, soup->corner_count, err);
        }
    }
    if (status != HE_OK) {
        goto out;
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        corners[to[c]] = soup->corners[c];
    }
    if (soup->face_count > 0) {
        memcpy(soup->starts, starts, soup->face_count * sizeof *starts);
    }
    if (soup->corner_count > 0) {
        memcpy(soup->corners, corners, soup->corner_count * sizeof *corners);
    }
out:
    he_mem_free(starts);
    he_mem_free(corners);
    he_mem_free(to);
    return status;
}
