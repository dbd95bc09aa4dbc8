/* cuts.h - the triangles of all faces, for formats that have no others.
 *
 * A polygon is cut as triangulation.h says, with diagonals that avoid the edges there are where
 * they can: an edge that is doubled would have more than two faces when the file is read again. */
#ifndef HE_FORMAT_IO_CUTS_H
#define HE_FORMAT_IO_CUTS_H

#include "geometry/triangulation.h"

/* {0} is empty. */
typedef struct he_cuts {
    const he_mesh *mesh;
    he_ids corners;            /* three vertices a triangle, of all faces that are none */
    uint64_t polygons, turned; /* faces: cut; with triangles turned over */
    uint64_t steps;            /* that cutting them took */
} he_cuts;

/* Borrows the mesh, which must not change meanwhile. `watch` may be NULL. HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_cuts_make(const he_mesh *mesh, he_watch *watch, he_cuts *out,
                                    he_error *err);
void he_cuts_clear(he_cuts *cuts);
/* Triangles in all: the corners of faces, less two a face. */
uint64_t he_cuts_count(const he_cuts *cuts);

/* A walk over the triangles, those of one face after another; {0} begins it. */
typedef struct he_cut_walk {
    uint32_t face; /* next, or the one that has begun */
    uint32_t left; /* triangles of it that are to come */
    bool is_cut;   /* it is no triangle */
    size_t corner; /* next of cuts */
} he_cut_walk;

/* The ids of its vertices; false after the last. */
bool he_cuts_next(const he_cuts *cuts, he_cut_walk *walk, uint32_t vertices[3]);

#endif
