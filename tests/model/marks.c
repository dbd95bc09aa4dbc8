#include "model/marks.h"

#include "mesh/marks.h"
#include "mesh/write.h"

#include <string.h>

static bool add(he_mesh *m, md_random *r, he_kind kind, const char *name)
{
    he_column *column = NULL;
    if (he_column_new(
            &(he_column_schema){name, kind, HE_BOOL, 1, md_chance(r, 80) ? HE_COPY : HE_DEFAULT},
            &column, NULL) != HE_OK) {
        return false;
    }
    uint32_t rows = he_mesh_issued(m, kind);
    if (he_column_extend(column, rows, NULL) != HE_OK ||
        he_mesh_add_column(m, column, NULL) != HE_OK) {
        he_column_free(column);
        return false;
    }
    for (uint32_t i = 0; i < rows; i++) {
        *he_column_row(column, i) = md_chance(r, 8);
    }
    return true;
}

/* Adds attributes of numbers with three types and a random interpolation rule. The oracle does not
 * know what edits do to these attributes, but changes to them must be undone, rolled back and
 * reported like all other changes. */
static bool add_numbers(he_mesh *m, md_random *r, he_kind kind)
{
    static const he_type types[HE_KIND_COUNT] = {[HE_VERTEX] = HE_DOUBLE,
                                                 [HE_HALFEDGE] = HE_FLOAT,
                                                 [HE_EDGE] = HE_INT32,
                                                 [HE_FACE] = HE_INT32};
    he_column *column = NULL;
    he_rule rule = (he_rule)md_below(r, HE_RULE_COUNT);
    if (he_column_new(&(he_column_schema){"number", kind, types[kind], 2, rule}, &column, NULL) !=
        HE_OK) {
        return false;
    }
    uint32_t rows = md_chance(r, 50) ? he_mesh_issued(m, kind) : 0;
    if (he_column_extend(column, rows, NULL) != HE_OK ||
        he_mesh_add_column(m, column, NULL) != HE_OK) {
        he_column_free(column);
        return false;
    }
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            unsigned char *at = he_column_row(column, i) + k * he_type_bytes(column->type);
            double d = md_unit(r);
            float f = (float)d;
            int32_t n = (int32_t)md_below(r, 9);
            const void *from = column->type == HE_DOUBLE  ? (const void *)&d
                               : column->type == HE_FLOAT ? (const void *)&f
                                                          : (const void *)&n;
            memcpy(at, from, he_type_bytes(column->type));
        }
    }
    return true;
}

/* Gives faces an attribute of numbers under the name `material`. Usually the attribute of that name
 * has labels, the names of materials. Does nothing if faces have an attribute of that name. */
static bool add_clash(he_mesh *m)
{
    if (he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE) != NULL) {
        return true;
    }
    he_column *column = NULL;
    if (he_column_new(&(he_column_schema){HE_MATERIAL_ATTRIBUTE, HE_FACE, HE_INT32, 1, HE_COPY},
                      &column, NULL) != HE_OK) {
        return false;
    }
    if (he_column_extend(column, he_mesh_issued(m, HE_FACE), NULL) != HE_OK ||
        he_mesh_add_column(m, column, NULL) != HE_OK) {
        he_column_free(column);
        return false;
    }
    return true;
}

bool md_mark(he_mesh *m, md_random *r)
{
    static const he_kind locked[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    static const he_kind numbered[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE};
    if (md_chance(r, 5) && !add_clash(m)) {
        return false;
    }
    bool numbers = md_chance(r, 30);
    for (size_t i = 0; i < sizeof numbered / sizeof *numbered && numbers; i++) {
        if (md_chance(r, 60) && !add_numbers(m, r, numbered[i])) {
            return false;
        }
    }
    if (!md_chance(r, 30)) {
        return true;
    }
    bool added = !md_chance(r, 60) || add(m, r, HE_EDGE, "feature");
    for (size_t i = 0; i < sizeof locked / sizeof *locked && added; i++) {
        added = !md_chance(r, 40) || add(m, r, locked[i], "locked");
    }
    return added;
}

void md_read_marks(or_mesh *o, const he_mesh *m)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    for (uint32_t v = 0; v < o->vertices; v++) {
        o->vertex[v].locked = he_is_locked(&marks, HE_VERTEX, v);
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        o->edge[e].locked = he_is_locked(&marks, HE_EDGE, e);
        o->edge[e].feature = he_is_feature(&marks, (he_edge){e});
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        o->face[f].locked = he_is_locked(&marks, HE_FACE, f);
    }
}
