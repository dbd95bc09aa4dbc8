/* deform_fields.c - what is the same for all translations of the handles.
 *
 * Without turns of single vertices, the solution is a linear function of the points of the vertices
 * that are not free. Let E be the map that extends values at these to the free ones by the system
 * of equations: E of a constant is that constant. If the handles move by a vector w and the motion
 * that fits a part best is the rotation R and a translation, which cancels out, the new positions
 * are
 *
 *     q = R p + (E - R E) p + w E h = R (p - E p) + E p + w E h,
 *
 * where h is 1 at handles and 0 at fixed vertices. The four fields E p and E h take one solution,
 * which is made together with the system; then each translation takes no solution at all. */
#include "deform/deformer.h"

enum { SIDES = 4 };

/* Adds what a vertex that is not free contributes to the right sides of row v. */
static void add(const he_deformer *d, uint32_t v, uint32_t other, double weight, double *right)
{
    const he_vec3 p = d->points[other];
    const double values[SIDES] = {p.x, p.y, p.z, d->handle[other] == HE_NONE ? 0 : 1};
    for (size_t k = 0; k < SIDES; k++) {
        right[k * d->free + v] -= weight * values[k];
    }
}

he_status he_deformer_make_fields(he_deformer *d, he_error *err)
{
    const he_sparse *a = &d->matrix;
    double *right = he_mem_zero(SIDES * (size_t)d->free + 1, sizeof *right);
    if (right == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices", d->free);
    }
    for (uint32_t v = 0; v < d->free; v++) {
        for (size_t i = a->starts[v]; i < a->starts[v + 1]; i++) {
            if (a->rows[i] >= d->free) {
                add(d, v, a->rows[i], a->values[i], right);
            }
        }
    }
    he_status status = he_factor_solve(d->factor, &d->system,
                                       (he_right_sides){right, right, SIDES, false}, NULL, err);
    if (status == HE_OK) {
        d->fields = right;
        return HE_OK;
    }
    he_mem_free(right);
    return status == HE_NOT_FINITE ? HE_OK : status; /* then every motion is solved for */
}

size_t he_deformer_field_bytes(const he_deformer *d)
{
    return d->fields == NULL ? 0 : SIDES * (size_t)d->free * sizeof *d->fields;
}

he_vec3 he_deformer_carry(const he_deformer *d, uint32_t v, const he_rotation *turn, he_vec3 by)
{
    const size_t n = d->free;
    const he_vec3 still = {d->fields[v], d->fields[n + v], d->fields[2 * n + v]};
    const he_vec3 bent = he_rotation_apply(turn, he_vec3_sub(d->points[v], still));
    return he_vec3_add(he_vec3_add(bent, still), he_vec3_scale(by, d->fields[3 * n + v]));
}
