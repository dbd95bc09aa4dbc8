/* A file that contains no mesh is refused, and the error says what kind of file it is. */
#include "unit/format_fixture.h"

#include "format/io/foreign.h"

#define ROW(bytes, name)               \
    {                                  \
        bytes, sizeof(bytes) - 1, name \
    }

static void what_is_no_mesh_is_called_by_its_name(void **state)
{
    (void)state;
    static const struct {
        const char *bytes;
        size_t length;
        const char *name;
    } rows[] = {
        ROW("PK\3\4\24\0\6\0", "a ZIP archive, as 3MF"),
        ROW("\x1F\x8B\x08\0\0", "gzip"),
        ROW("\x28\xB5\x2F\xFD", "zstd"),
        ROW("\x89PNG\r\n\x1A\n", "a PNG image"),
        ROW("\xFF\xD8\xFF\xE0", "a JPEG image"),
        ROW("RIFF\1\2\3\4WEBPVP8 ", "a WebP image"),
        ROW("%PDF-1.7\n", "a PDF document"),
        ROW("\177ELF\2\1\1", "a program in the format ELF"),
        ROW("Kaydara FBX Binary  \0", "an FBX file"),
        ROW("; FBX 7.3.0 project file\n", "an FBX file"),
        ROW("\xFF\xFEv\0 \0", "UTF-16 text"),
        ROW("\xFE\xFF\0v", "UTF-16 text"),
        ROW("version https://git-lfs.github.com/spec/v1\noid", "a pointer of Git LFS"),
        ROW("<!DOCTYPE html><html>", "an HTML page"),
        ROW("\xEF\xBB\xBF \r\n<HTML lang=en>", "an HTML page"),
        ROW("<?xml version=\"1.0\"?>", "an XML document"),
        ROW("ISO-10303-21;", "a STEP file"),
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *name = he_foreign_find(rows[i].bytes, rows[i].length);
        if (name == NULL || strstr(name, rows[i].name) == NULL) {
            fail_msg("%s: %s", rows[i].name, name == NULL ? "not known" : name);
        }
        assert_null(he_format_sniff(rows[i].bytes, rows[i].length));
        /* the first byte alone must not be enough to recognize the kind of file */
        assert_null(he_foreign_find(rows[i].bytes, 1));
    }
    char tar[512] = "part.obj";
    memcpy(tar + 257, "ustar", 5);
    assert_non_null(strstr(he_foreign_find(tar, sizeof tar), "a tar archive"));
    assert_null(he_foreign_find(tar, 261));
}

static void files_that_are_read_are_not_foreign(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",  "v 0 0 0\n", "OFF\n", "ply\n",      "solid\n",          "glTF\2", "{\"asset\":{}}",
        "B", "M",         "BM W",  "MZ housing", "# <html>\nv 0 0 0"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_null(he_foreign_find(texts[i], strlen(texts[i])));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_mesh_is_called_by_its_name),
        cmocka_unit_test(files_that_are_read_are_not_foreign),
    };
    return cmocka_run_group_tests_name("format_foreign", tests, NULL, NULL);
}
