/* smoothing.h - the state of one call of he_smooth, which its methods share. */
#ifndef HE_SMOOTH_SMOOTHING_H
#define HE_SMOOTH_SMOOTHING_H

#include "base/mem.h"
#include "mesh/walk.h"
#include "smooth/smooth.h"

/* Positions are relative to the middle of the box of the mesh, and divided by a power of two, so
 * that no sum or product overflows. */
typedef struct he_smoothing {
    const he_mesh *mesh;
    const he_smooth_options *options;
    he_vec3 *at;       /* the present position of each vertex */
    he_vec3 *next;     /* room for other positions */
    uint64_t *is_free; /* the vertices that may move: a bit set */
    uint32_t *free;    /* the same as a list, ascending */
    uint32_t count;    /* of the list */
    double scale;      /* the length that is 1 in scaled units */
    double amount;     /* the time of a step of laplacian, in scaled units */
} he_smoothing;

/* Each function does one step of a method: it moves the free vertices in s->at.
 * Each returns HE_NO_MEMORY or HE_CANCELLED, and he_smooth_laplacian what he_smooth lists. */
HE_NODISCARD he_status he_smooth_laplacian(he_smoothing *s, he_error *err);
HE_NODISCARD he_status he_smooth_taubin(he_smoothing *s, he_error *err);
HE_NODISCARD he_status he_smooth_bilateral(he_smoothing *s, he_error *err);
HE_NODISCARD he_status he_smooth_tangential(he_smoothing *s, he_error *err);

/* Returns the vector whose length is twice the area of a triangle and whose direction is its
 * normal. */
he_vec3 he_smooth_double_area(const he_smoothing *s, he_face f);
/* Returns the mean of the corners of a triangle. */
he_vec3 he_smooth_centre(const he_smoothing *s, he_face f);

#endif
