/* Bytes of a mesh as a store keeps them (core/stored): the length of the encoded mesh, the mesh,
 * the number of ids issued after an edit, and the edit, as in the golden files of
 * tests/unit/test_stored.c. A refusal must have a reason and change nothing. What can be read must
 * be writable and readable again, and the edit must be possible to undo. */
#include "fuzz/fuzz.h"

#include "mesh/check.h"
#include "stored/stored.h"

#include <stdlib.h>
#include <string.h>

static bool is_valid(const he_mesh *m)
{
    he_problem problem;
    size_t total = 0;
    FUZZ_REQUIRE(he_check(m, &problem, 1, &total, NULL) == HE_OK, "he_check has no memory");
    return total == 0;
}

static void require_reason(he_status status, const he_error *err)
{
    FUZZ_REQUIRE((status == HE_CORRUPT || status == HE_UNSUPPORTED) && err->status == status &&
                     err->place == HE_PLACE_BYTE && err->text[0] != '\0',
                 "refused with %d and \"%s\"", (int)status, err->text);
}

static void write_content(const he_mesh *m)
{
    size_t bound = he_stored_content_bound(m);
    unsigned char *bytes = malloc(bound);
    size_t size = he_stored_content_write(m, bytes);
    he_mesh *again = NULL;
    FUZZ_REQUIRE(size <= bound, "a content of %zu bytes has the bound %zu", size, bound);
    FUZZ_REQUIRE(he_stored_content_read(bytes, size, &again, NULL) == HE_OK &&
                     he_mesh_equal(again, m),
                 "the content comes back as another");
    he_mesh_free(again);
    free(bytes);
}

/* Writes the edit that led from `before` to the mesh m; applied to a copy of `before`, the bytes
 * must give m. */
static void write_edit(const he_delta *delta, const he_mesh *before, const he_mesh *m,
                       const uint32_t issued[HE_KIND_COUNT])
{
    size_t bound = he_stored_edit_bound(delta, m);
    unsigned char *bytes = malloc(bound);
    size_t size = he_stored_edit_write(delta, m, bytes);
    he_mesh *again = NULL;
    he_delta *read = NULL;
    FUZZ_REQUIRE(size <= bound, "an edit of %zu bytes has the bound %zu", size, bound);
    FUZZ_REQUIRE(he_mesh_copy(before, &again, NULL) == HE_OK &&
                     he_stored_edit_forward(bytes, size, issued, again, &read, NULL) == HE_OK &&
                     he_mesh_equal(again, m),
                 "the edit comes back as another");
    he_delta_free(read);
    he_mesh_free(again);
    free(bytes);
}

static void look_at_changes(const he_delta *delta, const he_mesh *m)
{
    he_changes changes = {0};
    FUZZ_REQUIRE(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL) == HE_OK,
                 "the changes of an edit are not found");
    he_changes_clear(&changes);
}

static void read_edit(const uint8_t *bytes, size_t size, he_mesh *m)
{
    uint32_t words[3], issued[HE_KIND_COUNT] = {0};
    if (size < sizeof words) {
        return;
    }
    memcpy(words, bytes, sizeof words);
    issued[HE_VERTEX] = words[0];
    issued[HE_EDGE] = words[1];
    issued[HE_FACE] = words[2];
    he_mesh *before = NULL;
    he_delta *delta = NULL;
    he_error err = {.status = HE_OK};
    FUZZ_REQUIRE(he_mesh_copy(m, &before, NULL) == HE_OK, "no copy");
    he_status status =
        he_stored_edit_forward(bytes + sizeof words, size - sizeof words, issued, m, &delta, &err);
    if (status != HE_OK) {
        require_reason(status, &err);
        FUZZ_REQUIRE(he_mesh_equal(m, before), "refused, and the mesh changed");
    } else {
        write_edit(delta, before, m, issued);
        if (is_valid(m)) {
            look_at_changes(delta, m);
        }
        he_delta_undo(delta, m);
        FUZZ_REQUIRE(he_mesh_equal_live(m, before), "undo leads elsewhere");
    }
    he_delta_free(delta);
    he_mesh_free(before);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    uint32_t length;
    if (size < sizeof length) {
        return;
    }
    memcpy(&length, bytes, sizeof length);
    bytes += sizeof length;
    size -= sizeof length;
    length = length < size ? length : (uint32_t)size;
    he_mesh *m = NULL;
    he_error err = {.status = HE_OK};
    he_status status = he_stored_content_read(bytes, length, &m, &err);
    if (status != HE_OK) {
        require_reason(status, &err);
        return;
    }
    write_content(m);
    if (is_valid(m)) {
        read_edit(bytes + length, size - length, m);
    }
    he_mesh_free(m);
}
