/* export_triangles.h - cuts all faces into triangles, for formats that only have triangles.
 *
 * A polygon is cut as triangulation.h says, with diagonals that avoid existing edges if possible: a
 * doubled edge would have more than two faces when the file is read again. */
#ifndef HE_FORMAT_IO_EXPORT_TRIANGLES_H
#define HE_FORMAT_IO_EXPORT_TRIANGLES_H

#include "geometry/triangulation.h"

/* {0} is empty. */
typedef struct he_export_triangles {
    const he_mesh *mesh;
    he_ids corners;            /* three vertices for each triangle into which a polygon was cut */
    uint64_t polygons, turned; /* `polygons` counts the faces that were cut, `turned` those of them
                                  that have flipped triangles */
    uint64_t steps;            /* number of steps of work that cutting the faces took */
} he_export_triangles;

/* Cuts all faces. The mesh is borrowed and must not change until the triangles are cleared.
 * `progress` may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_export_triangles_make(const he_mesh *mesh, he_progress *progress,
                                                he_export_triangles *out, he_error *err);
void he_export_triangles_clear(he_export_triangles *triangles);
/* Returns the number of triangles of all faces together. */
uint64_t he_export_triangles_count(const he_export_triangles *triangles);

/* A walk over all triangles, face by face. The caller initialises it with {0}. */
typedef struct he_export_triangle_walk {
    uint32_t face; /* the next face, or the one being visited */
    uint32_t left; /* number of triangles of the face being visited that are still to come */
    bool is_cut;   /* true if the face being visited was cut, because it is no triangle */
    size_t corner; /* index of the next vertex in he_export_triangles.corners */
} he_export_triangle_walk;

/* Gets the three vertices of the next triangle of the walk. Returns false after the last one. */
bool he_export_triangles_next(const he_export_triangles *triangles, he_export_triangle_walk *walk,
                              uint32_t vertices[3]);
/* Moves the walk to the first triangle of the face `face`, which is none that the walk has passed.
 * The walk must have returned all triangles of the face before. */
void he_export_triangles_skip(const he_export_triangles *triangles, he_export_triangle_walk *walk,
                              uint32_t face);

#endif
