#include "edit_log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "edit_script.h"
#include "mesh/compact.h"
#include "mesh/write.h"

edit_log *edit_log_new(he_mesh *mesh)
{
    edit_log *log = calloc(1, sizeof *log);
    assert_non_null(log);
    log->mesh = mesh;
    log->entries[0].after = copy_of(mesh);
    log->count = 1;
    return log;
}

void edit_log_free(edit_log *log)
{
    for (size_t i = 0; i < log->step_count; i++) {
        he_delta_free(log->steps[i]);
    }
    for (size_t i = 0; i < log->count; i++) {
        he_mesh_free(log->entries[i].after);
    }
    he_mesh_free(log->mesh);
    free(log);
}

void edit_log_note(edit_log *log, size_t step, bool undo)
{
    log->applied[step] = log->count;
    log->entries[log->count++] = (edit_log_entry){step, undo, copy_of(log->mesh)};
}

void edit_log_add_column(he_mesh *m, md_random *random, unsigned serial)
{
    static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE, HE_MESH_KIND};
    he_kind domain = domains[md_below(random, 5)];
    char name[16];
    he_column *column;
    snprintf(name, sizeof name, "late%u", serial);
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, HE_FLOAT, 3, (he_rule)md_below(random, 3)},
                      &column, NULL),
        HE_OK);
    column->fallback[2] = (unsigned char)md_below(random, 256);
    size_t rows = domain == HE_MESH_KIND ? 1 : he_mesh_issued(m, domain);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static bool random_column(const he_mesh *m, md_random *random, size_t *slot)
{
    for (int tries = 0; tries < 10 && he_mesh_columns(m) > 0; tries++) {
        *slot = md_below(random, (uint32_t)he_mesh_columns(m));
        if (he_mesh_column(m, *slot) != NULL) {
            return true;
        }
    }
    return false;
}

static void write_values(he_mesh *m, md_random *random, size_t slot)
{
    const he_column *column = he_mesh_column(m, slot);
    he_kind domain = column->domain;
    uint32_t rows = domain == HE_MESH_KIND ? 1 : he_mesh_issued(m, domain);
    assert_int_equal(he_reserve(m, (he_reservation){.attributes = 4}, NULL), HE_OK);
    for (int i = 0; i < 4; i++) {
        uint32_t row = md_below(random, rows);
        unsigned char value[HE_COLUMN_ROW_BYTES] = {(unsigned char)md_below(random, 2), 0, 1};
        if (domain == HE_MESH_KIND || he_mesh_is_live(m, domain, row)) {
            he_set_attribute(m, slot, row, value);
        }
    }
}

/* Moves most vertices by one record of all positions, and then one vertex by records of words. */
static void write_positions(he_mesh *m, md_random *random)
{
    he_column present, *column;
    he_mesh_position_column(m, &present);
    assert_int_equal(he_column_copy(&present, &column, NULL), HE_OK);
    for (uint32_t v = 0; v < column->rows; v++) {
        if (md_below(random, 4) > 0 && he_mesh_is_live(m, HE_VERTEX, v)) {
            const he_vec3 to = {md_below(random, 4), md_below(random, 9), v};
            memcpy(he_column_row(column, v), &to, sizeof to);
        }
    }
    assert_int_equal(he_exchange_positions(m, column, NULL), HE_OK);
    const uint32_t v = md_below(random, he_mesh_issued(m, HE_VERTEX));
    if (he_mesh_is_live(m, HE_VERTEX, v)) {
        assert_int_equal(he_reserve(m, (he_reservation){.positions = 1}, NULL), HE_OK);
        he_set_position(m, (he_vertex){v}, (he_vec3){md_below(random, 3), 0, v});
    }
}

/* Makes one random change to a mesh. The mesh is recording its changes, so this change is added to
 * its delta. */
static void change(he_mesh *m, md_random *random, unsigned serial)
{
    char text[96];
    size_t slot;
    switch (md_below(random, 9)) {
    case 0:
        edit_log_add_column(m, random, serial);
        return;
    case 1:
        if (random_column(m, random, &slot)) {
            assert_int_equal(he_mesh_drop_column(m, slot, NULL), HE_OK);
        }
        return;
    case 2:
        if (random_column(m, random, &slot)) {
            write_values(m, random, slot);
        }
        return;
    case 3:
        if (md_below(random, 3) == 0) {
            assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
        }
        return;
    case 4:
        write_positions(m, random);
        return;
    case 5:
        snprintf(text, sizeof text, "vertex_add position=%u,1,%u", serial, md_below(random, 9));
        break;
    case 6:
        snprintf(text, sizeof text, "face_delete face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    case 7:
        snprintf(text, sizeof text, "face_poke face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    default:
        snprintf(text, sizeof text, "edge_split edge=#%u t=0.25",
                 md_below(random, he_mesh_issued(m, HE_EDGE)));
        break;
    }
    /* The arguments are random and may name a deleted element: then the operation is refused and
     * changes nothing. */
    (void)script_run(m, text, NULL, NULL);
}

static void edit(edit_log *log, md_random *random)
{
    he_delta *delta = he_delta_new();
    he_mesh_record(log->mesh, delta);
    unsigned changes = 1 + md_below(random, 3);
    for (unsigned i = 0; i < changes; i++) {
        change(log->mesh, random, (unsigned)(log->count * 10 + i));
    }
    he_mesh_record(log->mesh, NULL);
    log->steps[log->step_count] = delta;
    log->done[log->done_count++] = log->step_count;
    log->undone_count = 0;
    edit_log_note(log, log->step_count++, false);
}

void edit_log_undo(edit_log *log)
{
    size_t undone = log->done[--log->done_count];
    log->undone[log->undone_count++] = undone;
    he_delta_undo(log->steps[undone], log->mesh);
    edit_log_note(log, undone, true);
}

static void step(edit_log *log, md_random *random)
{
    unsigned what = md_below(random, 4);
    if (what == 0 && log->done_count > 0) {
        edit_log_undo(log);
    } else if (what == 1 && log->undone_count > 0) {
        size_t redone = log->undone[--log->undone_count];
        log->done[log->done_count++] = redone;
        he_delta_redo(log->steps[redone], log->mesh);
        edit_log_note(log, redone, false);
    } else {
        edit(log, random);
    }
}

edit_log *edit_log_random(md_random *random, size_t entries)
{
    he_mesh *mesh = script_mesh("012,023,034,045", NULL);
    script_add_columns(mesh);
    edit_log *log = edit_log_new(mesh);
    while (log->count < entries) {
        step(log, random);
    }
    return log;
}

void edit_log_marks(const he_mesh *mesh, uint32_t marks[HE_KIND_COUNT])
{
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        marks[kind] = he_mesh_issued(mesh, (he_kind)kind);
    }
}
