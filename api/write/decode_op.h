/* decode_op.h - from {"op":"edge_split","edge":5,"t":0.5} to the arguments of its row.
 *
 * The operation table says all there is to know: which members, of which type and range, which
 * exclude each other, what is required. Unknown members, ids that are not whole numbers below
 * 2^32 - 2, points that are not three finite numbers, lists of the wrong length are 400 with their
 * pointer. Whether elements live is not asked here.
 *
 * In the place of an id a string "$name.result" or "$name.result.N" may stand: the result, or the
 * N-th of a list, of an earlier operation that carries "as":"name". In a list a result that is a
 * list is put in whole. In the place of a list of elements a set may stand, {"selected":true}: see
 * element_set.h. A scope (names.h) knows them. Decoding is cheap and done twice: once
 * for all operations before any is run, when references are only checked, and once for each as its
 * turn comes. */
#ifndef HE_API_WRITE_DECODE_OP_H
#define HE_API_WRITE_DECODE_OP_H

#include "api/write/element_set.h"
#include "op/op.h"
#include "store/store.h"

/* Ids a reference stands for; borrowed from the scope. */
typedef struct api_found {
    const uint32_t *ids;
    size_t count;
    bool list; /* the result as a whole, which is a list */
} api_found;

/* What resolves references. */
typedef struct api_references {
    /* Ids of `kind` that `text` (with its '$') stands for. Refuses at `at` on false. */
    bool (*find)(void *context, const api_in *at, const char *text, he_kind kind, api_found *out);
    void *context;
} api_references;

/* What finds other meshes. */
typedef struct api_meshes {
    /* The mesh of an id, or NULL where its content is not taken yet. Refuses at `at` on false. */
    bool (*find)(void *context, const api_in *at, const char *id, const he_mesh **out);
    void *context;
} api_meshes;

/* One operation, ready for he_op_run. */
typedef struct api_call {
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    const char *as; /* NULL when it has none; borrowed from the document */
    bool has_set;   /* a list was given as a set */
} api_call;

/* `references` NULL: strings in the place of ids are refused, and so is "as". `also` lists members
 * the object may hold besides (expected_revision beside a single operation), NULL for none. `mesh`
 * is what sets are looked up in; NULL: not yet, they are empty. `meshes` finds other meshes; NULL:
 * their ids are not looked at. Lists are in the arena, which must outlive the call. */
bool api_decode_op(const api_in *object, const char *const *also, const api_references *references,
                   const he_mesh *mesh, const api_meshes *meshes, api_arena *arena, api_call *out);

#endif
