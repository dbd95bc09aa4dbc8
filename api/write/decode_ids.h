/* decode_ids.h - for decode_op.c only: reads ids, lists of ids, and lists of lists of ids. */
#ifndef HE_API_WRITE_DECODE_IDS_H
#define HE_API_WRITE_DECODE_IDS_H

#include "api/write/decode_op.h"

/* What the functions that decode one operation share. */
typedef struct api_decoder {
    const api_in *object;
    const api_op_scope *scope;
    api_arena *arena;
    const he_op *op;
    api_call *call;
    bool runs_each; /* the operation has a list for each of whose items it runs */
} api_decoder;

/* Reads an id or a reference to one; null if the parameter allows it. */
bool api_decode_id(const api_decoder *d, const he_param *param, const api_in *in, uint32_t *id);
/* Reads a list of at least `min` ids and references. */
bool api_decode_ids(const api_decoder *d, const he_param *param, size_t min, const api_in *in,
                    he_arg *arg);
/* Reads a list of lists of ids, at least one. */
bool api_decode_cycles(const api_decoder *d, const he_param *param, const api_in *in, he_arg *arg);
/* Reads a set, such as {"selected":true}. */
bool api_decode_set(const api_decoder *d, he_kind kind, const api_in *in, he_arg *arg);
/* Refuses a list of ids in which an id occurs twice with API_REPEATED. `in` is the list. */
bool api_check_repeated(const api_decoder *d, const api_in *in, const he_arg *arg);

#endif
