/* material_value.h - materials in JSON.
 *
 *     {"name":"steel","base_color":[0.5,0.5,0.6,1],"metallic":1,"roughness":0.25,
 *      "emission":[0,0,0],"two_sided":false}
 *
 * Only the name is required; members that are left out have the value in he_plain_look. A base
 * colour of three numbers is opaque. */
#ifndef HE_API_JSON_MATERIAL_VALUE_H
#define HE_API_JSON_MATERIAL_VALUE_H

#include "api/json/json_in.h"
#include "api/json/record.h"
#include "mesh/material.h"

/* The JSON members of a he_material. */
extern const api_record api_material_record;

/* Writes all materials of a mesh as a list, in the order in which the mesh stores them. */
void api_write_materials(api_out *out, const he_materials *materials);
/* Reads a colour: an array of at least three and at most `most` numbers, each at least 0. `count`
 * gets the number of numbers. */
bool api_read_color(const api_in *in, size_t most, double color[4], size_t *count);
/* Adds the materials of an array to an empty table.
 * Returns false with the pointer of the member at fault: bad_value and similar codes for an invalid
 * material, duplicate_member for a name used twice, limit_exceeded for more than HE_MATERIALS. */
bool api_read_materials(const api_in *in, he_materials *out);

#endif
