/* materials.c - GET .../materials: the list of the mesh's materials, to which faces refer. */
#include "api/request/handlers.h"

#include "api/json/material_value.h"
#include "api/request/mesh_access.h"
#include "mesh/material.h"

void api_materials_list(api_exchange *x)
{
    if (!api_not_modified(x, "materials")) {
        api_out *out = &x->out;
        api_out_object_begin(out);
        api_out_key_u64(out, "revision", x->info.revision);
        api_out_key(out, "materials");
        api_write_materials(out, he_mesh_materials(x->content));
        api_out_object_end(out);
        api_answer_json(x, 200);
    }
}
