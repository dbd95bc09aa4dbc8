#include "format/obj/mtl.h"

#include "format/io/export.h"
#include "format/obj/obj_name.h"
#include "format/text/number.h"

#include <string.h>

typedef struct mtl_writer {
    const he_materials *table;
    size_t row; /* the next row of the table to write */
    bool begun; /* true if the first line of the file is written */
    he_obj_name name;
    /* True if the name of the material has been written, so that its numbers come next. */
    bool look;
} mtl_writer;

size_t he_mtl_names(const he_mesh *mesh, const char *names[HE_COLUMN_COMPONENTS])
{
    const he_column *column = he_mesh_find_column(mesh, HE_MESH_KIND, HE_OBJ_LIBRARY);
    size_t count = 0;
    if (column != NULL && column->type == HE_UINT32 && column->labels != NULL) {
        for (uint32_t i = 0; i < column->components; i++) {
            uint32_t label;
            memcpy(&label, he_column_value(column, 0) + i * sizeof label, sizeof label);
            if (label < he_labels_count(column->labels) &&
                he_labels_get(column->labels, label)[0] != '\0') {
                names[count++] = he_labels_get(column->labels, label);
            }
        }
    }
    if (count == 0 && he_materials_count(he_mesh_materials(mesh)) > 0) {
        names[count++] = "materials.mtl";
    }
    return count;
}

bool he_mtl_sniff(const char *bytes, size_t n)
{
    (void)bytes;
    (void)n;
    return false;
}

static void mtl_close(void *state)
{
    he_mem_free(state);
}

static he_status mtl_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    (void)progress;
    (void)encoding;
    mtl_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the MTL file");
    }
    w->table = he_mesh_materials(mesh);
    for (size_t i = 0; i < w->table->count; i++) {
        const he_material *row = w->table->rows[i];
        if (row == NULL) {
            continue;
        }
        he_obj_note_name(row->name, warnings);
        if (row->look.two_sided) {
            he_warnings_add(warnings,
                            &(he_occurrence){.code = "two_sided_lost",
                                             .text = "two_sided of material % is not written, "
                                                     "because a material library cannot hold it",
                                             .subject = row->name,
                                             .length = row->length});
        }
    }
    *state = w;
    return HE_OK;
}

static char *write_numbers(const char *keyword, const double *numbers, size_t count, char *p)
{
    p = he_export_text(keyword, p);
    for (size_t i = 0; i < count; i++) {
        *p++ = ' ';
        p += he_double_print(numbers[i], p);
    }
    *p++ = '\n';
    return p;
}

static char *write_look(const he_look *look, char *p)
{
    p = write_numbers("Kd", look->base_color, 3, p);
    p = write_numbers("d", &look->base_color[3], 1, p);
    p = write_numbers("Ke", look->emission, 3, p);
    p = write_numbers("Pm", &look->metallic, 1, p);
    p = write_numbers("Pr", &look->roughness, 1, p);
    return he_export_text("illum 2\n", p);
}

static bool mtl_step(void *state, char **at, const char *end)
{
    mtl_writer *w = state;
    char *p = *at;
    if (!w->begun) {
        w->begun = true;
        p = he_export_text("# materials\n", p);
    } else if (w->name.rest != NULL) {
        p = he_obj_name_write(&w->name, p, end);
        w->look = w->name.rest == NULL;
    } else if (w->look) {
        p = write_look(&w->table->rows[w->row++]->look, p);
        w->look = false;
    } else if (w->row < w->table->count && w->table->rows[w->row] == NULL) {
        w->row++;
    } else if (w->row < w->table->count) {
        p = he_export_text("newmtl ", p);
        w->name.rest = w->table->rows[w->row]->name;
    } else {
        return false;
    }
    *at = p;
    return true;
}

const he_writing he_mtl_writing = {
    .open = mtl_open,
    .step = mtl_step,
    .close = mtl_close,
};
