/* The progress that long work reports must never decrease, and must have enough steps to be
 * visible; cancelled work must leave nothing behind. */
#include "tests/unit/fixture.h"

#include "algo/shape.h"
#include "edit/local/erase.h"
#include "edit/local/vertex.h"
#include "edit/merge/weld.h"
#include "edit/plane/plane_cut.h"
#include "edit/plane/plane_split.h"
#include "edit/region/inset.h"
#include "edit/whole/delaunay.h"
#include "edit/whole/separate.h"
#include "edit/whole/transform.h"
#include "edit/whole/triangulate.h"
#include "format/io/format.h"
#include "geometry/geometry.h"
#include "mesh/compact.h"
#include "mesh/write.h"
#include "query/curvature.h"
#include "query/topology.h"

/* --- a hook that counts allocated blocks --- */

static size_t blocks;

static void *count_blocks(void *context, void *memory, size_t size)
{
    (void)context;
    if (size == 0) {
        blocks -= memory != NULL;
        free(memory);
        return NULL;
    }
    void *resized = realloc(memory, size);
    blocks += memory == NULL && resized != NULL;
    return resized;
}

static const he_mem_hook counting = {count_blocks, NULL};

/* --- a listener that receives progress and can cancel --- */

typedef struct listener {
    long told, give_up_at; /* number of the progress report at which the listener cancels the work;
                              0: it never cancels */
    size_t distinct;
    double last;
    bool fell;
} listener;

static bool hear(void *context, const char *phase, double done)
{
    listener *l = context;
    assert_non_null(phase);
    l->told++;
    l->fell |= done < l->last || done > 1;
    l->distinct += done > l->last;
    l->last = done;
    return l->told != l->give_up_at;
}

/* number of cells along each side of a grid, large enough for each phase of work to report progress
 * more than once */
enum { SIDE = 130 };

static he_status make(he_progress *progress, he_mesh **out)
{
    double args[HE_SHAPE_PARAMS];
    const he_shape *grid = he_shape_find("grid", 4);
    he_limits limits = {.progress = progress};
    he_soup soup;
    he_mesh *mesh;
    he_topology topology;
    he_measures measures;
    he_shape_defaults(grid, args);
    args[0] = args[1] = SIDE;
    he_progress_span(progress, 0.2);
    he_status status = he_shape_make(grid, args, &limits, &soup, NULL);
    if (status != HE_OK) {
        return status;
    }
    he_progress_span(progress, 0.7);
    status = he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL);
    he_soup_clear(&soup);
    if (status != HE_OK) {
        return status;
    }
    he_mesh_set_progress(mesh, progress);
    he_progress_span(progress, 1);
    status = he_topology_find(mesh, &topology, NULL);
    if (status == HE_OK) {
        he_topology_clear(&topology);
        status = he_mesh_measure(mesh, &measures, NULL);
    }
    he_mesh_set_progress(mesh, NULL);
    if (status != HE_OK) {
        he_mesh_free(mesh);
        return status;
    }
    *out = mesh;
    return HE_OK;
}

static void a_second_of_work_has_twenty_steps_and_none_falls(void **state)
{
    (void)state;
    he_mesh *mesh = NULL;
    he_progress progress;
    listener l = {0};
    he_progress_init(&progress, hear, &l);
    assert_int_equal(make(&progress, &mesh), HE_OK);
    he_mesh_free(mesh);
    assert_false(l.fell);
    assert_true(l.distinct >= 20);
    assert_true(l.last > 0.95);
    print_message("note: %zu steps for %d quads\n", l.distinct, SIDE * SIDE);
}

static void making_is_given_up_anywhere_and_leaves_nothing(void **state)
{
    (void)state;
    he_mem_set_hook(&counting);
    blocks = 0;
    he_status status = HE_CANCELLED;
    for (long n = 1; status != HE_OK; n += n < 40 ? 1 : 37) {
        he_mesh *mesh = NULL;
        he_progress progress;
        listener l = {.give_up_at = n};
        he_progress_init(&progress, hear, &l);
        status = make(&progress, &mesh);
        if (status != HE_OK) {
            assert_int_equal(status, HE_CANCELLED);
            assert_null(mesh);
            assert_int_equal(l.told, n);
            assert_int_equal(blocks, 0);
        }
        he_mesh_free(mesh);
    }
    assert_int_equal(blocks, 0);
    he_mem_set_hook(NULL);
}

/* --- file formats that are parsed only after the last byte has arrived --- */

typedef struct file {
    const char *format;
    char *bytes;
    size_t length;
} file;

/* Makes a GLB file of a grid of quads with a face attribute, which glTF stores in `extras`. */
static file grid_glb(void)
{
    he_mesh *mesh = NULL;
    he_column *column;
    he_writer *writer;
    file f = {.format = "glb", .bytes = malloc((size_t)1 << 24)};
    assert_non_null(f.bytes);
    assert_int_equal(make(NULL, &mesh), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"part", HE_FACE, HE_UINT32, 1, HE_COPY}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, SIDE * SIDE, NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(mesh, column, NULL), HE_OK);
    assert_int_equal(he_writer_new(he_format_find("glb"), mesh, 0, NULL, &writer, NULL), HE_OK);
    f.length = he_writer_read(writer, f.bytes, (size_t)1 << 24);
    assert_true(f.length < (size_t)1 << 24);
    he_writer_free(writer);
    he_mesh_free(mesh);
    return f;
}

/* Makes a glTF file of triangles whose corners all lie at the origin, with the data in base64. */
static file zeros_gltf(void)
{
    enum { VERTICES = 30000, TEXT = VERTICES * 16 };
    file f = {.format = "gltf", .bytes = malloc(TEXT + 1000)};
    assert_non_null(f.bytes);
    f.length = (size_t)snprintf(
        f.bytes, 1000,
        "{\"asset\":{\"version\":\"2.0\"},\"bufferViews\":[{\"buffer\":0,\"byteLength\":%d}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%d,"
        "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"NORMAL\":0}}]}],\"buffers\":[{\"byteLength\":%d,\"uri\":\"data:;base64,",
        VERTICES * 12, VERTICES, VERTICES * 12);
    memset(f.bytes + f.length, 'A', TEXT);
    f.length += TEXT;
    memcpy(f.bytes + f.length, "\"}]}", 4);
    f.length += 4;
    return f;
}

static he_status read_file(const file *f, he_progress *progress)
{
    he_reader *reader;
    he_import import;
    assert_int_equal(he_reader_new(he_format_find(f->format), NULL, &reader, NULL), HE_OK);
    assert_true(he_reader_reads_at_end(reader));
    assert_int_equal(he_reader_feed(reader, f->bytes, f->length, NULL), HE_OK);
    he_reader_set_progress(reader, progress);
    he_status status = he_reader_finish(reader, &import, NULL);
    if (status == HE_OK) {
        assert_true(import.soup.face_count >= 10000);
        he_import_clear(&import);
    }
    he_reader_free(reader);
    return status;
}

static void a_file_that_is_read_at_its_end_is_given_up_anywhere(void **state)
{
    (void)state;
    file files[] = {grid_glb(), zeros_gltf()};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        he_status status = HE_CANCELLED;
        he_mem_set_hook(&counting);
        blocks = 0;
        listener l = {0};
        for (long n = 1; status != HE_OK; n += n < 10 ? 1 : 13) {
            he_progress progress;
            l = (listener){.give_up_at = n};
            he_progress_init(&progress, hear, &l);
            status = read_file(&files[i], &progress);
            assert_true(status == HE_OK || status == HE_CANCELLED);
            assert_true(status == HE_OK || l.told == n);
            assert_int_equal(blocks, 0);
            assert_false(l.fell);
        }
        print_message("note: %s of %zu bytes: told %ld times\n", files[i].format, files[i].length,
                      l.told);
        assert_true(l.told > 20 && l.distinct > 20);
        he_mem_set_hook(NULL);
        free(files[i].bytes);
    }
}

/* --- computations for requests that only read: files and queries --- */

typedef struct finding {
    const char *name;
    he_status (*find)(const he_mesh *m, he_progress *progress);
} finding;

static he_status write_file(const he_mesh *m, const char *format, he_progress *progress)
{
    he_writer *writer = NULL;
    he_status status = he_writer_new(he_format_find(format), m, 0, progress, &writer, NULL);
    assert_true((status == HE_OK) == (writer != NULL));
    he_writer_free(writer);
    return status;
}

#define WRITE(format)                                                        \
    static he_status write_##format(const he_mesh *m, he_progress *progress) \
    {                                                                        \
        return write_file(m, #format, progress);                             \
    }
WRITE(obj)
WRITE(ply)
WRITE(stl)
WRITE(glb)
#undef WRITE

static he_status find_curvatures(const he_mesh *m, he_progress *progress)
{
    he_curvature *all = he_mem_array(NULL, he_mesh_vertices(m), sizeof *all);
    assert_non_null(all);
    he_status status = he_curvatures(m, NULL, 0, UINT64_MAX, progress, all, NULL);
    he_mem_free(all);
    return status;
}

static he_status find_cotangents(const he_mesh *m, he_progress *progress)
{
    double *all = he_mem_array(NULL, he_mesh_edges(m), sizeof *all);
    assert_non_null(all);
    he_status status = he_edge_cotangents(m, NULL, 0, UINT64_MAX, progress, all, NULL);
    he_mem_free(all);
    return status;
}

static he_status find_vertex_normals(const he_mesh *m, he_progress *progress)
{
    he_vec3 *all = he_mem_array(NULL, he_mesh_issued(m, HE_VERTEX), sizeof *all);
    assert_non_null(all);
    he_status status = he_vertex_normals(m, HE_WEIGHT_ANGLE, progress, all, NULL);
    he_mem_free(all);
    return status;
}

/* The mesh consists of quads whose corners have different texture coordinates. Everything that a
 * request may compute from the mesh must be cancellable at each report of progress. */
static void what_costs_the_mesh_before_an_answer_is_given_up_anywhere(void **state)
{
    (void)state;
    static const finding findings[] = {{"obj", write_obj},
                                       {"ply", write_ply},
                                       {"stl", write_stl},
                                       {"glb", write_glb},
                                       {"curvatures", find_curvatures},
                                       {"cotangents", find_cotangents},
                                       {"vertex normals", find_vertex_normals}};
    he_mesh *mesh = NULL;
    he_column *uv;
    he_mem_set_hook(&counting);
    assert_int_equal(make(NULL, &mesh), HE_OK);
    assert_int_equal(
        he_column_new(&(he_column_schema){"uv", HE_HALFEDGE, HE_FLOAT, 2, HE_INTERPOLATE}, &uv,
                      NULL),
        HE_OK);
    assert_int_equal(he_column_extend(uv, he_mesh_issued(mesh, HE_HALFEDGE), NULL), HE_OK);
    for (uint32_t h = 0; h < uv->rows; h++) {
        const float value[2] = {(float)h, 1};
        memcpy(uv->data + (size_t)h * uv->row_bytes, value, sizeof value);
    }
    assert_int_equal(he_mesh_add_column(mesh, uv, NULL), HE_OK);
    size_t kept = blocks;
    for (size_t i = 0; i < sizeof findings / sizeof *findings; i++) {
        he_status status = HE_CANCELLED;
        long n = 1;
        for (; status != HE_OK; n++) {
            he_progress progress;
            listener l = {.give_up_at = n};
            he_progress_init(&progress, hear, &l);
            status = findings[i].find(mesh, &progress);
            assert_true(status == HE_OK || status == HE_CANCELLED);
            assert_true(status == HE_OK || l.told == n);
            assert_int_equal(blocks, kept);
            assert_false(l.fell);
        }
        print_message("note: %s: told %ld times\n", findings[i].name, n - 2);
        assert_true(n - 2 >= SIDE * SIDE / HE_PROGRESS_STRIDE);
    }
    he_mesh_free(mesh);
    he_mem_set_hook(NULL);
}

/* --- operations on a mesh --- */

static he_status run_transform(he_mesh *m)
{
    static const double matrix[16] = {2, 0, 0, 1, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
    return he_transform(m, matrix, NULL, 0, NULL);
}

static he_status run_plane_split(he_mesh *m)
{
    he_plane_parts parts;
    he_status status =
        he_plane_split(m, &(he_plane){(he_vec3){0.001, 0.002, 0}, (he_vec3){1, 0.7, 0}, NULL}, NULL,
                       0, &parts, NULL);
    if (status == HE_OK) {
        he_plane_parts_clear(&parts);
    }
    return status;
}

static he_status run_delaunay(he_mesh *m)
{
    return he_delaunay(m, NULL, 0, NULL, NULL);
}

static he_status run_triangulate(he_mesh *m)
{
    static uint32_t faces[SIDE * SIDE];
    for (uint32_t f = 0; f < SIDE * SIDE; f++) {
        faces[f] = f;
    }
    return he_face_triangulate(m, faces, SIDE * SIDE, NULL, NULL, NULL, NULL);
}

static he_status run_compact(he_mesh *m)
{
    return he_compact(m, NULL, NULL);
}

static he_status run_weld(he_mesh *m)
{
    return he_weld_near(m, 0.01, HE_MERGE_MEAN, NULL, NULL, NULL);
}

static he_status run_separate_bowties(he_mesh *m)
{
    return he_separate_bowties(m, NULL, NULL);
}

static he_status run_delete_isolated(he_mesh *m)
{
    return he_delete_isolated(m, NULL);
}

static he_status run_copy(he_mesh *m)
{
    he_mesh *copy;
    he_status status = he_mesh_copy_with_progress(m, m->progress, &copy, NULL);
    if (status == HE_OK) {
        assert_true(he_mesh_equal(m, copy));
        he_mesh_free(copy);
    }
    return status;
}

static he_status run_plane_cut(he_mesh *m)
{
    return he_plane_cut(m, &(he_plane){(he_vec3){0.001, 0.002, 0}, (he_vec3){1, 0.7, 0}, NULL},
                        HE_CUT_ABOVE, false, NULL, NULL);
}

static he_status run_face_delete(he_mesh *m)
{
    static uint32_t faces[SIDE * SIDE / 2];
    for (uint32_t i = 0; i < SIDE * SIDE / 2; i++) {
        faces[i] = 2 * i;
    }
    return he_face_delete(m, faces, SIDE * SIDE / 2, HE_DROP_ISOLATED, NULL);
}

static he_status run_edge_delete(he_mesh *m)
{
    static uint32_t edges[SIDE * SIDE];
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        edges[i] = i;
    }
    return he_edge_delete(m, edges, SIDE * SIDE, HE_KEEP_ISOLATED, NULL);
}

static he_status run_face_inset(he_mesh *m)
{
    static uint32_t faces[SIDE * SIDE / 5];
    for (uint32_t i = 0; i < SIDE * SIDE / 5; i++) {
        faces[i] = 5 * i;
    }
    return he_face_inset(m, faces, SIDE * SIDE / 5, false, (he_inset_width){0.5, 0}, NULL, NULL);
}

static he_status run_vertex_move(he_mesh *m)
{
    static uint32_t vertices[SIDE * SIDE];
    const he_vec3 by = {0, 0, 1};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        vertices[i] = i;
    }
    return he_vertex_move(m, vertices, SIDE * SIDE, HE_MOVE_BY, &by, 1, NULL);
}

static he_status (*const operations[])(he_mesh *m) = {
    run_transform,   run_plane_split, run_delaunay,         run_triangulate,     run_compact,
    run_copy,        run_weld,        run_separate_bowties, run_delete_isolated, run_plane_cut,
    run_face_delete, run_edge_delete, run_vertex_move,      run_face_inset};

static he_status run_recorded(he_status (*operation)(he_mesh *m), he_mesh *mesh, listener *l)
{
    he_progress progress;
    he_delta *delta = he_delta_new();
    he_changes changes;
    he_progress_init(&progress, hear, l);
    he_mesh_set_progress(mesh, &progress);
    he_mesh_record(mesh, delta);
    he_savepoint mark = he_delta_mark(mesh);
    he_progress_span(&progress, 0.8);
    he_status status = operation(mesh);
    if (status == HE_OK) {
        he_progress_span(&progress, 1);
        status = he_changes_find(mesh, delta, 0, delta->count, false, &changes, NULL);
    }
    if (status == HE_OK) {
        he_changes_clear(&changes);
    } else {
        he_delta_rollback(mesh, mark);
    }
    he_mesh_record(mesh, NULL);
    he_mesh_set_progress(mesh, NULL);
    he_delta_free(delta);
    return status;
}

static void an_operation_is_given_up_and_the_mesh_is_as_it_was(void **state)
{
    (void)state;
    he_mesh *mesh, *copy;
    assert_int_equal(make(NULL, &mesh), HE_OK);
    for (size_t i = 0; i < sizeof operations / sizeof *operations; i++) {
        he_mem_set_hook(&counting);
        he_status status = HE_CANCELLED;
        blocks = 0;
        assert_int_equal(he_mesh_copy(mesh, &copy, NULL), HE_OK);
        size_t before = blocks;
        /* Cancelled work must leave the mesh unchanged, so each further attempt runs on the same
         * mesh. */
        for (long n = 1; status != HE_OK; n += n < 20 ? 1 : 47) {
            listener l = {.give_up_at = n};
            status = run_recorded(operations[i], copy, &l);
            assert_false(l.fell);
            if (status != HE_OK) {
                assert_int_equal(status, HE_CANCELLED);
                assert_int_equal(blocks, before);
                assert_true(he_mesh_equal(mesh, copy));
            }
        }
        he_mesh_free(copy);
        he_mem_set_hook(NULL);
    }
    he_mesh_free(mesh);
}

static void a_cancelled_edit_of_an_expendable_mesh_is_left_half_done(void **state)
{
    (void)state;
    he_mesh *mesh;
    size_t left = 0;
    he_status status = HE_CANCELLED;
    assert_int_equal(make(NULL, &mesh), HE_OK);
    he_mem_set_hook(&counting);
    blocks = 0;
    for (long n = 1; status == HE_CANCELLED; n++) {
        he_mesh *copy;
        he_progress progress;
        listener l = {.give_up_at = n};
        he_delta *delta = he_delta_new();
        assert_int_equal(he_mesh_copy(mesh, &copy, NULL), HE_OK);
        he_mesh_expend(copy);
        he_progress_init(&progress, hear, &l);
        he_mesh_set_progress(copy, &progress);
        he_mesh_record(copy, delta);
        status = run_triangulate(copy);
        left += status == HE_CANCELLED ? delta->count : 0;
        he_mesh_record(copy, NULL);
        he_mesh_free(copy);
        he_delta_free(delta);
        assert_int_equal(blocks, 0);
    }
    assert_int_equal(status, HE_OK);
    assert_true(left > 0);
    he_mem_set_hook(NULL);
    he_mesh_free(mesh);
}

enum { WORDS = 5000, WRITES = 400000 };

/* Writes values to scattered entries of `words`, and returns a delta that has a record of each
 * write. */
static he_delta *write_words(uint32_t *words)
{
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    assert_int_equal(he_delta_reserve(delta, WRITES, 0, NULL), HE_OK);
    for (uint32_t i = 0; i < WRITES; i++) {
        uint32_t row = i * 2654435761U % WORDS;
        delta->records[delta->count++] =
            (he_record){.column = HE_COL_NEXT, .row = row, .before = words[row], .after = i};
        words[row] = i;
    }
    return delta;
}

static void a_fold_that_is_given_up_leads_to_the_states_it_led_to(void **state)
{
    (void)state;
    static uint32_t words[WORDS];
    he_status status = HE_CANCELLED;
    long n = 1;
    for (; status == HE_CANCELLED; n++) {
        he_progress progress;
        listener l = {.give_up_at = n};
        memset(words, 255, sizeof words);
        he_delta *delta = write_words(words);
        he_progress_init(&progress, hear, &l);
        status = he_delta_fold(delta, 0, &progress, NULL);
        assert_true(status == HE_OK ? delta->count == WORDS : status == HE_CANCELLED);
        for (size_t i = delta->count; i-- > 0;) {
            const he_record *r = &delta->records[i];
            assert_int_equal(words[r->row], r->after);
            words[r->row] = r->before;
        }
        for (size_t row = 0; row < WORDS; row++) {
            assert_int_equal(words[row], UINT32_MAX);
        }
        he_delta_free(delta);
    }
    assert_int_equal(status, HE_OK);
    assert_true(n > 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_second_of_work_has_twenty_steps_and_none_falls),
        cmocka_unit_test(making_is_given_up_anywhere_and_leaves_nothing),
        cmocka_unit_test(a_file_that_is_read_at_its_end_is_given_up_anywhere),
        cmocka_unit_test(what_costs_the_mesh_before_an_answer_is_given_up_anywhere),
        cmocka_unit_test(an_operation_is_given_up_and_the_mesh_is_as_it_was),
        cmocka_unit_test(a_cancelled_edit_of_an_expendable_mesh_is_left_half_done),
        cmocka_unit_test(a_fold_that_is_given_up_leads_to_the_states_it_led_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
