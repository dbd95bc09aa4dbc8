/* result_names.h - the names that operations of one edit list have ("as"), and the results of these
 * operations.
 *
 *     api_result_names_init(&names, secret);
 *     for each operation:                          the check
 *         api_decode_op(op, ...)                     in a scope with names.references
 *         api_result_names_add(&names, at, &call)          400 repeated_name
 *     for each operation:                          the run
 *         api_decode_op(...);  he_op_run(..., &results);
 *         api_result_names_bind(&names, &call, &results);  references to it now have values
 *
 * api_result_names_bind stores the results of an operation. A reference to an operation whose
 * results are not stored yet is checked (known name, known result, right kind) and stands for one
 * id, HE_NONE. So when the list is run, an operation must be decoded only after the results of
 * those before it were stored. Names are found by a hash with a secret key, so that clients cannot
 * construct collisions. */
#ifndef HE_API_WRITE_RESULT_NAMES_H
#define HE_API_WRITE_RESULT_NAMES_H

#include "api/write/decode_op.h"

typedef struct api_result_name {
    /* The name is stored in `texts`, because the parsed document of an operation is freed when the
     * next operation is read. */
    const char *name;
    const he_op *op;
    bool each; /* true if the operation runs once for each item of a list: its results are lists */
    bool bound;
    he_results results; /* the results of the operation, if `bound` */
} api_result_name;

typedef struct api_result_names {
    api_result_name *names;
    size_t count, capacity;
    uint32_t *table; /* hash table: each slot has an index of a name plus 1, or 0 if it is empty */
    size_t table_size;  /* number of slots, a power of two */
    uint64_t secret[2]; /* secret key of the hash */
    api_arena texts;
    api_references references; /* resolves references to these names; passed to api_decode_op */
} api_result_names;

/* Initializes `names`, which must not move afterwards: references.context points to it. */
void api_result_names_init(api_result_names *names, const uint64_t secret[2]);
void api_result_names_clear(api_result_names *names);
/* Adds the name of an operation, if it has one. `at` is the JSON object of the operation. Returns
 * false with the problem filled if the name exists already. */
bool api_result_names_add(api_result_names *names, const api_in *at, const api_call *call);
/* Stores the results of an operation if it has a name: moves them out of `results`, which becomes
 * {0}. Otherwise does nothing. */
void api_result_names_bind(api_result_names *names, const api_call *call, he_results *results);
/* Drops all stored results, so that the list can be run again. */
void api_result_names_unbind(api_result_names *names);

#endif
