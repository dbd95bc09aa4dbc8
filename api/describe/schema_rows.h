/* schema_rows.h - tables of the members that the JSON bodies of requests and answers have. */
#ifndef HE_API_DESCRIBE_SCHEMA_ROWS_H
#define HE_API_DESCRIBE_SCHEMA_ROWS_H

#include "api/json/record.h"

/* One member of one schema; the rows of a schema are consecutive. An answer may have members for
 * which there is no row, because later versions may add some; a request may not.
 *
 * Types: id, count, number, flag, text, point, time, nothing (an empty array), and #NAME for the
 * schema NAME. A star before a type means an array (**id: an array of arrays of ids), a plus before
 * it an array that is not empty; a question mark after a type allows null. =TEXT is a string that
 * is always TEXT.
 *
 * If answers are written from a table (api/json/record.h), their schema has only one row here,
 * whose name is NULL: the members of the schema are the rows of that other table. */
typedef struct api_member {
    const char *schema, *name, *type;
    bool required;
    const char *doc;
} api_member;

/* The members that answers have, and the members that requests have. Each of the two arrays ends
 * with a row whose schema is NULL. */
extern const api_member api_answer_members[];
extern const api_member api_request_members[];

/* api_record_count returns the number of tables from which answers are written, api_record_at the
 * table with index `i`. */
size_t api_record_count(void);
const api_record *api_record_at(size_t i);
/* Returns the table from which answers with this schema are written, or NULL if there is no such
 * table. */
const api_record *api_record_find(const char *schema);

#endif
