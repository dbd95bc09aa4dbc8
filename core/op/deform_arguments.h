/* deform_arguments.h - the arguments of the operation deform, for a preview that does not edit. */
#ifndef HE_OP_DEFORM_ARGUMENTS_H
#define HE_OP_DEFORM_ARGUMENTS_H

#include "deform/deform.h"
#include "op/op.h"

/* Reads the arguments of deform. The lists and points are those of `args`. */
void he_deform_arguments(const he_arg *args, he_deform_sets *sets, he_deform_goal *goal,
                         unsigned *steps);

#endif
