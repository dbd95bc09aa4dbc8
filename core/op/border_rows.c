#include "op/rows.h"

#include "edit/erase.h"

static he_status run_edge_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_edge_delete(m, args[0].ids, args[0].count,
                          args[1].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

const he_op he_border_rows[] = {
    {
        .name = "edge_delete",
        .doc = "Delete edges with the faces beside them, and edges and vertices that are left "
               "without any.",
        .params = {{.name = "edge",
                    .plural = "edges",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "What goes."},
                   {.name = "keep_isolated",
                    .type = HE_PARAM_FLAG,
                    .doc = "Keep vertices that lose their last face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_edge_delete,
    },
    {.name = NULL},
};
