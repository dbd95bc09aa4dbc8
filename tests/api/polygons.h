/* polygons.h - a small mesh as lists of corners, in which everything is found by searching.
 *
 * It is slow and obvious, and the answers of the API are compared with it. Where the design leaves
 * a choice, pg_learn takes it from the API and checks that it is allowed: the half-edge that a
 * vertex or face stores, and the order in which boundary links connect the fans of a bow-tie. */
#ifndef TESTS_API_POLYGONS_H
#define TESTS_API_POLYGONS_H

#include <stdbool.h>
#include <stddef.h>

enum { PG_VERTICES = 64, PG_FACES = 64, PG_CORNERS = 16, PG_HALFEDGES = 400 };
#define PG_NONE ((unsigned)-1)

typedef struct pg_list {
    unsigned ids[PG_HALFEDGES];
    unsigned count;
} pg_list;

typedef struct pg_mesh {
    unsigned vertices, faces, halfedges;
    double position[PG_VERTICES][3];
    unsigned corners[PG_FACES][PG_CORNERS], degree[PG_FACES];
    unsigned origin[PG_HALFEDGES], face[PG_HALFEDGES], next[PG_HALFEDGES], prev[PG_HALFEDGES];
    unsigned vertex_first[PG_VERTICES], face_first[PG_FACES];
} pg_mesh;

/* Makes a mesh from faces, each a string of one-digit vertices, as in "012,023"; the mesh has at
 * least `vertices` vertices. Edges are numbered in the order in which the faces name them, and each
 * edge is directed as in the first face that has it. */
void pg_make(pg_mesh *pg, const char *faces, unsigned vertices);
/* Makes a mesh from any list of corners: PG_NONE ends a face. */
void pg_make_corners(pg_mesh *pg, const unsigned *corners, size_t count, unsigned vertices);

/* Records which half-edge the API has chosen to store with a vertex or a face; fails the test if
 * this half-edge is not allowed. */
void pg_learn_vertex(pg_mesh *pg, unsigned v, unsigned halfedge);
void pg_learn_face(pg_mesh *pg, unsigned f, unsigned halfedge);
void pg_learn_next(pg_mesh *pg, unsigned h, unsigned next);

/* An element, such as the "vertex" 3. */
typedef struct pg_element {
    const char *kind;
    unsigned id;
} pg_element;

/* Finds the elements in a relation to an element: `what` names the relation, as in "faces" of the
 * "vertex" 3. */
void pg_relation(const pg_mesh *pg, pg_element of, const char *what, bool clockwise, pg_list *out);
bool pg_is_isolated(const pg_mesh *pg, unsigned v);
bool pg_is_boundary(const pg_mesh *pg, unsigned v);
unsigned pg_fans(const pg_mesh *pg, unsigned v);
double pg_length(const pg_mesh *pg, unsigned e);
/* Returns the area of a face; `out` becomes its area vector, half of the sum of p[i] x p[i + 1]. */
double pg_area(const pg_mesh *pg, unsigned f, double out[3]);

/* A breadth-first walk from a vertex along edges or from a face across them: `depth` is its maximum
 * number of steps, `limit` its maximum number of elements, 0: no limit. */
typedef struct pg_flood {
    pg_element from;
    unsigned depth, limit;
} pg_flood;
void pg_breadth_first(const pg_mesh *pg, const pg_flood *flood, pg_list *ids, pg_list *depths);
/* Finds the distances between all pairs of vertices, in edges or by length; HUGE_VAL: not
 * connected. */
void pg_distances(const pg_mesh *pg, bool by_length, double out[PG_VERTICES][PG_VERTICES]);
/* Finds the edges of the loop through `edge`, which goes straight on at vertices of four edges, or
 * of its ring, which goes across faces of four sides. */
void pg_edges(const pg_mesh *pg, bool ring, unsigned edge, pg_list *out, bool *closed);
/* Finds the boundary loops. Each starts with its lowest half-edge, and the loops are in the order
 * of these. Returns the number of loops. */
unsigned pg_boundaries(const pg_mesh *pg, pg_list loops[PG_FACES]);
/* Finds for each face the lowest face in its connected component. */
void pg_components(const pg_mesh *pg, bool by_vertex, unsigned lowest[PG_FACES]);

#endif
