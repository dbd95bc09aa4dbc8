#include "unit/query_specimens.h"

#include "geometry/vec3.h"

#include <math.h>

const char *const query_specimens[QUERY_SPECIMENS] = {
    "",
    "012",
    "021,032,013,123",
    "0123,7654,1045,2156,3267,0374",
    "301,320,431,523,653,634",
    "401,430,512,541,652,734,874,845,985,956",
    "012,034,056",
    "021,032,013,123,456",
    "021,123,134",
    "0123,3245",
    "01234567",
    "0123,2104",
    "012,346,895",
    "0135,579",
    "012,234,450",
    "0143,1254,2035,3476,4587,5368,6710,7821,8602",
};

void query_bury(he_mesh *m, uint32_t vertex, uint32_t edge, uint32_t face)
{
    he_reservation need = {.deleted_vertices = m->c.vertices.issued - vertex,
                           .deleted_edges = m->c.edges.issued - edge,
                           .deleted_faces = m->c.faces.issued - face};
    assert_int_equal(he_reserve(m, need, NULL), HE_OK);
    for (uint32_t i = face; i < m->c.faces.issued; i++) {
        he_delete_face(m, (he_face){i});
    }
    for (uint32_t i = edge; i < m->c.edges.issued; i++) {
        he_delete_edge(m, (he_edge){i});
    }
    for (uint32_t i = vertex; i < m->c.vertices.issued; i++) {
        he_delete_vertex(m, (he_vertex){i});
    }
}

he_mesh *query_with_dead_rows(void)
{
    he_mesh *m = fixture_mesh("012,456");
    query_bury(m, 4, 3, 1);
    fixture_check(m);
    fixture_counts(m, 4, 3, 1);
    return m;
}

he_mesh *query_shape(const char *name, double a, double b, double c, double d)
{
    const he_shape *shape = he_shape_find(name, strlen(name));
    assert_non_null(shape);
    double args[HE_SHAPE_PARAMS] = {a, b, c, d};
    he_soup soup;
    he_mesh *mesh = NULL;
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return mesh;
}

uint64_t query_random(uint64_t *seed)
{
    uint64_t z = *seed += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
}

void query_spoil(he_mesh *m, uint64_t *seed)
{
    uint32_t *columns[] = {
        m->c.next, m->c.prev, m->c.origin, m->c.face, m->c.vertex_halfedge, m->c.face_halfedge};
    uint32_t halfedges = 2 * m->c.edges.issued;
    uint32_t rows[] = {halfedges,        halfedges, halfedges, halfedges, m->c.vertices.issued,
                       m->c.faces.issued};
    uint32_t values[] = {halfedges,         halfedges, m->c.vertices.issued,
                         m->c.faces.issued, halfedges, halfedges};
    size_t column = query_random(seed) % 6;
    if (rows[column] == 0 || values[column] == 0) {
        return;
    }
    uint32_t row = (uint32_t)(query_random(seed) % rows[column]);
    static const uint32_t odd[] = {HE_NONE, HE_DEAD, 0x7FFFFFFF, 1000};
    uint64_t dice = query_random(seed) % 8;
    columns[column][row] = dice < 4 ? odd[dice] : (uint32_t)(query_random(seed) % values[column]);
}

double query_uniform(uint64_t *seed, double low, double high)
{
    return low + (high - low) * ldexp((double)(query_random(seed) >> 11), -53);
}

he_vec3 query_random_point(uint64_t *seed, double reach)
{
    return (he_vec3){query_uniform(seed, -reach, reach), query_uniform(seed, -reach, reach),
                     query_uniform(seed, -reach, reach)};
}

he_mesh *query_tangle(uint64_t *seed)
{
    static const char *const shapes[] = {"icosphere", "cube", "dodecahedron", "grid"};
    static const double args[][4] = {{2, 1}, {1}, {1}, {5, 4, 1, 1}};
    size_t which = query_random(seed) % 4;
    const double *a = args[which];
    he_mesh *m = query_shape(shapes[which], a[0], a[1], a[2], a[3]);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        m->c.position[v] = he_vec3_add(m->c.position[v], query_random_point(seed, 0.4));
    }
    return m;
}
