/* arguments.h - arguments of a call by their name, and elements to give: mostly alive, sometimes
 * deleted, sometimes never issued. */
#ifndef TESTS_MODEL_ARGUMENTS_H
#define TESTS_MODEL_ARGUMENTS_H

#include "model/random.h"
#include "op/op.h"
#include "oracle/oracle.h"

enum { MD_LIST = 12, MD_CALL_TEXT = 400 };

typedef struct md_call {
    size_t row; /* of the table */
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    uint32_t ids[HE_OP_PARAMS][MD_LIST];
    he_vec3 points[HE_OP_PARAMS][MD_LIST];
} md_call;

/* The call as a request would spell it. */
void md_describe(const md_call *c, char text[MD_CALL_TEXT]);

/* Parameters are found by name or plural; one that is missing fails the test. */
size_t md_index(const md_call *c, const char *name);
const he_arg *md_get(const md_call *c, const char *name);

/* A call while it is made up. */
typedef struct md_draft {
    md_call *c;
    const or_mesh *o;
    const he_mesh *m;
    md_random *r;
    bool far; /* points too are as large as doubles get */
} md_draft;

void md_give_id(md_draft *d, const char *name, uint32_t id);
void md_give_number(md_draft *d, const char *name, double number);
void md_give_flag(md_draft *d, const char *name, bool flag);
void md_give_ids(md_draft *d, const char *name, const uint32_t *ids, uint32_t count, bool list);
void md_give_points(md_draft *d, const char *name, uint32_t count, bool list);

/* A live one where there is any. */
uint32_t md_live(md_draft *d, he_kind kind);
uint32_t md_pick(md_draft *d, he_kind kind);
/* Give up to `most` elements, as one id or as a list; now and then one twice. How many it were. */
uint32_t md_pick_some(md_draft *d, const char *one, const char *many, he_kind kind, uint32_t most);
uint32_t md_boundary_halfedge(md_draft *d);
/* Give `point` and `normal`: anywhere, or through three vertices. */
void md_give_plane(md_draft *d);

/* or_require of all elements of a list, and HE_REPEATED_ELEMENT. */
uint64_t md_require_all(const or_mesh *o, he_kind kind, const he_arg *arg);
bool md_is_live_boundary(const he_mesh *m, uint32_t h);
/* The origins along the hole of a boundary half-edge, at most OR_CORNERS; 0 when there are more. */
uint32_t md_hole(const he_mesh *m, uint32_t h, uint32_t loop[OR_CORNERS]);

#endif
