#include "model/rows.h"

#include "mesh/column.h"
#include "mesh/material.h"

#include <string.h>

static const char *const names[] = {"red", "green", "blue", "steel", "glass"};
enum { NAMES = sizeof names / sizeof *names };

/* Returns whether faces have an attribute of numbers under the name `material`, which marks.c may
 * give them. Then a material_set that names faces is refused, because it needs labels there. */
static bool clashes(const he_mesh *m)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    return column != NULL && !he_is_material_column(column);
}

/* Draws a material_set. The model has no attributes: unit tests check the values of materials, and
 * the model checks that nothing else changes. */
static bool draw_material_set(md_draft *d)
{
    he_arg *name = &d->c->args[md_index(d->c, "name")];
    he_arg *color = &d->c->args[md_index(d->c, "base_color")];
    name->given = true;
    name->text = names[md_below(d->r, NAMES)];
    if (md_chance(d->r, 50)) {
        color->given = true;
        color->count = md_chance(d->r, 50) ? 4 : 3;
        for (size_t i = 0; i < color->count; i++) {
            color->color[i] = md_unit(d->r);
        }
        color->color[0] += md_chance(d->r, 5) ? 1 : 0;
    }
    if (md_chance(d->r, 30)) {
        md_give_number(d, "metallic", md_unit(d->r));
    }
    if (md_chance(d->r, 60) && he_mesh_issued(d->m, HE_FACE) > 0) {
        (void)md_pick_some(d, "face", "faces", HE_FACE, 3);
    }
    return true;
}

static uint64_t play_material_set(const md_call *c, or_mesh *o, const he_mesh *m)
{
    const he_arg *color = md_get(c, "base_color"), *faces = md_get(c, "face");
    uint64_t refused = faces->given ? md_require_all(o, HE_FACE, faces) : 0;
    refused |= faces->given && clashes(m) ? OR_BIT(HE_ATTRIBUTE_CLASH) : 0;
    return refused | (color->given && color->color[0] > 1 ? OR_BIT(HE_BAD_VALUE) : 0);
}

static bool draw_material_delete(md_draft *d)
{
    he_arg *name = &d->c->args[md_index(d->c, "name")], *to = &d->c->args[md_index(d->c, "to")];
    name->given = true;
    name->text = names[md_below(d->r, NAMES)];
    to->given = md_chance(d->r, 50);
    to->text = names[md_below(d->r, NAMES)];
    return true;
}

static bool is_there(const he_mesh *m, const char *name)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    uint32_t index;
    return he_materials_find(he_mesh_materials(m), name, strlen(name)) != SIZE_MAX ||
           (column != NULL && he_labels_find(column->labels, name, strlen(name), &index));
}

static uint64_t play_material_delete(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)o;
    const he_arg *name = md_get(c, "name"), *to = md_get(c, "to");
    if (clashes(m)) {
        return OR_BIT(HE_ATTRIBUTE_CLASH);
    }
    bool good = is_there(m, name->text) &&
                (!to->given || (is_there(m, to->text) && strcmp(name->text, to->text) != 0));
    return good ? 0 : OR_BIT(HE_BAD_VALUE);
}

const md_row md_material_rows[] = {
    {"material_set", 0, draw_material_set, play_material_set, NULL, true},
    {"material_delete", 0, draw_material_delete, play_material_delete, NULL, true},
    {.name = NULL},
};
