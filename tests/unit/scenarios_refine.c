#include "scenarios.h"

#include <stddef.h>

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define TETRA   "021,013,032,123"
#define PILLOW  "012,021"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"

#define SQUARE "012,023"
/* Moves the vertices of SQUARE to the corners of a square with sides of length 2. */
#define FLAT_SQUARE "vertex_move vertices=0,1,2,3 to=0,0,0,2,0,0,2,2,0,0,2,0"

const scenario refine_scenarios[] = {
    {"subdivide", QCUBE, NULL, HE_OK, {18, 36, 18}},
    {"subdivide scheme=catmull_clark", QCUBE, "face_delete face=0", HE_OK, {17, 32, 15}},
    {"subdivide scheme=catmull_clark steps=2", "012", NULL, HE_OK, {16, 27, 11}},
    {"subdivide scheme=catmull_clark", STRANGE, NULL, HE_OK, {12, 18, 6}},
    {"subdivide scheme=catmull_clark", PILLOW, NULL, HE_OK, {5, 9, 4}},
    {"subdivide scheme=catmull_clark", "01234,0456+", "mark feature edge=0-4", HE_OK, {10, 17, 7}},
    {"subdivide scheme=loop", TETRA, NULL, HE_OK, {6, 18, 12}},
    {"subdivide scheme=loop steps=2", TETRA, NULL, HE_OK, {30, 90, 60}},
    {"subdivide scheme=loop", STRANGE "+", NULL, HE_OK, {9, 18, 9}},
    {"subdivide scheme=loop", HEXAGON, "face_delete face=0", HE_OK, {11, 26, 15}},
    {"subdivide scheme=loop", HEXAGON, "mark feature edges=0-1,0-2,0-3", HE_OK, {12, 30, 18}},
    {"subdivide scheme=loop",
     HEXAGON,
     "mark locked vertex=0;mark locked edge=0-1;mark locked face=0",
     HE_OK,
     {12, 30, 18}},
    {"subdivide scheme=loop",
     TETRA,
     "vertex_move vertices=0,1 to=1.7e308,1.7e308,0,-1.7e308,0,0",
     HE_OK,
     {6, 18, 12}},
    {"subdivide scheme=linear", "0123,024", NULL, HE_OK, {8, 14, 6}},
    {"subdivide scheme=linear steps=2", "0123,024", NULL, HE_OK, {33, 63, 30}},
    {"subdivide scheme=linear", STRANGE, "face_delete face=1", HE_OK, {6, 12, 6}},
    {"subdivide scheme=sqrt3", TETRA, NULL, HE_OK, {4, 12, 8}},
    {"subdivide scheme=sqrt3 steps=3", TETRA, NULL, HE_OK, {52, 156, 104}},
    {"subdivide scheme=sqrt3 steps=2", "012", NULL, HE_OK, {7, 15, 8}},
    {"subdivide scheme=sqrt3 steps=2", STRANGE, NULL, HE_OK, {21, 45, 24}},
    {"subdivide scheme=sqrt3 steps=2", HEXAGON, "face_delete face=0", HE_OK, {27, 67, 40}},
    {"subdivide scheme=sqrt3 steps=2", "012,023", "mark feature edge=0-2", HE_OK, {12, 28, 16}},
    {"subdivide scheme=sqrt3",
     "012,023",
     "mark locked edge=0-2;mark locked face=0;mark feature edge=0-2",
     HE_OK,
     {2, 6, 4}},
    {"subdivide", "", NULL, HE_OK, {0, 0, 0}},
    {"subdivide scheme=loop", "++", NULL, HE_OK, {0, 0, 0}},
    {"subdivide scheme=loop steps=12", TETRA, NULL, HE_LIMIT, {0}},
    {"subdivide scheme=loop", QCUBE, NULL, HE_NOT_TRIANGLE, {0}},
    {"subdivide scheme=loop", "012,0234", NULL, HE_NOT_TRIANGLE, {0}},
    {"subdivide scheme=sqrt3 steps=2", "012,0234", NULL, HE_NOT_TRIANGLE, {0}},
    {"subdivide scheme=loop", PILLOW, NULL, HE_DOUBLED_EDGE, {0}},
    {"subdivide scheme=linear", PILLOW, NULL, HE_DOUBLED_EDGE, {0}},
    {"subdivide scheme=sqrt3", PILLOW, NULL, HE_DOUBLED_EDGE, {0}},
    {"subdivide scheme=sqrt3", TETRA, "mark locked edge=0-1", HE_LOCKED_ELEMENT, {0}},
    {"subdivide scheme=sqrt3", "012,023", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},

    {"remesh edge_length=100", "012", NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=100", "", NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=100", STRANGE, "face_delete face=1", HE_OK, {0, 0, 0}},
    {"remesh edge_length=100 faces=0,1", STRANGE, NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=100", PILLOW, NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=0.01 crease=3", PILLOW, NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=1.7 steps=1", SQUARE, FLAT_SQUARE, HE_OK, {1, 3, 2}},
    {"remesh edge_length=1.7 steps=1 project=0", SQUARE, FLAT_SQUARE, HE_OK, {1, 3, 2}},
    {"remesh edge_length=1 steps=1 keep_boundary=1", SQUARE, FLAT_SQUARE, HE_OK, {1, 3, 2}},
    {"remesh edge_length=1 steps=1 face=0", SQUARE, FLAT_SQUARE, HE_OK, {0, 0, 0}},
    {"remesh edge_length=1 steps=1", SQUARE, FLAT_SQUARE ";mark locked face=1", HE_OK, {0, 0, 0}},
    {"remesh target_faces=3 steps=1", SQUARE, FLAT_SQUARE, HE_OK, {1, 3, 2}},
    {"remesh edge_length=0", "012", NULL, HE_BAD_VALUE, {0}},
    {"remesh edge_length=-1", "012", NULL, HE_BAD_VALUE, {0}},
    {"remesh edge_length=1e-13", SQUARE, FLAT_SQUARE, HE_BAD_VALUE, {0}},
    {"remesh edge_length=1e-5", SQUARE, FLAT_SQUARE, HE_LIMIT, {0}},
    {"remesh edge_length=1", "012,0234", NULL, HE_NOT_TRIANGLE, {0}},
    {"remesh edge_length=100 face=0", "012,0234", NULL, HE_OK, {0, 0, 0}},
    {"remesh edge_length=1 face=7", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"remesh edge_length=1 face=0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"remesh edge_length=1 faces=0,1,0", "012,034", NULL, HE_REPEATED_ELEMENT, {0}},
    {.operation = NULL},
};
