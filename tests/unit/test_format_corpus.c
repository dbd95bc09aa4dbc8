/* Every file of the shared corpus of mesh files must be read as the corpus's manifest says. The
 * corpus is looked up beside the project, or in the directory given by the environment variable
 * CORPUS. */
#include "unit/format_fixture.h"

#include "format/io/export.h"
#include "build/soup_check.h"
#include "query/defects.h"

static const char *corpus;

/* Copies the field number k, counted from 0, of a line of tab-separated text. */
static void cell(const char *line, size_t k, char *text, size_t size)
{
    for (; k > 0; k--) {
        line = strchr(line, '\t');
        if (line == NULL) {
            text[0] = '\0';
            return;
        }
        line++;
    }
    size_t length = strcspn(line, "\t\n");
    length = length < size ? length : size - 1;
    memcpy(text, line, length);
    text[length] = '\0';
}

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    size_t capacity = 1 << 16;
    char *text = malloc(capacity + 1);
    assert_non_null(text);
    *length = 0;
    size_t n;
    while ((n = fread(text + *length, 1, capacity - *length, file)) > 0) {
        *length += n;
        if (*length == capacity) {
            capacity *= 2;
            text = realloc(text, capacity + 1);
            assert_non_null(text);
        }
    }
    fclose(file);
    text[*length] = '\0';
    return text;
}

enum {
    NAME = 0,
    FORMAT = 8,
    ACTION = 10,
    VERTICES = 12,
    FACES,
    EDGES,
    ISOLATED = 28,
    NO_AREA = 30,
    PLACES = 36,
    FLAGS = 44
};

static void expect_cell(const char *line, size_t k, uint64_t found, const char *what)
{
    char name[200], text[20];
    cell(line, NAME, name, sizeof name);
    cell(line, k, text, sizeof text);
    if (text[0] != '\0' && strtoull(text, NULL, 10) != found) {
        fail_msg("%s: %llu %s, not %s", name, (unsigned long long)found, what, text);
    }
}

/* Compares the defects that hedge finds in a file with the counts that other programs found. */
static void check_defects(const char *line, const he_mesh *mesh)
{
    static he_defects found;
    he_thresholds t = he_thresholds_of(mesh);
    char flags[300];
    t.merge = 0;
    assert_int_equal(he_defects_find(mesh, &t, NULL, &found, NULL), HE_OK);
    expect_cell(line, ISOLATED, found.of[HE_DEFECT_ISOLATED].total, "isolated vertices");
    expect_cell(line, NO_AREA, found.of[HE_DEFECT_DEGENERATE].total, "faces without area");
    expect_cell(line, PLACES, he_mesh_vertices(mesh) - found.of[HE_DEFECT_DUPLICATE].total,
                "places");
    cell(line, FLAGS, flags, sizeof flags);
    bool inside_out = strstr(flags, "inside-out") != NULL;
    assert_int_equal(inside_out, found.of[HE_DEFECT_INSIDE_OUT].total > 0);
}

/* Requires equal faces. Each face may begin with any of its corners, because the compression of
 * indices does not preserve the first corner of a triangle. */
static void expect_turned_faces(const he_soup *found, const he_soup *wanted)
{
    assert_int_equal(found->face_count, wanted->face_count);
    for (size_t f = 0; f < wanted->face_count; f++) {
        uint32_t begin = wanted->starts[f], n = he_soup_end(wanted, f) - begin, turn = 0;
        const uint32_t *a = wanted->corners + begin, *b = found->corners + found->starts[f];
        assert_int_equal(he_soup_end(found, f) - found->starts[f], n);
        while (turn < n && b[turn] != a[0]) {
            turn++;
        }
        for (uint32_t i = 0; i < n; i++) {
            assert_int_equal(b[(turn + i) % n], a[i]);
        }
    }
}

/* Exports the mesh and reads the file back: the result must have equal polygons or, if the format
 * is STL, the number of triangles into which the polygons are cut. */
static void check_export(const he_format *format, const char *encoding, const he_mesh *mesh,
                         const he_soup *wanted)
{
    size_t length;
    char *bytes = write_encoded(format->name, encoding, mesh, 4096, NULL, &length);
    he_import again = {0};
    he_error err = {0};
    if (read_pieces(&(format_file){format->name, bytes, length}, 1000, NULL, &again, &err) !=
        HE_OK) {
        fail_msg("%s %s: %s", format->name, encoding, err.text);
    }
    const he_soup *s = &again.soup;
    if (strcmp(format->name, "stl") == 0) {
        assert_int_equal(s->face_count, wanted->corner_count - 2 * wanted->face_count);
    } else {
        assert_int_equal(s->vertex_count, wanted->vertex_count);
        for (size_t i = 0; i < wanted->vertex_count; i++) {
            he_vec3 p = wanted->positions[i];
            if (strcmp(format->name, "glb") == 0) {
                p = (he_vec3){he_narrow(p.x), he_narrow(p.y), he_narrow(p.z)};
            }
            assert_memory_equal(&s->positions[i], &p, sizeof p);
        }
        assert_int_equal(s->corner_count, wanted->corner_count);
        if (strcmp(encoding, "meshopt") == 0) {
            expect_turned_faces(s, wanted);
        } else {
            assert_memory_equal(s->corners, wanted->corners,
                                wanted->corner_count * sizeof(uint32_t));
        }
    }
    he_import_clear(&again);
    free(bytes);
}

static void check_file(const char *line, const char *format)
{
    char name[200] = "", path[600], action[40] = "", v[20] = "", f[20] = "", e[20] = "";
    cell(line, NAME, name, sizeof name);
    cell(line, ACTION, action, sizeof action);
    cell(line, VERTICES, v, sizeof v);
    cell(line, FACES, f, sizeof f);
    cell(line, EDGES, e, sizeof e);
    snprintf(path, sizeof path, "%s/files/%s", corpus, name);
    size_t length = 0;
    char *bytes = read_file(path, &length);
    if (bytes == NULL) {
        fail_msg("%s is missing", path);
        return;
    }
    he_import import = {0};
    he_error err = {0};
    he_status status = length < 100000 ? read_bytes(format, bytes, length, &import, &err)
                                       : read_pieces(&(format_file){format, bytes, length}, 0, NULL,
                                                     &import, &err);
    if (strcmp(action, "reject_422") == 0) {
        assert_int_not_equal(status, HE_OK);
        assert_int_not_equal(err.place, HE_PLACE_NONE);
        print_message("%s: %s\n", name, err.text);
        free(bytes);
        return;
    }
    if (status != HE_OK) {
        fail_msg("%s: %s", name, err.text);
    }
    if (he_format_sniff(bytes, length) != he_format_find(format)) {
        print_message("%s: not recognised by its first bytes\n", name);
    }
    expect_counts(&import, strtoul(v, NULL, 10), strtoul(f, NULL, 10), import.soup.corner_count);
    he_mesh *mesh = NULL;
    status = he_build(&import.soup, 0, &mesh, NULL, &err);
    if (strcmp(action, "accept") == 0) {
        if (status != HE_OK) {
            fail_msg("%s: %s", name, err.text);
        }
        fixture_check(mesh);
        check_defects(line, mesh);
        assert_int_equal(he_mesh_edges(mesh), strtoul(e, NULL, 10));
        const he_format *row;
        for (size_t i = 0; (row = he_format_at(i)) != NULL; i++) {
            bool both = row->writing != NULL && row->reading != NULL;
            for (size_t k = 0; both && row->encodings[k] != NULL; k++) {
                check_export(row, row->encodings[k], mesh, &import.soup);
            }
        }
    } else if (status != HE_OK) {
        he_import_locate(&import, &err);
        assert_int_not_equal(err.place, HE_PLACE_NONE);
        print_message("%s: %s %llu: %s\n", name, err.place == HE_PLACE_LINE ? "line" : "byte",
                      (unsigned long long)err.at, err.text);
    }
    he_mesh_free(mesh);
    he_import_clear(&import);
    free(bytes);
}

static void files_give_what_the_manifest_says(void **state)
{
    (void)state;
    char path[600];
    size_t length;
    snprintf(path, sizeof path, "%s/manifest.tsv", corpus);
    char *manifest = read_file(path, &length);
    if (manifest == NULL) {
        skip();
    }
    unsigned checked = 0;
    for (char *line = manifest; line != NULL; line = strchr(line, '\n')) {
        line += *line == '\n';
        char format[20] = "";
        cell(line, FORMAT, format, sizeof format);
        if (he_format_find(format) != NULL) {
            check_file(line, format);
            checked++;
        }
    }
    print_message("%u files\n", checked);
    assert_true(checked > 0);
    free(manifest);
}

int main(void)
{
    corpus = getenv("CORPUS");
    corpus = corpus != NULL ? corpus : "../shared/corpus";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_give_what_the_manifest_says),
    };
    return cmocka_run_group_tests_name("format_corpus", tests, NULL, NULL);
}
