/* page_records.h - the tables of JSON members (api/json/record.h) of answers about the server
 * itself. */
#ifndef HE_API_DESCRIBE_PAGE_RECORDS_H
#define HE_API_DESCRIBE_PAGE_RECORDS_H

#include "api/json/record.h"

extern const api_record api_health_record, api_readiness_record, api_version_record,
    api_index_record;

#endif
