#include "model/limits.h"

#include "giants.h"
#include "mesh/check.h"
#include "mesh/material.h"
#include "model/arguments.h"

#include <string.h>

typedef struct limit {
    const char *row;
    he_mesh *(*make)(void);
    /* name of the edit's first argument, the element with the id `id`; NULL if it has none */
    const char *element;
    uint32_t id;
    const char *number; /* name of the edit's second argument, whose value is 0.1 */
    const char *name;   /* value of its argument `name` */
    const char *vector; /* name of an argument whose value is the vector (0, 0, 1) */
    /* the names of its choices, each followed by the value; ends in NULL */
    const char *choices[6 + 1];
    he_mesh *(*mesh)(void); /* makes the mesh for the edit's argument `mesh`; NULL if the edit has
                               no such argument */
} limit;

static he_mesh *all_materials(void)
{
    return giant_palette("m", HE_MATERIALS);
}

static he_mesh *another_material(void)
{
    return giant_palette("n", 1);
}

static const limit limits[] = {
    {.row = "delaunay", .make = giant_rows},
    {.row = "face_inset", .make = giant_star, .element = "face", .number = "distance"},
    {.row = "face_collapse", .make = giant_star, .element = "face"},
    {.row = "material_set", .make = all_materials, .element = "face", .name = "n"},
    {.row = "append", .make = all_materials, .mesh = another_material},
    {.row = "select",
     .make = giant_star,
     .choices = {"by", "measure", "measure", "mean_curvature", "elements", "vertices"}},
    {.row = "deform",
     .make = giant_hub,
     .element = "vertex",
     .choices = {"method", "biharmonic"},
     .vector = "by"},
};

static void make_call(const limit *l, const he_mesh *other, md_call *call)
{
    md_draft draft = {.c = call};
    for (call->row = 0; strcmp(he_op_at(call->row)->name, l->row) != 0; call->row++) {
    }
    call->op = he_op_at(call->row);
    he_op_defaults(call->op, call->args);
    if (l->element != NULL && call->op->params[md_index(call, l->element)].plural != NULL) {
        md_give_ids(&draft, l->element, &l->id, 1, false);
    } else if (l->element != NULL) {
        md_give_id(&draft, l->element, l->id);
    }
    if (l->number != NULL) {
        md_give_number(&draft, l->number, 0.1);
    }
    if (l->vector != NULL) {
        static const he_vec3 up = {0, 0, 1};
        he_arg *vector = &call->args[md_index(call, l->vector)];
        vector->given = true;
        vector->points = &up;
        vector->count = 1;
    }
    if (l->name != NULL) {
        he_arg *name = &call->args[md_index(call, "name")];
        name->given = true;
        name->text = l->name;
    }
    for (size_t i = 0; l->choices[i] != NULL; i += 2) {
        md_give_choice(&draft, l->choices[i], l->choices[i + 1]);
    }
    if (other != NULL) {
        he_arg *mesh = &call->args[md_index(call, "mesh")];
        mesh->given = true;
        mesh->mesh = other;
    }
}

static const char *refuse(const limit *l, he_mesh *m, const he_mesh *before, const he_mesh *other,
                          md_tally *tally)
{
    md_call call = {.row = 0};
    he_results results = {0};
    he_error err = {0};
    he_problem problem;
    size_t problems = 0;
    make_call(l, other, &call);
    he_status status = he_op_run(call.op, m, call.args, &results, &err);
    he_results_clear(&results);
    tally->edits++;
    tally->meshes++;
    tally->faces = he_mesh_faces(m) > tally->faces ? he_mesh_faces(m) : tally->faces;
    tally->row[call.row].refused[status]++;
    if (status != HE_LIMIT || err.status != HE_LIMIT || !he_op_declares(call.op, HE_LIMIT)) {
        return l->row;
    }
    if (!he_mesh_equal(m, before)) {
        return "a refusal changed the mesh";
    }
    return he_check(m, &problem, 1, &problems, NULL) == HE_OK && problems == 0 ? NULL
                                                                               : "the check fails";
}

const char *md_limits_run(md_tally *tally)
{
    const char *wrong = NULL;
    for (size_t i = 0; i < sizeof limits / sizeof *limits && wrong == NULL; i++) {
        he_mesh *m = limits[i].make();
        he_mesh *before = NULL;
        he_mesh *other = limits[i].mesh != NULL ? limits[i].mesh() : NULL;
        if (m == NULL || he_mesh_copy(m, &before, NULL) != HE_OK ||
            (limits[i].mesh != NULL && other == NULL)) {
            wrong = "no memory";
        } else {
            wrong = refuse(&limits[i], m, before, other, tally);
        }
        he_mesh_free(other);
        he_mesh_free(before);
        he_mesh_free(m);
    }
    return wrong;
}
