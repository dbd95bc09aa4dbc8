#include "model/rows.h"

#include "mesh/column.h"
#include "model/shapes.h"

#include <string.h>

/* The last drawn argument `with`, as an oracle and as a mesh. */
static or_mesh *other_oracle;
static he_mesh *other;

static bool draw_deviation(md_draft *d)
{
    static const char *const names[] = {"deviation", "distance", "position"};
    if (other_oracle == NULL) {
        other_oracle = or_new();
    }
    he_mesh_free(other);
    md_shape(other_oracle, d->r, md_fill_mixed);
    other = md_chance(d->r, 10) ? he_mesh_new() : md_build(other_oracle);
    if (other == NULL) {
        return false;
    }
    he_arg *arg = &d->c->args[md_index(d->c, "with")];
    arg->given = true;
    arg->mesh = other;
    if (md_chance(d->r, 50)) {
        md_give_text(d, "attribute", names[md_below(d->r, 3)]);
    }
    return true;
}

static uint64_t play_deviation(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)o;
    const he_arg *given = md_get(c, "attribute");
    const char *name = given->given ? given->text : "deviation";
    const he_column *column = he_mesh_find_column(m, HE_VERTEX, name);
    const bool fits = column == NULL || (column->components == 1 && column->labels == NULL &&
                                         (column->type == HE_FLOAT || column->type == HE_DOUBLE));
    return (he_mesh_faces(other) == 0 ? OR_BIT(HE_NO_FACES) : 0) |
           (strcmp(name, "position") == 0 ? OR_BIT(HE_BAD_VALUE) : 0) |
           (fits ? 0 : OR_BIT(HE_ATTRIBUTE_CLASH));
}

const md_row md_compare_rows[] = {
    {"deviation", 0, draw_deviation, play_deviation, NULL, false},
    {.name = NULL},
};
