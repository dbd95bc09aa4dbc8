/* records.h - the tables of JSON members (api/json/record.h) from which the handlers in api/ask
 * write their answers. */
#ifndef HE_API_ASK_RECORDS_H
#define HE_API_ASK_RECORDS_H

#include "api/json/record.h"

/* The JSON members of the answer of GET .../check, and of the objects in it: a broken invariant, a
 * defect and the thresholds. */
extern const api_record api_check_record, api_broken_record, api_defect_record,
    api_thresholds_record;
/* The JSON members of the answer of POST .../compare, and of the objects in it: the distances in
 * one direction, and a place. */
extern const api_record api_comparison_record, api_one_sided_record, api_far_place_record;

#endif
