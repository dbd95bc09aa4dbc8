#include "unit/fixture.h"

void fixture_soup(he_soup *soup, const char *faces)
{
    he_soup_init(soup, NULL);
    uint32_t most = 0;
    for (const char *p = faces; *p != '\0'; p++) {
        most = *p >= '0' && *p <= '9' && (uint32_t)(*p - '0') > most ? (uint32_t)(*p - '0') : most;
    }
    for (uint32_t v = 0; *faces != '\0' && v <= most; v++) {
        he_vec3 position = {(double)(v * v % 7), (double)(v * 3 % 5), (double)v};
        assert_int_equal(he_soup_add_vertex(soup, position, NULL), HE_OK);
    }
    for (const char *p = faces; *p != '\0';) {
        if (*p < '0' || *p > '9') {
            p++;
            continue;
        }
        assert_int_equal(he_soup_begin_face(soup, NULL), HE_OK);
        for (; *p >= '0' && *p <= '9'; p++) {
            assert_int_equal(he_soup_add_corner(soup, (uint32_t)(*p - '0'), NULL), HE_OK);
        }
    }
}

void fixture_check(const he_mesh *mesh)
{
    he_problem problem;
    size_t total = 1;
    assert_int_equal(he_check(mesh, &problem, 1, &total, NULL), HE_OK);
    if (total != 0) {
        fail_msg("I%d: %s", problem.rule, problem.text);
    }
}

he_mesh *fixture_mesh(const char *faces)
{
    he_soup soup;
    he_mesh *mesh = NULL;
    he_error err = {0};
    fixture_soup(&soup, faces);
    if (he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, &err) != HE_OK) {
        fail_msg("%s: %s", faces, err.text);
    }
    he_soup_clear(&soup);
    fixture_check(mesh);
    return mesh;
}

void fixture_counts(const he_mesh *mesh, unsigned v, unsigned e, unsigned f)
{
    assert_int_equal(he_mesh_vertices(mesh), v);
    assert_int_equal(he_mesh_edges(mesh), e);
    assert_int_equal(he_mesh_faces(mesh), f);
}
