#include "base/progress.h"

void he_progress_init(he_progress *progress,
                      bool (*tell)(void *context, const char *phase, double done), void *context)
{
    *progress = (he_progress){.tell = tell, .context = context, .phase = "starting", .span_to = 1};
}

void he_progress_span(he_progress *progress, double to)
{
    if (progress != NULL) {
        progress->span_from = progress->done;
        progress->span_to = to;
    }
}

static he_status tell(he_progress *progress, double done, he_error *err)
{
    if (done > progress->done) {
        progress->done = done;
    }
    if (!progress->cancelled && progress->tell != NULL) {
        progress->cancelled = !progress->tell(progress->context, progress->phase, progress->done);
    }
    return progress->cancelled
               ? he_fail_plain(err, HE_CANCELLED, "cancelled while %s", progress->phase)
               : HE_OK;
}

he_status he_progress_phase(he_progress *progress, const char *name, double to, he_error *err)
{
    if (progress == NULL) {
        return HE_OK;
    }
    progress->phase = name;
    progress->from = progress->done;
    progress->to = progress->span_from + to * (progress->span_to - progress->span_from);
    return tell(progress, progress->from, err);
}

he_status he_progress_step(he_progress *progress, uint64_t i, uint64_t count, he_error *err)
{
    if (progress == NULL) {
        return HE_OK;
    }
    double part = i >= count ? 1 : (double)i / (double)count;
    return tell(progress, progress->from + part * (progress->to - progress->from), err);
}

void he_progress_tell(he_progress *progress, uint64_t i, uint64_t count)
{
    he_status told = he_progress_step(progress, i, count, NULL);
    (void)told;
}
