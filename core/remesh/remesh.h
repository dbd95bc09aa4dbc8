/* remesh.h - replaces triangles by others of even size and shape that cover the same surface.
 *
 * M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004: each step
 *
 *     splits the edges that are too long, at their middle,
 *     collapses the edges that are too short,
 *     flips edges if the degrees of the vertices then come nearer to 6,
 *     moves each vertex along the surface towards the middle of its faces, and back onto the
 *     surface that was given.
 *
 * At last edges are flipped, and the corners of the worst triangles moved, so that angles become
 * even; and vertices are moved a little off the surface, so that the faces come as near to it as
 * they can (remesh_fit.c). An edge is too long or too short if its
 * length is above 1.19 or below 0.75 times the wanted length.
 *
 * WHAT STAYS. Vertices never leave these LINES, along which they may move:
 *
 *     boundaries; edges that are marked `feature`; edges where the normals of the faces differ by
 *     more than the angle `crease`; edges between faces of different materials; SEAMS, if they
 *     are kept: edges on whose two sides an attribute of corners has different values at an end,
 *     if it is a float or double that is interpolated, and neither `normal` nor `tangent`.
 *
 * The ends and branches of lines stay in place, and so do vertices at which a line turns by more
 * than `crease`; a closed line keeps two of its vertices. New vertices on a line are points of the
 * line. A vertex of a line is removed only if the straight edge that takes its place is nowhere
 * farther from the line than a tenth of the wanted length.
 *
 *     locked vertices, edges and faces (marks.h), with the ends of locked edges and the corners of
 *     locked faces; faces that are not in the set, with their edges and corners; bow-ties, and the
 *     boundary edges at vertices that have faces outside the set
 *
 * are not changed at all.
 *
 * IDS. Vertices, edges and faces keep their ids or are deleted: an edge that is split keeps its id
 * in one part; a flipped edge keeps its id. New elements get the next ids.
 *
 * ATTRIBUTES. Values stay where they were on the surface: a vertex that is new or was moved gets
 * the values of that point of the old surface that is nearest to it, and a corner or face those of
 * the point nearest to it, on its side of the lines. The rule of the attribute says how:
 * interpolated between the corners of the old face; copied from the nearest of them (an old vertex
 * keeps its own value); or the default value. Edges: parts of an edge have its values, unless the
 * rule is `default`; parts of `feature` edges are features under any rule; edges that were made
 * inside a face have default values. */
#ifndef HE_REMESH_REMESH_H
#define HE_REMESH_REMESH_H

#include "mesh/mesh.h"

enum { HE_REMESH_STEPS = 100, HE_REMESH_STEPS_USUAL = 6 };

/* The most triangles that may be made, and the least wanted length as a fraction of the largest
 * extent of the box around the faces. */
#define HE_REMESH_FACES (UINT32_C(1) << 25)
#define HE_REMESH_LEAST 0x1p-40

/* The usual angle of a crease in radians, 40 degrees. It is a little more, so that rounding does
 * not decide about prisms of nine sides. */
#define HE_REMESH_CREASE 0.7

/* What decides about the length of edges. */
typedef enum he_remesh_by {
    HE_REMESH_BY_LENGTH, /* one length for all edges */
    HE_REMESH_BY_FACES,  /* the length with which there are so many faces */
    HE_REMESH_BY_ERROR   /* lengths that depend on the curvature (sizing.h) */
} he_remesh_by;

/* If lengths depend on the curvature, they are at most this fraction of the largest extent of the
 * box around the faces, if `max_length` is not given. */
#define HE_REMESH_MOST_LENGTH 0.1

typedef struct he_remesh_options {
    he_remesh_by by;
    double edge_length;    /* by length: the wanted length, above 0 */
    uint32_t target_faces; /* by faces: the wanted number of faces, from 1 to HE_REMESH_FACES */
    /* By error: about how far triangles may be from a smooth surface through the vertices, above 0;
     * and the least and greatest wanted length, or 0 for the usual ones: the error, and
     * HE_REMESH_MOST_LENGTH. */
    double error, min_length, max_length;
    unsigned steps;        /* 1 to HE_REMESH_STEPS */
    bool project;          /* vertices are moved back onto the old surface, and fitted at last */
    bool fixed_boundary;   /* boundary edges are not changed at all */
    bool keep_seams;       /* seams are lines; see the head of this file */
    double crease;         /* an angle in radians, from 0 to pi; see the head of this file */
    const uint32_t *faces; /* the ids of the faces to replace; NULL stands for all faces */
    size_t face_count;
} he_remesh_options;

typedef enum he_remesh_stop {
    HE_REMESH_SETTLED, /* the last step changed almost nothing */
    HE_REMESH_DONE,    /* all steps were done */
    HE_REMESH_STOP_COUNT
} he_remesh_stop;

/* The names of the reasons why a remeshing stopped: "settled", "steps". */
extern const char *const he_remesh_stop_names[HE_REMESH_STOP_COUNT + 1];

/* Describes the faces that were worked on, after the remeshing; 0 if there are none. */
typedef struct he_remeshed {
    uint32_t faces_before, faces;
    double shortest, mean, longest;       /* lengths of edges */
    double smallest_angle, largest_angle; /* in radians */
    /* Fraction of the vertices that have 6 edges, among those that are neither on lines nor fixed;
     * 1 if there are none. */
    double regular;
    /* No point of the new faces is farther than this from the faces that were replaced, up to
     * rounding. Mostly it is a little more than the distance of the farthest point; where a surface
     * is folded within one new face, it may be as large as that face. */
    double distance;
    he_remesh_stop stop;
} he_remeshed;

/* remesh: V, E and F change as the lengths demand.
 *
 * The new triangles are computed apart from the mesh, and then written to it. If more than
 * HE_REMESH_RECORDED faces were worked on, the arrays of a changed copy replace those of the mesh,
 * which is recorded as one replacement that keeps ids, as in decimate.h.
 *
 * `out` may be NULL. If the list of faces is empty, nothing happens.
 * Returns HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT or HE_REPEATED_ELEMENT if a listed face is not
 * live or is listed twice. Returns HE_NOT_TRIANGLE naming a face, if one of the faces is no
 * triangle. Returns HE_BAD_VALUE if an option is outside its range, or if the wanted length is less
 * than HE_REMESH_LEAST of the extent of the faces. Returns HE_LIMIT if there would be more than
 * HE_REMESH_FACES faces: before anything is computed if the area of the faces tells. Returns
 * HE_NO_MEMORY if memory is out. Returns HE_IDS_EXHAUSTED if no ids are left. Returns HE_CANCELLED
 * if the work was cancelled. */
enum { HE_REMESH_RECORDED = 20000 };
HE_NODISCARD he_status he_remesh(he_mesh *m, const he_remesh_options *options, he_remeshed *out,
                                 he_error *err);

/* Estimates how many faces the mesh would have, from at most some thousand faces, so that it takes
 * no longer for a large mesh. The list of faces need not be valid, and faces that are no triangles
 * are not looked at; the lengths and the error that `by` tells of must be above 0. If lengths
 * depend on the curvature and that changes within a few faces, there may be a few times as many.
 * Returns at most HE_REMESH_FACES. */
double he_remesh_foretell(const he_mesh *m, const he_remesh_options *options);

#endif
