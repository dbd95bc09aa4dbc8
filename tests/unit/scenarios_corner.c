#include "scenarios.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define TETRA   "021,013,032,123"
#define PILLOW  "012,021"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"
/* Two quadrilaterals that share an edge. */
#define CF3 "0123,3245"
/* Two quadrilaterals back to back, which share all four edges; all vertices have degree 2. */
#define TENT "0123,0321"

const scenario corner_scenarios[] = {
    {"vertex_dissolve vertex=0", HEXAGON, NULL, HE_OK, {-1, -6, -5}},
    {"vertex_dissolve vertex=0", QCUBE, NULL, HE_OK, {-1, -3, -2}},
    {"vertex_dissolve vertex=0", TETRA, NULL, HE_OK, {-1, -3, -2}},
    {"vertex_dissolve vertex=8", QCUBE, "edge_bisect edge=0-1", HE_OK, {-1, -2, -1}},
    {"vertex_dissolve vertex=9", QCUBE, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_dissolve vertex=3", "012+", "vertex_delete vertex=3", HE_DELETED_ELEMENT, {0}},
    {"vertex_dissolve vertex=3", "012+", NULL, HE_BOUNDARY_VERTEX, {0}},
    {"vertex_dissolve vertex=1", HEXAGON, NULL, HE_BOUNDARY_VERTEX, {0}},
    {"vertex_dissolve vertex=0", PILLOW, NULL, HE_TOO_FEW_CORNERS, {0}},
    {"vertex_dissolve vertex=0", TENT, NULL, HE_REPEATED_CORNER, {0}},
    {"vertex_dissolve vertex=0", HEXAGON, "mark locked vertex=0", HE_LOCKED_ELEMENT, {0}},
    {"vertex_dissolve vertex=0", HEXAGON, "mark locked edge=0-4", HE_LOCKED_ELEMENT, {0}},
    {"vertex_dissolve vertex=0", HEXAGON, "mark locked face=5", HE_LOCKED_ELEMENT, {0}},
    {"vertex_dissolve vertex=0",
     HEXAGON,
     "mark locked vertex=1;mark locked edge=1-2",
     HE_OK,
     {-1, -6, -5}},

    {"vertex_split_corners a=3-0 b=3-2", CF3, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=3-2 b=3-0", CF3, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-1 b=0-4", HEXAGON, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-1 b=0-2", HEXAGON, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-2 b=0-1", HEXAGON, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-1 b=0-2", "012", NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-1 b=0-4", STRANGE, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=0-2 b=0-6", STRANGE, NULL, HE_OK, {1, 1, 0}},
    {"vertex_split_corners a=#0 b=#6", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_split_corners a=#6 b=#0", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_split_corners a=0-3 b=#0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"vertex_split_corners a=0-1 b=0-1", "012", NULL, HE_SAME_CORNER, {0}},
    {"vertex_split_corners a=0-1 b=1-0", "012", NULL, HE_DIFFERENT_ORIGINS, {0}},
    {"vertex_split_corners a=0-1 b=0-3", STRANGE, NULL, HE_NO_FACE, {0}},
    {"vertex_split_corners a=0-1 b=0-4",
     HEXAGON,
     "mark locked vertex=0;mark locked edge=0-2;mark locked face=0",
     HE_OK,
     {1, 1, 0}},

    {"vertex_bevel vertex=0 width=0.25", QCUBE, NULL, HE_OK, {2, 3, 1}},
    {"vertex_bevel vertex=0 width=9", HEXAGON, NULL, HE_OK, {5, 6, 1}},
    {"vertex_bevel vertex=0 width=1e-320", TETRA, NULL, HE_OK, {2, 3, 1}},
    {"vertex_bevel vertex=0 width=1",
     TETRA,
     "vertex_move vertices=0,1,2 to=1e308,0,0,-1e308,0,0,1e308,0,0",
     HE_OK,
     {2, 3, 1}},
    {"vertex_bevel vertex=9 width=1", QCUBE, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_bevel vertex=3 width=1", "012+", "vertex_delete vertex=3", HE_DELETED_ELEMENT, {0}},
    {"vertex_bevel vertex=0 width=0", QCUBE, NULL, HE_BAD_VALUE, {0}},
    {"vertex_bevel vertex=0 width=-1", QCUBE, NULL, HE_BAD_VALUE, {0}},
    {"vertex_bevel vertex=1 width=1", HEXAGON, NULL, HE_BOUNDARY_VERTEX, {0}},
    {"vertex_bevel vertex=0 width=1", PILLOW, NULL, HE_LOW_DEGREE, {0}},
    {"vertex_bevel vertex=0 width=1", QCUBE, "mark locked vertex=0", HE_LOCKED_ELEMENT, {0}},
    {"vertex_bevel vertex=0 width=1", QCUBE, "mark locked edge=0-4", HE_LOCKED_ELEMENT, {0}},
    {"vertex_bevel vertex=0 width=1", QCUBE, "mark locked face=0", HE_LOCKED_ELEMENT, {0}},
    {.operation = NULL},
};
