/* oracle.h - a mesh without half-edges: slow, obvious, and written from the specification of the
 * operations alone.
 *
 * The oracle knows three lists: vertices with a position, faces as cycles of vertex ids, edges as
 * pairs of vertex ids (the first is the origin of half-edge 2e). There are no links. Everything
 * else is computed again after each operation by visiting every face:
 *
 *     left[a][b]    the face that runs from a to b, OR_NONE when none does
 *     joined[a][b]  the edge between a and b, OR_NONE when none does
 *     around[a]     the degree[a] vertices b for which there is left[a][b] or left[b][a]
 *
 * An operation of the oracle returns the set of all refusals that apply, one bit per status; the
 * set is empty on success. If several apply, hedge may report any of them.
 *
 * New vertices get the next id. New faces and edges have no ids at first, since the specification
 * does not order them: or_adopt finds them in hedge's mesh by their corners and ends. Who survives
 * is specified, so ids that were there before are compared by id.
 *
 * The oracle does not track locks and features: the test passes them before each operation.
 *
 * The tables hold a fan of a thousand triangles and edits of it (OR_VERTICES and so on); the model
 * test starts a new mesh before they are full. Only rows in use are visited, so a small mesh takes
 * little time. */
#ifndef TESTS_ORACLE_ORACLE_H
#define TESTS_ORACLE_ORACLE_H

#include "mesh/mesh.h"

/* Sizes of the tables. A row of `left` or `joined` has an odd number of cache lines, so that the
 * entries of one column fall into different cache sets. */
enum { OR_VERTICES = 2352, OR_EDGES = 10000, OR_FACES = 6000, OR_CORNERS = 1200, OR_LIST = 1200 };

#define OR_NONE        UINT32_MAX
#define OR_BIT(status) (UINT64_C(1) << (unsigned)(status))

typedef struct or_vertex {
    bool alive;
    bool locked;
    /* Whether the oracle computed `at` with rounding: hedge's position may differ from `at` within
     * a tolerance, and replaces it after the comparison. */
    bool near;
    bool inside; /* whether hedge may choose `at`: any position in the box from `low` to `high` is
                    correct */
    he_vec3 at, low, high;
} or_vertex;

typedef struct or_edge {
    bool alive, locked, feature;
    uint32_t a, b;
} or_edge;

typedef struct or_face {
    bool alive, locked;
    uint32_t count;
    uint32_t v[OR_CORNERS];
} or_face;

typedef struct or_mesh {
    uint32_t vertices, edges, faces; /* numbers of ids issued */
    /* Number of faces in `face` that have no ids yet; they come after the first `faces`. */
    uint32_t fresh;
    /* Faces that hedge may cut in several ways: into triangles or, by plane_split, into parts that
     * each lie on one side of the plane. `was` is the face before the cut; `id` is OR_NONE for a
     * hole that is filled, since then all triangles are new. For plane_split, or_adopt adds the new
     * vertices to `was`. */
    struct {
        uint32_t id, start;
        or_face was;
    } cut[OR_LIST];
    uint32_t cuts;
    bool by_plane;
    bool chosen[OR_FACES];        /* faces that plane_split cuts */
    double distance[OR_VERTICES]; /* distance of each vertex from the plane; 0 in the plane */
    /* The refusals that depend on how hedge cut the faces in `cut`, or on rounding: hedge may
     * report one of them or succeed. `before` is a copy of the oracle's lists from before the
     * operation, restored if hedge refuses; NULL if the operation has changed nothing. */
    uint64_t may;
    struct or_lists *before;
    /* Whether the operation (loop_bridge) joins the two loops in `bridge` by new faces that hedge
     * may choose. */
    bool bridging;
    or_face bridge[2]; /* the two loops, in the direction around their holes */
    /* If both loops of `bridge` have equally many vertices: the least twist (sum of the squared
     * lengths of the new edges) of all ways to join them without doubling an edge. */
    double twist;
    bool either; /* whether hedge may choose which of the two edges in `joining` survives, as after
                    edge_join */
    uint32_t joining[2];
    or_vertex vertex[OR_VERTICES];
    or_edge edge[OR_EDGES];
    or_face face[OR_FACES];
    uint32_t left[OR_VERTICES][OR_VERTICES];
    uint32_t joined[OR_VERTICES][OR_VERTICES];
    uint32_t around[OR_VERTICES][OR_VERTICES];
    uint32_t degree[OR_VERTICES];
    /* known_vertices: the number of rows of `left`, `joined` and `around` that are in use.
     * known_edges: the number of entries of `pair` in use; pair[e] are the two vertices for which
     * `joined` has the edge e. */
    uint32_t known_vertices, known_edges;
    uint32_t pair[OR_EDGES][2];
} or_mesh;

or_mesh *or_new(void);
void or_free(or_mesh *o);
void or_empty(or_mesh *o);

/* --- building: ids are given in order; or_add_face does not check the face --- */

uint32_t or_add_vertex(or_mesh *o, he_vec3 at);
uint32_t or_add_face(or_mesh *o, const uint32_t *v, uint32_t count);
void or_remove_last_face(or_mesh *o);

/* A copy of the oracle's lists from before an operation. or_restore undoes the operation with it,
 * and frees it. */
typedef struct or_lists {
    uint32_t vertices, edges, faces;
    or_vertex *vertex;
    or_edge *edge;
    or_face **face; /* the faces, each allocated for as many corners as it has */
} or_lists;

or_lists *or_save(const or_mesh *o);
void or_restore(or_mesh *o, or_lists *lists);
void or_forget(or_lists *lists);
/* Notes that hedge may refuse this operation for one of the reasons in `may`: if hedge does,
 * or_decline restores the lists `before`, which belong to the oracle from now on. */
void or_doubt(or_mesh *o, or_lists *before, uint64_t may);

/* --- queries --- */

/* Computes `left` and `joined` from the lists. Returns 0, or the set of reasons why no mesh can
 * have these faces: HE_TOO_FEW_CORNERS, HE_REPEATED_CORNER, HE_ORIENTATION, HE_CLOSED_FAN. */
uint64_t or_derive(or_mesh *o);
/* Set one entry of the table `left` or of the table `joined`. */
void or_set_left(or_mesh *o, uint32_t a, uint32_t b, uint32_t f);
void or_set_joined(or_mesh *o, uint32_t e);

uint32_t or_live_vertices(const or_mesh *o);
uint32_t or_live_edges(const or_mesh *o);
uint32_t or_live_faces(const or_mesh *o);
bool or_same_point(he_vec3 a, he_vec3 b);
/* or_place returns the position of the vertex v among the corners of the face f, OR_NONE if it is
 * no corner; or_after returns the next corner. */
uint32_t or_place(const or_face *f, uint32_t v);
uint32_t or_after(const or_face *f, uint32_t v);
uint32_t or_before(const or_face *f, uint32_t v);
uint32_t or_degree(const or_mesh *o, uint32_t v);
/* Returns whether the vertex is on the boundary; true also for an isolated vertex, which has no
 * faces. */
bool or_on_boundary(const or_mesh *o, uint32_t v);
uint32_t or_fans(const or_mesh *o, uint32_t v);
/* Finds the neighbours of the vertex v, at most `room`; returns their number. */
uint32_t or_neighbours(const or_mesh *o, uint32_t v, uint32_t *out, uint32_t room);
/* Returns the neighbour of the vertex v that comes after its neighbour x, counter-clockwise, in the
 * same fan of faces; OR_NONE at the end of the fan. */
uint32_t or_turn(const or_mesh *o, uint32_t v, uint32_t x);
/* Returns whether the open fan at the vertex v that begins with the neighbour x ends with the
 * neighbour y, and v has another fan. */
bool or_closes_beside(const or_mesh *o, uint32_t v, uint32_t x, uint32_t y);
bool or_same_cycle(const or_face *f, const or_face *g);

/* --- operations (ops_*.c) --- */

/* Returns the refusal HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if the element is not live, else no
 * refusal. The operations below expect live elements. */
uint64_t or_require(const or_mesh *o, he_kind kind, uint32_t id);

uint64_t or_vertex_add(or_mesh *o, he_vec3 at);
uint64_t or_vertex_move(or_mesh *o, const uint32_t *v, const he_vec3 *to, uint32_t count);
uint64_t or_vertex_delete(or_mesh *o, uint32_t v, bool keep_isolated);
/* or_vertex_split: `left` and `right` are neighbours of the vertex v, which is split; one of them
 * may be OR_NONE. If `to` is NULL, the new vertex is at the position of v. */
uint64_t or_vertex_split(or_mesh *o, uint32_t v, uint32_t left, uint32_t right, const he_vec3 *to);

uint64_t or_edge_bisect(or_mesh *o, uint32_t e, double t);
uint64_t or_edge_join(or_mesh *o, uint32_t v);
uint64_t or_edge_split(or_mesh *o, uint32_t e, double t);
uint64_t or_edge_flip(or_mesh *o, uint32_t e);
/* The collapse of the edge from the vertex u to the vertex v: u is deleted; v moves to `to` or, if
 * `to` is NULL, to the fraction t of the way from u to v. */
typedef struct or_collapse {
    uint32_t u, v;
    double t;
    const he_vec3 *to;
} or_collapse;
uint64_t or_edge_collapse(or_mesh *o, const or_collapse *c);
/* The two steps of or_edge_collapse. If rounding decides whether v moves, the refusals that apply
 * only to a moving v are added to *doubt. */
uint64_t or_check_collapse(const or_mesh *o, const or_collapse *c, uint64_t *doubt);
void or_draw_together(or_mesh *o, const or_collapse *c);

uint64_t or_edge_delete(or_mesh *o, const uint32_t *e, uint32_t count, bool keep_isolated);
uint64_t or_edge_cut(or_mesh *o, const uint32_t *e, uint32_t count);
typedef enum or_keep { OR_MEAN, OR_A, OR_B } or_keep;
uint64_t or_edge_weld(or_mesh *o, uint32_t ea, uint32_t eb, or_keep keep);
uint64_t or_edge_extrude(or_mesh *o, const uint32_t *e, uint32_t count, he_vec3 by);
uint64_t or_edge_bevel(or_mesh *o, uint32_t e, double width);

uint64_t or_face_add(or_mesh *o, const uint32_t *v, uint32_t count);
uint64_t or_face_delete(or_mesh *o, const uint32_t *f, uint32_t count, bool keep_isolated);
uint64_t or_face_split(or_mesh *o, uint32_t f, uint32_t from, uint32_t to);
uint64_t or_face_join(or_mesh *o, uint32_t e);
/* `start` is the origin of the stored half-edge of the face f; if `at` is NULL, the position of the
 * new vertex is not specified. */
uint64_t or_face_poke(or_mesh *o, uint32_t f, uint32_t start, const he_vec3 *at);
/* In each face f[i], the stored half-edge leaves start[i]; the triangle with this half-edge keeps
 * the id of the face. */
uint64_t or_face_triangulate(or_mesh *o, const uint32_t *f, const uint32_t *start, uint32_t count);

typedef enum or_fill { OR_POLYGON, OR_FAN, OR_TRIANGULATE } or_fill;
/* `loop` has the vertices of the hole in the order of hedge's boundary links, which is hedge's
 * choice at a bow-tie. */
uint64_t or_hole_fill(or_mesh *o, const uint32_t *loop, uint32_t count, or_fill method);

/* (ops_corner.c) `start` is the neighbour of the vertex v to which hedge's stored half-edge of v
 * leads: or_vertex_dissolve keeps the id of the face of that half-edge, and or_vertex_bevel moves v
 * towards that neighbour. `moved` are those neighbours of v whose edges or_vertex_split_corners
 * moves to the new vertex. */
uint64_t or_vertex_dissolve(or_mesh *o, uint32_t v, uint32_t start);
uint64_t or_vertex_split_corners(or_mesh *o, uint32_t v, const uint32_t *moved, uint32_t count);
uint64_t or_vertex_bevel(or_mesh *o, uint32_t v, uint32_t start, double width);

/* (ops_weld.c) or_weld merges each vertex v into to[v], which may be v itself; the merged vertex is
 * at the mean of all vertices merged into it, or stays at the position of to[v]. or_weld_near finds
 * `to` for a tolerance; it returns false if rounding decides which vertices are merged. */
uint64_t or_weld(or_mesh *o, const uint32_t to[OR_VERTICES], bool mean);
bool or_weld_near(const or_mesh *o, double tolerance, uint32_t to[OR_VERTICES]);
/* `starts` are the first neighbours of those fans around the vertex v that get a new vertex: hedge
 * chooses which fan keeps v, and in which order the other fans get their new vertices. */
uint64_t or_check_separate(const or_mesh *o, uint32_t v, const uint32_t *starts, uint32_t count);
void or_separate(or_mesh *o, uint32_t v, const uint32_t *starts, uint32_t count);
uint64_t or_delete_isolated(or_mesh *o);
/* `a` and `b` have the vertices of two holes in the order of hedge's boundary links. */
uint64_t or_loop_bridge(or_mesh *o, const uint32_t *a, uint32_t n, const uint32_t *b, uint32_t m);
/* The vertices of a loop in order, and the face on the left of the loop; OR_NONE if there is a
 * hole. */
typedef struct or_loop {
    const uint32_t *v;
    uint32_t count;
    uint32_t face;
} or_loop;
/* Merges each vertex of the loop b into the vertex of the loop a with the same index; the loops
 * must be equally long. */
uint64_t or_loop_join(or_mesh *o, or_loop a, or_loop b);
uint64_t or_loop_split(or_mesh *o, const uint32_t e[3]);
/* Finds the vertices of a cycle of three edges, in the direction of the first edge; returns false
 * if the edges form no cycle. */
bool or_find_cycle(const or_mesh *o, const uint32_t e[3], uint32_t cycle[3]);
/* Returns whether the face is above the plane, after plane_split has cut all faces. */
bool or_face_is_above(const or_mesh *o, uint32_t f, he_vec3 normal);
/* (ops_region.c) A set of faces to extrude or inset; if `joined`, faces that share an edge stay
 * joined. start[f] is the origin of the stored half-edge of face f, where its corners begin. If
 * `by` is NULL, the faces move by `distance` along the normal. If `factor` is 0, or_face_inset
 * insets by `distance`; the oracle then knows only that the new corners are near the old ones. */
typedef struct or_region {
    const uint32_t *faces, *start;
    uint32_t count;
    bool joined;
} or_region;
uint64_t or_face_extrude(or_mesh *o, or_region region, const he_vec3 *by, double distance);
uint64_t or_face_inset(or_mesh *o, or_region region, double factor, double distance);
/* or_faces_vaguely returns whether the direction of a face, or of the whole region, is so uncertain
 * that rounding decides it. A face whose corners are at only two positions (or_is_flat) certainly
 * has no direction, so rounding decides nothing there. */
bool or_faces_vaguely(const or_mesh *o, or_region region, bool inset);
bool or_is_flat(const or_mesh *o, uint32_t f);

/* (ops_whole.c) or_reverse applies to all faces if `faces` is NULL. */
uint64_t or_face_collapse(or_mesh *o, uint32_t f, uint32_t start);
uint64_t or_reverse(or_mesh *o, const uint32_t *faces, uint32_t count);
uint64_t or_dual(or_mesh *o);
/* Appends copies of all live elements of `other`, in the order of their ids. */
void or_append(or_mesh *o, const or_mesh *other);

uint64_t or_transform(or_mesh *o, const double matrix[16], const uint32_t *v, uint32_t count);
void or_compact(or_mesh *o);

/* (ops_refine.c) Makes one step of subdivision; start[f] is the origin of the stored half-edge of
 * face f. */
typedef enum or_scheme { OR_LOOP, OR_CATMULL_CLARK, OR_LINEAR, OR_SQRT3 } or_scheme;
uint64_t or_subdivide(or_mesh *o, or_scheme scheme, const uint32_t *start);

/* A plane through `point`. A vertex is in the plane if its distance is within the tolerance; if
 * `tolerance` is NULL, the tolerance is hedge's default. */
typedef struct or_plane {
    he_vec3 point, normal;
    const double *tolerance;
} or_plane;
/* If `faces` is NULL, all faces are split; start[f] is the origin of the stored half-edge of face
 * f. If a face has more than two corners in the plane, hedge chooses which of them are joined, as
 * long as every part lies on one side of the plane. */
uint64_t or_plane_split(or_mesh *o, const or_plane *plane, const uint32_t *faces, uint32_t count,
                        const uint32_t *start);
/* The maximum size of the result of plane_split. `doubtful`: the distance of a vertex is so close
 * to the tolerance that rounding decides whether the vertex is in the plane. */
typedef struct or_plane_size {
    /* numbers of edges crossed and of faces cut by the plane, and of corners of the longest face
     * afterwards */
    uint32_t crossed, cut, longest;
    bool doubtful;
} or_plane_size;
or_plane_size or_plane_measure(const or_mesh *o, const or_plane *plane);

/* (ops_select.c) A rule of the operation select, see core/select/select.h. The oracle does not know
 * attributes: `values` has a value for each element of the kind `of`, for the rules attribute and
 * measure; NULL lets the oracle measure. */
typedef struct or_rule {
    const char *by;
    he_kind of, seed_kind;
    const uint32_t *seeds;
    uint32_t seed_count;
    bool seeded; /* whether seeds are given */
    bool cross_features, any_corner;
    double angle, from, to;
    he_vec3 low, high, normal;
    or_plane plane;
    const double *matrix;
    const he_vec3 *polygon;
    uint32_t polygon_count, steps;
    const char *measure;
    const double *values;
} or_rule;
/* What the oracle says about an element: it is not selected, rounding decides, it is selected. */
typedef enum or_verdict { OR_NO, OR_EITHER, OR_YES } or_verdict;
enum { OR_ROWS = OR_EDGES };
/* Finds for each element of the kind `of` whether the rule selects it; the kinds have at most
 * OR_ROWS elements. The rule must be one that hedge accepts. */
void or_select(const or_mesh *o, const or_rule *rule, or_verdict verdict[OR_ROWS]);

/* Returns whether the normals of the two faces of an edge differ by at most `angle`; OR_NO if the
 * edge has only one face. */
or_verdict or_is_smooth(const or_mesh *o, uint32_t e, double angle);

/* or_delaunay_flip applies one flip that hedge's delaunay reports; hedge chooses the order. Returns
 * false, and writes a sentence to `text`, unless the edge lies between two triangles, the opposite
 * angles require a flip, and edge_flip allows it. `looked[e]` is set for the edges to examine at
 * the end: or_delaunay_done returns false if one of them still requires a flip that is allowed. */
bool or_delaunay_flip(or_mesh *o, uint32_t e, bool looked[], char *text, size_t room);
bool or_delaunay_done(or_mesh *o, const bool looked[], char *text, size_t room);

/* --- comparison with hedge (match.c) --- */

enum { OR_TEXT = 256 };

/* Makes the vertices that plane_split puts on edges, in ascending order of the edges, and inserts
 * them into the faces that are cut. */
void or_plane_vertices(or_mesh *o);
/* Returns whether the faces from `first_new` on form the strip of loop_bridge. */
bool or_strip_is_right(const or_mesh *o, uint32_t first_new);
/* or_adopt copies the ids that hedge gave to new elements, then calls or_derive. It returns false,
 * and writes a sentence to `text`, if the new elements of hedge's mesh differ from the oracle's.
 * or_decline must be called if hedge refused for a reason in `may`: it restores the oracle's state
 * from before the operation. */
void or_decline(or_mesh *o);
bool or_adopt(or_mesh *o, const he_mesh *m, char text[OR_TEXT]);
/* Returns whether hedge's mesh equals the oracle's in all counts, cycles, ends, links, rings and
 * positions; if not, writes the reason to `text`. */
bool or_matches(or_mesh *o, const he_mesh *m, char text[OR_TEXT]);

#endif
