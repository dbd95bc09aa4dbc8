/* records.h - the members of answers that handlers of this room write from tables. */
#ifndef HE_API_READ_RECORDS_H
#define HE_API_READ_RECORDS_H

#include "api/json/record.h"

/* An entry of the history, and the numbers of elements in it. */
extern const api_record api_entry_record, api_counted_record;
/* The rights of a token, a ticket, and how many tokens were read. */
extern const api_record api_token_record, api_ticket_record, api_reloaded_record;

#endif
