/* scenarios.h - an operation on a mesh and what comes of it, for test_op_table.c. */
#ifndef TESTS_UNIT_SCENARIOS_H
#define TESTS_UNIT_SCENARIOS_H

#include "edit_script.h"

typedef struct scenario {
    const char *operation;
    const char *mesh;
    const char *prepare; /* a script that runs first, or NULL */
    he_status expected;
    int change[3]; /* of V, E, F, where it succeeds */
} scenario;

/* Beside those of test_op_table.c; each list ends in one without an operation. */
extern const scenario border_scenarios[];
extern const scenario weld_scenarios[];
extern const scenario corner_scenarios[];
extern const scenario loop_scenarios[];
extern const scenario region_scenarios[];
extern const scenario refine_scenarios[];
extern const scenario material_scenarios[];

#endif
