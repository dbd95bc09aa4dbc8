/* region.h - detaches faces from their surroundings by a ring of quads along their rim. The edits
 * face_extrude and face_inset do this; they differ in where they put the new vertices.
 *
 * A region is a set of faces connected across edges. Its rim consists of the half-edges of these
 * faces whose twins belong to other faces or to a hole. Each vertex on the rim gets a new vertex,
 * which replaces it in the faces of the region. Each rim half-edge gets a quad between the old and
 * the new vertices:
 *
 *        o-------o-------o               o-------o-------o
 *        |       |       |               | \     |     / |
 *        |   f   |   g   |               |   o---o---o   |
 *        |       |       |               |   | f | g |   |
 *        o-------o-------o      --->     |   o---o---o   |
 *        |               |               | /           \ |
 *                                        o-------o-------o
 *                                        |               |
 *
 * V + r, E + 2r, F + r for a rim of r half-edges, of one loop or of several. The faces of the
 * region and the edges between them keep their ids; the surroundings keep the old vertices and
 * edges. For rim half-edge i, from a to b, in the order of the region's faces and of each face's
 * corners from its stored half-edge on:
 *
 *     new vertex i      replaces a in the region; descends from a and has values of a
 *     new edge 2i       its half-edge 2e belongs to the region's face; descends from the edge of
 *                       the rim half-edge and has values of that edge
 *     new edge 2i + 1   its half-edge 2e runs from a to the new vertex
 *     new face i        the quad, whose stored half-edge is the rim half-edge; descends from the
 *                       region's face there
 *
 * The corners of the region's faces keep their values; the corners of a quad copy the values of the
 * corners beside the quad.
 *
 * The fans of a bow-tie at the rim stay open or closed as they were: at an old vertex two quads
 * replace the region's faces, and at the new vertex these quads close the fan of the region's
 * faces. So no two edges join one pair of vertices, and no vertex gets a closed fan beside another
 * fan.
 *
 * Returns HE_NO_RIM naming a face, if a region is a whole closed component.
 * Returns HE_RIM_MEETS_ITSELF naming a vertex, if the rim of one region passes it twice.
 * Returns HE_LOCKED_ELEMENT if a face with a corner on the rim, an edge between two faces of the
 * region with an end on the rim, or a vertex inside that moves is locked. */
#ifndef HE_EDIT_REGION_REGION_H
#define HE_EDIT_REGION_REGION_H

#include "mesh/mesh.h"
#include "query/idmap.h"

typedef struct he_region {
    /* the region's faces in breadth-first order, from the face that the caller listed first */
    he_idmap faces;
    /* Maps each vertex of the rim to the index in `rim` of the rim half-edge that leaves it. */
    he_idmap corners;
    he_ids rim;
    /* `inner` lists the half-edges inside the region that leave vertices of the rim, without the
     * rim's own half-edges. inner_at.ids[i] is the index in `corners` of the vertex that
     * inner.ids[i] leaves. */
    he_ids inner, inner_at;
} he_region;

/* Says how the interpolated values of a new vertex are computed, as a weighted mean of three
 * values. Half-edge `in` leaves the old vertex, from which the new vertex descends. The mean of the
 * corners of the face of `in` has the weight `mean`, the vertex `beside` has the weight `side`, and
 * the old vertex has the weight 1 - mean - side. */
typedef struct he_region_mix {
    he_halfedge in;
    he_vertex beside;
    double mean, side; /* the two weights: each at least 0, their sum at most 1 */
} he_region_mix;

/* Callbacks of he_region_draw. `place` computes where the new vertices are: it fills `to` with one
 * position for each corner of the rim. If it sets *shifts, the vertices inside the region move by
 * the vector *shift. If it fails, the edit is refused. `mix`, if not NULL, is called after `to` is
 * filled and says how the values of each new vertex are computed; if it is NULL, each new vertex
 * has the values of the old vertex from which it descends. */
typedef struct he_region_place {
    he_status (*place)(const he_mesh *m, const he_region *region, void *context, he_vec3 *to,
                       he_vec3 *shift, bool *shifts, he_error *err);
    void *context;
    he_status (*mix)(const he_mesh *m, const he_region *region, const he_vec3 *to,
                     he_region_mix *out, he_error *err);
} he_region_place;

/* The new elements, in the order that the head of region.h describes; {0} at first. */
typedef struct he_region_parts {
    he_ids vertices, edges, faces;
} he_region_parts;

void he_region_parts_clear(he_region_parts *parts);

/* Detaches the listed faces from their surroundings: each face as a region of its own or, with
 * `joined`, each set of faces that are connected across edges as one region. If the edit is
 * refused, nothing changes. `out` may be NULL; otherwise he_region_parts_clear frees it. Takes time
 * linear in the elements at the corners of the faces.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_NO_RIM, HE_RIM_MEETS_ITSELF or HE_LOCKED_ELEMENT in the cases that the head of
 * region.h lists.
 * Returns the error of `place` if that callback refuses.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_region_draw(he_mesh *m, const uint32_t *faces, size_t count, bool joined,
                                      he_region_place place, he_region_parts *out, he_error *err);

#endif
