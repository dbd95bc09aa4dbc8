#include "format/io/foreign.h"

#include <stdbool.h>
#include <string.h>

static const struct {
    const char *bytes;
    size_t length, at;
    const char *name;
} signatures[] = {
#define SIGNATURE(bytes, at, name)               \
    {                                            \
        (bytes), sizeof(bytes) - 1, (at), (name) \
    }
    SIGNATURE("PK\3\4", 0, "a ZIP archive, as 3MF and USDZ files are: unpack it first"),
    SIGNATURE("PK\5\6", 0, "an empty ZIP archive"),
    SIGNATURE("\x1F\x8B\x08", 0, "compressed with gzip: send it with Content-Encoding: gzip"),
    SIGNATURE("\x28\xB5\x2F\xFD", 0, "compressed with zstd: send it with Content-Encoding: zstd"),
    SIGNATURE("BZh", 0, "compressed with bzip2: decompress it first"),
    SIGNATURE("\xFD"
              "7zXZ",
              0, "compressed with xz: decompress it first"),
    SIGNATURE("7z\xBC\xAF", 0, "a 7z archive: unpack it first"),
    SIGNATURE("Rar!\x1A", 0, "a RAR archive: unpack it first"),
    SIGNATURE("ustar", 257, "a tar archive: unpack it first"),
    SIGNATURE("\x89PNG\r\n", 0, "a PNG image"),
    SIGNATURE("\xFF\xD8\xFF", 0, "a JPEG image"),
    SIGNATURE("GIF87a", 0, "a GIF image"),
    SIGNATURE("GIF89a", 0, "a GIF image"),
    SIGNATURE("WEBP", 8, "a WebP image"),
    SIGNATURE("%PDF-", 0, "a PDF document"),
    SIGNATURE("\x7F"
              "ELF",
              0, "a program in the format ELF"),
    SIGNATURE("SQLite format 3", 0, "an SQLite database"),
    SIGNATURE("Kaydara FBX Binary", 0, "an FBX file, which is not read: export it as GLB or OBJ"),
    SIGNATURE("; FBX", 0, "an FBX file, which is not read: export it as GLB or OBJ"),
    SIGNATURE("BLENDER", 0, "a file of Blender, which is not read: export it as GLB or OBJ"),
    SIGNATURE("PXR-USDC", 0, "a USD file, which is not read: export it as GLB or OBJ"),
    SIGNATURE("#usda", 0, "a USD file, which is not read: export it as GLB or OBJ"),
    SIGNATURE("DRACO", 0, "a Draco file, which is not read: decode it to PLY or OBJ first"),
    SIGNATURE("ISO-10303-21", 0, "a STEP file, which is not read: export it as STL or GLB"),
    SIGNATURE("version https://git-lfs", 0,
              "a pointer of Git LFS, not the file itself: fetch the file with git lfs pull"),
    SIGNATURE("\xFF\xFE", 0, "UTF-16 text: send it as UTF-8"),
    SIGNATURE("\xFE\xFF", 0, "UTF-16 text: send it as UTF-8"),
#undef SIGNATURE
};

/* Beginnings of text formats. Markup may begin with a UTF-8 byte order mark and blanks, and its
 * letter case does not matter. */
static const struct {
    const char *text, *name;
} markups[] = {
    {"<!doctype html", "an HTML page, perhaps the answer of a web site in place of the file"},
    {"<html", "an HTML page, perhaps the answer of a web site in place of the file"},
    {"<collada", "a COLLADA file, which is not read: export it as GLB or OBJ"},
    {"<?xml", "an XML document, as COLLADA, X3D and AMF files are: export it as GLB or OBJ"},
    {"<svg", "an SVG image"},
};

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c;
}

static bool begins(const char *p, const char *end, const char *text)
{
    while (p < end && *text != '\0' && lower(*p) == *text) {
        p++;
        text++;
    }
    return *text == '\0';
}

const char *he_foreign_find(const void *bytes, size_t n)
{
    const char *p = bytes, *end = p + n;
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
        size_t at = signatures[i].at, length = signatures[i].length;
        if (n >= at + length && memcmp(p + at, signatures[i].bytes, length) == 0) {
            return signatures[i].name;
        }
    }
    if (n >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0) {
        p += 3;
    }
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n')) {
        p++;
    }
    for (size_t i = 0; i < sizeof markups / sizeof *markups; i++) {
        if (begins(p, end, markups[i].text)) {
            return markups[i].name;
        }
    }
    return NULL;
}
