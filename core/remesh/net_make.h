/* net_make.h - makes the net of a mesh: finds the faces to work on, what must stay, and lines. */
#ifndef HE_REMESH_NET_MAKE_H
#define HE_REMESH_NET_MAKE_H

#include "remesh/net.h"

/* Which faces of a mesh a net is made of, and what stays. */
typedef struct he_net_choice {
    const uint32_t *faces; /* ids of live faces; NULL stands for all faces */
    size_t face_count;
    /* An edge is held like a feature if the normals of its faces differ by more than this angle,
     * and a vertex inside a line is fixed if the line turns by more than this angle; in radians. */
    double crease;
    bool fixed_boundary; /* edges on the boundary are frozen */
    bool keep_seams;     /* seams are held, as remesh.h says */
} he_net_choice;

/* Makes the net of the chosen faces, except locked ones, which count as not chosen. The caller
 * clears `out`.
 * Returns HE_NOT_TRIANGLE naming a face, if a chosen face is no triangle.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_net_make(const he_mesh *m, const he_net_choice *choice, he_net *out,
                                   he_error *err);

/* The parts of he_net_make that are in files of their own. */

/* Marks edges as held and vertices as fixed: finds features, borders and what is locked. */
HE_NODISCARD he_status he_net_hold(he_net *n, const he_mesh *m, const he_net_choice *choice,
                                   he_error *err);
/* Makes lines of the held edges that are not frozen. `crease` is that of he_net_choice. */
HE_NODISCARD he_status he_net_find_lines(he_net *n, const he_mesh *m, double crease, he_error *err);

/* Returns the place on a line at the distance `arc` from its first point, and in *ground a triangle
 * of the ground near it. */
he_vec3 he_net_line_place(const he_net *n, uint32_t line, double arc, uint32_t *ground);
/* Returns how far along a line vertex v is, which is inside the line or one of its ends. */
double he_net_line_arc(const he_net *n, uint32_t line, uint32_t v);
/* Returns the largest distance of the points of a line between two places on it, given as distances
 * along the line, from the straight segment between these places. */
double he_net_line_bulge(const he_net *n, uint32_t line, double from, double to);

#endif
