/* Tests of the queries for neighbours of elements: the answers are compared with a search through
 * all half-edges. */
#include "query_specimens.h"

#include "query/adjacency.h"
#include "query/idmap.h"
#include "tests/failing.h"

static const he_relation *relation_named(he_kind of, const char *name)
{
    const he_relation *relation = he_relation_find(of, name, strlen(name));
    if (relation == NULL) {
        fail_msg("%s has no relation %s", he_kind_name(of), name);
    }
    return relation;
}

static he_ids ids_of(const he_mesh *m, he_kind of, const char *name, uint32_t id, unsigned flags)
{
    he_ids ids = {0};
    he_error err = {0};
    if (he_relation_append(m, relation_named(of, name), id, flags, &ids, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    return ids;
}

static size_t times_in(const he_ids *ids, uint32_t id)
{
    size_t n = 0;
    for (size_t i = 0; i < ids->count; i++) {
        n += ids->ids[i] == id;
    }
    return n;
}

/* Returns whether element `related` belongs to the relation of element `id`. This is decided by the
 * definition of the relation, without following links from element to element. */
static bool belongs(const he_mesh *m, he_kind of, const char *name, uint32_t id, uint32_t related)
{
    const uint32_t *origin = m->c.origin, *face = m->c.face;
    uint32_t h = related;
    if (of == HE_EDGE) {
        if (strcmp(name, "vertices") == 0) {
            return origin[2 * id] == related || origin[2 * id + 1] == related;
        }
        return strcmp(name, "halfedges") == 0
                   ? related / 2 == id
                   : face[2 * id] == related || face[2 * id + 1] == related;
    }
    if (of == HE_HALFEDGE && strcmp(name, "ring") == 0) {
        return origin[h] == origin[id];
    }
    if (of == HE_VERTEX && strcmp(name, "outgoing") == 0) {
        return origin[h] == id;
    }
    if (of == HE_VERTEX && strcmp(name, "incoming") == 0) {
        return origin[h ^ 1u] == id;
    }
    if (of == HE_VERTEX && strcmp(name, "edges") == 0) {
        return origin[2 * related] == id || origin[2 * related + 1] == id;
    }
    if (of == HE_FACE && strcmp(name, "halfedges") == 0) {
        return face[h] == id;
    }
    if (of == HE_FACE && strcmp(name, "edges") == 0) {
        return face[2 * related] == id || face[2 * related + 1] == id;
    }
    for (uint32_t g = 0; g < 2 * m->c.edges.issued; g++) {
        if (!he_edge_is_live(m, (he_edge){g >> 1})) {
            continue;
        }
        bool found =
            of == HE_VERTEX
                ? origin[g] == id && (strcmp(name, "vertices") == 0 ? origin[g ^ 1u] == related
                                                                    : face[g] == related)
                : face[g] == id && (strcmp(name, "vertices") == 0 ? origin[g] == related
                                                                  : face[g ^ 1u] == related);
        if (found) {
            return true;
        }
    }
    return false;
}

static void try_all(const he_mesh *m)
{
    for (size_t i = 0; i < he_relation_count(); i++) {
        const he_relation *r = he_relation_at(i);
        for (uint32_t id = 0; id < he_mesh_issued(m, r->of); id++) {
            if (!he_mesh_is_live(m, r->of, id)) {
                continue;
            }
            he_ids ccw = ids_of(m, r->of, r->name, id, 0);
            he_ids cw = ids_of(m, r->of, r->name, id, HE_CLOCKWISE);
            size_t n = ccw.count;
            assert_int_equal(cw.count, n);
            for (size_t k = 0; k < n; k++) {
                assert_int_equal(cw.ids[k], ccw.ids[k == 0 ? 0 : n - k]);
                assert_true(he_mesh_is_live(m, r->gives, ccw.ids[k]));
            }
            bool loop = strcmp(r->name, "loop") == 0;
            for (uint32_t other = 0; !loop && other < he_mesh_issued(m, r->gives); other++) {
                bool wanted =
                    he_mesh_is_live(m, r->gives, other) && belongs(m, r->of, r->name, id, other);
                if (times_in(&ccw, other) != wanted) {
                    fail_msg("%s %s of %u: %u", he_kind_name(r->of), r->name, id, other);
                }
            }
            he_ids_clear(&ccw);
            he_ids_clear(&cw);
        }
    }
}

/* Requires that answers are in the defined order: the elements around a vertex in the order of
 * turning from half-edge to half-edge, the elements around a face in the order of its loop. */
static void try_order(const he_mesh *m)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (!he_mesh_is_live(m, HE_VERTEX, v)) {
            continue;
        }
        he_ids out = ids_of(m, HE_VERTEX, "outgoing", v, 0);
        he_ids in = ids_of(m, HE_VERTEX, "incoming", v, 0);
        he_ids to = ids_of(m, HE_VERTEX, "vertices", v, 0);
        he_ids edges = ids_of(m, HE_VERTEX, "edges", v, 0);
        he_ids faces = ids_of(m, HE_VERTEX, "faces", v, 0);
        size_t n = out.count, f = 0;
        assert_true(in.count == n && to.count == n && edges.count == n);
        for (size_t i = 0; i < n; i++) {
            uint32_t h = out.ids[i];
            assert_int_equal(out.ids[(i + 1) % n], m->c.prev[h] ^ 1u);
            assert_int_equal(in.ids[i], h ^ 1u);
            assert_int_equal(edges.ids[i], h >> 1);
            assert_int_equal(to.ids[i], m->c.origin[h ^ 1u]);
            if (m->c.face[h] != HE_NONE) {
                assert_int_equal(faces.ids[f++], m->c.face[h]);
            }
        }
        assert_int_equal(f, faces.count);
        assert_true(n == 0 || out.ids[0] == m->c.vertex_halfedge[v]);
        he_ids_clear(&out);
        he_ids_clear(&in);
        he_ids_clear(&to);
        he_ids_clear(&edges);
        he_ids_clear(&faces);
    }
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (!he_mesh_is_live(m, HE_HALFEDGE, h)) {
            continue;
        }
        he_ids loop = ids_of(m, HE_HALFEDGE, "loop", h, 0);
        assert_int_equal(loop.ids[0], h);
        for (size_t i = 0; i < loop.count; i++) {
            assert_int_equal(loop.ids[(i + 1) % loop.count], m->c.next[loop.ids[i]]);
        }
        he_ids_clear(&loop);
    }
}

/* Requires that the answer for all elements equals the answers for the single elements, one after
 * another. */
static void try_dense(const he_mesh *m)
{
    for (size_t i = 0; i < he_relation_count(); i++) {
        const he_relation *r = he_relation_at(i);
        for (unsigned flags = 0; flags < 2; flags++) {
            he_dense all = {0};
            assert_int_equal(he_relation_dense(m, &(he_neighbours){.relation = r, .flags = flags},
                                               0, &all, NULL),
                             HE_OK);
            uint32_t row = 0;
            for (uint32_t id = 0; id < he_mesh_issued(m, r->of); id++) {
                if (!he_mesh_is_live(m, r->of, id)) {
                    continue;
                }
                he_ids one = ids_of(m, r->of, r->name, id, flags);
                uint32_t from = all.offsets.ids[row], to = all.offsets.ids[row + 1];
                assert_int_equal(to - from, one.count);
                if (one.count > 0) {
                    assert_memory_equal(all.ids.ids + from, one.ids, 4 * one.count);
                }
                /* If a query names an element twice, its answer must appear twice. */
                uint32_t twice[] = {id, id};
                he_dense two = {0};
                assert_int_equal(
                    he_relation_dense(
                        m, &(he_neighbours){.relation = r, .of = twice, .count = 2, .flags = flags},
                        0, &two, NULL),
                    HE_OK);
                assert_int_equal(two.offsets.count, 3);
                assert_int_equal(two.offsets.ids[0], 0);
                assert_int_equal(two.offsets.ids[1], one.count);
                assert_int_equal(two.offsets.ids[2], 2 * one.count);
                assert_int_equal(two.ids.count, 2 * one.count);
                if (one.count > 0) {
                    assert_memory_equal(two.ids.ids + one.count, one.ids, 4 * one.count);
                }
                he_dense_clear(&two);
                he_ids_clear(&one);
                row++;
            }
            assert_int_equal(all.offsets.count, row + 1);
            assert_int_equal(all.offsets.ids[0], 0);
            assert_int_equal(all.offsets.ids[row], all.ids.count);
            he_dense_clear(&all);
        }
    }
}

static void try_common_faces(const he_mesh *m)
{
    for (uint32_t a = 0; a < he_mesh_issued(m, HE_VERTEX); a++) {
        for (uint32_t b = 0; b < he_mesh_issued(m, HE_VERTEX); b++) {
            if (!he_mesh_is_live(m, HE_VERTEX, a) || !he_mesh_is_live(m, HE_VERTEX, b)) {
                continue;
            }
            he_ids common = {0};
            assert_int_equal(he_common_faces(m, (he_vertex){a}, (he_vertex){b}, &common, NULL),
                             HE_OK);
            for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
                bool wanted = he_mesh_is_live(m, HE_FACE, f) &&
                              belongs(m, HE_FACE, "vertices", f, a) &&
                              belongs(m, HE_FACE, "vertices", f, b);
                assert_int_equal(times_in(&common, f), wanted);
            }
            he_ids_clear(&common);
        }
    }
}

static void relations_agree_with_a_search(void **state)
{
    (void)state;
    for (size_t i = 0; i <= QUERY_SPECIMENS; i++) {
        he_mesh *m =
            i < QUERY_SPECIMENS ? fixture_mesh(query_specimens[i]) : query_with_dead_rows();
        try_all(m);
        try_order(m);
        try_dense(m);
        try_common_faces(m);
        he_mesh_free(m);
    }
}

static void assert_ids(he_ids ids, const char *wanted)
{
    char text[256] = "";
    for (size_t i = 0; i < ids.count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, i == 0 ? "%u" : " %u", ids.ids[i]);
    }
    assert_string_equal(text, wanted);
    he_ids_clear(&ids);
}

static void relations_of_known_meshes_list_each_id_once_in_order(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,034,056");
    /* Vertex 0 has three separate fans of faces. In the answer, each fan begins with its boundary
     * half-edge and continues counter-clockwise. */
    he_ids faces = ids_of(m, HE_VERTEX, "faces", 0, 0);
    assert_int_equal(faces.count, 3);
    he_ids_clear(&faces);
    assert_ids(ids_of(m, HE_FACE, "faces", 1, 0), "");
    assert_ids(ids_of(m, HE_FACE, "vertices", 1, 0), "0 3 4");
    assert_ids(ids_of(m, HE_FACE, "vertices", 1, HE_CLOCKWISE), "0 4 3");
    assert_ids(ids_of(m, HE_EDGE, "vertices", 4, 0), "3 4");
    assert_ids(ids_of(m, HE_EDGE, "halfedges", 4, 0), "8 9");
    assert_ids(ids_of(m, HE_EDGE, "faces", 4, 0), "1");
    he_mesh_free(m);
    /* A neighbouring face must be listed once even if it shares two edges with the face. */
    m = fixture_mesh("0123,2104");
    assert_ids(ids_of(m, HE_FACE, "faces", 0, 0), "1");
    assert_ids(ids_of(m, HE_FACE, "faces", 1, 0), "0");
    assert_ids(ids_of(m, HE_EDGE, "faces", 0, 0), "0 1");
    he_mesh_free(m);
    m = fixture_mesh("012,456");
    assert_ids(ids_of(m, HE_VERTEX, "vertices", 3, 0), "");
    assert_ids(ids_of(m, HE_VERTEX, "faces", 3, HE_CLOCKWISE), "");
    he_mesh_free(m);
}

/* The face has too many neighbours for finding duplicates by comparing pairs, and it shares two
 * edges with each neighbour. */
static void neighbours_of_a_large_face_are_listed_once(void **state)
{
    (void)state;
    enum { PAIRS = 50 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < 3 * PAIRS; v++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){v, v * v, 0}, NULL), HE_OK);
    }
    uint32_t ring[2 * PAIRS];
    for (uint32_t v = 0; v < 2 * PAIRS; v++) {
        ring[v] = v;
    }
    assert_int_equal(he_soup_add_face(&soup, ring, 2 * PAIRS, NULL), HE_OK);
    for (uint32_t i = 0; i < PAIRS; i++) {
        uint32_t a = 2 * i, b = a + 1, c = (a + 2) % (2 * PAIRS), tip = 2 * PAIRS + i;
        assert_int_equal(he_soup_add_face(&soup, (uint32_t[]){c, b, a, tip}, 4, NULL), HE_OK);
    }
    he_mesh *m = NULL;
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    he_ids faces = ids_of(m, HE_FACE, "faces", 0, 0);
    assert_int_equal(faces.count, PAIRS);
    for (uint32_t i = 0; i < PAIRS; i++) {
        assert_int_equal(faces.ids[i], i + 1);
    }
    he_ids_clear(&faces);
    try_dense(m);
    he_mesh_free(m);
}

static void relations_refuse_elements_that_do_not_exist(void **state)
{
    (void)state;
    he_mesh *m = query_with_dead_rows();
    for (size_t i = 0; i < he_relation_count(); i++) {
        const he_relation *r = he_relation_at(i);
        assert_ptr_equal(he_relation_find(r->of, r->name, strlen(r->name)), r);
        uint32_t dead = he_mesh_issued(m, r->of) - 1;
        he_ids ids = {0};
        assert_int_equal(he_ids_add(&ids, 9, NULL), HE_OK);
        he_error err = {0};
        assert_int_equal(he_relation_append(m, r, dead, 0, &ids, &err), HE_DELETED_ELEMENT);
        assert_int_equal(err.kind, r->of);
        assert_int_equal(err.id, dead);
        assert_int_equal(he_relation_append(m, r, dead + 1, 0, &ids, &err), HE_NO_SUCH_ELEMENT);
        assert_int_equal(he_relation_append(m, r, HE_NONE, 0, &ids, &err), HE_NO_SUCH_ELEMENT);
        assert_int_equal(ids.count, 1);
        he_ids_clear(&ids);
        he_dense dense = {0};
        uint32_t list[] = {0, dead};
        assert_int_equal(he_relation_dense(m,
                                           &(he_neighbours){.relation = r, .of = list, .count = 2},
                                           0, &dense, &err),
                         HE_DELETED_ELEMENT);
        assert_int_equal(he_relation_dense(m,
                                           &(he_neighbours){.relation = r, .of = list, .count = 1},
                                           1, &dense, &err),
                         HE_LIMIT);
        assert_null(dense.ids.ids);
        assert_null(dense.offsets.ids);
        /* If a query lists no elements, its answer must be empty. */
        assert_int_equal(he_relation_dense(m,
                                           &(he_neighbours){.relation = r, .of = list, .count = 0},
                                           0, &dense, &err),
                         HE_OK);
        assert_int_equal(dense.offsets.count, 1);
        assert_int_equal(dense.ids.count, 0);
        he_dense_clear(&dense);
    }
    assert_null(he_relation_find(HE_VERTEX, "loop", 4));
    assert_null(he_relation_find(HE_VERTEX, "face", 4));
    assert_null(he_relation_find(HE_MESH_KIND, "faces", 5));
    he_ids common = {0};
    assert_int_equal(he_common_faces(m, (he_vertex){0}, (he_vertex){5}, &common, NULL),
                     HE_DELETED_ELEMENT);
    assert_int_equal(he_common_faces(m, (he_vertex){9}, (he_vertex){0}, &common, NULL),
                     HE_NO_SUCH_ELEMENT);
    he_mesh_free(m);
}

/* The links of the mesh are broken: turning around a vertex never comes back, and links lead out of
 * the mesh. The queries must still end. */
static void relations_end_on_broken_links(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("0123,7654,1045,2156,3267,0374");
    uint32_t h = m->c.vertex_halfedge[0], turned = m->c.prev[h] ^ 1u;
    m->c.prev[turned] =
        turned ^
        1u; /* the link leads back to the same half-edge, so turning around the vertex never ends */
    he_ids ids = {0};
    he_error err = {0};
    assert_int_equal(he_relation_append(m, relation_named(HE_VERTEX, "vertices"), 0, 0, &ids, &err),
                     HE_CORRUPT);
    assert_int_equal(err.kind, HE_VERTEX);
    assert_int_equal(err.id, 0);
    assert_int_equal(ids.count, 0);
    he_ids_clear(&ids);
    he_mesh_free(m);
    uint64_t seed = 1;
    for (int round = 0; round < 3000; round++) {
        m = fixture_mesh(query_specimens[query_random(&seed) % QUERY_SPECIMENS]);
        for (uint64_t n = 1 + query_random(&seed) % 3; n > 0; n--) {
            query_spoil(m, &seed);
        }
        for (size_t i = 0; i < he_relation_count(); i++) {
            const he_relation *r = he_relation_at(i);
            he_dense dense = {0};
            he_status status =
                he_relation_dense(m, &(he_neighbours){.relation = r}, 0, &dense, NULL);
            assert_true(status == HE_OK || status == HE_CORRUPT);
            he_dense_clear(&dense);
            for (uint32_t id = 0; id < he_mesh_issued(m, r->of); id++) {
                status = he_relation_append(m, r, id, 0, &ids, NULL);
                assert_true(status == HE_OK || status == HE_CORRUPT ||
                            status == HE_DELETED_ELEMENT);
                he_ids_clear(&ids);
            }
        }
        he_mesh_free(m);
    }
}

static void relations_without_memory_are_refused_and_give_no_ids(void **state)
{
    (void)state;
    he_mesh *m = query_shape("cone", 40, 1, 1, 1);
    for (size_t i = 0; i < he_relation_count(); i++) {
        failing f = {0};
        while (failing_next(&f)) {
            he_dense dense = {0};
            he_status status = he_relation_dense(m, &(he_neighbours){.relation = he_relation_at(i)},
                                                 0, &dense, NULL);
            assert_true(failing_status(&f, status) || dense.ids.ids == NULL);
            he_dense_clear(&dense);
        }
    }
    failing f = {0};
    while (failing_next(&f)) {
        he_ids common = {0};
        he_status status = he_common_faces(m, (he_vertex){40}, (he_vertex){1}, &common, NULL);
        assert_int_equal(common.count, failing_status(&f, status) ? 2 : 0);
        he_ids_clear(&common);
    }
    he_mesh_free(m);
}

static void an_idmap_numbers_ids_in_order_of_arrival(void **state)
{
    (void)state;
    he_idmap map = {0};
    uint64_t seed = 7;
    uint32_t next = 0;
    assert_int_equal(he_idmap_find(&map, 0), HE_NONE);
    for (int i = 0; i < 20000; i++) {
        uint32_t id = (uint32_t)(query_random(&seed) % 5000) * 65536u, index;
        uint32_t before = he_idmap_find(&map, id);
        bool added;
        assert_int_equal(he_idmap_add(&map, id, &index, &added, NULL), HE_OK);
        assert_int_equal(added, before == HE_NONE);
        assert_int_equal(index, added ? next++ : before);
        assert_int_equal(map.ids.ids[index], id);
    }
    assert_int_equal(map.ids.count, next);
    he_idmap_clear(&map);
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        uint32_t index;
        bool added;
        for (uint32_t id = 0; id < 100; id++) {
            size_t count = map.ids.count;
            if (he_idmap_add(&map, id, &index, &added, NULL) != HE_OK) {
                assert_int_equal(map.ids.count, count);
                assert_int_equal(he_idmap_find(&map, id), HE_NONE);
                assert_int_equal(he_idmap_add(&map, id, &index, &added, NULL), HE_OK);
            }
            assert_int_equal(index, id);
        }
        failing_end(&f, true);
        he_idmap_clear(&map);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relations_agree_with_a_search),
        cmocka_unit_test(relations_of_known_meshes_list_each_id_once_in_order),
        cmocka_unit_test(neighbours_of_a_large_face_are_listed_once),
        cmocka_unit_test(relations_refuse_elements_that_do_not_exist),
        cmocka_unit_test(relations_end_on_broken_links),
        cmocka_unit_test(relations_without_memory_are_refused_and_give_no_ids),
        cmocka_unit_test(an_idmap_numbers_ids_in_order_of_arrival),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
