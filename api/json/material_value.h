/* material_value.h - materials in JSON.
 *
 *     {"name":"steel","base_color":[0.5,0.5,0.6,1],"metallic":1,"roughness":0.25,
 *      "emission":[0,0,0],"two_sided":false}
 *
 * Only the name must be there; what is not given is as in he_plain_look. A base colour of three
 * numbers is opaque. */
#ifndef HE_API_JSON_MATERIAL_VALUE_H
#define HE_API_JSON_MATERIAL_VALUE_H

#include "api/json/json_in.h"
#include "api/json/json_out.h"
#include "mesh/material.h"

/* A list of the rows, in the order of their slots. */
void api_write_materials(api_out *out, const he_materials *materials);
/* Three numbers from 0 on, or up to `most`; `count` says how many. */
bool api_read_color(const api_in *in, size_t most, double color[4], size_t *count);
/* Add the materials of an array to an empty table. Refused with the pointer of the member: what is
 * no material (bad_value and so on), a second one of a name (duplicate_member), more than
 * HE_MATERIALS (limit_exceeded). */
bool api_read_materials(const api_in *in, he_materials *out);

#endif
