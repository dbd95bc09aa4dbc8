#include "query/defects.h"

#include "geometry/geometry.h"
#include "geometry/ring.h"
#include "mesh/walk.h"

static const struct {
    const char *name;
    he_kind kind;
} codes[HE_DEFECTS] = {
    [HE_DEFECT_BOWTIE] = {"bowtie", HE_VERTEX},
    [HE_DEFECT_ISOLATED] = {"isolated_vertex", HE_VERTEX},
    [HE_DEFECT_DUPLICATE] = {"duplicate_position", HE_VERTEX},
    [HE_DEFECT_SHORT] = {"zero_length_edge", HE_EDGE},
    [HE_DEFECT_DEGENERATE] = {"degenerate_face", HE_FACE},
    [HE_DEFECT_NONPLANAR] = {"nonplanar_face", HE_FACE},
    [HE_DEFECT_SMALL] = {"small_component", HE_FACE},
    [HE_DEFECT_INSIDE_OUT] = {"inside_out_component", HE_FACE},
    [HE_DEFECT_INTERSECTION] = {"self_intersection", HE_FACE},
};

const char *he_defect_name(he_defect_code code)
{
    return codes[code].name;
}

he_kind he_defect_kind(he_defect_code code)
{
    return codes[code].kind;
}

he_thresholds he_thresholds_of(const he_mesh *m)
{
    he_box box;
    double diagonal;
    (void)(he_surface_box(m, &box) || he_mesh_box(m, &box));
    he_direction(box.min, box.max, &diagonal);
    return (he_thresholds){1e-9 * diagonal, 1e-4 * diagonal, 1e-2 * diagonal, 0};
}

void he_defects_add(he_defects *defects, he_defect_code code, uint32_t id, uint32_t other,
                    double value)
{
    he_defect_list *list = &defects->of[code];
    if (list->count < HE_DEFECTS_LISTED) {
        list->listed[list->count++] = (he_defect_found){id, other, he_clamped(value)};
    }
    list->total++;
}

static he_status of_vertices(const he_mesh *m, he_progress *progress, he_defects *out,
                             he_error *err)
{
    he_status status = he_progress_phase(progress, "looking at vertices", 0.15, err);
    for (uint32_t v = 0; v < m->c.vertices.issued && status == HE_OK; v++) {
        status = he_progress_at(progress, v, m->c.vertices.issued, err);
        uint32_t h = m->c.vertex_halfedge[v];
        if (h == HE_NONE) {
            he_defects_add(out, HE_DEFECT_ISOLATED, v, HE_NONE, 0);
        } else if (h != HE_DEAD && m->c.face[h] == HE_NONE) {
            /* A fan is a run of faces around a vertex, each of which shares an edge with the next.
             * Only a vertex on the boundary can have several fans, so other vertices are
             * skipped. */
            uint32_t fans = he_vertex_fans(m, (he_vertex){v});
            if (fans > 1) {
                he_defects_add(out, HE_DEFECT_BOWTIE, v, HE_NONE, fans);
            }
        }
    }
    return status;
}

static he_status of_edges(const he_mesh *m, double merge, he_progress *progress, he_defects *out,
                          he_error *err)
{
    he_status status = he_progress_phase(progress, "looking at edges", 0.6, err);
    for (uint32_t e = 0; e < m->c.edges.issued && status == HE_OK; e++) {
        status = he_progress_at(progress, e, m->c.edges.issued, err);
        if (!he_edge_is_live(m, (he_edge){e})) {
            continue;
        }
        he_vec3 p = m->c.position[m->c.origin[2 * e]], q = m->c.position[m->c.origin[2 * e + 1]];
        if (he_vec3_extent(he_vec3_sub(p, q)) <= merge) {
            double length = he_edge_length(m, (he_edge){e});
            if (length <= merge) {
                he_defects_add(out, HE_DEFECT_SHORT, e, HE_NONE, length);
            }
        }
    }
    return status;
}

/* --- faces --- */

/* The mesh whose faces are measured, and the values that the functions below need. All lengths are
 * multiplied by `scale`, a power of two by which the mesh becomes about as large as the unit
 * cube. */
typedef struct measure {
    const he_mesh *m;
    int exponent;
    double scale, merge, flat, diagonal;
} measure;

static he_vec3 corner(const measure *s, uint32_t h)
{
    return he_vec3_scale(s->m->c.position[s->m->c.origin[h]], s->scale);
}

/* Returns the width of a face: twice its area divided by the length of its longest edge. */
static double width_of(const measure *s, uint32_t first, double area)
{
    double longest = 0;
    uint32_t h = first;
    do {
        uint32_t next = s->m->c.next[h];
        double length = he_vec3_length(he_vec3_sub(corner(s, next), corner(s, h)));
        longest = length > longest ? length : longest;
        h = next;
    } while (h != first);
    return longest > 0 ? 2 * area / longest : 0;
}

/* Returns the largest distance of a corner of a face from the plane through the point `about` with
 * the given normal. */
static double bulge_of(const measure *s, uint32_t first, he_vec3 about, he_vec3 normal)
{
    double most = 0;
    uint32_t h = first;
    do {
        double off = fabs(he_vec3_dot(he_vec3_sub(corner(s, h), about), normal));
        most = off > most ? off : most;
        h = s->m->c.next[h];
    } while (h != first);
    return most;
}

static void of_face(const measure *s, uint32_t f, he_defects *out)
{
    uint32_t first = s->m->c.face_halfedge[f], budget = he_ring_budget(s->m);
    int exponent; /* A length in the mesh is the length computed from `r` times 2^exponent. */
    he_ring r = he_ring_measure(s->m, first, &budget, &exponent);
    he_vec3 normal;
    bool degenerate = !he_ring_normal(&r, &normal);
    double area = ldexp(0.5 * he_vec3_length(r.vector), 2 * (exponent - s->exponent));
    if (degenerate || 2 * area <= s->merge * s->diagonal) {
        double width = width_of(s, first, area);
        if (degenerate || width <= s->merge) {
            he_defects_add(out, HE_DEFECT_DEGENERATE, f, HE_NONE, ldexp(width, s->exponent));
        }
    }
    if (degenerate || r.degree == 3) {
        return;
    }
    double n = r.degree;
    he_vec3 mean = {0, 0, 0};
    uint32_t h = first;
    do {
        mean = he_vec3_add(mean, he_vec3_scale(corner(s, h), 1 / n));
        h = s->m->c.next[h];
    } while (h != first);
    double bulge = bulge_of(s, first, mean, normal);
    if (bulge > s->flat) {
        he_defects_add(out, HE_DEFECT_NONPLANAR, f, HE_NONE, ldexp(bulge, s->exponent));
    }
}

static he_status of_faces(const he_mesh *m, const he_thresholds *t, he_progress *progress,
                          he_defects *out, he_error *err)
{
    he_box box;
    he_surface_box(m, &box);
    measure s = {.m = m};
    s.exponent = he_exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    s.scale = ldexp(1, -s.exponent);
    s.merge = ldexp(t->merge, -s.exponent);
    s.flat = ldexp(t->flat, -s.exponent);
    s.diagonal = he_vec3_length(
        he_vec3_sub(he_vec3_scale(box.max, s.scale), he_vec3_scale(box.min, s.scale)));
    he_status status = he_progress_phase(progress, "looking at faces", 0.8, err);
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        status = he_progress_at(progress, f, m->c.faces.issued, err);
        if (m->c.face_halfedge[f] != HE_DEAD) {
            of_face(&s, f, out);
        }
    }
    return status;
}

he_status he_defects_find(const he_mesh *m, const he_thresholds *thresholds, he_progress *progress,
                          he_defects *out, he_error *err)
{
    he_defects found = {0};
    he_status status = of_vertices(m, progress, &found, err);
    if (status == HE_OK) {
        status =
            he_defects_of_positions(m, thresholds->merge, thresholds->seed, progress, &found, err);
    }
    if (status == HE_OK) {
        status = of_edges(m, thresholds->merge, progress, &found, err);
    }
    if (status == HE_OK) {
        status = of_faces(m, thresholds, progress, &found, err);
    }
    if (status == HE_OK) {
        status = he_defects_of_components(m, thresholds->small, progress, &found, err);
    }
    if (status == HE_OK) {
        *out = found;
    }
    return status;
}
