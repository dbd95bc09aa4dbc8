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
    int change[3]; /* change of V, E, F on success */
} scenario;

/* The scenarios that are not in test_op_table.c; each list ends in one without an operation. */
extern const scenario border_scenarios[];
extern const scenario weld_scenarios[];
extern const scenario corner_scenarios[];
extern const scenario loop_scenarios[];
extern const scenario region_scenarios[];
extern const scenario refine_scenarios[];
extern const scenario material_scenarios[];

#endif
