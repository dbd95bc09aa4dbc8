/* materials.c - GET .../materials: the list of the mesh's materials, to which faces refer. */
#include "api/request/handlers.h"

#include "api/json/material_value.h"
#include "api/read/records.h"
#include "api/request/mesh_access.h"
#include "mesh/material.h"

typedef struct list {
    uint64_t revision;
    const he_materials *materials;
} list;

static void write_materials(api_out *out, const void *value)
{
    api_write_materials(out, ((const list *)value)->materials);
}

static const api_field list_fields[] = {
    API_FIELD("revision", "count", list, revision, .required = true),
    API_FIELD_MADE("materials", "*#material_row", write_materials, .required = true,
                   .doc = "The materials, the oldest first."),
};
const api_record api_material_list_record = API_RECORD("material_list", list_fields);

void api_materials_list(api_exchange *x)
{
    if (!api_not_modified(x, "materials")) {
        api_record_write(&x->out, &api_material_list_record,
                         &(list){x->info.revision, he_mesh_materials(x->content)});
        api_answer_json(x, 200);
    }
}
