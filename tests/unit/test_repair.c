/* Repairs of a soup, each beside an obvious check, and all of them on soups of every kind. */
#include "fixture.h"

#include "mesh/pair.h"
#include "model/random.h"
#include "query/topology.h"
#include "repair/repair.h"

#include <math.h>

enum { ALL = (1 << HE_REPAIR_COUNT) - 1 };

#define WELD       (1u << HE_REPAIR_WELD)
#define DEGENERATE (1u << HE_REPAIR_DROP_DEGENERATE)
#define DUPLICATES (1u << HE_REPAIR_DROP_DUPLICATES)
#define ORIENT     (1u << HE_REPAIR_ORIENT)
#define SPLIT      (1u << HE_REPAIR_SPLIT)
#define FILL       (1u << HE_REPAIR_FILL)

static uint64_t seed(void)
{
    const char *text = getenv("SEED");
    uint64_t out = text == NULL ? 1 : strtoull(text, NULL, 10);
    print_message("SEED=%llu\n", (unsigned long long)out);
    return out;
}

static he_repair_plan plan_of(unsigned which)
{
    return (he_repair_plan){.which = which, .hole_edges = 8};
}

/* A soup from another one's faces, whose attributes say their own row. */
static void copy_soup(const he_soup *from, he_soup *to)
{
    static const he_kind domains[] = {HE_VERTEX, HE_FACE, HE_HALFEDGE};
    const size_t rows[] = {from->vertex_count, from->face_count, from->corner_count};
    he_soup_init(to, NULL);
    for (size_t v = 0; v < from->vertex_count; v++) {
        assert_int_equal(he_soup_add_vertex(to, from->positions[v], NULL), HE_OK);
    }
    for (size_t f = 0; f < from->face_count; f++) {
        uint32_t begin = from->starts[f], end = he_soup_end(from, f);
        assert_int_equal(he_soup_add_face(to, from->corners + begin, end - begin, NULL), HE_OK);
    }
    for (size_t i = 0; i < 3; i++) {
        he_column *column;
        assert_int_equal(
            he_soup_column(to, "row", domains[i], HE_UINT32, 1, HE_COPY, &column, NULL), HE_OK);
        assert_int_equal(he_column_extend(column, rows[i], NULL), HE_OK);
        for (uint32_t row = 0; row < rows[i]; row++) {
            memcpy(he_column_row(column, row), &row, sizeof row);
        }
    }
}

static uint32_t value(const he_soup *soup, size_t column, size_t row)
{
    uint32_t out;
    memcpy(&out, he_column_value(soup->columns[column], row), sizeof out);
    return out;
}

static const he_repair_account *account(const he_repaired *done, he_repair repair)
{
    return &done->accounts[repair];
}

/* Attributes went with what they belong to, and every corner is at the vertex it was at, or at the
 * one that this was welded to. */
static void expect_carried(const he_soup *before, const he_soup *after, const he_repaired *done,
                           bool welded)
{
    for (uint32_t v = 0; v < after->vertex_count; v++) {
        uint32_t from = done->vertex_from == NULL ? v : done->vertex_from[v];
        assert_int_equal(value(after, 0, v), from);
        assert_memory_equal(&after->positions[v], &before->positions[from], sizeof(he_vec3));
    }
    for (uint32_t f = 0; f < after->face_count; f++) {
        uint32_t from = done->face_from == NULL ? f : done->face_from[f];
        assert_int_equal(value(after, 1, f), from);
        assert_int_equal(he_soup_end(after, f) - after->starts[f],
                         he_soup_end(before, from) - before->starts[from]);
        assert_int_equal(value(after, 2, after->starts[f]), before->starts[from]);
        for (uint32_t c = after->starts[f]; c < he_soup_end(after, f); c++) {
            uint32_t corner = value(after, 2, c);
            uint32_t v = after->corners[c];
            assert_int_equal(he_soup_face_of(before, corner), from);
            if (!welded) {
                assert_int_equal(before->corners[corner],
                                 done->vertex_from == NULL ? v : done->vertex_from[v]);
            }
        }
    }
}

/* Repaired, built and checked; freed by the caller. */
static he_mesh *mend(const he_soup *soup, const he_repair_plan *plan, he_repaired *done)
{
    he_soup copy;
    he_mesh *mesh = NULL;
    he_error err = {0};
    copy_soup(soup, &copy);
    if (he_repair_soup(&copy, plan, done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    expect_carried(soup, &copy, done, (plan->which & WELD) != 0);
    if (he_build(&copy, HE_BUILD_TAKE, &mesh, NULL, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    if (he_repair_mesh(mesh, plan, done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(mesh);
    he_soup_clear(&copy);
    return mesh;
}

static he_mesh *mend_faces(const char *faces, unsigned which, he_repaired *done)
{
    he_soup soup;
    he_repair_plan plan = plan_of(which);
    fixture_soup(&soup, faces);
    he_mesh *mesh = mend(&soup, &plan, done);
    he_soup_clear(&soup);
    return mesh;
}

/* --- one by one --- */

#define CUBE "0321,4567,0154,1265,2376,3047"

static void the_set_that_is_named_lets_each_refused_soup_pass(void **state)
{
    (void)state;
    static const struct {
        const char *faces;
        he_status reason;
        unsigned which;
        unsigned v, e, f;
    } rows[] = {
        /* three faces on an edge; four, of two tetrahedra with a common face */
        {"012,103,014", HE_NONMANIFOLD_EDGE, SPLIT, 7, 8, 3},
        {"021,032,013,123,132,124,234,314", HE_NONMANIFOLD_EDGE, SPLIT, 8, 12, 8},
        /* a repeated corner, too few corners, none that is good */
        {"012,0230", HE_REPEATED_CORNER, DEGENERATE, 4, 3, 1},
        {"012,23", HE_TOO_FEW_CORNERS, DEGENERATE, 4, 3, 1},
        {"011,22", HE_REPEATED_CORNER, DEGENERATE, 3, 0, 0},
        /* neighbours that clash */
        {"012,123,032", HE_ORIENTATION, ORIENT, 4, 6, 3},
        {CUBE ",0", HE_TOO_FEW_CORNERS, DEGENERATE, 8, 12, 6},
        {"0321,4567,0154,1562,2376,3047", HE_ORIENTATION, ORIENT, 8, 12, 6},
        /* closed fans: with another closed one, and with an open one */
        {"021,032,013,123,354,365,346,456", HE_CLOSED_FAN, SPLIT, 8, 12, 8},
        {"021,032,013,123,345", HE_CLOSED_FAN, SPLIT, 7, 9, 5},
        /* the same face twice: alike, and within a surface */
        {"012,012", HE_ORIENTATION, DUPLICATES, 3, 3, 1},
        {"021,032,013,123,231", HE_NONMANIFOLD_EDGE, DUPLICATES, 4, 6, 4},
        {"021,032,013,123,132", HE_NONMANIFOLD_EDGE, DUPLICATES, 4, 6, 4},
        /* a Moebius band of five triangles */
        {"012,123,234,340,401", HE_ORIENTATION, ORIENT | SPLIT, 7, 11, 5},
        /* several at once */
        {"012,103,014,11,3345", HE_REPEATED_CORNER, DEGENERATE | SPLIT, 8, 8, 3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_soup soup, copy;
        he_mesh *mesh = NULL;
        he_report report;
        unsigned which = 0;
        fixture_soup(&soup, rows[i].faces);
        copy_soup(&soup, &copy);
        he_status status = he_build(&copy, HE_BUILD_TAKE, &mesh, &report, NULL);
        bool listed = false;
        for (size_t k = 0; k < report.total; k++) {
            listed = listed || report.defects[k].reason == rows[i].reason;
        }
        assert_int_not_equal(status, HE_OK);
        assert_true(listed);
        assert_int_equal(he_repair_advise(&copy, 0, &which, NULL), HE_OK);
        if (which != rows[i].which) {
            fail_msg("%s: %x", rows[i].faces, which);
        }
        he_repaired done = {0};
        he_repair_plan plan = plan_of(which);
        mesh = mend(&soup, &plan, &done);
        fixture_counts(mesh, rows[i].v, rows[i].e, rows[i].f);
        he_mesh_free(mesh);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
        he_soup_clear(&copy);
    }
}

static void nothing_is_done_to_what_is_good(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = mend_faces(CUBE, ALL, &done);
    fixture_counts(mesh, 8, 12, 6);
    assert_false(he_repaired_soup(&done));
    for (he_repair r = HE_REPAIR_WELD; r < HE_REPAIR_COUNT; r++) {
        assert_int_equal(account(&done, r)->count, 0);
        assert_int_equal(account(&done, r)->named, 0);
    }
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void no_repair_mends_an_index_that_names_nothing(void **state)
{
    (void)state;
    he_soup soup;
    unsigned which = ALL;
    he_mesh *mesh = NULL;
    he_repaired done = {0};
    he_repair_plan plan = plan_of(ALL);
    fixture_soup(&soup, "012,11");
    soup.corners[1] = 3;
    assert_int_equal(he_repair_soup(&soup, &plan, &done, NULL), HE_OK);
    assert_false(he_repaired_soup(&done));
    assert_int_not_equal(he_build(&soup, 0, &mesh, NULL, NULL), HE_OK);
    assert_int_equal(he_repair_advise(&soup, ALL, &which, NULL), HE_OK);
    assert_int_equal(which, 0);
    he_soup_clear(&soup);
}

static void a_moebius_band_is_not_orientable(void **state)
{
    (void)state;
    he_soup soup;
    he_error err = {0};
    he_repaired done = {0};
    he_repair_plan plan = plan_of(DEGENERATE | ORIENT);
    unsigned which;
    fixture_soup(&soup, "01,012,123,234,340,401");
    assert_int_equal(he_repair_soup(&soup, &plan, &done, &err), HE_NOT_ORIENTABLE);
    assert_int_equal(err.kind, HE_FACE);
    assert_in_range(err.id, 1, 5); /* as the input numbers it */
    assert_int_equal(he_repair_advise(&soup, plan.which, &which, NULL), HE_OK);
    assert_int_equal(which, DEGENERATE | ORIENT | SPLIT);
    he_repaired_clear(&done);
    he_soup_clear(&soup);

    done = (he_repaired){0};
    he_mesh *mesh = mend_faces("01,012,123,234,340,401", which, &done);
    assert_int_equal(account(&done, HE_REPAIR_ORIENT)->left, 1);
    assert_int_equal(account(&done, HE_REPAIR_SPLIT)->count, 2);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void the_larger_part_keeps_its_direction(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = mend_faces("0123,4567,0154,1265,2376,3047", ORIENT, &done);
    assert_int_equal(account(&done, HE_REPAIR_ORIENT)->count, 1);
    assert_int_equal(account(&done, HE_REPAIR_ORIENT)->parts, 1);
    assert_int_equal(account(&done, HE_REPAIR_ORIENT)->pairs[0].a, 0);
    /* turned about its first corner */
    he_halfedge h = he_face_halfedge(mesh, (he_face){0});
    assert_int_equal(he_origin(mesh, h).i, 0);
    assert_int_equal(he_target(mesh, h).i, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void copies_know_their_parents(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = mend_faces("021,032,013,123,354,365,346,456", SPLIT, &done);
    const he_repair_account *split = account(&done, HE_REPAIR_SPLIT);
    assert_int_equal(split->count, 1);
    assert_int_equal(split->parts, 1);
    assert_int_equal(split->named, 1);
    assert_int_equal(split->pairs[0].a, 7);
    assert_int_equal(split->pairs[0].b, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void bow_ties_of_open_fans_are_split_too(void **state)
{
    (void)state;
    he_repaired done = {0};
    he_mesh *mesh = mend_faces("012,034,056", SPLIT, &done);
    assert_int_equal(account(&done, HE_REPAIR_SPLIT)->count, 2);
    assert_int_equal(account(&done, HE_REPAIR_SPLIT)->parts, 1);
    fixture_counts(mesh, 9, 9, 3);
    he_mesh_free(mesh);
    he_repaired_clear(&done);
}

static void small_holes_are_filled(void **state)
{
    (void)state;
    he_repaired done = {0};
    /* a cube without its lid, and without two that meet at a vertex */
    he_mesh *mesh = mend_faces("0321,0154,1265,2376,3047", FILL, &done);
    fixture_counts(mesh, 8, 12, 6);
    assert_int_equal(account(&done, HE_REPAIR_FILL)->count, 1);
    assert_int_equal(account(&done, HE_REPAIR_FILL)->pairs[0].a, 5);
    assert_int_equal(account(&done, HE_REPAIR_FILL)->pairs[0].b, 4);
    he_mesh_free(mesh);
    he_repaired_clear(&done);

    /* the rim of one face stays, and so does one longer than allowed */
    done = (he_repaired){0};
    mesh = mend_faces("0123", FILL, &done);
    fixture_counts(mesh, 4, 4, 1);
    assert_int_equal(account(&done, HE_REPAIR_FILL)->left, 1);
    he_mesh_free(mesh);
    he_soup soup;
    he_repair_plan plan = {.which = FILL, .hole_edges = 3};
    done = (he_repaired){0};
    fixture_soup(&soup, "0321,0154,1265,2376,3047");
    mesh = mend(&soup, &plan, &done);
    fixture_counts(mesh, 8, 12, 5);
    assert_int_equal(account(&done, HE_REPAIR_FILL)->left, 1);
    he_mesh_free(mesh);
    he_soup_clear(&soup);
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

/* As the header says it, comparing each with each. */
static void expect_welded(const he_soup *soup, double tolerance)
{
    he_soup copy;
    he_repaired done = {0};
    he_repair_plan plan = {.which = WELD, .tolerance = tolerance};
    copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
    expect_carried(soup, &copy, &done, true);
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
    assert_int_equal(account(&done, HE_REPAIR_WELD)->count, soup->vertex_count - count);
    for (uint32_t v = 0; v < count && done.vertex_from != NULL; v++) {
        assert_int_equal(done.vertex_from[v], kept[v]);
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        assert_int_equal(copy.corners[c], into[soup->corners[c]]);
    }
    for (size_t i = 0; i < account(&done, HE_REPAIR_WELD)->named; i++) {
        he_repair_pair pair = account(&done, HE_REPAIR_WELD)->pairs[i];
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

/* --- soups of every kind --- */

/* Faces over few vertices: mostly triangles that walk on from the one before. */
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
        if (md_below(random, 12) == 0 && soup->face_count > 0) {
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

/* Turned to any corner, either way round. */
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

static void expect_dropped(const he_soup *soup)
{
    he_soup copy;
    he_repaired done = {0};
    he_repair_plan plan = plan_of(DEGENERATE | DUPLICATES);
    copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &plan, &done, NULL), HE_OK);
    expect_carried(soup, &copy, &done, false);
    size_t kept = 0, degenerate = 0;
    for (size_t f = 0; f < soup->face_count; f++) {
        bool gone = is_degenerate(soup, f);
        degenerate += gone;
        for (size_t g = 0; g < f && !gone; g++) {
            gone = !is_degenerate(soup, g) && are_duplicates(soup, f, g);
        }
        if (!gone) {
            assert_true(kept < copy.face_count);
            assert_int_equal(done.face_from == NULL ? kept : done.face_from[kept], f);
            kept++;
        }
    }
    assert_int_equal(kept, copy.face_count);
    assert_int_equal(account(&done, HE_REPAIR_DROP_DEGENERATE)->count, degenerate);
    assert_int_equal(account(&done, HE_REPAIR_DROP_DUPLICATES)->count,
                     soup->face_count - degenerate - kept);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
}

/* How often faces run along a-b in each direction. */
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

/* Is there a way of turning the faces so that those of edges with two agree? Twice the faces, kept
 * and turned, in classes: a face must not be in the class of its own turned self. */
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
    he_repair_plan plan = plan_of(DEGENERATE | ORIENT);
    copy_soup(soup, &copy);
    he_status status = he_repair_soup(&copy, &plan, &done, NULL);
    if (status == HE_OK) {
        expect_carried(soup, &copy, &done, false);
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

/* Splitting leaves no bow-tie, and joined what was joined by an edge of two opposite faces. */
static void expect_split(const he_soup *soup)
{
    he_soup copy, again;
    he_repaired done = {0};
    he_ids bowties = {0};
    he_repair_plan drop = plan_of(DEGENERATE), split = plan_of(SPLIT);
    copy_soup(soup, &copy);
    assert_int_equal(he_repair_soup(&copy, &drop, &done, NULL), HE_OK);
    he_repaired_clear(&done);
    he_mesh *mesh = mend(&copy, &split, &done);
    assert_int_equal(he_bowties_find(mesh, &bowties, NULL), HE_OK);
    assert_int_equal(bowties.count, 0);
    he_repaired_clear(&done);
    copy_soup(&copy, &again);
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

/* Whatever is asked for first: where it is refused, the set that is named then lets it pass. */
static void expect_advice(const he_soup *soup, unsigned asked)
{
    he_soup copy;
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    he_repair_plan plan = plan_of(asked);
    unsigned which = 0;
    copy_soup(soup, &copy);
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
        plan = plan_of(which);
        mesh = mend(soup, &plan, &done);
        he_repaired_clear(&done);
        he_mesh_free(mesh);
    }
    he_soup_clear(&copy);
}

static void soups_of_every_kind_are_mended(void **state)
{
    (void)state;
    md_random random = {seed()};
    for (size_t round = 0; round < 6000; round++) {
        he_soup soup;
        he_repaired done = {0};
        random_soup(&random, &soup);
        expect_dropped(&soup);
        expect_oriented(&soup);
        expect_split(&soup);
        expect_advice(&soup, 0);
        expect_advice(&soup, md_below(&random, ALL + 1));
        he_repair_plan plan = plan_of(md_below(&random, ALL + 1) | DEGENERATE | SPLIT);
        he_mesh *mesh = mend(&soup, &plan, &done);
        he_mesh_free(mesh);
        he_repaired_clear(&done);
        he_soup_clear(&soup);
    }
}

/* --- failing --- */

static he_status mend_or_fail(const he_soup *soup, unsigned which, he_watch *watch)
{
    he_soup copy;
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    he_error err = {0};
    he_repair_plan plan = plan_of(which);
    long fail_at = fixture_memory.fail_at;
    fixture_memory_back();
    copy_soup(soup, &copy);
    copy.limits.watch = watch;
    fixture_fail_at(fail_at);
    he_status status = he_repair_soup(&copy, &plan, &done, &err);
    if (status == HE_OK) {
        status = he_build(&copy, 0, &mesh, NULL, &err);
    }
    if (status == HE_OK) {
        he_mesh_watch(mesh, watch);
        status = he_repair_mesh(mesh, &plan, &done, &err);
    }
    assert_int_equal(err.status, status);
    fixture_memory_back();
    he_mesh_free(mesh);
    he_repaired_clear(&done);
    he_soup_clear(&copy);
    fixture_memory.fail_at = fail_at;
    return status;
}

#define BROKEN "0,012,103,014,033,015,567,576,0321,785,012"

static void every_failing_allocation_is_survived(void **state)
{
    (void)state;
    he_soup soup;
    fixture_soup(&soup, BROKEN);
    soup.positions[8] = soup.positions[0];
    for (unsigned which = 0; which <= ALL; which++) {
        if ((which & (DEGENERATE | SPLIT)) != (DEGENERATE | SPLIT)) {
            continue;
        }
        he_status status = HE_NO_MEMORY;
        for (long n = 1; status != HE_OK; n++) {
            fixture_memory.fail_at = n;
            status = mend_or_fail(&soup, which, NULL);
            assert_true(status == HE_OK || status == HE_NO_MEMORY);
        }
    }
    fixture_memory.fail_at = 0;
    he_status status = HE_NO_MEMORY;
    for (long n = 1; status != HE_OK; n++) {
        he_soup copy;
        unsigned which;
        copy_soup(&soup, &copy);
        fixture_fail_at(n);
        status = he_repair_advise(&copy, 0, &which, NULL);
        fixture_memory_back();
        assert_true(status == HE_OK || status == HE_NO_MEMORY);
        he_soup_clear(&copy);
    }
    he_soup_clear(&soup);
}

typedef struct teller {
    int left;
    double done;
} teller;

static bool tell(void *context, const char *phase, double done)
{
    teller *t = context;
    assert_non_null(phase);
    assert_true(done >= t->done && done <= 1);
    t->done = done;
    return --t->left > 0;
}

static void it_can_be_given_up_at_any_time(void **state)
{
    (void)state;
    he_soup soup;
    fixture_soup(&soup, BROKEN);
    fixture_memory.fail_at = 0;
    he_status status = HE_CANCELLED;
    for (int n = 1; status != HE_OK; n++) {
        teller t = {.left = n};
        he_watch watch;
        he_watch_init(&watch, tell, &t);
        status = mend_or_fail(&soup, ALL, &watch);
        assert_true(status == HE_OK || status == HE_CANCELLED);
    }
    he_soup_clear(&soup);
}

static void copies_keep_within_the_limits(void **state)
{
    (void)state;
    he_soup soup;
    he_error err = {0};
    he_repaired done = {0};
    he_repair_plan plan = plan_of(SPLIT);
    fixture_soup(&soup, "012,034,056");
    soup.limits.vertices = 8;
    assert_int_equal(he_repair_soup(&soup, &plan, &done, &err), HE_LIMIT);
    he_repaired_clear(&done);
    he_soup_clear(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_set_that_is_named_lets_each_refused_soup_pass),
        cmocka_unit_test(nothing_is_done_to_what_is_good),
        cmocka_unit_test(no_repair_mends_an_index_that_names_nothing),
        cmocka_unit_test(a_moebius_band_is_not_orientable),
        cmocka_unit_test(the_larger_part_keeps_its_direction),
        cmocka_unit_test(copies_know_their_parents),
        cmocka_unit_test(bow_ties_of_open_fans_are_split_too),
        cmocka_unit_test(small_holes_are_filled),
        cmocka_unit_test(welding_is_what_comparing_all_would_do),
        cmocka_unit_test(soups_of_every_kind_are_mended),
        cmocka_unit_test(every_failing_allocation_is_survived),
        cmocka_unit_test(it_can_be_given_up_at_any_time),
        cmocka_unit_test(copies_keep_within_the_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
