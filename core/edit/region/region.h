/* region.h - faces drawn off their surroundings along their rim, which face_extrude and face_inset
 * share: they differ in where the new vertices go.
 *
 * A region is a set of faces connected across edges. Its rim are the half-edges inside it beside
 * which it ends, at other faces or at a hole. Each rim corner gets a new vertex, which takes the
 * region's faces over, and each rim half-edge a quad between old and new:
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
 * V + r, E + 2r, F + r for a rim of r half-edges, of one loop or of several. The faces keep their
 * ids, the edges between them too; what was beside the rim keeps the old vertices and edges. For
 * rim half-edge i, from a to b, in the order of the region's faces and of each face's corners from
 * its stored half-edge on:
 *
 *     new vertex i      above a; descends from a and has its values by rule
 *     new edge 2i       its half-edge 2e runs above the rim half-edge, inside the region; descends
 *                       from that edge and has its values by rule
 *     new edge 2i + 1   its half-edge 2e runs from a to the new vertex
 *     new face i        the quad, whose stored half-edge is the rim's; descends from the face there
 *
 * Corner values follow the corners of the region's faces; a quad has copies of those beside it.
 *
 * Two fans of a bow-tie at the rim, and the rings about what was outside, stay as they are: at an
 * old vertex two quads take the place of the region's faces, and at a new one they close the fan.
 * So no edge is doubled and no fan closes beside another.
 *
 * Refused: HE_NO_RIM naming a face, for a whole closed component; HE_RIM_MEETS_ITSELF naming a
 * vertex which the rim of one region passes twice; HE_LOCKED_ELEMENT for a face with a corner on
 * the rim, for an edge between two faces of the region with an end there, and for a vertex inside
 * that moves. */
#ifndef HE_EDIT_REGION_REGION_H
#define HE_EDIT_REGION_REGION_H

#include "mesh/mesh.h"
#include "query/idmap.h"

typedef struct he_region {
    he_idmap faces;   /* breadth-first from the one listed first */
    he_idmap corners; /* vertices of the rim; the index is that of the half-edge that leaves it */
    he_ids rim;
    he_ids inner, inner_at; /* other half-edges inside that leave the rim, and their corner */
} he_region;

/* What the interpolated values of a new vertex are made of: `mean` of the mean of the corners of
 * the face of `in`, which leaves the vertex below it, `side` of `beside`, and else of that vertex.
 */
typedef struct he_region_mix {
    he_halfedge in;
    he_vertex beside;
    double mean, side; /* 0 or more, and 1 at most together */
} he_region_mix;

/* Where the new vertices go: fill `to`, one for each corner of the rim. `*shift` is what the
 * vertices inside the region move by, when `*shifts` is set. May refuse. `mix` is for each what it
 * is made of, after `to`; without it all have the values of those below them. */
typedef struct he_region_place {
    he_status (*place)(const he_mesh *m, const he_region *region, void *context, he_vec3 *to,
                       he_vec3 *shift, bool *shifts, he_error *err);
    void *context;
    he_status (*mix)(const he_mesh *m, const he_region *region, const he_vec3 *to,
                     he_region_mix *out, he_error *err);
} he_region_place;

/* What was made, in order; {0} at first. */
typedef struct he_region_parts {
    he_ids vertices, edges, faces;
} he_region_parts;

void he_region_parts_clear(he_region_parts *parts);

/* Draw off the listed faces, each by itself, or with `joined` those that are connected across edges
 * as one region. All or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, the
 * refusals above and of `place`, HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL, else
 * he_region_parts_clear frees it. Costs what lies about the corners of the faces. */
HE_NODISCARD he_status he_region_draw(he_mesh *m, const uint32_t *faces, size_t count, bool joined,
                                      he_region_place place, he_region_parts *out, he_error *err);

#endif
