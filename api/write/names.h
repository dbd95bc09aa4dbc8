/* names.h - the "as" names of one edit list, and the results behind them.
 *
 *     api_names_init(&names, secret);
 *     for each operation:                          the check
 *         api_decode_op(op, NULL, &names.references, ...)
 *         api_names_add(&names, at, &call)          400 repeated_name
 *     for each operation:                          the run
 *         api_decode_op(...);  he_op_run(..., &results);
 *         api_names_bind(&names, &call, &results);  from here on its references have values
 *
 * While an operation is unbound its references check (known name, known result, fitting kind) and
 * stand for one id, HE_NONE. When the list is run, decode operation i only after those before it
 * were bound. Lookup is by a hash whose key, api_store.secret, clients do not know. */
#ifndef HE_API_WRITE_NAMES_H
#define HE_API_WRITE_NAMES_H

#include "api/write/decode_op.h"

typedef struct api_name {
    const char *name; /* in `texts`: the document of an operation is gone when the next is read */
    const he_op *op;
    bool bound;
    he_results results; /* owned once bound */
} api_name;

typedef struct api_names {
    api_name *names;
    size_t count, capacity;
    uint32_t *table;    /* index + 1 into names, 0 empty */
    size_t table_size;  /* a power of two */
    uint64_t secret[2]; /* key of the hash */
    api_arena texts;
    api_references references; /* give this to api_decode_op */
} api_names;

/* `names` must not move afterwards: references.context points at it. */
void api_names_init(api_names *names, const uint64_t secret[2]);
void api_names_clear(api_names *names);
/* Without "as" it does nothing. `at` is the operation's object. */
bool api_names_add(api_names *names, const api_in *at, const api_call *call);
/* Takes the results where the operation is named (and leaves {0}), else leaves them alone. */
void api_names_bind(api_names *names, const api_call *call, he_results *results);
/* Forget all results, before the list is run once more. */
void api_names_unbind(api_names *names);

#endif
