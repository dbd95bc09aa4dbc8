/* decode_op.h - decodes an operation such as {"op":"edge_split","edge":5,"t":0.5} to the arguments
 * that its row of the operation table requires.
 *
 * The operation table has all rules: the members with type and range, which of them exclude each
 * other, which are required. Unknown members, ids that are not whole numbers below 2^32 - 2, points
 * that are not three finite numbers and lists of a wrong length are answered 400 with their
 * pointer. Whether elements are live is not checked here.
 *
 * Instead of an id there may be a reference "$name.result" or "$name.result.N": the result, or the
 * N-th item of a list result, of an earlier operation that has "as":"name". In a list of ids, a
 * list result is inserted whole. Instead of a list of elements there may be a set,
 * {"selected":true}: see element_set.h. result_names.h resolves references. Decoding is cheap and
 * done twice: for all operations before the first one runs, when references are only checked, and
 * again for each operation just before it runs. */
#ifndef HE_API_WRITE_DECODE_OP_H
#define HE_API_WRITE_DECODE_OP_H

#include "api/write/element_set.h"
#include "op/op.h"
#include "store/store.h"

/* The ids that a reference stands for; borrowed from the names. */
typedef struct api_found {
    const uint32_t *ids;
    size_t count;
    bool list; /* the result is a list */
} api_found;

/* Resolves references. */
typedef struct api_references {
    /* Finds the ids of elements of `kind` that the reference `text` (with its '$') stands for.
     * Returns false with a refusal at `at`. */
    bool (*find)(void *context, const api_in *at, const char *text, he_kind kind, api_found *out);
    void *context;
} api_references;

/* Finds other meshes. */
typedef struct api_meshes {
    /* Finds the mesh with an id; *out is NULL if its content was not loaded yet. Returns false with
     * a refusal at `at`. */
    bool (*find)(void *context, const api_in *at, const char *id, const he_mesh **out);
    void *context;
} api_meshes;

/* What an operation may say beside its parameters and what it may refer to. {0} is nothing. */
typedef struct api_op_scope {
    /* Further members that the object may have, such as expected_revision beside a single
     * operation; ends in NULL. NULL: none. */
    const char *const *also;
    const api_references *references; /* NULL: references and "as" are refused */
    const he_mesh *mesh;              /* where sets are looked up; NULL: they are empty for now */
    const api_meshes *meshes;         /* where other meshes are found; NULL: ids are ignored */
} api_op_scope;

/* One operation, ready for he_op_run. */
typedef struct api_call {
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    const char *as; /* NULL: not named; borrowed from the document */
    bool has_set;   /* a list was given as a set */
} api_call;

/* Decodes one operation. Lists are in the arena, which must outlive the call. */
bool api_decode_op(const api_in *object, const api_op_scope *scope, api_arena *arena,
                   api_call *out);

#endif
