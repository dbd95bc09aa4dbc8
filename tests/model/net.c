#include "model/net.h"

#include "mesh/column.h"
#include "mesh/walk.h"

#include <stdio.h>
#include <string.h>

/* Returns whether two points have equal bits: -0 and 0 differ. */
static bool same_point(he_vec3 a, he_vec3 b)
{
    uint64_t bits[2][3];
    memcpy(bits[0], &a, sizeof a);
    memcpy(bits[1], &b, sizeof b);
    return memcmp(bits[0], bits[1], sizeof bits[0]) == 0;
}

static bool same_bytes(const he_column *a, const he_column *b, uint32_t row)
{
    return memcmp(he_column_value(a, row), he_column_value(b, row), a->row_bytes) == 0;
}

/* Returns the label that an element (the row `row`) has in the attribute `column`. If `column` is
 * NULL, the element has the default label of the attribute `other`. */
static const char *name_in(const he_column *column, const he_column *other, uint32_t row)
{
    const he_column *from = column != NULL ? column : other;
    uint32_t index;
    memcpy(&index, column != NULL ? he_column_value(column, row) : other->fallback, sizeof index);
    return he_labels_get(from->labels, index);
}

/* Returns whether the value of an element in an attribute counts as unchanged. If an edit adds or
 * removes a whole attribute, that alone does not make elements modified, unless the values are
 * labels. */
static bool same_in(const he_column *a, const he_column *b, uint32_t row)
{
    bool labels = (a == NULL || a->labels != NULL) && (b == NULL || b->labels != NULL);
    if (labels) {
        return strcmp(name_in(a, b, row), name_in(b, a, row)) == 0;
    }
    return a == NULL || b == NULL || a->type != b->type || a->row_bytes != b->row_bytes ||
           a->labels != NULL || b->labels != NULL || same_bytes(a, b, row);
}

static bool same_values(const he_mesh *was, const he_mesh *is, he_kind domain, uint32_t row)
{
    bool same = true;
    for (size_t i = 0; i < he_mesh_columns(was) && same; i++) {
        const he_column *a = he_mesh_column(was, i);
        same = a == NULL || a->domain != domain ||
               same_in(a, he_mesh_find_column(is, domain, a->name), row);
    }
    for (size_t i = 0; i < he_mesh_columns(is) && same; i++) {
        const he_column *b = he_mesh_column(is, i);
        same = b == NULL || b->domain != domain ||
               he_mesh_find_column(was, domain, b->name) != NULL || same_in(NULL, b, row);
    }
    return same;
}

static bool same_vertex(const he_mesh *was, const he_mesh *is, he_vertex v)
{
    return same_point(he_position(was, v), he_position(is, v)) &&
           he_vertex_halfedge(was, v).i == he_vertex_halfedge(is, v).i;
}

static bool same_edge(const he_mesh *was, const he_mesh *is, he_edge e)
{
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side);
        if (he_origin(was, h).i != he_origin(is, h).i ||
            he_face_of(was, h).i != he_face_of(is, h).i) {
            return false;
        }
    }
    return true;
}

static bool same_face(const he_mesh *was, const he_mesh *is, he_face f)
{
    he_halfedge first = he_face_halfedge(was, f);
    he_halfedge h = first;
    if (he_face_halfedge(is, f).i != first.i) {
        return false;
    }
    do {
        if (he_origin(was, h).i != he_origin(is, h).i || he_next(was, h).i != he_next(is, h).i ||
            !same_values(was, is, HE_HALFEDGE, h.i)) {
            return false;
        }
        h = he_next(was, h);
    } while (h.i != first.i);
    return true;
}

static bool same_element(const he_mesh *was, const he_mesh *is, he_kind kind, uint32_t id)
{
    switch (kind) {
    case HE_VERTEX:
        return same_vertex(was, is, (he_vertex){id});
    case HE_EDGE:
        return same_edge(was, is, (he_edge){id});
    case HE_FACE:
        return same_face(was, is, (he_face){id});
    case HE_HALFEDGE:
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return true;
}

static bool lives(const he_mesh *m, he_kind kind, uint32_t id)
{
    return id < he_mesh_issued(m, kind) && he_mesh_is_live(m, kind, id);
}

/* If `id` is the next entry of the sorted list, steps over that entry and returns true. */
static bool take(const he_ids *list, size_t *at, uint32_t id)
{
    bool there = *at < list->count && list->ids[*at] == id;
    *at += there;
    return there;
}

bool md_net_matches(const he_mesh *was, const he_mesh *is, const he_changes *changes,
                    char text[MD_NET_TEXT])
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        he_kind kind = kinds[k];
        uint32_t issued = he_mesh_issued(was, kind);
        size_t created = 0;
        size_t deleted = 0;
        size_t modified = 0;
        if (he_mesh_issued(is, kind) > issued) {
            issued = he_mesh_issued(is, kind);
        }
        for (uint32_t id = 0; id < issued; id++) {
            bool before = lives(was, kind, id);
            bool after = lives(is, kind, id);
            bool other = before && after &&
                         !(same_element(was, is, kind, id) && same_values(was, is, kind, id));
            if (take(&changes->created[kind], &created, id) != (!before && after) ||
                take(&changes->deleted[kind], &deleted, id) != (before && !after) ||
                take(&changes->modified[kind], &modified, id) != other) {
                (void)snprintf(text, MD_NET_TEXT, "%s %u lived %d, lives %d, changed %d",
                               he_kind_name(kind), id, before, after, other);
                return false;
            }
        }
        if (created != changes->created[kind].count || deleted != changes->deleted[kind].count ||
            modified != changes->modified[kind].count) {
            (void)snprintf(text, MD_NET_TEXT, "a set of %s is unsorted or too long",
                           he_kind_plural(kind));
            return false;
        }
    }
    return true;
}
