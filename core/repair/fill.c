/* fill.c - the repair fill: closes each small hole of the mesh by one polygon. */
#include "edit/border/hole.h"
#include "mesh/walk.h"
#include "repair/repair.h"

/* Returns the number of half-edges of the boundary loop of h; if there are more than `most`,
 * returns `most` + 1. Sets *one_face to true if one face lies on the other side of all half-edges
 * that were counted. */
static size_t length_of(const he_mesh *m, he_halfedge h, size_t most, bool *one_face)
{
    size_t length = 0;
    he_halfedge k = h;
    uint32_t face = he_face_of(m, he_twin(h)).i;
    *one_face = true;
    do {
        *one_face = *one_face && he_face_of(m, he_twin(k)).i == face;
        length++;
        k = he_next(m, k);
    } while (k.i != h.i && length <= most);
    return length;
}

static he_status fill(he_mesh *m, he_halfedge h, size_t most, he_repair_account *account,
                      he_error *err)
{
    bool one_face;
    he_filled filled = {.vertex = {HE_NONE}};
    he_error why = {0};
    size_t length = length_of(m, h, most, &one_face);
    if (length > most || one_face) {
        account->left++;
        return HE_OK;
    }
    he_status status = he_hole_fill(m, h, HE_FILL_POLYGON, &filled, &why);
    if (status == HE_REPEATED_CORNER) {
        account->left++;
        return HE_OK;
    }
    if (status != HE_OK) {
        if (err != NULL) {
            *err = why;
        }
        return status;
    }
    account->count++;
    if (account->named < HE_REPAIR_NAMED) {
        account->pairs[account->named++] = (he_repair_pair){filled.faces.ids[0], (uint32_t)length};
    }
    he_filled_clear(&filled);
    return HE_OK;
}

/* Fills the holes. Each boundary loop is handled when its half-edge with the lowest id is reached;
 * `seen` marks the half-edges of loops that were handled before. */
static he_status fill_all(he_mesh *m, size_t most, uint64_t *seen, he_repair_account *account,
                          he_error *err)
{
    he_status status = HE_OK;
    uint32_t count = he_mesh_issued(m, HE_HALFEDGE);
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        he_halfedge h = {i}, k = h;
        status = he_progress_at(m->progress, i, count, err);
        if (status != HE_OK || he_bits_get(seen, i) || !he_is_boundary_halfedge(m, h)) {
            continue;
        }
        do {
            he_bits_set(seen, k.i);
            k = he_next(m, k);
        } while (k.i != i);
        status = fill(m, h, most, account, err);
    }
    return status;
}

he_status he_repair_mesh(he_mesh *mesh, const he_repair_plan *plan, he_repaired *out, he_error *err)
{
    if ((plan->which & he_repair_bit(HE_REPAIR_FILL)) == 0) {
        return HE_OK;
    }
    he_status status = he_progress_phase(mesh->progress, "fill", 1, err);
    if (status != HE_OK) {
        return status;
    }
    uint64_t *seen = he_bits_new(he_mesh_issued(mesh, HE_HALFEDGE));
    if (seen == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for holes");
    }
    status = fill_all(mesh, plan->hole_edges, seen, &out->accounts[HE_REPAIR_FILL], err);
    he_mem_free(seen);
    return status;
}
