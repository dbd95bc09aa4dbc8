#include "mesh/walk.h"
#include "query/geometry.h"
#include "query/ring.h"

bool he_mesh_box(const he_mesh *m, he_box *out)
{
    he_vec3 low = {0, 0, 0}, high = {0, 0, 0};
    bool any = false;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (!he_vertex_is_live(m, (he_vertex){v})) {
            continue;
        }
        he_vec3 p = m->c.position[v];
        if (!any) {
            low = high = p;
            any = true;
        }
        low = (he_vec3){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y,
                        p.z < low.z ? p.z : low.z};
        high = (he_vec3){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y,
                         p.z > high.z ? p.z : high.z};
    }
    *out = (he_box){low, high};
    return any;
}

/* Neumaier's sum: the rounding errors are summed beside it. */
typedef struct total {
    double sum, error;
} total;

static void add(total *t, double x)
{
    double sum = t->sum + x;
    t->error += fabs(t->sum) >= fabs(x) ? (t->sum - sum) + x : (x - sum) + t->sum;
    t->sum = sum;
}

he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err)
{
    he_box box;
    he_mesh_box(m, &box);
    int exponent = he_exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    double scale = ldexp(1, -exponent);
    total area = {0, 0}, volume = {0, 0};
    uint32_t budget = he_ring_budget(m);
    he_vec3 about = {0, 0, 0}; /* a corner of the mesh: far from it, the sum would cancel */
    bool any = false;
    he_status status = he_watch_phase(m->watch, "measuring", 1, err);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (status == HE_OK) {
            status = he_watch_at(m->watch, f, m->c.faces.issued, err);
        }
        if (status != HE_OK) {
            return status;
        }
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        uint32_t first = m->c.face_halfedge[f];
        he_ring r = he_ring_walk(m, first, scale, &budget);
        if (r.degree == 0) {
            return he_ring_corrupt(f, err);
        }
        he_vec3 corner = he_vec3_scale(m->c.position[m->c.origin[first]], scale);
        if (!any) {
            about = corner;
            any = true;
        }
        /* The tetrahedra over a fan of triangles from p0 add up to p0 . A, whatever the other
         * corners: p0 . (p0 x q) is nothing. */
        add(&area, he_vec3_length(r.vector));
        add(&volume, he_vec3_dot(he_vec3_sub(corner, about), r.vector));
    }
    out->area = he_saturated(ldexp((area.sum + area.error) / 2, 2 * exponent));
    out->has_volume = m->c.boundary_halfedges == 0;
    double signed_volume = ldexp((volume.sum + volume.error) / 6, 3 * exponent);
    out->volume = out->has_volume ? he_clamped(signed_volume) : 0;
    return HE_OK;
}
