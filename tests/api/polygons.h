/* polygons.h - a small mesh stored as lists of corners, without links: all neighbours are found by
 * searching.
 *
 * The searches are slow but obviously right, so that the answers of the API can be checked against
 * their results. Where the API has a choice, pg_learn_vertex, pg_learn_face and pg_learn_next
 * record the choice of the API and check that the choice is allowed: the half-edge that a vertex or
 * face stores, and the order in which boundary links connect the fans of faces at a bow-tie. */
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
/* Makes a mesh from faces, each a list of vertices that ends in PG_NONE; `corners` has these lists
 * one after another. */
void pg_make_corners(pg_mesh *pg, const unsigned *corners, size_t count, unsigned vertices);

/* Records which half-edge the API has chosen to store with a vertex or a face; fails the test if
 * this half-edge is not allowed. */
void pg_learn_vertex(pg_mesh *pg, unsigned v, unsigned halfedge);
void pg_learn_face(pg_mesh *pg, unsigned f, unsigned halfedge);
void pg_learn_next(pg_mesh *pg, unsigned h, unsigned next);

/* An element of the mesh; for vertex 3, `kind` is "vertex" and `id` is 3. */
typedef struct pg_element {
    const char *kind;
    unsigned id;
} pg_element;

/* Finds the elements that are in the relation `what` to the element `of`, such as the "faces" of
 * vertex 3. */
void pg_relation(const pg_mesh *pg, pg_element of, const char *what, bool clockwise, pg_list *out);
bool pg_is_isolated(const pg_mesh *pg, unsigned v);
bool pg_is_boundary(const pg_mesh *pg, unsigned v);
unsigned pg_fans(const pg_mesh *pg, unsigned v);
double pg_length(const pg_mesh *pg, unsigned e);
/* Returns the area of a face; `out` becomes its area vector, half of the sum of p[i] x p[i + 1]. */
double pg_area(const pg_mesh *pg, unsigned f, double out[3]);

/* A breadth-first walk that starts at a vertex and goes along edges, or starts at a face and goes
 * across edges. `depth` is the maximum number of steps, `limit` the maximum number of elements that
 * are found; a limit of 0 means no limit. */
typedef struct pg_flood {
    pg_element from;
    unsigned depth, limit;
} pg_flood;
void pg_breadth_first(const pg_mesh *pg, const pg_flood *flood, pg_list *ids, pg_list *depths);
/* Finds the distance between each two vertices, as a number of edges or by length; HUGE_VAL if no
 * path connects them. */
void pg_distances(const pg_mesh *pg, bool by_length, double out[PG_VERTICES][PG_VERTICES]);
/* Finds the edges of the edge loop through `edge` (it goes straight on at each vertex with four
 * edges), or, if `ring` is true, the edges of the edge ring through `edge` (it crosses each face
 * with four sides to the opposite side). */
void pg_edges(const pg_mesh *pg, bool ring, unsigned edge, pg_list *out, bool *closed);
/* Finds the boundary loops and returns their number. Each loop starts with its lowest half-edge,
 * and the loops are in the order of their lowest half-edges. */
unsigned pg_boundaries(const pg_mesh *pg, pg_list loops[PG_FACES]);
/* Writes for each face the lowest id of a face in the same connected component. */
void pg_components(const pg_mesh *pg, bool by_vertex, unsigned lowest[PG_FACES]);

#endif
