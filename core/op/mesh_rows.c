#include "op/rows.h"

#include "edit/transform.h"
#include "mesh/compact.h"

static he_status run_transform(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    const uint32_t *vertices = args[1].given ? args[1].ids : NULL;
    return he_transform(m, args[0].matrix, vertices, args[1].count, err);
}

static void give_map(he_results *out, size_t i, uint32_t **takes, uint32_t count)
{
    he_ids list = {*takes, count, count};
    he_give_list(out, i, &list);
    *takes = NULL;
}

static he_status run_compact(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    he_maps maps = {0};
    he_status status = he_compact(m, &maps, err);
    if (status == HE_OK) {
        give_map(out, 0, &maps.vertex, maps.vertices);
        give_map(out, 1, &maps.edge, maps.edges);
        give_map(out, 2, &maps.face, maps.faces);
        he_maps_clear(&maps);
    }
    return status;
}

const he_op he_mesh_rows[] = {
    {
        .name = "transform",
        .doc = "Apply an affine map to vertices.",
        .size = HE_OP_WHOLE,
        .params = {{.name = "matrix",
                    .type = HE_PARAM_MATRIX,
                    .flags = HE_REQUIRED,
                    .doc = "16 numbers, row-major, the last row 0 0 0 1."},
                   {.name = "vertex",
                    .plural = "vertices",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_VERTEX,
                    .doc = "What moves; all vertices when not given."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_FINITE},
        .change = {0, 0, 0},
        .run = run_transform,
    },
    {
        .name = "compact",
        .doc = "Drop deleted ids and number what lives anew.",
        .size = HE_OP_WHOLE,
        .results = {{"vertices", HE_RESULT_MAP, HE_VERTEX, "The new id of each old one."},
                    {"edges", HE_RESULT_MAP, HE_EDGE, "The new id of each old one."},
                    {"faces", HE_RESULT_MAP, HE_FACE, "The new id of each old one."}},
        .change = {0, 0, 0},
        .run = run_compact,
    },
    {.name = NULL},
};
