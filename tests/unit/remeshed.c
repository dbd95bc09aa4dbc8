#include "tests/unit/remeshed.h"

#include "tests/unit/fixture.h"

he_remesh_options remesh_options(double edge_length)
{
    return (he_remesh_options){.by = edge_length > 0 ? HE_REMESH_BY_LENGTH : HE_REMESH_BY_FACES,
                               .edge_length = edge_length,
                               .steps = HE_REMESH_STEPS_USUAL,
                               .project = true,
                               .crease = HE_REMESH_CREASE};
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
