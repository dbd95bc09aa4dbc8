/* scenarios.h - operations on small meshes and their expected outcomes, which test_op_table.c
 * runs. */
#ifndef TESTS_UNIT_SCENARIOS_H
#define TESTS_UNIT_SCENARIOS_H

#include "edit_script.h"

typedef struct scenario {
    const char *operation;
    const char *mesh;
    const char *prepare; /* a script that runs before the operation, or NULL */
    he_status expected;
    /* changes of the numbers of vertices, edges and faces if the operation succeeds */
    int change[3];
} scenario;

/* Scenarios for test_op_table.c, sorted by the operations they test. The last element of each list
 * has no operation. */
extern const scenario border_scenarios[];
extern const scenario weld_scenarios[];
extern const scenario corner_scenarios[];
extern const scenario loop_scenarios[];
extern const scenario region_scenarios[];
extern const scenario refine_scenarios[];
extern const scenario material_scenarios[];
extern const scenario select_scenarios[];

#endif
