#include "tests/unit/remeshed.h"

#include "tests/unit/fixture.h"

#include "mesh/write.h"

he_remesh_options remesh_options(double edge_length)
{
    return (he_remesh_options){.by = edge_length > 0 ? HE_REMESH_BY_LENGTH : HE_REMESH_BY_FACES,
                               .edge_length = edge_length,
                               .steps = HE_REMESH_STEPS_USUAL,
                               .project = true,
                               .crease = HE_REMESH_CREASE};
}

he_column *remesh_add_column(he_mesh *m, const he_column_schema *schema)
{
    he_column *column = NULL;
    assert_int_equal(he_column_new(schema, &column, NULL), HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, schema->domain), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    return column;
}

he_remeshed remesh_mesh(he_mesh *m, const he_remesh_options *options)
{
    he_remeshed out = {.stop = HE_REMESH_STOP_COUNT};
    he_error err = {0};
    if (he_remesh(m, options, &out, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(m);
    return out;
}
