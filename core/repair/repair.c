#include "repair/repair.h"

#include "build/soup_check.h"
#include "repair/mend.h"

#include <string.h>

const char *const he_repair_names[] = {
    "weld", "drop_degenerate", "drop_duplicates", "orient", "split", "fill", NULL,
};

void he_repaired_clear(he_repaired *repaired)
{
    he_mem_free(repaired->vertex_from);
    he_mem_free(repaired->face_from);
    *repaired = (he_repaired){0};
}

bool he_repaired_soup(const he_repaired *repaired)
{
    return repaired->vertex_from != NULL || repaired->face_from != NULL ||
           repaired->accounts[HE_REPAIR_ORIENT].count > 0;
}

static uint32_t vertex_of_input(const he_repaired *repaired, uint32_t v)
{
    bool is_known = repaired->vertex_from != NULL && v < repaired->vertices;
    return is_known ? repaired->vertex_from[v] : v;
}

void he_repaired_report(const he_repaired *repaired, he_report *report)
{
    for (size_t i = 0; i < report->total && i < HE_REPORT_DEFECTS; i++) {
        he_defect *defect = &report->defects[i];
        if (defect->kind == HE_VERTEX) {
            defect->id = vertex_of_input(repaired, defect->id);
        } else if (repaired->face_from != NULL) {
            defect->id = repaired->face_from[defect->id];
        }
        if (defect->vertex != HE_NONE) {
            defect->vertex = vertex_of_input(repaired, defect->vertex);
        }
        if (defect->other != HE_NONE) {
            defect->other = vertex_of_input(repaired, defect->other);
        }
    }
}

/* --- functions that the repairs share --- */

uint32_t *he_mend_same(size_t count, size_t room)
{
    uint32_t *list = he_mem_array(NULL, room, sizeof *list);
    for (uint32_t i = 0; list != NULL && i < count; i++) {
        list[i] = i;
    }
    return list;
}

bool he_mend_has_corner_values(const he_soup *soup)
{
    size_t i = 0;
    while (i < soup->column_count && soup->columns[i]->domain != HE_HALFEDGE) {
        i++;
    }
    return i < soup->column_count;
}

he_status he_mend_corners(he_mend *m, he_error *err)
{
    if (!m->has_corner_values || m->corner_from != NULL) {
        return HE_OK;
    }
    m->corner_from = he_mend_same(m->soup->corner_count, m->soup->corner_count);
    return m->corner_from != NULL ? HE_OK
                                  : he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu corners",
                                                  m->soup->corner_count);
}

void he_mend_faces(const he_soup *soup, uint32_t *face_of)
{
    for (uint32_t f = 0; f < soup->face_count; f++) {
        for (uint32_t c = soup->starts[f], end = he_soup_end(soup, f); c < end; c++) {
            face_of[c] = f;
        }
    }
}

/* --- attributes --- */

static he_status carry_column(he_column *column, const uint32_t *from, size_t rows, he_error *err)
{
    if (column->rows == 0) {
        return HE_OK;
    }
    unsigned char *data = he_mem_array(NULL, rows, column->row_bytes);
    if (data == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu values of attribute %s", rows,
                             column->name);
    }
    for (size_t i = 0; i < rows; i++) {
        memcpy(data + i * column->row_bytes, he_column_value(column, from[i]), column->row_bytes);
    }
    he_mem_free(column->data);
    column->data = data;
    column->rows = column->capacity = rows;
    return HE_OK;
}

static he_status carry(const he_mend *m, he_error *err)
{
    he_soup *soup = m->soup;
    he_status status = HE_OK;
    for (size_t i = 0; i < soup->column_count && status == HE_OK; i++) {
        he_column *column = soup->columns[i];
        if (column->domain == HE_VERTEX && m->out->vertex_from != NULL) {
            status = carry_column(column, m->out->vertex_from, soup->vertex_count, err);
        } else if (column->domain == HE_FACE && m->out->face_from != NULL) {
            status = carry_column(column, m->out->face_from, soup->face_count, err);
        } else if (column->domain == HE_HALFEDGE && m->corner_from != NULL) {
            status = carry_column(column, m->corner_from, soup->corner_count, err);
        }
    }
    return status;
}

/* Reverses the normals of the faces that the repair `orient` reversed, and the normals of their
 * corners. */
static he_status turn_normals(const he_mend *m, he_column *column, he_error *err)
{
    const he_soup *soup = m->soup;
    size_t rows = column->domain == HE_FACE ? soup->face_count : soup->corner_count;
    he_status status = HE_OK;
    if (column->rows < rows) {
        status = he_column_extend(column, rows - column->rows, err);
    }
    for (uint32_t f = 0; f < soup->face_count && status == HE_OK; f++) {
        if (!he_bits_get(m->turned, f)) {
            continue;
        }
        if (column->domain == HE_FACE) {
            he_normal_negate(column, he_column_row(column, f));
            continue;
        }
        for (uint32_t c = soup->starts[f], end = he_soup_end(soup, f); c < end; c++) {
            he_normal_negate(column, he_column_row(column, c));
        }
    }
    return status;
}

static he_status turn_all_normals(const he_mend *m, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; m->turned != NULL && i < m->soup->column_count && status == HE_OK; i++) {
        he_column *column = m->soup->columns[i];
        if (he_is_normal_column(column) &&
            (column->domain == HE_FACE || column->domain == HE_HALFEDGE)) {
            status = turn_normals(m, column, err);
        }
    }
    return status;
}

/* --- all repairs --- */

bool he_mend_has_bad_index(const he_soup *soup)
{
    size_t c = 0;
    while (c < soup->corner_count && soup->corners[c] < soup->vertex_count) {
        c++;
    }
    return c < soup->corner_count;
}

/* Decides whether each face by itself is valid for he_build. If not, the repairs that come later
 * cannot run. */
static he_status is_proper(const he_soup *soup, bool *out, he_error *err)
{
    uint64_t total = 0;
    he_status status = he_soup_check_faces(soup, NULL, &total, err);
    *out = total == 0;
    return status;
}

static he_status run(he_mend *m, const he_repair_plan *plan, he_repair repair, he_error *err)
{
    switch (repair) {
    case HE_REPAIR_WELD:
        return he_mend_weld(m, plan->tolerance, err);
    case HE_REPAIR_DROP_DEGENERATE:
        return he_mend_drop_degenerate(m, err);
    case HE_REPAIR_DROP_DUPLICATES:
        return he_mend_drop_duplicates(m, err);
    case HE_REPAIR_ORIENT:
        return he_mend_orient(m, (plan->which & he_repair_bit(HE_REPAIR_SPLIT)) != 0, err);
    case HE_REPAIR_SPLIT:
        return he_mend_split(m, err);
    case HE_REPAIR_FILL:
    case HE_REPAIR_COUNT:
        break; /* fill is a repair of meshes, not of soups */
    }
    return HE_OK;
}

he_status he_repair_soup(he_soup *soup, const he_repair_plan *plan, he_repaired *out, he_error *err)
{
    he_mend m = {.soup = soup, .out = out};
    he_status status = HE_OK;
    if (he_mend_has_bad_index(soup)) {
        return HE_OK;
    }
    m.has_corner_values = he_mend_has_corner_values(soup);
    bool goes_on = true;
    for (he_repair r = HE_REPAIR_WELD; r < HE_REPAIR_FILL && status == HE_OK && goes_on; r++) {
        if ((plan->which & he_repair_bit(r)) == 0) {
            continue;
        }
        status = he_progress_phase(soup->limits.progress, he_repair_names[r],
                                   (double)(r + 1) / HE_REPAIR_FILL, err);
        if (status == HE_OK && r > HE_REPAIR_DROP_DEGENERATE) {
            status = is_proper(soup, &goes_on, err);
        }
        if (status == HE_OK && goes_on) {
            status = run(&m, plan, r, err);
        }
    }
    if (status == HE_OK) {
        status = carry(&m, err);
    }
    if (status == HE_OK) {
        status = turn_all_normals(&m, err);
    }
    he_mem_free(m.corner_from);
    he_mem_free(m.turned);
    return status;
}
