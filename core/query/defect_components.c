/* defect_components.c - finds components that are small, or closed and inside out. */
#include "query/defects.h"

#include "geometry/geometry.h"
#include "geometry/ring.h"
#include "mesh/walk.h"
#include "query/topology.h"

#include <float.h>

typedef struct shell {
    uint32_t face; /* the component's face with the lowest id */
    bool open;
    /* Two opposite corners of the bounding box of the component. All lengths in this struct are in
     * coordinates of the mesh multiplied by `scale`. */
    double min[3], max[3];
    /* `volume` is six times the volume of the component; `reach` is at least the sum of the
     * absolute values of the terms of `volume` */
    double volume, reach;
} shell;

typedef struct survey {
    const he_mesh *m;
    int exponent;
    double scale;
    const uint32_t *component; /* component of each face */
    shell *shells;
} survey;

/* A volume smaller than this fraction of `reach` may be only rounding errors. */
static const double NOISE = 1e-10;

static he_vec3 corner(const survey *s, uint32_t h)
{
    return he_vec3_scale(s->m->c.position[s->m->c.origin[h]], s->scale);
}

static void include(shell *own, he_vec3 p)
{
    const double x[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        own->min[k] = x[k] < own->min[k] ? x[k] : own->min[k];
        own->max[k] = x[k] > own->max[k] ? x[k] : own->max[k];
    }
}

static void add_face(survey *s, uint32_t f)
{
    shell *own = &s->shells[s->component[f]];
    uint32_t first = s->m->c.face_halfedge[f], h = first;
    if (own->face == HE_NONE) {
        own->face = f;
    }
    he_vec3 apex = corner(s, first), vector = {0, 0, 0};
    do {
        uint32_t next = s->m->c.next[h];
        he_vec3 p = corner(s, h), q = corner(s, next);
        include(own, p);
        vector = he_vec3_add(vector, he_vec3_cross(he_vec3_sub(p, apex), he_vec3_sub(q, apex)));
        own->open |= s->m->c.face[h ^ 1u] == HE_NONE;
        h = next;
    } while (h != first);
    /* The volume is the sum of pyramids whose common apex is a point of the component. With an apex
     * far away, large positive and negative terms would cancel out. */
    he_vec3 from = he_vec3_sub(apex, corner(s, s->m->c.face_halfedge[own->face]));
    own->volume += he_vec3_dot(from, vector);
    own->reach += he_vec3_length(from) * he_vec3_length(vector);
}

static void judge(const survey *s, const shell *own, double small, he_defects *out)
{
    he_vec3 size = {own->max[0] - own->min[0], own->max[1] - own->min[1],
                    own->max[2] - own->min[2]};
    double diagonal = he_vec3_length(size);
    if (diagonal <= ldexp(small, -s->exponent)) {
        he_defects_add(out, HE_DEFECT_SMALL, own->face, HE_NONE, ldexp(diagonal, s->exponent));
    }
    if (!own->open && own->volume < -NOISE * own->reach) {
        he_defects_add(out, HE_DEFECT_INSIDE_OUT, own->face, HE_NONE,
                       ldexp(own->volume / 6, 3 * s->exponent));
    }
}

he_status he_defects_of_components(const he_mesh *m, double small, he_progress *progress,
                                   he_defects *out, he_error *err)
{
    he_box box;
    uint32_t *component = NULL, count = 0;
    he_surface_box(m, &box);
    survey s = {.m = m};
    s.exponent = he_exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    s.scale = ldexp(1, -s.exponent);
    he_status status = he_progress_phase(progress, "looking at components", 1, err);
    if (status == HE_OK) {
        status = he_components_label(m, &component, &count, err);
    }
    if (status != HE_OK) {
        return status;
    }
    s.component = component;
    s.shells = he_mem_array(NULL, count, sizeof *s.shells);
    if (s.shells == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to measure %u components", count);
    }
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        s.shells[i] = (shell){.face = HE_NONE,
                              .min = {DBL_MAX, DBL_MAX, DBL_MAX},
                              .max = {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    }
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        status = he_progress_at(progress, f, m->c.faces.issued, err);
        if (m->c.face_halfedge[f] != HE_DEAD) {
            add_face(&s, f);
        }
    }
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        judge(&s, &s.shells[i], small, out);
    }
    he_mem_free(component);
    he_mem_free(s.shells);
    return status;
}
