#include "remesh/net_make.h"

#include "geometry/scale.h"
#include "mesh/marks.h"
#include "mesh/walk.h"

#include <string.h>

static he_status no_memory(size_t faces, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for a copy of %zu triangles", faces);
}

/* Marks a chosen face, which has no number yet, by the number HE_DEAD. */
static void mark_face(const he_marks *marks, uint32_t f, uint32_t *number)
{
    if (!he_is_locked(marks, HE_FACE, f)) {
        number[f] = HE_DEAD;
    }
}

static void mark_faces(const he_mesh *m, const he_net_choice *choice, uint32_t *number)
{
    he_marks marks = {.feature = NULL};
    (void)he_marks_find(m, &marks);
    for (size_t i = 0; i < choice->face_count && choice->faces != NULL; i++) {
        mark_face(&marks, choice->faces[i], number);
    }
    for (uint32_t f = 0; f < m->c.faces.issued && choice->faces == NULL; f++) {
        if (he_face_is_live(m, (he_face){f})) {
            mark_face(&marks, f, number);
        }
    }
}

static void number_face(uint32_t f, uint32_t *number, he_net *n)
{
    n->ids[n->triangle_count].face = f;
    number[f] = n->triangle_count++;
}

/* Where ids are in no spatial order, the links of the faces that the search will come to are
 * fetched into the caches so many faces ahead: those of the first half-edges, and later the links
 * of the half-edges after them. */
enum { FAR_AHEAD = 24, AHEAD = 12 };

static void fetch_ahead(const he_mesh *m, const he_net *n, uint32_t t)
{
    if (t + FAR_AHEAD < n->triangle_count) {
        __builtin_prefetch(&m->c.next[m->c.face_halfedge[n->ids[t + FAR_AHEAD].face]]);
    }
    if (t + AHEAD < n->triangle_count) {
        const uint32_t h = m->c.face_halfedge[n->ids[t + AHEAD].face], after = m->c.next[h];
        __builtin_prefetch(&m->c.next[after]);
        __builtin_prefetch(&m->c.face[h ^ 1]);
        __builtin_prefetch(&m->c.face[after ^ 1]);
    }
}

/* Finds the half-edges of triangle t, and in place of its twins the faces beside it, to which it
 * gives the next numbers.
 * Returns HE_NOT_TRIANGLE naming the face, if it is no triangle. */
static he_status number_beside(const he_mesh *m, uint32_t t, uint32_t *number, he_net *n,
                               he_error *err)
{
    const uint32_t f = n->ids[t].face, first = m->c.face_halfedge[f];
    uint32_t h = first;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t beside = m->c.face[h ^ 1];
        n->ids[t].halfedge[i] = h;
        n->triangles[t].twin[i] = beside;
        if (beside != HE_NONE && number[beside] == HE_DEAD) {
            number_face(beside, number, n);
        }
        h = m->c.next[h];
    }
    return h == first ? HE_OK
                      : he_fail(err, HE_NOT_TRIANGLE, HE_FACE, f,
                                "face %u has more than three corners: triangulate first", f);
}

/* Numbers the marked faces in the order in which a search from neighbour to neighbour finds them,
 * so that neighbours are near in memory. */
static he_status number_faces(const he_mesh *m, uint32_t *number, he_net *n, he_error *err)
{
    he_status status = HE_OK;
    uint32_t handled = 0;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f + 1, m->c.faces.issued, err);
        if (number[f] == HE_DEAD) {
            number_face(f, number, n);
        }
        for (; handled < n->triangle_count && status == HE_OK; handled++) {
            fetch_ahead(m, n, handled);
            status = number_beside(m, handled, number, n, err);
        }
    }
    return status;
}

/* Returns the corner of a triangle at which a half-edge leaves. */
static uint32_t corner_of(const he_net *n, uint32_t t, uint32_t h)
{
    const uint32_t *own = n->ids[t].halfedge;
    return 4 * t + (own[0] == h ? 0 : own[1] == h ? 1 : 2);
}

/* Gives numbers to the vertices of the chosen faces, and fills the triangles. */
static void link_triangles(const he_mesh *m, const uint32_t *number, uint32_t *vertex_number,
                           he_net *n)
{
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        const uint32_t ahead = t + AHEAD < n->triangle_count ? t + AHEAD : t;
        he_net_triangle *to = &n->triangles[t];
        to->marks = to->unused = 0;
        for (unsigned i = 0; i < 3; i++) {
            __builtin_prefetch(&m->c.origin[n->ids[ahead].halfedge[i]]);
            const uint32_t h = n->ids[t].halfedge[i], v = m->c.origin[h], beside = to->twin[i];
            if (vertex_number[v] == HE_NONE) {
                vertex_number[v] = n->vertex_count;
                n->vertex_id[n->vertex_count++] = v;
            }
            to->v[i] = vertex_number[v];
            to->twin[i] = beside == HE_NONE || number[beside] == HE_NONE
                              ? HE_NONE
                              : corner_of(n, number[beside], h ^ 1);
        }
    }
}

/* Finds the frame of the coordinates, and the positions of the vertices in it. */
static void place_vertices(const he_mesh *m, he_net *n)
{
    he_vec3 low = {DBL_MAX, DBL_MAX, DBL_MAX}, high = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        he_vec3 p = m->c.position[n->vertex_id[v]];
        low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
    n->middle = he_vec3_add(he_vec3_scale(low, 0.5), he_vec3_scale(high, 0.5));
    he_vec3 half = he_vec3_sub(he_vec3_scale(high, 0.5), he_vec3_scale(low, 0.5));
    n->exponent = he_exponent_of(he_vec3_extent(half));
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        n->vertices[v] =
            (he_net_vertex){.p = he_net_inside(n, m->c.position[n->vertex_id[v]]), .ideal = 6};
        n->corner[v] = HE_NONE;
    }
}

/* Finds a corner at each vertex, its degree, and whether it is on a border or has more than one
 * fan. */
static void link_vertices(he_net *n)
{
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        if ((c & 3) == 3) {
            continue;
        }
        uint32_t v = he_net_origin(n, c);
        bool border = he_net_twin(n, c) == HE_NONE;
        he_net_vertex *at = &n->vertices[v];
        he_net_add_degree(n, v, 1);
        if (border) {
            bool again = (at->flags & HE_NET_BORDER) != 0;
            at->flags |= again ? HE_NET_PART | HE_NET_FIXED : HE_NET_BORDER;
            he_net_add_degree(n, he_net_target(n, c), 1);
        }
        if (n->corner[v] == HE_NONE || border) {
            n->corner[v] = c;
        }
        n->ground[v] = c >> 2;
    }
}

/* Marks vertices that have faces outside the net. */
static void find_outside(const he_mesh *m, const uint32_t *number, const uint32_t *vertex_number,
                         he_net *n)
{
    if (n->triangle_count == he_mesh_faces(m)) {
        return;
    }
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        uint32_t f = m->c.face[h];
        if (f < HE_DEAD && number[f] == HE_NONE) {
            uint32_t v = vertex_number[m->c.origin[h]];
            if (v != HE_NONE) {
                n->vertices[v].flags |= HE_NET_PART | HE_NET_FIXED;
            }
        }
    }
}

static bool make_room(const he_mesh *m, size_t faces, he_net *n)
{
    size_t vertices = 3 * faces < m->c.vertices.live ? 3 * faces : m->c.vertices.live;
    n->triangle_room = (uint32_t)faces + 2;
    n->vertex_room = (uint32_t)vertices + 1;
    n->first_edge = m->c.edges.issued;
    n->edge_room = 3;
    n->triangles = he_mem_array(NULL, n->triangle_room, sizeof *n->triangles);
    n->ids = he_mem_array(NULL, n->triangle_room, sizeof *n->ids);
    n->vertices = he_mem_array(NULL, n->vertex_room, sizeof *n->vertices);
    n->corner = he_mem_array(NULL, n->vertex_room, sizeof *n->corner);
    n->ground = he_mem_array(NULL, n->vertex_room, sizeof *n->ground);
    n->vertex_id = he_mem_array(NULL, n->vertex_room, sizeof *n->vertex_id);
    n->edge_parent = he_mem_array(NULL, n->edge_room, sizeof *n->edge_parent);
    return n->triangles != NULL && n->ids != NULL && n->vertices != NULL && n->corner != NULL &&
           n->ground != NULL && n->vertex_id != NULL && n->edge_parent != NULL;
}

he_status he_net_make(const he_mesh *m, const he_net_choice *choice, he_net *out, he_error *err)
{
    size_t faces = choice->faces != NULL ? choice->face_count : he_mesh_faces(m);
    uint32_t *number = he_mem_array(NULL, (size_t)m->c.faces.issued + 1, sizeof *number);
    uint32_t *vertex_number =
        he_mem_array(NULL, (size_t)m->c.vertices.issued + 1, sizeof *vertex_number);
    he_net n = {.most_triangles = UINT32_MAX / 4 - 1, .spare_edge = HE_NONE};
    he_status status = HE_OK;
    if (!make_room(m, faces, &n) || number == NULL || vertex_number == NULL) {
        status = no_memory(faces, err);
        goto out;
    }
    memset(number, 0xFF, m->c.faces.issued * sizeof *number);
    memset(vertex_number, 0xFF, m->c.vertices.issued * sizeof *vertex_number);
    mark_faces(m, choice, number);
    status = number_faces(m, number, &n, err);
    if (status != HE_OK) {
        goto out;
    }
    link_triangles(m, number, vertex_number, &n);
    n.live_triangles = n.triangle_count;
    n.live_vertices = n.vertex_count;
    place_vertices(m, &n);
    link_vertices(&n);
    find_outside(m, number, vertex_number, &n);
    status = he_net_hold(&n, m, choice, err);
    if (status == HE_OK) {
        status = he_net_find_lines(&n, m, choice->crease, err);
    }
out:
    he_mem_free(number);
    he_mem_free(vertex_number);
    if (status != HE_OK) {
        he_net_clear(&n);
        return status;
    }
    *out = n;
    return HE_OK;
}
