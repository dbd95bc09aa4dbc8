/* Tests of counting components, holes and handles: the results are compared with counts made in
 * another way, such as relabelling faces again and again where the query uses union-find. */
#include "query_specimens.h"

#include "query/topology.h"
#include "tests/failing.h"

static bool is_live(const he_mesh *m, he_kind kind, uint32_t id)
{
    return he_mesh_is_live(m, kind, id);
}

static bool has_corner(const he_mesh *m, uint32_t f, uint32_t v)
{
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (m->c.face[h] == f && m->c.origin[h] == v) {
            return true;
        }
    }
    return false;
}

enum { SMALL = 64 };

/* Repeats this until no label changes: gives every face the lowest label among the faces that are
 * connected to it. */
static void label_faces(const he_mesh *m, he_connection by, uint32_t *label)
{
    uint32_t n = he_mesh_issued(m, HE_FACE);
    assert_true(n <= SMALL);
    bool touch[SMALL][SMALL] = {{false}};
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        for (uint32_t g = 0; is_live(m, HE_HALFEDGE, h) && g < he_mesh_issued(m, HE_HALFEDGE);
             g++) {
            if (is_live(m, HE_HALFEDGE, g) && m->c.face[h] != HE_NONE && m->c.face[g] != HE_NONE &&
                (by == HE_JOINED_BY_EDGE ? g == (h ^ 1u) : m->c.origin[g] == m->c.origin[h])) {
                touch[m->c.face[h]][m->c.face[g]] = true;
            }
        }
    }
    for (uint32_t f = 0; f < n; f++) {
        label[f] = is_live(m, HE_FACE, f) ? f : HE_NONE;
    }
    bool changed = true;
    while (changed) {
        changed = false;
        for (uint32_t f = 0; f < n; f++) {
            for (uint32_t g = 0; g < n; g++) {
                if (touch[f][g] && label[g] < label[f]) {
                    label[f] = label[g];
                    changed = true;
                }
            }
        }
    }
}

static uint32_t try_components(const he_mesh *m, he_connection by)
{
    uint32_t label[SMALL] = {0};
    label_faces(m, by, label);
    he_components found;
    assert_int_equal(he_components_find(m, by, &found, NULL), HE_OK);
    uint32_t next = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (label[f] != f) {
            continue;
        }
        assert_true(next < found.count);
        he_component c = found.components[next++];
        uint32_t faces = 0, vertices = 0;
        for (uint32_t g = 0; g < he_mesh_issued(m, HE_FACE); g++) {
            faces += label[g] == f;
        }
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            bool in = false;
            for (uint32_t g = 0; g < he_mesh_issued(m, HE_FACE); g++) {
                in = in || (label[g] == f && has_corner(m, g, v));
            }
            vertices += in;
        }
        assert_int_equal(c.face, f);
        assert_int_equal(c.faces, faces);
        assert_int_equal(c.vertices, vertices);
    }
    assert_int_equal(found.count, next);
    he_components_clear(&found);
    return next;
}

static uint32_t try_boundaries(const he_mesh *m)
{
    he_boundaries found;
    assert_int_equal(he_boundaries_find(m, &found, NULL), HE_OK);
    uint32_t next = 0, total = 0;
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (!is_live(m, HE_HALFEDGE, h) || m->c.face[h] != HE_NONE) {
            continue;
        }
        total++;
        uint32_t lowest = h, length = 0;
        for (uint32_t g = m->c.next[h]; g != h; g = m->c.next[g]) {
            lowest = g < lowest ? g : lowest;
            length++;
        }
        if (lowest == h) {
            assert_true(next < found.count);
            assert_int_equal(found.loops[next].halfedge, h);
            assert_int_equal(found.loops[next].length, length + 1);
            next++;
        }
    }
    assert_int_equal(found.count, next);
    assert_int_equal(total, he_mesh_boundary_halfedges(m));
    he_boundaries_clear(&found);
    return next;
}

static void try_all(const he_mesh *m)
{
    he_topology t;
    assert_int_equal(he_topology_find(m, &t, NULL), HE_OK);
    assert_int_equal(t.vertices, he_mesh_vertices(m));
    assert_int_equal(t.edges, he_mesh_edges(m));
    assert_int_equal(t.faces, he_mesh_faces(m));
    assert_int_equal(t.components, try_components(m, HE_JOINED_BY_VERTEX));
    assert_int_equal(t.components_by_edge, try_components(m, HE_JOINED_BY_EDGE));
    assert_int_equal(t.boundary_loops, try_boundaries(m));
    he_ids bowties = {0};
    assert_int_equal(he_bowties_find(m, &bowties, NULL), HE_OK);
    uint32_t isolated = 0, fans_over_one = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (is_live(m, HE_VERTEX, v)) {
            isolated += he_is_isolated(m, (he_vertex){v});
            if (he_vertex_fans(m, (he_vertex){v}) > 1) {
                assert_int_equal(bowties.ids[fans_over_one++], v);
            }
        }
    }
    assert_int_equal(bowties.count, fans_over_one);
    he_ids_clear(&bowties);
    assert_int_equal(t.bowties, fans_over_one);
    assert_int_equal(t.isolated_vertices, isolated);
    bool faceless = t.faces == 0;
    assert_int_equal(t.manifold, fans_over_one == 0 && !faceless);
    assert_int_equal(t.closed, he_mesh_boundary_halfedges(m) == 0 && !faceless);
    int64_t euler = (int64_t)t.vertices - isolated - t.edges + t.faces;
    assert_int_equal(t.euler, euler);
    assert_int_equal(t.has_genus, fans_over_one == 0);
    if (t.has_genus) {
        assert_int_equal(2 * (int64_t)t.components - 2 * t.genus - t.boundary_loops, euler);
    }
    uint32_t faces = 0;
    for (size_t i = 0; i < t.degree_count; i++) {
        uint32_t wanted = 0;
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            wanted +=
                is_live(m, HE_FACE, f) && he_face_degree(m, (he_face){f}) == t.degrees[i].degree;
        }
        assert_int_equal(t.degrees[i].faces, wanted);
        assert_true(wanted > 0);
        assert_true(i == 0 || t.degrees[i].degree > t.degrees[i - 1].degree);
        faces += wanted;
    }
    assert_int_equal(faces, t.faces);
    he_topology_clear(&t);
}

static void topology_agrees_with_counting(void **state)
{
    (void)state;
    for (size_t i = 0; i <= QUERY_SPECIMENS; i++) {
        he_mesh *m =
            i < QUERY_SPECIMENS ? fixture_mesh(query_specimens[i]) : query_with_dead_rows();
        try_all(m);
        he_mesh_free(m);
    }
}

/* Each mesh is a random selection of the squares of a grid, so it has holes, bow-ties, and islands
 * that touch at corners. */
static void topology_agrees_with_counting_on_random_holes(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int round = 0; round < 60; round++) {
        he_soup soup;
        he_soup_init(&soup, NULL);
        for (uint32_t v = 0; v < 49; v++) {
            uint32_t row = v / 7;
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v % 7, row, 0}, NULL), HE_OK);
        }
        for (uint32_t i = 0; i < 36; i++) {
            uint32_t a = i / 6 * 7 + i % 6;
            if (query_random(&seed) % 100 < 55) {
                assert_int_equal(
                    he_soup_add_face(&soup, (uint32_t[]){a, a + 1, a + 8, a + 7}, 4, NULL), HE_OK);
            }
        }
        he_mesh *m = NULL;
        assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
        he_soup_clear(&soup);
        try_all(m);
        he_mesh_free(m);
    }
}

static void known_meshes_have_the_expected_topology(void **state)
{
    (void)state;
    static const struct {
        const char *faces;
        uint32_t loops, isolated, bowties, components, by_edge;
        int euler, genus; /* the genus is -1 if it is not defined */
    } rows[] = {
        {"", 0, 0, 0, 0, 0, 0, 0},
        {"012", 1, 0, 0, 1, 1, 1, 0},
        {"0123,7654,1045,2156,3267,0374", 0, 0, 0, 1, 1, 2, 0},
        {"012,034,056", 1, 0, 1, 1, 3, 1, -1},
        {"012,456", 2, 1, 0, 2, 2, 2, 0},
        {"0143,1254,2035,3476,4587,5368,6710,7821,8602", 0, 0, 0, 1, 1, 0, 1},
        {"021,032,013,123,456", 1, 0, 0, 2, 2, 3, 0},
        {"012,234,450", 2, 0, 3, 1, 3, 0, -1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *m = fixture_mesh(rows[i].faces);
        he_topology t;
        assert_int_equal(he_topology_find(m, &t, NULL), HE_OK);
        /* at a bow-tie, the number of boundary loops depends on the order of the fans, so it is not
         * checked */
        if (rows[i].bowties == 0) {
            assert_int_equal(t.boundary_loops, rows[i].loops);
        }
        assert_int_equal(t.isolated_vertices, rows[i].isolated);
        assert_int_equal(t.bowties, rows[i].bowties);
        assert_int_equal(t.components, rows[i].components);
        assert_int_equal(t.components_by_edge, rows[i].by_edge);
        assert_int_equal(t.euler, rows[i].euler);
        assert_int_equal(t.has_genus, rows[i].genus >= 0);
        assert_int_equal(t.closed, t.faces > 0 && t.boundary_halfedges == 0);
        assert_int_equal(t.manifold, t.faces > 0 && t.bowties == 0);
        assert_true(rows[i].genus < 0 || t.genus == rows[i].genus);
        he_topology_clear(&t);
        he_mesh_free(m);
    }
}

static void a_face_of_100000_corners_takes_no_quadratic_time(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cylinder", 100000, 1, 1, 1);
    he_topology t;
    assert_int_equal(he_topology_find(m, &t, NULL), HE_OK);
    assert_int_equal(t.degree_count, 2);
    assert_true(t.degrees[0].degree == 4 && t.degrees[0].faces == 100000);
    assert_true(t.degrees[1].degree == 100000 && t.degrees[1].faces == 2);
    assert_true(t.closed && t.euler == 2 && t.genus == 0);
    he_topology_clear(&t);
    he_mesh_free(m);
}

static void topology_ends_on_broken_links(void **state)
{
    (void)state;
    uint64_t seed = 4;
    int corrupt = 0;
    for (int round = 0; round < 5000; round++) {
        he_mesh *m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        for (uint64_t n = 1 + query_random(&seed) % 3; n > 0; n--) {
            query_spoil(m, &seed);
        }
        he_topology t;
        he_boundaries loops;
        he_components parts;
        he_ids bowties = {0};
        he_error err = {0};
        he_status got[5] = {
            he_topology_find(m, &t, &err),
            he_boundaries_find(m, &loops, &err),
            he_components_find(m, HE_JOINED_BY_EDGE, &parts, &err),
            HE_OK,
            he_bowties_find(m, &bowties, &err),
        };
        if (got[0] == HE_OK) {
            he_topology_clear(&t);
        }
        if (got[1] == HE_OK) {
            he_boundaries_clear(&loops);
        }
        if (got[2] == HE_OK) {
            he_components_clear(&parts);
        }
        got[3] = he_components_find(m, HE_JOINED_BY_VERTEX, &parts, &err);
        if (got[3] == HE_OK) {
            he_components_clear(&parts);
        }
        he_ids_clear(&bowties);
        for (int i = 0; i < 5; i++) {
            assert_true(got[i] == HE_OK || got[i] == HE_CORRUPT);
            corrupt += got[i] == HE_CORRUPT;
        }
        he_mesh_free(m);
    }
    assert_true(corrupt > 1000);
}

static void topology_without_memory_is_refused_and_reports_nothing(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,034,056,7890");
    for (int which = 0; which < 5; which++) {
        failing f = {0};
        while (failing_next(&f)) {
            he_status status = HE_OK;
            he_topology t = {.faces = 77};
            he_boundaries loops = {.count = 77};
            he_components parts = {.count = 77};
            he_ids bowties = {0};
            switch (which) {
            case 0:
                status = he_topology_find(m, &t, NULL);
                break;
            case 1:
                status = he_boundaries_find(m, &loops, NULL);
                break;
            case 2:
            case 3:
                status = he_components_find(m, which == 2 ? HE_JOINED_BY_EDGE : HE_JOINED_BY_VERTEX,
                                            &parts, NULL);
                break;
            default:
                status = he_bowties_find(m, &bowties, NULL);
                break;
            }
            if (!failing_status(&f, status)) {
                assert_true(t.faces == 77 && loops.count == 77 && parts.count == 77);
                assert_int_equal(bowties.count, 0);
            }
            he_topology_clear(&t);
            he_boundaries_clear(&loops);
            he_components_clear(&parts);
            he_ids_clear(&bowties);
        }
        assert_true(f.n > 1);
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(topology_agrees_with_counting),
        cmocka_unit_test(topology_agrees_with_counting_on_random_holes),
        cmocka_unit_test(known_meshes_have_the_expected_topology),
        cmocka_unit_test(a_face_of_100000_corners_takes_no_quadratic_time),
        cmocka_unit_test(topology_ends_on_broken_links),
        cmocka_unit_test(topology_without_memory_is_refused_and_reports_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
