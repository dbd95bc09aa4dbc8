/* deformer.h - what a deformer consists of, for the sources that make and use it. */
#ifndef HE_DEFORM_DEFORMER_H
#define HE_DEFORM_DEFORMER_H

#include "deform/deform.h"
#include "deform/rotation.h"
#include "solve/factor.h"

/* The patch of the surface around the free vertices: the triangles that have a corner at a free
 * vertex or at one that shares a triangle with a free vertex. Its vertices are numbered anew: the
 * free ones first, ascending. Points are relative to the middle of the patch, and divided by a
 * power of two, so that no sum or product overflows. */
struct he_deformer {
    he_deform_method method;
    uint32_t vertices, free; /* of the patch */
    uint32_t handles;
    uint32_t *ids;    /* the vertex of the mesh of each vertex of the patch */
    uint32_t *handle; /* the number of the handle that it is; HE_NONE: it is none */
    uint32_t *part;   /* the connected part of the patch in which it lies */
    uint32_t parts;
    he_vec3 *points; /* scaled */
    he_vec3 *at;     /* as they are in the mesh */
    he_vec3 middle;
    double scale;      /* the length that is 1 in scaled units */
    he_sparse matrix;  /* over all vertices of the patch: the Laplacian L, or L (1/m) L */
    he_sparse system;  /* its rows and columns of free vertices */
    he_factor *factor; /* of `system`; NULL if no vertex is free */
    /* Four columns with a row for each free vertex: what is the same for all translations of the
     * handles (deform_fields.c). NULL if the system is singular, or almost. */
    double *fields;
};

/* The triangles of a patch. */
typedef struct he_deform_triangles {
    uint32_t *corners; /* three vertices of the patch for each; the caller frees them */
    uint32_t count;
} he_deform_triangles;

/* Finds the free vertices and the patch around them: the members from `vertices` to `scale`, and
 * the triangles. The lists were checked. `d` and `out` were {0}, and are cleared by the caller in
 * any case.
 * Returns HE_LIMIT if there are too many triangles, HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status he_deformer_find_patch(he_deformer *d, const he_mesh *m,
                                              const he_deform_sets *sets, he_deform_triangles *out,
                                              he_progress *progress, he_error *err);

/* Makes the fields of a deformer that has a factor that is exact. Returns HE_NO_MEMORY. */
HE_NODISCARD he_status he_deformer_make_fields(he_deformer *d, he_error *err);
size_t he_deformer_field_bytes(const he_deformer *d);
/* Returns where a free vertex is, in scaled units, if all handles move by a vector and the part in
 * which it lies turns by `turn`; the deformer must have fields. */
he_vec3 he_deformer_carry(const he_deformer *d, uint32_t v, const he_rotation *turn, he_vec3 by);

#endif
