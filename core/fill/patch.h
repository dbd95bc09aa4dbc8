/* patch.h - the surface that fills one hole, while it is made.
 *
 * A PATCH is a surface of triangles in flat arrays of its own. Its first `rim` vertices are the
 * corners of the hole, in the order of the hole's loop; the others are new. Side 3 t + k of
 * triangle t runs from its corner k to its corner k + 1 (of 3), counter-clockwise, and `twins` has
 * the side that runs in the opposite direction. A side from rim vertex i to rim vertex i + 1
 * without a twin is where the patch meets the mesh, at half-edge i of the loop:
 *
 *          mesh        loop[i]
 *     ------ o ------------------> o ------
 *            i \                 / i + 1
 *                \    patch    /
 *                  \         /
 *                    \     /
 *                       o
 *
 * COORDINATES are relative to the first corner of the hole, in units of a power of two about as
 * large as the hole, so that no product of coordinates leaves the range of a double, and a hole far
 * from the origin loses no digits. */
#ifndef HE_FILL_PATCH_H
#define HE_FILL_PATCH_H

#include "fill/fill.h"

#include "base/mem.h"
#include "geometry/edge_lookup.h"
#include "geometry/vec3.h"

/* Tells which corners of a hole an edge of the mesh joins already; {0} before the first hole. */
typedef struct he_rim_chords {
    he_edge_lookup lookup; /* is made when a hole has a corner with many edges */
    bool made;
} he_rim_chords;

typedef struct he_patch {
    const he_mesh *mesh;
    const he_rim_chords *chords;
    const uint32_t *loop; /* the half-edges of the hole; borrowed */
    uint32_t rim;
    uint32_t vertices, vertex_room, triangles, triangle_room;
    he_vec3 *at;       /* the position of each vertex */
    double *size;      /* the wanted length of edges at each vertex */
    uint32_t *degree;  /* the number of triangles around each vertex */
    uint32_t *corner;  /* for each vertex: a corner of the hole near it */
    uint32_t *corners; /* three vertices of each triangle */
    uint32_t *twins;   /* UINT32_MAX: none */
    /* The unit normal of the mesh on the other side of each half-edge of the loop; zero if there
     * is none. */
    he_vec3 *beyond;
    he_vec3 base; /* the position of the first corner */
    double unit;  /* the length that is 1 in the coordinates of the patch */
    double left;  /* how many faces the patch may get, as several holes share a limit */
} he_patch;

/* Makes a patch of the corners of a hole, without triangles. he_patch_clear frees it, also after a
 * failure. Makes the lookup of `chords` if the hole has a corner with many edges.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_patch_make(const he_mesh *m, const he_ids *loop, he_rim_chords *chords,
                                     he_patch *out, he_error *err);
void he_patch_clear(he_patch *p);
/* Returns a position of the mesh in the coordinates of the patch, and the reverse. */
he_vec3 he_patch_inside(const he_patch *p, he_vec3 position);
he_vec3 he_patch_outside(const he_patch *p, he_vec3 at);
/* Makes room for one more vertex and two more triangles.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_patch_reserve(he_patch *p, he_error *err);
/* Adds a vertex near a corner of the hole, and returns its number; there must be room. */
uint32_t he_patch_add_vertex(he_patch *p, he_vec3 at, double size, uint32_t corner);
/* Adds a triangle, for which there must be room, and returns its number. Its sides have no twins
 * yet. */
uint32_t he_patch_add_triangle(he_patch *p, uint32_t a, uint32_t b, uint32_t c);
/* Finds the twins of all sides.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_patch_pair(he_patch *p, he_error *err);
/* Returns true if an edge of the mesh joins two corners of the hole that are not neighbours in it.
 */
bool he_patch_is_chord(const he_patch *p, uint32_t a, uint32_t b);

static inline uint32_t he_patch_next(uint32_t side)
{
    return side % 3 == 2 ? side - 2 : side + 1;
}
static inline uint32_t he_patch_prev(uint32_t side)
{
    return side % 3 == 0 ? side + 2 : side - 1;
}
/* Returns the vector whose direction is the normal of a triangle, and whose length is twice its
 * area. */
static inline he_vec3 he_triangle_normal(he_vec3 a, he_vec3 b, he_vec3 c)
{
    return he_vec3_cross(he_vec3_sub(b, a), he_vec3_sub(c, a));
}

/* The steps in which a patch is made, each in a file of its own. */

/* Covers the hole by triangles between its corners, choosing those of the least area and the least
 * bend. If none are found without an edge that the mesh has already, the triangles go around a new
 * vertex in the middle. The area A and the bend at an edge count by the sum of A and of
 * l^2 (1 - cos a) / 2, where l is the length of the edge and a the angle between the normals beside
 * it; the sum is made the least by dynamic programming over the parts of the loop (Barequet and
 * Sharir, Filling gaps in the boundary of a polyhedron, 1995; Liepa, Filling holes in meshes,
 * 2003). That takes the third power of the number of corners, so a hole of more than HE_COVER_LOOP
 * edges is first cut, along chords between HE_COVER_PARTS + 1 of its corners: twice as many would
 * take eight times as long, and what is built on the cover would come out no better.
 * Returns HE_NO_MEMORY or HE_CANCELLED. */
enum { HE_COVER_LOOP = 64, HE_COVER_PARTS = 31 };
HE_NODISCARD he_status he_patch_cover(he_patch *p, he_error *err);

/* Adds vertices until edges are about as long as wanted, or `coarseness` times as long. They should
 * have the length `edge_length`, in the coordinates of the patch, or, if it is 0, that of the
 * mesh's edges at the rim; then they grow towards the middle of a hole that would get too many
 * faces otherwise. Edges are flipped as he_patch_relax does (Liepa 2003). Returns HE_LIMIT if
 * `edge_length` asks for more than HE_FILL_FACES faces, or the patch would get more than `left`;
 * returns HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status he_patch_refine(he_patch *p, double edge_length, double coarseness,
                                       he_error *err);

/* Flips edges of which the opposite angles add up to more than 180 degrees, unless the surface
 * would fold or get a doubled edge. Returns HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status he_patch_relax(he_patch *p, he_error *err);

/* Moves the new vertices so that the patch is as smooth as `continuity` says: 0, it meets the mesh;
 * 1, also its tangent planes do; 2, also its curvature (harmonic.h). If the equations have no
 * solution in doubles, those of less continuity are taken.
 * Returns HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status he_patch_fair(he_patch *p, unsigned continuity, he_error *err);

/* Returns true if work must end because of lack of memory or because it was cancelled, and then
 * copies the error `why` to `err`, which may be NULL. Any other failure to solve equations has a
 * way around it. */
bool he_patch_must_stop(he_status status, const he_error *why, he_error *err);

/* Finds the values that the new vertices get in the attribute columns of vertices: harmonic ones
 * where the rule is interpolate, those of a near corner of the hole where it is copy. `values` has,
 * for each column of the mesh, NULL or an array of one value for each new vertex.
 * The caller frees it with he_patch_values_clear.
 * Returns HE_NO_MEMORY or HE_CANCELLED. */
typedef struct he_patch_values {
    unsigned char **columns;
    size_t count;
} he_patch_values;
HE_NODISCARD he_status he_patch_values_find(const he_patch *p, he_patch_values *out, he_error *err);
void he_patch_values_clear(he_patch_values *values);

/* Writes the patch into the mesh, and lists the new elements.
 * Returns HE_NO_MEMORY or HE_IDS_EXHAUSTED; the mesh is then as it was. */
HE_NODISCARD he_status he_patch_write(he_mesh *m, const he_patch *p, const he_patch_values *values,
                                      he_ids *edges, he_ids *faces, he_error *err);

/* What the holes that one operation fills have in common. */
typedef struct he_fill_shared {
    he_rim_chords chords; /* he_edge_lookup_clear frees its lookup */
    double left;          /* how many faces may still be made */
    bool phases;          /* the steps of a patch are phases of the progress */
} he_fill_shared;

/* Does what he_hole_fill_smooth does after its checks: fills the hole that has this loop. Subtracts
 * the faces that it makes from shared->left. The mesh is as it was after a refusal.
 * Returns HE_LIMIT if the hole would get more than HE_FILL_FACES or shared->left faces.
 * Returns HE_NO_MEMORY, HE_IDS_EXHAUSTED or HE_CANCELLED. */
HE_NODISCARD he_status he_fill_loop(he_mesh *m, const he_ids *loop, const he_smooth_fill *options,
                                    he_fill_shared *shared, he_filled *out, he_error *err);

/* Refuses the faces that `edge_length`, a length in the mesh, asks for in one hole: returns
 * HE_LIMIT if they are more than HE_FILL_FACES. */
HE_NODISCARD he_status he_fill_within(double faces, double edge_length, he_error *err);
/* Returns how many faces the method smooth may make in all holes of a mesh. */
double he_fill_most(const he_mesh *m);
/* Refuses faces that all holes together would get: returns HE_LIMIT if they are more than `left`.
 */
HE_NODISCARD he_status he_fill_within_all(double faces, double left, he_error *err);

#endif
