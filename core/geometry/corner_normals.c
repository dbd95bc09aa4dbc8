#include "base/parallel.h"
#include "geometry/geometry.h"
#include "geometry/scale.h"
#include "mesh/walk.h"

/* A half-edge that leaves a vertex, and the normal of the face to the left of the half-edge. The
 * corners around a vertex are divided into groups; all corners of a group get one common normal. */
typedef struct corner {
    uint32_t halfedge;
    uint32_t group; /* number of the corner's group; HE_NONE for a boundary half-edge */
    he_vec3 normal; /* normal of the face; zero if the face is degenerate */
    bool degenerate;
} corner;

typedef struct fan {
    corner *corners; /* the half-edges that leave the vertex, counter-clockwise */
    /* for each group, the sum of the normals of its faces, weighted by the angles of the corners */
    he_vec3 *sums;
    size_t count, capacity;
    double crease;
} fan;

static void clear(fan *f)
{
    he_mem_free(f->corners);
    he_mem_free(f->sums);
}

static he_status grow(fan *f, he_error *err)
{
    size_t grown = he_mem_grown(f->capacity, f->count + 1);
    corner *corners = he_mem_array(f->corners, grown, sizeof *corners);
    if (corners != NULL) {
        f->corners = corners;
    }
    he_vec3 *sums = he_mem_array(f->sums, grown, sizeof *sums);
    if (sums != NULL) {
        f->sums = sums;
    }
    if (corners == NULL || sums == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the corners around a vertex");
    }
    f->capacity = grown;
    return HE_OK;
}

/* Lists the corners around a vertex in f->corners, beginning with the half-edge `first`. `normals`
 * has the normals of all faces of the mesh; if `normals` is NULL, the function computes the normals
 * of the faces around the vertex. */
static he_status gather(fan *f, const he_mesh *m, uint32_t first, const he_vec3 *normals,
                        he_error *err)
{
    uint32_t h = first, end = 2u * m->c.edges.issued;
    f->count = 0;
    do {
        if (h >= end || f->count >= end) {
            return he_fail(err, HE_CORRUPT, HE_HALFEDGE, first,
                           "the mesh is damaged: the half-edges around the origin of half-edge %u "
                           "do not form a loop",
                           first);
        }
        if (f->count == f->capacity) {
            he_status status = grow(f, err);
            if (status != HE_OK) {
                return status;
            }
        }
        corner *c = &f->corners[f->count++];
        *c = (corner){.halfedge = h, .group = HE_NONE};
        uint32_t face = m->c.face[h];
        if (face < m->c.faces.issued) {
            c->group = 0;
            if (normals != NULL) {
                c->normal = normals[face];
            } else {
                he_face_normal(m, (he_face){face}, &c->normal);
            }
            c->degenerate = !(he_vec3_extent(c->normal) > 0);
        }
        h = m->c.prev[h] ^ 1u;
    } while (h != first);
    return HE_OK;
}

/* Divides the corners around a vertex into groups, and returns the number of groups. A new group
 * begins where the normals of two neighbouring faces differ by more than the crease angle, and
 * after each boundary half-edge. The list of corners is a ring: if the vertex is not on the
 * boundary, the last corner of the list is a neighbour of the first one. At a boundary vertex the
 * list begins with a boundary half-edge, which separates the first corner from the last one. */
static uint32_t find_groups(fan *f)
{
    /* `leader`: the first corner whose face has a normal; `last`: the latest corner, after the
     * latest boundary half-edge, whose face has a normal */
    const corner *last = NULL, *leader = NULL;
    uint32_t group = 0;
    bool closed = true;
    for (size_t i = 0; i < f->count; i++) {
        corner *c = &f->corners[i];
        if (c->group == HE_NONE) {
            closed = false;
            group += i > 0;
            last = NULL;
            continue;
        }
        if (!c->degenerate) {
            group += last != NULL && he_vec3_angle(last->normal, c->normal) > f->crease;
            leader = leader == NULL ? c : leader;
            last = c;
        }
        c->group = group;
    }
    if (!closed || group == 0 || last == NULL) {
        return group + 1;
    }
    bool merged = he_vec3_angle(last->normal, leader->normal) <= f->crease;
    for (size_t i = 0; i < f->count; i++) {
        corner *c = &f->corners[i];
        /* The corners of degenerate faces at the beginning of the list, before `leader`, get the
         * group of the last corner of the list, which is their neighbour in clockwise direction. */
        bool leads = c < leader;
        c->group = leads || (merged && c->group == group) ? (merged ? 0 : group) : c->group;
    }
    return group + 1;
}

static void sum_groups(fan *f, const he_mesh *m)
{
    uint32_t groups = find_groups(f);
    for (uint32_t g = 0; g < groups; g++) {
        f->sums[g] = (he_vec3){0, 0, 0};
    }
    for (size_t i = 0; i < f->count; i++) {
        const corner *c = &f->corners[i];
        if (c->group != HE_NONE && !c->degenerate) {
            double angle = he_corner_angle(m, (he_halfedge){c->halfedge});
            f->sums[c->group] = he_vec3_add(f->sums[c->group], he_vec3_scale(c->normal, angle));
        }
    }
}

he_status he_corner_normal(const he_mesh *m, he_halfedge h, double crease, he_vec3 *out,
                           he_error *err)
{
    /* The walk around the vertex starts from the half-edge that the vertex stores, as in
     * he_corner_normals, so that normals are added up in one order and the results are equal. */
    fan f = {.crease = crease};
    he_status status = gather(&f, m, m->c.vertex_halfedge[m->c.origin[h.i]], NULL, err);
    if (status == HE_OK) {
        he_vec3 normal = {0, 0, 0};
        sum_groups(&f, m);
        for (size_t i = 0; i < f.count; i++) {
            if (f.corners[i].halfedge == h.i && f.corners[i].group != HE_NONE) {
                he_vec3_normalise(f.sums[f.corners[i].group], &normal);
            }
        }
        *out = normal;
    }
    clear(&f);
    return status;
}

typedef struct corners {
    const he_mesh *m;
    double crease;
    const he_vec3 *normals; /* the normal of each face of the mesh */
    he_vec3 *out;
} corners;

static he_status clear_range(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const corners *all = context;
    (void)part;
    (void)err;
    for (size_t h = from; h < to; h++) {
        all->out[h] = (he_vec3){0, 0, 0};
    }
    return HE_OK;
}

/* Computes the normals of the corners at the vertices from `from` to `to` - 1. Several threads run
 * this function at once, for different vertices. They do not interfere, because each corner is at
 * one vertex and so only one thread writes its normal. */
static he_status vertex_range(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const corners *all = context;
    fan f = {.crease = all->crease};
    he_status status = HE_OK;
    (void)part;
    for (size_t v = from; v < to && status == HE_OK; v++) {
        uint32_t first = all->m->c.vertex_halfedge[v];
        if (first == HE_NONE || first == HE_DEAD) {
            continue;
        }
        status = gather(&f, all->m, first, all->normals, err);
        if (status != HE_OK) {
            break;
        }
        sum_groups(&f, all->m);
        for (size_t i = 0; i < f.count; i++) {
            const corner *c = &f.corners[i];
            if (c->group != HE_NONE) {
                he_vec3_normalise(f.sums[c->group], &all->out[c->halfedge]);
            }
        }
    }
    clear(&f);
    return status;
}

he_status he_corner_normals(const he_mesh *m, double crease, he_progress *progress, he_vec3 *out,
                            he_error *err)
{
    he_vec3 *normals = he_mem_array(NULL, m->c.faces.issued, sizeof *normals);
    corners all = {m, crease, normals, out};
    he_status status = HE_OK;
    if (normals == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the normals of faces");
    }
    status = he_face_normals(m, progress, normals, err);
    if (status == HE_OK) {
        status = he_run_ranges(progress, 2 * (size_t)m->c.edges.issued, clear_range, &all, err);
    }
    if (status == HE_OK) {
        status = he_run_ranges(progress, m->c.vertices.issued, vertex_range, &all, err);
    }
    he_mem_free(normals);
    return status;
}
