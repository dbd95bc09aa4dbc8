/* schema_rows.h - the members of the API's bodies, as tables. */
#ifndef HE_API_DESCRIBE_SCHEMA_ROWS_H
#define HE_API_DESCRIBE_SCHEMA_ROWS_H

#include "api/json/record.h"

/* One member of one schema; the rows of a schema are consecutive. Answers may have members without
 * a row ("others may be added beside them"), requests may not.
 *
 * Types: id, count, number, flag, text, point, time, nothing (an empty array), #other for another
 * schema by name. A star before the type makes it an array (**id: an array of arrays of ids), a
 * plus an array that is not empty; a question mark after it allows null for the whole. =text is a
 * string that is always this text.
 *
 * A schema whose answers are written from a table (api/json/record.h) has one row without a name:
 * its members are the rows of that table. */
typedef struct api_member {
    const char *schema, *name, *type;
    bool required;
    const char *doc;
} api_member;

/* Both arrays end with a row that names no schema. */
extern const api_member api_answer_members[];
extern const api_member api_request_members[];

/* The tables of members from which answers are written. */
size_t api_record_count(void);
const api_record *api_record_at(size_t i);
/* Returns the table of a schema, or NULL. */
const api_record *api_record_find(const char *schema);

#endif
