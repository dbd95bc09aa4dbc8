#include "tests/unit/backwards.h"

static he_status run(void *self, uint32_t parts, he_part part, void *context, he_progress *progress,
                     he_error *err)
{
    he_status status = he_progress_step(progress, 0, parts, err);
    for (uint32_t i = parts; i-- > 0 && status == HE_OK;) {
        status = part(context, i, err);
        ++*(uint32_t *)self;
    }
    return status;
}

void backwards_lend(he_progress *progress, uint32_t *parts)
{
    static he_parallel host;
    *parts = 0;
    host = (he_parallel){.run = run, .self = parts, .threads = 2};
    he_progress_init(progress, NULL, NULL);
    progress->parallel = &host;
}
