/* status.h - the outcome of every fallible call in core.
 *
 * A call that can fail returns he_status and takes a caller-owned he_error last, which may be
 * NULL. On failure the outputs are untouched, an edited mesh is exactly as it was, and the error
 * says which rule was broken, by which element, in one plain sentence. On success the error is
 * left alone.
 *
 * HE_STATUS_MAP is the one list of outcomes: enum, slug (the `code` clients see) and title come
 * from it. A new refusal takes a line here, and is named in the rows of those operations (core/op)
 * that return it. */
#ifndef HE_BASE_STATUS_H
#define HE_BASE_STATUS_H

#include <stdint.h>

#define HE_NODISCARD __attribute__((warn_unused_result))

/* X(constant, slug, title) */
#define HE_STATUS_MAP(X)                                                                         \
    X(OK, "ok", "Success")                                                                       \
    /* resources */                                                                              \
    X(NO_MEMORY, "no_memory", "Out of memory")                                                   \
    X(IDS_EXHAUSTED, "ids_exhausted", "No ids are left in this mesh")                            \
    X(LIMIT, "limit_exceeded", "A configured limit was exceeded")                                \
    X(CANCELLED, "cancelled", "The work was cancelled")                                          \
    /* statuses for input that is wrong whatever the mesh is */                                  \
    X(SYNTAX, "syntax", "The input is not well formed")                                          \
    X(BAD_VALUE, "bad_value", "A value is outside its allowed range")                            \
    X(NOT_FINITE, "not_finite", "A number is not finite")                                        \
    X(BAD_INDEX, "bad_index", "An index is out of range")                                        \
    X(UNSUPPORTED, "unsupported", "The input uses a feature that is not supported")              \
    X(BEYOND_FLOAT, "beyond_float", "A coordinate is too large for the floats of the format")    \
    X(CORRUPT, "corrupt", "The mesh breaks one of its own invariants")                           \
    /* statuses for ids that the caller must not pass */                                         \
    X(NO_SUCH_ELEMENT, "no_such_element", "There is no such element")                            \
    X(DELETED_ELEMENT, "deleted_element", "The element was deleted")                             \
    X(REPEATED_ELEMENT, "repeated_element", "An element is named twice")                         \
    /* statuses for shapes that a half-edge mesh cannot represent */                             \
    X(TOO_FEW_CORNERS, "too_few_corners", "A face needs at least three corners")                 \
    X(NOT_TRIANGLE, "not_triangle", "The face is not a triangle")                                \
    X(REPEATED_CORNER, "repeated_corner", "A face would use a vertex twice")                     \
    X(NONMANIFOLD_EDGE, "nonmanifold_edge", "An edge would have more than two faces")            \
    X(ORIENTATION, "orientation", "Two faces would run along an edge in the same direction")     \
    X(NOT_ORIENTABLE, "not_orientable", "The faces cannot be oriented consistently")             \
    X(DOUBLED_EDGE, "doubled_edge", "Two edges would join the same two vertices")                \
    X(CLOSED_FAN, "closed_fan", "A closed fan of faces would share its vertex with another fan") \
    /* statuses for edits that the elements around them forbid */                                \
    X(BOUNDARY_EDGE, "boundary_edge", "The edge is on the boundary")                             \
    X(NOT_BOUNDARY, "not_boundary", "The element is not on the boundary")                        \
    X(INTERIOR_VERTEX, "interior_vertex", "The vertex is surrounded by faces")                   \
    X(BOUNDARY_VERTEX, "boundary_vertex", "The vertex is on the boundary")                       \
    X(BOWTIE, "bowtie", "The vertex has more than one fan of faces")                             \
    X(NOT_NEIGHBOUR, "not_neighbour", "The vertices are not joined by an edge")                  \
    X(NO_SECTOR, "no_sector", "No face would move to the new vertex")                            \
    X(NOT_A_CORNER, "not_a_corner", "The element is not a corner of the face")                   \
    X(SAME_CORNER, "same_corner", "The two corners are the same corner")                         \
    X(DIFFERENT_ORIGINS, "different_origins", "The half-edges leave different vertices")         \
    X(NO_FACE, "no_face", "The new edge would have no face")                                     \
    X(ADJACENT_CORNERS, "adjacent_corners", "The corners are already neighbours on the face")    \
    X(SHARED_BOUNDARY, "shared_boundary", "The faces share more than this edge")                 \
    X(WRONG_DEGREE, "wrong_degree", "The vertex does not have degree two")                       \
    X(TRIANGLE_SIDE, "triangle_side", "A face beside the vertex is a triangle")                  \
    X(LOW_DEGREE, "low_degree", "A vertex has too few edges")                                    \
    X(SAME_ENDS, "same_ends", "Both ends of the edge would be the same vertex")                  \
    X(LINK_CONDITION, "link_condition", "The link condition does not hold")                      \
    X(BRANCHING_CHAIN, "branching_chain", "The edges branch at a vertex")                        \
    X(SAME_LOOP, "same_loop", "The two half-edges lie on the same loop")                         \
    X(SHARED_VERTEX, "shared_vertex", "The loops have a vertex in common")                       \
    X(LOOP_LENGTH, "loop_length", "The loops have different lengths")                            \
    X(OPEN_LOOP, "open_loop", "The loop of the cut leaves the plane")                            \
    X(NOT_A_CYCLE, "not_a_cycle", "The edges do not form a cycle")                               \
    X(SHARED_FACE, "shared_face", "A face has more than one of the given edges")                 \
    X(ISOLATED_VERTEX, "isolated_vertex", "The vertex has no face")                              \
    X(NO_RIM, "no_rim", "The faces are a whole closed component and have no outline")            \
    X(RIM_MEETS_ITSELF, "rim_meets_itself", "The outline of the faces passes a vertex twice")    \
    X(NO_FACES, "no_faces", "A mesh has no faces")                                               \
    X(NO_NORMAL, "no_normal", "The face has no area and so no normal")                           \
    X(NO_SUCH_ATTRIBUTE, "no_such_attribute", "No such attribute")                               \
    X(ATTRIBUTE_CLASH, "attribute_clash", "Attributes of the same name have different types")    \
    /* refusals because of marks (marks.h) */                                                    \
    X(FEATURE_EDGE, "feature_edge", "A feature line would lose its shape")                       \
    X(LOCKED_ELEMENT, "locked_element", "The element is locked")

typedef enum he_status {
#define HE_STATUS_ENUM(constant, slug, title) HE_##constant,
    HE_STATUS_MAP(HE_STATUS_ENUM)
#undef HE_STATUS_ENUM
        HE_STATUS_COUNT
} he_status;

/* The kinds of elements; HE_MESH_KIND stands for the mesh itself. */
typedef enum he_kind {
    HE_VERTEX,
    HE_HALFEDGE,
    HE_EDGE,
    HE_FACE,
    HE_MESH_KIND,
    HE_KIND_COUNT
} he_kind;

/* One element of a mesh. */
typedef struct he_element {
    he_kind kind;
    uint32_t id;
} he_element;

/* The unit in which a position in an input is given: lines or bytes. */
typedef enum he_place { HE_PLACE_NONE, HE_PLACE_LINE, HE_PLACE_BYTE } he_place;

enum { HE_ERROR_TEXT = 192 };

typedef struct he_error {
    he_status status;
    he_kind kind;   /* kind of the element that the error names; HE_KIND_COUNT if it names none */
    uint32_t id;    /* id of that element */
    he_place place; /* unit of `at`: lines are counted from 1, bytes from 0 */
    uint64_t at;    /* position in the input at which the error was found */
    /* one plain sentence with the offending value; does not mention `at` */
    char text[HE_ERROR_TEXT];
} he_error;

/* Returns the slug of a status, such as "boundary_edge", which clients see as `code`; never
 * NULL. */
const char *he_status_slug(he_status status);
const char *he_status_title(he_status status);
/* Returns the name of a kind of element: "vertex", "halfedge", "edge", "face" or "mesh". */
const char *he_kind_name(he_kind kind);
/* Returns the plural of a kind of element: "vertices", "halfedges", "edges", "faces" or "mesh". */
const char *he_kind_plural(he_kind kind);

/* Fills `err` (which may be NULL) and returns `status`, so that a refusal is one statement:
 *     return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i, "edge %u has one face", e.i); */
he_status he_fail(he_error *err, he_status status, he_kind kind, uint32_t id, const char *format,
                  ...) __attribute__((format(printf, 5, 6)));
/* Fails like he_fail, with an error that names no element. */
he_status he_fail_plain(he_error *err, he_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Fails like he_fail, with an error that names a line or byte of an input. */
he_status he_fail_at(he_error *err, he_status status, he_place place, uint64_t at,
                     const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
