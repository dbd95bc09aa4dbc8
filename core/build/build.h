/* build.h - makes a mesh from a polygon soup: a list of vertices, and a list of faces that name
 * their vertices.
 *
 * Readers of files and documents fill a soup piece by piece; he_build makes the mesh, in time
 * linear in the number of corners, whatever their order and the degrees of vertices, or reports
 * everything in the soup that a half-edge mesh cannot represent. Vertices and faces keep the soup's
 * order as ids; edges are numbered by their first appearance in the faces, and half-edge 2e belongs
 * to the face in which edge e appears first. The stored half-edge of a face leaves its first
 * corner. Nothing is merged, dropped or reversed. */
#ifndef HE_BUILD_BUILD_H
#define HE_BUILD_BUILD_H

#include "mesh/column.h"
#include "mesh/material.h"
#include "mesh/mesh.h"

/* Limits on the size of a soup. 0 means that only the limits of every mesh apply. */
typedef struct he_limits {
    uint64_t vertices, faces, corners;
    uint64_t bytes; /* memory of the soup */
    /* watch of the work of filling and building the soup (progress.h); may be NULL */
    he_progress *progress;
} he_limits;

typedef struct he_soup {
    he_limits limits;
    he_vec3 *positions;
    size_t vertex_count, vertex_capacity;
    uint32_t *corners; /* vertex of each corner; the corners of a face are consecutive */
    size_t corner_count, corner_capacity;
    /* index of the first corner of each face; to the last face corners may still be added */
    uint32_t *starts;
    size_t face_count, face_capacity;
    /* The attributes of the soup. HE_VERTEX columns have a row for each vertex, HE_FACE columns for
     * each face, HE_HALFEDGE columns for each corner, HE_MESH_KIND columns have one row. Shorter
     * columns are filled up with their default. */
    he_column **columns;
    size_t column_count, column_capacity;
    /* the materials of the soup; the mesh gets all of them, even those that no face uses */
    he_materials materials;
} he_soup;

void he_soup_init(he_soup *soup, const he_limits *limits);
void he_soup_clear(he_soup *soup);
/* Appends a vertex.
 * Returns HE_LIMIT if a limit of the soup would be exceeded.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_NOT_FINITE if a coordinate is not finite. */
HE_NODISCARD he_status he_soup_add_vertex(he_soup *soup, he_vec3 position, he_error *err);
/* he_soup_begin_face begins a face, he_soup_add_corner adds a corner to the last face. The vertex
 * of a corner is not checked here, because a corner may name a vertex that is added later. */
HE_NODISCARD he_status he_soup_begin_face(he_soup *soup, he_error *err);
HE_NODISCARD he_status he_soup_add_corner(he_soup *soup, uint32_t vertex, he_error *err);
HE_NODISCARD he_status he_soup_add_face(he_soup *soup, const uint32_t *vertices, size_t count,
                                        he_error *err);
/* Finds the face of a corner, by bisection. */
uint32_t he_soup_face_of(const he_soup *soup, size_t corner);
/* Finds the column with the domain and name of `schema`, or makes it.
 * Returns HE_BAD_VALUE if a column of another type exists. */
HE_NODISCARD he_status he_soup_column(he_soup *soup, const he_column_schema *schema,
                                      he_column **out, he_error *err);
/* Adds a column; the soup must have none of its domain and name. On success the soup owns it. */
HE_NODISCARD he_status he_soup_take_column(he_soup *soup, he_column *takes, he_error *err);

/* One thing in a soup that a half-edge mesh cannot represent. `reason` is one of:
 *     HE_TOO_FEW_CORNERS                     a face is at fault
 *     HE_BAD_INDEX, HE_REPEATED_CORNER       a face and the vertex that its corner names
 *     HE_NONMANIFOLD_EDGE, HE_ORIENTATION    a face and its edge from `vertex` to `other`
 *     HE_CLOSED_FAN                          a vertex */
typedef struct he_defect {
    he_status reason;
    he_kind kind; /* kind of the element at fault: HE_FACE or HE_VERTEX */
    uint32_t id;
    /* index of the corner at fault within its face; HE_NONE if no single corner is */
    uint32_t corner;
    /* the vertex at fault, or both ends of the edge at fault; else HE_NONE */
    uint32_t vertex, other;
} he_defect;

enum { HE_REPORT_DEFECTS = 100 };

typedef struct he_report {
    /* the first defects found: first those of faces, then of edges, then of vertices */
    he_defect defects[HE_REPORT_DEFECTS];
    uint64_t total; /* number of all defects */
} he_report;

/* Writes one sentence that describes the defect for people. */
void he_defect_text(const he_defect *defect, char *text, size_t size);
/* Returns the reason of the first defect of a report, which must have one, and describes that
 * defect in `err`. */
he_status he_report_fail(const he_report *report, he_error *err);

/* Counts the defects that he_build would find in a soup; 0 means that it would make a mesh.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_build_try(const he_soup *soup, uint64_t *defects, he_error *err);

/* he_build makes a mesh, which the caller owns. If the soup has defects, the call fails with the
 * reason and element of the first defect, and `report` (which may be NULL) gets the first
 * HE_REPORT_DEFECTS defects. The soup is only read, unless `flags` has HE_BUILD_TAKE: then columns
 * and positions are moved instead of copied, and the soup is cleared on success.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the soup has more elements than there are ids.
 * Returns HE_CANCELLED if the work was cancelled. */
enum { HE_BUILD_TAKE = 1 };
HE_NODISCARD he_status he_build(he_soup *soup, unsigned flags, he_mesh **out, he_report *report,
                                he_error *err);

#endif
