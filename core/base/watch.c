#include "base/watch.h"

void he_watch_init(he_watch *watch, bool (*tell)(void *context, const char *phase, double done),
                   void *context)
{
    *watch = (he_watch){.tell = tell, .context = context, .phase = "starting", .span_to = 1};
}

void he_watch_span(he_watch *watch, double to)
{
    if (watch != NULL) {
        watch->span_from = watch->done;
        watch->span_to = to;
    }
}

static he_status tell(he_watch *watch, double done, he_error *err)
{
    if (done > watch->done) {
        watch->done = done;
    }
    if (!watch->cancelled && watch->tell != NULL) {
        watch->cancelled = !watch->tell(watch->context, watch->phase, watch->done);
    }
    return watch->cancelled ? he_fail_plain(err, HE_CANCELLED, "cancelled while %s", watch->phase)
                            : HE_OK;
}

he_status he_watch_phase(he_watch *watch, const char *name, double to, he_error *err)
{
    if (watch == NULL) {
        return HE_OK;
    }
    watch->phase = name;
    watch->from = watch->done;
    watch->to = watch->span_from + to * (watch->span_to - watch->span_from);
    return tell(watch, watch->from, err);
}

he_status he_watch_step(he_watch *watch, uint64_t i, uint64_t count, he_error *err)
{
    if (watch == NULL) {
        return HE_OK;
    }
    double part = i >= count ? 1 : (double)i / (double)count;
    return tell(watch, watch->from + part * (watch->to - watch->from), err);
}

void he_watch_tell(he_watch *watch, uint64_t i, uint64_t count)
{
    he_status told = he_watch_step(watch, i, count, NULL);
    (void)told;
}
