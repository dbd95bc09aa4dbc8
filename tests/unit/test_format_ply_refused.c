/* PLY files that must be refused: the place in the file that the error names, the words of the
 * error, and how much memory the reader allocates before the error. */
#include "unit/ply_file.h"

#include <math.h>

static void wrong_text_names_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        he_status status;
        uint64_t line;
        const char *words;
    } rows[] = {
        {"", HE_SYNTAX, 1, "empty"},
        {"\n\n", HE_SYNTAX, 2, "empty"},
        {"plyx\n", HE_SYNTAX, 1, "'plyx' cannot begin a PLY file"},
        {"OFF\n3 1 3\n", HE_SYNTAX, 1, "'OFF' cannot begin"},
        {"ply ascii\n", HE_SYNTAX, 1, "an extra word"},
        {"ply\n", HE_SYNTAX, 1, "inside its header"},
        {ASCII "element vertex 3\n" XYZ, HE_SYNTAX, 6, "inside its header"},
        {ASCII "element vertex 1\n" XYZ "0 0 0\n", HE_SYNTAX, 7, "'0' cannot begin a line"},
        {ASCII "element vertex 1\n" XYZ "end_header 0 0 0\n", HE_SYNTAX, 7, "'0' is an extra word"},
        {"ply\nformat ascii 1.0 now\n", HE_SYNTAX, 2, "'now' is an extra word"},
        {"ply\nformat ascii 1.1\n", HE_UNSUPPORTED, 2, "'1.1' is not version"},
        {"ply\nformat\n", HE_SYNTAX, 2, "'' is not an encoding"},
        {"ply\nformat binary_middle_endian 1.0\n", HE_SYNTAX, 2, "is not an encoding"},
        {ASCII "format ascii 1.0\n", HE_SYNTAX, 3, "given twice"},
        {"ply\nelement vertex 0\nend_header\n", HE_SYNTAX, 3, "gives no format"},
        {ASCII "element\n", HE_SYNTAX, 3, "'' is not a count"},
        {ASCII "element vertex\n", HE_SYNTAX, 3, "'' is not a count"},
        {ASCII "element vertex many\n", HE_SYNTAX, 3, "'many' is not a count"},
        {ASCII "element vertex -1\n", HE_SYNTAX, 3, "'-1' is not a count"},
        {ASCII "element vertex 1.5\n", HE_SYNTAX, 3, "'1.5' is not a count"},
        {ASCII "element vertex 4294967295\n", HE_BAD_VALUE, 3, "'4294967295' is a number of rows"},
        {ASCII "element vertex 2147483647\n", HE_BAD_VALUE, 3, "larger than a mesh can have"},
        {ASCII "element face 18446744073709551616\n", HE_BAD_VALUE, 3,
         "larger than a mesh can have"},
        {ASCII "element x 281474976710657\n", HE_BAD_VALUE, 3, "larger than a mesh can have"},
        {ASCII "element vertex 1 2\n", HE_SYNTAX, 3, "an extra word"},
        {ASCII "element vertex 1\nelement vertex 1\n", HE_SYNTAX, 4, "the name of two elements"},
        {ASCII "property float x\n", HE_SYNTAX, 3, "before the first element"},
        {ASCII "element vertex 1\nproperty half x\n", HE_SYNTAX, 4, "'half' is not a type"},
        {ASCII "element vertex 1\nproperty\n", HE_SYNTAX, 4, "'' is not a type"},
        {ASCII "element vertex 1\nproperty float\n", HE_SYNTAX, 4, "a property has no name"},
        {ASCII "element vertex 1\nproperty float x y\n", HE_SYNTAX, 4, "an extra word"},
        {ASCII "element vertex 1\nproperty float x\nproperty int x\n", HE_SYNTAX, 5,
         "'x' is the name of two properties"},
        {ASCII "element face 1\nproperty list float int vertex_indices\n", HE_SYNTAX, 4,
         "'float' is not an integer type"},
        {ASCII "element face 1\nproperty list uchar list vertex_indices\n", HE_SYNTAX, 4,
         "'list' is not a type"},
        {ASCII "element a 4000000000\nend_header\n", HE_SYNTAX, 3,
         "'a' has 4000000000 rows and no properties"},
        {ASCII "element vertex 2\nend_header\n", HE_SYNTAX, 3, "no properties"},
        {ASCII "element face 2\nend_header\n", HE_SYNTAX, 3, "no properties"},
        {ASCII "element vertex 1\nproperty int x\nproperty int z\nend_header\n1 2\n", HE_SYNTAX, 3,
         "no property 'y'"},
        {ASCII "element vertex 1\nproperty int x\nproperty list int int y\nproperty int z\n"
               "end_header\n",
         HE_SYNTAX, 3, "no property 'y'"},
        {ASCII "element face 1\nproperty int n\nend_header\n1\n", HE_SYNTAX, 3,
         "no list 'vertex_indices'"},
        {ASCII "element face 1\nproperty int vertex_indices\nend_header\n", HE_SYNTAX, 4,
         "'vertex_indices' is not a list"},
        {ASCII "element tristrips 1\nproperty list uchar float x\nend_header\n", HE_SYNTAX, 3,
         "'tristrips' has no list"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_refused("ply", rows[i].text, rows[i].status, rows[i].line, rows[i].words);
    }
    static const char wide[] = "\xFF\xFEp\0l\0y\0\n\0";
    expect_bytes_refused(&(format_file){"ply", wide, sizeof wide - 1}, HE_UNSUPPORTED, 1, "UTF-16");
}

#define ROWS \
    ASCII "element vertex 3\n" XYZ "property short q\nelement face 2\n" CORNER "end_header\n"
#define POINTS "0 0 0 1\n1 0 0 1\n0 1 0 1\n"
#define FRACTIONS                                     \
    ASCII "element vertex 1\n" XYZ "element face 1\n" \
          "property list uchar float vertex_index\nend_header\n0 0 0\n"

static void wrong_rows_name_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        he_status status;
        uint64_t line;
        const char *words;
    } rows[] = {
        {ROWS, HE_SYNTAX, 10, "after 0 of the 3 rows of element 'vertex'"},
        {ROWS "0 0 0 1\n0 1 0 2\n", HE_SYNTAX, 12, "after 2 of the 3 rows of element 'vertex'"},
        {ROWS "0 0 0\n", HE_SYNTAX, 11, "'vertex' ends before its last value"},
        {ROWS "0 0 a 1\n", HE_SYNTAX, 11, "'a' is not a number"},
        {ROWS "0 nan 0 1\n", HE_NOT_FINITE, 11, "'nan' is not finite"},
        {ROWS "0 0 1e999 1\n", HE_NOT_FINITE, 11, "is not finite"},
        {ROWS "0 0 0 b\n", HE_SYNTAX, 11, "'b' is not a number"},
        {ROWS "0 0 0 1.5\n", HE_BAD_VALUE, 11, "'q' does not fit its type short"},
        {ROWS "0 0 0 3000000000\n", HE_BAD_VALUE, 11, "'q' does not fit its type short"},
        {ROWS "0 0 0 nan\n", HE_BAD_VALUE, 11, "'q' does not fit its type short"},
        {ROWS POINTS, HE_SYNTAX, 13, "after 0 of the 2 rows of element 'face'"},
        {ROWS POINTS "3 0 1 2\n", HE_SYNTAX, 14, "after 1 of the 2 rows of element 'face'"},
        {ROWS POINTS "-1 0 1 2\n", HE_BAD_VALUE, 14, "a list cannot have -1 values"},
        {ROWS POINTS "4294967295 0 1 2\n", HE_BAD_VALUE, 14, "4294967295 corners, more than"},
        {ROWS POINTS "18446744073709551617 0 1\n", HE_BAD_VALUE, 14, "a list cannot have"},
        {ROWS POINTS "-99999999999999999999 0\n", HE_BAD_VALUE, 14, "a list cannot have -"},
        {ROWS POINTS "3.0 0 1 2\n", HE_SYNTAX, 14, "'3.0' is not a whole number"},
        {ROWS POINTS "x 0 1 2\n", HE_SYNTAX, 14, "'x' is not a whole number"},
        {ROWS POINTS "4 0 1 2\n", HE_SYNTAX, 14, "'face' ends before its last value"},
        {ROWS "0 0 0 1\n# the end", HE_SYNTAX, 12, "after 1 of the 3 rows of element 'vertex'"},
        {ROWS POINTS "3 0 1 -1\n", HE_BAD_INDEX, 14, "no vertex -1; the vertices are 0 to 2"},
        {ROWS POINTS "3 0 1 3\n", HE_BAD_INDEX, 14, "no vertex 3"},
        {ROWS POINTS "3 0 1 4294967297\n", HE_BAD_INDEX, 14, "no vertex 4294967297"},
        {ROWS POINTS "3 0 1 18446744073709551617\n", HE_BAD_INDEX, 14, "no vertex"},
        {ROWS POINTS "3 0 1 1.0\n", HE_SYNTAX, 14, "'1.0' is not a valid corner"},
        {ROWS POINTS "3 0 1 2\n3 0 1\n", HE_SYNTAX, 15, "ends before its last value"},
        {FRACTIONS "3 0 0 0.5\n", HE_BAD_INDEX, 11, "the float 0.5 is not a vertex index"},
        {FRACTIONS "3 0 0 1.0\n", HE_BAD_INDEX, 11,
         "there is no vertex 1; the vertices are 0 to 0"},
        {FRACTIONS "3 0 0 -1e0\n", HE_BAD_INDEX, 11, "there is no vertex -1"},
        {FRACTIONS "3 0 0 nan\n", HE_BAD_INDEX, 11, "is not a vertex index"},
        {FRACTIONS "3 0 0 1e999\n", HE_BAD_INDEX, 11, "is not a vertex index"},
        {FRACTIONS "3 0 0 16777218\n", HE_BAD_INDEX, 11,
         "the float 16777218 is not a vertex index"},
        {FRACTIONS "3 0 0 x\n", HE_SYNTAX, 11, "'x' is not a number"},
        {ASCII "element face 1\n" CORNER "end_header\n3 0 1 2\n", HE_BAD_INDEX, 6,
         "no vertex 0: the file has none"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_refused("ply", rows[i].text, rows[i].status, rows[i].line, rows[i].words);
    }
}

static void wrong_bytes_name_their_place(void **state)
{
    (void)state;
    static const struct {
        /* for each face the number of corners, then its corners; -9 ends the list */
        double faces[10];
        he_status status;
        size_t at;
        const char *words;
    } rows[] = {
        {{3, 0, 1, 2, -9}, HE_SYNTAX, 13, "after 1 of the 2 rows of element 'face'"},
        {{3, 0, 1, 2, 3, 0, 1, -9}, HE_SYNTAX, 22, "after 1 of the 2 rows"},
        {{-1, -9}, HE_BAD_VALUE, 0, "a list cannot have -1 values"},
        {{3, 0, 1, 3, -9}, HE_BAD_INDEX, 9, "no vertex 3; the vertices are 0 to 2"},
        {{3, 0, -1, 2, -9}, HE_BAD_INDEX, 5, "no vertex -1"},
        {{3, 0, 1, 2, 127, 0, -9}, HE_SYNTAX, 18, "after 1 of the 2 rows"},
    };
    for (ply_encoding e = LEAST_FIRST; e <= MOST_FIRST; e++) {
        ply_file f;
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            ply_begin(&f, e,
                      "element vertex 3\n" XYZ "element face 2\n"
                      "property list char int vertex_indices\nend_header\n");
            for (size_t k = 0; k < 9; k++) {
                ply_put_value(&f, FLOAT, ply_square[k / 3][k % 3]);
            }
            size_t body = f.length, left = 0;
            for (size_t k = 0; rows[i].faces[k] != -9; k++) {
                bool count = left == 0;
                ply_put_value(&f, count ? 0 : INT, rows[i].faces[k]);
                left = count ? (size_t)fabs(rows[i].faces[k]) : left - 1;
            }
            expect_refused_at_byte(&(format_file){"ply", f.bytes, f.length}, rows[i].status,
                                   body + rows[i].at, rows[i].words);
        }
        ply_begin(&f, e, "element vertex 2\n" XYZ "end_header\n");
        size_t body = f.length;
        for (size_t k = 0; k < 6; k++) {
            ply_put_value(&f, FLOAT, k == 4 ? NAN : 0);
        }
        expect_refused_at_byte(&(format_file){"ply", f.bytes, f.length}, HE_NOT_FINITE, body + 12,
                               "vertex 1");
        expect_refused_at_byte(&(format_file){"ply", f.bytes, body + 23}, HE_SYNTAX, body + 23,
                               "after 1 of the 2 rows");
    }
}

static void fractions_of_bytes_name_their_place(void **state)
{
    (void)state;
    static const struct {
        size_t type;
        double corner;
        const char *words;
    } rows[] = {{FLOAT, 1.5, "the float 1.5 is not a vertex index"},
                {DOUBLE, 1e300, "is not a vertex index"},
                {FLOAT, INFINITY, "is not a vertex index"},
                {DOUBLE, NAN, "is not a vertex index"},
                {DOUBLE, 3, "there is no vertex 3; the vertices are 0 to 2"}};
    for (ply_encoding e = LEAST_FIRST; e <= MOST_FIRST; e++) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            ply_file f;
            char header[200];
            snprintf(header, sizeof header,
                     "element vertex 3\n" XYZ "element face 1\n"
                     "property list char %s vertex_indices\nend_header\n",
                     ply_types[rows[i].type].names[0]);
            ply_begin(&f, e, header);
            for (size_t k = 0; k < 9; k++) {
                ply_put_value(&f, FLOAT, ply_square[k / 3][k % 3]);
            }
            ply_put_value(&f, 0, 3);
            ply_put_value(&f, rows[i].type, 0);
            ply_put_value(&f, rows[i].type, 1);
            size_t at = f.length;
            ply_put_value(&f, rows[i].type, rows[i].corner);
            expect_refused_at_byte(&(format_file){"ply", f.bytes, f.length}, HE_BAD_INDEX, at,
                                   rows[i].words);
        }
    }
}

/* Size of the largest block of memory that a reader requests. If the header promises elements that
 * the file does not contain, the file must be refused without allocating memory for them. */
typedef struct largest {
    size_t size;
} largest;

static void *progress(void *context, void *memory, size_t size)
{
    largest *most = context;
    most->size = size > most->size ? size : most->size;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    return realloc(memory, size);
}

static void counts_are_not_believed(void **state)
{
    (void)state;
    static const struct {
        const char *header;
        double body[2];
        he_status status;
        const char *words;
    } rows[] = {
        {"element vertex 4294967295\n" XYZ, {0, 0}, HE_BAD_VALUE, "larger than a mesh can have"},
        {"element vertex 18446744073709551616\n" XYZ,
         {0, 0},
         HE_BAD_VALUE,
         "larger than a mesh can"},
        {"element vertex 357913942\n" XYZ, {0, 0}, HE_SYNTAX, "after 0 of the 357913942 rows"},
        {"element vertex 2147483646\n" XYZ, {0, 0}, HE_SYNTAX, "after 0 of the 2147483646 rows"},
        {"element x 4000000000\nelement vertex 0\n" XYZ, {0, 0}, HE_SYNTAX, "no properties"},
        {"element x 281474976710656\nproperty double a\nproperty double b\n",
         {0, 0},
         HE_SYNTAX,
         "of the 281474976710656 rows"},
        {"element face 1\nproperty list uint int vertex_indices\n",
         {4294967295, 0},
         HE_BAD_VALUE,
         "a face has 4294967295 corners, more than a mesh can have"},
        {"element face 1\nproperty list uint int vertex_indices\n",
         {2147483646, 0},
         HE_BAD_INDEX,
         "there is no vertex"},
        {"element face 1\nproperty list int int vertex_indices\n",
         {-1, 0},
         HE_BAD_VALUE,
         "a list cannot have -1 values"},
        {"element vertex 1\nproperty list uint double many\n" XYZ,
         {4294967295, 0},
         HE_SYNTAX,
         "after 0 of the 1 rows"},
        {"element tristrips 9\nproperty list uint int vertex_index\n",
         {4294967295, -1},
         HE_SYNTAX,
         "after 0 of the 9 rows"},
    };
    largest most = {0};
    const he_mem_hook hook = {progress, &most};
    for (ply_encoding e = TEXT; e <= MOST_FIRST; e++) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            ply_file f;
            ply_begin(&f, e, rows[i].header);
            ply_put_text(&f, "end_header\n");
            ply_put_value(&f, UINT, rows[i].body[0]);
            ply_put_value(&f, INT, rows[i].body[1]);
            ply_end_row(&f);
            he_import import = {0};
            he_error err = {0};
            he_mem_set_hook(&hook);
            he_status status =
                read_pieces(&(format_file){"ply", f.bytes, f.length}, 3, NULL, &import, &err);
            he_mem_set_hook(NULL);
            bool short_text = e == TEXT && strstr(err.text, "ends before its last") != NULL;
            if (!short_text && (status != rows[i].status || !strstr(err.text, rows[i].words))) {
                fail_msg("%s: %s", rows[i].header, err.text);
            }
            assert_int_not_equal(err.place, HE_PLACE_NONE);
            assert_true(most.size < 65536);
        }
    }
}

static void limits_are_kept(void **state)
{
    (void)state;
    static const struct {
        he_limits limits;
        const char *words;
    } rows[] = {
        {{.vertices = 2}, "more than 2 vertices"},
        {{.faces = 1}, "more than 1 faces"},
        {{.corners = 5}, "more than 5 corners"},
        {{.corners = 2}, "a face has 3 corners, more than the limit of 2"},
        {{.bytes = 190}, "more than 190 bytes"},
    };
    static const char text[] = ROWS POINTS "3 0 1 2\n3 0 2 1\n";
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_import import = {0};
        he_error err = {0};
        assert_int_equal(read_pieces(&(format_file){"ply", text, sizeof text - 1}, 1,
                                     &rows[i].limits, &import, &err),
                         HE_LIMIT);
        assert_non_null(strstr(err.text, rows[i].words));
        assert_int_equal(err.place, HE_PLACE_LINE);
    }
    /* The file contains many values of an attribute and hardly any other data: the memory of the
     * attribute must count towards the limit on memory, too. */
    ply_file f;
    ply_begin(
        &f, LEAST_FIRST,
        "element face 60\nproperty list char char vertex_indices\nproperty uchar a\nend_header\n");
    for (size_t k = 0; k < 60; k++) {
        ply_put_value(&f, UCHAR, 0);
        ply_put_value(&f, UCHAR, 1);
    }
    he_limits limits = {.bytes = 300};
    he_import import = {0};
    he_error err = {0};
    assert_int_equal(read_pieces(&(format_file){"ply", f.bytes, f.length}, 0, NULL, &import, &err),
                     HE_OK);
    he_import_clear(&import);
    limits.bytes = 239;
    assert_int_equal(
        read_pieces(&(format_file){"ply", f.bytes, f.length}, 0, &limits, &import, &err), HE_LIMIT);
    assert_int_equal(err.place, HE_PLACE_BYTE);

    static char header[200000];
    for (int kind = 0; kind < 3; kind++) {
        size_t length = (size_t)snprintf(header, sizeof header, "%s", ASCII "element e 0\n");
        for (int i = 0; i < 1100; i++) {
            length += (size_t)snprintf(header + length, sizeof header - length,
                                       kind == 0   ? "element e%d 0\n"
                                       : kind == 1 ? "property int p%d\n"
                                                   : "comment %d",
                                       i);
        }
        if (kind == 2) {
            memset(header + length, 'c', sizeof header - 1 - length);
            length = sizeof header - 1;
        }
        assert_int_equal(
            read_pieces(&(format_file){"ply", header, length}, 1000, NULL, &import, &err),
            HE_LIMIT);
        assert_int_equal(err.place, HE_PLACE_LINE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_text_names_its_line),
        cmocka_unit_test(wrong_rows_name_their_line),
        cmocka_unit_test(wrong_bytes_name_their_place),
        cmocka_unit_test(fractions_of_bytes_name_their_place),
        cmocka_unit_test(counts_are_not_believed),
        cmocka_unit_test(limits_are_kept),
    };
    return cmocka_run_group_tests_name("format_ply_refused", tests, NULL, NULL);
}
