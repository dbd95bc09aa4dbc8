/* fill.h - closes holes by surfaces that continue what is around them. */
#ifndef HE_FILL_FILL_H
#define HE_FILL_FILL_H

#include "edit/border/hole.h"

/* The most faces that `edge_length` may ask for in one hole, and in all holes of a mesh together.
 * The equations for the surface take more time and memory than in proportion to the faces: 0.5 s
 * and 100 MB for 90,000 faces with HE_CONTINUOUS_TANGENT, 1.6 s and 200 MB with
 * HE_CONTINUOUS_CURVATURE, and 2.7 s and 300 MB, 11 s and 750 MB for 240,000 faces. All holes
 * together may also get as many faces as the mesh has. */
enum { HE_FILL_FACES = 100000, HE_FILL_ALL_FACES = 500000 };

/* How smoothly the new surface meets the mesh; the values are the orders of continuity. */
typedef enum he_continuity {
    HE_CONTINUOUS_POSITION,
    HE_CONTINUOUS_TANGENT,
    HE_CONTINUOUS_CURVATURE,
    HE_CONTINUITIES
} he_continuity;

typedef struct he_smooth_fill {
    /* The wanted length of the new edges, or 0 for that of the edges around the hole, growing
     * inwards in a hole that would get more than 50,000 faces otherwise. */
    double edge_length;
    he_continuity continuity;
} he_smooth_fill;

/* hole_fill with the method `smooth`: closes the hole to the left of the boundary half-edge h by
 * triangles about as large as those around it. The edges of the hole stay, and no vertex of the
 * mesh moves.
 *
 *        o-----o-----o            o-----o-----o
 *        |     |     |            | \   |  /  |
 *        o-----o-----o            o--- o-- o--o         V + k, E + n + 3k - 3, F + n + 2k - 2
 *        |           |    --->    |  / | \ | /|         for n edges and k new vertices
 *        o           o            o -- o - o--o
 *        |           |            | \  | / |\ |
 *        o-----o-----o            o-----o-----o
 *
 * STEPS. The hole is covered by triangles between its corners, of the least area and bend; these
 * are divided until their edges are as long as wanted; then the new vertices are moved so that the
 * surface is k-harmonic (Liepa, Filling holes in meshes, 2003; Botsch and Kobbelt, An intuitive
 * framework for real-time freeform modeling, 2004). A hole in a plane stays in the plane. The
 * surface may cross other parts of the mesh.
 *
 * New vertices get harmonic values in attributes of vertices that are interpolated, and those of a
 * near corner of the hole in attributes that are copied. New edges and faces have no parents.
 *
 * `out` may be NULL; otherwise he_filled_clear frees it.
 * Returns HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_BOUNDARY or HE_REPEATED_CORNER as
 * he_hole_fill does. Returns HE_BAD_VALUE if `edge_length` is not finite or below 0.
 * Returns HE_LIMIT if `edge_length` asks for more than HE_FILL_FACES faces. This is found out
 * before the equations are made, mostly before any other work. Returns HE_NO_MEMORY,
 * HE_IDS_EXHAUSTED or HE_CANCELLED. */
HE_NODISCARD he_status he_hole_fill_smooth(he_mesh *m, he_halfedge h, const he_smooth_fill *options,
                                           he_filled *out, he_error *err);

/* Returns about how many faces he_hole_fill_smooth makes at least for the hole of h, or 0 if h is
 * not a boundary half-edge or the size of the hole is not finite. Walks around the hole, but takes
 * no more than *steps steps, and subtracts from *steps those that it took. */
double he_fill_foretell(const he_mesh *m, he_halfedge h, const he_smooth_fill *options,
                        uint64_t *steps);

/* --- all holes --- */

/* The methods of he_hole_fill, and that of he_hole_fill_smooth. */
typedef enum he_fill_method {
    HE_FILL_ALL_POLYGON,
    HE_FILL_ALL_FAN,
    HE_FILL_ALL_TRIANGULATE,
    HE_FILL_ALL_SMOOTH
} he_fill_method;

/* Returns the method of he_hole_fill; `method` must not be HE_FILL_ALL_SMOOTH. */
he_fill he_fill_of(he_fill_method method);

typedef struct he_fill_holes_options {
    he_fill_method method;
    he_smooth_fill smooth; /* for HE_FILL_ALL_SMOOTH */
    uint32_t max_edges;    /* holes with more edges are left; 0: none is left for that */
    double max_size; /* holes with a larger box, measured along its diagonal, are left; 0: none */
} he_fill_holes_options;

typedef struct he_filled_holes {
    uint32_t filled;
    /* How many holes are left: because they are too large; because their loop passes a vertex
     * twice; because one face lies around them; because each filling would double an edge. */
    uint32_t large, touching, single, doubled;
    he_ids left; /* a half-edge of each hole that is left */
    double
        bend; /* the largest angle between the normals beside an edge of a filled hole; radians */
} he_filled_holes;

/* fill_holes: fills every hole, each like hole_fill. A hole that cannot be filled is left, and so
 * is the only hole around a component of a single face.
 *
 * `out` may be NULL; otherwise he_filled_holes_clear frees it.
 * Returns HE_BAD_VALUE if a number is not finite or below 0.
 * Returns HE_LIMIT if `edge_length` asks for more than HE_FILL_FACES faces in a hole, or if the
 * method smooth would fill all holes together with more faces than HE_FILL_ALL_FACES and than the
 * mesh has. Returns HE_NO_MEMORY, HE_IDS_EXHAUSTED or HE_CANCELLED; no hole is filled then. */
HE_NODISCARD he_status he_fill_holes(he_mesh *m, const he_fill_holes_options *options,
                                     he_filled_holes *out, he_error *err);
void he_filled_holes_clear(he_filled_holes *filled);

/* Returns about how many faces he_fill_holes makes at most, from the number of boundary half-edges
 * and the lengths of a few edges: as if all boundaries were circles of as many edges as
 * `max_edges` allows. Takes no longer for a large mesh. */
double he_fill_holes_foretell(const he_mesh *m, const he_fill_holes_options *options);

/* Returns the largest angle between the normals of the two faces of the listed half-edges, in
 * radians. */
double he_fill_bend(const he_mesh *m, const he_ids *loop);

#endif
