#include "op/rows.h"

#include "edit/whole/append.h"
#include "edit/whole/dual.h"
#include "edit/whole/reverse.h"
#include "edit/whole/triangulate.h"

enum { TRIANGULATE_OUT_EDGES, TRIANGULATE_OUT_FACES, TRIANGULATE_OUT_DEGENERATE };

static he_status run_triangulate(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    return he_triangulate(m, &out->list[TRIANGULATE_OUT_EDGES], &out->list[TRIANGULATE_OUT_FACES],
                          &out->list[TRIANGULATE_OUT_DEGENERATE], err);
}

enum { REVERSE_FACES };

static he_status run_reverse(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_reverse(m, args[REVERSE_FACES].given ? args[REVERSE_FACES].ids : NULL,
                      args[REVERSE_FACES].count, err);
}

static he_status run_dual(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    (void)out;
    return he_dual(m, err);
}

enum { APPEND_MESH };
enum { APPEND_OUT_VERTICES, APPEND_OUT_EDGES, APPEND_OUT_FACES };

static he_status run_append(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_appended appended;
    he_status status = he_append(m, args[APPEND_MESH].mesh, &appended, err);
    if (status == HE_OK) {
        he_results_set_list(out, APPEND_OUT_VERTICES, &appended.vertices);
        he_results_set_list(out, APPEND_OUT_EDGES, &appended.edges);
        he_results_set_list(out, APPEND_OUT_FACES, &appended.faces);
        he_appended_clear(&appended);
    }
    return status;
}

const he_op he_whole_rows[] = {
    {
        .name = "triangulate",
        .doc = "Cut all faces into triangles.",
        .size = HE_OP_WHOLE,
        .results = {[TRIANGULATE_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                               "The diagonals."},
                    [TRIANGULATE_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                               "The new triangles."},
                    [TRIANGULATE_OUT_DEGENERATE] =
                        {"degenerate", HE_RESULT_ELEMENTS, HE_FACE,
                         "The faces in which a triangle has no area or is turned over."}},
        .refusals = {HE_DOUBLED_EDGE},
        .change = {0, HE_VARIES, HE_VARIES},
        .pace = 5,
        .run = run_triangulate,
    },
    {
        .name = "reverse",
        .doc =
            "Reverse the orientation of faces, and the direction of the attributes named `normal`.",
        .size = HE_OP_WHOLE,
        .params = {[REVERSE_FACES] =
                       {.name = "face",
                        .plural = "faces",
                        .type = HE_PARAM_ELEMENTS,
                        .kind = HE_FACE,
                        .doc =
                            "The faces to reverse, which must be whole components. Default: all."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_ORIENTATION,
                     HE_BOWTIE},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_reverse,
    },
    {
        .name = "dual",
        .doc = "Replace the mesh by its dual: a vertex for each face and a face for each vertex. "
               "With more than about 200,000 faces it becomes a job.",
        .size = HE_OP_WHOLE,
        .refusals = {HE_BOUNDARY_EDGE, HE_ISOLATED_VERTEX, HE_TOO_FEW_CORNERS, HE_DOUBLED_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, 0, HE_VARIES},
        .pace = 8,
        .run = run_dual,
    },
    {
        .name = "append",
        .doc = "Add a copy of another mesh, with its attributes and materials.",
        .size = HE_OP_WHOLE,
        .params = {[APPEND_MESH] = {.name = "mesh",
                                    .type = HE_PARAM_MESH,
                                    .flags = HE_REQUIRED,
                                    .doc = "The id of the other mesh, which is copied as it was "
                                           "when the request began and is not changed; or the "
                                           "number of an earlier revision of this mesh."}},
        .results =
            {[APPEND_OUT_VERTICES] =
                 {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                  "The new vertices, in the order of the ids in the other mesh."},
             [APPEND_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                   "The new edges, in the order of the ids in the other mesh."},
             [APPEND_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                   "The new faces, in the order of the ids in the other mesh."}},
        .refusals = {HE_ATTRIBUTE_CLASH, HE_LIMIT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 2,
        .run = run_append,
    },
    {.name = NULL},
};
