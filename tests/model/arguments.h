/* arguments.h - draws random arguments, each for the parameter of a call that has the given name:
 * mostly ids of live elements, sometimes ids of deleted elements, sometimes ids that were never
 * issued. */
#ifndef TESTS_MODEL_ARGUMENTS_H
#define TESTS_MODEL_ARGUMENTS_H

#include "model/random.h"
#include "op/op.h"
#include "oracle/oracle.h"

enum { MD_LIST = 12, MD_CALL_TEXT = 400 };

typedef struct md_call {
    size_t row; /* index of the operation in the table of operations */
    const he_op *op;
    he_arg args[HE_OP_PARAMS];
    uint32_t ids[HE_OP_PARAMS][MD_LIST];
    he_vec3 points[HE_OP_PARAMS][MD_LIST];
} md_call;

/* Writes the call in the form of a request. */
void md_describe(const md_call *c, char text[MD_CALL_TEXT]);

/* md_index finds the index of a parameter, and md_get its argument, by its name in the singular or
 * plural; if the call has no such parameter, the test fails. */
size_t md_index(const md_call *c, const char *name);
const he_arg *md_get(const md_call *c, const char *name);

/* The state while a call and its arguments are drawn. */
typedef struct md_draft {
    md_call *c;
    const or_mesh *o;
    const he_mesh *m;
    md_random *r;
    bool far; /* whether points may have coordinates up to the largest double */
} md_draft;

void md_give_id(md_draft *d, const char *name, uint32_t id);
void md_give_number(md_draft *d, const char *name, double number);
void md_give_flag(md_draft *d, const char *name, bool flag);
void md_give_choice(md_draft *d, const char *name, const char *choice);
void md_give_text(md_draft *d, const char *name, const char *text);
void md_give_ids(md_draft *d, const char *name, const uint32_t *ids, uint32_t count, bool list);
void md_give_points(md_draft *d, const char *name, uint32_t count, bool list);

/* md_live returns a live element if there is one; md_pick returns an id that may also be deleted or
 * never issued. */
uint32_t md_live(md_draft *d, he_kind kind);
uint32_t md_pick(md_draft *d, he_kind kind);
/* Puts up to `most` ids of elements into the call, as one id for the parameter `one` or as a list
 * for `many`, in which an id is sometimes repeated. Returns the number of ids. */
uint32_t md_pick_some(md_draft *d, const char *one, const char *many, he_kind kind, uint32_t most);
uint32_t md_boundary_halfedge(md_draft *d);
/* Puts the arguments `point` and `normal` into the call: random ones, or the plane through three
 * vertices. */
void md_give_plane(md_draft *d);
/* Returns the plane of a call, from its arguments point, normal and tolerance. */
or_plane md_plane(const md_call *c);

/* md_is_listed returns whether a list of elements has an id; md_covers also returns true if the
 * list was not given, which stands for all elements. */
bool md_is_listed(const he_arg *list, uint32_t id);
bool md_covers(const he_arg *list, uint32_t id);

/* Returns the refusals of or_require for the elements of a list, and HE_REPEATED_ELEMENT if one is
 * repeated. */
uint64_t md_require_all(const or_mesh *o, he_kind kind, const he_arg *arg);
bool md_is_live_boundary(const he_mesh *m, uint32_t h);
/* Finds the origins of the half-edges along a hole, given one of its half-edges, at most
 * OR_CORNERS; returns 0 if there are more. */
uint32_t md_hole(const he_mesh *m, uint32_t h, uint32_t loop[OR_CORNERS]);

#endif
