/* proxies.h - patches that planes approximate: variational shape approximation (D. Cohen-Steiner,
 * P. Alliez and M. Desbrun, "Variational shape approximation", 2004).
 *
 * Every patch has a proxy, the direction of a plane. The error of a face is its area times the
 * squared distance between its unit normal and the proxy of its patch (the metric L2,1 of the
 * paper). Two steps are repeated until the sum of errors no longer falls: all patches grow at once
 * from one seed each, always by the face with the least error; and each proxy becomes the mean of
 * the normals of its patch, weighted by area, and its seed the face that fits it best. The number
 * of patches is doubled step by step: a patch with a large error gets a second seed at its worst
 * face. At the end, seeds are moved from where they are needed least to where the error is largest
 * ("region teleportation" in the paper): two neighbouring patches become one, if that adds less
 * error than half the error of another patch, which gets a second seed. */
#ifndef HE_SELECT_PROXIES_H
#define HE_SELECT_PROXIES_H

#include "mesh/column.h"

/* A mesh to be divided into patches. */
typedef struct he_proxy_task {
    const he_mesh *m;
    const he_vec3 *normals;   /* of each face id: a unit vector, or zero */
    const double *areas;      /* of each face id, in any unit in which no sum of them overflows */
    const he_column *barrier; /* a mark of edges that no patch crosses, or NULL */
    uint32_t count;           /* the number of patches */
} he_proxy_task;

/* Divides the mesh. labels[f] becomes the number of the patch of face f, from 0, for each live
 * face; the entries of deleted faces become HE_NONE. There are fewer patches than wanted if no face
 * has an error any more, and more if the mesh has more components, each of which gets a patch at
 * least. Faces are in one component if a chain of faces joins them that share edges which are no
 * barrier. Returns HE_NO_MEMORY if memory is out. Returns HE_CANCELLED if the work was cancelled.
 */
HE_NODISCARD he_status he_proxies_fit(const he_proxy_task *task, uint32_t *labels, he_error *err);

#endif
