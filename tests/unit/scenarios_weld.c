#include "scenarios.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define TETRA   "021,013,032,123"
#define PILLOW  "012,021"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"
/* Faces of a mesh of three quadrilaterals: the first two share an edge, and the third does not
 * touch them. */
#define APART "0154,1265,378b"

/* Operation on the mesh APART: moves vertex 3 to the position of vertex 2, and vertex 11 to the
 * position of vertex 6. */
static const char TOGETHER[] = "vertex_move vertices=3,11,2,6 to=0,0,1,0,1,1,0,0,1,0,1,1";

const scenario weld_scenarios[] = {
    {"vertex_weld vertices=4,2", "012,345", NULL, HE_OK, {-1, 0, 0}},
    {"vertex_weld vertex=2", "012,345", NULL, HE_OK, {0, 0, 0}},
    {"vertex_weld vertices=", "012,345", NULL, HE_OK, {0, 0, 0}},
    {"vertex_weld vertices=0,3", "012+", NULL, HE_OK, {-1, 0, 0}},
    {"vertex_weld vertices=0,8 position=lowest", QCUBE "+", NULL, HE_OK, {-1, 0, 0}},
    /* A weld can merge two sides of faces into one edge: it is refused if both faces use this edge
     * in the same direction, or if more than two faces use it. */
    {"vertex_weld vertices=1,3", "012,034", NULL, HE_ORIENTATION, {0}},
    {"vertex_weld vertices=1,4", "012,103,045", NULL, HE_NONMANIFOLD_EDGE, {0}},
    {"vertex_weld vertices=3,4", "012,023,041", NULL, HE_OK, {-1, -1, 0}},
    /* Welding neighbouring corners of a face removes the edge between them; a face with fewer than
     * three corners left is deleted, with the vertices and edges that no other face uses. */
    {"vertex_weld vertices=0,1", "012", NULL, HE_OK, {-2, -3, -1}},
    {"vertex_weld vertices=0,1,2", "012", NULL, HE_OK, {-2, -3, -1}},
    {"vertex_weld vertices=0,1", "0123", NULL, HE_OK, {-1, -1, 0}},
    {"vertex_weld vertices=0,1", HEXAGON, NULL, HE_OK, {-1, -3, -2}},
    {"vertex_weld vertices=0,1", QCUBE, NULL, HE_OK, {-1, -1, 0}},
    {"vertex_weld vertices=0,1,2,3", QCUBE, NULL, HE_OK, {-3, -4, -1}},
    {"vertex_weld vertices=0,1", TETRA, NULL, HE_OK, {-1, -3, -2}},
    {"vertex_weld vertices=0,1", PILLOW, NULL, HE_OK, {-2, -3, -2}},
    /* If a weld makes several faces equal, all but one of them are deleted. */
    {"weld tolerance=0",
     "012,345",
     "vertex_move vertices=0,3 to=0,0,0;vertex_move vertices=1,4 to=1,0,0;"
     "vertex_move vertices=2,5 to=0,1,0",
     HE_OK,
     {-3, -3, -1}},
    {"weld tolerance=0",
     "012,354",
     "vertex_move vertices=0,3 to=0,0,0;vertex_move vertices=1,4 to=1,0,0;"
     "vertex_move vertices=2,5 to=0,1,0",
     HE_OK,
     {-3, -3, 0}},
    {"vertex_weld tolerance=1e-3 position=lowest", APART, TOGETHER, HE_OK, {-2, -1, 0}},
    {"weld tolerance=0", APART, TOGETHER, HE_OK, {-2, -1, 0}},
    {"weld tolerance=1e-320", APART, TOGETHER, HE_OK, {-2, -1, 0}},
    {"weld tolerance=0", APART, NULL, HE_OK, {0, 0, 0}},
    {"weld tolerance=1e300", APART, NULL, HE_OK, {-11, -11, -3}},
    {"weld tolerance=0", "", NULL, HE_OK, {0, 0, 0}},
    {"weld tolerance=-1", "012", NULL, HE_BAD_VALUE, {0}},
    {"vertex_weld tolerance=-1", "012", NULL, HE_BAD_VALUE, {0}},
    {"vertex_weld vertices=0,9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_weld vertices=0,3", "012+", "vertex_delete vertex=3", HE_DELETED_ELEMENT, {0}},
    {"vertex_weld vertices=0,1,0", "012", NULL, HE_REPEATED_ELEMENT, {0}},
    {"vertex_weld vertices=0,2", "0123", NULL, HE_REPEATED_CORNER, {0}},
    {"weld tolerance=0", "0123", "vertex_move vertices=0,2 to=9,9,9", HE_REPEATED_CORNER, {0}},
    {"vertex_weld vertices=0,6", QCUBE, NULL, HE_CLOSED_FAN, {0}},
    {"vertex_weld vertices=0,8", QCUBE ",89a", NULL, HE_CLOSED_FAN, {0}},
    {"weld tolerance=0", QCUBE, "vertex_move vertices=0,6 to=9,9,9", HE_CLOSED_FAN, {0}},
    {"weld tolerance=0", "012,034", "vertex_move vertices=1,3 to=9,9,9", HE_ORIENTATION, {0}},
    {"weld tolerance=0",
     "012,103,045",
     "vertex_move vertices=1,4 to=9,9,9",
     HE_NONMANIFOLD_EDGE,
     {0}},
    {"weld tolerance=0",
     APART,
     "vertex_move vertices=3,11,2,6 to=0,0,1,0,1,1,0,0,1,0,1,1;mark locked vertex=2",
     HE_OK,
     {-2, -1, 0}},
    {"weld tolerance=0",
     APART,
     "vertex_move vertices=3,11,2,6 to=0,0,1,0,1,1,0,0,1,0,1,1;mark locked vertex=3",
     HE_LOCKED_ELEMENT,
     {0}},
    {"vertex_weld vertices=2,4", "012,345", "mark locked vertex=2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_weld vertices=2,4 position=lowest",
     "012,345",
     "mark locked vertex=2;mark locked face=0;mark locked edge=0-2",
     HE_OK,
     {-1, 0, 0}},
    {"vertex_weld vertices=2,4", "012,345", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},
    {"vertex_weld vertices=2,4", "012,345", "mark locked edge=3-4", HE_LOCKED_ELEMENT, {0}},
    {"vertex_weld vertices=0,1", "012", "mark locked vertex=2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_weld vertices=0,1", "012", "mark locked edge=1-2", HE_LOCKED_ELEMENT, {0}},

    {"vertex_separate vertex=0", STRANGE, NULL, HE_OK, {2, 0, 0}},
    {"vertex_separate vertex=1", STRANGE, NULL, HE_OK, {0, 0, 0}},
    {"vertex_separate vertex=0", QCUBE, NULL, HE_OK, {0, 0, 0}},
    {"vertex_separate vertices=0,7", "012,034+++", NULL, HE_OK, {1, 0, 0}},
    /* Vertices 0 and 1 are neighbours, and each is a bow-tie of two fans of faces. */
    {"vertex_separate vertices=0,1", "012,034,156", NULL, HE_OK, {2, 0, 0}},
    {"vertex_separate vertex=7", STRANGE, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_separate vertices=0,7",
     STRANGE "+",
     "vertex_delete vertex=7",
     HE_DELETED_ELEMENT,
     {0}},
    {"vertex_separate vertices=0,1,0", STRANGE, NULL, HE_REPEATED_ELEMENT, {0}},
    {"vertex_separate vertex=0", STRANGE, "mark locked faces=0,1,2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_separate vertex=0", STRANGE, "mark locked edges=0-2,0-4,0-6", HE_LOCKED_ELEMENT, {0}},
    {"vertex_separate vertex=0", STRANGE, "mark locked vertex=0", HE_OK, {2, 0, 0}},

    {"separate_bowties", STRANGE, NULL, HE_OK, {2, 0, 0}},
    {"separate_bowties", QCUBE, NULL, HE_OK, {0, 0, 0}},
    {"separate_bowties", "012,034,156", NULL, HE_OK, {2, 0, 0}},
    {"separate_bowties", STRANGE, "mark locked faces=0,1,2", HE_LOCKED_ELEMENT, {0}},

    {"delete_isolated", "012++", NULL, HE_OK, {-2, 0, 0}},
    {"delete_isolated", "012", NULL, HE_OK, {0, 0, 0}},
    {"delete_isolated", "012++", "mark locked vertex=4", HE_LOCKED_ELEMENT, {0}},
    {.operation = NULL},
};
