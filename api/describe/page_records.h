/* page_records.h - tables of the JSON members (api/json/record.h) that the answers about the server
 * itself have. */
#ifndef HE_API_DESCRIBE_PAGE_RECORDS_H
#define HE_API_DESCRIBE_PAGE_RECORDS_H

#include "api/json/record.h"

extern const api_record api_health_record, api_readiness_record, api_version_record,
    api_index_record, api_problem_row_record, api_problems_record;

#endif
