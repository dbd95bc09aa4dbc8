/* The reader of MTL files, libraries of materials. The table that it makes must be one that a mesh
 * can have, and the library written from this table must be readable and have no more materials. */
#include "fuzz/fuzz.h"
#include "unit/format_fixture.h"

#include "format/obj/mtl.h"
#include "mesh/write.h"

static he_status read_library(const char *bytes, size_t size, he_import *import)
{
    he_error err = {0};
    /* The input is copied to a block of its size, so that the sanitizer notices reads beyond its
     * end. */
    char *copy = malloc(size == 0 ? 1 : size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    he_status status = he_mtl_read(copy, size, import, &err);
    free(copy);
    FUZZ_REQUIRE(status == HE_OK || err.text[0] != '\0', "a refusal says nothing");
    return status;
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    he_import import = {0}, again = {0};
    if (read_library((const char *)bytes, size, &import) == HE_OK) {
        he_mesh *mesh = build_import(&import);
        char *text = write_text("mtl", mesh, NULL);
        he_status status = read_library(text, strlen(text), &again);
        FUZZ_REQUIRE(status == HE_OK, "a library that was written is %s", he_status_slug(status));
        FUZZ_REQUIRE(he_materials_count(&again.soup.materials) <=
                         he_materials_count(he_mesh_materials(mesh)),
                     "a library has more materials when it is read again");
        free(text);
        he_mesh_free(mesh);
    }
    he_import_clear(&import);
    he_import_clear(&again);
}
