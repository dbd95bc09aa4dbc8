/* segment.h - the operation `segment`: divides the faces into patches, and marks the edges between
 * them.
 *
 * Every face gets the number of its patch in an int attribute, such as `patch`; patches are
 * numbered from 1, in the order of their lowest face ids. A patch is connected: a chain of its
 * faces, each of which shares an edge with the one before, joins any two of them. The bool edge
 * attribute `feature` (marks.h) becomes true for the edges between patches; the boundary of the
 * mesh is not marked.
 *
 * BY ANGLE. A patch ends at edges at which the normals of the two faces differ by more than an
 * angle. All such edges are marked, also those that end inside a patch. A face without a normal
 * counts as if it had the normal of a neighbour (smooth_normals.h).
 *
 * BY PLANES. The patches are those that a number of planes, one for each patch, approximates best
 * (proxies.h).
 *
 * Edges that are marked already are borders of patches, too, if the caller wants to keep them. */
#ifndef HE_SELECT_SEGMENT_H
#define HE_SELECT_SEGMENT_H

#include "mesh/mesh.h"

/* What is done with the attribute `feature`. */
typedef enum he_segment_features {
    HE_FEATURES_ADD,     /* patches end at marked edges; further edges are marked */
    HE_FEATURES_REPLACE, /* marks are ignored, and replaced by those of the new patches */
    HE_FEATURES_IGNORE   /* marks are neither read nor written */
} he_segment_features;

typedef struct he_segment_options {
    const char *into; /* name of the int attribute of faces */
    /* Number of planes, at least 1; 0: the patches are found by angle. */
    uint32_t planes;
    double angle; /* in radians, from 0 to pi */
    he_segment_features features;
} he_segment_options;

typedef struct he_segmented {
    uint32_t patches;
    uint32_t features; /* number of edges that are marked afterwards; 0 with HE_FEATURES_IGNORE */
    /* How far patches by planes are from flat; 0 for patches by angle. It is the root mean square,
     * weighted by area, of the distance between the unit normal of a face and that of its patch,
     * the mean of its faces: 0 if all patches are flat, about the angle in radians if it is
     * small. */
    double deviation;
} he_segmented;

/* Divides the mesh into patches. `out` may be NULL.
 *
 * If the operation is refused, nothing changes.
 * Returns HE_BAD_VALUE if the name is empty, too long or "position".
 * Returns HE_ATTRIBUTE_CLASH if faces have an attribute of this name that is not an int32 or uint32
 * with one component and without labels, or edges an attribute `feature` that is not a mark.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_segment(he_mesh *m, const he_segment_options *options, he_segmented *out,
                                  he_error *err);

#endif
