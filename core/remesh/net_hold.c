/* net_hold.c - finds which edges of a net are held or frozen, and which vertices are fixed. */
#include "remesh/net_make.h"

#include "geometry/scale.h"
#include "mesh/marks.h"

#include <string.h>

/* A triangle has no normal of its own if it is lower than this fraction of its longest side. */
static const double FLAT = 1e-11;

static he_vec3 normal_of(const he_net *n, uint32_t t, unsigned *longest)
{
    const uint32_t *v = n->triangles[t].v;
    he_vec3 side[3];
    double most = -1;
    for (unsigned i = 0; i < 3; i++) {
        side[i] = he_vec3_sub(he_net_place(n, v[(i + 1) % 3]), he_net_place(n, v[i]));
        double square = he_vec3_dot(side[i], side[i]);
        if (square > most) {
            most = square;
            *longest = i;
        }
    }
    he_vec3 normal = he_vec3_cross(side[0], side[1]);
    double least = FLAT * most;
    if (!(he_vec3_dot(normal, normal) > least * least)) {
        return (he_vec3){0, 0, 0};
    }
    return normal;
}

/* A triangle without a normal has that of its neighbour at its longest side; at most this many such
 * triangles are passed. */
enum { HOPS = 8 };

/* Finds the unit normal of a triangle; zero if it has none. */
static he_vec3 find_normal(const he_net *n, uint32_t t)
{
    he_vec3 unit = {0, 0, 0};
    for (unsigned hop = 0; hop < HOPS; hop++) {
        unsigned longest = 0;
        he_vec3 normal = normal_of(n, t, &longest);
        if (he_vec3_normalise(normal, &unit)) {
            break;
        }
        uint32_t twin = n->triangles[t].twin[longest];
        if (twin == HE_NONE) {
            break;
        }
        t = twin >> 2;
    }
    return unit;
}

static void hold(he_net *n, uint32_t c, uint32_t marks)
{
    uint32_t twin = he_net_twin(n, c);
    he_net_set_edge_marks(n, c, he_net_edge_marks(n, c) | marks);
    if (twin != HE_NONE) {
        he_net_set_edge_marks(n, twin, he_net_edge_marks(n, c));
    }
    if ((marks & HE_NET_FROZEN) != 0) {
        n->vertices[he_net_origin(n, c)].flags |= HE_NET_FIXED;
        n->vertices[he_net_target(n, c)].flags |= HE_NET_FIXED;
    }
}

/* Holds edges between faces whose normals differ by more than the angle. */
static he_status hold_creases(he_net *n, double crease, he_error *err)
{
    if (!(crease < HE_PI)) {
        return HE_OK;
    }
    he_vec3 *normal = he_mem_array(NULL, (size_t)n->triangle_count + 1, sizeof *normal);
    if (normal == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of %u faces",
                             n->triangle_count);
    }
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        normal[t] = find_normal(n, t);
    }
    double least = cos(crease);
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        for (unsigned i = 0; i < 3; i++) {
            uint32_t twin = n->triangles[t].twin[i];
            if (twin == HE_NONE || twin < 4 * t) {
                continue;
            }
            he_vec3 a = normal[t], b = normal[twin >> 2];
            bool known = he_vec3_dot(a, a) > 0 && he_vec3_dot(b, b) > 0;
            if (known && he_vec3_dot(a, b) < least) {
                hold(n, 4 * t + i, HE_NET_HELD);
            }
        }
    }
    he_mem_free(normal);
    return HE_OK;
}

/* Holds edges between faces of different materials. */
static void hold_materials(he_net *n, const he_mesh *m)
{
    const he_column *material = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    if (material == NULL || !he_is_material_column(material)) {
        return;
    }
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        uint32_t twin = (c & 3) == 3 ? HE_NONE : he_net_twin(n, c);
        if (twin != HE_NONE && c < twin &&
            memcmp(he_column_value(material, n->ids[c >> 2].face),
                   he_column_value(material, n->ids[twin >> 2].face), material->row_bytes) != 0) {
            hold(n, c, HE_NET_HELD);
        }
    }
}

/* Numbers on the two sides of an edge differ if they do so by more than this fraction of the
 * largest number of the attribute: where an attribute has no seam, interpolation leaves rounding
 * errors. */
static const double FLOAT_ROUNDING = 1e-6, DOUBLE_ROUNDING = 1e-9;

/* An attribute of corners that may have seams, and by how much its numbers must differ. */
typedef struct seamed {
    const he_column *column;
    double least;
} seamed;

static double number_at(const he_column *column, uint32_t row, uint32_t k)
{
    const unsigned char *value = he_column_value(column, row);
    if (column->type == HE_FLOAT) {
        float narrow;
        memcpy(&narrow, value + k * sizeof narrow, sizeof narrow);
        return (double)narrow;
    }
    double wide;
    memcpy(&wide, value + k * sizeof wide, sizeof wide);
    return wide;
}

/* Returns true if an attribute is interpolated over the surface, and says more than its shape, as
 * normals and tangents do not: faces that are drawn flat have other ones on each side of each
 * edge. */
static bool may_have_seams(const he_column *column)
{
    return column != NULL && column->domain == HE_HALFEDGE && column->rule == HE_INTERPOLATE &&
           (column->type == HE_FLOAT || column->type == HE_DOUBLE) &&
           strcmp(column->name, "normal") != 0 && strcmp(column->name, "tangent") != 0;
}

static seamed look_at(const he_net *n, const he_column *column)
{
    double most = 0;
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        for (uint32_t k = 0; k < column->components && (c & 3) != 3; k++) {
            const double number = fabs(number_at(column, he_net_halfedge(n, c), k));
            most = number > most && isfinite(number) ? number : most;
        }
    }
    return (seamed){column, most * (column->type == HE_FLOAT ? FLOAT_ROUNDING : DOUBLE_ROUNDING)};
}

static bool differ(const seamed *of, uint32_t h, uint32_t other)
{
    for (uint32_t k = 0; k < of->column->components; k++) {
        if (fabs(number_at(of->column, h, k) - number_at(of->column, other, k)) > of->least) {
            return true;
        }
    }
    return false;
}

/* Returns true if the values at one of the ends of an edge are not the same on both its sides. */
static bool is_seam(const he_net *n, const seamed *of, uint32_t c, uint32_t twin)
{
    return differ(of, he_net_halfedge(n, c), he_net_halfedge(n, he_net_next(twin))) ||
           differ(of, he_net_halfedge(n, he_net_next(c)), he_net_halfedge(n, twin));
}

static void hold_seams(he_net *n, const he_mesh *m)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        if (!may_have_seams(m->c.columns[i])) {
            continue;
        }
        const seamed of = look_at(n, m->c.columns[i]);
        for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
            const uint32_t twin = (c & 3) == 3 ? HE_NONE : he_net_twin(n, c);
            if (twin != HE_NONE && c < twin && is_seam(n, &of, c, twin)) {
                hold(n, c, HE_NET_HELD);
            }
        }
    }
}

static void hold_marked(he_net *n, const he_mesh *m, const he_net_choice *choice)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        if (he_is_locked(&marks, HE_VERTEX, n->vertex_id[v])) {
            n->vertices[v].flags |= HE_NET_FIXED;
        }
    }
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        if ((c & 3) == 3) {
            continue;
        }
        uint32_t h = he_net_halfedge(n, c);
        bool border = he_net_twin(n, c) == HE_NONE, outside = border && m->c.face[h ^ 1] != HE_NONE;
        if (outside || he_is_locked(&marks, HE_EDGE, h >> 1) ||
            (border && choice->fixed_boundary)) {
            hold(n, c, HE_NET_HELD | HE_NET_FROZEN);
        } else if (border || he_is_feature(&marks, (he_edge){h >> 1})) {
            hold(n, c, HE_NET_HELD);
        }
    }
}

/* Freezes the borders at vertices that have other fans than those of the net: the boundary links
 * of these fans stay as they are. */
static void freeze_borders(he_net *n)
{
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        if ((c & 3) != 3 && he_net_twin(n, c) == HE_NONE &&
            (he_net_has(n, he_net_origin(n, c), HE_NET_PART) ||
             he_net_has(n, he_net_target(n, c), HE_NET_PART))) {
            hold(n, c, HE_NET_HELD | HE_NET_FROZEN);
        }
    }
}

he_status he_net_hold(he_net *n, const he_mesh *m, const he_net_choice *choice, he_error *err)
{
    he_status status = hold_creases(n, choice->crease, err);
    if (status == HE_OK) {
        hold_marked(n, m, choice);
        hold_materials(n, m);
        if (choice->keep_seams) {
            hold_seams(n, m);
        }
        freeze_borders(n);
    }
    return status;
}
