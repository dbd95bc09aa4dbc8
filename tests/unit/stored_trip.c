#include "stored_trip.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "edit_log.h"
#include "edit_script.h"
#include "stored/stored.h"

/* Requires that the size of an encoding is at most `bound`, the size predicted for it. Shrinks the
 * encoding's memory block to exactly its size, so that the sanitizers detect reads beyond its
 * end. */
static stored_bytes cut(unsigned char *bytes, size_t size, size_t bound)
{
    assert_true(size > 0 && size <= bound);
    unsigned char *exact = realloc(bytes, size);
    assert_non_null(exact);
    return (stored_bytes){exact, size};
}

stored_bytes stored_content(const he_mesh *mesh)
{
    size_t bound = he_stored_content_bound(mesh);
    unsigned char *bytes = malloc(bound);
    assert_non_null(bytes);
    return cut(bytes, he_stored_content_write(mesh, bytes), bound);
}

stored_bytes stored_edit(const he_delta *delta, const he_mesh *after)
{
    size_t bound = he_stored_edit_bound(delta, after);
    unsigned char *bytes = malloc(bound);
    assert_non_null(bytes);
    return cut(bytes, he_stored_edit_write(delta, after, bytes), bound);
}

he_mesh *stored_load(stored_bytes content)
{
    he_mesh *m = NULL;
    he_error err = {.status = HE_OK};
    if (he_stored_content_read(content.bytes, content.size, &m, &err) != HE_OK) {
        fail_msg("byte %llu: %s", (unsigned long long)err.at, err.text);
    }
    assert_valid(m);
    return m;
}

void stored_trip(const he_mesh *before, const he_delta *delta, const he_mesh *after)
{
    stored_bytes content = stored_content(before), edit = stored_edit(delta, after);
    he_mesh *m = stored_load(content);
    he_delta *read = NULL;
    he_error err = {.status = HE_OK};
    uint32_t issued[HE_KIND_COUNT];
    assert_true(he_mesh_equal(m, before));
    edit_log_marks(after, issued);
    if (he_stored_edit_forward(edit.bytes, edit.size, issued, m, &read, &err) != HE_OK) {
        fail_msg("byte %llu: %s", (unsigned long long)err.at, err.text);
    }
    assert_true(he_mesh_equal(m, after));
    assert_valid(m);
    stored_bytes again = stored_edit(read, m);
    assert_int_equal(again.size, edit.size);
    assert_memory_equal(again.bytes, edit.bytes, edit.size);
    assert_int_equal(he_delta_ready(read, m, NULL), HE_OK);
    he_delta_undo(read, m);
    assert_true(he_mesh_equal_live(m, before));
    assert_int_equal(he_delta_ready(read, m, NULL), HE_OK);
    he_delta_redo(read, m);
    assert_true(he_mesh_equal(m, after));
    he_delta_free(read);
    he_mesh_free(m);
    free(again.bytes);
    free(edit.bytes);
    free(content.bytes);
}
