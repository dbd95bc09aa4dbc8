/* Tests of every operation in the table of operations. The operation must be able to succeed; each
 * error that it declares must occur, and no other error; the numbers of vertices, edges and faces
 * must change as declared; the resulting mesh must pass the checker; an error or a failed
 * allocation must leave every bit of the mesh unchanged; and the operation's delta must undo and
 * redo it. */
#include "edit_script.h"
#include "giants.h"
#include "scenarios.h"
#include "stored_trip.h"

#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CORNERS "vertex_move vertices=0,1,2,3 to=0,0,0,0,1,0,1,1,0,1,0,0"
#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define TETRA   "021,013,032,123"
#define PILLOW  "012,021"
#define STRANGE "012,034,056"
#define RING6   "301,320,431,523,653,634"
#define HEXAGON "012,023,034,045,056,061"
/* The Csaszar torus, in which all seven vertices are neighbours of each other. */
#define CSASZAR "013,032,124,143,235,254,346,365,450,406,561,510,602,621"

/* A list of vertices that is too long for comparing them pair by pair. */
#define MANY \
    "0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31,32,33"
#define MANY_MORE "+++++++++++++++++++++++++++++++++"

static const char MIRROR[] = "transform matrix=-1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1";

static const char FLAT_KITE[] = "vertex_move vertices=0,1,2,3 to=0,0,0,4,0,0,2,1,0,2,-1,0";

static const scenario scenarios[] = {
    {"vertex_add position=1,2,3", "", NULL, HE_OK, {1, 0, 0}},

    {"vertex_move vertex=1 to=0,0,9", "012", NULL, HE_OK, {0, 0, 0}},
    {"vertex_move vertices=1,2 by=0,0,9", "012", NULL, HE_OK, {0, 0, 0}},
    {"vertex_move vertices=1,2 to=0,0,9,1,2,3", "012", NULL, HE_OK, {0, 0, 0}},
    {"vertex_move vertex=3 to=0,0,9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_move vertices=0,3 to=0,0,9",
     "012+",
     "vertex_delete vertex=3",
     HE_DELETED_ELEMENT,
     {0}},
    {"vertex_move vertices=1,2,1 to=0,0,9", "012", NULL, HE_REPEATED_ELEMENT, {0}},
    {"vertex_move vertices=1,2,0 to=0,0,9,1,2,3", "012", NULL, HE_BAD_VALUE, {0}},
    {"vertex_move vertex=1 to=0,0,9,1,2,3", "012", NULL, HE_BAD_VALUE, {0}},
    {"vertex_move vertices=0,1 by=1e308,0,0",
     "012",
     "vertex_move vertex=1 to=1e308,0,0",
     HE_NOT_FINITE,
     {0}},

    {"vertex_move vertices=" MANY " by=0,0,1", "+" MANY_MORE, NULL, HE_OK, {0, 0, 0}},
    {"vertex_move vertices=" MANY ",7 by=0,0,1", "+" MANY_MORE, NULL, HE_REPEATED_ELEMENT, {0}},

    {"vertex_delete vertex=0", "012", NULL, HE_OK, {-3, -3, -1}},
    {"vertex_delete vertex=0 keep_isolated=1", "012", NULL, HE_OK, {-1, -3, -1}},
    {"vertex_delete vertex=3", "012+", NULL, HE_OK, {-1, 0, 0}},
    {"vertex_delete vertex=0", STRANGE, NULL, HE_OK, {-7, -9, -3}},
    {"vertex_delete vertex=0", QCUBE, NULL, HE_OK, {-1, -3, -3}},
    {"vertex_delete vertex=9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_delete vertex=3", "012+", "vertex_delete vertex=3", HE_DELETED_ELEMENT, {0}},

    {"vertex_split vertex=0 left=1 right=4 to=0,0,1", HEXAGON, NULL, HE_OK, {1, 3, 2}},
    {"vertex_split vertex=0 left=1 right=2 to=0,0,1", HEXAGON, NULL, HE_OK, {1, 3, 2}},
    {"vertex_split vertex=0 left=null right=2 to=0,0,1", "012,023", NULL, HE_OK, {1, 2, 1}},
    {"vertex_split vertex=0 left=null right=3 to=0,0,1", "012,023", NULL, HE_OK, {1, 2, 1}},
    {"vertex_split vertex=0 left=2 right=null to=0,0,1", "012,023", NULL, HE_OK, {1, 2, 1}},
    {"vertex_split vertex=0 left=1 right=2 to=0,0,1", "012,023", NULL, HE_OK, {1, 3, 2}},
    {"vertex_split vertex=0 left=2 right=1 to=0,0,1", "012,023", NULL, HE_OK, {1, 3, 2}},
    {"vertex_split vertex=0 left=1 right=3 to=0,0,1", "012,023", NULL, HE_OK, {1, 3, 2}},
    {"vertex_split vertex=7 left=1 right=4 to=0,0,1", HEXAGON, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_split vertex=0 left=1 right=7 to=0,0,1", HEXAGON, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"vertex_split vertex=0 left=3 right=1 to=0,0,1",
     "012+",
     "vertex_delete vertex=3",
     HE_DELETED_ELEMENT,
     {0}},
    {"vertex_split vertex=0 left=1 right=1 to=0,0,1", HEXAGON, NULL, HE_REPEATED_ELEMENT, {0}},
    {"vertex_split vertex=0 left=null right=null to=0,0,1", "012", NULL, HE_BAD_VALUE, {0}},
    {"vertex_split vertex=0 left=1 right=2 to=0,0,1", STRANGE, NULL, HE_BOWTIE, {0}},
    {"vertex_split vertex=0 left=null right=2 to=0,0,1", HEXAGON, NULL, HE_NOT_BOUNDARY, {0}},
    {"vertex_split vertex=0 left=1 right=null to=0,0,1", HEXAGON, NULL, HE_NOT_BOUNDARY, {0}},
    {"vertex_split vertex=0 left=1 right=2 to=0,0,1", QCUBE, NULL, HE_NOT_NEIGHBOUR, {0}},
    {"vertex_split vertex=0 left=1 right=0 to=0,0,1", QCUBE, NULL, HE_NOT_NEIGHBOUR, {0}},
    {"vertex_split vertex=3 left=null right=0 to=0,0,1", "012+", NULL, HE_NOT_NEIGHBOUR, {0}},
    {"vertex_split vertex=0 left=3 right=1 to=0,0,1", "012,023", NULL, HE_NO_SECTOR, {0}},
    {"vertex_split vertex=0 left=null right=1 to=0,0,1", "012,023", NULL, HE_NO_SECTOR, {0}},
    {"vertex_split vertex=0 left=3 right=null to=0,0,1", "012,023", NULL, HE_NO_SECTOR, {0}},

    {"edge_bisect edge=0-1", "012", NULL, HE_OK, {1, 1, 0}},
    {"edge_bisect edge=0-1 t=0.25", QCUBE, NULL, HE_OK, {1, 1, 0}},
    {"edge_bisect edge=#3", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_bisect edge=#0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},

    {"edge_join vertex=4", QCUBE, "edge_bisect edge=0-1;face_delete face=0", HE_WRONG_DEGREE, {0}},
    {"edge_join vertex=8", QCUBE, "edge_bisect edge=0-1;face_delete face=0", HE_OK, {-1, -1, 0}},
    {"edge_join vertex=8", QCUBE, "edge_bisect edge=0-1", HE_OK, {-1, -1, 0}},
    {"edge_join vertex=3", "0123", NULL, HE_OK, {-1, -1, 0}},
    {"edge_join vertex=9", "0123", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_join vertex=4", "0123+", "vertex_delete vertex=4", HE_DELETED_ELEMENT, {0}},
    {"edge_join vertex=4", "0123+", NULL, HE_WRONG_DEGREE, {0}},
    {"edge_join vertex=0", "012", NULL, HE_TRIANGLE_SIDE, {0}},
    {"edge_join vertex=0", "0123,314", NULL, HE_DOUBLED_EDGE, {0}},

    {"edge_split edge=0-1", QCUBE, NULL, HE_OK, {1, 3, 2}},
    {"edge_split edge=0-1 t=0.75", TETRA, NULL, HE_OK, {1, 3, 2}},
    {"edge_split edge=0-1", "012", NULL, HE_OK, {1, 2, 1}},
    {"edge_split edge=#3", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_split edge=#0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"edge_split edge=0-1", PILLOW, NULL, HE_DOUBLED_EDGE, {0}},

    {"edge_flip edge=0-2", "012,023", NULL, HE_OK, {0, 0, 0}},
    {"edge_flip edge=1-4", "0341,142", NULL, HE_OK, {0, 0, 0}},
    {"edge_flip edge=#9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_flip edge=#0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"edge_flip edge=0-1", "012", NULL, HE_BOUNDARY_EDGE, {0}},
    {"edge_flip edge=0-1", PILLOW, NULL, HE_SAME_ENDS, {0}},
    {"edge_flip edge=0-1", TETRA, NULL, HE_LOW_DEGREE, {0}},
    {"edge_flip edge=0-1", QCUBE, NULL, HE_LOW_DEGREE, {0}},
    {"edge_flip edge=0-1", "012,103,234", NULL, HE_DOUBLED_EDGE, {0}},
    {"edge_flip edge=0-1", "012536,103", NULL, HE_REPEATED_CORNER, {0}},
    {"edge_flip edge=0-1", "012,103425", NULL, HE_REPEATED_CORNER, {0}},

    {"edge_collapse halfedge=0-1", HEXAGON, NULL, HE_OK, {-1, -3, -2}},
    {"edge_collapse halfedge=1-0 t=1", HEXAGON, NULL, HE_OK, {-1, -3, -2}},
    {"edge_collapse edge=1-2 to=7,7,7", HEXAGON, NULL, HE_OK, {-1, -2, -1}},
    {"edge_collapse halfedge=1-4", "0341,142+", NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse halfedge=0-1", QCUBE, NULL, HE_OK, {-1, -1, 0}},
    {"edge_collapse halfedge=0-1", "0123", NULL, HE_OK, {-1, -1, 0}},
    {"edge_collapse halfedge=1-2", QCUBE, "face_triangulate face=0", HE_OK, {-1, -2, -1}},
    {"edge_collapse halfedge=#24", QCUBE, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_collapse edge=#12", QCUBE, NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_collapse halfedge=#0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"edge_collapse edge=0-1", PILLOW, NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-1", "0341,1452,2530", NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-2", "012,023", NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-2", "012", NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-1", "0123,045167", NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-1", TETRA, NULL, HE_LINK_CONDITION, {0}},
    {"edge_collapse edge=0-1", CSASZAR, NULL, HE_LINK_CONDITION, {0}},

    {"face_add vertices=0,1,2", "+++", NULL, HE_OK, {0, 3, 1}},
    {"face_add vertices=2,1,0", "012", NULL, HE_OK, {0, 0, 1}},
    {"face_add vertices=0,2,3", "012+", NULL, HE_OK, {0, 2, 1}},
    {"face_add vertices=0,4,1,5", STRANGE, NULL, HE_OK, {0, 2, 1}},
    {"face_add vertices=0,2,4,1", STRANGE, NULL, HE_CLOSED_FAN, {0}},
    {"face_add vertices=3,0,2", STRANGE, NULL, HE_OK, {0, 1, 1}},
    {"face_add vertices=5,0,4", STRANGE, NULL, HE_OK, {0, 1, 1}},
    {"face_add vertices=1,0,6", STRANGE, NULL, HE_OK, {0, 1, 1}},
    {"face_add vertices=5,0,2", STRANGE, NULL, HE_OK, {0, 1, 1}},
    {"face_add vertices=0,1,3,5", STRANGE, NULL, HE_ORIENTATION, {0}},
    {"face_add vertices=0,7,8", STRANGE "++", NULL, HE_OK, {0, 3, 1}},
    {"face_add vertices=0,1", "012", NULL, HE_TOO_FEW_CORNERS, {0}},
    {"face_add vertices=0,1,9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_add vertices=1,0,3", "012+", "vertex_delete vertex=3", HE_DELETED_ELEMENT, {0}},
    {"face_add vertices=1,0,3,1", "012+", NULL, HE_REPEATED_CORNER, {0}},
    {"face_add vertices=0,8,9", QCUBE "++", NULL, HE_INTERIOR_VERTEX, {0}},
    {"face_add vertices=0,2,4", "012,023+", NULL, HE_NONMANIFOLD_EDGE, {0}},
    {"face_add vertices=0,1,3", "012+", NULL, HE_ORIENTATION, {0}},
    {"face_add vertices=3,0,4", STRANGE, NULL, HE_CLOSED_FAN, {0}},

    {"face_delete face=0", QCUBE, NULL, HE_OK, {0, 0, -1}},
    {"face_delete faces=0,1", QCUBE, NULL, HE_OK, {0, 0, -2}},
    {"face_delete faces=0,1,2,3,4,5", QCUBE, NULL, HE_OK, {-8, -12, -6}},
    {"face_delete faces=0,1,2,3,4,5 keep_isolated=1", QCUBE, NULL, HE_OK, {0, -12, -6}},
    {"face_delete faces=1,0", STRANGE, NULL, HE_OK, {-4, -6, -2}},
    {"face_delete faces=", "012", NULL, HE_OK, {0, 0, 0}},
    {"face_delete face=1", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_delete faces=1,0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"face_delete faces=0,1,0", "012,034", NULL, HE_REPEATED_ELEMENT, {0}},

    {"face_split face=0 from=0 to=2", "0123", NULL, HE_OK, {0, 1, 1}},
    {"face_split face=0 from_halfedge=1-2 to=3", "0123", NULL, HE_OK, {0, 1, 1}},
    {"face_split face=0 from_halfedge=1-2 to_halfedge=4-0", "01234", NULL, HE_OK, {0, 1, 1}},
    {"face_split face=1 from=0 to=2", "0123", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_split face=0 from=0 to=9", "0123", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_split face=0 from_halfedge=#8 to=2", "0123", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_split face=0 from=0 to=4", "0123+", "vertex_delete vertex=4", HE_DELETED_ELEMENT, {0}},
    {"face_split face=0 from=0 to=4", "0123+", NULL, HE_NOT_A_CORNER, {0}},
    {"face_split face=0 from_halfedge=1-0 to=2", "0123", NULL, HE_NOT_A_CORNER, {0}},
    {"face_split face=0 from_halfedge=0-1 to=0", "0123", NULL, HE_SAME_CORNER, {0}},
    {"face_split face=0 from=0 to=1", "0123", NULL, HE_ADJACENT_CORNERS, {0}},
    {"face_split face=0 from=0 to=3", "0123", NULL, HE_ADJACENT_CORNERS, {0}},
    {"face_split face=0 from=0 to=2", "0123,024", NULL, HE_DOUBLED_EDGE, {0}},

    {"face_join edge=0-1", QCUBE, NULL, HE_OK, {0, -1, -1}},
    {"face_join edge=0-2", "012,023", NULL, HE_OK, {0, -1, -1}},
    {"face_join edge=#9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_join edge=#0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"face_join edge=0-1", "012", NULL, HE_BOUNDARY_EDGE, {0}},
    {"face_join edge=0-1", PILLOW, NULL, HE_SHARED_BOUNDARY, {0}},
    {"face_join edge=0-1", "012536,103", NULL, HE_SHARED_BOUNDARY, {0}},

    {"face_poke face=0", "0123", NULL, HE_OK, {1, 4, 3}},
    {"face_poke face=1 position=9,9,9", PILLOW, NULL, HE_OK, {1, 3, 2}},
    {"face_poke face=1", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_poke face=0", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},

    {"face_triangulate face=0", "0123", NULL, HE_OK, {0, 1, 1}},
    {"face_triangulate face=0", "012", NULL, HE_OK, {0, 0, 0}},
    {"face_triangulate faces=0,1,2,3,4,5", QCUBE, NULL, HE_OK, {0, 6, 6}},
    {"face_triangulate faces=0,1", "0123,3210", NULL, HE_OK, {0, 2, 2}},
    {"face_triangulate face=0", "0123,024", NULL, HE_OK, {0, 1, 1}},
    {"face_triangulate face=1", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"face_triangulate faces=1,0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"face_triangulate faces=0,0", "0123", NULL, HE_REPEATED_ELEMENT, {0}},
    {"face_triangulate faces=1,0", "0123,024,4567,135", NULL, HE_DOUBLED_EDGE, {0}},
    {"face_triangulate faces=2,0", "0123,024,4567,135", NULL, HE_DOUBLED_EDGE, {0}},

    {"hole_fill halfedge=0-1", QCUBE, "face_delete face=0", HE_OK, {0, 0, 1}},
    {"hole_fill halfedge=0-1 method=fan", QCUBE, "face_delete face=0", HE_OK, {1, 4, 4}},
    {"hole_fill halfedge=0-1 method=triangulate", QCUBE, "face_delete face=0", HE_OK, {0, 1, 2}},
    {"hole_fill halfedge=1-0 method=triangulate", "012", NULL, HE_OK, {0, 0, 1}},
    {"hole_fill halfedge=#6", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"hole_fill halfedge=#1", "012", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"hole_fill halfedge=0-1", "012", NULL, HE_NOT_BOUNDARY, {0}},
    {"hole_fill halfedge=1-0", "012,034", NULL, HE_REPEATED_CORNER, {0}},
    {"hole_fill halfedge=0-2 method=triangulate",
     CSASZAR,
     "vertex_delete vertex=6",
     HE_DOUBLED_EDGE,
     {0}},
    {"hole_fill halfedge=0-2 method=fan", CSASZAR, "vertex_delete vertex=6", HE_OK, {1, 6, 6}},
    {"hole_fill halfedge=0-1 method=smooth edge_length=100",
     QCUBE,
     "face_delete face=0",
     HE_OK,
     {0, 1, 2}},
    {"hole_fill halfedge=0-2 method=smooth edge_length=100",
     CSASZAR,
     "vertex_delete vertex=6",
     HE_OK,
     {1, 6, 6}},
    {"hole_fill halfedge=0-1 method=smooth edge_length=1e-9 continuity=2",
     QCUBE,
     "face_delete face=0;" CORNERS,
     HE_LIMIT,
     {0}},
    {"fill_holes", QCUBE, NULL, HE_OK, {0, 0, 0}},
    {"fill_holes", "", NULL, HE_OK, {0, 0, 0}},
    {"fill_holes", "012,034", NULL, HE_OK, {0, 0, 0}},
    {"fill_holes max_edges=3", QCUBE, "face_delete face=0", HE_OK, {0, 0, 0}},
    {"fill_holes method=polygon", QCUBE, "face_delete face=0", HE_OK, {0, 0, 1}},
    {"fill_holes method=fan", QCUBE, "face_delete face=0", HE_OK, {1, 4, 4}},
    {"fill_holes method=triangulate max_size=100", QCUBE, "face_delete face=0", HE_OK, {0, 1, 2}},
    {"fill_holes edge_length=100", QCUBE, "face_delete face=0", HE_OK, {0, 1, 2}},
    {"fill_holes edge_length=1e-9 continuity=0",
     QCUBE,
     "face_delete face=0;" CORNERS,
     HE_LIMIT,
     {0}},

    {MIRROR, "012,034+", "face_delete face=1", HE_OK, {0, 0, 0}},
    {"transform matrix=2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1 vertices=0,2",
     "012",
     NULL,
     HE_OK,
     {0, 0, 0}},
    {"transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 vertex=9",
     "012",
     NULL,
     HE_NO_SUCH_ELEMENT,
     {0}},
    {"transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 vertices=0,3",
     "012+",
     "vertex_delete vertex=3",
     HE_DELETED_ELEMENT,
     {0}},
    {"transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 vertices=0,1,0",
     "012",
     NULL,
     HE_REPEATED_ELEMENT,
     {0}},
    {"transform matrix=1e308,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "012", NULL, HE_NOT_FINITE, {0}},

    {"plane_split point=0.5,0,0 normal=1,0,0", "0123", NULL, HE_OK, {2, 3, 1}},
    {"plane_split point=1,0,0 normal=-7,0,0", "0123", NULL, HE_OK, {1, 2, 1}},
    {"plane_split point=3,0,0 normal=1,0,0 tolerance=1.5", "01234567", NULL, HE_OK, {1, 2, 1}},
    {"plane_split point=9,0,0 normal=1,0,0", "0123", NULL, HE_OK, {0, 0, 0}},
    {"plane_split point=3.5,0,0 normal=1,0,0", QCUBE, NULL, HE_OK, {4, 8, 4}},
    {"plane_split point=0.5,0,0 normal=1,0,0", STRANGE, NULL, HE_OK, {6, 9, 3}},
    {"plane_split point=0.5,0,0 normal=1,0,0 face=0", "012,103", NULL, HE_OK, {2, 3, 1}},
    {"plane_split point=0.5,0,0 normal=1,0,0 faces=0,1",
     "012,034",
     "face_delete face=0",
     HE_DELETED_ELEMENT,
     {0}},
    {"plane_split point=0.5,0,0 normal=1,0,0 face=1", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"plane_split point=0.5,0,0 normal=1,0,0 faces=0,1,0",
     "012,034",
     NULL,
     HE_REPEATED_ELEMENT,
     {0}},
    {"plane_split point=0.5,0,0 normal=0,0,0", "012", NULL, HE_BAD_VALUE, {0}},
    {"plane_split point=0.5,0,0 normal=1,0,0 tolerance=-1", "012", NULL, HE_BAD_VALUE, {0}},
    {"plane_split point=0.5,0,0 normal=1,0,0", PILLOW, NULL, HE_DOUBLED_EDGE, {0}},
    {"plane_split point=0.5,0,0 normal=1,0,0 face=1", PILLOW, NULL, HE_OK, {2, 3, 1}},

    {"delaunay", "", NULL, HE_OK, {0, 0, 0}},
    {"delaunay", "012,103", FLAT_KITE, HE_OK, {0, 0, 0}},
    {"delaunay edge=0-1", "012,103", FLAT_KITE, HE_OK, {0, 0, 0}},
    {"delaunay edges=1-2,0-2", "012,103", FLAT_KITE, HE_OK, {0, 0, 0}},
    {"delaunay edge=#9", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"delaunay edges=0-3,#0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"delaunay edges=0-1,1-0", "012", NULL, HE_REPEATED_ELEMENT, {0}},

    {"vertex_move vertices=0,1 by=0,0,1", "012", "mark locked vertex=1", HE_LOCKED_ELEMENT, {0}},
    {"vertex_move vertices=0,1 by=0,0,1",
     "012",
     "mark locked vertex=2;mark locked face=0;mark locked edge=0-1",
     HE_OK,
     {0, 0, 0}},
    {"vertex_delete vertex=0", "012", "mark locked vertex=0", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=3", "012+", "mark locked vertex=3", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=0", "012,034", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=0", "012", "mark locked vertex=2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=0 keep_isolated=1", "012", "mark locked vertex=2", HE_OK, {-1, -3, -1}},
    {"vertex_delete vertex=0", "012", "mark locked edge=1-2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=0", PILLOW, "mark locked edge=1-2", HE_LOCKED_ELEMENT, {0}},
    {"vertex_delete vertex=0",
     QCUBE,
     "mark locked edge=1-2;mark locked vertex=1",
     HE_OK,
     {-1, -3, -3}},
    {"vertex_delete vertex=0", QCUBE, "mark locked edge=0-1", HE_LOCKED_ELEMENT, {0}},
    {"edge_join vertex=3", "0123", "mark locked vertex=3", HE_LOCKED_ELEMENT, {0}},
    {"edge_join vertex=3", "0123", "mark locked edge=3-0", HE_LOCKED_ELEMENT, {0}},
    {"edge_join vertex=3", "0123", "mark locked edge=2-3", HE_LOCKED_ELEMENT, {0}},
    {"edge_join vertex=3", "0123", "mark locked face=0", HE_LOCKED_ELEMENT, {0}},
    {"edge_join vertex=3", "0123", "mark locked edge=0-1", HE_OK, {-1, -1, 0}},
    {"edge_bisect edge=0-1", "012", "mark locked edge=0-1;mark locked face=0", HE_OK, {1, 1, 0}},
    {"edge_flip edge=0-2", "012,023", "mark feature edge=0-2", HE_FEATURE_EDGE, {0}},
    {"edge_flip edge=0-2", "012,023", "mark locked edge=0-2", HE_LOCKED_ELEMENT, {0}},
    {"edge_flip edge=0-2", "012,023", "mark locked face=0", HE_LOCKED_ELEMENT, {0}},
    {"edge_flip edge=0-2", "012,023", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},
    {"edge_flip edge=0-2",
     "012,023",
     "mark locked vertex=0;mark feature edge=0-1",
     HE_OK,
     {0, 0, 0}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark locked vertex=0", HE_LOCKED_ELEMENT, {0}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark locked vertex=1", HE_LOCKED_ELEMENT, {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark locked vertex=1", HE_OK, {-1, -3, -2}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark locked edge=0-1", HE_LOCKED_ELEMENT, {0}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark locked edge=0-4", HE_LOCKED_ELEMENT, {0}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark locked face=3", HE_LOCKED_ELEMENT, {0}},
    {"edge_collapse halfedge=1-0 t=1",
     HEXAGON,
     "mark locked vertex=0;mark locked face=3;mark locked edge=0-2",
     HE_OK,
     {-1, -3, -2}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark feature edge=0-3", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark feature edge=0-1", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1 t=1",
     HEXAGON,
     "mark feature edges=0-1,0-3,0-5",
     HE_FEATURE_EDGE,
     {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark feature edges=0-1,0-2", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark feature edges=0-1,0-6", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark feature edges=0-1,0-4", HE_OK, {-1, -3, -2}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark feature edges=0-1,0-4", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark feature edges=0-1,0-4,1-6", HE_OK, {-1, -3, -2}},
    {"edge_collapse halfedge=0-1", HEXAGON, "mark feature edge=1-2", HE_FEATURE_EDGE, {0}},
    {"edge_collapse halfedge=0-1 t=1", HEXAGON, "mark feature edge=1-2", HE_OK, {-1, -3, -2}},
    {"face_delete face=0", "012", "mark locked face=0", HE_LOCKED_ELEMENT, {0}},
    {"face_delete face=0", "012", "mark locked edge=1-2", HE_LOCKED_ELEMENT, {0}},
    {"face_delete face=0", "012", "mark locked vertex=2", HE_LOCKED_ELEMENT, {0}},
    {"face_delete face=0 keep_isolated=1", "012", "mark locked vertex=2", HE_OK, {0, -3, -1}},
    {"face_delete faces=0,1", "012,103", "mark locked edge=0-1", HE_LOCKED_ELEMENT, {0}},
    {"face_delete face=0",
     "012,103",
     "mark locked vertices=0,1;mark locked edge=0-1",
     HE_OK,
     {-1, -2, -1}},
    {"face_join edge=0-2", "012,023", "mark locked edge=0-2", HE_LOCKED_ELEMENT, {0}},
    {"face_join edge=0-2", "012,023", "mark locked face=0", HE_LOCKED_ELEMENT, {0}},
    {"face_join edge=0-2", "012,023", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},
    {"face_join edge=0-2", "012,023", "mark feature edge=0-2", HE_OK, {0, -1, -1}},
    {"transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1",
     "012",
     "mark locked vertex=1",
     HE_LOCKED_ELEMENT,
     {0}},
    {"transform matrix=1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 vertices=0,2",
     "012",
     "mark locked vertex=1",
     HE_OK,
     {0, 0, 0}},

    {"compact", "012,034+", "face_delete face=0", HE_OK, {0, 0, 0}},
    {"compact", "", NULL, HE_OK, {0, 0, 0}},
    {.operation = NULL},
};

static const scenario *const groups[] = {scenarios,        border_scenarios,   weld_scenarios,
                                         corner_scenarios, loop_scenarios,     region_scenarios,
                                         refine_scenarios, material_scenarios, select_scenarios};

enum { MAX_OPS = 128 };

/* Whether a scenario of this run has made an operation (the first index) return a status (the
 * second index). */
static bool produced[MAX_OPS][HE_STATUS_COUNT];

static void mark(const he_op *op, he_status status)
{
    for (size_t i = 0; i < he_op_count(); i++) {
        if (he_op_at(i) == op) {
            produced[i][status] = true;
        }
    }
}

static he_mesh *start_of(const scenario *s, bool columns)
{
    he_mesh *m = script_mesh(s->mesh, NULL);
    if (columns) {
        script_add_columns(m);
    }
    script_prepare(m, s->prepare);
    return m;
}

static void check_change(const scenario *s, const he_mesh *before, const he_mesh *after)
{
    const he_op *op = script_op(s->operation);
    static const he_kind kinds[3] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (unsigned k = 0; k < 3; k++) {
        int change = (int)he_mesh_count(after, kinds[k]) - (int)he_mesh_count(before, kinds[k]);
        assert_int_equal(change, s->change[k]);
        if (op->change[k] != HE_VARIES) {
            assert_int_equal(change, op->change[k]);
        }
    }
}

/* Runs a scenario while changes are recorded. If the scenario's operation succeeds, the delta must
 * undo and redo it; if the operation is refused, nothing must be recorded. */
static void run_recorded(const scenario *s, bool columns)
{
    he_mesh *m = start_of(s, columns), *before = copy_of(m);
    assert_valid(m);
    he_delta *delta = he_delta_new();
    he_error err = {.status = HE_OK};
    he_results results = {.each = false};
    assert_non_null(delta);
    he_mesh_record(m, delta);
    he_status status = script_run(m, s->operation, &results, &err);
    if (status != s->expected) {
        fail_msg("gave %s (%s), not %s", he_status_slug(status), err.text,
                 he_status_slug(s->expected));
    }
    mark(script_op(s->operation), status);
    assert_valid(m);
    if (status != HE_OK) {
        assert_int_equal(err.status, status);
        assert_true(err.text[0] != '\0');
        assert_int_equal(delta->count, 0);
        assert_equal(m, before);
    } else {
        check_change(s, before, m);
        he_mesh *after = copy_of(m);
        he_mesh_record(m, NULL);
        stored_trip(before, delta, after);
        he_delta_undo(delta, m);
        assert_valid(m);
        assert_true(he_mesh_equal_live(m, before));
        he_delta_redo(delta, m);
        assert_equal(m, after);
        he_mesh_free(after);
    }
    he_mesh_record(m, NULL);
    he_results_clear(&results);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* Runs a scenario again and again: in run n, the n-th allocation fails. The changes are recorded or
 * not, as the caller requests. */
static void run_short_of_memory(const scenario *s, bool columns, bool record)
{
    /* A tree of boxes keeps its block if that cannot be made smaller. */
    const bool has_tree = strncmp(s->operation, "deviation", strlen("deviation")) == 0;
    failing f = {.what = s->operation, .may_succeed = has_tree};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = start_of(s, columns), *before = copy_of(m);
        he_delta *delta = record ? he_delta_new() : NULL;
        he_mesh_record(m, delta);
        failing_resume();
        he_status status = script_run(m, s->operation, NULL, NULL);
        if (failing_end(&f, status != HE_NO_MEMORY)) {
            assert_int_equal(status, s->expected);
        }
        he_mesh_record(m, NULL);
        assert_valid(m);
        if (status != HE_OK) {
            assert_equal(m, before);
        }
        he_delta_free(delta);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void each_scenario_succeeds_or_is_refused_as_its_row_declares(void **state)
{
    (void)state;
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
        for (const scenario *s = groups[g]; s->operation != NULL; s++) {
            print_message("%s on %s\n", s->operation, s->mesh);
            for (unsigned columns = 0; columns < 2; columns++) {
                run_recorded(s, columns);
                run_short_of_memory(s, columns, false);
                run_short_of_memory(s, columns, true);
            }
        }
    }
}

static void too_much_work_is_refused_without_change(void **state)
{
    (void)state;
    static const struct {
        const char *operation;
        he_mesh *(*make)(void);
    } works[] = {
        {"delaunay", giant_rows},
        {"face_inset face=0 distance=0.1", giant_star},
        {"face_collapse face=0", giant_star},
        {"select by=measure measure=mean_curvature elements=vertices", giant_star},
        {"deform vertex=1 by=0,0,1 method=biharmonic", giant_hub},
    };
    for (unsigned i = 0; i < sizeof works / sizeof *works; i++) {
        const char *operation = works[i].operation;
        he_mesh *m = works[i].make();
        assert_non_null(m);
        he_mesh *before = copy_of(m);
        assert_int_equal(script_run(m, operation, NULL, NULL), HE_LIMIT);
        assert_equal(m, before);
        mark(script_op(operation), HE_LIMIT);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

/* This test must run after all others: each operation must declare exactly the errors that the
 * scenarios have produced. */
static void each_declared_refusal_occurs_and_no_other(void **state)
{
    (void)state;
    unsigned missing = 0;
    assert_true(he_op_count() <= MAX_OPS);
    for (size_t i = 0; i < he_op_count(); i++) {
        const he_op *op = he_op_at(i);
        for (unsigned status = 0; status < HE_STATUS_COUNT; status++) {
            bool declared = status == HE_OK;
            for (size_t k = 0; k < HE_OP_REFUSALS && op->refusals[k] != HE_OK; k++) {
                declared |= op->refusals[k] == (he_status)status;
            }
            if (declared != produced[i][status]) {
                print_message("%s: %s %s\n", op->name, he_status_slug((he_status)status),
                              declared ? "was never produced" : "is not declared");
                missing++;
            }
        }
    }
    assert_int_equal(missing, 0);
}

/* Checks what parameter k says about the operation's selector: there is one, before the parameters
 * that depend on it, and all of these name choices that it has. */
static void check_selector(const he_op *op, size_t k)
{
    const he_param *param = &op->params[k], *selector = he_op_selector(op);
    size_t choices = 0;
    if (param->flags & HE_SELECTS) {
        assert_ptr_equal(param, selector);
        assert_int_equal(param->type, HE_PARAM_CHOICE);
    }
    if (param->with == 0) {
        assert_int_equal(param->needed, 0);
        return;
    }
    assert_true(selector != NULL && selector < param);
    while (selector->choices[choices] != NULL) {
        choices++;
    }
    assert_int_equal(param->with >> choices, 0);
    assert_int_equal(param->needed & ~param->with, 0);
    assert_false(param->flags & HE_REQUIRED);
}

static void rows_are_complete_and_found_by_name(void **state)
{
    (void)state;
    for (size_t i = 0; i < he_op_count(); i++) {
        const he_op *op = he_op_at(i);
        assert_ptr_equal(he_op_find(op->name, strlen(op->name)), op);
        assert_non_null(op->doc);
        assert_non_null(op->run);
        assert_int_equal(op->refusals[HE_OP_REFUSALS - 1], HE_OK);
        for (size_t k = 0; k < he_op_params(op); k++) {
            const he_param *param = &op->params[k];
            assert_non_null(param->doc);
            assert_int_equal(param->type == HE_PARAM_ELEMENTS, param->plural != NULL);
            assert_int_equal(param->type == HE_PARAM_CHOICE, param->choices != NULL);
            assert_true(!(param->flags & HE_DERIVED) || param->type == HE_PARAM_NUMBER ||
                        param->type == HE_PARAM_FLAG || param->type == HE_PARAM_CHOICE);
            check_selector(op, k);
            assert_true(!(param->flags & HE_WHOLE) ||
                        (param->type == HE_PARAM_NUMBER && (param->flags & HE_RANGE)));
            for (size_t j = 0; j < k; j++) {
                assert_string_not_equal(op->params[j].name, param->name);
            }
        }
        for (size_t k = 0; k < he_op_results(op); k++) {
            assert_non_null(op->results[k].doc);
        }
    }
    assert_null(he_op_find("edge_spli", 9));
    assert_null(he_op_find("edge_split_", 11));
    assert_null(he_op_find("", 0));
}

static void results_are_reported_and_a_refusal_leaves_them_empty(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,023", NULL);
    he_results results = {.each = false};
    assert_int_equal(script_run(m, "edge_split edge=0-2", &results, NULL), HE_OK);
    assert_true(results.present[0] && results.present[1] && results.present[2]);
    assert_int_equal(results.id[0], 4);
    assert_int_equal(results.list[1].count, 3);
    assert_int_equal(results.list[1].ids[0], 5);
    assert_int_equal(results.list[2].count, 2);
    assert_int_equal(results.list[2].ids[1], 3);
    /* An operation that fails must clear the results that were stored before. */
    assert_int_equal(script_run(m, "edge_split edge=#99", &results, NULL), HE_NO_SUCH_ELEMENT);
    assert_false(results.present[0]);
    assert_int_equal(results.list[1].count, 0);
    script_prepare(m, "face_delete face=0");
    assert_int_equal(script_run(m, "compact", &results, NULL), HE_OK);
    assert_int_equal(results.list[2].count, 4);
    assert_int_equal(results.list[2].ids[0], HE_NONE);
    assert_int_equal(results.list[2].ids[3], 2);
    he_results_clear(&results);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_complete_and_found_by_name),
        cmocka_unit_test(each_scenario_succeeds_or_is_refused_as_its_row_declares),
        cmocka_unit_test(too_much_work_is_refused_without_change),
        cmocka_unit_test(each_declared_refusal_occurs_and_no_other),
        cmocka_unit_test(results_are_reported_and_a_refusal_leaves_them_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
