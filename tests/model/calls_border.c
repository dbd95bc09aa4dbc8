#include "model/rows.h"

#include "mesh/walk.h"

static bool draw_edge_delete(md_draft *d)
{
    (void)md_pick_some(d, "edge", "edges", HE_EDGE, 3);
    if (md_chance(d->r, 50)) {
        md_give_flag(d, "keep_isolated", md_chance(d->r, 60));
    }
    return true;
}

static uint64_t play_edge_delete(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)m;
    const he_arg *e = md_get(c, "edge");
    uint64_t refused = md_require_all(o, HE_EDGE, e);
    return refused != 0
               ? refused
               : or_edge_delete(o, e->ids, (uint32_t)e->count, md_get(c, "keep_isolated")->flag);
}

const md_row md_border_rows[] = {
    {"edge_delete", -1, draw_edge_delete, play_edge_delete, NULL},
    {.name = NULL},
};
