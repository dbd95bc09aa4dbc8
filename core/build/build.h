/* build.h - from a polygon soup to a mesh.
 *
 * Readers of files and documents fill a soup piece by piece; he_build makes the mesh, in time
 * linear in the corners whatever their order and the valences, or names everything the structure
 * cannot hold. Vertices and faces keep the soup's order as ids; edges are numbered by their first
 * appearance in the faces, with half-edge 2e running as that face does. halfedge(f) leaves the
 * face's first corner. Nothing is merged, dropped or turned. */
#ifndef HE_BUILD_BUILD_H
#define HE_BUILD_BUILD_H

#include "mesh/column.h"
#include "mesh/material.h"
#include "mesh/mesh.h"

/* What a caller allows; 0 means the structure's own maximum. */
typedef struct he_limits {
    uint64_t vertices, faces, corners;
    uint64_t bytes;  /* of memory for the soup */
    he_watch *watch; /* told of filling and building; NULL: nobody */
} he_limits;

typedef struct he_soup {
    he_limits limits;
    he_vec3 *positions;
    size_t vertex_count, vertex_capacity;
    uint32_t *corners; /* vertex of each corner, faces one after another */
    size_t corner_count, corner_capacity;
    uint32_t *starts; /* first corner of each face; the open face, if any, is the last */
    size_t face_count, face_capacity;
    /* Attributes. Rows of HE_VERTEX columns follow vertices, of HE_FACE columns faces, of
     * HE_HALFEDGE columns corners, of HE_MESH_KIND columns there is one. Shorter columns are
     * filled up with their default. */
    he_column **columns;
    size_t column_count, column_capacity;
    he_materials materials; /* the mesh's, whatever becomes of its faces */
} he_soup;

void he_soup_init(he_soup *soup, const he_limits *limits);
void he_soup_clear(he_soup *soup);
/* HE_LIMIT, HE_NO_MEMORY; HE_NOT_FINITE for a vertex. */
HE_NODISCARD he_status he_soup_add_vertex(he_soup *soup, he_vec3 position, he_error *err);
/* A face is begun, then given its corners. Corner values are not checked here: they may name
 * vertices that come later. */
HE_NODISCARD he_status he_soup_begin_face(he_soup *soup, he_error *err);
HE_NODISCARD he_status he_soup_add_corner(he_soup *soup, uint32_t vertex, he_error *err);
HE_NODISCARD he_status he_soup_add_face(he_soup *soup, const uint32_t *vertices, size_t count,
                                        he_error *err);
/* The face that has a corner, by bisection. */
uint32_t he_soup_face_of(const he_soup *soup, size_t corner);
/* The column of this domain and name, made when absent. HE_BAD_VALUE when one of another type
 * exists. */
HE_NODISCARD he_status he_soup_column(he_soup *soup, const char *name, he_kind domain, he_type type,
                                      uint32_t components, he_rule rule, he_column **out,
                                      he_error *err);
/* The column is the soup's from success on; there is none of its domain and name. */
HE_NODISCARD he_status he_soup_take_column(he_soup *soup, he_column *takes, he_error *err);

/* One thing the structure cannot hold. `reason` is HE_TOO_FEW_CORNERS, HE_BAD_INDEX,
 * HE_REPEATED_CORNER (face, vertex), HE_NONMANIFOLD_EDGE, HE_ORIENTATION (face, and the edge as
 * vertex and other), HE_CLOSED_FAN (vertex). */
typedef struct he_defect {
    he_status reason;
    he_kind kind; /* of the element that is at fault: HE_FACE or HE_VERTEX */
    uint32_t id;
    uint32_t corner;        /* of the face, HE_NONE when no single one is at fault */
    uint32_t vertex, other; /* ends of the edge at fault, or HE_NONE */
} he_defect;

enum { HE_REPORT_DEFECTS = 100 };

typedef struct he_report {
    he_defect defects[HE_REPORT_DEFECTS]; /* the first ones, by kind of test, then by id */
    uint64_t total;
} he_report;

/* One sentence, for people. */
void he_defect_text(const he_defect *defect, char *text, size_t size);
/* Fail with the first of a report that has any. */
he_status he_report_fail(const he_report *report, he_error *err);

/* How many defects he_build would find in a soup; 0: it would make a mesh. HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_build_try(const he_soup *soup, uint64_t *defects, he_error *err);

/* The mesh is the caller's. Any defect fails with the reason of the first and its element; all of
 * them are in `report` (may be NULL). HE_NO_MEMORY, HE_IDS_EXHAUSTED, HE_CANCELLED. The soup is
 * only read, save that its columns may be taken when `flags` has HE_BUILD_TAKE: then the soup is
 * cleared on success and positions are moved, not copied. */
enum { HE_BUILD_TAKE = 1 };
HE_NODISCARD he_status he_build(he_soup *soup, unsigned flags, he_mesh **out, he_report *report,
                                he_error *err);

#endif
