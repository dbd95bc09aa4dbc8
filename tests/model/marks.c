#include "model/marks.h"

#include "mesh/marks.h"
#include "mesh/write.h"

static bool add(he_mesh *m, md_random *r, he_kind kind, const char *name)
{
    he_column *column = NULL;
    if (he_column_new(name, kind, HE_BOOL, 1, md_chance(r, 80) ? HE_COPY : HE_DEFAULT, &column,
                      NULL) != HE_OK) {
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

bool md_mark(he_mesh *m, md_random *r)
{
    static const he_kind locked[] = {HE_VERTEX, HE_EDGE, HE_FACE};
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
