#include "model/limits.h"

#include "giants.h"
#include "mesh/check.h"
#include "model/arguments.h"

#include <string.h>

typedef struct limit {
    const char *row;
    he_mesh *(*make)(void);
    const char *element; /* its first argument, of id `id`; NULL for none */
    uint32_t id;
    const char *number; /* its second one, 0.1 */
    const char *method; /* its choice */
} limit;

static const limit limits[] = {
    {"delaunay", giant_rows, NULL, 0, NULL, NULL},
    {"face_inset", giant_star, "face", 0, "distance", NULL},
    {"face_collapse", giant_star, "face", 0, NULL, NULL},
};

static void make_call(const limit *l, md_call *call)
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
    if (l->method != NULL) {
        size_t i = md_index(call, "method");
        call->args[i].given = true;
        call->args[i].choice = 0;
        while (strcmp(call->op->params[i].choices[call->args[i].choice], l->method) != 0) {
            call->args[i].choice++;
        }
    }
}

static const char *refuse(const limit *l, he_mesh *m, const he_mesh *before, md_tally *tally)
{
    md_call call = {.row = 0};
    he_results results = {0};
    he_error err = {0};
    he_problem problem;
    size_t problems = 0;
    make_call(l, &call);
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
        wrong = m == NULL || he_mesh_copy(m, &before, NULL) != HE_OK ? "no memory" : NULL;
        if (wrong == NULL) {
            wrong = refuse(&limits[i], m, before, tally);
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
    return wrong;
}
