/* schema_rows.h - the members of the API's bodies, as tables. */
#ifndef HE_API_DESCRIBE_SCHEMA_ROWS_H
#define HE_API_DESCRIBE_SCHEMA_ROWS_H

#include <stdbool.h>

/* One member of one schema; rows of a schema stand together. A schema without a row for a member
 * may have it all the same in answers ("others may be added beside them"), but not in requests.
 *
 * Types: id, count, number, flag, text, point, time, nothing (an empty array), #other for a schema
 * by name; a star before makes it an array (**id: arrays of ids), a plus one that is not empty, a
 * question mark behind lets the whole be null. */
typedef struct api_member {
    const char *schema, *name, *type;
    bool required;
    const char *doc;
} api_member;

/* Each ends at a row without a schema. */
extern const api_member api_answer_members[];
extern const api_member api_request_members[];

#endif
