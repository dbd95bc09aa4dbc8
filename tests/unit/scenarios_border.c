#include "scenarios.h"

#define QCUBE   "0123,7654,1045,2156,3267,0374"
#define RING10  "401,430,512,541,652,734,874,845,985,956"
#define STRANGE "012,034,056"
#define HEXAGON "012,023,034,045,056,061"

const scenario border_scenarios[] = {
    {"edge_delete edge=4-5", RING10, NULL, HE_OK, {0, -1, -2}},
    {"edge_delete edge=0-1", "012", NULL, HE_OK, {-3, -3, -1}},
    {"edge_delete edge=0-1 keep_isolated=1", "012", NULL, HE_OK, {0, -3, -1}},
    {"edge_delete edges=0-1,1-2,2-0", "012", NULL, HE_OK, {-3, -3, -1}},
    {"edge_delete edges=0-1,6-7", QCUBE, NULL, HE_OK, {0, -4, -4}},
    {"edge_delete edges=1-2,3-4,5-6", STRANGE, NULL, HE_OK, {-7, -9, -3}},
    {"edge_delete edge=#3", "012", NULL, HE_NO_SUCH_ELEMENT, {0}},
    {"edge_delete edges=0-3,#0", "012,034", "face_delete face=0", HE_DELETED_ELEMENT, {0}},
    {"edge_delete edges=0-1,1-2,1-0", "012", NULL, HE_REPEATED_ELEMENT, {0}},
    {"edge_delete edge=0-1", "012", "mark locked vertex=2", HE_LOCKED_ELEMENT, {0}},
    {"edge_delete edge=0-1 keep_isolated=1", "012", "mark locked vertex=2", HE_OK, {0, -3, -1}},
    {"edge_delete edge=0-2", "012,023", "mark locked face=1", HE_LOCKED_ELEMENT, {0}},
    {"edge_delete edges=0-1,0-3", HEXAGON, "mark locked edge=0-2", HE_LOCKED_ELEMENT, {0}},
    {"edge_delete edge=0-1", HEXAGON, "mark locked edge=0-2", HE_OK, {-1, -3, -2}},
    {.operation = NULL},
};
