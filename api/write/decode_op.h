/* decode_op.h - decodes an operation such as {"op":"edge_split","edge":5,"t":0.5} to the arguments
 * of he_op_run.
 *
 * The operation table (op/op.h) says which members an operation has, with their types and ranges,
 * which are required, and which exclude each other. Unknown members, ids that are not whole numbers
 * below 2^32 - 2, points that are not three finite numbers, and lists of a wrong length are refused
 * with 400 and the JSON pointer of the value. Whether elements are live is not checked here.
 *
 * Instead of an id there may be a reference "$name.result" or "$name.result.N": the result, or the
 * N-th item of a list result, of an earlier operation that has "as":"name". In a list of ids, a
 * reference to a list inserts all its items. Instead of a list of elements there may be a set,
 * {"selected":true}: see element_set.h. A parameter with `each` in the table may be given as a
 * list, and the others then as columns (he_arg); ids in such a list are refused with API_REPEATED
 * if they occur twice. result_names.h resolves references. Each operation is
 * decoded twice: once before the first operation of the list runs, when references are only
 * checked, and again just before it runs itself. */
#ifndef HE_API_WRITE_DECODE_OP_H
#define HE_API_WRITE_DECODE_OP_H

#include "api/write/element_set.h"
#include "op/op.h"
#include "store/store.h"

/* The ids that a reference stands for; borrowed from result_names.h. */
typedef struct api_found {
    const uint32_t *ids;
    size_t count;
    bool list;  /* true if the reference stands for a list, not a single id */
    bool known; /* true if the operation that the reference names has run already */
} api_found;

/* A function that resolves references, with its context. */
typedef struct api_references {
    /* Finds the ids of elements of `kind` that the reference `text` (with its '$') stands for.
     * Refuses the value at `at` and returns false if there is no such result. */
    bool (*find)(void *context, const api_in *at, const char *text, he_kind kind, api_found *out);
    void *context;
} api_references;

/* A function that finds the other meshes that an operation names, with its context. */
typedef struct api_meshes {
    /* Finds the mesh with an id, or a revision of the edited mesh if `id` is NULL; *out is NULL if
     * no snapshot of it was taken yet. Refuses the value at `at` and returns false if there is no
     * such mesh. */
    bool (*find)(void *context, const api_in *at, const char *id, uint64_t revision,
                 const he_mesh **out);
    void *context;
} api_meshes;

/* What an operation may contain besides its parameters, and what it may refer to. {0} allows
 * neither. */
typedef struct api_op_scope {
    /* Names of further members that the object may have, such as expected_revision if the request
     * has a single operation; ends in NULL. NULL: none. */
    const char *const *also;
    /* Resolves references; NULL: references and "as" are refused. */
    const api_references *references;
    /* The mesh whose elements are in the sets that an operation names; NULL: sets are only
     * checked. */
    const he_mesh *mesh;
    const api_meshes *meshes; /* finds other meshes; NULL: ids of other meshes are ignored */
} api_op_scope;

/* One decoded operation, ready for he_op_run. */
typedef struct api_call {
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    const char *as; /* the name given with "as", borrowed from the document; NULL: none */
    bool has_set;   /* true if a list of elements was given as a set */
    /* True if there is a reference to results that are not known yet. */
    bool has_unknown;
} api_call;

/* Decodes one operation. Lists are in the arena, which must outlive `out`. */
bool api_decode_op(const api_in *object, const api_op_scope *scope, api_arena *arena,
                   api_call *out);

#endif
