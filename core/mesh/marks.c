#include "mesh/marks.h"

#include "mesh/walk.h"

#include <string.h>

bool he_is_mark(const he_column *column, const char *name)
{
    return column != NULL && column->type == HE_BOOL && column->components == 1 &&
           strcmp(column->name, name) == 0;
}

const he_column *he_mark_find(const he_mesh *m, he_kind domain, const char *name)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (he_is_mark(column, name) && column->domain == domain) {
            return column;
        }
    }
    return NULL;
}

bool he_marks_search(const he_mesh *m, he_marks *out)
{
    he_marks found = {.feature = NULL};
    bool any = false;
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (he_is_mark(column, "locked")) {
            if (column->domain != HE_HALFEDGE && column->domain != HE_MESH_KIND) {
                found.locked[column->domain] = column;
                any = true;
            }
        } else if (he_is_mark(column, "feature") && column->domain == HE_EDGE) {
            found.feature = column;
            any = true;
        }
    }
    if (any) {
        *out = found;
    }
    return any;
}

he_status he_require_unlocked(const he_marks *marks, he_kind kind, uint32_t id, he_error *err)
{
    if (id != HE_NONE && he_is_locked(marks, kind, id)) {
        return he_fail(err, HE_LOCKED_ELEMENT, kind, id, "%s %u is locked", he_kind_name(kind), id);
    }
    return HE_OK;
}

he_status he_require_unlocked_about(const he_mesh *m, const he_marks *marks, he_halfedge first,
                                    he_error *err)
{
    he_status status = HE_OK;
    he_halfedge h = first;
    do {
        status = he_require_unlocked(marks, HE_EDGE, he_edge_of(h).i, err);
        if (status == HE_OK) {
            status = he_require_unlocked(marks, HE_FACE, he_face_of(m, h).i, err);
        }
        h = he_swing_ccw(m, h);
    } while (status == HE_OK && h.i != first.i);
    return status;
}
