/* attribute_value.h - values of attributes in JSON.
 *
 * A value is a number, true or false, or, of an attribute of several components, an array of them.
 * Numbers are written so that they read back to the same bits of the same type. Reading refuses
 * with the pointer of the value: another JSON type (wrong_type), a number that is not whole or
 * does not fit (bad_value), one that is too large for a float (not_finite). */
#ifndef HE_API_JSON_ATTRIBUTE_VALUE_H
#define HE_API_JSON_ATTRIBUTE_VALUE_H

#include "api/json/json_in.h"
#include "api/json/json_out.h"
#include "mesh/column.h"

/* One row of a column, at `row`. */
void api_write_value(api_out *out, const he_column *column, const unsigned char *row);
/* Its numbers one after the other, in an array that is open. */
void api_write_components(api_out *out, const he_column *column, const unsigned char *row);
bool api_read_value(const api_in *in, const he_column *column, unsigned char *row);
/* Every value of an array, packed, from mem.h: the caller frees. */
bool api_read_values(const api_in *in, const he_column *column, unsigned char **rows,
                     size_t *count);

/* The members type, components, rule, default and labels of an object, as a new column without
 * rows; the other members are the caller's. */
bool api_read_column(const api_in *object, he_kind domain, const char *name, he_column **out);
/* "domain" to "default" in an object that is open; "labels" of one that has any, which may be long;
 * "domain" to "default" and "bytes", of all rows. */
void api_write_head(api_out *out, const he_column *column);
void api_write_labels(api_out *out, const he_column *column);
void api_write_column(api_out *out, const he_mesh *mesh, const he_column *column);

/* The member "attributes" of an element, where its mesh has any in the domain. Returns how many
 * numbers that are. */
uint32_t api_write_attributes(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id);

/* Texts of he_type and he_rule in their order; end in NULL. */
extern const char *const api_type_names[], *const api_rule_names[];
/* What a rule is where none is said: interpolate for numbers with a fraction, else copy. */
he_rule api_default_rule(he_type type);

#endif
