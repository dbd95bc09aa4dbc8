/* attribute_value.h - attribute values in JSON.
 *
 * A value is a number, true or false, or, when the attribute has several components, an array of
 * them. Numbers are written so that they read back to the same bits of the same type. The problem
 * of a refused value carries its JSON pointer. The codes are wrong_type for another JSON type,
 * bad_value for a number that is not whole or out of range, not_finite for a number too large for a
 * float. */
#ifndef HE_API_JSON_ATTRIBUTE_VALUE_H
#define HE_API_JSON_ATTRIBUTE_VALUE_H

#include "api/json/json_in.h"
#include "api/json/record.h"
#include "mesh/column.h"

/* Writes the attribute value of one element; `row` has the bytes of the value. */
void api_write_value(api_out *out, const he_column *column, const unsigned char *row);
/* Writes the components of one value into an array that the caller has opened. */
void api_write_components(api_out *out, const he_column *column, const unsigned char *row);
bool api_read_value(const api_in *in, const he_column *column, unsigned char *row);
/* Reads all values of an array into `rows`, one after the other without gaps. The caller frees
 * `rows`, which come from mem.h. */
bool api_read_values(const api_in *in, const he_column *column, unsigned char **rows,
                     size_t *count);

/* Reads the definition of an attribute from an object: the members type, components, rule, default
 * and labels. Makes a new column (the array of an attribute's values) that has no values yet. The
 * caller reads the other members. */
bool api_read_column(const api_in *object, he_kind domain, const char *name, he_column **out);

/* A column, with the values of the JSON members of an attribute. The texts are borrowed. */
typedef struct api_shown_column {
    const he_column *column;
    const char *domain, *name, *type, *rule;
    uint32_t components;
    bool has_labels; /* true if the labels are written: the list may be long */
    uint64_t bytes;  /* size of all values */
} api_shown_column;

/* Returns a column of the mesh with these values; `has_labels` is true if the column has labels. */
api_shown_column api_show_column(const he_mesh *mesh, const he_column *column);
/* The JSON members of an api_shown_column. The first of the three tables has "domain" and "name"
 * only, the second all members but "bytes", the third all. */
extern const api_record api_attribute_read_record, api_attribute_added_record,
    api_attribute_info_record;
/* Writes the default value of the api_shown_column at `shown`, as the row of a table requires. */
void api_write_default(api_out *out, const void *shown);

/* Writes the member "attributes" of an element, if the mesh has attributes in its domain. Returns
 * the number of values written. */
uint32_t api_write_attributes(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id);

/* The names of he_type and of he_rule, in the order of the enum; each array ends in NULL. */
extern const char *const api_type_names[], *const api_rule_names[];
/* Returns the rule that an attribute gets if the client names none: interpolate for floating-point
 * types, else copy. */
he_rule api_default_rule(he_type type);

#endif
