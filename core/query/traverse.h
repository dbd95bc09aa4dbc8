/* traverse.h - walks over a mesh from one of its elements.
 *
 * A walk takes time and memory proportional to what it touches: a mesh of millions of elements may
 * be walked a thousand times a second. Every walk is bounded by the number of half-edges; links
 * that lead nowhere or do not close give HE_CORRUPT. Elements named by the caller are refused with
 * HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT. Results are appended to lists, which on failure are as
 * they were; every function may return HE_NO_MEMORY. */
#ifndef HE_QUERY_TRAVERSE_H
#define HE_QUERY_TRAVERSE_H

#include "mesh/mesh.h"

/* A PATH follows a list of steps from a half-edge; the whole list is taken `repeat` times. */
typedef enum he_step { HE_STEP_NEXT, HE_STEP_PREV, HE_STEP_TWIN } he_step;
typedef enum he_until {
    HE_UNTIL_COUNT, /* the path ends only after its list of steps was taken `repeat` times */
    HE_UNTIL_START, /* the path also ends when it first returns to the half-edge `from` */
    /* The path also ends at the first half-edge without a face, or when the whole list of steps was
     * taken and led back to `from`. */
    HE_UNTIL_BOUNDARY
} he_until;

typedef struct he_path_steps {
    const he_step *list;
    size_t count;
    /* How many times the list of steps is taken; may be 0. UINT64_MAX is for paths that `until`
     * ends. */
    uint64_t repeat;
    /* condition at which the path ends; it is tested after each step, not before the first */
    he_until until;
    uint64_t limit; /* the most steps that may be taken; 0: no bound */
} he_path_steps;

/* Appends the half-edges of the path, beginning with `from`: one more than the steps taken. A path
 * with the condition HE_UNTIL_START or HE_UNTIL_BOUNDARY always ends: the list of steps maps
 * half-edges one to one, so after at most as many rounds as there are half-edges the path has
 * returned to `from`; if it has not, HE_CORRUPT is returned. `progress` may be NULL.
 * Returns HE_LIMIT if the path would take more steps than `limit`.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_BAD_VALUE if the list of steps is empty. */
HE_NODISCARD he_status he_traverse_path(const he_mesh *m, he_halfedge from,
                                        const he_path_steps *steps, he_progress *progress,
                                        he_ids *out, he_error *err);

/* LOOP. Appends the half-edges of the face or hole of `from`, in the order of next, beginning with
 * `from`. Their origins are the vertices of the loop. */
HE_NODISCARD he_status he_traverse_loop(const he_mesh *m, he_halfedge from, he_ids *out,
                                        he_error *err);

/* BREADTH FIRST from a vertex along edges, or from a face across edges. */
typedef struct he_breadth_first {
    he_kind kind;   /* HE_VERTEX or HE_FACE */
    uint32_t from;  /* the vertex or face where the walk begins */
    uint32_t depth; /* the greatest depth that is visited; HE_NONE: no bound */
    size_t limit;   /* the walk stops at so many elements, which is no error; 0: no bound */
} he_breadth_first;

/* Appends the elements in the order in which they are reached, neighbours counter-clockwise as in
 * adjacency.h, and their distances in steps; `from` is first, at depth 0.
 * Returns HE_BAD_VALUE if the walk begins at an element of another kind. */
HE_NODISCARD he_status he_traverse_breadth_first(const he_mesh *m, const he_breadth_first *walk,
                                                 he_ids *ids, he_ids *depths, he_error *err);

/* SHORTEST PATH along edges: how the length of a path is measured. */
typedef enum he_measure {
    HE_BY_EDGES, /* each edge counts 1 */
    HE_BY_LENGTH /* each edge counts its length */
} he_measure;

typedef struct he_path {
    bool found; /* false: no path joins the two vertices, which is no error */
    /* the vertices of the path, from `from` to `to`; a single one if these are equal */
    he_ids vertices;
    he_ids edges; /* the edges between successive vertices: one fewer than vertices */
    /* length of the path in the measure that the caller chose; DBL_MAX if it is too large for a
     * double */
    double length;
    uint64_t visited; /* number of half-edges that the search visited, also if no path was found */
} he_path;

/* Finds the shortest path by Dijkstra's algorithm (1959), with a heap in which a node has four
 * children, until the distance of `to` is final; HE_BY_EDGES makes it a breadth-first search. Which
 * of several shortest paths is found depends only on the links of the mesh, so it is the same on
 * every machine. The caller clears `out`. */
HE_NODISCARD he_status he_traverse_shortest_path(const he_mesh *m, he_vertex from, he_vertex to,
                                                 he_measure by, he_path *out, he_error *err);
void he_path_clear(he_path *path);

/* EDGE LOOP. Edges that go straight on through vertices of four edges:
 *
 *             |     |              the loop enters such a vertex by one edge and leaves by the
 *        o----o=====o=====o        second one after it. It ends at a vertex on the boundary and at
 *             |     |     ^ ends   one of any other degree; `*closed` says that it came back.
 *
 * Appends the edges in the order along the loop. A closed one begins with `from` and goes on in the
 * direction of half-edge 2e; an open one begins at the end that is opposite to that direction. An
 * edge between two such ends, like any on the boundary, is a loop of one edge. */
HE_NODISCARD he_status he_traverse_edge_loop(const he_mesh *m, he_edge from, he_ids *out,
                                             bool *closed, he_error *err);

/* EDGE RING. Edges that are opposite each other in faces of four sides:
 *
 *        o---o---o---o             it ends at the boundary and at a face of any other degree.
 *        ||  ||  ||  ||  ends
 *        o---o---o---o
 *
 * Appends the edges in order. A closed ring begins with `from` and goes on into the face of
 * half-edge 2e; an open one begins at its end on the other side, and ends beyond the face of 2e. */
HE_NODISCARD he_status he_traverse_edge_ring(const he_mesh *m, he_edge from, he_ids *out,
                                             bool *closed, he_error *err);

#endif
