/* Repairs of random soups of every kind are compared with simple, slow checks. The environment
 * variable SEED sets the random numbers, to repeat a run. */
#include "repair_fixture.h"

#include "model/random.h"
#include "query/topology.h"

#include <math.h>

static uint64_t seed(void)
{
    const char *text = getenv("SEED");
    uint64_t out = text == NULL ? 1 : strtoull(text, NULL, 10);
    print_message("SEED=%llu\n", (unsigned long long)out);
    return out;
}

/* --- welding --- */

static bool is_near(he_vec3 a, he_vec3 b, double tolerance)
{
    double x = fabs(a.x - b.x), y = fabs(a.y - b.y), z = fabs(a.z - b.z);
    if (x > tolerance || y > tolerance || z > tolerance) {
        return false;
    }
    return tolerance == 0 || x / tolerance * (x / tolerance) + y / tolerance * (y / tolerance) +
                                     z / tolerance * (z / tolerance) <=
                                 1;
}

/* Checks the result of a weld against its definition in the header, by comparing all pairs of
 * vertices. */
static void expect_welded(const he_soup *soup, double tolerance)
{
    he_soup copy;
    he_repaired done = {0};
    he_repair_plan plan = {.which = WELD, .tolerance = tolerance};
    repair_copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
    repair_expect_carried(soup, &copy, &done, true);
    uint32_t *kept = calloc(soup->vertex_count + 1, sizeof *kept), count = 0;
    uint32_t *into = calloc(soup->vertex_count + 1, sizeof *into);
    assert_true(kept != NULL && into != NULL);
    for (uint32_t v = 0; v < soup->vertex_count; v++) {
        uint32_t k = 0;
        while (k < count && !is_near(soup->positions[kept[k]], soup->positions[v], tolerance)) {
            k++;
        }
        into[v] = k;
        if (k == count) {
            kept[count++] = v;
        }
    }
    assert_int_equal(copy.vertex_count, count);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_WELD)->count, soup->vertex_count - count);
    for (uint32_t v = 0; v < count && done.vertex_from != NULL; v++) {
        assert_int_equal(done.vertex_from[v], kept[v]);
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        assert_int_equal(copy.corners[c], into[soup->corners[c]]);
    }
    for (size_t i = 0; i < repair_account_of(&done, HE_REPAIR_WELD)->named; i++) {
        he_repair_pair pair = repair_account_of(&done, HE_REPAIR_WELD)->pairs[i];
        assert_int_equal(into[pair.a], pair.b);
    }
    free(kept);
    free(into);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
}

static void welding_is_what_comparing_all_would_do(void **state)
{
    (void)state;
    static const double scales[] = {1, 1e-300, 1e300, 1e-3, 0x1p50, 0x1p47, 0x1p53};
    static const double tolerances[] = {0, 1, 0.3, 1e-300, 1e290, 0x1p-60, 1.7e308, 5e-324};
    md_random random = {seed()};
    for (size_t round = 0; round < 400; round++) {
        he_soup soup;
        he_soup_init(&soup, NULL);
        double scale = scales[md_below(&random, 7)];
        double step = round % 2 == 0 ? 0.25 : 0.1;
        size_t count = md_below(&random, 60);
        for (size_t v = 0; v < count; v++) {
            double p[3];
            for (size_t i = 0; i < 3; i++) {
                p[i] = ((double)md_below(&random, 9) - 4) * step * scale;
                p[i] = md_below(&random, 4) == 0 ? nextafter(p[i], 1e308) : p[i];
                p[i] = md_below(&random, 8) == 0 ? -0.0 : p[i];
            }
            assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){p[0], p[1], p[2]}, NULL), HE_OK);
        }
        for (uint32_t v = 0; v + 2 < count; v++) {
            const uint32_t corners[] = {v, v + 1, v + 2};
            assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
        }
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            expect_welded(&soup, tolerances[t]);
            expect_welded(&soup, tolerances[t] * scale < 1.7e308 ? tolerances[t] * scale : 1);
        }
        he_soup_clear(&soup);
    }
}

/* --- random soups and all repairs --- */

/* Makes random faces on few vertices. Most faces are triangles that share an edge with the face
 * made before them. */
static void random_soup(md_random *random, he_soup *soup)
{
    uint32_t vertices = 3 + md_below(random, 8), corners[8] = {0, 1, 2};
    size_t faces = md_below(random, 24);
    bool is_tame = md_below(random, 2) == 0;
    he_soup_init(soup, NULL);
    for (uint32_t v = 0; v < vertices; v++) {
        he_vec3 p = {(double)md_below(random, 3), (double)md_below(random, 3), 0};
        assert_int_equal(he_soup_add_vertex(soup, p, NULL), HE_OK);
    }
    for (size_t f = 0; f < faces; f++) {
        size_t degree = 3;
        if (!is_tame && md_below(random, 3) == 0) {
            degree = md_below(random, 8);
        }
        uint32_t turn = md_below(random, 3);
        uint32_t a = corners[turn], b = corners[(turn + 1) % 3];
        corners[0] = md_below(random, 2) == 0 ? a : b;
        corners[1] = corners[0] == a ? b : a;
        for (size_t i = 2; i < degree; i++) {
            corners[i] = md_below(random, vertices);
            for (size_t k = 0; is_tame && k < 2; k++) {
                if (corners[i] == corners[k]) {
                    corners[i] = (corners[i] + 1) % vertices;
                    k = (size_t)-1;
                }
            }
        }
        if (md_below(random, 12) == 0 && soup->corner_count > 0) {
            size_t again = md_below(random, (uint32_t)soup->face_count);
            degree = he_soup_end(soup, again) - soup->starts[again];
            memcpy(corners, soup->corners + soup->starts[again], degree * sizeof *corners);
        }
        assert_int_equal(he_soup_add_face(soup, corners, degree, NULL), HE_OK);
    }
}

static bool is_degenerate(const he_soup *soup, size_t f)
{
    uint32_t begin = soup->starts[f], end = he_soup_end(soup, f);
    for (uint32_t a = begin; a < end; a++) {
        for (uint32_t b = a + 1; b < end; b++) {
            if (soup->corners[a] == soup->corners[b]) {
                return true;
            }
        }
    }
    return end - begin < 3;
}

/* Returns whether two faces have the same cyclic order of corners, in the same or in the opposite
 * direction. */
static bool are_duplicates(const he_soup *soup, size_t f, size_t g)
{
    uint32_t n = he_soup_end(soup, f) - soup->starts[f];
    const uint32_t *a = soup->corners + soup->starts[f], *b = soup->corners + soup->starts[g];
    bool found = false;
    if (he_soup_end(soup, g) - soup->starts[g] != n) {
        return false;
    }
    for (uint32_t from = 0; from < n && !found; from++) {
        bool same = true, back = true;
        for (uint32_t i = 0; i < n; i++) {
            same = same && a[i] == b[(from + i) % n];
            back = back && a[i] == b[(from + n - i) % n];
        }
        found = same || back;
    }
    return found;
}

/* Removes spikes (paths that go out and straight back) and repeated neighbouring corners from a
 * loop, in the order in which they are found. Returns the new number of corners. */
static uint32_t reduce(uint32_t *loop, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        bool again = n > 1 && loop[i] == loop[(i + 1) % n];
        bool spike = n > 2 && loop[i] == loop[(i + 2) % n];
        if (again || spike) {
            uint32_t gone = (i + 1) % n;
            memmove(loop + gone, loop + gone + 1, (n - gone - 1) * sizeof *loop);
            return reduce(loop, n - 1);
        }
    }
    return n;
}

/* The directed edges of a set of loops; `ends` lists the two vertices of each edge. */
typedef struct runs {
    uint32_t ends[32][2];
    uint32_t count;
} runs;

static void add_runs(runs *r, const uint32_t *loop, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++, r->count++) {
        assert_true(r->count < 32);
        r->ends[r->count][0] = loop[i];
        r->ends[r->count][1] = loop[(i + 1) % n];
    }
}

static int count_run(const runs *r, uint32_t a, uint32_t b)
{
    int count = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        count += r->ends[i][0] == a && r->ends[i][1] == b;
    }
    return count;
}

static bool runs_twice(const runs *r)
{
    bool twice = false;
    for (uint32_t i = 0; i < r->count; i++) {
        twice = twice || count_run(r, r->ends[i][0], r->ends[i][1]) > 1;
    }
    return twice;
}

/* Requires that the loops in `a` and the loops in `b` have the same directed edges. Edges that are
 * used in both directions are not counted, because they cancel out. */
static void expect_same_rim(const runs *a, const runs *b)
{
    for (uint32_t v = 0; v < 11; v++) {
        for (uint32_t w = 0; w < v; w++) {
            assert_int_equal(count_run(a, v, w) - count_run(a, w, v),
                             count_run(b, v, w) - count_run(b, w, v));
        }
    }
}

/* Checks the faces by which the repair replaced face f of the soup; the first of these faces is
 * face `at` of the result. Returns the number of these faces. */
static size_t expect_mended(const he_soup *soup, size_t f, const he_soup *after,
                            const uint32_t *from, size_t at)
{
    uint32_t loop[8], n = he_soup_end(soup, f) - soup->starts[f];
    runs left = {.count = 0}, now = {.count = 0};
    size_t made = 0;
    for (uint32_t i = 0; i < n; i++) {
        loop[i] = soup->corners[soup->starts[f] + i];
    }
    n = reduce(loop, n);
    add_runs(&left, loop, n);
    for (; at + made < after->face_count && from[at + made] == f; made++) {
        uint32_t begin = after->starts[at + made];
        assert_false(is_degenerate(after, at + made));
        add_runs(&now, after->corners + begin, he_soup_end(after, at + made) - begin);
    }
    if (n < 3 || runs_twice(&left)) {
        assert_int_equal(made, 0);
    } else if (made > 0) {
        assert_false(runs_twice(&now));
        expect_same_rim(&now, &left);
    }
    return made;
}

/* Repairs a copy of the soup and requires that it has no degenerate faces left. The copy becomes
 * `out`, which the caller must clear. */
static void expect_no_degenerate(const he_soup *soup, he_soup *out, unsigned *cut)
{
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(DEGENERATE);
    repair_copy_soup(soup, out);
    assert_int_equal(he_repair_soup(out, &plan, &done, NULL), HE_OK);
    repair_expect_carried(soup, out, &done, false);
    size_t at = 0, gone = 0, mended = 0;
    for (size_t f = 0; f < soup->face_count; f++) {
        if (!is_degenerate(soup, f)) {
            assert_true(at < out->face_count);
            assert_true(done.face_from == NULL || done.face_from[at] == f);
            at++;
            continue;
        }
        size_t made = expect_mended(soup, f, out, done.face_from, at);
        gone += made == 0;
        mended += made > 0;
        *cut += made > 1;
        at += made;
    }
    assert_int_equal(at, out->face_count);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE)->count, gone);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE)->parts, mended);
    he_repaired_clear(&done);
}

/* Removes duplicate faces and requires that none are left. Degenerate faces are dropped first,
 * because two degenerate faces may be duplicates. */
static void expect_no_duplicates(const he_soup *soup)
{
    he_soup copy;
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(DEGENERATE | DUPLICATES);
    repair_copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
    repair_expect_carried(soup, &copy, &done, false);
    size_t kept = 0;
    for (size_t f = 0; f < soup->face_count; f++) {
        bool gone = false;
        for (size_t g = 0; g < f && !gone; g++) {
            gone = are_duplicates(soup, f, g);
        }
        if (!gone) {
            assert_true(kept < copy.face_count);
            assert_int_equal(done.face_from == NULL ? kept : done.face_from[kept], f);
            kept++;
        }
    }
    assert_int_equal(kept, copy.face_count);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DEGENERATE)->count, 0);
    assert_int_equal(repair_account_of(&done, HE_REPAIR_DROP_DUPLICATES)->count,
                     soup->face_count - kept);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
}

/* Counts the faces at the edge between the vertices `a` and `b`: the faces that use the edge from a
 * to b, and the faces that use it from b to a. */
static void count_runs(const he_soup *soup, uint32_t a, uint32_t b, unsigned *up, unsigned *down)
{
    *up = *down = 0;
    for (size_t f = 0; f < soup->face_count; f++) {
        uint32_t end = he_soup_end(soup, f);
        for (uint32_t c = soup->starts[f]; c < end; c++) {
            uint32_t next = soup->corners[c + 1 < end ? c + 1 : soup->starts[f]];
            *up += soup->corners[c] == a && next == b;
            *down += soup->corners[c] == b && next == a;
        }
    }
}

/* Returns whether faces can be reversed so that the two faces of each edge use the edge in opposite
 * directions. A union-find has two entries for each face: one for the face as it is, and one for
 * the reversed face. If both entries of a face are in one class, the function returns false. */
static bool is_orientable(const he_soup *soup)
{
    size_t n = soup->face_count;
    uint32_t *class = calloc(2 * n + 1, sizeof *class);
    assert_non_null(class);
    for (uint32_t i = 0; i < 2 * n; i++) {
        class[i] = i;
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        for (size_t d = 0; d < c; d++) {
            uint32_t f = he_soup_face_of(soup, c), g = he_soup_face_of(soup, d);
            uint32_t a = soup->corners[c], x = soup->corners[d];
            uint32_t b = soup->corners[c + 1 < he_soup_end(soup, f) ? c + 1 : soup->starts[f]];
            uint32_t y = soup->corners[d + 1 < he_soup_end(soup, g) ? d + 1 : soup->starts[g]];
            unsigned up, down;
            bool same = a == x && b == y;
            if (!same && !(a == y && b == x)) {
                continue;
            }
            count_runs(soup, a, b, &up, &down);
            for (uint32_t side = 0; side < 2 && up + down == 2; side++) {
                uint32_t p = class[f + n * side], q = class[g + n * (side ^ same)];
                for (size_t i = 0; i < 2 * n; i++) {
                    class[i] = class[i] == q ? p : class[i];
                }
            }
        }
    }
    bool good = true;
    for (size_t f = 0; f < n; f++) {
        good = good && class[f] != class[f + n];
    }
    free(class);
    return good;
}

static void expect_oriented(const he_soup *soup)
{
    he_soup copy;
    he_repaired done = {0};
    he_repair_plan plan = repair_plan_of(DEGENERATE | ORIENT);
    repair_copy_soup(soup, &copy);
    he_status status = he_repair_soup(&copy, &plan, &done, NULL);
    if (status == HE_OK) {
        repair_expect_carried(soup, &copy, &done, false);
        assert_true(is_orientable(&copy));
        for (uint32_t a = 0; a < copy.vertex_count; a++) {
            for (uint32_t b = 0; b < a; b++) {
                unsigned up, down;
                count_runs(&copy, a, b, &up, &down);
                assert_true(up + down != 2 || up == 1);
            }
        }
    } else {
        assert_int_equal(status, HE_NOT_ORIENTABLE);
        assert_false(is_orientable(&copy));
    }
    he_repaired_clear(&done);
    he_soup_clear(&copy);
}

/* Requires that after the repair `split` there is no bow-tie, and that two faces that use an edge
 * in opposite directions are still joined at this edge. */
static void expect_split(const he_soup *soup)
{
    he_soup copy, again;
    he_repaired done = {0};
    he_ids bowties = {0};
    he_repair_plan drop = repair_plan_of(DEGENERATE), split = repair_plan_of(SPLIT);
    repair_copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &drop, &done, NULL), HE_OK);
    he_repaired_clear(&done);
    he_mesh *mesh = repair_mend(&copy, &split, &done);
    assert_int_equal(he_bowties_find(mesh, &bowties, NULL), HE_OK);
    assert_int_equal(bowties.count, 0);
    he_repaired_clear(&done);
    repair_copy_soup(&copy, &again);
    assert_int_equal(he_repair_soup(&again, &split, &done, NULL), HE_OK);
    for (size_t f = 0; f < copy.face_count; f++) {
        uint32_t end = he_soup_end(&copy, f);
        for (uint32_t c = copy.starts[f]; c < end; c++) {
            uint32_t next = c + 1 < end ? c + 1 : copy.starts[f];
            unsigned up, down;
            count_runs(&copy, copy.corners[c], copy.corners[next], &up, &down);
            if (up == 1 && down == 1) {
                count_runs(&again, again.corners[c], again.corners[next], &up, &down);
                assert_true(up == 1 && down == 1);
            }
        }
    }
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
    he_soup_clear(&again);
}

/* Applies the repairs `asked`. If the soup cannot be built even then, the repairs that the error
 * recommends must be enough. */
static void expect_advice(const he_soup *soup, unsigned asked)
{
    he_soup copy;
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    he_repair_plan plan = repair_plan_of(asked);
    unsigned which = 0;
    repair_copy_soup(soup, &copy);
    he_status status = he_repair_soup(&copy, &plan, &done, NULL);
    if (status == HE_OK) {
        status = he_build(&copy, HE_BUILD_TAKE, &mesh, NULL, NULL);
    }
    he_repaired_clear(&done);
    he_mesh_free(mesh);
    if (status != HE_OK) {
        assert_int_equal(he_repair_advise(&copy, asked, &which, NULL), HE_OK);
        assert_int_equal(which & asked, asked);
        assert_int_not_equal(which, asked);
        plan = repair_plan_of(which);
        mesh = repair_mend(soup, &plan, &done);
        he_repaired_clear(&done);
        he_mesh_free(mesh);
    }
    he_soup_clear(&copy);
}

static void soups_of_every_kind_are_mended(void **state)
{
    (void)state;
    md_random random = {seed()};
    unsigned cut = 0;
    for (size_t round = 0; round < 6000; round++) {
        he_soup soup, proper;
        he_repaired done = {0};
        random_soup(&random, &soup);
        expect_no_degenerate(&soup, &proper, &cut);
        expect_no_duplicates(&proper);
        he_soup_clear(&proper);
        expect_oriented(&soup);
        expect_split(&soup);
        expect_advice(&soup, 0);
        expect_advice(&soup, md_below(&random, ALL + 1));
        he_repair_plan plan = repair_plan_of(md_below(&random, ALL + 1) | DEGENERATE | SPLIT);
        he_mesh *mesh = repair_mend(&soup, &plan, &done);
        he_mesh_free(mesh);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
    }
    print_message("note: %u faces that come to a vertex twice were cut\n", cut);
    assert_true(cut > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(welding_is_what_comparing_all_would_do),
        cmocka_unit_test(soups_of_every_kind_are_mended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
