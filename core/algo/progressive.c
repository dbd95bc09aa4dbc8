#include "algo/progressive.h"

#include "algo/decimation.h"

void he_progressive_clear(he_progressive *progressive)
{
    he_mesh_free(progressive->base);
    he_mem_free(progressive->splits);
    he_ids_clear(&progressive->moved);
    *progressive = (he_progressive){0};
}

/* The reported progress (0 to 1) at which copying the mesh ends and the decimation begins. */
static const double COPIED = 0.05;

he_status he_progressive_new(const he_mesh *m, const he_decimate_options *options,
                             he_progress *progress, he_progressive *out, he_error *err)
{
    he_progressive made = {0};
    he_decimated done;
    he_progress_span(progress, COPIED);
    he_status status = he_mesh_copy_with_progress(m, progress, &made.base, err);
    if (status == HE_OK) {
        he_progress_span(progress, 1);
        status = he_decimation_run(made.base, options, &made, &done, err);
    }
    if (status != HE_OK) {
        he_progressive_clear(&made);
        return status;
    }
    he_mesh_set_progress(made.base, NULL);
    *out = made;
    return HE_OK;
}
